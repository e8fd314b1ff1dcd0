#include "sim/fabric/grid/element_contact.h"

#include "sim/core/parallel.h"
#include "sim/fabric/grid/contact_response.h"

#include <Eigen/Geometry>

#include <cmath>

namespace sim {

namespace {

/// Interior angle at `at` over π.
double angleShare(const Vec3& at, const Vec3& b, const Vec3& c)
{
    const Vec3 u = b - at, v = c - at;
    return std::atan2(u.cross(v).norm(), u.dot(v)) / kPi;
}

yarn::Strain yarnStrain(const Mat3& q, const std::array<Vec3, 2>& d)
{
    yarn::Strain r;
    for (int k = 0; k < 2; ++k) r.col(k) = q.transpose() * d[k];
    return r;
}

}  // namespace

ElementContact::ElementContact(const Fabric& fabric) : edges_(fabric.edges.size())
{
    const auto addVolume = [&](double envelope, const FabricMaterial& m) {
        volume_.push_back(m.packing() * envelope);
        mass_.push_back(m.envelopeDensity() * envelope);
    };
    for (const FabricMaterial& m : fabric.materials) moduli_.emplace_back(m);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const int strand = fabric.edges.strand[e];
        const auto [a, b] = fabric.strands.radius[strand];
        corners_.push_back({fabric.edges.vertices[e][0], fabric.edges.vertices[e][1], -1});
        shares_.push_back({0.5, 0.5, 0.0});
        material_.push_back(fabric.strands.material[strand]);
        addVolume(kPi * a * b * fabric.edges.restLength[e], fabric.materials[material_.back()]);
    }
    for (std::size_t f = 0; f < fabric.faces.size(); ++f) {
        const Vec3i& c = fabric.faces.vertices[f];
        const Vec3 &x0 = fabric.rest[c[0]], &x1 = fabric.rest[c[1]], &x2 = fabric.rest[c[2]];
        corners_.push_back({c[0], c[1], c[2]});
        shares_.push_back({angleShare(x0, x1, x2), angleShare(x1, x2, x0), angleShare(x2, x0, x1)});
        material_.push_back(fabric.faces.material[f]);
        const double area = 0.5 * (x1 - x0).cross(x2 - x0).norm();
        addVolume(area * fabric.faces.thickness[f], fabric.materials[material_.back()]);
    }

    incidenceBegin_.assign(fabric.vertexCount() + 1, 0);
    for (const std::array<int, 3>& c : corners_)
        for (int v : c)
            if (v >= 0) ++incidenceBegin_[v + 1];
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) incidenceBegin_[v + 1] += incidenceBegin_[v];
    incidence_.resize(incidenceBegin_.back());
    std::vector<int> next(incidenceBegin_.begin(), incidenceBegin_.end() - 1);
    for (std::size_t e = 0; e < corners_.size(); ++e)
        for (int k = 0; k < 3; ++k)
            if (corners_[e][k] >= 0) incidence_[next[corners_[e][k]]++] = 3 * static_cast<int>(e) + k;
    local_.resize(corners_.size());
    stress_.resize(corners_.size());
}

std::vector<Vec3> ElementContact::unstrained(const FabricState& state) const
{
    std::vector<Vec3> across;
    for (std::size_t e = 0; e < edges_; ++e) {
        across.push_back(state.reference[e]);
        across.push_back(state.tangent[e].cross(state.reference[e]));
    }
    for (std::size_t e = edges_; e < size(); ++e) {
        const Vec3& x0 = state.x[corners_[e][0]];
        across.push_back(sheet::frameOf(state.x[corners_[e][1]] - x0, state.x[corners_[e][2]] - x0).col(2));
    }
    return across;
}

/// Changes of the directions that the prediction expects, seen from the mesh.
std::array<Vec3, 2> ElementContact::expectedMoves(std::size_t e, const Local& at, const PredictedMotion& prediction) const
{
    const auto change = [&](int corner) {
        return toVec3T(prediction.motion.velocity[corners_[e][corner]] - prediction.motion.velocity[corners_[e][0]]);
    };
    const std::array<Vec3T<double>, 2> reciprocal = {toVec3T(at.reciprocal[0]), toVec3T(at.reciprocal[1])};
    const Vec3 turn = toVec3(isEdge(e) ? angularVelocityOfEdge(reciprocal[0], change(1))
                                       : angularVelocityOfNormal(toVec3T(at.normal), reciprocal, change(1), change(2)));
    const Mat3& g = prediction.motion.gradient[e];
    return {prediction.h * (g * at.d[0] - turn.cross(at.d[0])), prediction.h * (g * at.d[1] - turn.cross(at.d[1]))};
}

