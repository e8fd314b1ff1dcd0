#include "tests/sim/scene/loads_or_rejects.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>

namespace {

std::string textOf(const std::string& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// A few random edits: bytes changed, inserted, removed, stretches copied elsewhere.
std::string mutated(std::string text, std::mt19937& random)
{
    static const std::string kBytes = "{}[]:,-#&*!|>'\"%@`?~ \n\t.0123456789einfax_/^=";
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1)); };
    const int edits = 1 + static_cast<int>(below(6));
    for (int i = 0; i < edits; ++i) {
        const std::size_t at = below(text.size());
        const char byte = below(10) == 0 ? static_cast<char>(below(256)) : kBytes[below(kBytes.size())];
        switch (below(5)) {
            case 0: text[at] = byte; break;
            case 1: text.insert(at, 1, byte); break;
            case 2: text.erase(at, 1 + below(20)); break;
            case 3: text.insert(below(text.size()), text.substr(at, below(60))); break;
            default: text.insert(at, std::string(1 + below(4), byte)); break;
        }
    }
    return text;
}

/// Anything else than loading or one line fails the test. True if it loaded.
bool loadsOrComplains(const std::string& text)
{
    try {
        return test::loadsOrComplains(text, "mutated.yaml");
    } catch (const std::exception& error) {
        ADD_FAILURE() << error.what() << "\n" << text;
        return false;
    }
}

TEST(MutatedScenes, LoadOrGiveOneLine)
{
    const std::string drop = textOf(std::string(SCENES_DIR) + "/drop.yaml");
    const std::string dam = textOf(std::string(SCENES_DIR) + "/dam_break_small.yaml");
    ASSERT_FALSE(drop.empty());
    ASSERT_FALSE(dam.empty());
    std::mt19937 random(1);
    int loaded = 0, refused = 0;
    for (int i = 0; i < 3000; ++i) ++(loadsOrComplains(mutated(i % 2 == 0 ? drop : dam, random)) ? loaded : refused);
    EXPECT_GT(loaded, 100) << "the edits are too wild to reach the later checks";
    EXPECT_GT(refused, 1000);
}

TEST(MutatedScenes, CutAnywhereGiveOneLine)
{
    const std::string drop = textOf(std::string(SCENES_DIR) + "/drop.yaml");
    for (std::size_t length = 0; length < drop.size(); length += 3) loadsOrComplains(drop.substr(0, length));
}

}  // namespace
