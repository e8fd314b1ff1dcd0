#pragma once

#include "render/frame_view.h"
#include "render/look.h"
#include "render/view_transforms.h"

#include <vector>

namespace render {

inline constexpr float kSmallestDisc = 2.0f;  ///< pixels across; smaller ones would leave holes between particles

/// Picks the particles of a liquid that some pixel may show. Within a body of liquid most are hidden by others, and a
/// software renderer spends its time on them; a graphics card does not mind. The picture is the same with and without
/// those left out: one is left out only where nearer particles cover every pixel of its sprite whole.
class VisibleParticles {
 public:
    /// The visible ones in their order; spans live until the next call. With fewer than a few thousand, or drawn as
    /// dots, the liquid itself.
    FrameView::Liquid of(const FrameView::Liquid& liquid, const ViewTransforms& transforms, const LiquidLook& look, int samples);

 private:
    struct Disc {
        float x, y;      ///< centre [pixels], x to the right, y up
        float depth;     ///< distance from the eye along the view [cm]
        float diameter;  ///< [pixels]; 0: not to be judged, always drawn
    };

    void place(const FrameView::Liquid& liquid, const ViewTransforms& transforms, float radius);
    /// @param wholeFrom  value of `inside` in shaders/liquid.frag from which all samples of a pixel are covered
    void cover(const ViewTransforms& transforms, float wholeFrom);
    /// @param anyFrom  value of `inside` from which one sample is
    bool isHidden(const Disc& disc, const ViewTransforms& transforms, float anyFrom) const;

    std::vector<Disc> discs_;
    std::vector<float> nearest_;  ///< least depth of what covers a pixel whole [cm], rows from below
    std::vector<Eigen::Vector3f> positions_;
    std::vector<float> values_;
};

}  // namespace render
