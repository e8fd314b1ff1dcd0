#include "tests/app/import/imported.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>

namespace app {
namespace {

using test::ownScene;
using ::testing::HasSubstr;

const std::string kHead =
    "<scene>\n<duration time=\"1\"/>\n<integrator type=\"linearized-implicit-euler\" dt=\"1e-3\"/>\n"
    "<ElasticParameters><youngsModulus value=\"1e6\"/></ElasticParameters>\n";

/// A file that is refused: the message, which is one line, and whether anything was left behind.
class Refused {
 public:
    explicit Refused(const std::string& content)
    {
        test::writeFile(folder_ / "bad.xml", content);
        try {
            importScene(folder_ / "bad.xml", folder_ / "bad.yaml", {}, drenchBackends());
        } catch (const sim::InputError& error) {
            message = error.what();
        }
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            if (entry.path().filename() != "bad.xml") leftBehind += entry.path().filename().string() + " ";
    }
    std::string message, leftBehind;

 private:
    test::TemporaryFolder folder_;
};

/// The import of the text is refused at that line of it with these words.
void expectRefused(const std::string& content, int line, const std::string& words)
{
    const Refused refused(content);
    EXPECT_THAT(refused.message, HasSubstr(fmt::format("bad.xml:{}: ", line)));
    EXPECT_THAT(refused.message, HasSubstr(words));
    EXPECT_EQ(refused.message.find('\n'), std::string::npos) << refused.message;
    EXPECT_EQ(refused.leftBehind, "");
}

std::string inScene(const std::string& lines) { return kHead + lines + "\n</scene>\n"; }

std::string utf16(const std::string& text)
{
    std::string out = "\xff\xfe";
    for (const char c : text) out += {c, '\0'};
    return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) { return text.replace(text.find(what), what.size(), by); }

TEST(BadImport, NoFile)
{
    test::TemporaryFolder folder;
    EXPECT_THROW(importScene(folder / "none.xml", folder / "none.yaml", {}, drenchBackends()), sim::InputError);
    EXPECT_THROW(importScene(folder.path(), folder / "none.yaml", {}, drenchBackends()), sim::InputError);
    EXPECT_THROW(importScene(ownScene("odd"), folder / "no" / "folder.yaml", {}, drenchBackends()), sim::InputError);
    const std::string sheet = test::contentOf(ownScene("sheet"));
    test::writeFile(folder / "scene.xml", sheet);
    EXPECT_THROW(importScene(folder / "scene.xml", folder / "scene.xml", {}, drenchBackends()), sim::InputError);
    EXPECT_EQ(test::contentOf(folder / "scene.xml"), sheet) << "it does not write over what it reads";
}

TEST(BadImport, NotXml)
{
    expectRefused("drench: 1\nscene: {name: drop}\n", 1, "is no XML");
    expectRefused("", 1, "is empty");
    expectRefused(" \n\n", 1, "is empty");
    expectRefused("<html><body/></html>\n", 1, "its root is \"html\"");
    expectRefused(std::string("\x7f"
                              "ELF\0\0\0",
                              7),
                  1, "zero bytes");
    expectRefused(inScene("<particle x=\"0 0 0\">"), 6, "well-formed");
    expectRefused(inScene("") + "<scene/>", 7, "something follows");
}

TEST(BadImport, Truncated)
{
    const std::string whole = test::contentOf(ownScene("sheet"));
    for (std::size_t length = 150; length < whole.size() - 10; length += 97) {
        const Refused refused(whole.substr(0, length));
        EXPECT_THAT(refused.message, HasSubstr("bad.xml:")) << length;
        EXPECT_EQ(refused.leftBehind, "") << length;
    }
    const std::string half = whole.substr(0, whole.find("<particle", whole.size() / 2) + 14);
    expectRefused(half, static_cast<int>(std::ranges::count(half, '\n')) + 1, "the file is cut off");
}

TEST(BadImport, OtherEncodings)
{
    const std::string whole = inScene("<particle x=\"0 0 0\"/>");
    expectRefused(utf16(whole), 1, "UTF-16");
    expectRefused(utf16(whole).substr(2), 1, "UTF-16");
    expectRefused(inScene("<description text=\"K\xf6nig\"/>"), 5, "no UTF-8");
}

TEST(BadImport, DeepNesting)
{
    std::string deep = "<scene>\n";
    for (int i = 0; i < 100'000; ++i) deep += "<a>";
    expectRefused(deep, 2, "cut off");
    for (int i = 0; i < 100'000; ++i) deep += "</a>";
    expectRefused(deep + "</scene>", 2, "deep in one another");
}

TEST(BadImport, EntityBomb)
{
    std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE scene [<!ENTITY a0 \"ha\">";
    for (int i = 1; i < 10; ++i) bomb += fmt::format("<!ENTITY a{0} \"&a{1};&a{1};&a{1};&a{1};&a{1};&a{1};&a{1};&a{1};&a{1};&a{1};\">", i, i - 1);
    bomb += "]>\n<scene><description text=\"&a9;\"/></scene>";
    const auto start = std::chrono::steady_clock::now();
    expectRefused(bomb, 2, "DOCTYPE");
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.0);
}

TEST(BadImport, AbsurdCounts)
{
    const std::string particles = "<particle x=\"0 0 0\"/><particle x=\"1 0 0\"/>\n";
    expectRefused(inScene(particles + "<hair params=\"0\" start=\"0\" count=\"1000000000000\"/>"), 6, "hair@count names particle 999999999999");
    expectRefused(inScene("<hair params=\"0\" start=\"0\" count=\"1000000000000\"/>"), 5, "the file has no particles");
    expectRefused(inScene("<bucketinfo size=\"1\" numcells=\"1000000000000\"/>"), 5, "bucketinfo@numcells");
    expectRefused(inScene("<bucketinfo size=\"1e-9\"/>\n<distancefield usage=\"source\" type=\"sphere\" cx=\"0\" "
                          "cy=\"0\" cz=\"0\" radius=\"1\"/>"),
                  6, "particles");
    expectRefused(inScene(particles + "<hair params=\"0\" start=\"0\" count=\"-3\"/>"), 6, "whole numbers");
    std::string hairs = "<particle x=\"0 0 0\"/>";
    for (int i = 1; i < 2000; ++i) hairs += fmt::format("<particle x=\"{} 0 0\"/>", i);
    for (int i = 0; i < 20'000; ++i) hairs += "<hair params=\"0\" start=\"0\" count=\"2000\"/>";
    expectRefused(inScene(hairs), 5, "points together");
    std::string fields;
    for (int i = 0; i < 10'001; ++i) fields += "<distancefield type=\"sphere\" cx=\"0\" cy=\"0\" cz=\"0\" radius=\"1\"/>";
    expectRefused(inScene(fields), 5, "more than 10000");
}

TEST(BadImport, NumbersThatAreNone)
{
    expectRefused(inScene("<particle x=\"0 nan 0\"/>"), 5, "\"nan\" is no number");
    expectRefused(inScene("<particle x=\"0 inf 0\"/>"), 5, "\"inf\" is no number");
    expectRefused(inScene("<particle x=\"0 1e999 0\"/>"), 5, "\"1e999\" is no number");
    expectRefused(inScene("<particle x=\"0 1e-3abc 0\"/>"), 5, "\"1e-3abc\" is no number");
    expectRefused(inScene("<particle x=\"0 1\"/>"), 5, "needs three numbers");
    expectRefused(inScene("<particle v=\"0 0 0\"/>"), 5, "particle@x is missing");
    expectRefused(inScene("<liquidinfo>\n<viscosity/></liquidinfo>"), 6, "viscosity@value is missing");
    expectRefused(inScene("<liquidinfo><surfTension value=\"maybe\"/></liquidinfo>"), 5, "neither 0 nor 1");
    expectRefused(inScene("<distancefield type=\"sphere\" cx=\"0\" cy=\"0\" radius=\"1\"/>"), 5, "distancefield@cz is missing");
    expectRefused(replaced(inScene(""), "dt=\"1e-3\"", "dt=\"0\""), 3, "integrator@dt must be above 0");
    expectRefused("<scene>\n<duration time=\"1\"/></scene>", 1, "has no <integrator");
    expectRefused("<scene>\n</scene>", 1, "has no <duration");
}

TEST(BadImport, ParticlesAndMaterialsThatAreNotThere)
{
    const std::string particles = "<particle x=\"0 0 0\"/><particle x=\"1 0 0\"/><particle x=\"0 1 0\"/>\n";
    expectRefused(inScene(particles + "<cloth params=\"0\">\n<face i=\"0 1 3\"/></cloth>"), 7, "names particle 3, but the file has 0 to 2 only");
    expectRefused(inScene(particles + "<cloth params=\"0\">\n<face i=\"0 1 1\"/></cloth>"), 7, "names a particle twice");
    expectRefused(inScene(particles + "<cloth params=\"0\">\n<face i=\"0 1\"/></cloth>"), 7, "needs three numbers");
    expectRefused(inScene(particles + "<cloth params=\"1\"><face i=\"0 1 2\"/></cloth>"), 6, "there is no material 1");
    expectRefused(inScene(particles + "<hair params=\"0\" start=\"2\" count=\"2\"/>"), 6, "names particle 3");
    expectRefused(inScene(particles + "<hair params=\"0\"><p i=\"0\"/>\n<p i=\"-1\"/></hair>"), 7, "names particle -1");
    expectRefused(inScene(particles + "<hair params=\"0\" start=\"0\" count=\"1\"/>"), 6, "no edge");
    expectRefused(inScene("<distancefield usage=\"solid\" type=\"union\" i=\"0 1\"/>"), 5, "no earlier field 0");
}

TEST(BadImport, WhatTheSceneReaderRefusesIsToldWithTheLineOfTheXml)
{
    expectRefused(inScene("\n<liquidinfo><liquidDensity value=\"-1\"/></liquidinfo>\n<distancefield usage=\"source\" "
                          "type=\"sphere\" cx=\"0\" cy=\"0\" cz=\"0\" radius=\"1\"/>"),
                  6, "liquid.density");
    expectRefused(inScene("<distancefield usage=\"source\" type=\"sphere\" cx=\"0\" cy=\"0\" cz=\"0\" radius=\"1\"/>\n"
                          "<distancefield usage=\"solid\" type=\"sphere\" cx=\"0\" cy=\"0\" cz=\"0\" radius=\"2\"/>"),
                  5, "is empty");
    expectRefused(inScene(""), 1, "at least one source");
}

}  // namespace
}  // namespace app
