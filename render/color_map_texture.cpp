#include "render/color_map_texture.h"

namespace render {

void ColorMapTexture::bind(ColorMap map)
{
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, texture_.id());
    if (uploaded_ == map) return;
    const ColorTable table = colorTable(map);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, kColorMapSize, 1, 0, GL_RGB, GL_FLOAT, table.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    uploaded_ = map;
}

}  // namespace render
