#version 330 core

// Glossy, but no mirror: colours must be read.

in vec3 eyePosition;
in vec3 eyeNormal;
in float shade;

uniform sampler2D colorMap;  // 256 x 1
uniform vec4 flatColor;      // a = 1: this colour for all

out vec4 fragment;

#include "lighting.glsl"

void main()
{
    float t = (clamp(shade, 0.0, 1.0) * 255.0 + 0.5) / 256.0;
    vec3 color = mix(textureLod(colorMap, vec2(t, 0.5), 0.0).rgb, flatColor.rgb, flatColor.a);
    fragment = vec4(lit(color, normalize(eyeNormal), normalize(-eyePosition), 1.0), 0.0);
}
