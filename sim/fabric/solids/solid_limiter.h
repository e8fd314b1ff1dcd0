#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/safe_moves.h"
#include "sim/fabric/solids/sweep.h"
#include "sim/obstacle_settings.h"

#include <span>
#include <string>
#include <vector>

namespace sim {

/// What was limited at solids.
struct SolidLimitReport {
    std::vector<int> stopped;  ///< vertices of edges and faces whose moves had to be changed, each as often as that was done
    int left = 0;              ///< edges and faces that still passed a solid or came too near: fabric then rests, or moves in halves of the time

    void clear() { stopped.clear(), left = 0; }
};

/// Where an edge or a face touches a solid with none of its vertices.
struct NearestPoint {
    int element = 0, body = 0;  ///< number of the edge or face, and of the solid among those that fabric feels
    int corners = 0;            ///< 2 or 3
    std::array<int, 3> vertices{};
    Vec3 weights = Vec3::Zero();  ///< [-]
    double radius = 0.0;          ///< radius of the fabric [cm]
};

/// Limits moves so that fabric never passes a solid's surface. Moves are checked in the frame of each solid, in which it rests while corners of the
/// fabric go straight from where they are at the start of a step to where they are at its end: no point of an edge or a face may come
/// nearer than a part of its radius on the way, however thin, pointed or fast the solid is. What would is stopped at the surface, slides
/// along it, or is carried ahead. What begins nearer may come no nearer still, and what begins inside of a solid is free to leave it: of
/// faces that a solid pierces their edges are looked at, of such edges their ends. What pins draw into a solid is looked at so too.
class SolidLimiter {
 public:
    SolidLimiter() = default;
    /// Against those of the scene that fabric feels.
    SolidLimiter(const Fabric& fabric, std::span<const ObstacleSettings> obstacles);

    bool empty() const { return bodies_.empty(); }
    /// During the next moves solids go from where they are at t0 to where they are at t1 [s].
    void moveTo(double t0, double t1);
    /// During the next moves solids rest where the last moveTo led.
    void rest();
    /// Does a solid that moves come near the box around these moves, so that it may push?
    bool movesNear(std::span<const Vec3> x, std::span<const Vec3> u);

    /// What became of moves, and which solids they came near.
    struct Limited {
        enum class Moves { Unchanged, Changed, Unsafe };
        Moves moves = Moves::Unchanged;
        bool isNear = false;    ///< near any solid
        bool isDriven = false;  ///< near one that moves
    };
    /// Makes the moves u from x safe [cm], but for those of pinned vertices; Unsafe, which they are only while solids move, if it cannot.
    /// @param mass  of each vertex [g]
    Limited limit(std::span<const Vec3> x, std::span<const double> mass, std::span<Vec3> u, SolidLimitReport& report);
    /// Makes the moves u safe while solids go on for h from t [s], by bisection of the time where that is needed: u becomes the displacement, not
    /// the path. Near are solids in the last part of the way.
    Limited limitBisected(double t, double h, std::span<const Vec3> x, std::span<const double> mass, std::span<Vec3> u, SolidLimitReport& report);
    static constexpr int kMostHalvings = 8;  ///< largest number of halvings of the time, one within the other
    /// Throws RunError: the moves u from x cannot be made safe, in however short a time.
    [[noreturn]] void throwNoSafeMove(std::span<const Vec3> x, std::span<const Vec3> u);
    /// Points at which edges and faces are nearer to solids, where the last moveTo led these, than their radius, and than their vertices; by
    /// elements, then by solids.
    const std::vector<NearestPoint>& nearestPoints(std::span<const Vec3> x);
    struct SafeShare {
        double part = 1.0;      ///< safe part of all moves together [0..1]
        bool isDriven = false;  ///< a solid near them moves
    };
    SafeShare safePart(std::span<const Vec3> x, std::span<const Vec3> u);

 private:
    static constexpr double kKept = 0.85;     ///< share of its distance that an element which begins nearer keeps: less than kNearestError leaves [-]
    static constexpr double kStays = 1.0e-6;  ///< share of its distance by which such an element may end nearer than it began [-]

    struct Body {
        std::string name;
        Shape shape;
        Motion motion;
        double steepest;                        ///< slope of its distance [-]
        Eigen::Isometry3d end, toBegin, toEnd;  ///< maps from its frame at the end, and into its frame at the beginning and at the end
        bool moves = false, isNear = false;
        std::vector<double> distance, clear;  ///< distance of each vertex at the start, and less its way past the solid [cm]
    };
    /// One that comes too near on its way.
    struct Blocked {
        int body, element, corners;
        std::array<int, 3> vertices;
        double part;   ///< part of the way that is safe [0..1]
        double lack;   ///< length by which it should get away, lacking in its distance at the start [cm]
        Vec3 weights;  ///< weights of the corners where it is nearest [-]
    };
    using Moves = std::span<Vec3>;
    using Points = std::span<const Vec3>;

    void findNear(Points x, std::span<const Vec3> u, double radii = 1.0);
    bool anyMovesNear() const;
    Limited limited(Limited::Moves moves) const { return {moves, isNear_, anyMovesNear()}; }
    void measure(Points x, std::span<const Vec3> u);
    solids::SweptElement swept(const Body& body, Points x, std::span<const Vec3> u, const int* vertices, int corners) const;
    bool slide(Points x, Moves u);
    bool slide(const Body& body, std::size_t v, bool isLast, const Vec3& x, Vec3& u) const;
    void findBlocked(Points x, std::span<const Vec3> u);
    /// An element, or an edge or a vertex of one.
    struct Part {
        int element;
        const int* vertices;
        int corners;
    };
    void checkElement(int body, const Part& part, Points x, std::span<const Vec3> u, std::vector<Blocked>& out) const;
    bool isHeld(const int* vertices, int corners) const;
    void leaveToPins();
    bool mayTouch(const Body& body, Points x, const int* vertices, int corners, double distance) const;
    void addNearest(int body, int element, Points x, const std::array<int, 3>& vertices, std::vector<NearestPoint>& out) const;
    double leastRadius(const int* vertices, int corners) const;
    using Elements = std::vector<std::array<int, 3>>;
    template <class Found, class Look>
    void collect(const Elements& elements, std::vector<std::vector<Found>>& ofChunk, std::vector<Found>& all, Look&& checkElement) const;
    void applyImpulses(Points x, std::span<const double> mass, Moves u) const;
    void carryAlong(Points x, double share, Moves u) const;
    bool mayCarry();

    const Fabric* fabric_ = nullptr;
    std::vector<Body> bodies_;
    Elements elements_;    ///< edges of yarns, whose third vertex is −1, and faces
    Elements clothEdges_;  ///< edges of cloth, each once
    bool isNear_ = false;
    std::vector<char> slid_;
    std::vector<char> isLeft_;  ///< whether pins draw each element through a solid in this step
    std::vector<std::vector<Blocked>> ofChunk_;
    std::vector<Blocked> blocked_;
    struct Carrier {
        int body = -1, changes = 0;  ///< solid with which it goes in this limit(), and how often it was another before
    };
    std::vector<Carrier> carriers_;  ///< carrier of each vertex
    std::vector<Vec3> at_, part_;    ///< place and next move of each vertex on its way in halves [cm]
    std::vector<std::vector<NearestPoint>> nearestOfChunk_;
    std::vector<NearestPoint> nearest_;
};

}  // namespace sim
