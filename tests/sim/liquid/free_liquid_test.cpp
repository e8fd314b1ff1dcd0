#include "sim/liquid/free_liquid.h"

#include "sim/liquid/cells.h"
#include "sim/liquid/volume.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A pool in the corner of a tank and balls in the air above it, all with random masses and far too full cells, corrected.
struct Pieces {
    GridScene scene{{-3, -3, -3}, {21, 21, 21}};
    std::vector<Vec3> middles;
    double radius = 3.1;  ///< of the balls [cells]
    VolumeWorkspace volume;
    BlockArray<double, 3> asFound;

    explicit Pieces(unsigned seed)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        scene.add(tankOfCells(scene, {0, 0, 0}, {40, 40, 40}));
        for (const Vec3& ball : {Vec3(5, 16, 5), Vec3(16, 16, 7), Vec3(15, 8, 16)})
            middles.emplace_back(scene.corner(Vec3i::Zero()) + scene.grid.dx * (ball + Vec3(unit(random), unit(random), unit(random))));
        scene.fill([&](const Vec3& x) {
            double d = (x - scene.corner({6, 6, 6})).maxCoeff();
            for (const Vec3& middle : middles) d = std::min(d, (x - middle).norm() - radius * scene.grid.dx);
            return d;
        });
        for (int a = 0; a < kAxes; ++a)
            scene.forEachCell([&](const Vec3i& c) {
                const CellRef at = scene.at(c);
                scene.liquid.faces.sums.block(at.block, FaceFields::kMass + a)[at.cell] *= std::pow(unit(random), 3);
            });
        scene.forEachCell([&](const Vec3i& c) {
            scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell] = scene.isInside(c) ? 0.5 + 2.0 * unit(random) : 0.0;
        });
        // Faces between deep cells are taken as full, whatever their mass: let there be none.
        for (int b = 0; b < scene.grid.count(); ++b) std::fill_n(scene.liquid.deep.block(b), BlockBits<>::kWords, 0);
        const PressureSystem system = scene.system(1.0e-3);
        Settings settings;
        settings.gravity = Vec3(0.0, -981.0, 0.0);
        correctVolume(scene.cut(), settings, 0.5, system, volume);
        asFound = volume.displacement;
        FreeLiquid work;
        const HeldBodies bodies = findHeldBodies(scene.grid, system, findUnheldFaces(scene.cut(), work));
        takeMeans(scene.grid, bodies, volume.displacement, work, volume.displacement);
    }

    /// Mean displacement of one ball, and of the pool after them [cm].
    Vec3 meanOf(std::size_t piece, const BlockArray<double, 3>& displacement) const
    {
        Vec3 mean = Vec3::Zero();
        for (int a = 0; a < kAxes; ++a) {
            double moved = 0.0, mass = 0.0;
            scene.forEachCell([&](const Vec3i& c) {
                const CellRef at = scene.at(c);
                if (!(scene.work.coefficient.block(at.block, a)[at.cell] > 0.0)) return;
                const Vec3 x = scene.faceMiddle(a, c);
                std::size_t nearest = middles.size();
                for (std::size_t n = 0; n < middles.size(); ++n)
                    if ((x - middles[n]).norm() < (radius + 1.0) * scene.grid.dx) nearest = n;
                if (nearest != piece) return;
                const double m = scene.liquid.faces.sums.block(at.block, FaceFields::kMass + a)[at.cell];
                moved += m * displacement.block(at.block, a)[at.cell];
                mass += m;
            });
            mean[a] = moved / mass;
        }
        return mean;
    }
};

TEST(CentreOfMass, OfFreeLiquidStaysWhereACorrectionFindsIt)
{
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const Pieces pieces(seed);
        const double dx = pieces.scene.grid.dx;
        for (std::size_t ball = 0; ball < pieces.middles.size(); ++ball) {
            EXPECT_GT(pieces.meanOf(ball, pieces.asFound).norm(), 1.0e-4 * dx) << "what is mended, seed " << seed;
            EXPECT_LT(pieces.meanOf(ball, pieces.volume.displacement).norm(), 1.0e-14 * dx) << "ball " << ball << ", seed " << seed;
        }
        const std::size_t pool = pieces.middles.size();
        EXPECT_GT(pieces.meanOf(pool, pieces.asFound).minCoeff(), 1.0e-3 * dx) << "away from the corner";
        EXPECT_EQ(pieces.meanOf(pool, pieces.asFound), pieces.meanOf(pool, pieces.volume.displacement)) << "walls hold it";
    }
}

}  // namespace
}  // namespace sim::test
