#include "sim/fabric/shells/shells.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/fabric/shells/shell_rest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sim {

namespace {

constexpr std::size_t kBatchesPerTask = 16;

/// Number of the block (i, j), i ≤ j, of the upper half.
constexpr int blockOf(int i, int j) { return i * kShellVertices - i * (i - 1) / 2 + j - i; }

template <class Batch>
ShellCorners<Pack> cornersOf(const Batch& batch, std::span<const Vec3> x)
{
    ShellCorners<Pack> c{};
    for (int i = 0; i < kShellVertices; ++i)
        for (int l = 0; l < kLanes; ++l)
            if (batch.vertex[i][l] >= 0) setLane(c[i], l, x[batch.vertex[i][l]]);
    for (int l = 0; l < kLanes; ++l) {
        if (batch.vertex[0][l] < 0) {  // an unused lane: any triangle
            setLane(c[1], l, Vec3::UnitX());
            setLane(c[2], l, Vec3::UnitY());
        }
        for (int k = 0; k < 3; ++k)  // no neighbour: the flat continuation
            if (batch.vertex[3 + k][l] < 0) setLane(c[3 + k], l, laneOf(c[(k + 1) % 3], l) + laneOf(c[(k + 2) % 3], l) - laneOf(c[k], l));
    }
    return c;
}

}  // namespace

Shells::Shells(const Fabric& fabric, const FabricSettings& settings) : settings_(settings)
{
    const std::span<const Vec3i> faces = fabric.faces.vertices;
    if (faces.empty()) return;
    across_ = verticesAcross(faces);
    row_.assign(fabric.vertexCount(), -1);
    for (const Vec3i& f : faces)
        for (int k = 0; k < 3; ++k) row_[f[k]] = 0;
    for (std::size_t v = 0; v < row_.size(); ++v)
        if (row_[v] == 0) {
            row_[v] = static_cast<int>(vertices_.size());
            vertices_.push_back(static_cast<int>(v));
        }

    pattern_.resize(vertices_.size());
    const auto sixOf = [&](std::size_t f) {
        std::array<int, kShellVertices> six{};
        for (int k = 0; k < 3; ++k) {
            six[k] = row_[faces[f][k]];
            six[3 + k] = across_[f][k] >= 0 ? row_[across_[f][k]] : -1;
        }
        return six;
    };
    neighbors_.resize(vertices_.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::array<int, kShellVertices> six = sixOf(f);
        for (int i = 0; i < kShellVertices; ++i)
            for (int j = 0; j < kShellVertices; ++j) {
                if (six[i] < 0 || six[j] < 0 || !areTied(i, j)) continue;
                pattern_[six[i]].push_back(six[j]);
                if (i < 3 && j < 3) neighbors_[six[i]].push_back(six[j]);
            }
    }
    for (auto* rows : {&pattern_, &neighbors_})
        for (std::vector<int>& columns : *rows) {
            std::ranges::sort(columns);
            columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
        }

    const BlockMatrix pattern(pattern_);
    for (std::size_t begin = 0; begin < faces.size(); begin += kLanes)
        fill(fabric, settings, begin, std::min(faces.size(), begin + kLanes), pattern, batches_.emplace_back());
    colorTasks(fabric.vertexCount());
    for (const FabricMaterial& m : fabric.materials) damped_ = damped_ || (m.dampingViscosity > 0.0 && (m.dampBending || m.dampStretching));
}

