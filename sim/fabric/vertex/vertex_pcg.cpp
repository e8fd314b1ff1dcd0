#include "sim/core/parallel.h"
#include "sim/fabric/vertex/mat3_columns.h"
#include "sim/fabric/vertex/vertex_system.h"

#include <cmath>
#include <numeric>

// Conjugate gradients for A = S + K + C. The strands' S is never multiplied with: as z = S⁻¹ r, the product S p follows from the
// recurrence of p itself (fabric/vertex/README.md, Linear solve). What strands do by themselves is done group by group in one pass.

namespace sim {

namespace {

Pack* packs(AlignedArray<double>& v) { return reinterpret_cast<Pack*>(v.data()); }

/// A vertex' three numbers and a 0.
HalfPack& quad(AlignedArray<double>& v, std::size_t n) { return *reinterpret_cast<HalfPack*>(v.data() + 4 * n); }
HalfPack asQuad(const std::array<double, 4>& v) { return HalfPack{v[0], v[1], v[2], v[3]}; }

double dot(const HalfPack& a, const HalfPack& b)
{
    const HalfPack c = a * b;
    return (c[0] + c[1]) + c[2];
}

/// H u of a pair.
HalfPack times(const HalfPack& normal, double stiffness, double across, const HalfPack& u)
{
    return across * u + (stiffness * dot(normal, u)) * normal;
}

double sumOf(const std::vector<double>& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0); }

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

/// C p of every pair, on each of its vertices: Bᵀ H B p, but for what S has of it.
void VertexSystem::applyPairs()
{
    parallelFor(pairs_.size(), 512, [&](std::size_t n) {
        const PairBlock& pair = pairs_[n];
        const HalfPack normal = asQuad(pair.normal);
        HalfPack p[4], side[2] = {};
        for (int k = 0; k < 4; ++k) {
            p[k] = quad(pOfVertex_, pair.vertices[k]);
            side[k < pair.firstSide ? 0 : 1] += pair.weights[k] * p[k];
        }
        const auto ends = directionsOfPair(pair.firstSide);
        if (pair.hasLever)
            for (int d = 0; d < 2; ++d) side[pair.sideOfDirection(d)] -= Mat3Columns(pair.lever[d]) * (p[ends[d][1]] - p[ends[d][0]]);
        const HalfPack both = side[0] + side[1];
        const HalfPack on[2] = {times(normal, pair.stiffness, pair.across, pair.inStrands[0] ? side[1] : both),
                                times(normal, pair.stiffness, pair.across, pair.inStrands[1] ? side[0] : both)};
        HalfPack force[4];
        for (int k = 0; k < 4; ++k) force[k] = pair.weights[k] * on[k < pair.firstSide ? 0 : 1];
        if (pair.hasLever)
            for (int d = 0; d < 2; ++d) {
                const HalfPack turning = Mat3Columns(pair.lever[d]).transposed() * on[pair.sideOfDirection(d)];
                force[ends[d][0]] += turning;
                force[ends[d][1]] -= turning;
            }
        for (int k = 0; k < 4; ++k) quad(pairForce_, 4 * n + k) = force[k];
    });
}

/// q = S p + C p on strands; p·q of them.
double VertexSystem::multiplyStrands()
{
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const StrandLayout::Group& group = layout.groups[g];
        const std::size_t first = group.firstRow;
        const Pack *p = packs(p_) + first, *sp = packs(sp_) + first;
        Pack* q = packs(q_) + first;
        for (int r = 0; r < group.rows(); ++r) q[r] = sp[r];
        if (!pairs_.empty())
            for (int j = 0; j < group.vertices; ++j)
                for (int l = 0; l < kLanes; ++l) {
                    const int v = layout.vertex[group.firstVertex + j][l], slot = (group.firstRow + 4 * j) * kLanes + l;
                    if (v < 0 || unknowns_.slot[v] != slot || fabric_.pinned[v]) continue;
                    HalfPack sum{};
                    for (int i = incidenceBegin_[v]; i < incidenceBegin_[v + 1]; ++i)
                        sum += quad(pairForce_, 4 * incidence_[i].pair + incidence_[i].place);
                    for (int a = 0; a < 3; ++a) q_[slot + a * kLanes] += sum[a];
                }
        Pack product{};
        for (int r = 0; r < group.rows(); ++r) product += p[r] * q[r];
        partialDot_[g] = sumLanes(product);
    });
    return sumOf(partialDot_);
}

