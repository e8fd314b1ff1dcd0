#include "app/import/read_back.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace app {

namespace {

void require(bool agrees, const std::string& piece, const char* what)
{
    if (!agrees)
        throw std::logic_error(
            fmt::format("the scene that was written has other {} in {} than the file; this is a mistake of the import", what, piece));
}

std::vector<std::array<int, 3>> sortedCorners(const std::vector<sim::Vec3i>& faces)
{
    std::vector<std::array<int, 3>> all;
    for (const sim::Vec3i& f : faces) {
        all.push_back({f[0], f[1], f[2]});
        std::ranges::sort(all.back());
    }
    std::ranges::sort(all);
    return all;
}

/// The largest distance of a vertex from its particle [cm].
double comparePiece(const sim::FabricPiece& read, const ImportedPiece& piece, const reference::Scene& reference)
{
    require(read.points.size() == piece.particles.size(), piece.name, "vertices");
    double largest = 0.0;
    for (std::size_t v = 0; v < read.points.size(); ++v)
        largest = std::max(largest, (read.points[v] - reference.particles[piece.particles[v]].x).norm());
    require(largest < kSameShape, piece.name, "places of vertices");
    require(sortedCorners(read.faces) == sortedCorners(piece.shape.geometry.faces), piece.name, "faces");
    require(read.strands == piece.shape.geometry.strands, piece.name, "yarns");
    std::vector<char> isHeld(read.points.size(), 0);
    for (const sim::PinGroup& pin : read.pins)
        for (const int v : pin.vertices) isHeld[v] = 1;
    for (std::size_t v = 0; v < isHeld.size(); ++v)
        require((isHeld[v] != 0) == reference.particles[piece.particles[v]].isHeld, piece.name, "held vertices");
    return largest;
}

}  // namespace

std::string compareWithReference(const sim::Scene& read, const ImportedScene& scene)
{
    require(read.fabrics.size() == scene.pieces.size(), "fabrics", "pieces");
    double largest = 0.0;
    for (std::size_t i = 0; i < scene.pieces.size(); ++i)
        largest = std::max(largest, comparePiece(read.fabrics[i], scene.pieces[i], scene.reference));
    if (scene.pieces.empty()) return "the scene is accepted";
    return fmt::format(
        "the scene is accepted; vertices, edges, faces and held vertices are those of the file, and no vertex is "
        "further from its particle than {:.1e} cm",
        largest);
}

}  // namespace app
