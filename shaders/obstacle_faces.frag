#version 330 core

// Faint glass: walls differ by how they face the key light, rims and narrow roundings are denser.

in vec3 eyePosition;
in vec3 eyeNormal;
flat in float faceBend;

uniform vec3 color;
uniform float opacity;

out vec4 fragment;

const vec3 kKeyLight = normalize(vec3(-0.45, 0.65, 0.75));

void main()
{
    vec3 normal = normalize(gl_FrontFacing ? eyeNormal : -eyeNormal);
    float facing = abs(dot(normal, normalize(eyePosition)));
    float rim = pow(1.0 - facing, 3.0);
    float rounding = smoothstep(6.0, 16.0, faceBend);
    float lit = 0.5 + 0.5 * dot(normal, kKeyLight);
    float density = opacity * (0.55 + 0.6 * (1.0 - lit) + 1.2 * rim + 0.8 * rounding);
    fragment = vec4(color * (0.6 + 0.4 * lit), clamp(density, 0.0, 1.0));
}