/// What shared vertices tie together, and takes back the diagonals of C that S has: added to q; their part of p·q.
double VertexSystem::applyLinks()
{
    double product = 0.0;
    for (const UncoupledVertex& loose : uncoupled_) {
        const PairBlock& pair = pairs_[loose.pair];
        const HalfPack u = quad(pOfVertex_, loose.vertex);
        const HalfPack force = pair.blocks(loose.place, loose.place).own * u;
        const int slot = unknowns_.slot[loose.vertex];
        for (int a = 0; a < 3; ++a) q_[slot + a * kLanes] -= force[a];
        product -= dot(u, force);
    }
    for (const Link& link : links_) {
        if (fabric_.pinned[link.vertex]) continue;
        const int owner = unknowns_.slot[link.vertex];
        for (int n = 0; n < 16; ++n) {
            if (link.slot[n] < 0) continue;
            for (int a = 0; a < 3; ++a) {
                const double here = p_[owner + a * kLanes], there = p_[link.slot[n]], coupling = link.coupling[a][n];
                q_[owner + a * kLanes] += coupling * there;
                q_[link.slot[n]] += coupling * here;
                product += 2.0 * coupling * here * there;
            }
        }
    }
    return product;
}

/// q of vertices on cloth; their part of p·q that is not counted yet.
double VertexSystem::multiplyCloth()
{
    const std::vector<int>& vertices = shells_.vertices();
    return parallelSum(cloth_.chunks(), [&](std::size_t chunk) {
        double product = 0.0;
        cloth_.timesChunk(
            static_cast<int>(chunk), [&](int row) { return quad(pOfVertex_, vertices[row]); },
            [&](int row, HalfPack sum) {
                const int v = vertices[row], slot = unknowns_.slot[v];
                if (fabric_.pinned[v]) return;
                if (!ownsDiagonal_[row] && !pairs_.empty())
                    for (int i = incidenceBegin_[v]; i < incidenceBegin_[v + 1]; ++i)
                        sum += quad(pairForce_, 4 * incidence_[i].pair + incidence_[i].place);
                for (int a = 0; a < 3; ++a) {
                    double& q = q_[slot + a * kLanes];
                    q = (ownsDiagonal_[row] ? q : 0.0) + sum[a];
                }
                product += dot(quad(pOfVertex_, v), sum);
            });
        return product;
    });
}

/// q = A p; returns p·q.
double VertexSystem::multiply()
{
    if (!pairs_.empty()) applyPairs();
    double product = multiplyStrands();
    if (!shells_.empty()) product += multiplyCloth();
    product += applyLinks();
    for (int slot : heldSlots_) q_[slot] = 0.0;
    return product;
}

/// x += step p, r −= step q, z = the preconditioner's answer to r; returns r·z.
double VertexSystem::precondition(double step)
{
    const StrandLayout& layout = rods_.layout();
    const Pack by = broadcast(step);
    parallelFor(layout.groups.size(), [&](std::size_t g) {
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
        partialDot_[g] = sumLanes(product);
    });
    double product = sumOf(partialDot_);
    if (shells_.empty()) return product;
    Pack *x = packs(solution_), *r = packs(residual_);
    const Pack *p = packs(p_), *q = packs(q_);
    for (int i = unknowns_.strandSize / kLanes; i < unknowns_.size / kLanes; ++i) {
        x[i] += by * p[i];
        r[i] -= by * q[i];
    }
    return product + preconditionCloth();
}

