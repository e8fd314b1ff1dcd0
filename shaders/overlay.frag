#version 330 core

uniform sampler2D notes;  // colours times opacity, and opacity

out vec4 fragment;

void main()
{
    fragment = texelFetch(notes, ivec2(gl_FragCoord.xy), 0);
}
