#include "sim/coupling/fabric_on_faces.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

constexpr double kWater = 1.0;  // g/cm^3

/// Cloth with a yarn through it, or two sheets.
struct Spread {
    Spread(bool hasYarn, double secondDensity, bool isWet) : scene(Vec3i(0, 0, 0), Vec3i(16, 16, 16))
    {
        const Vec3 middle = scene.corner(Vec3i(8, 8, 8)), off(0.05, 0.02, 0.11);
        FabricPiece first = testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.144}, middle}), testing::wool(), {0.017, 0.017});
        FabricPiece second =
            hasYarn ? testing::pieceOf(strand(middle - Vec3(0.5, 0.3, 0.2), middle + Vec3(0.6, 0.1, 0.4), 8), testing::wool(), {0.05, 0.03})
                    : testing::pieceOf(clothGrid({{7, 9}, {0.144, 0.144}, middle + off}), testing::wool(), {0.017, 0.017});
        second.material.density = secondDensity;
        fabric = assembleFabric(std::vector<FabricPiece>{first, second});
        state = restState(fabric);
        testing::Noise noise(3);
        if (isWet)
            for (std::size_t v = 0; v < state.absorbed.size(); ++v) state.absorbed[v] = (1.0 + noise()) * fabric.mass[v];
        scene.fill([&](const Vec3& x) { return (x - middle).cwiseAbs().maxCoeff() - 6.4 * scene.grid.dx; });
        faces.emplace(fabric, kWater);
        spread();
    }
    /// Liquid touches all of the fabric.
    void spread()
    {
        const std::vector<double> distance(fabric.vertexCount(), 0.0);
        faces->spread(sorter.sort(scene.grid, state), state, distance);
    }
    double fibres() const
    {
        double sum = 0.0;
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) sum += fabric.materials[fabric.vertexMaterial[v]].volumeFraction * fabric.volume[v];
        return sum;
    }
    double absorbed() const { return std::accumulate(state.absorbed.begin(), state.absorbed.end(), 0.0); }
    /// Σ over the faces normal to one axis that have mass.
    double sum(const BlockArray<double, 3>& u, int axis) const
    {
        double sum = 0.0;
        for (int b = 0; b < faces->grid().count(); ++b)
            for (int c = 0; c < kBlockCells; ++c)
                if (faces->mass.block(b, axis)[c] > 0.0) sum += u.block(b, axis)[c];
        return sum;
    }

    GridScene scene;
    Fabric fabric;
    FabricState state;
    VertexSorter sorter;
    std::optional<FabricOnFaces> faces;
};

/// The faces hold the fabric's mass and its volumes, dry and wet, of one material and of several (coupling/README.md, Fabric on the faces).
TEST(FabricOnFaces, HoldsMassAndVolumes)
{
    for (bool hasYarn : {false, true})
        for (double density : {1.32, 0.9})
            for (bool isWet : {false, true}) {
                const Spread spread(hasYarn, density, isWet);
                const double fibres = spread.fibres(), mass = std::accumulate(spread.fabric.mass.begin(), spread.fabric.mass.end(), 0.0);
                for (int a = 0; a < kAxes; ++a) {
                    EXPECT_NEAR(spread.sum(spread.faces->mass, a), mass + spread.absorbed(), 1.0e-12 * mass);
                    EXPECT_NEAR(spread.sum(spread.faces->fibres, a), fibres, 1.0e-12 * fibres);
                    EXPECT_NEAR(spread.sum(spread.faces->solid, a), fibres + spread.absorbed() / kWater, 1.0e-11 * fibres);
                }
            }
}

/// What is not scattered, because masses or a single shape tell it, is what scattering gives: a material that hardly differs has it done.
TEST(FabricOnFaces, KnowsWithoutAPassWhatAPassGives)
{
    for (bool isWet : {false, true}) {
        const double density = testing::wool().density;
        const Spread known(false, density, isWet), scattered(false, density * (1.0 + 1.0e-10), isWet);
        ASSERT_EQ(known.faces->grid().count(), scattered.faces->grid().count());
        for (int b = 0; b < known.faces->grid().count(); ++b)
            for (int i = 0; i < kAxes * kBlockCells; ++i) {
                if (!(known.faces->mass.block(b)[i] > 0.0)) continue;
                const double size = scattered.faces->solid.block(b)[i];
                EXPECT_NEAR(known.faces->fibres.block(b)[i], scattered.faces->fibres.block(b)[i], 1.0e-8 * size);
                EXPECT_NEAR(known.faces->solid.block(b)[i], size, 1.0e-8 * size);
                EXPECT_EQ(known.faces->shape.block(b)[i], 0.0);
            }
    }
    const Spread mixed(true, testing::wool().density, false);
    double least = 1.0, most = 0.0;
    for (int b = 0; b < mixed.faces->grid().count(); ++b)
        for (int i = 0; i < kAxes * kBlockCells; ++i)
            if (mixed.faces->mass.block(b)[i] > 0.0) {
                least = std::min(least, mixed.faces->shape.block(b)[i]);
                most = std::max(most, mixed.faces->shape.block(b)[i]);
            }
    EXPECT_LT(least, 0.1);
    EXPECT_GT(most, 0.9);
}

/// Fabric that is stretched has the fibres it had in an envelope that grows with it: yarns with their length, cloth with its area.
TEST(FabricOnFaces, EnvelopesFollowTheStretch)
{
    for (const bool hasYarn : {false, true}) {
        Spread spread(hasYarn, 1.3, false);
        const double before = spread.sum(spread.faces->envelope, 1), fibres = spread.sum(spread.faces->fibres, 1);
        double whole = 0.0, grown = 0.0;
        for (std::size_t v = 0; v < spread.fabric.vertexCount(); ++v) {
            const bool isYarn = hasYarn && v >= 81;
            whole += spread.fabric.volume[v];
            grown += (isYarn ? 1.2 : 1.44) * spread.fabric.volume[v];
        }
        EXPECT_NEAR(before, whole, 1.0e-12 * whole);
        EXPECT_NEAR(spread.sum(spread.faces->touched, 1), whole, 1.0e-12 * whole);
        const Vec3 middle = spread.scene.corner(Vec3i(8, 8, 8));
        for (Vec3& x : spread.state.x) x = middle + 1.2 * (x - middle);
        spread.spread();
        EXPECT_NEAR(spread.sum(spread.faces->envelope, 1), grown, 1.0e-12 * whole);
        EXPECT_NEAR(spread.sum(spread.faces->fibres, 1), fibres, 1.0e-12 * whole);
    }
}

}  // namespace
}  // namespace sim::test
