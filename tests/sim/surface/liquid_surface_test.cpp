#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/surface/bodies.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace sim::test {
namespace {

double volumeOf(const LiquidParticles& liquid)
{
    double mass = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p) mass += liquid.mass[p];
    return mass / kDensity;
}

TEST(LiquidSurface, IsClosedAndFacesOutwards)
{
    LiquidSurface surface;
    for (const Body& body : bodies()) {
        const SurfaceMesh& mesh = surface.find(body.liquid, kDensity);
        EXPECT_TRUE(isClosed(mesh)) << body.name;
        EXPECT_EQ(2, eulerCharacteristic(mesh)) << body.name;
        EXPECT_GT(enclosedVolume(mesh), 0.0) << body.name;
    }
}

TEST(LiquidSurface, EnclosesTheVolumeOfTheLiquid)
{
    LiquidSurface surface;
    for (const Body& body : bodies()) {
        const double volume = volumeOf(body.liquid);
        EXPECT_NEAR(volume, enclosedVolume(surface.find(body.liquid, kDensity)), 0.005 * volume) << body.name;
    }
}

TEST(LiquidSurface, EnclosesTheVolumeOfAFewParticles)
{
    LiquidSurface surface;
    LiquidParticles drop;
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}) {
        addAt(drop, kPitch * place + Vec3(0.013, 0.02, 0.05));
        const SurfaceMesh& mesh = surface.find(drop, kDensity);
        const double volume = volumeOf(drop);
        EXPECT_NEAR(volume, enclosedVolume(mesh), 0.02 * volume) << drop.count << " particles";
        EXPECT_TRUE(isClosed(mesh)) << drop.count << " particles";
        EXPECT_EQ(2, eulerCharacteristic(mesh)) << drop.count << " particles";
    }
}

/// Where a mean of places bridges everything: particles at random, a ninth as dense as bulk liquid. Between those that
/// are near to each other there are bridges, but the surface hardly needs to move for the volume.
TEST(LiquidSurface, EnclosesTheVolumeOfSpray)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 3.0);
    LiquidParticles spray;
    for (int p = 0; p < 3000; ++p) addAt(spray, {unit(random), unit(random), unit(random)});
    LiquidSurface surface;
    const SurfaceMesh& mesh = surface.find(spray, kDensity);
    EXPECT_NEAR(volumeOf(spray), enclosedVolume(mesh), 0.005 * volumeOf(spray));
    EXPECT_LT(std::abs(surface.offset()), 0.05);
    EXPECT_GT(eulerCharacteristic(mesh), 2 * 500) << "hundreds of drops";
    EXPECT_TRUE(isClosed(mesh));
}

/// A dam break that has run up the wall, with all that it throws around.
TEST(LiquidSurface, EnclosesTheVolumeOfASplash)
{
    Simulation simulation(coarseDamBreak(kPoly8));
    LiquidSurface surface;
    for (const double time : {0.15, 0.3}) {
        while (simulation.state().time < time) simulation.step(time);
        const LiquidParticles& liquid = simulation.state().liquid;
        const SurfaceMesh& mesh = surface.find(liquid, simulation.scene().settings.liquid.density);
        EXPECT_NEAR(surface.liquidVolume(), enclosedVolume(mesh), 0.02 * surface.liquidVolume()) << time << " s";
        EXPECT_TRUE(isClosed(mesh)) << time << " s";
        for (const Vec3& v : mesh.velocities) ASSERT_LT(v.norm(), 2000.0) << "faster than a fall of 20 m";
    }
}

/// Seeds that fill 58 % of their region: the surface would have to go deep into it.
TEST(LiquidSurface, MovesNoFartherThanHalfASpacing)
{
    LiquidParticles loose = ball(1.0);
    for (std::size_t p = 0; p < loose.count; ++p) loose.mass[p] *= 0.4;
    LiquidSurface surface;
    const SurfaceMesh& mesh = surface.find(loose, kDensity);
    EXPECT_LT(surface.offset(), -0.45);
    EXPECT_GT(enclosedVolume(mesh), 1.2 * volumeOf(loose));
    EXPECT_EQ(2, eulerCharacteristic(mesh));
}

