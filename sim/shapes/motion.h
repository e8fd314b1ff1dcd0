#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <functional>
#include <vector>

namespace sim {

/// Keyed motion of an obstacle or of pins: where it is and how fast at a time. Pieces act one after another, in
/// the order in which they begin: each moves what the earlier ones have moved. Before its span a piece has not begun,
/// after it the body stays where the piece has left it. A span that is not longer than 0, an ease that does not fit
/// into it, an axis that is not a unit vector or a number that is not finite throws InputError.
class Motion {
 public:
    /// World: the axis stands still while the body moves. Local: the axis is fixed to the body, given for the body as
    /// in the scene.
    enum class Frame { World, Local };

    /// A line about which a body turns: along a unit vector, through a point.
    struct Axis {
        Vec3 direction;
        Vec3 through;  ///< [cm]
        Frame frame = Frame::World;
    };

    /// Moves by `by` between t0 and t1, speeding up over easeIn and slowing down over easeOut [s].
    void addTranslation(double t0, double t1, const Vec3& by, double easeIn, double easeOut);
    /// Turns by `angle` [rad] about an axis.
    void addRotation(double t0, double t1, const Axis& axis, double angle, double easeIn, double easeOut);
    /// Swings along a unit direction: amplitude [cm] times sin(2π frequency (t − t0)).
    void addOscillation(double t0, double t1, const Vec3& direction, double amplitude, double frequency);
    /// Swings about an axis: amplitude [rad] times sin(2π frequency (t − t0)).
    void addSwing(double t0, double t1, const Axis& axis, double amplitude, double frequency);
    /// Passes through positions (offsets from the scene's) at given times, ascending, two or more. Cubic: smooth, at
    /// rest at both ends, and never beyond the positions on either side (Fritsch and Butland 1984); else along straight
    /// lines.
    void addPath(const std::vector<double>& times, const std::vector<Vec3>& offsets, bool cubic);
    /// Goes at all times where a program says, which knows where at any time, and of one step says the same whenever it is asked.
    void addGiven(std::function<Eigen::Isometry3d(double t)> place);

    bool isStatic() const { return pieces_.empty(); }
    /// Position at time t relative to the one given in the scene.
    Eigen::Isometry3d transform(double t) const;
    /// Velocity at time t of the body's point that is now at x [cm/s]: the exact derivative of transform(), from the
    /// right where it jumps; of a motion that a program gives a difference quotient.
    Vec3 velocity(double t, const Vec3& x) const;
    /// Does anything move in [t0, t1]? What a program gives may, also where it ends where it began.
    bool moves(double t0, double t1) const;

    /// One of the motions above: along or about an axis by a distance or angle that depends on time, along a path, or as given.
    struct Piece {
        enum class Course { Eased, Sine, Path, Given };
        Course course = Course::Eased;
        bool turns = false;  ///< whether it turns about the axis, or else moves along it
        Frame frame = Frame::World;
        double begin = 0.0, end = 0.0;       ///< [s]
        Vec3 axis = Vec3::UnitX();           ///< unit
        Vec3 origin = Vec3::Zero();          ///< [cm]
        double amount = 0.0;                 ///< end of an eased course, amplitude of a sine [cm or rad]
        double easeIn = 0.0, easeOut = 0.0;  ///< [s]
        double frequency = 0.0;              ///< [1/s]
        std::vector<double> times;           ///< times of a path [s]
        std::vector<Vec3> offsets, slopes;   ///< offsets [cm] and slopes [cm/s] of the path at these times
        bool cubic = false;
        std::function<Eigen::Isometry3d(double t)> given;
    };

 private:
    void add(Piece piece);

    std::vector<Piece> pieces_;
};

}  // namespace sim
