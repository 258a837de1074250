// Faces of a cube map (render/env/cube.h).
vec3 cube_direction(int face, float s, float t)
{
    float a = 2.0 * s - 1.0, b = 2.0 * t - 1.0;
    return face == 0 ? vec3(1.0, -b, -a) : face == 1 ? vec3(-1.0, -b, a) : face == 2 ? vec3(a, 1.0, b)
         : face == 3 ? vec3(a, -1.0, -b) : face == 4 ? vec3(a, -b, 1.0) : vec3(-a, -b, -1.0);
}

int cube_texel(vec3 d, int side)
{
    vec3 m = abs(d);
    int face = m.x >= m.y && m.x >= m.z ? (d.x < 0.0 ? 1 : 0) : m.y >= m.z ? (d.y < 0.0 ? 3 : 2) : (d.z < 0.0 ? 5 : 4);
    vec2 st = face < 2   ? vec2(face == 1 ? d.z : -d.z, -d.y) / m.x
              : face < 4 ? vec2(d.x, face == 3 ? -d.z : d.z) / m.y
                         : vec2(face == 5 ? -d.x : d.x, -d.y) / m.z;
    ivec2 at = clamp(ivec2((0.5 * st + 0.5) * float(side)), 0, side - 1);
    return (face * side + at.y) * side + at.x;
}
