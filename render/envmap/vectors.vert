#version 450 core
// The directions of look-ups at the vertices of a surface, as OpenGL generates texture coordinates: interpolated and not
// renormalised [Heidrich and Seidel 1999, 4.1].
#include "vectors.glsl"

const int REFRACTION = 2, TRANSMISSION = 5;

layout(location = 64) uniform mat4 view_projection;
layout(location = 65) uniform vec3 eye;
layout(location = 66) uniform int mode;
layout(location = 67) uniform float index; // of refraction

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;

invariant gl_Position;
out vec3 over; // the reflected view vector, the same for both sides
out float cosine; // n . v of the front
out vec3 under_front, under_back;

// The refracted view vector by Snell's law for the side whose normal is n; in case of total reflection the mirrored one.
vec3 refracted(vec3 v, vec3 n, vec3 mirror, float ratio)
{
    float c = clamp(dot(n, v), 0.0, 1.0), square = 1.0 - ratio * ratio * (1.0 - c * c);
    return square < 0.0 ? mirror : normalize((ratio * c - sqrt(square)) * n - ratio * v);
}

void main()
{
    vec3 n = direction_or(vertex_normal, vec3(0.0, 1.0, 0.0)), v = direction_or(eye - position, n);
    cosine = dot(n, v);
    over = 2.0 * cosine * n - v;
    under_front = mode == REFRACTION ? refracted(v, n, over, 1.0 / index) : mode == TRANSMISSION ? -v : n;
    under_back = mode == REFRACTION ? refracted(v, -n, over, index) : mode == TRANSMISSION ? -v : -n;
    gl_Position = view_projection * vec4(position, 1.0);
}
