#pragma once

#include "app/frames/frame_snapshot.h"
#include "app/scene/picture_settings.h"
#include "sim/fabric/fabric.h"

namespace app {

/// Yarns as they are now. Without any, all is empty.
void takeYarns(const sim::Fabric& fabric, const sim::FabricState& state, double liquidDensity, FabricColorBy colorBy, FrameSnapshot::Yarns& out);

/// Cloth as it is now. Without any, all is empty.
void takeCloth(const sim::Fabric& fabric, const sim::FabricState& state, double liquidDensity, FabricColorBy colorBy, FrameSnapshot::Cloth& out);

/// How full the pores of each vertex are, 0 … 1; empty where all are dry.
std::vector<float> wetnessOf(const sim::Fabric& fabric, const sim::FabricState& state, double liquidDensity);

/// Largest relative lengthening of the yarn edges that meet at each vertex; 0 where there are none [-].
std::vector<double> yarnStrain(const sim::Fabric& fabric, const sim::FabricState& state);

/// Largest principal stretch of the faces that meet at each vertex, less 1; 0 where there are none [-].
std::vector<double> clothStrain(const sim::Fabric& fabric, const sim::FabricState& state);

}  // namespace app
