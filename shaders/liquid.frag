#version 330 core

// The visible half of a sphere: its normal from the place in the disc, lit by a key light from the upper left.
// Depth stays that of the centre: at the size of particles it cannot be told from the sphere's own.

flat in vec3 color;
flat in float discPixels;
flat in float spritePixels;

uniform float dotPixels;
uniform bool smoothEdges;

out vec4 fragment;

const vec3 kKeyLight = normalize(vec3(-0.45, 0.65, 0.75));  // eye space
const vec3 kHalfway = normalize(kKeyLight + vec3(0.0, 0.0, 1.0));

void main()
{
    vec2 disc = (2.0 * gl_PointCoord - 1.0) * (spritePixels / discPixels);
    float squared = dot(disc, disc);
    // Distance to the edge in pixels, (1 - r) discPixels / 2, with 1 - r = (1 - r^2) / 2 close to it.
    float inside = 0.25 * discPixels * (1.0 - squared);
    float coverage = smoothEdges ? clamp(0.5 + inside, 0.0, 1.0) : (inside >= 0.0 ? 1.0 : 0.0);
    if (coverage <= 0.0) discard;

    vec3 shaded = color;
    if (dotPixels <= 0.0) {
        vec3 normal = vec3(disc.x, -disc.y, sqrt(max(0.0, 1.0 - squared)));
        // Few pixels cannot show a ball: small ones are lit more evenly, or the liquid looks like sand.
        float roundness = clamp(0.35 + 0.05 * discPixels, 0.0, 1.0);
        float lit = max(dot(normal, kKeyLight), -0.3) - 0.72;
        float shine = max(dot(normal, kHalfway), 0.0);
        shine *= shine;
        shine *= shine;
        shine *= shine;
        shine *= shine;
        shaded = color * (1.0 + 0.5 * roundness * lit) + 0.10 * roundness * shine;
    }
    fragment = vec4(shaded, coverage);
}
