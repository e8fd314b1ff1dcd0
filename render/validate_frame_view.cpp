#include "render/validate_frame_view.h"

#include <algorithm>
#include <stdexcept>

namespace render {

namespace {

void require(bool isMet, const char* what)
{
    if (!isMet) throw std::invalid_argument(what);
}

void validate(const FrameView::Yarns& yarns, const YarnLook& look)
{
    if (yarns.begin.empty()) return;
    const std::size_t count = yarns.positions.size(), strands = yarns.begin.size() - 1;
    require(yarns.begin.front() == 0 && yarns.begin.back() == static_cast<int>(count) && std::ranges::is_sorted(yarns.begin),
            "picture: the strands must begin one behind the other and end with the last position");
    require(yarns.directions.size() == count && yarns.along.size() == count, "picture: the yarns need one direction and length per position");
    require(yarns.halfAxes.size() == strands && yarns.materials.size() == strands, "picture: the yarns need one section and material per strand");
    require(yarns.values.size() == (look.byValue ? count : yarns.values.empty() ? 0 : count), "picture: the yarns need one value per position");
    require(look.range[0] < look.range[1], "picture: the colour range of yarns must grow from its first to its second number");
}

void validate(const FrameView::Cloth& cloth, const FabricLook& look)
{
    if (cloth.triangles.empty()) return;
    const std::size_t count = cloth.positions.size();
    require(cloth.thickness.size() == count && cloth.materials.size() == count, "picture: the cloth needs one thickness and material per position");
    require(cloth.values.size() == (look.byValue ? count : cloth.values.empty() ? 0 : count), "picture: the cloth needs one value per position");
    require(look.range[0] < look.range[1], "picture: the colour range of cloth must grow from its first to its second number");
}

void validate(const FrameView::LiquidSurface& surface, const LiquidLook& look)
{
    if (surface.triangles.empty()) return;
    const std::size_t count = surface.positions.size();
    require(surface.normals.size() == count, "picture: the surface of the liquid needs one normal per position");
    require(look.flat || surface.values.size() == count, "picture: the surface of the liquid needs one value per position");
    for (const Eigen::Vector3i& t : surface.triangles)
        require(t.minCoeff() >= 0 && t.maxCoeff() < static_cast<int>(count),
                "picture: a triangle of the liquid's surface names a position that is not there");
}

}  // namespace

void validate(const FrameView& view, const Look& look)
{
    validate(view.yarns, look.yarns);
    validate(view.cloth, look.cloth);
    validate(view.surface, look.liquid);
    for (const FrameView::Lines& lines : view.lines) require(lines.points.size() % 2 == 0, "picture: lines need two points per segment");
    if (look.width <= 0 || look.height <= 0) throw std::invalid_argument("picture: width and height must be positive");
    if (!look.liquid.flat && view.liquid.values.size() != view.liquid.positions.size())
        throw std::invalid_argument("picture: the liquid needs one value per position");
    if (!(look.liquid.range[0] < look.liquid.range[1]))
        throw std::invalid_argument("picture: the colour range must grow from its first to its second number");
}

}  // namespace render
