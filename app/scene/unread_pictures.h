#pragma once

#include "app/scene/picture_settings.h"
#include "sim/scene/node.h"

#include <string>
#include <vector>

namespace app {

/// A note for every key of render, output and compare that the file gives and nothing reads, as the others are and as the scene is
/// (sim::unreadNote). Of a file of several runs, of what the command line gives alone; compare is of all of them.
std::vector<std::string> unreadPictureNotes(const sim::Node& root, const PictureSettings& settings);

}  // namespace app
