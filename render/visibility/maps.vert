#version 450 core
// A surface seen along a region's direction: orthographic, depth linear [Knuth et al. 2014, 3.3]. What a plain depth
// map does not keep is not handed on: on software GL that is a third of its time.
layout(location = 0) in vec3 position;
layout(location = 3) in vec2 vertex_uv;

layout(location = 16) uniform vec4 map_rows[3]; // world point -> map u, map v, depth

#ifdef MOMENTS
out float depth;
#endif
#ifdef MASKED
out vec2 uv;
#endif

void main()
{
    vec4 point = vec4(position, 1.0);
    float z = dot(map_rows[2], point);
#ifdef MOMENTS
    depth = z;
#endif
#ifdef MASKED
    uv = vertex_uv;
#endif
    gl_Position = vec4(2.0 * dot(map_rows[0], point) - 1.0, 2.0 * dot(map_rows[1], point) - 1.0, 2.0 * z - 1.0, 1.0);
}
