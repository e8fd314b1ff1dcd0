#version 330 core

// Matt cloth; its back is a little paler, so that folds tell the sides apart.

in vec3 eyePosition;
in vec3 eyeNormal;
in float shade;
flat in float isBack;
flat in vec4 flatColor;

uniform sampler2D colorMap;  // 256 x 1

out vec4 fragment;

#include "lighting.glsl"

void main()
{
    float t = (clamp(shade, 0.0, 1.0) * 255.0 + 0.5) / 256.0;
    vec3 pale = mix(flatColor.rgb, vec3(0.9), 0.35 * isBack);
    vec3 color = mix(textureLod(colorMap, vec2(t, 0.5), 0.0).rgb, pale, flatColor.a);
    fragment = vec4(lit(color, normalize(eyeNormal), normalize(-eyePosition), 0.1), 0.0);
}
