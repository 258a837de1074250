// The ground disc (ground.h), for GLSL and C. `disc` is its centre and radius; radius 0: there is no ground.
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
