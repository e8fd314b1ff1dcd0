#include "sim/transfer/reference.h"

#include "sim/core/check.h"

namespace sim {

Stencil::Stencil(const BlockGrid& grid, int axis, const Vec3& x) : basis{Basis1D(0.0), Basis1D(0.0), Basis1D(0.0)}
{
    for (int a = 0; a < kAxes; ++a) {
        const double inCells = (x[a] - grid.origin[a]) * (1.0 / grid.dx);
        const double cell = std::floor(inCells), xi = inCells - cell;
        // Faces stand at the cell's lower side along their own axis, at its middle along the others.
        const bool upperHalf = a == axis && xi >= 0.5;
        const double middle = a != axis ? 0.5 : upperHalf ? 1.0 : 0.0;
        basis[a] = Basis1D(xi - middle);
        first[a] = static_cast<int>(cell) - 1 + (upperHalf ? 1 : 0);
    }
}

CellRef faceOfCell(const BlockGrid& grid, const Vec3i& cell)
{
    const int block = grid.find({cell.x() >> 3, cell.y() >> 3, cell.z() >> 3});
    return {block == BlockGrid::kNone ? grid.count() : block, cellInBlock(cell.x() & 7, cell.y() & 7, cell.z() & 7)};
}

namespace {

/// Call f(face, node) for the 27 faces of a stencil.
template <class F>
void forEachFace(const BlockGrid& grid, const Stencil& stencil, F&& f)
{
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) f(faceOfCell(grid, stencil.first + Vec3i(i, j, k)), Vec3i(i, j, k));
}

}  // namespace

void particlesToFacesReference(const SortedParticles& sorted, FaceFields& faces)
{
    const Particles& particles = sorted.particles;
    const BlockGrid& grid = sorted.grid;
    faces.sums.resize(grid.count());
    std::fill_n(faces.sums.block(0), faces.sums.size(), 0.0);
    for (std::size_t p = 0; p < particles.count; ++p)
        for (int axis = 0; axis < kAxes; ++axis) {
            const Stencil stencil(grid, axis, particles.position(p));
            Modes c{};
            for (int r = 0; r < particles.modeCount; ++r) c[r] = particles.mode(axis, r)[sorted.order.source[p]];
            forEachFace(grid, stencil, [&](CellRef face, const Vec3i& node) {
                const double mass = particles.mass[p] * stencil.weight(node);
                SIM_CHECK(face.block < grid.count());
                faces.sums.block(face.block, FaceFields::kMass + axis)[face.cell] += mass;
                faces.sums.block(face.block, FaceFields::kMomentum + axis)[face.cell] += mass * evaluateModes(stencil.basis, node, c);
            });
        }
}

Modes gatherModes(const BlockArray<double, 3>& velocity, const BlockGrid& grid, int axis, const Stencil& stencil, int modes)
{
    Modes c{};
    forEachFace(grid, stencil, [&](CellRef face, const Vec3i& node) {
        projectOntoModes(stencil.basis, node, velocity.block(face.block, axis)[face.cell], modes, c);
    });
    return c;
}

void facesToParticlesReference(const FaceFields& faces, const BlockGrid& grid, int modes, Particles& particles)
{
    for (std::size_t p = 0; p < particles.count; ++p)
        for (int axis = 0; axis < kAxes; ++axis) {
            const Stencil stencil(grid, axis, particles.position(p));
            const Modes c = toMonomials(stencil.basis, gatherModes(faces.velocity, grid, axis, stencil, modes));
            for (int r = 0; r < particles.modeCount; ++r) particles.mode(axis, r)[p] = c[r];
        }
}

}  // namespace sim
