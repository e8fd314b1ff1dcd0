// Masses and momenta that particles bring behind walls, folded back into the liquid (liquid/README.md, Walls).
#include "sim/core/units.h"
#include "sim/liquid/face_velocity.h"
#include "sim/liquid/walls.h"
#include "sim/transfer/scatter.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <optional>
namespace sim::test {
namespace {

TEST(Walls, FoldingIsLikeMirroredParticles)
{
    // Particles in the corners of a small tank, with and without their images behind every wall.
    constexpr double kDx = 0.5;
    const Vec3i size(6, 5, 4);
    const Vec3 far = kDx * size.cast<double>();
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    SortedLiquid inside, all;
    inside.grid.dx = all.grid.dx = kDx;
    inside.particles.modeCount = all.particles.modeCount = 4;
    const auto add = [](SortedLiquid& liquid, const Vec3& x, const Vec3& v, const Mat3& slope) {
        const std::size_t p = liquid.particles.count;
        liquid.particles.add(x, 1.0, static_cast<std::uint32_t>(p), v);
        for (int a = 0; a < kAxes; ++a)
            for (int b = 0; b < kAxes; ++b) liquid.particles.mode(a, 1 + b)[p] = slope(a, b);
    };
    for (int n = 0; n < 300; ++n) {
        const Vec3 x = Vec3(unit(random), unit(random), unit(random)).cwiseProduct(far), v = Vec3(unit(random), unit(random), unit(random));
        Mat3 slope;
        for (int e = 0; e < 9; ++e) slope(e / 3, e % 3) = unit(random) - 0.5;
        add(inside, x, v, slope);
        for (int image = 0; image < 27; ++image) {
            const Vec3i wall(image % 3, image / 3 % 3, image / 9);  // 0 none, 1 the lower, 2 the upper one
            Vec3 at = x, sign = Vec3::Ones();
            for (int a = 0; a < kAxes; ++a) {
                if (wall[a] == 0) continue;
                at[a] = (wall[a] == 1 ? 0.0 : 2.0 * far[a]) - x[a];
                sign[a] = -1.0;
            }
            const Mat3 mirrored = sign.asDiagonal() * slope * sign.asDiagonal();
            add(all, at, sign.cwiseProduct(v), mirrored);
        }
    }
    Obstacles obstacles;
    obstacles.add(Shape::box(0.5 * far, 0.5 * far).inverted(), {});
    FaceFields folded, expected;
    ScatterScratch scratch;
    inside.sort();
    all.sort();
    particlesToFaces({inside.particles, inside.order, inside.grid}, scratch, folded);
    BlockArray<double, 3> weightless;
    mirrorAtPlaneWalls(inside.grid, obstacles, folded, weightless);
    particlesToFaces({all.particles, all.order, all.grid}, scratch, expected);
    for (int a = 0; a < kAxes; ++a)
        for (int z = a == 2; z < size.z(); ++z)
            for (int y = a == 1; y < size.y(); ++y)
                for (int x = a == 0; x < size.x(); ++x)
                    for (int kind : {FaceFields::kMass + a, FaceFields::kMomentum + a}) {
                        const int cell = cellInBlock(x, y, z);
                        ASSERT_NEAR(folded.sums.block(inside.grid.find({0, 0, 0}), kind)[cell],
                                    expected.sums.block(all.grid.find({0, 0, 0}), kind)[cell], 1.0e-12)
                            << a << ": " << x << ' ' << y << ' ' << z;
                    }
}

/// sum of p^2 / 2 m over all faces with mass [erg].
double energyOfSums(const GridScene& scene)
{
    double energy = 0.0;
    for (int b = 0; b < scene.grid.count(); ++b)
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                const auto& sums = scene.liquid.faces.sums;
                const double m = sums.block(b, FaceFields::kMass + a)[c], p = sums.block(b, FaceFields::kMomentum + a)[c];
                if (m > 0.0) energy += 0.5 * p * p / m;
            }
    return energy;
}

/// Bodies that leave edges, corners, slots and walls thinner than a cell, anywhere and turned anyhow.
void addRandomSolids(GridScene& scene, std::mt19937& random, const Motion& motion = {})
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const double dx = scene.grid.dx;
    for (int n = 0; n < 3; ++n) {
        Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        place.translate(scene.corner({4, 4, 4}) + 5.0 * dx * Vec3(unit(random), unit(random), unit(random)));
        if (n > 0) place.rotate(Eigen::AngleAxisd(kPi * unit(random), Vec3(unit(random), unit(random), unit(random)).normalized()));
        scene.obstacles.add(Shape::box(Vec3::Zero(), dx * Vec3(4.0, n == 1 ? 0.3 : 2.0, 3.0)).moved(place), motion);
    }
    scene.obstacles.moveTo(0.0, 1.0e-6);
    scene.updateObstacles();
}

