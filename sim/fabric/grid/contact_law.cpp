#include "sim/fabric/grid/contact_law.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sim {

using Eigen::Matrix2d;
using Eigen::Vector2d;

ContactModuli::ContactModuli(const FabricMaterial& material)
{
    const double nu = material.poisson;
    shear = material.contactStiffness * material.shear();
    lame = material.contactStiffness * material.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    const double sine = std::sin(material.frictionAngle);
    cone = std::sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
    coulomb = std::tan(material.frictionAngle);
}

namespace sheet {

Mat3 frameOf(const Vec3& t0, const Vec3& t1)
{
    Mat3 q;
    q.col(0) = t0.normalized();
    q.col(2) = t0.cross(t1).normalized();
    q.col(1) = q.col(2).cross(q.col(0));
    return q;
}

double energy(const ContactModuli& m, const Vec3& r)
{
    const double pressed = 1.0 - r[2];
    if (pressed < kLeastCompression) return 0.0;
    return m.normal() / 3.0 * pressed * pressed * pressed + 0.5 * m.shear * (r[0] * r[0] + r[1] * r[1]);
}

Vec3 stress(const ContactModuli& m, const Vec3& r)
{
    const double pressed = 1.0 - r[2];
    if (pressed < kLeastCompression) return Vec3::Zero();
    return {m.shear * r[0], m.shear * r[1], -m.normal() * pressed * pressed};
}

Vec3 stiffness(const ContactModuli& m, const Vec3& r, const Vec3& last)
{
    const double first = std::max(1.0 - r[2], 0.0), pressed = std::max(first, 1.0 - std::max(last[2], kLeastThickness));
    if (pressed < kLeastCompression) return Vec3::Zero();
    return {m.shear, m.shear, m.normal() * (first + pressed)};
}

double stickFraction(const ContactModuli& m, const Vec3& r)
{
    const double pressed = 1.0 - std::clamp(r[2], kLeastThickness, 1.0);
    const double friction = m.shear * std::hypot(r[0], r[1]), bound = m.coulomb * m.normal() * pressed * pressed;
    return friction > bound ? bound / friction : 1.0;
}

Vec3 returnMapping(const ContactModuli& m, const Vec3& r)
{
    if (r[2] >= 1.0) return Vec3::UnitZ();
    const double share = stickFraction(m, r);
    return {share * r[0], share * r[1], std::max(r[2], kLeastThickness)};
}

Vec3 scaledStrain(const Vec3& r, double share) { return {share * r[0], share * r[1], 1.0 - share * (1.0 - r[2])}; }

}  // namespace sheet

