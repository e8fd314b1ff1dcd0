#include "sim/shapes/motion.h"

#include "sim/core/check.h"
#include "sim/core/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

using Piece = Motion::Piece;

/// A position and its rate of change: of a number or of a point.
template <class T>
struct Course {
    T place, rate;
};

/// Smooth-step ramps of the speed over both eases, a plateau between them.
Course<double> easedCourse(const Piece& p, double t)
{
    if (t < p.begin) return {0.0, 0.0};
    if (t >= p.end) return {p.amount, 0.0};
    const double plateau = 2.0 * p.amount / (2.0 * (p.end - p.begin) - p.easeIn - p.easeOut);
    const auto rampSpeed = [](double u) { return u * u * (3.0 - 2.0 * u); };
    const auto rampWay = [](double u) { return u * u * u * (1.0 - 0.5 * u); };  // the integral of rampSpeed
    const double since = t - p.begin, left = p.end - t;
    if (since < p.easeIn) {
        const double u = since / p.easeIn;
        return {plateau * p.easeIn * rampWay(u), plateau * rampSpeed(u)};
    }
    if (left < p.easeOut) {
        const double u = left / p.easeOut;
        return {p.amount - plateau * p.easeOut * rampWay(u), plateau * rampSpeed(u)};
    }
    return {plateau * (since - 0.5 * p.easeIn), plateau};
}

Course<double> sineCourse(const Piece& p, double t)
{
    const double omega = 2.0 * kPi * p.frequency, since = std::clamp(t, p.begin, p.end) - p.begin;
    const bool moving = t >= p.begin && t < p.end;
    return {p.amount * std::sin(omega * since), moving ? p.amount * omega * std::cos(omega * since) : 0.0};
}

Course<double> course(const Piece& p, double t) { return p.course == Piece::Course::Eased ? easedCourse(p, t) : sineCourse(p, t); }

Course<Vec3> pathCourse(const Piece& p, double t)
{
    if (t < p.begin) return {p.offsets.front(), Vec3::Zero()};
    if (t >= p.end) return {p.offsets.back(), Vec3::Zero()};
    const std::size_t i = std::upper_bound(p.times.begin(), p.times.end(), t) - p.times.begin() - 1;
    const double span = p.times[i + 1] - p.times[i], u = (t - p.times[i]) / span;
    const Vec3 way = p.offsets[i + 1] - p.offsets[i];
    if (!p.cubic) return {p.offsets[i] + u * way, way / span};
    // Hermite's cubic.
    const Vec3 a = span * p.slopes[i], b = span * p.slopes[i + 1];
    return {p.offsets[i] + u * u * (3.0 - 2.0 * u) * way + u * (1.0 - u) * (1.0 - u) * a - u * u * (1.0 - u) * b,
            (6.0 * u * (1.0 - u) * way + (1.0 - u) * (1.0 - 3.0 * u) * a + u * (3.0 * u - 2.0) * b) / span};
}

/// Slopes of a cubic that does not overshoot: weighted harmonic means of the neighbouring ones, 0 at turning points and
/// at the ends.
std::vector<Vec3> monotoneSlopes(const std::vector<double>& times, const std::vector<Vec3>& offsets)
{
    std::vector<Vec3> slopes(offsets.size(), Vec3::Zero());
    for (std::size_t i = 1; i + 1 < offsets.size(); ++i) {
        const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
        for (int a = 0; a < kAxes; ++a) {
            const double p = (offsets[i][a] - offsets[i - 1][a]) / before, q = (offsets[i + 1][a] - offsets[i][a]) / after;
            const double share = (before + 2.0 * after) / (3.0 * (before + after));
            if (p * q > 0.0) slopes[i][a] = p * q / (share * q + (1.0 - share) * p);
        }
    }
    return slopes;
}

/// The motion of one piece at one time, about the frame in which it is given.
Eigen::Isometry3d pieceTransform(const Piece& p, double t)
{
    if (p.course == Piece::Course::Given) return p.given(t);
    Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
    if (p.course == Piece::Course::Path) m.translation() = pathCourse(p, t).place;
    else if (!p.turns) m.translation() = course(p, t).place * p.axis;
    else m = Eigen::Translation3d(p.origin) * Eigen::AngleAxisd(course(p, t).place, p.axis) * Eigen::Translation3d(-p.origin);
    return m;
}

/// Velocity field of a rigid body: at x it is atOrigin + spin × x.
struct Twist {
    Vec3 atOrigin = Vec3::Zero(), spin = Vec3::Zero();
};

/// Difference quotient over a span that is as short as rounding and the curvature of a motion of seconds allow.
Twist givenTwist(const Piece& p, double t)
{
    constexpr double kSpan = 1.0e-5;  // [s]
    const Eigen::Isometry3d from = p.given(t - 0.5 * kSpan), to = p.given(t + 0.5 * kSpan);
    const Eigen::AngleAxisd turn(Mat3(to.linear() * from.linear().transpose()));
    const Vec3 spin = turn.angle() / kSpan * turn.axis(), middle = 0.5 * (from.translation() + to.translation());
    return {(to.translation() - from.translation()) / kSpan - spin.cross(middle), spin};
}

Twist pieceTwist(const Piece& p, double t)
{
    if (p.course == Piece::Course::Given) return givenTwist(p, t);
    if (p.course == Piece::Course::Path) return {pathCourse(p, t).rate, Vec3::Zero()};
    const Vec3 rate = course(p, t).rate * p.axis;
    if (!p.turns) return {rate, Vec3::Zero()};
    return {p.origin.cross(rate), rate};
}