/// What particles give to faces with any masses and velocities, and what they read where only walls have acted.
struct AtWalls {
    double given = 0.0, folded = 0.0, read = 0.0;  ///< energy: given, on the faces that carry it then, and read [erg]
    double work = 0.0;                             ///< of the walls by what WallFaces tell and by the faces that get their velocity [erg]
    Vec3 impulse = Vec3::Zero();                   ///< of the walls: momentum read less that given [g cm/s]
};

AtWalls passWalls(GridScene& scene, std::mt19937& random, double friction)
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    // Masses over twelve powers of ten, as lone particles leave them, on part of the faces.
    FaceFields& faces = scene.liquid.faces;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const double mass = unit(random) > 0.3 ? std::pow(10.0, 6.0 * unit(random)) : 0.0;
        faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] = mass;
        faces.sums.block(ref.block, FaceFields::kMomentum + a)[ref.cell] = mass * 100.0 * unit(random);
    });
    const auto before = faces.sums;
    AtWalls result;
    result.given = energyOfSums(scene);
    WallFaces followers;
    mirrorAtWalls(scene.grid, scene.obstacles, friction, scene.field, followers, scene.liquid);
    result.folded = energyOfSums(scene);
    result.work = followers.driven.work;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const double m = faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell];
        scene.velocity(a, c) = m > 0.0 ? faces.sums.block(ref.block, FaceFields::kMomentum + a)[ref.cell] / m : 0.0;
        if (m > 0.0 && scene.open(a, c) > 0.0) scene.setValid(a, c);
    });
    const auto alone = faces.velocity;
    applyWalls(scene.cut(), friction, false, followers, faces.valid, faces.velocity);
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const double m = before.block(ref.block, FaceFields::kMass + a)[ref.cell], u = scene.velocity(a, c);
        result.read += 0.5 * m * u * u;
        result.impulse[a] += m * u - before.block(ref.block, FaceFields::kMomentum + a)[ref.cell];
        if (scene.open(a, c) == 0.0)
            result.work += faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] * (u - alone.block(ref.block, a)[ref.cell]) *
                           scene.field.wallVelocity(ref.block, a)[ref.cell];
    });
    return result;
}

TEST(Walls, NeverAddEnergyWhateverMassesTheFacesHave)
{
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        GridScene scene({0, 0, 0}, {16, 16, 16});
        addRandomSolids(scene, random);
        const AtWalls at = passWalls(scene, random, seed % 3 == 0 ? 0.4 : 0.0);
        ASSERT_LE(at.folded, at.given * (1.0 + 1.0e-13)) << seed;
        ASSERT_LE(at.read, at.folded * (1.0 + 1.0e-13)) << seed;
        ASSERT_GT(at.read, 0.1 * at.given) << seed;
        ASSERT_EQ(at.work, 0.0) << seed;
    }
}