/// Whether the stresses at the start or at the expected end would be felt: spread over a cell they give accelerations
/// below 4 |σ| / (m Δx).
bool ElementContact::isSignificant(std::size_t e, const Local& at, const Stress& found, const std::array<Vec3, 2>& moves,
                                   const PredictedMotion& prediction) const
{
    const std::array<Vec3, 2> last = {found.stress[0] + at.stiffness[0] * moves[0] + at.stiffness[1] * moves[1],
                                      found.stress[1] + at.stiffness[1].transpose() * moves[0] + at.stiffness[2] * moves[1]};
    const auto size = [](const std::array<Vec3, 2>& s) { return std::sqrt(s[0].squaredNorm() + s[1].squaredNorm()); };
    return 4.0 * std::max(size(found.stress), size(last)) > prediction.negligible * mass_[e] * prediction.cell;
}

ElementContact::Stress ElementContact::assembleEdge(std::size_t e, const FabricState& state, const PredictedMotion* prediction, Local& at) const
{
    const ContactModuli& m = moduli_[material_[e]];
    const Vec3 along = state.x[corners_[e][1]] - state.x[corners_[e][0]];
    at.d = {state.gridSolver.across[direction(e)], state.gridSolver.across[direction(e) + 1]};
    const Mat3 q = at.frame = yarn::frameOf(along, at.d[0]);
    at.reciprocal = {q.col(0) / along.norm(), Vec3::Zero()};
    at.normal.setZero();
    for (Mat3& k : at.stiffness) k.setZero();
    Stress found{{Vec3::Zero(), Vec3::Zero()}, 0.0, false};
    yarn::Strain r = yarnStrain(q, at.d);
    yarn::Section section = yarn::sectionOf(r);
    yarn::SectionStiffness k;
    const bool isPressed = yarn::stiffness(m, section, k);
    if (!isPressed && !prediction) return found;
    found.energy = volume_[e] * yarn::energy(m, r, section);

    std::array<Vec3, 2> moves;
    yarn::StickFractions stickFraction;
    if (prediction) {
        moves = expectedMoves(e, at, *prediction);
        const yarn::Strain expected = r + yarnStrain(q, moves);
        const yarn::Section last = yarn::sectionOf(expected);
        if (!isPressed && !yarn::stiffness(m, yarn::onsetOfContact(section, last), k)) return found;
        stickFraction = yarn::stickFraction(m, expected, last);
        yarn::scaleDeviatoric(section, stickFraction.across, k);
        // What parts takes its stress along no further than to 0.
        const double sum = section.log.sum(), change = last.log.sum() - sum;
        if (isPressed && change > -sum) k *= -sum / change;
        section = yarn::withDeviatoric(section, stickFraction.across);
        r.row(0) *= stickFraction.along;
    }
    const yarn::Strain p = yarn::stress(m, r, section);
    for (int n = 0; n < 3; ++n) {
        const int column = n / 2, other = (n + 1) / 2;
        Mat3 local = Mat3::Zero();
        if (column == other) {
            found.stress[column] = volume_[e] * (q * p.col(column));
            local(0, 0) = stickFraction.along * m.shear;
        }
        local.bottomRightCorner<2, 2>() = k.block<2, 2>(2 * column, 2 * other);
        at.stiffness[n] = volume_[e] * (q * local * q.transpose());
    }
    found.isActive = !prediction || isSignificant(e, at, found, moves, *prediction);
    return found;
}

ElementContact::Stress ElementContact::assembleFace(std::size_t e, const FabricState& state, const PredictedMotion* prediction, Local& at) const
{
    const ContactModuli& m = moduli_[material_[e]];
    const Vec3& x0 = state.x[corners_[e][0]];
    const Vec3 t0 = state.x[corners_[e][1]] - x0, t1 = state.x[corners_[e][2]] - x0;
    const Mat3 q = at.frame = sheet::frameOf(t0, t1);
    const double area = t0.cross(t1).norm();
    at.d = {state.gridSolver.across[direction(e)], Vec3::Zero()};
    at.normal = q.col(2);
    at.reciprocal = {t1.cross(at.normal) / area, at.normal.cross(t0) / area};
    for (Mat3& k : at.stiffness) k.setZero();
    Stress found{{Vec3::Zero(), Vec3::Zero()}, 0.0, false};
    const Vec3 r = q.transpose() * at.d[0];
    std::array<Vec3, 2> moves;
    Vec3 last = r, stickFraction = Vec3::Ones();
    if (prediction) {
        moves = expectedMoves(e, at, *prediction);
        last += q.transpose() * moves[0];
        stickFraction.head<2>().setConstant(sheet::stickFraction(m, last));
    }
    if (1.0 - std::min(r[2], last[2]) < kLeastCompression) return found;
    found.energy = volume_[e] * sheet::energy(m, r);
    found.stress[0] = volume_[e] * (q * stickFraction.cwiseProduct(sheet::stress(m, r)));
    at.stiffness[0] = volume_[e] * (q * stickFraction.cwiseProduct(sheet::stiffness(m, r, last)).asDiagonal() * q.transpose());
    found.isActive = !prediction || isSignificant(e, at, found, moves, *prediction);
    return found;
}

