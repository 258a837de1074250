#version 450 core
// A surface with its place in the light map, or the light of its vertices.
layout(location = 64) uniform mat4 view_projection;
layout(location = 65) uniform vec4 map_frame; // offset, factor on UV
layout(location = 66) uniform int layer; // of the front; -1: at vertices
layout(location = 67) uniform ivec2 first_vertex; // of front and back in the buffer

layout(location = 0) in vec3 position;
layout(location = 3) in vec2 vertex_uv;

layout(std430, binding = 2) readonly buffer VertexLight
{
    vec4 vertex_light[];
};

invariant gl_Position;
out vec2 chart;
out vec3 light_front, light_back;

void main()
{
    chart = map_frame.xy + vertex_uv * map_frame.zw;
    light_front = layer < 0 ? vertex_light[first_vertex.x + gl_VertexID].rgb : vec3(0.0);
    light_back = layer < 0 ? vertex_light[first_vertex.y + gl_VertexID].rgb : vec3(0.0);
    gl_Position = view_projection * vec4(position, 1.0);
}
