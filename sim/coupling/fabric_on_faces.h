#pragma once

#include "sim/coupling/sorted_vertices.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/fabric/grid/block_points.h"
#include "sim/transfer/scatter.h"

#include <optional>
#include <vector>

namespace sim {

/// The fabric as liquid meets it: masses, volumes and directions on the faces of the blocks that vertices reach (model-fluid 3). Plain
/// P2G, without modes.
class FabricOnFaces {
 public:
    FabricOnFaces(const Fabric& fabric, double liquidDensity, SortedVertices& vertices);

    /// P2G of all fields, of vertices that have been sorted.
    void spread(const FabricState& state);
    /// The velocity again: that of the vertices as they are now …
    void spreadVelocity(const FabricState& state);
    /// … or as a solver has it on faces.
    void takeVelocity(const FabricFaces& faces);

    const BlockGrid& grid() const { return vertices_.grid; }
    double massOf(int vertex) const { return massOf_[vertex]; }    ///< with what it has absorbed [g]
    double solidOf(int vertex) const { return solidOf_[vertex]; }  ///< volume of its fibres and of that [cm^3]

    // Of each face; of its own component where there are several.
    BlockArray<double, 3> mass;           ///< with what has been absorbed [g]
    BlockArray<double, 3> velocity;       ///< [cm/s]
    BlockArray<double, 3> fibres;         ///< volume of the fibres [cm^3]
    BlockArray<double, 3> solid;          ///< volume of them and of what has been absorbed [cm^3]
    BlockArray<double, 3> shape;          ///< 1 = yarns, 0 = cloth, or between
    BlockArray<double, 3> held;           ///< part of the mass that pins and the fabric's own forces hold against loads [0..1]
    BlockArray<double, 3> squares;        ///< o_a² of the direction o: tangent of yarns, normal of cloth

    /// Wᵀ: of(v) is what vertex v gives to the faces normal to each axis. Faces without mass stay as they are.
    template <class Of>
    void scatter(Of&& of, BlockArray<double, 3>& u);
    /// W: to(v, value) gets u at vertex v.
    template <class To>
    void gather(const BlockArray<double, 3>& u, To&& to);

 private:
    void findVolumes(const FabricState& state);
    void findShapes();
    void findHeld(const FabricState& state);
    void findDirections(const FabricState& state);
    void divideByMass(BlockArray<double, 3>& u) const;

    const Fabric& fabric_;
    double liquidDensity_;                          ///< [g/cm^3]
    SortedVertices& vertices_;
    std::vector<double> fibresOf_, shapeOf_;        ///< of each vertex [cm^3, -]
    std::optional<double> fibresPerMass_;           ///< of the dry fabric, where all vertices have the same [cm^3/g]
    bool isOneShape_ = false;                       ///< all yarns, or all cloth
    std::vector<double> massOf_, solidOf_;          ///< of each vertex, of the step [g, cm^3]
    std::vector<Vec3> squaresOf_;                   ///< of each vertex
    std::vector<int> edgesBegin_, edgesAt_;         ///< of each vertex: yarn edges that end there
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
    sumOverBlocks(vertices_.order, vertices_.grid, rows_, u, [&](std::size_t n, FaceTile& tile) {
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
    forEachBlock(vertices_.order, vertices_.grid, u, [&](std::size_t n, const FaceTile& tile) {
        gatherValues(tile, points_, n, onPoints_);
        for (int s = points_.begin(n); s < points_.end(n); ++s)
            to(points_.id[s], Vec3(onPoints_.of[0][s], onPoints_.of[1][s], onPoints_.of[2][s]));
    });
}

}  // namespace sim
