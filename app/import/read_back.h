#pragma once

#include "app/import/write_scene.h"
#include "sim/scene/scene.h"

#include <string>

namespace app {

/// Compares a scene as it was read with what it was written from; says what agrees. Throws std::logic_error where it
/// does not.
std::string compareWithReference(const sim::Scene& read, const ImportedScene& scene);

}  // namespace app
