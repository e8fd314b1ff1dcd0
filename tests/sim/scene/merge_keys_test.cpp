// YAML's merge key <<: a map that has the keys of others, too.

#include "sim/core/check.h"
#include "sim/scene/node.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

namespace {

using sim::Node;
using Map = std::map<std::string, std::string>;

Node parse(const std::string& text)
{
    auto source = std::make_shared<sim::TextSource>();
    source->name = "merge.yaml";
    return sim::parseYaml(text, source);
}

std::string numbered(std::string word, int number) { return word.append(std::to_string(number)); }

std::string flow(const Map& map)
{
    std::string text;
    for (const auto& [key, value] : map) text += (text.empty() ? "" : ", ") + key + ": " + value;
    return "{" + text + "}";
}

Map mapOf(const Node& node)
{
    Map map;
    for (std::size_t i = 0; i < node.keys.size(); ++i) map[node.keys[i]] = node.items[i].text;
    EXPECT_EQ(map.size(), node.keys.size()) << "a key twice";
    return map;
}

/// The map's own keys go before those merged, wherever << stands; of those merged the first map's.
TEST(MergeKeys, GiveAMapTheKeysThatItHasNot)
{
    std::mt19937 random(1);
    const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n + 1)); };
    for (int trial = 0; trial < 300; ++trial) {
        const auto dice = [&](const std::string& owner) {
            Map map;
            for (int i = upTo(4); i > 0; --i) map[numbered("k", upTo(5))] = numbered(owner, upTo(9));
            return map;
        };
        std::vector<Map> bases(1 + static_cast<std::size_t>(upTo(3)));
        std::string text, names;
        for (std::size_t b = 0; b < bases.size(); ++b) {
            bases[b] = dice(numbered("base", static_cast<int>(b)));
            const std::string name = numbered("b", static_cast<int>(b));
            text += name + ": &" + name + " " + flow(bases[b]) + "\n";
            names += (b > 0 ? ", *" : "*") + name;
        }
        const Map before = dice("own_");
        Map after = dice("own_");
        for (const auto& [key, value] : before) after.erase(key);
        const std::string merge = bases.size() == 1 && upTo(1) == 0 ? "*b0" : "[" + names + "]";
        text += "all:\n";
        for (const auto& [key, value] : before) text += "  " + key + ": " + value + "\n";
        text += "  <<: " + merge + "\n";
        for (const auto& [key, value] : after) text += "  " + key + ": " + value + "\n";
        Map expected = before;
        expected.insert(after.begin(), after.end());
        for (const Map& base : bases) expected.insert(base.begin(), base.end());
        const Node root = parse(text);
        EXPECT_EQ(mapOf(*root.find("all")), expected) << text;
        for (std::size_t b = 0; b < bases.size(); ++b)
            EXPECT_EQ(mapOf(*root.find(numbered("b", static_cast<int>(b)))), bases[b]) << "left as it is\n" << text;
    }
}

TEST(MergeKeys, ThatMergeNoMapsAreRefusedWithTheirLine)
{
    for (const char* value : {"3", "word", "[1]", "[{a: 1}, 2]", "[[{a: 1}]]", ""}) {
        try {
            parse(std::string("a: 1\n<<: ") + value + "\n");
            ADD_FAILURE() << value;
        } catch (const sim::InputError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with("merge.yaml:2: << merges maps")) << error.what();
        }
    }
}

}  // namespace
