// The file of a state: what is written is read, and nothing else is taken for it.
#include "app/checkpoint/checkpoint.h"

#include "app/backends.h"
#include "sim/core/check.h"
#include "sim/state_fields.h"
#include "sim/state_hash.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <random>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace app::test {
namespace {

/// Gives every number of a state a value of its own.
class Scribbler {
 public:
    static constexpr bool kFills = true;

    template <class T>
    void number(const std::string& name, std::string_view, T& x)
    {
        if (name == "liquid/count") x = static_cast<T>(37);
        else if (name == "liquid/mode_count") x = static_cast<T>(8);
        else x = next<T>();
    }
    template <class T>
    void list(const std::string& name, std::string_view, std::vector<T>& v)
    {
        if (name.ends_with("blocks")) {
            if constexpr (std::is_same_v<T, sim::Vec3i>) v = {{0, 0, 0}, {1, 0, -2}, {3, 4, 5}};
            return;
        }
        v.resize(5);
        for (T& x : v)
            if constexpr (std::is_same_v<T, double>) x = next<double>();
            else
                for (typename T::Scalar& number : x) number = next<typename T::Scalar>();
    }
    template <class Row>
    void rows(const std::string&, std::string_view, std::size_t count, std::size_t size, Row&& row)
    {
        using Number = std::remove_cvref_t<decltype(*row(0))>;
        for (std::size_t r = 0; r < count; ++r)
            for (std::size_t i = 0; i < size; ++i) row(r)[i] = next<Number>();
    }

 private:
    template <class T>
    T next()
    {
        if constexpr (std::is_same_v<T, bool>) return true;
        else if constexpr (std::is_floating_point_v<T>) return std::uniform_real_distribution<T>(-1.0, 1.0)(random_);
        else return static_cast<T>(++count_);
    }
    std::mt19937 random_{1};
    int count_ = 100;
};

sim::State scribbledState()
{
    sim::State state;
    Scribbler scribbler;
    sim::visitState(scribbler, state);
    return state;
}

/// Counts fields, and adds to one of them.
class Nudger {
 public:
    static constexpr bool kFills = false;
    explicit Nudger(int which) : left_(which) {}

    template <class T>
    void number(const std::string&, std::string_view, T& x)
    {
        if (left_-- == 0) x = static_cast<T>(!std::is_same_v<T, bool> ? x + 1 : 0);
    }
    template <class T>
    void list(const std::string& name, std::string_view, std::vector<T>& v)
    {
        if (name.ends_with("blocks")) return;  // a copy
        if (left_-- == 0) reinterpret_cast<typename NumberOf<T>::Type&>(v.back()) += 1;
    }
    template <class Row>
    void rows(const std::string&, std::string_view, std::size_t count, std::size_t size, Row&& row)
    {
        if (left_-- == 0) row(count - 1)[size - 1] += 1;
    }
    bool isDone() const { return left_ < 0; }

 private:
    template <class T>
    struct NumberOf {
        using Type = double;
    };
    int left_;
};

class CheckpointFile : public testing::Test {
 protected:
    CheckpointFile()
    {
        origin.scene = "a scene";
        origin.label = "with an Umlaut: ä";
        origin.trajectory = "0123456789abcdef";
        origin.program = 77;
        origin.frame = 12;
        origin.logs.summary.times.total = {0.5, 0.25};
        origin.logs.summary.largestCfl = 0.75;
        origin.logs.stepsBytes = 4321;
    }
    std::string refusalOf(const std::string& bytes) const
    {
        writeFile(folder / "broken.h5", bytes);
        try {
            loadCheckpoint(folder / "broken.h5");
        } catch (const sim::InputError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            return error.what();
        }
        return "taken";
    }

