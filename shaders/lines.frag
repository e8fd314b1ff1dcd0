#version 330 core

noperspective in float fromMiddle;
noperspective in float halfWidth;

uniform vec3 color;

out vec4 fragment;

void main()
{
    float coverage = clamp(halfWidth + 0.5 - abs(fromMiddle), 0.0, 1.0);
    fragment = vec4(color, coverage);
}
