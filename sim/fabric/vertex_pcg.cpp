#include "sim/core/parallel.h"
#include "sim/fabric/vertex_system.h"

#include <cmath>

// Conjugate gradients for A = S + K + C. The strands' S is never multiplied with: as z = S⁻¹ r, the product S p follows from the
// recurrence of p itself (contact-design 3.3).

namespace sim {

namespace {

constexpr std::size_t kPacksPerTask = 256;

const Pack* packs(const AlignedArray<double>& v) { return reinterpret_cast<const Pack*>(v.data()); }
Pack* packs(AlignedArray<double>& v) { return reinterpret_cast<Pack*>(v.data()); }

double dot(const AlignedArray<double>& a, const AlignedArray<double>& b)
{
    const Pack *x = packs(a), *y = packs(b);
    return sumLanes(parallelReduce(
        a.size() / kLanes, Pack{}, [&](std::size_t n) { return x[n] * y[n]; }, [](Pack u, Pack v) { return u + v; }));
}

Vec3 at(const double* vector, int slot) { return {vector[slot], vector[slot + kLanes], vector[slot + 2 * kLanes]}; }

void add(double* vector, int slot, const Vec3& v)
{
    for (int a = 0; a < 3; ++a) vector[slot + a * kLanes] += v[a];
}

/// H u of a pair.
Vec3 timesContact(const ActiveContacts& c, std::size_t pair, const Vec3& u)
{
    const double across = c.frictionStiffness[pair];
    return across * u + ((c.stiffness[pair] - across) * c.normal[pair].dot(u)) * c.normal[pair];
}

}  // namespace

void VertexSystem::precondition(const double* r, double* z) const
{
    const StrandLayout& layout = rods_.layout();
    parallelFor(layout.groups.size(), [&](std::size_t g) {
        const std::size_t first = std::size_t(layout.groups[g].firstRow) * kLanes;
        strands_.solve(layout.groups[g], reinterpret_cast<const Pack*>(r + first), reinterpret_cast<Pack*>(z + first));
    });
    if (shells_.empty()) return;
    parallelFor(clothFactor_.parts(), [&](std::size_t part) {
        const int begin = clothFactor_.partBegin(static_cast<int>(part)), end = clothFactor_.partBegin(static_cast<int>(part) + 1);
        for (int row = begin; row < end; ++row) Eigen::Map<Vec3>(clothIn_.data() + 3 * row) = at(r, unknowns_.slot[shells_.vertices()[row]]);
        clothFactor_.solve(static_cast<int>(part), clothIn_.data(), clothOut_.data());
        for (int row = begin; row < end; ++row) {
            if (ownsDiagonal_[row]) continue;
            const int slot = unknowns_.slot[shells_.vertices()[row]];
            for (int a = 0; a < 3; ++a) z[slot + a * kLanes] = clothOut_[3 * row + a];
        }
    });
}

/// C p of every pair, on either side.
void VertexSystem::applyContacts(const double* p)
{
    const ActiveContacts& c = *contacts_;
    parallelFor(c.size(), 512, [&](std::size_t n) {
        std::array<Vec3, 2> moved = {Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 4; ++k) moved[k < c.firstSide[n] ? 0 : 1] += c.weights[n][k] * at(p, unknowns_.slot[c.vertices[n][k]]);
        const Vec3 both = moved[0] + moved[1];
        for (int side = 0; side < 2; ++side) {
            const Vec3 u = sideInStrands_[n][side] ? Vec3(both - moved[side]) : both;
            pairForce_[n][side] = timesContact(c, n, u);
        }
    });
}

/// q += (K + C) p.
void VertexSystem::addOffStrand(const double* p, double* q) const
{
    if (!shells_.empty()) {
        const std::vector<int>& vertices = shells_.vertices();
        parallelFor(vertices.size(), 512, [&](std::size_t row) { Eigen::Map<Vec3>(clothIn_.data() + 3 * row) = at(p, unknowns_.slot[vertices[row]]); });
        parallelFor(vertices.size(), 128, [&](std::size_t n) {
            const int row = static_cast<int>(n);
            Vec3 sum = Vec3::Zero();
            for (int e = cloth_.begin(row); e < cloth_.begin(row + 1); ++e) {
                if (ownsDiagonal_[row] && e == cloth_.diagonal(row)) continue;
                const double *m = cloth_.block(e), *v = clothIn_.data() + 3 * cloth_.column(e);
                for (int a = 0; a < 3; ++a) sum[a] += m[3 * a] * v[0] + m[3 * a + 1] * v[1] + m[3 * a + 2] * v[2];
            }
            add(q, unknowns_.slot[vertices[n]], sum);
        });
    }
    if (contacts_ && !contacts_->empty()) {
        parallelFor(fabric_.vertexCount(), 256, [&](std::size_t v) {
            if (incidenceBegin_[v] == incidenceBegin_[v + 1]) return;
            const bool isOnStrand = unknowns_.isOnStrand(static_cast<int>(v));
            Vec3 sum = Vec3::Zero();
            for (int i = incidenceBegin_[v]; i < incidenceBegin_[v + 1]; ++i) {
                const int n = incidence_[i] / 4, k = incidence_[i] % 4, side = k < contacts_->firstSide[n] ? 0 : 1;
                const double weight = contacts_->weights[n][k];
                Vec3 force = pairForce_[n][side];
                if (isOnStrand && !sideInStrands_[n][side])  // its own diagonal is in S
                    force -= timesContact(*contacts_, n, weight * at(p, unknowns_.slot[v]));
                sum += weight * force;
            }
            add(q, unknowns_.slot[v], sum);
        });
    }
    for (const Link& link : links_) {
        const int owner = unknowns_.slot[link.vertex];
        for (int n = 0; n < 16; ++n) {
            if (link.slot[n] < 0) continue;
            for (int a = 0; a < 3; ++a) {
                q[owner + a * kLanes] += link.coupling[a][n] * p[link.slot[n]];
                q[link.slot[n]] += link.coupling[a][n] * p[owner + a * kLanes];
            }
        }
    }
    for (int slot : heldSlots_) q[slot] = 0.0;
}

LinearReport VertexSystem::solve(double tolerance, double speedTolerance, double otherEnergy, int maxIterations)
{
    const std::size_t n = gradient_.size() / kLanes;
    const auto forEach = [n](auto&& body) { parallelFor((n + kPacksPerTask - 1) / kPacksPerTask, [&](std::size_t task) {
        for (std::size_t i = task * kPacksPerTask; i < std::min(n, (task + 1) * kPacksPerTask); ++i) body(i);
    }); };
    Pack *x = packs(solution_), *r = packs(residual_), *p = packs(p_), *sp = packs(sp_), *q = packs(q_);
    const Pack *z = packs(z_), *g = packs(gradient_);
    const std::size_t strandPacks = unknowns_.strandSize / kLanes;

    forEach([&](std::size_t i) {
        x[i] = Pack{};
        r[i] = -g[i];
    });
    for (int slot : heldSlots_) residual_[slot] = 0.0;
    precondition(residual_.data(), z_.data());
    for (int slot : heldSlots_) z_[slot] = 0.0;
    forEach([&](std::size_t i) {
        p[i] = z[i];
        sp[i] = i < strandPacks ? r[i] : Pack{};
    });

    LinearReport report;
    double energy = dot(residual_, z_);
    report.firstEnergy = energy;
    const double relative = std::max(energy, 0.0) * tolerance * tolerance;
    const double other = otherEnergy * 0.09 * tolerance * tolerance, speed = totalMass_ * speedTolerance * speedTolerance;
    const double enough = std::max({relative, other, speed});
    while (energy > enough && report.iterations < maxIterations) {
        if (contacts_ && !contacts_->empty()) applyContacts(p_.data());
        forEach([&](std::size_t i) { q[i] = sp[i]; });
        addOffStrand(p_.data(), q_.data());
        const double curvature = dot(p_, q_);
        if (!(curvature > 0.0)) break;
        const Pack step = broadcast(energy / curvature);
        forEach([&](std::size_t i) {
            x[i] += step * p[i];
            r[i] -= step * q[i];
        });
        precondition(residual_.data(), z_.data());
        for (int slot : heldSlots_) z_[slot] = 0.0;
        ++report.iterations;
        const double next = dot(residual_, z_);
        const Pack ratio = broadcast(next / energy);
        energy = next;
        forEach([&](std::size_t i) {
            p[i] = z[i] + ratio * p[i];
            if (i < strandPacks) sp[i] = r[i] + ratio * sp[i];
        });
    }
    report.speedError = totalMass_ > 0.0 ? std::sqrt(std::max(energy, 0.0) / totalMass_) : 0.0;
    return report;
}

}  // namespace sim
