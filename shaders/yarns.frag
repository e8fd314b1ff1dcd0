#version 330 core

// A yarn of three plies: grooves wind about it with its material frame, so that its twist can be seen. They fade where they
// are too fine for the picture.

in vec3 eyePosition;
in vec3 eyeNormal;
in float helix;
in float shade;
flat in vec4 flatColor;

uniform sampler2D colorMap;  // 256 x 1
uniform float plyDepth;      // 0 = smooth … 1

out vec4 fragment;

#include "lighting.glsl"

void main()
{
    float t = (clamp(shade, 0.0, 1.0) * 255.0 + 0.5) / 256.0;
    vec3 color = mix(textureLod(colorMap, vec2(t, 0.5), 0.0).rgb, flatColor.rgb, flatColor.a);
    vec3 normal = normalize(eyeNormal);

    // The picture's gradient of the helix, and from it the one along the surface.
    vec2 slope = vec2(dFdx(helix), dFdy(helix));
    float visible = plyDepth * (1.0 - smoothstep(0.09, 0.21, length(slope)));
    if (visible > 0.0) {
        float across = 2.0 * fract(helix) - 1.0;  // −1 … 1 over one ply
        float groove = smoothstep(0.45, 1.0, abs(across));
        float fibre = 0.5 + 0.5 * sin(6.2831853 * 7.0 * helix);
        float fibreVisible = 1.0 - smoothstep(0.015, 0.035, length(slope));
        vec3 dx = dFdx(eyePosition), dy = dFdy(eyePosition);
        vec3 rise = slope.x * cross(dy, normal) + slope.y * cross(normal, dx);
        float size = length(rise);
        if (size > 0.0) normal = normalize(normal + visible * 0.55 * across * abs(across) * sign(dot(normal, cross(dx, dy))) * rise / size);
        color *= 1.0 - visible * (0.38 * groove + 0.07 * fibreVisible * fibre);
    }
    fragment = vec4(lit(color, normal, normalize(-eyePosition), 0.25), 0.0);
}
