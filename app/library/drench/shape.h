#pragma once

#include <drench/vec3.h>

#include <string>
#include <vector>

namespace drench {

/// A body, in the words of scene files: Shape{"{rounded_box: {center: [0, 1, 0], half: [1, 1, 1], round: 0.2}}"} is what the functions
/// below have no name for. It is read, and refused if it is none, when a scene takes it.
struct Shape {
    std::string text;
};

// Lengths in cm.
Shape ball(const Vec3& center, double radius);
Shape box(const Vec3& min, const Vec3& max);
/// All that is within the radius of a line from a to b.
Shape capsule(const Vec3& a, const Vec3& b, double radius);
/// @param half  of the height
Shape cylinder(const Vec3& center, const Vec3& axis, double radius, double half);
/// The inside of a closed OBJ file, whose lengths are multiplied by `scale` to be cm.
Shape mesh(const std::string& file, double scale = 1.0);

Shape unite(const std::vector<Shape>& shapes);
Shape intersect(const std::vector<Shape>& shapes);
/// The first without the others.
Shape subtract(const std::vector<Shape>& shapes);

}  // namespace drench
