#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 vertex_tangent;
layout(location = 3) in vec2 vertex_uv;

layout(location = 16) uniform mat4 view_projection;

invariant gl_Position; // passes that shade what is seen draw it again
out vec2 uv;
#ifndef ONLY_TRIANGLE
out vec3 point;
out vec3 normal;
out vec4 tangent;
#ifdef DETAIL_EYE_SPACE
#define DETAIL_VERTICES
#include "detail_vertex.glsl"
#endif
#endif

void main()
{
    uv = vertex_uv;
#ifndef ONLY_TRIANGLE
    point = position;
    normal = vertex_normal;
    tangent = vertex_tangent;
#ifdef DETAIL_EYE_SPACE
    set_offsets(vertex_normal);
#endif
#endif
    gl_Position = view_projection * vec4(position, 1.0);
}
