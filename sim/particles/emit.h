#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"

namespace sim {

/// Lay new particles into the sources that are active at the beginning of the step from timeFrom to timeTo, the time at
/// which all particles are where they are. Equal times mean the state before the first step: then bodies that are laid
/// once appear. Later, one whose instant lies in (timeFrom, timeTo] does.
///
/// A source is active from `from` to `to` while the volume that it has given in all is below the emission's maxVolume,
/// which is exceeded by less than one particle. New particles are numbered on, move rigidly with the emission's
/// velocity and are entered in emittedVolume and the ledger. Obstacles stand where they are at timeFrom. Throws
/// InputError for a body that is laid once and has no room for a single particle.
void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo);

/// Does any source give liquid in the step from timeFrom to timeTo?
bool emits(const Scene& scene, const State& state, double timeFrom, double timeTo);

}  // namespace sim
