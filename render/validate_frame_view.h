#pragma once

#include "render/frame_view.h"
#include "render/look.h"

namespace render {

/// Throws std::invalid_argument if the spans of `view` disagree with each other or with what the look needs of them, or
/// a size or range of the look is none.
void validate(const FrameView& view, const Look& look);

}  // namespace render
