#pragma once

#include "sim/fabric/grid/grid_solver.h"
#include "tests/sim/fabric/pieces.h"

#include <utility>

namespace sim::testing {

inline constexpr double kCell = 0.288;

inline FabricPiece cloth(int nodes, const Vec3& origin = Vec3::Zero())
{
    FabricPiece piece = pieceOf(clothGrid({{nodes, nodes}, {0.144, 0.144}, origin}), wool(), {0.017, 0.017});
    piece.material.poisson = 0.2;
    return piece;
}

inline FabricPiece weave(int yarns, double damping = 0.0)
{
    WovenYarns shape;
    shape.yarns = {yarns, yarns};
    shape.spacing = 0.144;
    shape.amplitude = 0.072;
    shape.origin = Vec3(0.03, 0.01, -0.02);
    FabricPiece piece = pieceOf(wovenYarns(shape), wool(), {0.048, 0.048});
    piece.material.dampingViscosity = damping;
    return piece;
}

inline Settings gridSettings(TransferMethod method, int modes = 8)
{
    Settings settings;
    settings.cell = kCell;
    settings.fabric.solver = FabricSolver::Grid;
    settings.fabricTransfer.method = method;
    settings.fabricTransfer.modes = modes;
    settings.gravity.setZero();
    return settings;
}

/// Some fabric under the grid solver.
struct GridRun {
    GridRun(const std::vector<FabricPiece>& pieces, const Settings& s)
        : settings(s), fabric(assembleFabric(pieces)), state(initialState(fabric, pieces)), solver(fabric, settings, {})
    {
    }
    FabricReport step(double h)
    {
        StageTimes report;
        StageClock clock(report);
        const FabricReport done = solver.step(time, h, settings.gravity, state, clock);
        time += h;
        return done;
    }
    FabricEnergies energies() const { return solver.energies(state, settings.gravity); }
    Vec3 momentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.x.size(); ++v) sum += fabric.mass[v] * state.v[v];
        return sum;
    }

    Settings settings;
    Fabric fabric;
    FabricState state;
    GridFabricSolver solver;
    double time = 0.0;
};

/// The parts of the solver by themselves, put together at a state.
struct GridParts {
    GridParts(const std::vector<FabricPiece>& pieces, const Settings& settings)
        : fabric(assembleFabric(pieces)),
          state(initialState(fabric, pieces)),
          stiffness(fabric, settings.fabric),
          contact(fabric),
          particles(fabric, settings),
          system(fabric, stiffness, contact)
    {
        state.gridSolver.across = contact.unstrained(state);
    }
    void toFaces()
    {
        std::vector<Vec3> points;
        for (std::size_t e = 0; e < contact.size(); ++e) points.push_back(contact.position(e, state.x));
        particles.toFaces(fabric.mass, points, state);
    }
    /// Contact and stiffness.
    std::pair<ElementContact::Assembled, VertexStiffness::Assembled> assembleForces(double h)
    {
        const ElementContact::Assembled ofContact = contact.assemble(state);
        return {ofContact, stiffness.assemble(state, 0.0, h, {}, {})};
    }
    FaceSystem::Begun assemble(double h)
    {
        toFaces();
        const auto [ofContact, ofStiffness] = assembleForces(h);
        const FaceSystem::Begun begun = system.begin(particles, h);
        system.assemble(begun, ofStiffness, ofContact);
        return begun;
    }
    /// Random numbers at faces with mass and twist angles.
    FaceVector randomVector(unsigned seed) const
    {
        Noise noise(seed);
        FaceVector v;
        v.resize(system.blocks(), system.edges());
        v.twist.fill(0.0);
        for (std::size_t i = 0; i < v.faces.size(); ++i) v.faces.block(0)[i] = system.mass().block(0)[i] > 0.0 ? noise() : 0.0;
        for (std::size_t e = 0; e < system.edges(); ++e) v.twist[e] = 10.0 * noise();
        return v;
    }
    /// Rms error of v in the norm of the system's matrix, weighted by mass [cm/s].
    double error(const FaceVector& v, const FaceVector& exact)
    {
        FaceVector d = v, product;
        for (std::size_t i = 0; i < d.faces.size(); ++i) d.faces.block(0)[i] -= exact.faces.block(0)[i];
        for (std::size_t e = 0; e < system.edges(); ++e) d.twist[e] -= exact.twist[e];
        product.resize(system.blocks(), system.edges());
        system.multiply(d, product);
        return std::sqrt(dot(d, product) / std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0));
    }
    static double dot(const FaceVector& a, const FaceVector& b)
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.faces.size(); ++i) sum += a.faces.block(0)[i] * b.faces.block(0)[i];
        for (std::size_t e = 0; e < a.twist.size(); ++e) sum += a.twist[e] * b.twist[e];
        return sum;
    }

    Fabric fabric;
    FabricState state;
    VertexStiffness stiffness;
    ElementContact contact;
    FabricParticles particles;
    FaceSystem system;
};

