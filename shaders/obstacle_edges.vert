#version 330 core

// One edge of an obstacle as a thin strip of four corners, if it is sharp or on the silhouette.

layout(location = 0) in vec3 a;        // ends, world [cm]
layout(location = 1) in vec3 b;
layout(location = 2) in vec3 normal0;  // faces that meet there
layout(location = 3) in vec3 normal1;
layout(location = 4) in float isSharp;

uniform mat4 view;
uniform mat4 projection;
uniform vec3 eyePosition;   // world [cm]
uniform vec2 halfPicture;   // [pixels]
uniform float linePixels;   // width

noperspective out float fromMiddle;  // [pixels]

void main()
{
    vec3 sight = 0.5 * (a + b) - eyePosition;
    bool isSilhouette = dot(normal0, sight) * dot(normal1, sight) <= 0.0;
    vec4 clipA = projection * view * vec4(a, 1.0);
    vec4 clipB = projection * view * vec4(b, 1.0);
    fromMiddle = 0.0;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: not drawn
    if (!(isSharp > 0.5 || isSilhouette) || clipA.w <= 0.0 || clipB.w <= 0.0) return;

    vec2 along = (clipB.xy / clipB.w - clipA.xy / clipA.w) * halfPicture;
    float len = max(length(along), 1e-6);
    along /= len;
    float side = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    vec4 end = gl_VertexID < 2 ? clipA : clipB;
    float reach = 0.5 * linePixels + 1.0;
    fromMiddle = side * reach;
    end.xy += vec2(-along.y, along.x) * side * reach / halfPicture * end.w;
    gl_Position = end;
}
