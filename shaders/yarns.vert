#version 330 core

layout(location = 0) in vec3 position;  // world [cm]
layout(location = 1) in vec3 normal;
layout(location = 2) in float turn;     // [pitches of the plies]
layout(location = 3) in float angle;    // [turns]
layout(location = 4) in float value;
layout(location = 5) in vec4 paint;     // a = 1: this colour, 0: that of the value

uniform mat4 view;
uniform mat4 projection;
uniform vec2 range;  // values at the ends of the colour map

out vec3 eyePosition;
out vec3 eyeNormal;
out float helix;     // counts the plies around the yarn
out float shade;     // place in the colour map
flat out vec4 flatColor;

const float kPlies = 3.0;

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    eyePosition = eye.xyz;
    eyeNormal = mat3(view) * normal;
    helix = kPlies * (angle - turn);
    shade = (value - range.x) / (range.y - range.x);
    flatColor = paint;
    gl_Position = projection * eye;
}
