// Places the start of the rays of a pixel to a sun (render/shade/sun_bundle.c). False: the surface faces away.
bool sun_start(Place p, int sun, out vec3 start)
{
    vec3 normal = direction_or(smooth_of(p), vec3(0.0, 1.0, 0.0)) * (p.back ? -1.0 : 1.0);
    start = ray_start(p, normal);
    return dot(normal, sun_at(sun, start, normal).towards) > 0.0;
}

// Whether a place of a sun, or a lamp, is seen.
bool sees_sun(int sun, uint place, vec3 start)
{
    Sun at = sun_at(sun, start, vec3(0.0, 1.0, 0.0));
    vec3 d = at.is_lamp ? at.towards : sun_places[16 * min(sun, 3) + int(place)].xyz;
    return ground_passes_from(start, d, at.way) > 0.5 && !tree_occluded(start, d, 0.0, at.way);
}
