// What the runs of an ensemble set.
#include "app/ensemble/vary.h"
#include "sim/core/check.h"

#include <gtest/gtest.h>

#include <set>

namespace app::test {
namespace {

using Sets = std::vector<std::string>;

sim::Scene sceneWith(std::vector<sim::FillSettings::Pattern> patterns)
{
    sim::Scene scene;
    scene.file = "two.yaml";
    for (const auto pattern : patterns) scene.sources.emplace_back().fill = {.pattern = pattern, .seed = 5};
    return scene;
}

constexpr auto kLattice = sim::FillSettings::Pattern::Lattice, kPoisson = sim::FillSettings::Pattern::Poisson;

TEST(Vary, SeedIsOfSourcesThatHaveOne)
{
    const sim::Scene scene = sceneWith({kLattice, kPoisson});
    EXPECT_EQ(setsOfRun({readVary("seed")}, scene, 0), (Sets{"liquid.sources.1.fill.seed=5"}));
    EXPECT_EQ(setsOfRun({readVary("seed")}, scene, 3), (Sets{"liquid.sources.1.fill.seed=8"}));
    EXPECT_THROW(setsOfRun({readVary("seed")}, sceneWith({kLattice}), 0), sim::InputError);
    EXPECT_THROW(setsOfRun({readVary("seed")}, sceneWith({}), 0), sim::InputError);
}

TEST(Vary, PositionsAreOfAllSources)
{
    EXPECT_EQ(setsOfRun({readVary("positions")}, sceneWith({kLattice, kPoisson}), 2),
              (Sets{"liquid.sources.0.fill.pattern=jittered", "liquid.sources.0.fill.seed=7", "liquid.sources.1.fill.seed=7"}));
    EXPECT_THROW(setsOfRun({readVary("positions")}, sceneWith({}), 0), sim::InputError);
}

TEST(Vary, KeysAreDrawnFromTheirRangeEvenly)
{
    const std::vector<Vary> varied = {readVary("liquid.viscosity=0.5..1.5"), readVary("gravity.y=-1e3..-9.e2")};
    std::set<std::string> seen;
    double sum = 0.0;
    constexpr int kRuns = 1000;
    for (std::uint64_t n = 0; n < kRuns; ++n) {
        const Sets sets = setsOfRun(varied, sceneWith({}), n);
        ASSERT_EQ(sets.size(), 2u);
        ASSERT_TRUE(sets[0].starts_with("liquid.viscosity=")) << sets[0];
        const double x = std::stod(sets[0].substr(17)), y = std::stod(sets[1].substr(10));
        EXPECT_TRUE(x >= 0.5 && x <= 1.5) << x;
        EXPECT_TRUE(y >= -1000.0 && y <= -900.0) << y;
        EXPECT_GT(std::abs((x - 0.5) - (y + 1000.0) / 100.0), 1.0e-9) << "each is drawn for itself";
        sum += x;
        seen.insert(sets[0]);
    }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(kRuns));
    EXPECT_NEAR(sum / kRuns, 1.0, 4.0 / std::sqrt(12.0 * kRuns)) << "four deviations of the mean of even numbers";
    EXPECT_EQ(setsOfRun(varied, sceneWith({}), 7), setsOfRun(varied, sceneWith({}), 7));
}

TEST(Vary, MistakesAreTold)
{
    for (const char* text : {"", "sead", "liquid.viscosity", "liquid.viscosity=1", "liquid.viscosity=2..1", "liquid.viscosity=1..1", "=1..2", "a=..2",
                             "a=1..", "a=1..2x", "a=1..nan", "a=1..inf"})
        EXPECT_THROW(readVary(text), sim::InputError) << text;
}

}  // namespace
}  // namespace app::test