/// Greedy: each task takes the first colour that none before it with a vertex of its own has.
void Shells::colorTasks(std::size_t vertices)
{
    std::vector<std::vector<int>> colorsAt(vertices);
    const int tasks = static_cast<int>((batches_.size() + kBatchesPerTask - 1) / kBatchesPerTask);
    for (int task = 0; task < tasks; ++task) {
        std::vector<int> own;
        for (std::size_t b = task * kBatchesPerTask; b < std::min(batches_.size(), (task + 1) * kBatchesPerTask); ++b)
            for (const Lanes& lanes : batches_[b].vertex) std::ranges::copy_if(lanes, std::back_inserter(own), [](int v) { return v >= 0; });
        std::vector<char> isTaken(tasks_.size() + 1, 0);
        for (int v : own)
            for (int color : colorsAt[v]) isTaken[color] = 1;
        const int color = static_cast<int>(std::ranges::find(isTaken, 0) - isTaken.begin());
        if (color == static_cast<int>(tasks_.size())) tasks_.emplace_back();
        tasks_[color].push_back(task);
        for (int v : own)
            if (colorsAt[v].empty() || colorsAt[v].back() != color) colorsAt[v].push_back(color);
    }
}

/// The faces from number begin to end, a pack of them at most.
void Shells::fill(const Fabric& fabric, const FabricSettings& settings, std::size_t begin, std::size_t end, const BlockMatrix& pattern,
                  Batch& batch) const
{
    for (auto& lanes : batch.vertex) lanes.fill(-1);
    for (auto& lanes : batch.entry) lanes.fill(-1);
    batch.isTransposed.fill(0);
    for (std::size_t f = begin; f < end; ++f) {
        const int l = static_cast<int>(f - begin);
        const FabricMaterial& material = fabric.materials[fabric.faces.material[f]];
        for (int k = 0; k < 3; ++k) {
            batch.vertex[k][l] = fabric.faces.vertices[f][k];
            batch.vertex[3 + k][l] = across_[f][k];
        }
        setLane(batch.rest, l, shellRest(fabric, static_cast<int>(f), across_[f], settings));
        const double viscous = 3.0 * material.dampingViscosity / material.young;
        batch.damping[l] = material.dampStretching ? viscous : 0.0;
        batch.bendDamping[l] = material.dampBending ? viscous : 0.0;
        for (int i = 0; i < kShellVertices; ++i)
            for (int j = i; j < kShellVertices; ++j) {
                if (batch.vertex[i][l] < 0 || batch.vertex[j][l] < 0 || !areTied(i, j)) continue;
                const int ri = row_[batch.vertex[i][l]], rj = row_[batch.vertex[j][l]];
                batch.entry[blockOf(i, j)][l] = pattern.find(std::min(ri, rj), std::max(ri, rj));
                if (ri > rj) batch.isTransposed[blockOf(i, j)] |= 1u << l;
            }
    }
}

MembraneStress<Pack> Shells::stressOf(const Batch& batch, const MembraneStrain<Pack>& strain) const
{
    return settings_.membrane == MembraneModel::StVk ? stVenantKirchhoff(batch.rest, strain) : neoHookean(batch.rest, strain);
}

Shells::BendMeasure Shells::measured(const Batch& batch, const ShellBend<Pack>& bend) const
{
    BendMeasure m;
    const bool isHinge = settings_.bending == BendingModel::Hinge;
    for (int k = 0; k < 3; ++k) {
        const Pack angle = bend.angle[k], rest = batch.rest.angle[k];
        if (!isHinge || settings_.hingeMeasure == HingeMeasure::Angle) {
            m.change[k] = angle - rest;
            m.slope[k] = m.curvature[k] = broadcast(1.0);
            continue;
        }
        for (int l = 0; l < kLanes; ++l) {  // 2 tan(θ/2) or 2 sin(θ/2)
            const double half = 0.5 * angle[l], c = std::cos(half), s = std::sin(half), t = s / c;
            const bool isTan = settings_.hingeMeasure == HingeMeasure::Tan;
            const double restMeasure = isTan ? 2.0 * std::tan(0.5 * rest[l]) : 2.0 * std::sin(0.5 * rest[l]);
            const double change = (isTan ? 2.0 * t : 2.0 * s) - restMeasure;
            const double slope = isTan ? 1.0 + t * t : c, second = isTan ? t * (1.0 + t * t) : -0.5 * s;
            m.change[k][l] = change;
            m.slope[k][l] = slope;
            m.curvature[k][l] = std::max(0.0, slope * slope + change * second);
        }
    }
    return m;
}

