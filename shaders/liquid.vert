#version 330 core

// One liquid particle as a point sprite that just covers its sphere.

layout(location = 0) in vec3 position;  // world [cm]
layout(location = 1) in float value;

uniform mat4 view;
uniform mat4 projection;
uniform float radius;            // [cm]
uniform float pixelsPerTangent;  // pixels of 1 cm at 1 cm from the eye
uniform float smallestDisc;      // diameter [pixels]
uniform float dotPixels;         // > 0: plain dots of this diameter instead of spheres
uniform vec2 range;              // values at the ends of the colour map
uniform vec4 flatColor;          // a = 1: this colour for all
uniform sampler2D colorMap;      // 256 x 1
uniform bool smoothEdges;
uniform vec2 clipShift;          // corrects where the driver puts points

flat out vec3 color;
flat out float discPixels;       // diameter of the disc
flat out float spritePixels;     // side of the square around it

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    gl_Position = projection * eye;
    gl_Position.xy += clipShift * gl_Position.w;

    float tangentSquared = max(eye.z * eye.z - radius * radius, 1e-12 * eye.z * eye.z);
    float spherePixels = 2.0 * pixelsPerTangent * radius * inversesqrt(tangentSquared);
    discPixels = dotPixels > 0.0 ? dotPixels : max(spherePixels, smallestDisc);
    spritePixels = discPixels + (smoothEdges ? 1.0 : 0.0);
    gl_PointSize = spritePixels;

    float t = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
    vec3 mapped = textureLod(colorMap, vec2((t * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
    color = mix(mapped, flatColor.rgb, flatColor.a);
}
