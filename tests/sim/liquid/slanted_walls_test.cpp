// Masses of faces at walls that go slanted through the grid (liquid/README.md, Walls).
#include "sim/core/units.h"
#include "sim/liquid/walls.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <optional>

namespace sim::test {
namespace {

/// A grid with a plane wall of any direction through it, whose faces have what P2G brings of even liquid in front of the wall.
struct LiquidAtPlane {
    GridScene scene{{-16, -16, -16}, {16, 16, 16}};
    Vec3 normal;

    /// @param alongAxis  of the grid that the wall is parallel to, or none
    LiquidAtPlane(std::mt19937& random, std::optional<int> alongAxis)
    {
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        normal = Vec3(unit(random), unit(random), unit(random));
        if (alongAxis) normal[*alongAxis] = 0.0;
        normal.normalize();
        Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        place.translate(scene.corner({0, 0, 0}) + scene.grid.dx * (unit(random) - 40.0) * normal);
        place.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), normal));
        scene.add(Shape::box(Vec3::Zero(), Vec3::Constant(40.0 * scene.grid.dx)).moved(place));
        scene.forEachFace([&](int a, const Vec3i& c) { mass(a, c) = scene.liquid.fullMass * room(a, c); });
    }
    double& mass(int a, const Vec3i& c) { return scene.liquid.faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell]; }
    double room(int a, const Vec3i& c) const { return scene.field.room(scene.at(c).block, a)[scene.at(c).cell]; }
    /// Is a face far enough from the ends of the grid, and its plane nearer to the wall's normal than its own is?
    bool passesAllOfIt(int a, const Vec3i& c) const
    {
        const double along = std::max(std::abs(normal[(a + 1) % 3]), std::abs(normal[(a + 2) % 3]));
        return c.cwiseAbs().maxCoeff() < 9 && along >= std::abs(normal[a]);
    }
};

/// Sum over faces of what their masses differ by from their open parts [of a full face].
double differenceOf(LiquidAtPlane& liquid)
{
    double sum = 0.0;
    liquid.scene.forEachFace([&](int a, const Vec3i& c) {
        const double open = liquid.scene.open(a, c);
        if (open > 0.0 && liquid.passesAllOfIt(a, c)) sum += std::abs(liquid.mass(a, c) / liquid.scene.liquid.fullMass - open);
    });
    return sum;
}

double afterWalls(LiquidAtPlane& liquid, unsigned seed)
{
    GridScene& scene = liquid.scene;
    WallFaces followers;
    mirrorAtWalls(scene.grid, scene.obstacles, 0.0, scene.field, followers, scene.liquid);
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (!(scene.open(a, c) > 0.0) || c.cwiseAbs().maxCoeff() >= 9) return;
        EXPECT_NEAR(liquid.mass(a, c), scene.liquid.fullMass * liquid.room(a, c), 1.0e-12 * scene.liquid.fullMass)
            << "rooms go with masses, " << seed;
    });
    return differenceOf(liquid);
}

/// Where liquid is even, masses are nearly what is open of faces, wherever the wall is and however it stands, also along an axis of the grid: then
/// pressure and weight act alike on each of them, and pressure pushes along the normal however few faces have one. Not all is there, for what is
/// behind closed faces goes to several columns.
TEST(SlantedWalls, FacesWeighWhatIsOpenOfThem)
{
    for (const bool isAlongAxis : {false, true}) {
        double now = 0.0, before = 0.0;
        for (unsigned seed = 1; seed <= 40; ++seed) {
            std::mt19937 random(seed);
            LiquidAtPlane liquid(random, isAlongAxis ? std::optional(static_cast<int>(seed % kAxes)) : std::nullopt);
            before += differenceOf(liquid);
            now += afterWalls(liquid, seed);
        }
        std::printf("masses differ from open parts by %.3f of what they do as they come\n", now / before);
        EXPECT_LT(now, 0.2 * before);
    }
}

}  // namespace
}  // namespace sim::test
