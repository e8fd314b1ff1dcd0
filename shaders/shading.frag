#version 330 core

// Darken a pixel by how far, on average, its neighbours lie in front of it, on two rings.

uniform sampler2D colors;
uniform sampler2D depths;   // window depth of the liquid, 1 where there is none
uniform vec2 nearFar;       // [cm]
uniform float strength;
uniform float depthStep;    // [cm]
uniform float reach;        // pixels per ring unit

out vec4 fragment;

const vec2 kRing[8] = vec2[](vec2(1.0, 0.0), vec2(0.7, 0.7), vec2(0.0, 1.0), vec2(-0.7, 0.7),
                             vec2(-1.0, 0.0), vec2(-0.7, -0.7), vec2(0.0, -1.0), vec2(0.7, -0.7));

float distanceFromEye(float windowDepth)
{
    return nearFar.x * nearFar.y / (nearFar.y - windowDepth * (nearFar.y - nearFar.x));
}

float depthAt(ivec2 pixel)
{
    return texelFetch(depths, clamp(pixel, ivec2(0), textureSize(depths, 0) - 1), 0).r;
}

float hiddenShare(ivec2 pixel, float here, float radius)
{
    float hidden = 0.0;
    for (int i = 0; i < 8; ++i) {
        float there = distanceFromEye(depthAt(pixel + ivec2(round(radius * kRing[i]))));
        hidden += clamp((here - there) / depthStep, 0.0, 1.0);
    }
    return hidden / 8.0;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(colors, pixel, 0);
    float depth = depthAt(pixel);
    float light = 1.0;
    if (depth < 1.0 && strength > 0.0) {
        float here = distanceFromEye(depth);
        float hidden = 0.5 * (hiddenShare(pixel, here, max(1.0, 1.5 * reach)) + hiddenShare(pixel, here, max(2.0, 5.0 * reach)));
        light = 1.0 - strength * hidden;
    }
    fragment = vec4(color.rgb * light, 1.0);
}
