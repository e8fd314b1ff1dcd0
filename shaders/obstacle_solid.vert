#version 330 core

layout(location = 0) in vec3 position;  // world [cm]
layout(location = 1) in vec3 normal;

uniform mat4 view;
uniform mat4 projection;

out vec3 eyePosition;
out vec3 eyeNormal;

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    eyePosition = eye.xyz;
    eyeNormal = mat3(view) * normal;
    gl_Position = projection * eye;
}
