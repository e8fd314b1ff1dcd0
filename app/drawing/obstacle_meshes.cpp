#include "app/drawing/obstacle_meshes.h"

#include "sim/shapes/tessellate.h"

namespace app {

namespace {

/// One obstacle where the scene file puts it, before any motion. A container is drawn as the shape it is the outside of.
FrameSnapshot::Mesh restMesh(const sim::ObstacleSettings& obstacle, double cell)
{
    const bool inside = obstacle.shape.isInverted();
    const sim::TriangleMesh mesh = sim::tessellate(inside ? obstacle.shape.inverted() : obstacle.shape, cell);
    FrameSnapshot::Mesh rest;
    rest.inside = inside;
    rest.name = obstacle.name;
    rest.triangles = mesh.triangles;
    for (const auto& vertex : mesh.vertices) rest.positions.push_back(vertex.cast<float>());
    return rest;
}

/// Put a mesh where its motion has it at a time [s], with the velocities of its points there.
void place(const sim::Motion& motion, double time, FrameSnapshot::Mesh& mesh)
{
    const Eigen::Isometry3f transform = motion.transform(time).cast<float>();
    for (auto& position : mesh.positions) position = transform * position;
    // A rigid body's velocities are an affine map of where its points are: that of the origin and of a unit along each axis tell all.
    const sim::Vec3 origin = motion.velocity(time, sim::Vec3::Zero());
    Eigen::Matrix3d turning;
    for (int a = 0; a < 3; ++a) turning.col(a) = motion.velocity(time, sim::Vec3::Unit(a)) - origin;
    mesh.velocities.clear();
    for (const auto& position : mesh.positions) mesh.velocities.push_back((origin + turning * position.cast<double>()).cast<float>());
}

}  // namespace

PlaceObstacles meshObstacles(const sim::Scene& scene)
{
    // Half a grid cell resolves what the liquid can feel of a shape.
    const double cell = 0.5 * scene.settings.cell;
    std::vector<FrameSnapshot::Mesh> rest;
    std::vector<sim::Motion> motions;
    for (const auto& obstacle : scene.obstacles) {
        rest.push_back(restMesh(obstacle, cell));
        motions.push_back(obstacle.motion);
    }
    return [rest = std::move(rest), motions = std::move(motions)](double time, std::vector<FrameSnapshot::Mesh>& meshes) {
        meshes = rest;
        for (std::size_t o = 0; o < rest.size(); ++o)
            if (!motions[o].isStatic()) place(motions[o], time, meshes[o]);
    };
}

}  // namespace app
