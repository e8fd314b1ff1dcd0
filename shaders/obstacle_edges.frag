#version 330 core

noperspective in float fromMiddle;

uniform vec3 color;
uniform float linePixels;

out vec4 fragment;

void main()
{
    float coverage = clamp(0.5 * linePixels + 0.5 - abs(fromMiddle), 0.0, 1.0);
    fragment = vec4(0.75 * color, 0.8 * coverage);
}
