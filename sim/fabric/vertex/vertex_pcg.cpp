#include "sim/core/parallel.h"
#include "sim/fabric/vertex/run_sums.h"
#include "sim/fabric/vertex/vertex_system.h"

#include <algorithm>
#include <cmath>

// Conjugate gradients for A = S + K + C. The strands' S is never multiplied with: as z = S⁻¹ r, the product S p follows from the
// recurrence of p itself (fabric/vertex/README.md, Linear solve). What strands do by themselves is done group by group in one pass. Every
// component has scalars of its own; what has none that is still solved for is passed over.

namespace sim {

namespace {

Pack* packs(AlignedArray<double>& v) { return reinterpret_cast<Pack*>(v.data()); }

/// A vertex' three numbers and a 0.
HalfPack& quad(AlignedArray<double>& v, std::size_t n) { return *reinterpret_cast<HalfPack*>(v.data() + 4 * n); }

double dot(const HalfPack& a, const HalfPack& b)
{
    const HalfPack c = a * b;
    return (c[0] + c[1]) + c[2];
}

}  // namespace

/// p of the vertices that a group of strands owns, vertex by vertex.
void VertexSystem::copyByVertex(const double* p, int g)
{
    const StrandLayout& layout = rods_.layout();
    const StrandLayout::Group& group = layout.groups[g];
    for (int j = 0; j < group.vertices; ++j) {
        const double* at = p + std::size_t(group.firstRow + 4 * j) * kLanes;
        for (int l = 0; l < kLanes; ++l) {
            const int v = layout.vertex[group.firstVertex + j][l];
            if (v >= 0 && unknowns_.slot[v] == (group.firstRow + 4 * j) * kLanes + l)
                quad(pOfVertex_, v) = HalfPack{at[l], at[kLanes + l], at[2 * kLanes + l], 0.0};
        }
    }
}

bool VertexSystem::isAnyActive(const PairPack& pairs)
{
    return std::ranges::any_of(pairs.vertices[0], [&](int v) { return componentOf(v).isActive; });
}

/// C p of every pair, on each of its vertices: Bᵀ H B p, but for what S has of it.
void VertexSystem::applyPairs()
{
    parallelFor(pairs_.size(), 64, [&](std::size_t n) {
        const PairPack& pairs = pairs_[n];
        if (!isAnyActive(pairs)) return;
        std::array<PackVec3, 4> p;
        for (int k = 0; k < 4; k += 2) {  // two vertices of each pair are a row
            Pack rows[kLanes];
            for (int l = 0; l < kLanes; ++l) {
                rows[l] = joinHalves(quad(pOfVertex_, pairs.vertices[k][l]), quad(pOfVertex_, pairs.vertices[k + 1][l]));
            }
            transposeLanes(rows);
            p[k] = {rows[0], rows[1], rows[2]};
            p[k + 1] = {rows[4], rows[5], rows[6]};
        }
        const std::array<PackVec3, 4> force = n < edgePacks() ? pairs.times<2>(p) : pairs.times<1>(p);
        for (int k = 0; k < 4; k += 2) {
            const Pack zero = broadcast(0.0);
            Pack rows[kLanes] = {force[k].x, force[k].y, force[k].z, zero, force[k + 1].x, force[k + 1].y, force[k + 1].z, zero};
            transposeLanes(rows);
            for (int l = 0; l < kLanes; ++l) {
                if (pairs.incidence[k][l] == PairPack::kNone) break;
                quad(pairForce_, pairs.incidence[k][l]) = lowerHalf(rows[l]);
                quad(pairForce_, pairs.incidence[k + 1][l]) = upperHalf(rows[l]);
            }
        }
    });
}

/// C p on a vertex.
HalfPack VertexSystem::sumOfPairs(int vertex) const
{
    HalfPack sum{};
    for (int i = incidenceBegin_[vertex]; i < incidenceBegin_[vertex + 1]; ++i)
        sum += *reinterpret_cast<const HalfPack*>(pairForce_.data() + 4 * static_cast<std::size_t>(i));
    return sum;
}

/// q = S p + C p on strands.
void VertexSystem::multiplyStrands()
{
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        if (!isActive(strandPieces_[g])) return;
        const StrandLayout::Group& group = layout.groups[g];
        const std::size_t first = group.firstRow;
        const Pack *p = packs(p_) + first, *sp = packs(sp_) + first;
        Pack* q = packs(q_) + first;
        for (int r = 0; r < group.rows(); ++r) q[r] = sp[r];
        for (int j = 0; j < group.vertices && !pairs_.empty(); ++j) {
            Pack rows[kLanes] = {};
            for (int l = 0; l < kLanes; ++l) {
                const int v = layout.vertex[group.firstVertex + j][l], slot = (group.firstRow + 4 * j) * kLanes + l;
                if (v < 0 || unknowns_.slot[v] != slot || fabric_.pinned[v]) continue;
                const HalfPack sum = sumOfPairs(v);
                rows[l] = joinHalves(sum, HalfPack{});
            }
            transposeLanes(rows);
            for (int a = 0; a < 3; ++a) q[4 * j + a] += rows[a];
        }
        Pack product{};
        for (int r = 0; r < group.rows(); ++r) product += p[r] * q[r];
        laneDot_[g] = product;
    });
}

