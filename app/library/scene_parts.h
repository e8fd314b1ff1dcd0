#pragma once

#include "drench/scene.h"
#include "sim/scene/scene.h"
#include "sim/scene/scene_file.h"

#include <map>
#include <string>

namespace drench {

/// The tree of keys, which sim/scene reads, and what no key can say.
struct Scene::Parts {
    sim::SceneFile file;
    std::map<std::string, Motion> motions;  ///< motions given by the program, by the names of their obstacles

    /// Throws sim::InputError.
    sim::Scene read() const;
};

std::string flow(const Vec3& v);  ///< as scene files have it
inline Vec3 fromSim(const sim::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline sim::Vec3 toSim(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace drench
