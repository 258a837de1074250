#version 450 core
// A surface in the view of a lamp. maps.frag writes its depth.
layout(location = 0) in vec3 position;
layout(location = 3) in vec2 vertex_uv;

layout(location = 73) uniform mat4 lamp_view;

#ifdef MASKED
out vec2 uv;
#endif

void main()
{
#ifdef MASKED
    uv = vertex_uv;
#endif
    gl_Position = lamp_view * vec4(position, 1.0);
}