namespace yarn {

namespace {

Matrix2d rotation(double angle)
{
    Matrix2d m;
    m << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return m;
}

Vector2d logs(const Vector2d& sigma) { return {std::log(std::max(sigma[0], kLeastThickness)), std::log(std::max(sigma[1], kLeastThickness))}; }

/// ∂ψ/∂σ.
Vector2d principal(const ContactModuli& m, const Vector2d& log)
{
    const double sum = log.sum();
    return {(2.0 * m.shear * log[0] + m.lame * sum) * std::exp(-log[0]), (2.0 * m.shear * log[1] + m.lame * sum) * std::exp(-log[1])};
}

/// The entries of a 2x2 matrix in the order of SectionStiffness.
Eigen::Vector4d entries(const Matrix2d& a) { return {a(0, 0), a(1, 0), a(0, 1), a(1, 1)}; }

}  // namespace

Mat3 frameOf(const Vec3& along, const Vec3& d2)
{
    Mat3 q;
    q.col(0) = along.normalized();
    Vec3 across = d2 - d2.dot(q.col(0)) * q.col(0);
    if (across.squaredNorm() <= 1.0e-24 * d2.squaredNorm()) across = q.col(0).unitOrthogonal();  // d2 is along the yarn: any side will do
    q.col(1) = across.normalized();
    q.col(2) = q.col(0).cross(q.col(1));
    return q;
}

Section::Section(const Matrix2d& b)
{
    const double e = 0.5 * (b(0, 0) + b(1, 1)), f = 0.5 * (b(0, 0) - b(1, 1));
    const double g = 0.5 * (b(1, 0) + b(0, 1)), h = 0.5 * (b(1, 0) - b(0, 1));
    const double even = std::hypot(e, h), odd = std::hypot(f, g);
    sigma = {even + odd, even - odd};
    const double sum = std::atan2(g, f), difference = std::atan2(h, e);
    u = rotation(0.5 * (difference + sum));
    vt = rotation(0.5 * (difference - sum));
    log = logs(sigma);
}

double energy(const ContactModuli& m, const Strain& r, const Section& section)
{
    const Vector2d& log = section.log;
    const double sum = log.sum();
    if (sum > -kLeastCompression) return 0.0;
    return m.shear * log.squaredNorm() + 0.5 * m.lame * sum * sum + 0.5 * m.shear * r.row(0).squaredNorm();
}

Strain stress(const ContactModuli& m, const Strain& r, const Section& section)
{
    Strain p = Strain::Zero();
    const Vector2d& log = section.log;
    if (log.sum() > -kLeastCompression) return p;
    p.row(0) = m.shear * r.row(0);
    p.bottomRows<2>() = section.u * principal(m, log).asDiagonal() * section.vt;
    return p;
}

bool stiffness(const ContactModuli& m, const Section& section, SectionStiffness& k)
{
    const Vector2d& log = section.log;
    const double sum = log.sum();
    k.setZero();
    if (sum > -kLeastCompression) return false;
    const Vector2d sigma(std::exp(log[0]), std::exp(log[1])), p = principal(m, log);
    const auto own = [&](int n) { return (2.0 * m.shear * (1.0 - log[n]) + m.lame * (1.0 - sum)) / (sigma[n] * sigma[n]); };
    const double a = own(0), b = own(1), c = m.lame / (sigma[0] * sigma[1]);

    // Scaling: the 2x2 block by both singular values.
    const double middle = 0.5 * (a + b), radius = std::hypot(0.5 * (a - b), c), angle = 0.5 * std::atan2(c, 0.5 * (a - b));
    const auto add = [&](double value, const Matrix2d& mode) {
        if (value > 0.0) k += value * entries(section.u * mode * section.vt) * entries(section.u * mode * section.vt).transpose();
    };
    const double cosine = std::cos(angle), sine = std::sin(angle);
    add(middle + radius, Vector2d(cosine, sine).asDiagonal());
    add(middle - radius, Vector2d(-sine, cosine).asDiagonal());
    // Turning U and V against each other, the same way and the opposite way.
    Matrix2d twist, flip;
    twist << 0.0, -1.0, 1.0, 0.0;
    flip << 0.0, 1.0, 1.0, 0.0;
    const double half = std::sqrt(0.5), difference = sigma[0] - sigma[1];
    constexpr double kEqual = 1.0e-6;  // relative difference of the singular values below which the limit is taken
    add((p[0] + p[1]) / (sigma[0] + sigma[1]), half * twist);
    add(difference > kEqual * sigma[0] ? (p[0] - p[1]) / difference : a - c, half * flip);
    return true;
}

Section onsetOfContact(const Section& section, const Section& last)
{
    Section onsetOfContact = section;
    onsetOfContact.log.setConstant(last.log.sum() > -kLeastCompression ? 0.0 : -kLeastCompression);
    onsetOfContact.sigma = onsetOfContact.log.array().exp();
    return onsetOfContact;
}

Section withDeviatoric(const Section& section, double across)
{
    Section withDeviatoric = section;
    const Vector2d middle = Vector2d::Constant(0.5 * section.log.sum());
    withDeviatoric.log = middle + across * (section.log - middle);
    withDeviatoric.sigma = withDeviatoric.log.array().exp();
    return withDeviatoric;
}

void scaleDeviatoric(const Section& section, double across, SectionStiffness& k)
{
    const Eigen::Vector4d scaled = entries(section.u * section.sigma.asDiagonal() * section.vt), answer = k * scaled;
    const double own = scaled.dot(answer);
    k *= across;
    if (own > 0.0) k += (1.0 - across) / own * answer * answer.transpose();
}

StickFractions stickFraction(const ContactModuli& m, const Strain& r, const Section& section)
{
    const double sum = section.log.sum();
    if (sum >= 0.0) return {0.0, 0.0};
    StickFractions stickFraction;
    const double deviator = std::abs(0.5 * (section.log[0] - section.log[1])) * std::sqrt(2.0);
    const double excess = deviator + (m.lame + m.shear) / m.shear * sum * m.cone;
    if (excess > 0.0) stickFraction.across = (deviator - excess) / deviator;
    const double friction = m.shear * r.row(0).norm();
    const double bound = m.coulomb * 0.5 * principal(m, withDeviatoric(section, stickFraction.across).log).norm();
    if (friction > bound) stickFraction.along = bound / friction;
    return stickFraction;
}

Strain returnMapping(const ContactModuli& m, const Strain& r)
{
    const Section section = sectionOf(r);
    const StickFractions share = stickFraction(m, r, section);
    Strain kept;
    kept.row(0) = share.along * r.row(0);
    if (section.log.sum() >= 0.0) kept.bottomRows<2>() = section.u * section.vt;
    else kept.bottomRows<2>() = section.u * withDeviatoric(section, share.across).sigma.asDiagonal() * section.vt;
    return kept;
}

Strain scaledStrain(const Strain& r, double share)
{
    if (share == 1.0) return r;
    const Section section = sectionOf(r);
    Strain scaledStrain;
    scaledStrain.row(0) = share * r.row(0);
    scaledStrain.bottomRows<2>() = section.u * Vector2d((share * section.log).array().exp()).asDiagonal() * section.vt;
    return scaledStrain;
}

}  // namespace yarn

}  // namespace sim
