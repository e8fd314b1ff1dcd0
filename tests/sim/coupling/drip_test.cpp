#include "sim/coupling/drip.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

constexpr double kDrop = 2.0e-4;  // g

struct Towel {
    explicit Towel(const FabricPiece& piece)
        : settings(coarse()), fabric(testing::fabricOf(piece)), elements(fabric), drip(fabric, elements, settings, kDrop)
    {
        state.fabric = restState(fabric);
        state.liquid.modeCount = 8;
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
            state.fabric.v[v] = Vec3(std::sin(1.0 + static_cast<double>(v)), 2.0, std::cos(2.0 * static_cast<double>(v)));
            state.fabric.absorbed[v] = poreVolume(fabric, v);
        }
    }
    static Settings coarse()
    {
        Settings settings;
        settings.cell = 1.0;
        return settings;
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
    PorousElements elements;
    Drip drip;
    State state;
};

/// Vertices of one cell pool what they have too much: it comes off in drops of about a particle each.
TEST(Drip, ReleasesWhatVerticesPool)
{
    for (const int count : {1, 4, 5}) {
        Towel towel(testing::pieceOf(strand(Vec3(0.01, 0.01, 0.01), Vec3(0.3, 0.1, 0.01), 1), testing::wool(), {0.05, 0.03}));
        towel.state.fabric.absorbed[0] += (count - 0.2) * kDrop;
        towel.state.fabric.absorbed[1] += 0.3 * kDrop;
        const Towel::Sums before = towel.sums();
        EXPECT_NEAR(towel.drip.drip(towel.state, {}), (count + 0.1) * kDrop, 1.0e-15);
        EXPECT_EQ(towel.state.liquid.count, static_cast<std::size_t>(count));
        EXPECT_EQ(towel.state.nextId, static_cast<std::uint32_t>(count));
        const Towel::Sums after = towel.sums();
        EXPECT_NEAR(after.mass, before.mass, 1.0e-13 * before.mass);
        EXPECT_LT((after.moment - before.moment).norm(), 1.0e-13 * before.moment.norm());
        EXPECT_LT((after.momentum - before.momentum).norm(), 1.0e-13 * before.momentum.norm());
        EXPECT_EQ(towel.drip.drip(towel.state, {}), 0.0);  // nothing is left
    }
}

/// However large particles are against the pores, no pore holds more than kMostOver beside what it can: drops are as small as that asks for.
TEST(Drip, LeavesNoPoreOverfull)
{
    for (const double share : {0.5, 0.02, 5.0e-3}) {  // of what the pores of a vertex hold, in particles
        Towel towel(testing::pieceOf(clothGrid({{7, 7}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
        Settings settings;
        settings.cell = 0.5;
        const double nominal = poreVolume(towel.fabric, 24) / share;
        Drip drip(towel.fabric, towel.elements, settings, nominal);
        testing::Noise noise(5);
        for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) towel.state.fabric.absorbed[v] *= 1.0 + 0.2 * std::abs(noise());
        const Towel::Sums before = towel.sums();
        EXPECT_GT(drip.drip(towel.state, {}), 0.0);
        const Towel::Sums after = towel.sums();
        EXPECT_NEAR(after.mass, before.mass, 1.0e-13 * before.mass);
        EXPECT_LT((after.moment - before.moment).norm(), 1.0e-13 * before.moment.norm());
        EXPECT_LT((after.momentum - before.momentum).norm(), 1.0e-13 * before.momentum.norm());
        for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v)
            EXPECT_LE(towel.state.fabric.absorbed[v], (1.0 + Drip::kMostOver) * poreVolume(towel.fabric, v) * (1.0 + 1.0e-12));
        EXPECT_LE(towel.state.liquid.count, 9u);  // the cells of the cloth, each a pool
    }
}

TEST(Drip, ClothDripsFromItsFaces)
{
    Towel towel(testing::pieceOf(clothGrid({{7, 7}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
    for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) towel.state.fabric.absorbed[v] += 3.3 * kDrop * static_cast<double>(v % 3);
    const Towel::Sums before = towel.sums();
    const double dripped = towel.drip.drip(towel.state, {});
    EXPECT_GT(dripped, 30.0 * kDrop);
    const Towel::Sums after = towel.sums();
    EXPECT_NEAR(after.mass, before.mass, 1.0e-13 * before.mass);
    EXPECT_LT((after.moment - before.moment).norm(), 1.0e-13 * before.moment.norm());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1.0e-13 * before.momentum.norm());
    // What stays is less than a particle of each cell.
    double excess = 0.0;
    for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) {
        EXPECT_GE(towel.state.fabric.absorbed[v], poreVolume(towel.fabric, v) * (1.0 - 1.0e-12));
        excess += towel.state.fabric.absorbed[v] - poreVolume(towel.fabric, v);
    }
    EXPECT_LT(excess, kDrop);
    for (std::size_t p = 0; p < towel.state.liquid.count; ++p)  // in the plane of the cloth, within it
        EXPECT_TRUE(std::abs(towel.state.liquid.position(p).y()) < 1.0e-12 || std::abs(towel.state.liquid.position(p).z()) < 1.0e-12);
}

/// Cloth that nearly touches the walls of a box on all sides, each vertex a pool of its own.
TEST(Drip, NoDropComesOffWithinASolid)
{
    Towel towel(testing::pieceOf(clothGrid({{7, 7}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
    Settings settings = Towel::coarse();
    settings.cell = 0.1;
    Drip drip(towel.fabric, towel.elements, settings, kDrop);
    Eigen::AlignedBox3d box;
    for (const Vec3& x : towel.state.fabric.x) box.extend(x);
    Obstacles obstacles;
    obstacles.add(Shape::box(box.center(), 0.5 * box.sizes() + Vec3::Constant(0.005)).inverted(), {});
    const Towel::Sums start = towel.sums();
    double added = 0.0;
    for (int step = 0; step < 20; ++step) {
        towel.state.step = step;
        for (std::size_t v = 0; v < towel.fabric.vertexCount(); ++v) {
            const double more = kDrop * static_cast<double>((7 * v + 3 * static_cast<std::size_t>(step)) % 5);
            towel.state.fabric.absorbed[v] += more;
            added += more;
        }
        EXPECT_GT(drip.drip(towel.state, obstacles), 0.0);
    }
    EXPECT_NEAR(towel.sums().mass, start.mass + added, 1.0e-12 * added);
    Obstacles everywhere;
    everywhere.add(Shape::ball(box.center(), 10.0), {});
    towel.state.fabric.absorbed[0] += 10.0 * kDrop;
    EXPECT_EQ(drip.drip(towel.state, everywhere), 0.0);
    for (std::size_t p = 0; p < towel.state.liquid.count; ++p) EXPECT_GE(obstacles.distance(towel.state.liquid.position(p)), 0.0);
}

TEST(Drip, FullFabricKeepsWhatItHolds)
{
    Towel towel(testing::pieceOf(clothGrid({{5, 5}, {0.144, 0.144}, Vec3::Zero()}), testing::wool(), {0.017, 0.017}));
    EXPECT_EQ(towel.drip.drip(towel.state, {}), 0.0);
    EXPECT_EQ(towel.state.liquid.count, 0u);
}

}  // namespace
}  // namespace sim::test