ElementContact::Assembled ElementContact::assemble(const FabricState& state, const PredictedMotion* prediction)
{
    parallelFor(size(), kElementsPerTask, [&](std::size_t e) { stress_[e] = assembleElement(e, state, prediction, local_[e]); });
    listActive();
    return Assembled();
}

ElementContact::Assembled ElementContact::assembleNone()
{
    active_.clear();
    return Assembled();
}

void ElementContact::listActive()
{
    active_.clear();
    for (std::size_t e = 0; e < size(); ++e)
        if (stress_[e].isActive) active_.push_back(static_cast<int>(e));
}

/// What an element gains by the moves of its directions, which an inactive one makes freely [erg].
double ElementContact::energyAfter(std::size_t e, const PredictedMotion& prediction) const
{
    const ContactModuli& m = moduli_[material_[e]];
    const Local& at = local_[e];
    const std::array<Vec3, 2> moves = expectedMoves(e, at, prediction);
    if (!isEdge(e)) return volume_[e] * sheet::energy(m, at.frame.transpose() * (at.d[0] + moves[0])) - stress_[e].energy;
    const yarn::Strain r = yarnStrain(at.frame, {at.d[0] + moves[0], at.d[1] + moves[1]});
    return volume_[e] * yarn::energy(m, r, yarn::sectionOf(r)) - stress_[e].energy;
}

double ElementContact::omittedEnergy(const PredictedMotion& prediction) const
{
    return parallelSum(size(), [&](std::size_t e) { return stress_[e].isActive ? 0.0 : std::max(0.0, energyAfter(e, prediction)); });
}

ElementContact::Assembled ElementContact::activate(const Assembled&, const FabricState& state, const PredictedMotion& prediction)
{
    parallelFor(size(), kElementsPerTask, [&](std::size_t e) {
        if (!stress_[e].isActive) stress_[e] = assembleElement(e, state, &prediction, local_[e]);
    });
    listActive();
    return Assembled();
}

double ElementContact::energy() const
{
    double sum = 0.0;
    for (int e : active_) sum += stress_[e].energy;
    return sum;
}

/// What an element may store after a motion: no more than it did, and than the stresses that the step was solved with took [erg].
/// @param leftOut  share of what they gain that elements may keep which were left out [0..1]
double ElementContact::energyBound(std::size_t e, const PredictedMotion& moved, double leftOut) const
{
    const Local& at = local_[e];
    if (!stress_[e].isActive) return stress_[e].energy + leftOut * std::max(0.0, energyAfter(e, moved));
    const std::array<Vec3, 2> moves = expectedMoves(e, at, moved), &first = stress_[e].stress;
    const Vec3 last0 = first[0] + at.stiffness[0] * moves[0] + at.stiffness[1] * moves[1],
               last1 = first[1] + at.stiffness[1].transpose() * moves[0] + at.stiffness[2] * moves[1];
    return std::max(0.0, stress_[e].energy + last0.dot(moves[0]) + last1.dot(moves[1]));
}

double ElementContact::gain(const PredictedMotion& moved) const
{
    return parallelSum(size(), [&](std::size_t e) { return std::min(energyAfter(e, moved), energyBound(e, moved, 1.0) - stress_[e].energy); });
}

double ElementContact::advectDirections(const PredictedMotion& moved, double maxOmitted, FabricState& state) const
{
    const double unmet = omittedEnergy(moved), leftOut = unmet > maxOmitted ? maxOmitted / unmet : 1.0;
    return parallelSum(size(), [&](std::size_t e) {
        const ContactModuli& m = moduli_[material_[e]];
        const Mat3 step = moved.h * moved.motion.gradient[e], carried = Mat3::Identity() + step + 0.5 * (step * step);
        const Vec3& x0 = state.x[corners_[e][0]];
        const Vec3 t0 = state.x[corners_[e][1]] - x0;
        const double most = energyBound(e, moved, leftOut);
        const auto excess = [&](double energy) { return energy > most ? std::sqrt(most / energy) : 1.0; };
        Vec3* d = state.gridSolver.across.data() + direction(e);
        if (isEdge(e)) {
            const std::array<Vec3, 2> between = {carried * d[0], carried * d[1]};
            const Mat3 q = yarn::frameOf(t0, between[0]);
            yarn::Strain r = yarn::returnMapping(m, yarnStrain(q, between));
            r = yarn::scaledStrain(r, excess(volume_[e] * yarn::energy(m, r, yarn::sectionOf(r))));
            for (int k = 0; k < 2; ++k) d[k] = q * r.col(k);
            return volume_[e] * yarn::energy(m, r, yarn::sectionOf(r));
        }
        const Mat3 q = sheet::frameOf(t0, state.x[corners_[e][2]] - x0);
        Vec3 r = sheet::returnMapping(m, q.transpose() * (carried * d[0]));
        r = sheet::scaledStrain(r, excess(volume_[e] * sheet::energy(m, r)));
        d[0] = q * r;
        return volume_[e] * sheet::energy(m, r);
    });
}

}  // namespace sim