/// Particles on spheres a pitch apart, at equal distances on each: a ball without the steps of a lattice.
LiquidParticles roundBall(int layers)
{
    LiquidParticles liquid;
    const double golden = kPi * (3.0 - std::sqrt(5.0));
    for (int layer = 0; layer < layers; ++layer) {
        const double radius = (layer + 0.5) * kPitch, inner = layer * kPitch, outer = (layer + 1) * kPitch;
        const int count = std::max(4, static_cast<int>(std::round(4.0 * kPi * radius * radius / (kPitch * kPitch))));
        const double volume = 4.0 / 3.0 * kPi * (std::pow(outer, 3) - std::pow(inner, 3)) / count;
        for (int n = 0; n < count; ++n) {
            const double z = 1.0 - (2.0 * n + 1.0) / count, s = std::sqrt(1.0 - z * z), angle = golden * n + layer;
            addAt(liquid, radius * Vec3(s * std::cos(angle), s * std::sin(angle), z), volume);
        }
    }
    return liquid;
}

TEST(LiquidSurface, OfABallIsItsSphere)
{
    LiquidSurface surface;
    const SurfaceMesh& mesh = surface.find(roundBall(10), kDensity);
    double squares = 0.0, largest = 0.0, turned = 0.0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const double off = mesh.positions[v].norm() / kPitch - 10.0;
        squares += off * off;
        largest = std::max(largest, std::abs(off));
        turned += 1.0 - mesh.normals[v].dot(mesh.positions[v].normalized());
    }
    const auto count = static_cast<double>(mesh.positions.size());
    std::printf("off the sphere by %.3f pitches (at most %.3f), normals by %.2f degrees\n", std::sqrt(squares / count), largest,
                180.0 / kPi * std::sqrt(2.0 * turned / count));
    // The volume is kept to 0.4 %, which is 0.013 pitches of the radius.
    EXPECT_LT(std::sqrt(squares / count), 0.02);
    EXPECT_LT(largest, 0.04);
    EXPECT_LT(180.0 / kPi * std::sqrt(2.0 * turned / count), 0.5);
}

/// Amid a face of a box, where its edges are out of reach.
TEST(LiquidSurface, OfABoxIsFlat)
{
    LiquidSurface surface;
    // Seen are 0.001 pitches and 0.6 degrees for a lattice, 0.08 and 1.7 for one shaken by a quarter of a pitch.
    for (const auto& [jitter, mostOff, mostTurned] : {std::array{0.0, 0.01, 1.5}, std::array{0.25, 0.10, 2.5}}) {
        const SurfaceMesh& mesh = surface.find(box({1.6, 1.6, 1.0}, jitter), kDensity);
        double count = 0.0, sum = 0.0, squares = 0.0, turned = 0.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3 x = mesh.positions[v] / kPitch;
            if (std::abs(x.x()) > 4.5 || std::abs(x.y()) > 4.5 || x.z() < 0.0) continue;
            count += 1.0, sum += x.z(), squares += x.z() * x.z(), turned += 1.0 - mesh.normals[v].z();
        }
        ASSERT_GT(count, 200.0);
        EXPECT_NEAR(5.0, sum / count, 0.1) << jitter;
        EXPECT_LT(std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))), mostOff) << jitter;
        EXPECT_LT(180.0 / kPi * std::sqrt(2.0 * turned / count), mostTurned) << jitter;
    }
}

/// The same vertices wherever the other mesh has them in its order, up to the rounding of floats.
void expectSameVertices(const SurfaceMesh& a, const SurfaceMesh& b)
{
    ASSERT_EQ(a.positions.size(), b.positions.size());
    EXPECT_EQ(a.triangles.size(), b.triangles.size());
    for (const Vec3& x : a.positions) {
        double nearest = 1.0;
        for (const Vec3& y : b.positions) nearest = std::min(nearest, (x - y).norm());
        // Sums of floats are off by 1e-6, and where the field hardly changes along an edge its crossing by hundreds of
        // that.
        ASSERT_LT(nearest, 5.0e-4 * kPitch) << x.transpose();
    }
}

constexpr SurfaceSettings kUnmoved = {.cell = 0.5, .keepsVolume = false};

TEST(LiquidSurface, MovesWithTheParticles)
{
    LiquidParticles liquid = box({0.5, 0.6, 0.4}, 0.4);
    LiquidSurface surface;
    SurfaceMesh mesh = surface.find(liquid, kDensity, kUnmoved);
    for (const Vec3& cells : {Vec3(80, -40, 16), Vec3(3, -5, 13)}) {  // whole blocks, and not
        const Vec3 shift = 0.5 * kPitch * cells;
        LiquidParticles moved = liquid;
        for (std::size_t p = 0; p < moved.count; ++p)
            for (int a = 0; a < kAxes; ++a) moved.x[a][p] += shift[a];
        SurfaceMesh back = surface.find(moved, kDensity, kUnmoved);
        for (Vec3& x : back.positions) x -= shift;
        expectSameVertices(mesh, back);
    }
}

