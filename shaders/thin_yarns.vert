#version 330 core

// A yarn too thin for plies, lit at its vertices.

layout(location = 0) in vec3 position;  // world [cm]
layout(location = 1) in vec3 normal;
layout(location = 4) in float value;
layout(location = 5) in vec4 paint;     // a = 1: this colour, 0: that of the value

uniform mat4 view;
uniform mat4 projection;
uniform vec2 range;          // values at the ends of the colour map
uniform sampler2D colorMap;  // 256 x 1

out vec3 color;

#include "lighting.glsl"

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    float t = (clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * 255.0 + 0.5) / 256.0;
    vec3 base = mix(textureLod(colorMap, vec2(t, 0.5), 0.0).rgb, paint.rgb, paint.a);
    color = lit(base, normalize(mat3(view) * normal), normalize(-eye.xyz), 0.25);
    gl_Position = projection * eye;
}
