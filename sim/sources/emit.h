#pragma once

#include "sim/liquid/inflow.h"
#include "sim/scene/scene.h"
#include "sim/state.h"

#include <optional>
#include <vector>

namespace sim {

/// Size of a source's part outside of obstacles.
struct MouthSize {
    double area = 0.0;    ///< across an emission's velocity [cm^2]
    double volume = 0.0;  ///< [cm^3]
};

struct EmissionWorkspace {
    std::vector<Inflow> inflows;                  ///< inflows of this step; without a volume where a source is shut
    std::vector<std::optional<MouthSize>> sizes;  ///< sizes of the mouths, for each emission of each source, while no obstacle moves
};

/// Lay new particles into the sources that are active at the beginning of the step from timeFrom to timeTo, the time at
/// which all particles are where they are. Equal times mean the state before the first step: then bodies that are laid
/// once appear. Later, one whose instant lies in (timeFrom, timeTo] does.
///
/// A source is active from `from` to `to` while the volume that it has given in all is below the emission's maxVolume,
/// which is exceeded by less than one particle. New particles are numbered on, move rigidly with the emission's
/// velocity and are entered in emittedVolume and the ledger. Obstacles stand where they are at timeFrom. Throws
/// InputError for a body that is laid once and has no room for a single particle.
///
/// What a source with a velocity gives is the area of its shape across it times the speed times the time, beside what fills its shape when it begins
/// and to within one layer of particles. Where it finds no room for that, particles are pressed in among those that are there, and the
/// workspace tells where. It gives nothing while it is shut (SourceMemory), and is owed nothing for that time.
void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo, EmissionWorkspace& work);
void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo);

/// Volume of the particles of a source relative to the region that they fill [-]: of the source that is packed most tightly, for sources of one scene
/// should all be filled alike. Of a body that is there from the start it is its own, which depends on its size (packingOf).
double packingOfSources(const Scene& scene, const State& state);

/// Does any source give liquid in the step from timeFrom to timeTo?
bool emits(const Scene& scene, const State& state, double timeFrom, double timeTo);

}  // namespace sim
