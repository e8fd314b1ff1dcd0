#version 330 core

// The visible half of a sphere: its normal from the place in the disc, lit by a key light from the upper left.
// Depth stays that of the centre: nearer spheres hide farther ones, and the early depth test keeps its worth.

flat in vec3 color;
flat in float discPixels;
flat in float spritePixels;

uniform float dotPixels;
uniform bool smoothEdges;

out vec4 fragment;

const vec3 kKeyLight = normalize(vec3(-0.45, 0.65, 0.75));  // eye space
const float kAmbient = 0.62;
const float kKey = 0.46;
const float kShine = 0.10;

void main()
{
    vec2 disc = (2.0 * gl_PointCoord - 1.0) * (spritePixels / discPixels);
    float squared = dot(disc, disc);
    float coverage = smoothEdges ? clamp(0.5 + 0.5 * discPixels * (1.0 - sqrt(squared)), 0.0, 1.0)
                                 : (squared <= 1.0 ? 1.0 : 0.0);
    if (coverage <= 0.0) discard;

    vec3 shaded = color;
    if (dotPixels <= 0.0) {
        vec3 normal = vec3(disc.x, -disc.y, sqrt(max(0.0, 1.0 - squared)));
        float diffuse = dot(normal, kKeyLight);
        vec3 halfway = normalize(kKeyLight + vec3(0.0, 0.0, 1.0));
        float shine = pow(max(dot(normal, halfway), 0.0), 24.0);
        shaded = color * (kAmbient + kKey * max(diffuse, -0.3)) + kShine * shine;
    }
    fragment = vec4(shaded, coverage);
}