/// The velocity field of a twist, carried along by a rigid motion.
Twist moved(const Eigen::Isometry3d& m, const Twist& twist)
{
    const Vec3 spin = m.linear() * twist.spin;
    return {m.linear() * twist.atOrigin - spin.cross(m.translation()), spin};
}

void require(bool condition, const char* what)
{
    if (!condition) throw InputError(std::string("a motion's ") + what);
}

bool isUnit(const Vec3& v) { return std::abs(v.norm() - 1.0) < 1.0e-6; }

/// A piece that turns about an axis.
Piece turning(const Motion::Axis& axis)
{
    require(isUnit(axis.direction), "axis must be a unit vector");
    Piece p;
    p.turns = true;
    p.frame = axis.frame;
    p.axis = axis.direction.normalized();
    p.origin = axis.through;
    return p;
}

}  // namespace

void Motion::add(Piece piece)
{
    require(std::isfinite(piece.begin) && std::isfinite(piece.end), "span must be finite");
    require(piece.end > piece.begin, "span must end after it begins");
    require(std::isfinite(piece.amount) && std::isfinite(piece.frequency), "numbers must be finite");
    require(piece.axis.allFinite() && piece.origin.allFinite(), "axis and origin must be finite");
    require(piece.easeIn >= 0.0 && piece.easeOut >= 0.0, "eases must not be negative");
    const double span = piece.end - piece.begin;
    require(piece.easeIn + piece.easeOut <= span * (1.0 + 1.0e-9), "eases must not be longer than its span together");
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), piece.begin, [](double begin, const Piece& p) { return begin < p.begin; });
    pieces_.insert(after, std::move(piece));
}

void Motion::addTranslation(double t0, double t1, const Vec3& by, double easeIn, double easeOut)
{
    Piece p;
    p.begin = t0;
    p.end = t1;
    p.amount = by.stableNorm();
    if (p.amount > 0.0) p.axis = by / p.amount;
    p.easeIn = easeIn;
    p.easeOut = easeOut;
    add(p);
}

void Motion::addRotation(double t0, double t1, const Axis& axis, double angle, double easeIn, double easeOut)
{
    Piece p = turning(axis);
    p.begin = t0;
    p.end = t1;
    p.amount = angle;
    p.easeIn = easeIn;
    p.easeOut = easeOut;
    add(p);
}

void Motion::addOscillation(double t0, double t1, const Vec3& direction, double amplitude, double frequency)
{
    require(isUnit(direction), "direction must be a unit vector");
    Piece p;
    p.course = Piece::Course::Sine;
    p.begin = t0;
    p.end = t1;
    p.axis = direction.normalized();
    p.amount = amplitude;
    p.frequency = frequency;
    add(p);
}

void Motion::addSwing(double t0, double t1, const Axis& axis, double amplitude, double frequency)
{
    Piece p = turning(axis);
    p.course = Piece::Course::Sine;
    p.begin = t0;
    p.end = t1;
    p.amount = amplitude;
    p.frequency = frequency;
    add(p);
}

void Motion::addPath(const std::vector<double>& times, const std::vector<Vec3>& offsets, bool cubic)
{
    require(times.size() >= 2 && times.size() == offsets.size(), "path needs two keys or more");
    for (std::size_t i = 0; i < times.size(); ++i) {
        require(std::isfinite(times[i]) && offsets[i].allFinite(), "keys must be finite");
        require(i == 0 || times[i] > times[i - 1], "keys must be in the order of time");
    }
    Piece p;
    p.course = Piece::Course::Path;
    p.begin = times.front();
    p.end = times.back();
    p.times = times;
    p.offsets = offsets;
    p.cubic = cubic;
    if (cubic) p.slopes = monotoneSlopes(times, offsets);
    add(p);
}

void Motion::addGiven(std::function<Eigen::Isometry3d(double t)> place)
{
    Piece p;
    p.course = Piece::Course::Given;
    p.begin = std::numeric_limits<double>::lowest();
    p.end = std::numeric_limits<double>::max();
    p.given = std::move(place);
    add(std::move(p));
}

Eigen::Isometry3d Motion::transform(double t) const
{
    Eigen::Isometry3d all = Eigen::Isometry3d::Identity();
    for (const Piece& p : pieces_) all = p.frame == Frame::World ? pieceTransform(p, t) * all : all * pieceTransform(p, t);
    return all;
}

Vec3 Motion::velocity(double t, const Vec3& x) const
{
    Eigen::Isometry3d all = Eigen::Isometry3d::Identity();
    Twist sum;
    for (const Piece& p : pieces_) {
        const Eigen::Isometry3d m = pieceTransform(p, t);
        const Twist own = pieceTwist(p, t);
        const Twist carried = p.frame == Frame::World ? moved(m, sum) : moved(all, own);
        const Twist& added = p.frame == Frame::World ? own : sum;
        sum = {carried.atOrigin + added.atOrigin, carried.spin + added.spin};
        all = p.frame == Frame::World ? m * all : all * m;
    }
    return sum.atOrigin + sum.spin.cross(x);
}

bool Motion::moves(double t0, double t1) const
{
    const auto overlaps = [&](double begin, double end) { return t0 < t1 ? begin < t1 && end > t0 : begin <= t0 && t0 < end; };
    for (const Piece& p : pieces_) {
        if (!overlaps(p.begin, p.end)) continue;
        if (p.course == Piece::Course::Given) return true;
        if (p.course == Piece::Course::Eased && p.amount != 0.0) return true;
        if (p.course == Piece::Course::Sine && p.amount != 0.0 && p.frequency != 0.0) return true;
        for (std::size_t i = 0; i + 1 < p.times.size(); ++i)
            if (overlaps(p.times[i], p.times[i + 1]) && p.offsets[i] != p.offsets[i + 1]) return true;
    }
    return false;
}

}  // namespace sim