    TemporaryFolder folder;
    CheckpointOrigin origin;
};

TEST_F(CheckpointFile, EveryFieldOfAStateComesBack)
{
    const sim::State state = scribbledState();
    saveCheckpoint(origin, state, folder / "state.h5");
    const Checkpoint read = loadCheckpoint(folder / "state.h5");
    EXPECT_EQ(sim::stateHash(read.state), sim::stateHash(state));
    EXPECT_EQ(read.state.liquid.count, 37u);
    EXPECT_EQ(read.state.grid.coords(), state.grid.coords());
    EXPECT_EQ(read.state.memory.maxSpeed, state.memory.maxSpeed);
    EXPECT_EQ(read.state.memory.longest, state.memory.longest);
    EXPECT_EQ(read.state.memory.energies, state.memory.energies);
    EXPECT_EQ(read.state.memory.next, state.memory.next);
    EXPECT_EQ(read.state.memory.internal, state.memory.internal);
    EXPECT_EQ(read.state.memory.deepest, state.memory.deepest);
    EXPECT_EQ(read.origin.scene, origin.scene);
    EXPECT_EQ(read.origin.variant, "");
    EXPECT_EQ(read.origin.label, origin.label);
    EXPECT_EQ(read.origin.frame, 12);
    EXPECT_EQ(read.origin.program, 77u);
    EXPECT_EQ(read.origin.logs.summary.times.total, origin.logs.summary.times.total);
    EXPECT_EQ(read.origin.logs.summary.largestCfl, 0.75);
    EXPECT_EQ(read.origin.logs.stepsBytes, 4321u);
    EXPECT_FALSE(read.origin.logs.summary.energyLedger.has_value());
}

TEST_F(CheckpointFile, AStateWithoutAnythingComesBack)
{
    const sim::State nothing;
    saveCheckpoint(origin, nothing, folder / "state.h5");
    EXPECT_EQ(sim::stateHash(loadCheckpoint(folder / "state.h5").state), sim::stateHash(nothing));
}

/// The hash is of all fields but the memory of steps: whichever is changed, it is another.
TEST_F(CheckpointFile, NoFieldEscapesTheHash)
{
    const std::uint64_t hash = sim::stateHash(scribbledState());
    int fields = 0;
    for (;; ++fields) {
        sim::State state = scribbledState();
        Nudger nudger(fields);
        sim::visitMatter(nudger, state);
        if (!nudger.isDone()) break;
        // The numbers of particles and modes, and whether there is a pressure of strain, are copies while they are looked at.
        if (fields != 4 && fields != 5 && fields != 14) {
            EXPECT_NE(sim::stateHash(state), hash) << "field " << fields;
        }
    }
    EXPECT_GT(fields, 35);
}

TEST_F(CheckpointFile, WhatIsNoneIsRefusedWithItsReason)
{
    saveCheckpoint(origin, scribbledState(), folder / "state.h5");
    const std::string whole = contentOf(folder / "state.h5");
    EXPECT_EQ(refusalOf(whole), "taken");
    EXPECT_NE(refusalOf("").find("no checkpoint of Drench"), std::string::npos);
    EXPECT_NE(refusalOf("\x89HDF\r\n\x1a\n and more").find("no checkpoint of Drench"), std::string::npos);
    EXPECT_NE(refusalOf("Drench checkpoint 1\n" + whole.substr(20)).find("version 1"), std::string::npos);
    EXPECT_NE(refusalOf(whole.substr(0, 200)).find("cut off"), std::string::npos);
    EXPECT_NE(refusalOf(whole + "x").find("bytes are there"), std::string::npos);
    for (std::size_t size = 512; size < whole.size(); size += 997)
        EXPECT_NE(refusalOf(whole.substr(0, size)).find("cut off"), std::string::npos) << size;
    for (std::size_t at = 512; at < whole.size(); at += 499) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
        EXPECT_NE(refusalOf(flipped).find("damaged"), std::string::npos) << at;
    }
}

/// Same content, other numbers in the header: the checksum is not the only thing that is looked at.
TEST_F(CheckpointFile, AHeaderThatWasTamperedWithIsRefused)
{
    saveCheckpoint(origin, scribbledState(), folder / "state.h5");
    const std::string whole = contentOf(folder / "state.h5");
    for (std::size_t at = 0; at < whole.find('\0'); ++at) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x01);
        EXPECT_NE(refusalOf(flipped), "taken") << at;
    }
}

/// A disk that takes no more: the old file stays, nothing is left half-written, and the program goes on.
TEST_F(CheckpointFile, AFullDiskLeavesTheOldFile)
{
    saveCheckpoint(origin, sim::State(), folder / "state.h5");
    const std::string old = contentOf(folder / "state.h5");
    const pid_t child = fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit few = {4096, 4096};
        setrlimit(RLIMIT_FSIZE, &few);
        try {
            saveCheckpoint(origin, scribbledState(), folder / "state.h5");
        } catch (const std::runtime_error&) {
            _exit(7);
        }
        _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(contentOf(folder / "state.h5"), old);
    EXPECT_FALSE(std::filesystem::exists(folder / "state.h5.part"));
}

TEST_F(CheckpointFile, ForPicturesTheVelocityIsEnough)
{
    const sim::State state = scribbledState();
    sim::State lean;
    for (int again = 0; again < 2; ++again) {  // the second one into storage that is there
        copyForPictures(state, lean);
        ASSERT_EQ(lean.liquid.count, state.liquid.count);
        EXPECT_EQ(lean.liquid.modeCount, 1);
        for (std::size_t p = 0; p < lean.liquid.count; ++p) {
            EXPECT_EQ(lean.liquid.velocity(p), state.liquid.velocity(p));
            EXPECT_EQ(lean.liquid.position(p), state.liquid.position(p));
            EXPECT_EQ(lean.liquid.mass[p], state.liquid.mass[p]);
            EXPECT_EQ(lean.liquid.id[p], state.liquid.id[p]);
        }
        EXPECT_EQ(lean.fabric.absorbed, state.fabric.absorbed);
        EXPECT_EQ(lean.pressure.block(1)[5], state.pressure.block(1)[5]);
    }
}

}  // namespace
}  // namespace app::test
