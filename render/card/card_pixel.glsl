// The place of a pixel on the triangle that its ID names, by planes through the eye and an edge, which need no clipping.
#include "card_geometry.glsl"
#include "spread_terms.glsl"
layout(binding = 0) uniform usampler2D ids;

struct Place {
    uint triangle;
    bool back;
    uvec3 corners;
    vec3 weights, at_x, at_y; // of the corners; their changes to the next pixel across and up
    vec3 points[3];
    vec3 ray;                 // unit, from the eye
};

Place place_of(uint id, ivec2 pixel)
{
    Place p;
    p.triangle = (id & 0x7fffffffu) - 1u;
    p.back = (id >> 31) != 0u;
    p.corners = corners_of(p.triangle);
    for (int i = 0; i < 3; i++)
        p.points[i] = position_of(p.corners[i]);
    vec3 a = p.points[0] - eye.xyz, b = p.points[1] - eye.xyz, c = p.points[2] - eye.xyz;
    vec3 ray = ray_first.xyz + ray_across.xyz * float(pixel.x) + ray_up.xyz * float(pixel.y);
    // Small differences of large products are taken first.
    mat3 planes = mat3(cross(b, p.points[2] - p.points[1]), cross(c, p.points[0] - p.points[2]), cross(a, p.points[1] - p.points[0]));
    vec3 w = ray * planes, across = ray_across.xyz * planes, up = ray_up.xyz * planes;
    float facing = w.x + w.y + w.z < 0.0 ? -1.0 : 1.0;
    w = max(w * facing, 0.0);
    float sum = w.x + w.y + w.z, scale = sum > 0.0 ? 1.0 / sum : 0.0;
    p.weights = sum > 0.0 ? w * scale : vec3(1.0 / 3.0);
    across *= facing;
    up *= facing;
    p.at_x = scale * (across - p.weights * (across.x + across.y + across.z));
    p.at_y = scale * (up - p.weights * (up.x + up.y + up.z));
    p.ray = direction_or(ray, vec3(0.0, -1.0, 0.0));
    return p;
}

vec3 smooth_of(Place p)
{
    return p.weights.x * normal_of(p.corners.x) + p.weights.y * normal_of(p.corners.y) + p.weights.z * normal_of(p.corners.z);
}

vec3 point_of(Place p)
{
    return p.weights.x * p.points[0] + p.weights.y * p.points[1] + p.weights.z * p.points[2];
}

// Places the start of rays on the smooth surface (tl_smooth_point), whose unit `normal` is on the side that is seen.
vec3 ray_start(Place p, vec3 normal)
{
    vec3 point = point_of(p), moved = point;
    for (int i = 0; i < 3; i++)
        moved += smooth_shift(point, p.points[i], normal_of(p.corners[i]) * (p.back ? -1.0 : 1.0), p.weights[i]);
    return moved + normal * eye.w;
}
