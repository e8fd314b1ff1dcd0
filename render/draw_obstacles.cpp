#include "render/draw_obstacles.h"

#include "render/mesh_edges.h"

#include <algorithm>
#include <vector>

namespace render {

namespace {

using Eigen::Vector3f;

struct FaceVertex {
    Vector3f position, normal;
    float bend;
};

struct EdgeInstance {
    Vector3f a, b, normal0, normal1;
    float isSharp;
};

std::vector<FaceVertex> faceVertices(const FrameView::Mesh& mesh, const MeshEdges& outline)
{
    std::vector<FaceVertex> vertices;
    vertices.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) vertices.push_back({mesh.positions[mesh.triangles[t][k]], outline.cornerNormals[t][k], outline.bend[t]});
    return vertices;
}

std::vector<EdgeInstance> edgeInstances(const MeshEdges& outline)
{
    std::vector<EdgeInstance> instances;
    instances.reserve(outline.edges.size());
    for (const MeshEdges::Edge& e : outline.edges) instances.push_back({e.a, e.b, e.normal0, e.normal1, e.isSharp ? 1.0f : 0.0f});
    return instances;
}

bool isSolid(const FrameView::Mesh& mesh, const ObstacleLook& look) { return look.style == ObstacleStyle::Solid && !mesh.inside; }

void setCommonUniforms(const Gl& gl, const Program& program, const ViewTransforms& transforms, const Vector3f& color)
{
    program.use();
    gl.UniformMatrix4fv(program["view"], 1, GL_FALSE, transforms.view.data());
    gl.UniformMatrix4fv(program["projection"], 1, GL_FALSE, transforms.projection.data());
    gl.Uniform3f(program["color"], color.x(), color.y(), color.z());
}

}  // namespace

DrawObstacles::DrawObstacles(const Gl& gl, const std::filesystem::path& shaderDir)
    : gl_(gl),
      faceProgram_(gl, shaderDir, "obstacle_faces"),
      edgeProgram_(gl, shaderDir, "obstacle_edges"),
      solidProgram_(gl, shaderDir, "obstacle_solid"),
      faceVertices_(gl),
      edgeVertices_(gl),
      faces_(gl),
      edges_(gl)
{
    gl.BindVertexArray(faceVertices_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, faces_.id());
    describeAttribute(gl, 0, 3, sizeof(FaceVertex), offsetof(FaceVertex, position));
    describeAttribute(gl, 1, 3, sizeof(FaceVertex), offsetof(FaceVertex, normal));
    describeAttribute(gl, 2, 1, sizeof(FaceVertex), offsetof(FaceVertex, bend));

    gl.BindVertexArray(edgeVertices_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, edges_.id());
    describeAttribute(gl, 0, 3, sizeof(EdgeInstance), offsetof(EdgeInstance, a));
    describeAttribute(gl, 1, 3, sizeof(EdgeInstance), offsetof(EdgeInstance, b));
    describeAttribute(gl, 2, 3, sizeof(EdgeInstance), offsetof(EdgeInstance, normal0));
    describeAttribute(gl, 3, 3, sizeof(EdgeInstance), offsetof(EdgeInstance, normal1));
    describeAttribute(gl, 4, 1, sizeof(EdgeInstance), offsetof(EdgeInstance, isSharp));
    for (GLuint index = 0; index < 5; ++index) gl.VertexAttribDivisor(index, 1);
}

void DrawObstacles::drawSolid(std::span<const FrameView::Mesh> meshes, const ViewTransforms& transforms, const ObstacleLook& look)
{
    for (const FrameView::Mesh& mesh : meshes) {
        if (!isSolid(mesh, look) || mesh.triangles.empty()) continue;
        const std::vector<FaceVertex> vertices = faceVertices(mesh, meshEdges(mesh));
        setCommonUniforms(gl_, solidProgram_, transforms, look.solidColor);
        drawOpaque(gl_);
        gl_.Disable(GL_CULL_FACE);  // open meshes have two sides
        gl_.BindVertexArray(faceVertices_.id());
        upload(gl_, GL_ARRAY_BUFFER, faces_, vertices);
        gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
    }
    requireNoGlError(gl_, "drawing solid obstacles");
}

void DrawObstacles::draw(std::span<const FrameView::Mesh> meshes, const ViewTransforms& transforms, const ObstacleLook& look)
{
    if (look.style == ObstacleStyle::Hidden) return;
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LEQUAL);
    gl_.DepthMask(GL_FALSE);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // glass leaves alpha to what is behind it
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const FrameView::Mesh& mesh : meshes) {
        if (isSolid(mesh, look) || mesh.triangles.empty()) continue;
        const MeshEdges outline = meshEdges(mesh);
        const std::vector<FaceVertex> vertices = faceVertices(mesh, outline);
        const std::vector<EdgeInstance> instances = edgeInstances(outline);
        upload(gl_, GL_ARRAY_BUFFER, faces_, vertices);
        upload(gl_, GL_ARRAY_BUFFER, edges_, instances);
        const auto count = static_cast<GLsizei>(vertices.size());
        if (look.style != ObstacleStyle::Wire) {
            drawFaces(GL_FRONT, count, transforms, look);
            if (!mesh.inside) drawFaces(GL_BACK, count, transforms, look);
        }
        drawEdges(static_cast<GLsizei>(instances.size()), transforms, look);
    }
    gl_.DepthMask(GL_TRUE);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.Disable(GL_BLEND);
    requireNoGlError(gl_, "drawing the obstacles");
}

void DrawObstacles::drawFaces(GLenum culled, GLsizei vertices, const ViewTransforms& transforms, const ObstacleLook& look) const
{
    setCommonUniforms(gl_, faceProgram_, transforms, look.color);
    gl_.Uniform1f(faceProgram_["opacity"], look.opacity);
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(culled);
    gl_.BindVertexArray(faceVertices_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, vertices);
    gl_.Disable(GL_CULL_FACE);
}

void DrawObstacles::drawEdges(GLsizei edges, const ViewTransforms& transforms, const ObstacleLook& look) const
{
    setCommonUniforms(gl_, edgeProgram_, transforms, look.color);
    gl_.Uniform3f(edgeProgram_["eyePosition"], transforms.eye.x(), transforms.eye.y(), transforms.eye.z());
    gl_.Uniform2f(edgeProgram_["halfPicture"], 0.5f * static_cast<float>(transforms.width), 0.5f * static_cast<float>(transforms.height));
    gl_.Uniform1f(edgeProgram_["linePixels"], std::max(1.0f, 1.5f * static_cast<float>(transforms.height) / 720.0f));
    gl_.BindVertexArray(edgeVertices_.id());
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, edges);
}

}  // namespace render
