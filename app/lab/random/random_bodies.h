#pragma once

#include "app/lab/random/random_source.h"

#include <string>

namespace app {

/// Things of a random scene lie above one another, so that none crosses another at the start.
struct RandomPile {
    double cell = 0.0;      ///< [cm]
    double duration = 0.0;  ///< [s]
    double height = 0.0;    ///< over the floor, of what lies there already [cm]

    /// Raise the pile by something and a gap above it; returns its middle [cm].
    double add(double thickness, double gap)
    {
        const double middle = height + 0.5 * thickness;
        height += thickness + gap;
        return middle;
    }
};

/// "[1, 2, 3]"
std::string listText(const sim::Vec3& x);

/// Lists of a scene file, each line behind "  - ".
std::string randomObstacles(RandomSource& random, RandomPile& pile);
std::string randomFabrics(RandomSource& random, RandomPile& pile);
/// @param withPool  it lies on the floor
std::string randomSources(RandomSource& random, RandomPile& pile, bool withPool);

/// "{ball: {…}}" around a place, and about so large [cm].
std::string randomShape(RandomSource& random, const sim::Vec3& center, double radius);

}  // namespace app
