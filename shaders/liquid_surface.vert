#version 330 core

layout(location = 0) in vec3 position;  // world [cm]
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;

uniform mat4 view;
uniform mat4 projection;
uniform vec2 range;  // values at the ends of the colour map

out vec3 eyePosition;
out vec3 eyeNormal;
out float shade;     // place in the colour map

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    eyePosition = eye.xyz;
    eyeNormal = mat3(view) * normal;
    shade = (value - range.x) / (range.y - range.x);
    gl_Position = projection * eye;
}
