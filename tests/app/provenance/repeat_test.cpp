// What results say of how they were made, and runs that are made again from it, by the program itself.

#include "app/checkpoint/checkpoint.h"
#include "app/checkpoint/state_files.h"
#include "tests/app/checkpoint/small_scene.h"

#include <algorithm>
#include <map>

namespace app::test {
namespace {

using nlohmann::json;

class Repeat : public testing::Test, protected SmallRuns {
 protected:
    ChildExit again(const std::string& report, std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(), {"run", "--again", report, "--no-video", "--no-frames"});
        return drench(more);
    }
    /// Of a run in `name`, of which nothing but the report is left.
    ChildExit againFromReportAlone(const std::string& name, const std::vector<std::string>& more = {}) const
    {
        const std::string report = contentOf(folder / name / "report.json");
        std::filesystem::remove_all(folder / name);
        std::filesystem::remove_all(folder / "alone");
        std::filesystem::create_directory(folder / "alone");
        writeFile(folder / "alone" / "report.json", report);
        return again("alone/report.json", more);
    }
    void rewriteReport(const std::string& name, const std::function<void(json&)>& change) const
    {
        json changed = report(name);
        change(changed);
        writeFile(folder / name / "report.json", changed.dump());
    }
};

/// Keywords and texts of a PNG, read by the format's description: chunks of length, type, content and checksum.
std::map<std::string, std::string> pngTexts(const std::string& png)
{
    std::map<std::string, std::string> texts;
    for (std::size_t at = 8; at + 12 <= png.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = 256 * length + static_cast<unsigned char>(png[at + i]);
        const std::string content = png.substr(at + 8, length);
        if (png.compare(at + 4, 4, "tEXt") == 0) texts[content.substr(0, content.find('\0'))] = content.substr(content.find('\0') + 1);
        at += length + 12;
    }
    return texts;
}

/// With overrides, with an included file, as a variant, stopped and gone on with, branched off with other settings.
TEST_F(Repeat, EndsInTheSameStateHoweverTheRunWasMade)
{
    writeFile(folder / "other.yaml", "drench: 1\ninclude: small.yaml\nscene: {name: other}\nliquid: {viscosity: 0.5}\n");
    ASSERT_EQ(run("plain").code, 0);
    ASSERT_EQ(run("overrides", {"--set", "gravity=[0, -500, 0]", "--set", "grid.cell=0.35"}).code, 0);
    ASSERT_EQ(run("variant", {"--variant", "4"}).code, 0);
    ASSERT_EQ(drench({"run", "other.yaml", "--no-frames", "--out", "included"}).code, 0);
    ASSERT_EQ(run("resumed", {"--set", "time.duration=0.041"}).code, 0);
    ASSERT_EQ(resume("resumed", {"--set", "time.duration=0.08"}).code, 0);
    ASSERT_EQ(resume("plain", {"--from-frame", "10", "--out", "branch", "--set", "gravity=[100, 0, 0]"}).code, 0);
    EXPECT_EQ(report("resumed").at("provenance").at("made_from").at("scene").at("overrides"), json({"time.duration=0.041"}));
    EXPECT_NE(hash("plain"), hash("overrides"));
    EXPECT_EQ(hash("plain"), hash("resumed"));
    for (const char* name : {"plain", "overrides", "variant", "included", "resumed", "branch"}) {
        const std::string expected = hash(name);
        const ChildExit end = againFromReportAlone(name, {"--threads", "2"});
        EXPECT_EQ(end.code, 0) << name << ": " << end.errorText;
        EXPECT_EQ(hash("alone/again"), expected) << name;
    }
}

TEST_F(Repeat, EndsWithOneWhereTheStateIsAnother)
{
    ASSERT_EQ(run("run").code, 0);
    rewriteReport("run", [](json& report) {
        std::string& scene = report["provenance"]["scene"]["resolved"].get_ref<std::string&>();
        scene.replace(scene.find("-981"), 4, "-980");
    });
    EXPECT_EQ(again("run").code, 1);
    EXPECT_EQ(report("run/again").at("status"), "done");
}

TEST_F(Repeat, RefusesWhatCannotBeRepeatedAndLeavesNothing)
{
    ASSERT_EQ(run("run").code, 0);
    const std::string whole = contentOf(folder / "run" / "report.json");
    const auto refused = [&](const std::string& mentions, const std::vector<std::string>& more = {}) {
        const ChildExit end = again("run", more);
        EXPECT_EQ(end.code, 2) << mentions;
        EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
        EXPECT_NE(end.errorText.find(mentions), std::string::npos) << end.errorText;
        EXPECT_FALSE(std::filesystem::exists(folder / "run" / "again")) << mentions;
    };
    refused("--set", {"--set", "time.duration=1"});
    refused("--variant", {"--variant", "4"});
    refused("choose another folder", {"--out", "run"});
    rewriteReport("run", [](json& report) { report["status"] = "interrupted"; });
    refused("only a run that is done");
    for (const char* key : {"provenance", "state_hash", "label"}) {
        writeFile(folder / "run" / "report.json", whole);
        rewriteReport("run", [&](json& report) { report.erase(key); });
        refused("version");
    }
    for (std::size_t size = 0; size < whole.size(); size += 500) {
        writeFile(folder / "run" / "report.json", whole.substr(0, size));
        refused("no report of a run");
    }
    std::filesystem::remove(folder / "run" / "report.json");
    refused("there is no such file");
}

TEST_F(Repeat, EveryResultSaysOfWhatItWasMade)
{
    const std::string data = "output.data=[energy, states, checkpoint, geometry]";
    ASSERT_EQ(run("run", {"--set", data, "--set", "output.geometry_format=[vtp, ply, obj, usda]"}).code, 0);
    const json made = report("run").at("provenance");
    for (const char* key : {"version", "commit", "compiler", "flags", "processor", "command", "started"}) EXPECT_NE(made.at(key), "") << key;
    EXPECT_EQ(made.at("scene").at("texts").at("small.yaml"), kSmallScene);
    EXPECT_EQ(made.at("scene").at("overrides").at(0), data);
    EXPECT_EQ(made.at("scene").at("resolved"), contentOf(folder / "run" / "resolved.yaml"));
    EXPECT_NE(made.at("libraries").at("opengl").get<std::string>().find("Mesa"), std::string::npos);
    EXPECT_NE(made.at("command").get<std::string>().find("run small.yaml --no-video"), std::string::npos);
    EXPECT_EQ(json::parse(contentOf(folder / "run" / "geometry" / "provenance.json")), made);
    for (const StateKind kind : {StateKind::ForPictures, StateKind::ForResuming})
        for (const std::int64_t frame : storedFrames(folder / "run", kind))
            EXPECT_EQ(json::parse(loadCheckpoint(stateFile(folder / "run", kind, frame)).origin.provenance), made) << frame;
    const std::string program = "Drench " + made.at("version").get<std::string>() + " (" + made.at("commit").get<std::string>() + ")";
    for (const char* file : {"liquid_00003.vtp", "liquid.pvd", "cloth_00003.ply", "frame_00003.obj", "frame_00003.usda"})
        EXPECT_NE(contentOf(folder / "run" / "geometry" / file).find(program), std::string::npos) << file;
    for (const std::int64_t frame : {0, 4, 20}) {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%05d.png", static_cast<int>(frame));
        const auto texts = pngTexts(contentOf(folder / "run" / name));
        EXPECT_EQ(texts.at("Software"), program);
        EXPECT_EQ(texts.at("Scene"), "small");
        EXPECT_NEAR(std::stod(texts.at("Time")), 4.0e-3 * static_cast<double>(frame), 1e-9);
        EXPECT_EQ(texts.at("State hash"), hexDigits(loadCheckpoint(stateFile(folder / "run", StateKind::ForPictures, frame)).origin.stateHash));
    }
    EXPECT_EQ(pngTexts(contentOf(folder / "run" / "frame_00020.png")).at("State hash"), hash("run"));
}

/// The script that tells the commit, called as the build does.
class BuildInfoFile : public testing::Test {
 protected:
    std::string commitIn(const std::filesystem::path& source) const
    {
        const ChildExit end = runChild(*findProgram("cmake"), {"-D", "SOURCE=" + source.string(), "-D", "OUT=" + out().string(), "-D",
                                                               "COMPILER=c++ 1", "-D", "FLAGS=-O3 -DA=\"b\"", "-P", BUILD_INFO_SCRIPT});
        EXPECT_EQ(end.code, 0) << end.errorText;
        const std::string text = contentOf(out());
        EXPECT_NE(text.find("R\"(-O3 -DA=\"b\")\""), std::string::npos) << text;
        const std::size_t begin = text.find("R\"(") + 3;
        return text.substr(begin, text.find(")\"") - begin);
    }
    bool git(const std::vector<std::string>& arguments) const
    {
        std::vector<std::string> all = {"-c", "user.name=a", "-c", "user.email=a@b"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        return runChild(*findProgram("git"), all, {.folder = source()}).ok();
    }
    std::filesystem::path source() const { return folder / "source"; }
    std::filesystem::path out() const { return folder / "build_info.cpp"; }
    TemporaryFolder folder;
};

TEST_F(BuildInfoFile, TellsTheCommitAndIsWrittenOnlyWhenThatChanges)
{
    if (!findProgram("git")) GTEST_SKIP() << "no git here";
    std::filesystem::create_directories(source() / "below");
    writeFile(source() / "file", "1");
    EXPECT_EQ(commitIn(source()), "unknown") << "no repository";
    ASSERT_TRUE(git({"init", "-q"}));
    EXPECT_EQ(commitIn(source()), "unknown") << "no commit";
    ASSERT_TRUE(git({"add", "file"}) && git({"commit", "-q", "-m", "one"}));
    const std::string commit = commitIn(source());
    EXPECT_EQ(commit.size(), 40u);
    EXPECT_EQ(commitIn(source() / "below"), "unknown") << "unpacked within another repository";
    commitIn(source());
    const auto written = std::filesystem::last_write_time(out()) - std::chrono::hours(1);
    std::filesystem::last_write_time(out(), written);
    EXPECT_EQ(commitIn(source()), commit);
    EXPECT_EQ(std::filesystem::last_write_time(out()), written);
    writeFile(source() / "file", "2");
    EXPECT_EQ(commitIn(source()), commit + "+changes");
    EXPECT_NE(std::filesystem::last_write_time(out()), written);
}

}  // namespace
}  // namespace app::test
