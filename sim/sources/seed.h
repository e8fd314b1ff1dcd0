#pragma once

#include "sim/scene/scene.h"
#include "sim/shapes/shape.h"

#include <span>
#include <vector>

namespace sim {

/// A source to be filled with particles, at one time (sources/README.md, Filling).
struct SeedPlan {
    Shape source;
    std::vector<Shape> solids;  ///< no particle is laid inside of these
    FillSettings fill;
    double dx = 0.0;                 ///< cell of the grid [cm]
    Vec3 gridOrigin = Vec3::Zero();  ///< lower corner of cell (0, 0, 0) [cm]
    std::uint64_t stream = 0;        ///< number of the source: others draw other random numbers
    /// A source that gives liquid for a while: the pattern moves with the liquid, so that places enter at one side as
    /// they leave at the other, and whatever is laid anew fits to what was laid before. 0 for a body that is laid once.
    Vec3 velocity = Vec3::Zero();  ///< [cm/s]
    double age = 0.0;              ///< time since the source began [s]
    Vec3 moved = Vec3::Zero();     ///< how far the pattern has moved since places of it were last laid [cm]
    double regionVolume = 0.0;     ///< boundedVolume(regionOf(plan), dx), if it is known already [cm^3]
};

/// Liquid that is there already: no particle is laid where the pattern has one.
struct LiquidNearby {
    std::vector<Vec3> positions;  ///< positions of particles in the source and up to particleSpacing around it
    double volumeInside = 0.0;    ///< volume of particles in the source [cm^3]
};

struct Seeds {
    std::vector<Vec3> positions;  ///< positions in the order of the pattern's places
    double volume = 0.0;          ///< volume of each particle, or their mean [cm^3]
    std::vector<double> volumes;  ///< volume of each particle, where they are not alike [cm^3]
};

/// Where particles may be laid: the source outside of the solids.
Shape regionOf(const SeedPlan& plan);

/// What a region lets in along a move.
class Inlet {
 public:
    /// @param solids  through which nothing comes
    /// @param pitch   of the pattern [cm]
    Inlet(const Shape& region, const std::vector<Shape>& solids, const Vec3& moved, double pitch);

    /// Has what is in the region now come from outside of it?
    bool hasEntered(const Vec3& x) const { return isInside(x) && !isInside(x - moved_); }
    /// Has what is beyond the region now come through all of it? So it is where the region is thinner than the move is long, and at edges.
    bool hasPassed(const Vec3& x) const;

 private:
    bool isInside(const Vec3& x) const;

    const Shape& region_;
    Shape solids_;
    Vec3 moved_;     ///< [cm]
    double length_;  ///< length of the move [cm]
    double pitch_;   ///< [cm]
};

/// Volume that a region gives per length along a direction, of what moves through it: the area of its shadow, of each of its parts that does not
/// follow on another [cm²].
/// @param pitch  of the pattern that tells what is small [cm]
double areaAcross(const Shape& region, const Vec3& direction, double pitch);

/// Where new particles go, and how large they are: all of them together are as large as the source outside of solids; of a moving pattern, on average
/// over time. A body that is laid once where no liquid is fills its region evenly (evenVolumes); otherwise particles are alike. Those of `reference`
/// have the published volume on average, which is packingOf(Pattern::Reference) of that. Where there is liquid already, places that have
/// a particle stay as they are, and the rest is filled no further than to the region's volume. The same bits for any
/// number of threads. Throws InputError when the source is unbounded or has more than 4e8 places; the message ("is
/// unbounded …") lacks the name of the source.
Seeds seedParticles(const SeedPlan& plan, const LiquidNearby& nearby = {});

/// Volume of the particles of a pattern relative to that of the region they fill [-].
double packingOf(FillSettings::Pattern pattern);

/// Pitch of the pattern [cm].
double particleSpacing(const FillSettings& fill, double dx);

/// r* (sources/README.md, Filling): what relaxation and drawing take for the radius of a particle [cm].
double nominalRadius(const FillSettings& fill, double dx);

/// The least distance between two particles of the pattern [cm]; 0 for a jittered lattice.
double minimumDistance(const FillSettings& fill, double dx);

}  // namespace sim
