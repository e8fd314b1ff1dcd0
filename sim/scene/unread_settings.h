#pragma once

#include "sim/scene/node.h"
#include "sim/scene/scene.h"

#include <string>
#include <string_view>

namespace sim {

/// Adds a note to the scene for every setting that its file gives a value other than its default and that nothing reads, as the others are:
/// "drop.yaml:4: transfer.flip_ratio: has no effect here; it goes with transfer.method flip". Where a file is of several runs, of what the
/// command line gives alone.
void noteUnreadSettings(const Node& root, Scene& scene);

/// Is a setting given for this run alone? Of a file of several runs one may leave unread what another reads.
bool isOfThisRun(const Node& root, const Node& given);
/// Where the file gives a dotted path; of what may be given for both phases, as one value, too. nullptr where it does not.
const Node* nodeAt(const Node& root, std::string_view path);
/// "drop.yaml:4: transfer.flip_ratio: has no effect here; it goes with transfer.method flip".
std::string unreadNote(const Node& given, std::string_view path, std::string_view lacking);

}  // namespace sim