TEST(LiquidSurface, NoAxisIsSpecial)
{
    LiquidParticles liquid = box({0.5, 0.6, 0.4}, 0.4), turned = liquid;
    for (int a = 0; a < kAxes; ++a) turned.x[(a + 1) % kAxes] = liquid.x[a];
    LiquidSurface surface;
    const SurfaceMesh mesh = surface.find(liquid, kDensity, kUnmoved);
    SurfaceMesh back = surface.find(turned, kDensity, kUnmoved);
    for (Vec3& x : back.positions) x = Vec3(x.y(), x.z(), x.x());
    expectSameVertices(mesh, back);
}

bool areSame(const SurfaceMesh& a, const SurfaceMesh& b)
{
    return a.positions == b.positions && a.normals == b.normals && a.velocities == b.velocities && a.triangles == b.triangles;
}

TEST(LiquidSurface, SameBitsForAnyThreadCount)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 3.0);
    LiquidParticles liquid = ball(1.2, 0.5);
    for (int p = 0; p < 2000; ++p) addAt(liquid, {1.0 + unit(random), unit(random), unit(random)});
    setVelocities(liquid, {1.0, 2.0, 3.0}, Mat3::Random());
    const auto meshOn = [&](int threads) { return onThreads(threads, [&] { return LiquidSurface().find(liquid, kDensity); }); };
    const SurfaceMesh one = meshOn(1);
    EXPECT_GT(one.positions.size(), 10000u);
    for (const int threads : {2, 8}) EXPECT_TRUE(areSame(one, meshOn(threads))) << threads;
}

TEST(LiquidSurface, DependsOnNothingBefore)
{
    LiquidSurface used, fresh;
    used.find(ball(1.0, 0.3), kDensity);
    used.find(LiquidParticles(), kDensity);
    const LiquidParticles liquid = box({0.5, 0.6, 0.4}, 0.4);
    EXPECT_TRUE(areSame(used.find(liquid, kDensity), fresh.find(liquid, kDensity)));
}

TEST(LiquidSurface, IsNothingWithoutLiquid)
{
    LiquidSurface surface;
    surface.find(ball(0.3), kDensity);
    LiquidParticles massless;
    addAt(massless, Vec3::Zero(), 0.0);
    for (const LiquidParticles& liquid : {LiquidParticles(), massless}) {
        const SurfaceMesh& mesh = surface.find(liquid, kDensity);
        EXPECT_TRUE(mesh.positions.empty() && mesh.normals.empty() && mesh.velocities.empty() && mesh.triangles.empty());
        EXPECT_EQ(0.0, enclosedVolume(mesh));
        EXPECT_EQ(0, surface.blocks());
    }
}

/// Two balls 2 km apart take the memory of two balls.
TEST(LiquidSurface, TakesTheMemoryOfTheLiquid)
{
    LiquidSurface surface;
    constexpr SurfaceSettings kHalf = {.cell = 0.5};
    surface.find(ball(0.4), kDensity, kHalf);
    const int alone = surface.blocks();
    LiquidParticles both = ball(0.4);
    const Vec3 far = 4.0 * kPitch * Vec3(5.0e5, -2.0e5, 3.0e5);  // whole blocks away
    const LiquidParticles other = ball(0.4);
    for (std::size_t p = 0; p < other.count; ++p) addAt(both, other.position(p) + far);
    const SurfaceMesh& mesh = surface.find(both, kDensity, kHalf);
    EXPECT_EQ(2 * alone, surface.blocks());
    EXPECT_EQ(4, eulerCharacteristic(mesh));
    EXPECT_NEAR(volumeOf(both), enclosedVolume(mesh), 0.005 * volumeOf(both));
}

TEST(LiquidSurface, RefusesParticlesBeyondItsGrid)
{
    LiquidParticles liquid = ball(0.3);
    addAt(liquid, {1.0e9, 0.0, 0.0});
    LiquidSurface surface;
    EXPECT_THROW(surface.find(liquid, kDensity), RunError);
}

/// Ten times as many droplets as particles, of a thousandth of their volume, leave the ball as it is.
TEST(LiquidSurface, DustLeavesTheSpacing)
{
    LiquidParticles liquid = ball(0.6);
    const double before = surfaceSpacing(liquid, kDensity);
    EXPECT_NEAR(kPitch, before, 1.0e-9);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(1.0, 4.0);
    for (std::size_t p = 10 * liquid.count; p > 0; --p) addAt(liquid, {unit(random), unit(random), unit(random)}, 1.0e-3 * std::pow(kPitch, 3));
    EXPECT_NEAR(before, surfaceSpacing(liquid, kDensity), 0.01 * before);
}

}  // namespace
}  // namespace sim::test