TEST(Walls, AddNoMoreEnergyThanTheirWorkWhereTheyMove)
{
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({0, 0, 0}, {16, 16, 16});
        const Vec3 velocity = 80.0 * Vec3(unit(random), unit(random), unit(random));
        const bool turns = seed % 2 == 0;
        Motion motion;
        motion.addTranslation(0.0, 1.0, velocity, 0.0, 0.0);
        if (turns) motion.addRotation(0.0, 1.0, {Vec3::UnitY(), scene.corner({4, 4, 4})}, 30.0, 0.0, 0.0);
        addRandomSolids(scene, random, motion);
        const AtWalls at = passWalls(scene, random, std::array{0.0, 0.2, 0.5, 0.92}[seed / 2 % 4]);
        const double scale = at.given + at.read + std::abs(at.work);
        ASSERT_LE(at.read - at.given, at.work + 1.0e-12 * scale) << seed;
        if (turns) continue;
        ASSERT_NEAR(at.work, at.impulse.dot(velocity), 1.0e-11 * scale) << seed;
    }
}

/// Weight acts on the folded masses; its power must be that on what the particles gave, at the velocities that they read.
/// @param scene  whose faces have the masses of particles, and frictionless walls
void expectSameWorkOfWeight(GridScene& scene, const Vec3& gravity, std::mt19937& random, unsigned seed)
{
    constexpr double kFriction = 0.0, kStep = 0.01;  // [-], [s]
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    FaceFields& faces = scene.liquid.faces;
    const auto given = faces.sums;
    WallFaces followers;
    mirrorAtWalls(scene.grid, scene.obstacles, kFriction, scene.field, followers, scene.liquid);
    computeFaceVelocities(scene.grid, gravity, kStep, false, scene.liquid);
    withholdWeightOfImages(scene.field, gravity, kStep, scene.liquid);
    const auto mass = [&](const auto& sums, int a, const Vec3i& c) { return sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell]; };
    const BlockArray<double, 3> fallen = faces.velocity;
    scene.forEachFace([&](int a, const Vec3i& c) {
        scene.velocity(a, c) = 10.0 * unit(random);
        if (mass(faces.sums, a, c) > 0.0 && scene.open(a, c) > 0.0) scene.setValid(a, c);
    });
    const BlockArray<double, 3> own = faces.velocity;  // particles read others, also on open faces at slanted walls
    applyWalls(scene.cut(), kFriction, false, followers, faces.valid, faces.velocity);
    double onFaces = 0.0, onParticles = 0.0, scale = 0.0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const double u = scene.velocity(a, c), particles = mass(given, a, c) * gravity[a] * u;
        const double ofFace = scene.open(a, c) > 0.0 ? own.block(scene.at(c).block, a)[scene.at(c).cell] : u;
        onFaces += mass(faces.sums, a, c) * fallen.block(scene.at(c).block, a)[scene.at(c).cell] / kStep * ofFace;
        onParticles += particles;
        scale += std::abs(particles);
    });
    EXPECT_NEAR(onFaces, onParticles, 1.0e-12 * scale) << seed;
}

/// Gives masses over four orders of size to the faces that particles in a tank of so many cells reach, or to all.
/// @param share  of them that get one [-]
void giveMasses(GridScene& scene, const std::optional<Vec3i>& size, double share, std::mt19937& random)
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (size && ((c.array() < -1).any() || (c.array() > size->array() + Vec3i::Unit(a).array()).any())) return;
        const bool hasMass = 0.5 * (unit(random) + 1.0) < share;
        scene.liquid.faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell] =
            hasMass ? std::pow(10.0, 2.0 * unit(random)) : 0.0;
    });
}

TEST(Walls, WeightDoesOnFacesTheWorkThatItDoesOnParticles)
{
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({-3, -3, -3}, {16, 16, 16});
        const Vec3i size(5 + static_cast<int>(seed % 5), 4, 9);
        const bool isTank = seed % 2 == 1;
        if (isTank) scene.add(tankOfCells(scene, {0, 0, 0}, size));
        else addRandomSolids(scene, random);
        giveMasses(scene, isTank ? std::optional(size) : std::nullopt, 0.5, random);
        expectSameWorkOfWeight(scene, {300.0 * unit(random), -981.0, 200.0 * unit(random)}, random, seed);
    }
}

