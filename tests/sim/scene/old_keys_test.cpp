// Keys that were called otherwise before are read, and told.

#include "sim/scene/old_keys.h"
#include "app/scene/read_picture_settings.h"
#include "sim/renamed.h"
#include "sim/scene/load_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <ostream>

namespace sim {

void PrintTo(const Renamed& row, std::ostream* out) { *out << row.before; }

}  // namespace sim

namespace {

const std::string kPool = "grid: {cell: 0.25}\nliquid: {sources: [{shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}}]}\n";

/// What a key had before and has now, and the key beside it without which it is refused.
struct Values {
    std::string before, now, beside;
};
const std::map<std::string_view, Values> kValues = {
    {"transfer.keep", {"{liquid_affine: 0.996, fabric_stretch: 0}", "{liquid_affine: 0.004, fabric_stretch: 1}", ""}},
    {"transfer.keep_dt", {"step", "step", ""}},
    {"coupling.capture.compat_factor", {"2", "2", "coupling.capture.law"}},
    {"output.probes.hoops", {"{gate: {center: [0, 2, 0]}}", "{gate: {center: [0, 2, 0]}}", ""}},
};

std::string nested(const std::string& path, const std::string& value)
{
    const std::size_t dot = path.find('.');
    return dot == std::string::npos ? fmt::format("{}: {}", path, value)
                                    : fmt::format("{}: {{{}}}", path.substr(0, dot), nested(path.substr(dot + 1), value));
}

/// A scene that was read, and all of it as it is printed.
struct Loaded {
    sim::Scene scene;
    std::string printed;
};

Loaded loaded(const std::string& text, const sim::LoadOptions& options = {})
{
    const sim::SceneFile file = sim::sceneFileFromText(text, "old.yaml", options);
    Loaded all = {sim::readScene(file), {}};
    all.printed = sim::printScene(all.scene) + app::printPictureSettings(app::readPictureSettings(file));
    return all;
}

/// Notes that tell what a key is called now.
std::vector<std::string> namesTold(const Loaded& of)
{
    std::vector<std::string> told;
    for (const std::string& note : of.scene.notes)
        if (note.find(" is called ") != std::string::npos) told.push_back(note);
    return told;
}

class OldKeys : public testing::TestWithParam<sim::Renamed> {
 protected:
    /// The scenes are the same, and of the old one the name of now is told once, at that place.
    void expectSame(const Loaded& before, const Loaded& now, const std::string& where) const
    {
        EXPECT_EQ(before.printed, now.printed);
        EXPECT_NE(now.printed, loaded(kPool, {"", beside()}).printed) << "a key that changes nothing shows nothing";
        EXPECT_TRUE(namesTold(now).empty());
        const std::vector<std::string> told = namesTold(before);
        ASSERT_EQ(told.size(), 1u);
        EXPECT_TRUE(told[0].starts_with(fmt::format("{}: {} is called {} now", where, GetParam().before, GetParam().now))) << told[0];
    }
    const Values& values() const { return kValues.at(GetParam().before); }
    std::vector<std::string> beside() const
    {
        return values().beside.empty() ? std::vector<std::string>() : std::vector<std::string>{values().beside + "=published"};
    }
    std::string before() const { return std::string(GetParam().before); }
    std::string now() const { return std::string(GetParam().now); }
};

TEST_P(OldKeys, InSectionsAreThoseOfNow)
{
    const auto in = [&](const std::string& path, const std::string& value) { return loaded(kPool + nested(path, value) + "\n", {"", beside()}); };
    expectSame(in(before(), values().before), in(now(), values().now), "old.yaml:3");
}

TEST_P(OldKeys, OfTheCommandLineAreThoseOfNow)
{
    const auto set = [&](const std::string& path, const std::string& value) {
        std::vector<std::string> sets = beside();
        sets.push_back(path + "=" + value);
        return loaded(kPool, {"", sets});
    };
    expectSame(set(before(), values().before), set(now(), values().now), fmt::format("--set {}={}", before(), values().before));
}

TEST_P(OldKeys, OfVariantsAreThoseOfNow)
{
    const auto in = [&](const std::string& path, const std::string& value) {
        return loaded(fmt::format("{}compare: {{variants: [{{name: a, {}: {}}}]}}\n", kPool, path, value), {"a", beside()});
    };
    expectSame(in(before(), values().before), in(now(), values().now), "old.yaml:3");
}

TEST_P(OldKeys, OfChangesAreThoseOfNow)
{
    const auto in = [&](const std::string& path, const std::string& value) {
        return loaded(fmt::format("{}changes: [{{step: 3, set: {{{}: {}}}}}]\n", kPool, path, value), {"", beside()});
    };
    if (before().starts_with("output.")) {  // which holds for a whole run, by either name
        EXPECT_THROW(in(before(), values().before), sim::InputError);
        EXPECT_THROW(in(now(), values().now), sim::InputError);
        return;
    }
    expectSame(in(before(), values().before), in(now(), values().now), "old.yaml:3");
}

TEST_P(OldKeys, BesideThoseOfNowAreRefused)
{
    const std::string inner = before().substr(before().rfind('.') + 1), section = before().substr(0, before().rfind('.'));
    const std::string both = fmt::format("{{{}: {}, {}: {}}}", inner, values().before, now().substr(now().rfind('.') + 1), values().now);
    try {
        loaded(kPool + nested(section, both) + "\n", {"", beside()});
        ADD_FAILURE() << "not refused";
    } catch (const sim::InputError& error) {
        EXPECT_EQ(fmt::format("old.yaml:3: {} is called {} now, which stands beside it; remove one of them", before(), now()), error.what());
    }
}

std::string nameOf(const testing::TestParamInfo<sim::Renamed>& info)
{
    std::string name(info.param.before);
    std::ranges::replace(name, '.', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, OldKeys, testing::ValuesIn(sim::renamedKeys().begin(), sim::renamedKeys().end()), nameOf);

TEST(OldKeysBelow, OneThatWasRenamedGoWithItWithDots)
{
    const Loaded scene = loaded(kPool, {"", {"transfer.keep.liquid_affine=0.9992"}});
    EXPECT_EQ(scene.scene.settings.transfer.affineDamping, 0.0008);
    ASSERT_EQ(namesTold(scene).size(), 1u);
    EXPECT_NE(namesTold(scene)[0].find("transfer.keep.liquid_affine is called transfer.damping.liquid_affine now, and says what is lost"),
              std::string::npos);
}

TEST(OldKeysBelow, ThatAreUnknownAreRefusedAsBefore)
{
    for (const auto& [text, message] :
         {std::pair<std::string, std::string>{"transfer: {keeps: {liquid_affine: 1}}\n", "old.yaml:3: unknown key \"keeps\" in transfer"},
          {"transfer: {keep: {liquid: 1}}\n", "old.yaml:3: unknown key \"liquid\" in transfer.damping"}}) {
        try {
            loaded(kPool + text);
            ADD_FAILURE() << text;
        } catch (const sim::InputError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(message)) << error.what();
        }
    }
}

/// 1 - x of what is written is what was kept, to the last bit, from a half on and where nothing was.
TEST(OldKeysBelow, KeepTheirBitsWhereNumbersHaveThem)
{
    for (int n = 5000; n <= 10000; ++n) {
        const double kept = 1.0e-4 * n;
        ASSERT_EQ(1.0 - std::stod(sim::lostText(kept)), kept) << sim::lostText(kept);
    }
    EXPECT_EQ(sim::lostText(0.9992), "0.0008");
    EXPECT_EQ(sim::lostText(0.996), "0.004");
    EXPECT_EQ(sim::lostText(0.0), "1");
    EXPECT_EQ(sim::lostText(1.0), "0");
    for (int n = 1; n < 5000; ++n) {
        const double kept = 1.0e-4 * n;
        EXPECT_NEAR(1.0 - std::stod(sim::lostText(kept)), kept, 6.0e-17);
    }
}

}  // namespace