/// What shared vertices tie together, and takes back the diagonals of C that S has: added to q and p·q.
void VertexSystem::applyLinks()
{
    for (const UncoupledVertex& loose : uncoupled_) {
        const HalfPack p = quad(pOfVertex_, loose.vertex);
        const Vec3 u(p[0], p[1], p[2]), force = loose.block * u;
        const int slot = unknowns_.slot[loose.vertex];
        for (int a = 0; a < 3; ++a) q_[slot + a * kLanes] -= force[a];
        componentOf(loose.vertex).curvature -= u.dot(force);
    }
    for (const Link& link : links_) {
        if (fabric_.pinned[link.vertex]) continue;
        const int owner = unknowns_.slot[link.vertex];
        double product = 0.0;
        for (int n = 0; n < 16; ++n) {
            if (link.slot[n] < 0) continue;
            for (int a = 0; a < 3; ++a) {
                const double here = p_[owner + a * kLanes], there = p_[link.slot[n]], coupling = link.coupling[a][n];
                q_[owner + a * kLanes] += coupling * there;
                q_[link.slot[n]] += coupling * here;
                product += 2.0 * coupling * here * there;
            }
        }
        componentOf(link.vertex).curvature += product;
    }
}

/// q of vertices on cloth, and their part of p·q that is not counted yet.
void VertexSystem::multiplyCloth()
{
    const std::vector<int>& vertices = shells_.vertices();
    std::ranges::fill(runDot_, 0.0);
    parallelFor(cloth_.chunks(), [&](std::size_t chunk) {
        const int first = static_cast<int>(chunk) * BlockMatrix::kRowsAtOnce;
        if (!isAnyRowActive(first, first + BlockMatrix::kRowsAtOnce)) return;
        RunSums dots(runDot_);
        cloth_.timesChunk(
            static_cast<int>(chunk), [&](int row) { return quad(pOfVertex_, vertices[row]); },
            [&](int row, HalfPack sum) {
                const int v = vertices[row], slot = unknowns_.slot[v];
                if (fabric_.pinned[v]) return;
                if (!ownsDiagonal_[row] && !pairs_.empty()) sum += sumOfPairs(v);
                for (int a = 0; a < 3; ++a) {
                    double& q = q_[slot + a * kLanes];
                    q = (ownsDiagonal_[row] ? q : 0.0) + sum[a];
                }
                dots.add(runOfRow_[row], dot(quad(pOfVertex_, v), sum));
            });
    });
}

/// q = A p, and p·q.
void VertexSystem::multiply()
{
    if (!pairs_.empty()) applyPairs();
    multiplyStrands();
    if (!shells_.empty()) multiplyCloth();
    sumDots(&Component::curvature);
    applyLinks();
    for (int slot : heldSlots_) q_[slot] = 0.0;
}

/// x += step p, r −= step q, z = the preconditioner's answer to r, and r·z.
void VertexSystem::precondition()
{
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        if (!isActive(strandPieces_[g])) return;
        const Pack by = scalarsOf(strandPieces_[g], &Component::step);
        const StrandLayout::Group& group = layout.groups[g];
        const std::size_t first = group.firstRow;
        const Pack *p = packs(p_) + first, *q = packs(q_) + first;
        Pack *x = packs(solution_) + first, *r = packs(residual_) + first, *z = packs(z_) + first;
        for (int row = 0; row < group.rows(); ++row) {
            x[row] += by * p[row];
            r[row] -= by * q[row];
        }
        strands_.solve(group, r, z);
        Pack product{};
        for (int row = 0; row < group.rows(); ++row) product += r[row] * z[row];
        laneDot_[g] = product;
    });
    Pack *x = packs(solution_) + unknowns_.strandSize / kLanes, *r = packs(residual_) + unknowns_.strandSize / kLanes;
    const Pack *p = packs(p_) + unknowns_.strandSize / kLanes, *q = packs(q_) + unknowns_.strandSize / kLanes;
    for (std::size_t i = 0; i < clothPieces_.size(); ++i) {
        const Pack by = scalarsOf(clothPieces_[i], &Component::step);
        for (std::size_t row = 3 * i; row < 3 * i + 3; ++row) {
            x[row] += by * p[row];
            r[row] -= by * q[row];
        }
    }
    if (!shells_.empty()) preconditionCloth();
    sumDots(&Component::next);
}