/// A pressed element by itself, as the packs hold it.
inline EdgeContact<double> edgeOf(const ElementContact& contact, std::size_t e)
{
    const ElementContact::Local& at = contact.local(e);
    const auto symmetric = [](const Mat3& m) { return Symmetric<double>{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0)}; };
    Rows<double> mixed;
    for (int a = 0; a < 3; ++a) mixed[a] = toVec3T(at.stiffness[1].row(a));
    return {{toVec3T(at.d[0]), toVec3T(at.d[1])}, toVec3T(at.reciprocal[0]), symmetric(at.stiffness[0]), symmetric(at.stiffness[2]), mixed};
}
inline FaceContact<double> faceOf(const ElementContact& contact, std::size_t e)
{
    const ElementContact::Local& at = contact.local(e);
    const Mat3& m = at.stiffness[0];
    return {{toVec3T(at.d[0])},
            toVec3T(at.normal),
            {toVec3T(at.reciprocal[0]), toVec3T(at.reciprocal[1])},
            {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0)}};
}

/// What an element gives to the grid, through the velocity gradient, and to its corners.
struct PlainPush {
    template <class Contact>
    PlainPush(const Contact& contact, const typename Contact::Across& stress)
    {
        for (int k = 0; k < Contact::kDirections; ++k) onGrid += toVec3(stress[k]) * toVec3(contact.d[k]).transpose();
        const auto corners = contact.nodalResponse(stress);
        for (int k = 0; k < Contact::kCorners; ++k) nodalResponse[k] = toVec3(corners[k]);
    }
    Mat3 onGrid = Mat3::Zero();
    std::array<Vec3, 3> nodalResponse = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/// Energy gradient of an element.
inline PlainPush gradientOf(const ElementContact& contact, std::size_t e)
{
    const std::array<Vec3, 2>& stress = contact.stress(e).stress;
    if (contact.isEdge(e)) return PlainPush(edgeOf(contact, e), {toVec3T(stress[0]), toVec3T(stress[1])});
    return PlainPush(faceOf(contact, e), {toVec3T(stress[0])});
}

/// Its Hessian times a move by G and of the corners by u.
inline PlainPush changeOf(const ElementContact& contact, std::size_t e, const Mat3& g, const std::array<Vec3, 3>& u)
{
    const std::array<Vec3, 2>& d = contact.local(e).d;
    if (contact.isEdge(e)) {
        const EdgeContact<double> edge = edgeOf(contact, e);
        return PlainPush(edge, edge.change({toVec3T(g * d[0]), toVec3T(g * d[1])}, {toVec3T(u[0]), toVec3T(u[1])}));
    }
    const FaceContact<double> face = faceOf(contact, e);
    return PlainPush(face, face.change({toVec3T(g * d[0])}, {toVec3T(u[0]), toVec3T(u[1]), toVec3T(u[2])}));
}

/// Squeezes and shears what lies across the fabric.
inline void press(FabricState& state, double by, unsigned seed, double noise)
{
    Noise random(seed);
    for (Vec3& d : state.gridSolver.across) d = (1.0 - by) * (d + noise * random.vector());
}

}  // namespace sim::testing
