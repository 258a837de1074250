// The ground disc (ground.h), for GLSL and C. `disc` is its centre and radius; radius 0: there is no ground.
#ifdef GL_core_profile
#define atan2 atan
#endif
#ifndef TERM
#define TERM
#endif

// The opacity of the disc at a point of its plane: whole to half its radius, then fading to its rim.
TERM float ground_opacity(vec4 disc, float x, float z)
{
    float off_x = x - disc.x, off_z = z - disc.z;
    float share = 2.0f * sqrt(off_x * off_x + off_z * off_z) / disc.w - 1.0f, t = clamp(share, 0.0f, 1.0f);
    return disc.w > 0.0f ? 1.0f - t * t * (3.0f - 2.0f * t) : 0.0f;
}

// Its mesh (ground.c): rings of corners about the middle, at radii that grow as sinh(4 t) / sinh(4).
#define GROUND_RINGS 32
#define GROUND_SEGMENTS 48
TERM float ground_ring_radius(float ring) // over the disc's
{
    float power = exp(0.125f * ring);
    return (power - 1.0f / power) / 54.5798344f;
}

// The ring, 0 in the middle, and the segment of the mesh at a point of the plane.
TERM vec2 ground_place(vec4 disc, float x, float z)
{
    float off_x = x - disc.x, off_z = z - disc.z, sine = 27.2899172f * sqrt(off_x * off_x + off_z * off_z) / disc.w;
    float turn = atan2(off_z, off_x) / 6.28318531f;
    return vec2(5.54517744f * log2(sine + sqrt(sine * sine + 1.0f)), 48.0f * (turn < 0.0f ? turn + 1.0f : turn));
}

// The distance of a ray from above to the plane of the disc; below 0: it does not meet it.
TERM float ground_way(vec4 disc, vec3 origin, vec3 direction)
{
    return direction.y < 0.0f && origin.y >= disc.y ? (origin.y - disc.y) / -direction.y : -1.0f;
}

// The share that the disc leaves of directional light from `direction` at `point`, when that light comes from below.
TERM float ground_passes(vec4 disc, vec3 point, vec3 direction)
{
    float way = ground_way(disc, point, direction);
    float opacity = ground_opacity(disc, point.x + direction.x * way, point.z + direction.z * way);
    return way >= 0.0f ? 1.0f - opacity : 1.0f;
}
