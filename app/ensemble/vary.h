#pragma once

#include "sim/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace app {

/// What is not the same in the runs of an ensemble.
struct Vary {
    enum class What {
        Seed,       ///< seed of sources whose particles are laid at random
        Positions,  ///< positions of the particles of all sources: those on a lattice are moved at random within their places
        Key         ///< a setting, drawn evenly from a range
    };
    What what = What::Seed;
    std::string key;               ///< dotted
    double low = 0.0, high = 0.0;  ///< in the unit that the scene's file has for the key
};

/// Reads "seed", "positions" or "dotted.key=a..b". Throws InputError.
Vary readVary(const std::string& text);

/// What one run of an ensemble sets beside what all of them do: "dotted.key=value". The same for the same number on any machine; number 0
/// leaves seeds as the scene has them. Throws InputError for a scene in which nothing can be varied so.
std::vector<std::string> setsOfRun(const std::vector<Vary>& varied, const sim::Scene& scene, std::uint64_t number);

}  // namespace app
