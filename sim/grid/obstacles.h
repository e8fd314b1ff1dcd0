#pragma once

#include "sim/grid/block_grid.h"
#include "sim/shapes/motion.h"
#include "sim/shapes/shape.h"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace sim {

/// The solids of a scene where they are now, and how fast they move.
class Obstacles {
 public:
    void add(const Shape& shape, const Motion& motion);

    /// Put everything where it is at t0 [s], when a step begins; velocities are the displacement until t1 per time.
    void startAt(double t0, double t1);
    /// Put everything where it is at t1 [s], when a step ends; velocities are the displacement since t0 per time.
    void moveTo(double t0, double t1);

    bool empty() const { return bodies_.empty(); }
    int count() const { return static_cast<int>(bodies_.size()); }
    double steepest() const { return steepest_; }        ///< distances change by no more than this times the way [-]
    bool anyMoving() const { return anyMoving_; }        ///< whether any moves in the step of the last startAt or moveTo
    bool anyDisplaced() const { return anyDisplaced_; }  ///< whether any moves in that step or in the one before it

    double distance(const Vec3& x) const;  ///< distance to the nearest solid [cm], negative inside; infinite without any
    /// All, those that moved in this step or the one before, those that are no vessels().
    enum class Which { All, Displaced, NotVessels };
    /// Does a solid come nearer than `within` to some place of the cube around x [cm]? Rather yes than no: as if it were a ball, and for meshes
    /// a little more.
    bool reach(const Vec3& x, double halfEdge, double within, Which which = Which::All) const;
    int nearest(const Vec3& x) const;    ///< number of the nearest solid, in the order of add; there must be one
    Vec3 normal(const Vec3& x) const;    ///< unit normal out of the nearest solid [-]
    Vec3 velocity(const Vec3& x) const;  ///< velocity of the nearest solid's material point at x [cm/s]

    // Queries of one solid.
    static constexpr int kAll = -1;
    double distance(const Vec3& x, int solid) const;  ///< distance from one solid, from all for kAll [cm]
    Vec3 normal(const Vec3& x, int solid) const;
    Vec3 velocity(const Vec3& x, int solid) const;

    /// Where a path first meets a solid, and on which side.
    struct Contact {
        Vec3 x;        ///< on the solid's surface, or up to `resolution` in front of it, where it is at the end of the step [cm]
        Vec3 normal;   ///< out of the solid
        double share;  ///< share of the way that the point has gone until then
    };
    /// The way of a point through a step, straight as seen from each solid from where it is to where it wants to be at the step's end.
    class Path {
     public:
        explicit Path(const Vec3& start) : start_(start) {}
        /// Go the first `share` of the way to a place.
        void addSegment(const Vec3& to, double share) { segments_[count_++] = {to, share}; }
        static constexpr int kMaxSegments = 6;

     private:
        friend class Obstacles;
        struct Segment {
            Vec3 to;
            double share;
        };
        Vec3 start_;  ///< place of the particle at the start of the step [cm]
        std::array<Segment, kMaxSegments> segments_;
        int count_ = 0;
    };
    /// First contact of what goes on from there to another place; nothing if it meets none. Solids in which it is by more than a thousandth of
    /// `resolution` [cm] let it pass. Walls thinner than `resolution` may be missed.
    std::optional<Contact> firstContact(const Path& way, const Vec3& to, double resolution) const;
    std::optional<Contact> firstContact(const Vec3& from, const Vec3& to, double resolution) const
    {
        return firstContact(Path(from), to, resolution);
    }
    /// First contact on a straight path where all solids rest in their places at the end of the step.
    std::optional<Contact> firstContactAtEnd(const Vec3& from, const Vec3& to, double resolution) const;

    /// The farthest that a solid's point goes in the step that is somewhere in the cube around x before it, or would be if the solid were
    /// there [cm].
    double farthestMove(const Vec3& x, double halfEdge) const;

    /// Plane walls of resting boxes that hold everything: the solid fills all beyond coordinate `at` along `axis`.
    struct Wall {
        int axis;
        double at;   ///< [cm]
        bool above;  ///< the solid is on the upper side
    };
    const std::vector<Wall>& planeWalls() const { return walls_; }
    /// What a resting box that is solid outside leaves, with rounded edges: convex, so that straight ways with both ends in it meet no wall.
    struct Vessel {
        Vec3 center, half;  ///< of where its edges begin to be round [cm]
        double round;       ///< [cm]

        /// @param margin  as near to the wall is not in it [cm]
        bool holds(const Vec3& x, double margin) const
        {
            const Vec3 beyond = (x - center).cwiseAbs() - half;
            return round > margin ? beyond.cwiseMax(0.0).squaredNorm() < (round - margin) * (round - margin) : beyond.maxCoeff() < round - margin;
        }
    };
    const std::vector<Vessel>& vessels() const { return vessels_; }

 private:
    struct Body {
        Shape shape;
        Motion motion;
        Eigen::Isometry3d now, toShape;
        Eigen::Isometry3d other;  ///< place of the body at the other end of the step
        bool moving = false;      ///< whether it moves in this step
        bool displaced = false;   ///< whether it moves in this step or the one before
        bool isVessel = false;    ///< whether it is one of vessels()
        bool isOne(Which which) const { return which == Which::All || (which == Which::Displaced ? displaced : !isVessel); }
    };
    const Body* nearestBody(const Vec3& x) const;
    Vec3 velocityOf(const Body& body, const Vec3& x) const;
    template <class Start>
    std::optional<Contact> findContact(const Vec3& to, double resolution, Start&& start) const;

    void begin(double t0, double t1);
    void place(double there, double now);

    std::vector<Body> bodies_;
    std::vector<Wall> walls_;
    std::vector<Vessel> vessels_;
    double steepest_ = 1.0;
    bool anyMoving_ = false, anyDisplaced_ = false;
    double started_ = std::numeric_limits<double>::infinity();  ///< start of the last step [s]
    double startedBefore_ = 0.0;                                ///< start of the step before it [s]
    double interval_ = 0.0;                                     ///< time from the other end of the step until now [s]
};

/// Number of the plane of faces that a wall stands in, counted from cell 0; nothing if it stands between two.
std::optional<int> planeOfFaces(const BlockGrid& grid, const Obstacles::Wall& wall);

}  // namespace sim