void Shells::startStep(std::span<const Vec3> x)
{
    if (!damped_) return;
    parallelFor(batches_.size(), kBatchesPerTask, [&](std::size_t n) {
        Batch& batch = batches_[n];
        const ShellCorners<Pack> corners = cornersOf(batch, x);
        batch.startGreen = membraneStrain(batch.rest, corners).green;
        batch.startAngle = shellBend(batch.rest, corners).angle;
    });
}

void Shells::forces(std::span<const Vec3> x, double h, std::span<const int> slot, double* gradient, BlockMatrix* matrix) const
{
    for (const std::vector<int>& color : tasks_)
        parallelFor(color.size(), [&](std::size_t n) {
            const std::size_t begin = color[n] * kBatchesPerTask, end = std::min(batches_.size(), begin + kBatchesPerTask);
            for (std::size_t b = begin; b < end; ++b) addForces(batches_[b], x, h, slot, gradient, matrix);
        });
}

void Shells::addForces(const Batch& batch, std::span<const Vec3> x, double h, std::span<const int> slot, double* gradient, BlockMatrix* matrix) const
{
    const ShellRest<Pack>& rest = batch.rest;
    const ShellCorners<Pack> corners = cornersOf(batch, x);
    const Pack zero{}, one = broadcast(1.0), perStep = broadcast(damped_ ? 1.0 / h : 0.0);

    const MembraneStrain<Pack> strain = membraneStrain(rest, corners);
    const MembraneStress<Pack> elastic = stressOf(batch, strain);
    const std::array<Pack, 6>& c = elastic.tangent;
    const Pack rate = perStep * batch.damping;
    std::array<Pack, 3> stress = elastic.stress;
    if (damped_) {
        const Pack d0 = rate * (strain.green[0] - batch.startGreen[0]), d1 = rate * (strain.green[1] - batch.startGreen[1]);
        const Pack d2 = rate * (strain.green[2] - batch.startGreen[2]);
        stress[0] += c[0] * d0 + c[3] * d1 + c[4] * d2;
        stress[1] += c[3] * d0 + c[1] * d1 + c[5] * d2;
        stress[2] += c[4] * d0 + c[5] * d1 + c[2] * d2;
    }

    const ShellBend<Pack> bend = shellBend(rest, corners);
    const BendMeasure measure = measured(batch, bend);
    const Pack bendRate = perStep * batch.bendDamping;
    std::array<Pack, 3> change = measure.change;
    if (damped_)
        for (int k = 0; k < 3; ++k) change[k] += bendRate * measure.slope[k] * (bend.angle[k] - batch.startAngle[k]);
    std::array<Pack, 3> moment = timesBending(rest.bending, change);
    for (int k = 0; k < 3; ++k) moment[k] *= measure.slope[k];

    std::array<std::array<PackTriple, 3>, 3> byStrain;  // of each own vertex: ∂ε/∂x for the three strains
    for (int i = 0; i < 3; ++i) byStrain[i] = {rest.ru[i] * strain.u, rest.rw[i] * strain.w, rest.ru[i] * strain.w + rest.rw[i] * strain.u};

    for (int i = 0; i < kShellVertices; ++i) {
        PackTriple g{zero, zero, zero};
        for (int k = 0; k < 3; ++k) g += moment[k] * bend.gradient[k][i];
        if (i < 3)
            for (int s = 0; s < 3; ++s) g += (rest.area * stress[s]) * byStrain[i][s];
        for (int l = 0; l < kLanes; ++l) {
            if (batch.vertex[i][l] < 0) continue;
            double* at = gradient + slot[batch.vertex[i][l]];
            for (int a = 0; a < 3; ++a) at[a * kLanes] += g[a][l];
        }
    }
    if (!matrix) return;

    const std::array<Pack, 3> tension = positivePart(elastic.stress);
    const Pack stiff = rest.area * (one + rate);
    std::array<Pack, 6> q = rest.bending;
    q[0] *= measure.curvature[0], q[1] *= measure.curvature[1], q[2] *= measure.curvature[2];
    for (Pack& entry : q) entry *= one + bendRate;
    for (int i = 0; i < kShellVertices; ++i) {
        std::array<PackTriple, 3> bendRow;  // Q times the derivatives by vertex i
        for (int a = 0; a < 3; ++a) {
            const std::array<Pack, 3> column = timesBending(q, {bend.gradient[0][i][a], bend.gradient[1][i][a], bend.gradient[2][i][a]});
            for (int k = 0; k < 3; ++k) bendRow[k][a] = column[k];
        }
        for (int j = i; j < kShellVertices; ++j) {
            if (!areTied(i, j)) continue;
            std::array<Pack, 9> block;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    Pack v = bendRow[0][a] * bend.gradient[0][j][b];
                    for (int k = 1; k < 3; ++k) v += bendRow[k][a] * bend.gradient[k][j][b];
                    block[3 * a + b] = v;
                }
            if (j < 3) {
                for (int b = 0; b < 3; ++b) {
                    const Pack e0 = byStrain[j][0][b], e1 = byStrain[j][1][b], e2 = byStrain[j][2][b];
                    const Pack s0 = stiff * (c[0] * e0 + c[3] * e1 + c[4] * e2), s1 = stiff * (c[3] * e0 + c[1] * e1 + c[5] * e2);
                    const Pack s2 = stiff * (c[4] * e0 + c[5] * e1 + c[2] * e2);
                    for (int a = 0; a < 3; ++a) block[3 * a + b] += byStrain[i][0][a] * s0 + byStrain[i][1][a] * s1 + byStrain[i][2][a] * s2;
                }
                const Pack geometric = rest.area * (tension[0] * rest.ru[i] * rest.ru[j] + tension[1] * rest.rw[i] * rest.rw[j] +
                                                    tension[2] * (rest.ru[i] * rest.rw[j] + rest.rw[i] * rest.ru[j]));
                for (int a = 0; a < 3; ++a) block[4 * a] += geometric;
            }
            addBlock(batch, blockOf(i, j), block, *matrix);
        }
    }
}

