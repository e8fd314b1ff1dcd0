#pragma once

#include "app/parts.h"

namespace app {

/// A renderer without a window, for the calling thread, that draws frames as the scene's file says.
/// A camera that frames everything is placed by the first frame and stays.
/// @param asPanel  without the colour bar and time that stand beside all panels of a comparison
DrawFrame startOffscreenRenderer(const SceneSetup& setup, bool asPanel);

/// Panels of one time side by side, with the time and one colour bar for all.
SideBySide putSideBySide(const std::vector<Panel>& panels, const PictureSettings& pictures, double time);

}  // namespace app
