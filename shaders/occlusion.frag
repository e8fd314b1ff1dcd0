#version 330 core

// Openness of solids from the depths alone. Window depth is linear in the picture on any plane, so a pixel's rise against
// two opposite neighbours cancels there; what is left is how hollow the surface is.

uniform sampler2D colors;        // alpha 0: a solid
uniform sampler2D depths;
uniform vec2 nearFar;            // [cm]
uniform vec2 reach;              // smallest and largest [cm]
uniform float pixelsPerTangent;  // pixels of 1 cm at 1 cm from the eye

out vec4 fragment;

const int kPairs = 9;
const float kGoldenAngle = 2.39996;

float hollow(float rise)
{
    // Something much nearer to the eye is another thing in front: it darkens less the farther it is away.
    return rise > 1.0 ? 1.0 / rise : max(rise, -1.0);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float window = texelFetch(depths, pixel, 0).r;
    float distance = nearFar.x * nearFar.y / (nearFar.y - window * (nearFar.y - nearFar.x));
    fragment = vec4(1.0, distance, 0.0, 1.0);
    // As a number of turns, because a software renderer skips loops but not branches.
    int pairs = window >= 1.0 || texelFetch(colors, pixel, 0).a > 0.99 ? 0 : kPairs;

    ivec2 size = textureSize(depths, 0);
    float pixelsPerCm = pixelsPerTangent / distance;
    float centimetresPerDepth = distance * distance * (nearFar.y - nearFar.x) / (nearFar.x * nearFar.y);
    float inner = max(reach.x * pixelsPerCm, 1.5);
    float outer = clamp(reach.y * pixelsPerCm, 2.0 * inner, 0.2 * float(size.y));
    // Neighbours look at different places; the blur that follows takes 4 x 4 of them together.
    int cell = (pixel.x & 3) + 4 * (pixel.y & 3);
    float turn = float((cell * 7) & 15) / 16.0, shift = float((cell * 5 + 3) & 15) / 16.0;

    float shut = 0.0;
    for (int i = 0; i < pairs; ++i) {
        float fraction = (float(i) + shift) / float(kPairs);
        float radius = inner * exp2(fraction * log2(outer / inner));
        float angle = kGoldenAngle * float(i) + 3.14159265 * turn;
        ivec2 offset = ivec2(round(radius * vec2(cos(angle), sin(angle))));
        ivec2 a = pixel + offset, b = pixel - offset;
        if (any(lessThan(min(a, b), ivec2(0))) || any(greaterThanEqual(max(a, b), size))) continue;
        float scale = centimetresPerDepth * pixelsPerCm / radius;
        float rises = hollow(scale * (window - texelFetch(depths, a, 0).r)) + hollow(scale * (window - texelFetch(depths, b, 0).r));
        shut += max(rises, 0.0);
    }
    fragment.r = mix(0.22, 1.0, exp(-1.9 * shut / float(kPairs)));
}
