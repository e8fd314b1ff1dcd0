#version 330 core

in vec3 eyePosition;
in vec3 eyeNormal;

uniform vec3 color;

out vec4 fragment;

#include "lighting.glsl"

void main()
{
    vec3 normal = normalize(gl_FrontFacing ? eyeNormal : -eyeNormal);
    fragment = vec4(lit(color, normal, normalize(-eyePosition), 0.8), 0.0);
}