/// So it is where a wall within cells meets a floor in a plane of faces: what follows open faces takes what images hold of it along.
TEST(Walls, WeightDoesThatWorkWhereWallsWithinCellsMeetAFloor)
{
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({-3, -3, -3}, {16, 16, 16});
        const Vec3i size(7, 5, 9);
        const Vec3 low = scene.corner({0, 0, 0}), high = scene.corner(size) + 0.5 * scene.grid.dx * Vec3(unit(random), 0.0, unit(random));
        scene.add(Shape::box(0.5 * (low + high), 0.5 * (high - low)).inverted());
        giveMasses(scene, size, 1.0, random);
        expectSameWorkOfWeight(scene, {0.0, -981.0, 0.0}, random, seed);
    }
}

/// Along a wall weight gives all faces the same velocity, whatever the friction: only so can a pressure hold it.
TEST(Walls, WeightIsEvenAlongThem)
{
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({-3, -3, -3}, {16, 16, 16});
        const Vec3i size(10, 9, 10);
        scene.add(tankOfCells(scene, {0, 0, 0}, size));
        FaceFields& faces = scene.liquid.faces;
        scene.forEachFace([&](int a, const Vec3i& c) {
            if ((c.array() < -1).any() || (c.array() > size.array() + Vec3i::Unit(a).array()).any()) return;
            faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell] = std::pow(10.0, 2.0 * unit(random));
        });
        const Vec3 gravity(300.0 * unit(random), -981.0, 200.0 * unit(random));
        WallFaces followers;
        mirrorAtWalls(scene.grid, scene.obstacles, std::array{0.0, 0.3, 0.9}[seed % 3], scene.field, followers, scene.liquid);
        computeFaceVelocities(scene.grid, gravity, 0.01, false, scene.liquid);
        withholdWeightOfImages(scene.field, gravity, 0.01, scene.liquid);
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (!(scene.open(a, c) > 0.0) || c[a] < 3 || c[a] > size[a] - 3) return;
            EXPECT_NEAR(scene.velocity(a, c), 0.01 * gravity[a], 1.0e-12) << seed << ", axis " << a << ", face " << c.transpose();
        });
    }
}

TEST(Walls, FrictionlessOnesOffTheGridKeepMassAndMomentum)
{
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({-8, -8, -8}, {24, 24, 24});
        scene.add(skewTank(scene));
        FaceFields& faces = scene.liquid.faces;
        Vec3 mass[2] = {Vec3::Zero(), Vec3::Zero()}, momentum[2] = {Vec3::Zero(), Vec3::Zero()};
        const auto sumUp = [&](int when) {
            scene.forEachFace([&](int a, const Vec3i& c) {
                mass[when][a] += faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell];
                momentum[when][a] += faces.sums.block(scene.at(c).block, FaceFields::kMomentum + a)[scene.at(c).cell];
            });
        };
        scene.forEachFace([&](int a, const Vec3i& c) {
            const CellRef ref = scene.at(c);
            const double m = 1.0 + unit(random);
            faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] = m;
            faces.sums.block(ref.block, FaceFields::kMomentum + a)[ref.cell] = m * (3.0 + 10.0 * unit(random));
        });
        sumUp(0);
        WallFaces followers;
        mirrorAtWalls(scene.grid, scene.obstacles, 0.0, scene.field, followers, scene.liquid);
        sumUp(1);
        for (int a = 0; a < kAxes; ++a) {
            EXPECT_NEAR(mass[1][a], mass[0][a], 1.0e-12 * mass[0][a]);
            EXPECT_NEAR(momentum[1][a], momentum[0][a], 1.0e-11 * mass[0][a]);
        }
    }
}

}  // namespace
}  // namespace sim::test
