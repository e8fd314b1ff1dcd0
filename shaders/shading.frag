#version 330 core

// What makes a cloud of small spheres read as one body of liquid, from the depth of the liquid alone:
// a pixel gets darker by how far its neighbours lie in front of it, and brighter or darker by how the surface through
// them turns towards or away from the key light.

uniform sampler2D colors;
uniform sampler2D depths;        // window depth of the liquid, 1 where there is none
uniform sampler2D openness;      // of solids, and distance from the eye [cm]
uniform float occlusion;         // how much openness darkens solids, pixels of alpha 0
uniform vec2 nearFar;            // [cm]
uniform float strength;          // 0 = leave the colours as they are
uniform float depthStep;         // [cm] that count as an edge
uniform float reach;             // pixels per unit of the rings
uniform float pixelsPerTangent;  // pixels of 1 cm at 1 cm from the eye

out vec4 fragment;

const vec3 kKeyLight = normalize(vec3(-0.45, 0.65, 0.75));  // eye space
const vec2 kRing[8] = vec2[](vec2(1.0, 0.0), vec2(0.7, 0.7), vec2(0.0, 1.0), vec2(-0.7, 0.7),
                             vec2(-1.0, 0.0), vec2(-0.7, -0.7), vec2(0.0, -1.0), vec2(0.7, -0.7));
const int kRings = 3;
const float kRadii[kRings] = float[](1.5, 5.0, 9.0);

float distanceFromEye(float windowDepth)
{
    return nearFar.x * nearFar.y / (nearFar.y - windowDepth * (nearFar.y - nearFar.x));
}

float depthAt(ivec2 pixel)
{
    return texelFetch(depths, clamp(pixel, ivec2(0), textureSize(depths, 0) - 1), 0).r;
}

// 1 for an open wall that faces the eye.
float light(ivec2 pixel, float here, int rings)
{
    float hidden = 0.0;
    vec2 moment = vec2(0.0);     // sum of rise x place, and of place squared: their quotient is the gradient
    float spread = 1e-6;
    for (int ring = 0; ring < rings; ++ring) {
        float radius = max(float(ring + 1), kRadii[ring] * reach);
        for (int i = 0; i < 8; ++i) {
            vec2 place = round(radius * kRing[i]);
            float depth = depthAt(pixel + ivec2(place));
            if (depth >= 1.0) continue;
            float rise = clamp(here - distanceFromEye(depth), -depthStep, depthStep);
            hidden += max(rise, 0.0);
            moment += rise * place;
            spread += 0.5 * dot(place, place);
        }
    }
    float centimetresPerPixel = here / pixelsPerTangent;
    vec3 normal = normalize(vec3(-moment / (spread * centimetresPerPixel), 1.0));
    float facing = dot(normal, kKeyLight) - kKeyLight.z;
    return 1.0 - 0.6 * hidden / (8.0 * float(kRings) * depthStep) + (facing > 0.0 ? 0.45 : 0.3) * facing;
}

// Mean of the 4 x 4 pixels about this one that lie on the same surface.
float open(ivec2 pixel, float here, int rows)
{
    float sum = 0.0, weight = 0.0;
    ivec2 last = textureSize(openness, 0) - 1;
    for (int y = -2; y < rows - 2; ++y)
        for (int x = -2; x < 2; ++x) {
            vec2 there = texelFetch(openness, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).rg;
            float same = max(1.0 - 25.0 * abs(there.g - here) / here, 0.001);
            sum += same * there.r;
            weight += same;
        }
    return sum / max(weight, 1e-6);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(colors, pixel, 0);
    float depth = depthAt(pixel);
    float shade = 1.0;
#ifdef ONLY_LIQUID
    if (depth < 1.0 && strength > 0.0) shade = mix(1.0, light(pixel, distanceFromEye(depth), kRings), strength);
#else
    float solid = depth < 1.0 ? 1.0 - color.a : 0.0;
    // What to leave out is told as a number of turns, because a software renderer skips loops but not branches.
#ifndef ONLY_SOLIDS
    bool isLiquid = depth < 1.0 && strength > 0.0 && solid < 0.99;
    float lightened = light(pixel, distanceFromEye(depth), isLiquid ? kRings : 0);
    if (isLiquid) shade = mix(1.0, lightened, strength);
#endif
    bool isShut = solid > 0.0 && occlusion > 0.0;
    float opened = open(pixel, distanceFromEye(depth), isShut ? 4 : 0);
    shade = mix(shade, isShut ? mix(1.0, opened, occlusion) : 1.0, solid);
#endif
    fragment = vec4(color.rgb * shade, 1.0);
}
