#pragma once

#include "sim/fabric/friction.h"
#include "sim/fabric/pieces/piece.h"
#include "sim/grid/block_grid.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace sim {

/// All fabric of a scene: its topology, rest shape and material. Does not change in a run.
/// Vertices, strands and faces of all pieces stand one behind the other.
struct Fabric {
    /// Yarn edges of strand s are edgeBegin(s) … edgeBegin(s + 1) − 1, in order; each strand has one vertex more than edges.
    struct Strands {
        std::vector<int> begin = {0};               ///< begin of each strand in `vertices`, and the end of the last
        std::vector<int> vertices;                  ///< vertices of all strands, in order
        std::vector<int> material;                  ///< material of each strand
        std::vector<std::array<double, 2>> radius;  ///< half axes a, b of the section of each strand [cm]

        int count() const { return static_cast<int>(begin.size()) - 1; }
        int size(int s) const { return begin[s + 1] - begin[s]; }  ///< vertices of a strand
        int vertex(int s, int j) const { return vertices[begin[s] + j]; }
        int edgeBegin(int s) const { return begin[s] - s; }
    };
    /// One per yarn edge.
    struct YarnEdges {
        std::vector<Vec2i> vertices;
        std::vector<int> strand;
        std::vector<double> restLength;               ///< [cm]
        std::vector<double> twistInertia;             ///< inertia of dry yarn against twist, J = ¼ ρφ π a b l (a² + b²) [g cm^2]
        std::vector<std::array<double, 2>> wetTwist;  ///< what J grows by per mass of water that either end has absorbed [cm^2]
        std::vector<char> twistHeld;                  ///< whether the angle follows a pin
        std::size_t size() const { return vertices.size(); }
    };
    struct Faces {
        std::vector<Vec3i> vertices;
        std::vector<int> material;
        std::vector<double> thickness;  ///< [cm]
        std::size_t size() const { return vertices.size(); }
    };
    /// Vertices with prescribed positions (Dirichlet).
    struct Pins {
        std::vector<int> vertex;  ///< ascending
        std::vector<int> motion;  ///< motion of each pinned vertex, in `motions`
        std::vector<Motion> motions;
    };

    std::vector<FabricMaterial> materials;  ///< material of each piece of the scene, in its order
    std::vector<Vec3> warp;                 ///< direction of the warp of each piece at rest
    std::vector<Vec3> rest;                 ///< position of each vertex at the start, free of stress [cm]
    std::vector<double> mass;               ///< dry mass of each vertex [g]
    std::vector<double> volume;             ///< envelope of each vertex with pores [cm^3]
    std::vector<double> radius;       ///< radius of each vertex in contact: √(ab) of a yarn, half the thickness of cloth, the larger of both [cm]
    std::vector<int> vertexMaterial;  ///< number of each vertex' piece
    std::vector<char> pinned;         ///< whether each vertex is pinned
    Strands strands;
    YarnEdges edges;
    Faces faces;
    Pins pins;

    bool empty() const { return rest.empty(); }
    std::size_t vertexCount() const { return rest.size(); }
    int pieces() const { return static_cast<int>(materials.size()); }  ///< number of the scene's pieces
    int pieceOf(int vertex) const { return vertexMaterial[vertex]; }
};

/// What contact holds and gives back when it ends [erg].
struct ContactEnergy {
    double pressed = 0.0;  ///< energy where fabric presses on itself
    double gripped = 0.0;  ///< energy held by friction of fabric on fabric that has not slid; solver vertex only
    double solids = 0.0;   ///< energy where fabric presses on solids and holds on to them
    double bridges = 0.0;  ///< part of `pressed` and `solids` in liquid bridges, below 0 by what breaking them takes

    double sum() const { return pressed + gripped + solids; }
    double springs() const { return pressed + solids - bridges; }  ///< what presses or, on solids, holds
};

/// What evolves of the fabric.
struct FabricState {
    std::vector<Vec3> x;                 ///< position of each vertex [cm]
    std::vector<Vec3> v;                 ///< [cm/s]
    std::vector<double> absorbed;        ///< mass of liquid in each vertex' pores [g]
    std::vector<double> theta;           ///< angle of each yarn edge's material frame against its reference frame [rad]
    std::vector<double> omega;           ///< rate of theta [1/s]
    std::vector<Vec3> tangent;           ///< tangent of each yarn edge when its reference frame was last transported [-]
    std::vector<Vec3> reference;         ///< first axis u of the reference frame, across the tangent [-]
    std::vector<double> referenceTwist;  ///< twist of each yarn edge's reference frame against the one before on its strand; 0 for the first [rad]