/// z of the vertices that are on cloth only, and their r·z.
void VertexSystem::preconditionCloth()
{
    const std::vector<int>& vertices = shells_.vertices();
    std::ranges::fill(runDot_, 0.0);
    parallelFor(clothFactor_.parts(), [&](std::size_t n) {
        const int part = static_cast<int>(n), begin = clothFactor_.partBegin(part), end = clothFactor_.partBegin(part + 1);
        if (!isAnyRowActive(begin, end)) return;
        for (int row = begin; row < end; ++row) {
            const int slot = unknowns_.slot[vertices[row]];
            quad(clothIn_, row) =
                ownsDiagonal_[row] ? HalfPack{} : HalfPack{residual_[slot], residual_[slot + kLanes], residual_[slot + 2 * kLanes], 0.0};
        }
        clothFactor_.solve(part, &quad(clothIn_, 0), &quad(clothOut_, 0));
        RunSums dots(runDot_);
        for (int row = begin; row < end; ++row) {
            if (ownsDiagonal_[row]) continue;
            const int slot = unknowns_.slot[vertices[row]];
            const bool isHeld = fabric_.pinned[vertices[row]];
            double product = 0.0;
            for (int a = 0; a < 3; ++a) {
                const double z = isHeld ? 0.0 : clothOut_[4 * row + a];
                z_[slot + a * kLanes] = z;
                product += z * clothIn_[4 * row + a];
            }
            dots.add(runOfRow_[row], product);
        }
    });
}

/// p = z + ratio p and with it S p.
void VertexSystem::nextDirection()
{
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        if (!isActive(strandPieces_[g])) return;
        const Pack by = scalarsOf(strandPieces_[g], &Component::ratio);
        const std::size_t first = layout.groups[g].firstRow;
        Pack *p = packs(p_) + first, *sp = packs(sp_) + first;
        const Pack *z = packs(z_) + first, *r = packs(residual_) + first;
        for (int row = 0; row < layout.groups[g].rows(); ++row) {
            p[row] = z[row] + by * p[row];
            sp[row] = r[row] + by * sp[row];
        }
        copyByVertex(p_.data(), static_cast<int>(g));
    });
    Pack* p = packs(p_) + unknowns_.strandSize / kLanes;
    const Pack* z = packs(z_) + unknowns_.strandSize / kLanes;
    for (std::size_t i = 0; i < clothPieces_.size(); ++i) {
        const Pack by = scalarsOf(clothPieces_[i], &Component::ratio);
        for (std::size_t row = 3 * i; row < 3 * i + 3; ++row) p[row] = z[row] + by * p[row];
    }
    for (std::size_t row = 0; row < shells_.vertices().size(); ++row) {
        if (ownsDiagonal_[row]) continue;
        const int v = shells_.vertices()[row], slot = unknowns_.slot[v];
        quad(pOfVertex_, v) = HalfPack{p_[slot], p_[slot + kLanes], p_[slot + 2 * kLanes], 0.0};
    }
}

LinearReport VertexSystem::solve(const LinearTolerance& tolerance, bool isFirst, int maxIterations)
{
    for (AlignedArray<double>* v : {&solution_, &p_, &sp_, &q_, &z_}) v->fill(0.0);
    for (std::size_t i = 0; i < gradient_.size(); ++i) residual_[i] = -gradient_[i];

    LinearReport report;
    beginComponents();
    precondition();
    nextDirection();
    setTargets(tolerance, isFirst);
    while (report.iterations < maxIterations && findUnsolved(report.iterations)) {
        multiply();
        findSteps();
        precondition();
        findRatios();
        nextDirection();
        ++report.iterations;
    }
    balanceFreePieces();
    report.speedError = speedError();
    report.isIndefinite = std::ranges::any_of(conjugate_, &Component::isIndefinite);
    return report;
}

}  // namespace sim
