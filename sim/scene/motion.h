#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <vector>

namespace sim {

/// Keyed motion of an obstacle (later of pins): where it is and how fast at a time. Pieces act one after another.
class Motion {
 public:
    enum class Frame { World, Local };

    /// Moves by `by` between t0 and t1, speeding up over easeIn and slowing down over easeOut [s].
    void addTranslation(double t0, double t1, const Vec3& by, double easeIn, double easeOut);
    /// Turns by `angle` [rad] about a unit axis through `origin`.
    void addRotation(double t0, double t1, const Vec3& axis, double angle, const Vec3& origin, Frame frame, double easeIn, double easeOut);
    /// Swings along (or about) an axis: amplitude [cm or rad] times sin(2π frequency (t − t0)).
    void addOscillation(double t0, double t1, const Vec3& direction, double amplitude, double frequency);
    /// Passes through positions (offsets from the start) at given times.
    void addPath(const std::vector<double>& times, const std::vector<Vec3>& offsets, bool cubic);

    bool isStatic() const { return pieces_.empty(); }
    /// Position at time t relative to the one given in the scene.
    Eigen::Isometry3d transform(double t) const;
    /// Velocity at time t of the body's point that is now at x [cm/s], by central difference of transform().
    Vec3 velocity(double t, const Vec3& x) const;
    /// Does anything move in [t0, t1]?
    bool moves(double t0, double t1) const;

    struct Piece;

 private:
    std::vector<Piece> pieces_;
};

}  // namespace sim
