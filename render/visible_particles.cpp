#include "render/visible_particles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace render {

namespace {

constexpr std::size_t kFewParticles = 4096;  // not worth the search
constexpr float kLargestDisc = 64.0f;        // pixels: drivers draw no point larger than some size of theirs
constexpr float kPlaceError = 0.2f;          // pixels: how well it is known where the driver puts a sprite
constexpr float kDepthError = 2.5e-7f;       // of the depth buffer's range: four steps of its 24 bits

struct PixelRange {
    int begin, end;
};

/// Pixels of a row whose centres lie within `reach` of `x`, in a picture of `count`.
PixelRange pixelsWithin(float x, float reach, int count)
{
    const auto inPicture = [&](float pixel) { return static_cast<int>(std::clamp(pixel, 0.0f, static_cast<float>(count))); };
    return {inPicture(std::ceil(x - reach - 0.5f)), inPicture(std::floor(x + reach + 0.5f))};
}

/// How far from the centre of a disc `inside` of shaders/liquid.frag, D (1 - r^2) / 4 with r in radii, falls to a value.
float reachOf(float diameter, float inside) { return 0.5f * diameter * std::sqrt(std::max(0.0f, 1.0f - 4.0f * inside / diameter)); }

/// Diameter of the disc that shows a particle [pixels], as shaders/liquid.vert finds it.
float discPixels(float eyeZ, float radius, const ViewTransforms& transforms)
{
    const float tangentSquared = std::max(eyeZ * eyeZ - radius * radius, 1e-12f * eyeZ * eyeZ);
    return std::max(2.0f * transforms.pixelsPerTangent() * radius / std::sqrt(tangentSquared), kSmallestDisc);
}

/// How far two depths near `depth` may lie from each other and the depth buffer not tell them apart [cm].
float depthError(float depth, const ViewTransforms& transforms)
{
    return kDepthError * depth * depth * (1.0f / transforms.zNear - 1.0f / transforms.zFar);
}

}  // namespace

FrameView::Liquid VisibleParticles::of(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look, int samples)
{
    if (liquid.positions.size() < kFewParticles || look.style == LiquidStyle::Points) return liquid;
    place(liquid, transforms, liquid.radius * look.radiusFactor);
    // Alpha, 1/2 + inside, covers all samples from 1 - 1/samples on; drivers may take more samples than they were asked.
    const float wholeFrom = samples > 1 ? 0.5f - 1.0f / static_cast<float>(std::max(samples, 4)) : 0.0f;
    const float anyFrom = samples > 1 ? -0.5f : 0.0f;
    cover(transforms, wholeFrom);
    positions_.clear();
    values_.clear();
    const bool hasValues = !liquid.values.empty();
    for (std::size_t i = 0; i < discs_.size(); ++i) {
        if (isHidden(discs_[i], transforms, anyFrom)) continue;
        positions_.push_back(liquid.positions[i]);
        if (hasValues) values_.push_back(liquid.values[i]);
    }
    return {positions_, values_, liquid.radius};
}

void VisibleParticles::place(const FrameView::Liquid& liquid, const ViewTransforms& transforms, float radius)
{
    const Eigen::Matrix4f toClip = transforms.projection * transforms.view;
    const float halfWidth = 0.5f * static_cast<float>(transforms.width), halfHeight = 0.5f * static_cast<float>(transforms.height);
    discs_.resize(liquid.positions.size());
    for (std::size_t i = 0; i < discs_.size(); ++i) {
        const Eigen::Vector4f clip = toClip * liquid.positions[i].homogeneous();
        const float depth = clip.w();  // of a perspective view: the distance along it
        const bool isSeen = std::isfinite(clip.sum()) && depth > transforms.zNear && depth < transforms.zFar;
        const float diameter = isSeen ? discPixels(depth, radius, transforms) : 0.0f;
        discs_[i] = {halfWidth * (1.0f + clip.x() / depth), halfHeight * (1.0f + clip.y() / depth), depth, diameter < kLargestDisc ? diameter : 0.0f};
    }
}

void VisibleParticles::cover(const ViewTransforms& transforms, float wholeFrom)
{
    nearest_.assign(static_cast<std::size_t>(transforms.width) * transforms.height, std::numeric_limits<float>::infinity());
    // Drivers clip a point whose centre, or where they take it to be, is outside the picture.
    const float right = static_cast<float>(transforms.width) - 1.0f, top = static_cast<float>(transforms.height) - 1.0f;
    for (const Disc& disc : discs_) {
        if (disc.diameter == 0.0f || disc.x < 1.0f || disc.x > right || disc.y < 1.0f || disc.y > top) continue;
        const float reach = reachOf(disc.diameter, wholeFrom) - kPlaceError;
        if (reach <= 0.0f) continue;
        const PixelRange columns = pixelsWithin(disc.x, reach, transforms.width), rows = pixelsWithin(disc.y, reach, transforms.height);
        for (int y = rows.begin; y < rows.end; ++y)
            for (int x = columns.begin; x < columns.end; ++x) {
                const float dx = static_cast<float>(x) + 0.5f - disc.x, dy = static_cast<float>(y) + 0.5f - disc.y;
                float& nearest = nearest_[static_cast<std::size_t>(y) * transforms.width + x];
                if (dx * dx + dy * dy <= reach * reach) nearest = std::min(nearest, disc.depth);
            }
    }
}

bool VisibleParticles::isHidden(const Disc& disc, const ViewTransforms& transforms, float anyFrom) const
{
    if (disc.diameter == 0.0f) return false;
    const float reach = reachOf(disc.diameter, anyFrom) + kPlaceError;
    const PixelRange columns = pixelsWithin(disc.x, reach, transforms.width), rows = pixelsWithin(disc.y, reach, transforms.height);
    const float infront = disc.depth - depthError(disc.depth, transforms);
    for (int y = rows.begin; y < rows.end; ++y) {
        const float* row = &nearest_[static_cast<std::size_t>(y) * transforms.width];
        const float dy = static_cast<float>(y) + 0.5f - disc.y;
        for (int x = columns.begin; x < columns.end; ++x) {
            const float dx = static_cast<float>(x) + 0.5f - disc.x;
            if (row[x] >= infront && dx * dx + dy * dy < reach * reach) return false;
        }
    }
    return true;
}

}  // namespace render
