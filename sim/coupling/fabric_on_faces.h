#pragma once

#include "sim/coupling/liquid_around.h"
#include "sim/fabric/grid/block_points.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/transfer/scatter.h"

#include <optional>
#include <span>
#include <vector>

namespace sim {

/// The fabric as liquid meets it: masses, volumes and directions on the faces of the blocks that vertices reach (coupling/README.md, Fabric on the
/// faces). Plain P2G, without modes.
class FabricOnFaces {
 public:
    FabricOnFaces(const Fabric& fabric, double liquidDensity);

    /// P2G of all fields of the vertices, which hold until the next call.
    /// @param distance  how far liquid is from each vertex (LiquidAround::Found) [cells], where envelopes are to be known; else empty
    void spread(SortedVertices& vertices, const FabricState& state, std::span<const double> distance);
    /// P2G of the velocity alone, of the vertices as they are now.
    void spreadVelocity(const FabricState& state);
    /// Takes the velocity as a solver has it on faces.
    void takeVelocity(const FabricFaces& faces);

    const BlockGrid& grid() const { return vertices_->grid; }      ///< grid of the vertices that were spread
    double massOf(int vertex) const { return massOf_[vertex]; }    ///< mass with what the vertex has absorbed [g]
    double solidOf(int vertex) const { return solidOf_[vertex]; }  ///< volume of the vertex' fibres and of what it has absorbed [cm^3]

    // Of each face; of its own component where there are several.
    BlockArray<double, 3> mass;          ///< mass with what has been absorbed [g]
    BlockArray<double, 3> velocity;      ///< [cm/s]
    BlockArray<double, 3> fibres;        ///< volume of the fibres [cm^3]
    BlockArray<double, 3> envelope;      ///< volume of fibres and pores, as the fabric is stretched now [cm^3]; where it is asked for
    BlockArray<double, 3> touched;       ///< envelope of the fabric that liquid touches [cm^3]; where it is asked for
    BlockArray<double, 3> solid;         ///< volume of the fibres and of what has been absorbed [cm^3]
    BlockArray<double, 3> shape;         ///< shape of the fabric: 1 = yarns, 0 = cloth, or between
    BlockArray<double, 3> diameter;      ///< diameter of yarns [cm]; with envelopes, where there are yarns
    BlockArray<double, 3> constriction;  ///< constriction of the flow between yarns [-]; with envelopes, where there are yarns
    BlockArray<double, 3> held;          ///< part of the mass that pins and the fabric's own forces hold against loads [0..1]
    BlockArray<double, 3> squares;       ///< o_a² of the direction o: tangent of yarns, normal of cloth

    /// Wᵀ: of(v) is what vertex v gives to the faces normal to each axis. Faces without mass stay as they are.
    template <class Of>
    void scatter(Of&& of, BlockArray<double, 3>& u);
    /// W: to(v, value) gets u at vertex v.
    template <class To>
    void gather(const BlockArray<double, 3>& u, To&& to);

 private:
    void findYarns();
    void findVolumes(const FabricState& state);
    void averageOverMass(const std::vector<double>& ofVertex, bool isUniform, BlockArray<double, 3>& mean);
    void findHeld(const FabricState& state);
    void findDirections(const FabricState& state);
    void divideByMass(BlockArray<double, 3>& u) const;

    const Fabric& fabric_;
    double liquidDensity_;                ///< [g/cm^3]
    SortedVertices* vertices_ = nullptr;  ///< vertices that were spread last
    bool hasYarns_ = false;
    std::vector<double> diameterOf_, constrictionOf_;  ///< diameter and constriction of each vertex [cm, -]
    std::vector<double> fibresOf_, shapeOf_;           ///< volume of the fibres and shape of each vertex [cm^3, -]
    std::vector<double> restLength_, restArea_;        ///< length of the edges and area of the faces at each vertex at rest, summed [cm, cm^2]
    std::vector<double> envelopeOf_;                   ///< envelope of each vertex in the step [cm^3]
    std::optional<double> fibresPerMass_;              ///< volume of fibres per mass of dry fabric, where it is one for all vertices [cm^3/g]
    bool isOneShape_ = false;                          ///< whether all is yarns, or all is cloth
    bool isOneDiameter_ = false, isOneNarrowing_ = false;
    std::vector<double> massOf_, solidOf_;   ///< massOf and solidOf of each vertex in the step [g, cm^3]
    std::vector<Vec3> squaresOf_;            ///< squares of the direction's components for each vertex
    std::vector<int> edgesBegin_, edgesAt_;  ///< yarn edges that end at each vertex
    std::vector<int> facesBegin_, facesAt_;

    FaceFields sums_;
    ScatterScratch scatter_;
    BlockPoints points_;
    FaceRows rows_;
    PointArray<3> onPoints_;
};

template <class Of>
void FabricOnFaces::scatter(Of&& of, BlockArray<double, 3>& u)
{
    sumOverBlocks(vertices_->order, vertices_->grid, rows_, u, [&](std::size_t n, FaceTile& tile) {
        for (int s = points_.begin(n); s < points_.end(n); ++s) {
            const Vec3 value = of(points_.id[s]);
            for (int a = 0; a < kAxes; ++a) onPoints_.of[a][s] = value[a];
        }
        scatterValues(points_, n, onPoints_, tile);
    });
}

template <class To>
void FabricOnFaces::gather(const BlockArray<double, 3>& u, To&& to)
{
    forEachBlock(vertices_->order, vertices_->grid, u, [&](std::size_t n, const FaceTile& tile) {
        gatherValues(tile, points_, n, onPoints_);
        for (int s = points_.begin(n); s < points_.end(n); ++s) to(points_.id[s], Vec3(onPoints_.of[0][s], onPoints_.of[1][s], onPoints_.of[2][s]));
    });
}

}  // namespace sim