/// Row-major block number n of eight triangles to where each has it in the matrix.
void Shells::addBlock(const Batch& batch, int n, const std::array<Pack, 9>& block, BlockMatrix& matrix) const
{
    Pack ofLane[kLanes];  // but for the last number
    std::copy_n(block.begin(), kLanes, ofLane);
    transposeLanes(ofLane);
    for (int l = 0; l < kLanes; ++l) {
        if (batch.entry[n][l] < 0) continue;
        double* at = matrix.block(batch.entry[n][l]);
        Pack values = ofLane[l];
        if ((batch.isTransposed[n] >> l & 1u) == 0) values = permuteLanes(values, PackMask{0, 3, 6, 1, 4, 7, 2, 5});
        storeFirst(at, loadPack(at) + values, kLanes);
        at[8] += block[8][l];
    }
}

std::array<double, 2> Shells::energies(std::span<const Vec3> x) const
{
    const auto of = [&](const Batch& batch) {
        const ShellCorners<Pack> corners = cornersOf(batch, x);
        const MembraneStress<Pack> m = stressOf(batch, membraneStrain(batch.rest, corners));
        const BendMeasure b = measured(batch, shellBend(batch.rest, corners));
        const std::array<Pack, 3> moment = timesBending(batch.rest.bending, b.change);
        const Pack bending = 0.5 * (moment[0] * b.change[0] + moment[1] * b.change[1] + moment[2] * b.change[2]);
        return std::array<double, 2>{sumLanes(batch.rest.area * m.energy), sumLanes(bending)};
    };
    return parallelReduce(
        batches_.size(), std::array<double, 2>{}, [&](std::size_t n) { return of(batches_[n]); },
        [](std::array<double, 2> a, std::array<double, 2> b) {
            return std::array<double, 2>{a[0] + b[0], a[1] + b[1]};
        });
}

}  // namespace sim
