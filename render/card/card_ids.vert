#version 450 core
// All triangles at once, for the number of the nearest one at every pixel.
#include "card_frame.glsl"
layout(location = 0) in vec3 position;

void main()
{
    gl_Position = view_projection * vec4(position, 1.0);
}