    std::vector<Vec3> acceleration;  ///< acceleration of each vertex by the fabric's own forces over the last step [cm/s^2]
    std::vector<Vec3> held;          ///< fraction of each vertex, by axes, that pins and the fabric's own forces held (heldShare) [0..1]
                                     ///< in the last step; solver grid: 0 [0..1]
    FrictionForces onObstacles;      ///< friction between points of the fabric and obstacles, as FabricObstacles counts them
    ContactEnergy stored;            ///< energy of contact at the end of the last step, with its stiffnesses
    double springStep = 0.0;         ///< step that those stiffnesses go by, as mass over its square (springStepFor); 0 before the first [s]
    double mostKinetic = 0.0;        ///< largest kinetic energy of all steps' starts [erg]

    /// Part of the state that solver vertex has.
    struct VertexSolverPart {
        double owed = 0.0;          ///< energy that it gained from nothing and that its motion could not pay for yet (owed_energy.h) [erg]
        double lastFraction = 1.0;  ///< fraction of the moves that Newton asked for, taken in the last attempt at a step [-]
        FrictionForces onFabric;    ///< friction between primitives, as contact/primitives.h counts them
        // Of integrator second_order only; empty before its first step.
        std::vector<Vec3> force;                 ///< the fabric's own force on each vertex at the end of the last step, but for impulses [dyn]
        std::vector<Vec3> meanForce;             ///< recursive mean of the force on each vertex over the steps so far (bossak.h) [dyn]
        std::vector<Vec3> meanContactForce;      ///< part of meanForce by all that touches the vertex [dyn]
        std::vector<double> torque, meanTorque;  ///< torque on each yarn edge's twist at the last step's end, and its recursive mean [dyn cm]
        double lastStep = 0.0;                   ///< length of the last step or part of one [s]
        double recoverable = 0.0;                ///< energy that its last steps took, a tenth forgotten in each, and may yet give back [erg]
    };
    /// Part of the state that solver grid has; empty until its first step.
    struct GridSolverPart {
        std::vector<Vec3> across;          ///< material directions across the elements: d2, d3 of each yarn edge, then d3 of each face [-]
        std::vector<double> modes;         ///< mode r of component a of vertex v at (a · rows + r) · vertices + v, as in Particles [cm/s]
        double sinceGather = 0.0;          ///< time that the vertices have moved since their modes were gathered [s]
        BlockGrid faceBlocks;              ///< blocks of the grid in the last step
        BlockArray<double, 3> faceChange;  ///< change of the velocities of its faces by forces on the fabric [cm/s]
    };
    VertexSolverPart vertexSolver;
    GridSolverPart gridSolver;
};

/// Inertia of the twist of a yarn edge, with the water in it [g cm^2].
inline double twistInertia(const Fabric& fabric, std::span<const double> absorbed, std::size_t edge)
{
    const Vec2i& v = fabric.edges.vertices[edge];
    const auto [first, last] = fabric.edges.wetTwist[edge];
    return fabric.edges.twistInertia[edge] + first * absorbed[v[0]] + last * absorbed[v[1]];
}

/// Puts the pieces together. Throws InputError for a strand of one vertex, edges or faces without extent, indices out of range.
Fabric assembleFabric(std::span<const FabricPiece> pieces);

/// The fabric at rest where it starts, standing still, its frames parallel along each strand, without twist.
FabricState restState(const Fabric& fabric);

/// The fabric where it starts, with the pieces' velocities and wetness; what is pinned stands still.
FabricState initialState(const Fabric& fabric, std::span<const FabricPiece> pieces, double liquidDensity = 1.0);

/// Mean velocity of all vertices, weighted by their dry masses [cm/s].
inline Vec3 meanVelocity(const Fabric& fabric, const FabricState& state)
{
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        momentum += fabric.mass[v] * state.v[v];
        mass += fabric.mass[v];
    }
    return momentum / mass;
}

/// Volume of the pores of a vertex [cm^3]: its share of the envelope less that of the fibres (fabric/README.md, Materials).
inline double poreVolume(const Fabric& fabric, std::size_t v)
{
    return fabric.volume[v] * (1.0 - fabric.materials[fabric.vertexMaterial[v]].volumeFraction);
}
/// Liquid that the pores of each vertex hold [g].
/// @param density  of the liquid [g/cm^3]
std::vector<double> poreCapacity(const Fabric& fabric, double density);

}  // namespace sim
