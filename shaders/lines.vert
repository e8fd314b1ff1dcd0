#version 330 core

// One segment as a strip of four corners that faces the eye, or as a triangle that ends in a point.

layout(location = 0) in vec3 a;  // ends, world [cm]
layout(location = 1) in vec3 b;

uniform mat4 view;
uniform mat4 projection;
uniform vec2 halfPicture;   // [pixels]
uniform float linePixels;   // width
uniform float rimPixels;    // more on either side, and at the ends
uniform bool isTapered;     // full width at a, none at b
uniform float lift;         // towards the eye [cm]

noperspective out float fromMiddle;  // [pixels]
noperspective out float halfWidth;   // there [pixels]

void main()
{
    vec4 clipA = projection * view * vec4(a, 1.0);
    vec4 clipB = projection * view * vec4(b, 1.0);
    fromMiddle = 0.0;
    halfWidth = 0.0;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: not drawn
    float depthA = clipA.z + clipA.w, depthB = clipB.z + clipB.w;  // behind the near plane below 0
    if (depthA <= 0.0 && depthB <= 0.0) return;
    if (depthA < 0.0) clipA = mix(clipA, clipB, depthA / (depthA - depthB));
    if (depthB < 0.0) clipB = mix(clipB, clipA, depthB / (depthB - depthA));

    vec2 along = (clipB.xy / clipB.w - clipA.xy / clipA.w) * halfPicture;
    float len = length(along);
    if (len > 0.0) along /= len;
    else along = vec2(1.0, 0.0);
    float side = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    bool isFirst = gl_VertexID < 2;
    vec4 end = isFirst ? clipA : clipB;
    // A short head is a narrow one.
    float width = isTapered ? (isFirst ? min(linePixels, len) : 0.0) : linePixels;
    halfWidth = 0.5 * width + rimPixels;
    float reach = halfWidth + 1.0;
    fromMiddle = side * reach;
    vec2 beyond = along * (isFirst ? -rimPixels : rimPixels);
    end.xy += (vec2(-along.y, along.x) * side * reach + beyond) / halfPicture * end.w;
    // At the same place of the picture, with the depth of a point that is nearer, but not before the near plane.
    float depth = end.z / end.w;
    float nearer = max(end.w - lift, 1e-6);
    float lifted = (-projection[2][2] * nearer + projection[3][2]) / nearer;
    end.z = clamp(lifted, -1.0, depth) * end.w;
    gl_Position = end;
}
