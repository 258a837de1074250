// Directions in pictures of the whole sphere, for GLSL and C: cube maps (cube.h), and lat-long pictures (layout.h).
#ifdef GL_core_profile
#define atan2 atan
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// ---- Cubes ----

TERM vec3 cube_direction(int face, float s, float t)
{
    float u = 2.0f * s - 1.0f, v = 2.0f * t - 1.0f;
    if (face < 2)
        return face == 0 ? vec3(1.0f, -v, -u) : vec3(-1.0f, -v, u);
    if (face < 4)
        return face == 2 ? vec3(u, 1.0f, v) : vec3(u, -1.0f, -v);
    return face == 4 ? vec3(u, -v, 1.0f) : vec3(-u, -v, -1.0f);
}

TERM int cube_face(vec3 d)
{
    float x = abs(d.x), y = abs(d.y), z = abs(d.z);
    int on_x = d.x < 0.0f ? 1 : 0, on_y = d.y < 0.0f ? 3 : 2, on_z = d.z < 0.0f ? 5 : 4;
    return x >= y && x >= z ? on_x : y >= z ? on_y : on_z;
}

// The point where a direction meets the plane of a face; the middle for the zero vector.
TERM vec2 cube_place(int face, vec3 d)
{
    float major = abs(face < 2 ? d.x : face < 4 ? d.y : d.z), over = major > 0.0f ? major : 1.0f;
    float s = face == 0 ? -d.z : face == 1 ? d.z : face == 5 ? -d.x : d.x;
    float t = face == 2 ? d.z : face == 3 ? -d.z : -d.y;
    return vec2(0.5f * (s / over + 1.0f), 0.5f * (t / over + 1.0f));
}

// The number of the one of `count` texels that a share lies in.
TERM int texel_within(float share, int count)
{
    int at = int(share * float(count));
    return at < 0 ? 0 : at < count ? at : count - 1;
}

TERM int cube_texel(vec3 d, int side)
{
    int face = cube_face(d);
    vec2 at = cube_place(face, d);
    return (face * side + texel_within(at.y, side)) * side + texel_within(at.x, side);
}

// The area of a face, at distance 1, by solid angle, at a point of this squared distance from the centre.
TERM float cube_stretch(float square)
{
    return square * sqrt(square);
}

// ---- Lat-long pictures ----

// The place of a direction of any length; acos would lose half of its digits at the poles.
TERM vec2 latlong_place(vec3 d)
{
    float across = sqrt(d.x * d.x + d.z * d.z), turn = across > 0.0f ? atan2(d.x, -d.z) : 0.0f;
    return vec2(0.5f + turn / 6.28318531f, atan2(across, d.y) / 3.14159265f);
}

// The direction at u below which lies `share` of the solid angle of a row. 1 - cos a = 2 sin^2(a / 2) from the nearer pole
// keeps its digits.
TERM vec3 latlong_direction(float u, int row, int rows, float share)
{
    bool below = 2 * row >= rows;
    float from = float(below ? rows - 1 - row : row), part = below ? 1.0f - share : share;
    float upper = sin(1.57079633f * from / float(rows)), lower = sin(1.57079633f * (from + 1.0f) / float(rows));
    float square = upper * upper + (lower * lower - upper * upper) * part; // of the sine of half the angle
    float height = 1.0f - 2.0f * square, radius = 2.0f * sqrt(max(square * (1.0f - square), 0.0f));
    float phi = 6.28318531f * (u - 0.5f);
    return vec3(radius * sin(phi), below ? -height : height, -radius * cos(phi));
}

// ---- Places of a curve ----

// Every second bit, starting with the lowest, as a number in (0, 1): a place within a texel in Z order.
TERM float every_second_bit(uint bits)
{
    uint b = bits & 0x55555555u;
    b = (b | b >> 1) & 0x33333333u;
    b = (b | b >> 2) & 0x0f0f0f0fu;
    b = (b | b >> 4) & 0x00ff00ffu;
    b = (b | b >> 8) & 0x0000ffffu;
    return (float(b) + 0.5f) / 65536.0f;
}
