#pragma once

#include "app/backends.h"

namespace app {

/// A renderer without a window, for the calling thread, that draws frames as the scene's file says.
/// A camera that frames everything is placed by the first frame and stays.
/// @param asPanel  without the label, time and colour bar that putSideBySide() puts around all panels of a comparison
DrawFrame startOffscreenRenderer(const LoadedScene& setup, bool asPanel);

/// What it draws with: "3.3 (Core Profile) Mesa 22.3.6, llvmpipe (LLVM 15.0.6, 256 bits)".
std::string offscreenRendererName();

/// Panels of one time side by side, each under its label, with the time and one colour bar for all.
RgbPicture putSideBySide(const std::vector<Panel>& panels, const PictureSettings& pictures, double time);

void writeRgbPng(const RgbPicture& picture, const std::filesystem::path& file);

}  // namespace app
