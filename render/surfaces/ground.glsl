// The opacity of the ground disc at a point of its plane: whole to half its radius, then fading to its
// rim. `disc` is its centre and radius; radius 0: there is no ground.
float ground_cover(vec4 disc, vec2 point_xz)
{
    if (disc.w <= 0.0)
        return 0.0;
    return 1.0 - smoothstep(0.5, 1.0, length(point_xz - disc.xz) / disc.w);
}

// The share that a ground disc leaves of directional light from `direction` at `point`, when that light comes from
// below.
float ground_visibility(vec4 disc, vec3 point, vec3 direction)
{
    if (direction.y >= 0.0 || point.y < disc.y)
        return 1.0;
    vec2 hit = point.xz + direction.xz * ((point.y - disc.y) / -direction.y);
    return 1.0 - ground_cover(disc, hit);
}
