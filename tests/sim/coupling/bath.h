#pragma once

#include "sim/coupling/mixture.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

// Fabric in a bath.

namespace sim::test {

using testing::Noise;

inline constexpr double kStep = 1.0e-3;  // s

/// Cloth and yarns in the middle of liquid that moves at random.
struct Bath {
    explicit Bath(DragLaw law = DragLaw::Nonlinear) : scene(Vec3i(0, 0, 0), Vec3i(16, 16, 16))
    {
        testing::Noise noise(7);
        const Vec3 middle = scene.corner(Vec3i(8, 8, 8));
        FabricPiece cloth = testing::pieceOf(clothGrid({{9, 9}, {0.144, 0.144}, middle}), testing::wool(), {0.017, 0.017});
        FabricPiece yarn = testing::pieceOf(strand(middle - Vec3(0.5, 0.3, 0.2), middle + Vec3(0.6, 0.1, 0.4), 8), testing::wool(), {0.05, 0.03});
        cloth.material.volumeFraction = yarn.material.volumeFraction = 0.4;
        fabric = assembleFabric(std::vector<FabricPiece>{cloth, yarn});
        distance.assign(fabric.vertexCount(), 0.0);
        state = restState(fabric);
        for (Vec3& v : state.v) v = 20.0 * noise.vector();
        scene.fill([&](const Vec3& x) { return (x - middle).cwiseAbs().maxCoeff() - 6.4 * scene.grid.dx; });
        scene.setRandomVelocities(20.0);
        settings.cell = scene.grid.dx;
        settings.gravity.setZero();
        settings.coupling.drag = law;
        settings.coupling.capillary = false;
    }
    Vec3 fabricMomentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += fabric.mass[v] * state.v[v];
        return sum;
    }
    /// The fabric under the liquid's loads alone.
    void moveFabric(const LiquidLoads& loads)
    {
        for (std::size_t v = 0; v < state.v.size(); ++v) {
            const Vec3 inertia = Vec3::Constant(fabric.mass[v]) + loads.drag[v];
            state.v[v] = (fabric.mass[v] * state.v[v] + loads.impulse[v]).cwiseQuotient(inertia);
        }
    }

    /// The fabric on the faces, without its envelopes.
    FabricOnFaces onFaces()
    {
        FabricOnFaces faces(fabric, settings.liquid.density);
        faces.spread(sorter.sort(scene.grid, state), state, {});
        return faces;
    }

    Vec3 momentum(const Mixture& mixture) const { return fabricMomentum() + mixture.liquidMomentum(*shared, scene.liquid); }
    /// A step of the two without pressure.
    void exchange(Mixture& mixture) { finish(mixture, eliminateDragWithoutPressure(mixture)); }
    /// Moves the fabric under the liquid's loads alone, and separates the phases.
    void finish(Mixture& mixture, const Mixture::EliminatedDrag& eliminated)
    {
        const Mixture::AppliedPressure applied = mixture.applyPressure(eliminated, scene.liquid);
        moveFabric(mixture.vertexLoads(applied));
        mixture.recoverPhaseVelocities(applied, state, scene.liquid);
    }
    Mixture::EliminatedDrag eliminateDragWithoutPressure(Mixture& mixture)
    {
        BlockArray<double, 3> noPressure;
        noPressure.resize(scene.grid.count());
        for (int b = 0; b < scene.grid.count(); ++b) std::fill_n(noPressure.block(b), 3 * kBlockCells, 0.0);
        return mixture.eliminateDrag(*shared, scene.field, scene.liquid, noPressure);
    }
    bool find(Mixture& mixture)
    {
        const Mixture::MetFabric met{sorter.sort(scene.grid, state), state,
                                     isDragByFabric(settings.coupling) ? std::span<const double>(distance) : std::span<const double>(), nullptr};
        shared = mixture.findSharedFaces(scene.cut(), Vec3::Zero(), kStep, met, scene.liquid);
        return shared.has_value();
    }

    GridScene scene;
    Fabric fabric;
    std::vector<double> distance;  ///< of the liquid from each vertex [cells]
    VertexSorter sorter;
    FabricState state;
    Settings settings;
    std::optional<Mixture::SharedFaces> shared;  ///< of the last find()
};

}  // namespace sim::test