/// z of the vertices that are on cloth only; their r·z.
double VertexSystem::preconditionCloth()
{
    const std::vector<int>& vertices = shells_.vertices();
    std::array<double, 64> partial{};
    parallelFor(clothFactor_.parts(), [&](std::size_t n) {
        const int part = static_cast<int>(n), begin = clothFactor_.partBegin(part), end = clothFactor_.partBegin(part + 1);
        for (int row = begin; row < end; ++row) {
            const int slot = unknowns_.slot[vertices[row]];
            for (int a = 0; a < 3; ++a) clothIn_[3 * row + a] = ownsDiagonal_[row] ? 0.0 : residual_[slot + a * kLanes];
        }
        clothFactor_.solve(part, clothIn_.data(), clothOut_.data());
        double product = 0.0;
        for (int row = begin; row < end; ++row) {
            if (ownsDiagonal_[row]) continue;
            const int slot = unknowns_.slot[vertices[row]];
            const bool isHeld = fabric_.pinned[vertices[row]];
            for (int a = 0; a < 3; ++a) {
                z_[slot + a * kLanes] = isHeld ? 0.0 : clothOut_[3 * row + a];
                product += z_[slot + a * kLanes] * clothIn_[3 * row + a];
            }
        }
        partial[n] = product;
    });
    double sum = 0.0;
    for (double product : partial) sum += product;
    return sum;
}

/// p = z + ratio p and with it S p.
void VertexSystem::nextDirection(double ratio)
{
    const StrandLayout& layout = rods_.layout();
    const Pack by = broadcast(ratio);
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const std::size_t first = layout.groups[g].firstRow;
        Pack *p = packs(p_) + first, *sp = packs(sp_) + first;
        const Pack *z = packs(z_) + first, *r = packs(residual_) + first;
        for (int row = 0; row < layout.groups[g].rows(); ++row) {
            p[row] = z[row] + by * p[row];
            sp[row] = r[row] + by * sp[row];
        }
        copyByVertex(p_.data(), static_cast<int>(g));
    });
    Pack* p = packs(p_);
    const Pack* z = packs(z_);
    for (int i = unknowns_.strandSize / kLanes; i < unknowns_.size / kLanes; ++i) p[i] = z[i] + by * p[i];
    for (std::size_t row = 0; row < shells_.vertices().size(); ++row) {
        if (ownsDiagonal_[row]) continue;
        const int v = shells_.vertices()[row], slot = unknowns_.slot[v];
        quad(pOfVertex_, v) = HalfPack{p_[slot], p_[slot + kLanes], p_[slot + 2 * kLanes], 0.0};
    }
}

LinearReport VertexSystem::solve(const LinearTolerance& tolerance, double stepEnergy, int maxIterations)
{
    solution_.fill(0.0);
    p_.fill(0.0);
    sp_.fill(0.0);
    q_.fill(0.0);
    for (std::size_t i = 0; i < gradient_.size(); ++i) residual_[i] = -gradient_[i];

    LinearReport report;
    double energy = precondition(0.0);
    nextDirection(0.0);
    report.firstEnergy = energy;
    const double share = tolerance.share * tolerance.share, speed = totalMass_ * tolerance.speed * tolerance.speed;
    const double most = totalMass_ * tolerance.most * tolerance.most;
    const double enough = std::min(std::max({share * energy, 0.09 * share * stepEnergy, speed}), most);
    // One iteration at least, above round-off: as steps begin with the forces of the last, errors too small for one would stay for good.
    const double roundOff = totalMass_ * tolerance.roundOff * tolerance.roundOff;
    const double last = std::max(std::min(enough, tolerance.left * tolerance.left * energy), roundOff);
    while (report.iterations < maxIterations && energy > (report.iterations == 0 ? roundOff : last)) {
        const double curvature = multiply();
        if (!(curvature > 0.0)) break;
        const double next = precondition(energy / curvature);
        nextDirection(next / energy);
        energy = next;
        ++report.iterations;
    }
    balanceFreePieces();
    report.speedError = totalMass_ > 0.0 ? std::sqrt(std::max(energy, 0.0) / totalMass_) : 0.0;
    return report;
}

}  // namespace sim
