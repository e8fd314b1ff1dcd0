#include "sim/coupling/drip.h"
#include "sim/fabric/generators.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

constexpr double kDrop = 2.0e-4;  // g

struct Towel {
    explicit Towel(const FabricPiece& piece) : fabric(testing::fabricOf(piece)), elements(fabric), drip(fabric, elements, settings, kDrop)
    {
        state.fabric = restState(fabric);
        state.liquid.modeCount = 8;
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
            state.fabric.v[v] = Vec3(std::sin(1.0 + static_cast<double>(v)), 2.0, std::cos(2.0 * static_cast<double>(v)));
            state.fabric.absorbed[v] = poreVolume(fabric, v);
        }
    }
    struct Sums {
        double mass = 0.0;
        Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();
    };
    Sums sums() const
    {
        Sums sum;
        const auto add = [&](double m, const Vec3& x, const Vec3& v) { sum.mass += m, sum.moment += m * x, sum.momentum += m * v; };
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) add(state.fabric.absorbed[v], state.fabric.x[v], state.fabric.v[v]);
        for (std::size_t p = 0; p < state.liquid.count; ++p) add(state.liquid.mass[p], state.liquid.position(p), state.liquid.velocity(p));
        return sum;
    }

    Settings settings;
    Fabric fabric;
    WetElements elements;
    Drip drip;
    State state;
};

/// Model-fluid E4: an element that holds n particles too many releases exactly n.
TEST(Drip, ReleasesWholeParticles)
{
    for (const int count : {1, 4, 5}) {
        Towel towel(testing::pieceOf(strand(Vec3::Zero(), Vec3(0.3, 0.1, 0.0), 1), testing::wool(), {0.05, 0.03}));
        towel.state.fabric.absorbed[0] += (count - 0.2) * kDrop;
        towel.state.fabric.absorbed[1] += 0.7 * kDrop;
        const Towel::Sums before = towel.sums();
        EXPECT_NEAR(towel.drip.drip(towel.state), count * kDrop, 1.0e-15);
        EXPECT_EQ(towel.state.liquid.count, static_cast<std::size_t>(count));
        EXPECT_EQ(towel.state.nextId, static_cast<std::uint32_t>(count));
        const Towel::Sums after = towel.sums();
        EXPECT_NEAR(after.mass, before.mass, 1.0e-13 * before.mass);
        EXPECT_LT((after.moment - before.moment).norm(), 1.0e-13 * before.moment.norm());
        EXPECT_LT((after.momentum - before.momentum).norm(), 1.0e-13 * before.momentum.norm());
        EXPECT_EQ(towel.drip.drip(towel.state), 0.0);  // half a particle stays
    }
}

TEST(Drip, ClothDripsFromItsFaces)
{
    Towel towel(testing::pieceOf(clothGrid({{7, 7}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
    for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) towel.state.fabric.absorbed[v] += 3.3 * kDrop * static_cast<double>(v % 3);
    const Towel::Sums before = towel.sums();
    const double dripped = towel.drip.drip(towel.state);
    EXPECT_GT(dripped, 30.0 * kDrop);
    const Towel::Sums after = towel.sums();
    EXPECT_NEAR(after.mass, before.mass, 1.0e-13 * before.mass);
    EXPECT_LT((after.moment - before.moment).norm(), 1.0e-13 * before.moment.norm());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1.0e-13 * before.momentum.norm());
    // What stays is less than a particle of each element.
    double excess = 0.0;
    for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) {
        EXPECT_GE(towel.state.fabric.absorbed[v], poreVolume(towel.fabric, v) * (1.0 - 1.0e-12));
        excess += towel.state.fabric.absorbed[v] - poreVolume(towel.fabric, v);
    }
    EXPECT_LT(excess, kDrop * static_cast<double>(towel.elements.size()));
    for (std::size_t p = 0; p < towel.state.liquid.count; ++p)  // in the plane of the cloth, within it
        EXPECT_TRUE(std::abs(towel.state.liquid.position(p).y()) < 1.0e-12 || std::abs(towel.state.liquid.position(p).z()) < 1.0e-12);
}

TEST(Drip, FullFabricKeepsWhatItHolds)
{
    Towel towel(testing::pieceOf(clothGrid({{5, 5}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
    EXPECT_EQ(towel.drip.drip(towel.state), 0.0);
    EXPECT_EQ(towel.state.liquid.count, 0u);
}

}  // namespace
}  // namespace sim::test
