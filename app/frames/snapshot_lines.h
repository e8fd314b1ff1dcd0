#pragma once

#include "app/frames/frame_snapshot.h"
#include "sim/fabric/contact/contact.h"
#include "sim/state.h"

namespace app {

/// The lines that `extras` asks for; none where it asks for none.
/// @param contacts  between pieces of `fabric`, of the last step; null where there are none
/// @param radius    of a particle [cm]
void takeLines(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, const SnapshotExtras& extras, float radius,
               std::vector<FrameSnapshot::Lines>& out);

/// Edges of the blocks that exist, each once.
FrameSnapshot::Lines blockEdges(const sim::BlockGrid& grid);

/// Which particles have arrows: those whose id is a multiple of a number that leaves about this many. They keep them as
/// long as the number of particles stays alike.
inline constexpr std::size_t kMostArrows = 3000;

struct Arrows {
    FrameSnapshot::Lines shafts, heads;
};

/// Arrows from particles to where they come in `time` [s] at their velocity; lifted, so that those of the outermost particles
/// are seen whole.
Arrows velocityArrows(const sim::LiquidParticles& liquid, double time, float lift);

/// Lines between the nearest points of each pair, with the vertices at x; lifted out of the fabric, in whose
/// middle they lie.
FrameSnapshot::Lines contactLines(const sim::ActiveContacts& contacts, const sim::Fabric& fabric, std::span<const sim::Vec3> x);

}  // namespace app
