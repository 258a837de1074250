#version 450 core
// A surface seen along a region's direction: orthographic, depth linear [002, section 3.3].
layout(location = 0) in vec3 position;
layout(location = 3) in vec2 vertex_uv;

layout(location = 16) uniform vec4 map_rows[3]; // world point -> map u, map v, depth

out float depth;
out vec2 uv;

void main()
{
    vec4 point = vec4(position, 1.0);
    depth = dot(map_rows[2], point);
    uv = vertex_uv;
    gl_Position = vec4(2.0 * dot(map_rows[0], point) - 1.0, 2.0 * dot(map_rows[1], point) - 1.0,
                       2.0 * depth - 1.0, 1.0);
}
