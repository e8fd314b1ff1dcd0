#pragma once

#include "app/scene/picture_settings.h"
#include "render/camera.h"
#include "render/compose.h"
#include "render/look.h"

#include <array>
#include <optional>
#include <string>

// What a scene's file says about pictures, in the renderer's own words.

namespace app {

/// Title of a colour bar: what the colours show, with its unit.
const char* titleOf(ColorBy colorBy);
const char* titleOf(FabricColorBy colorBy);

/// Both ends of a range of values, as the renderer takes them.
std::array<float, 2> toFloat(const std::array<double, 2>& range);

render::LiquidStyle liquidStyleOf(LiquidStyle style);

/// @param asPanel  without the label, time and colour bar that putSideBySide() puts around all panels of a comparison
render::Look lookOf(const PictureSettings& pictures, const std::string& label, bool asPanel);

/// The bar that panels of a comparison share: the liquid's if there is one, or that of fabric coloured by value.
std::optional<render::ColorBar> sharedBar(const PictureSettings& pictures);

/// Where the camera is at a time [s].
/// @param everything  box about the first frame [cm]
render::Camera cameraAt(const CameraSettings& settings, double time, const Eigen::AlignedBox3d& everything, double aspect);

}  // namespace app
