const uint FACES = 1u, LETS_THROUGH = 2u;

// Places the start of the rays of a pixel to a sun (render/shade/sun_bundle.c). LETS_THROUGH: on the other side, from which it
// shines through; 0: the surface faces away.
uint sun_start(Place p, int sun, bool transmits, out vec3 start)
{
    vec3 normal = direction_or(smooth_of(p), vec3(0.0, 1.0, 0.0)) * (p.back ? -1.0 : 1.0);
    bool is_through = transmits && dot(normal, sun_at(sun, point_of(p), normal).towards) < 0.0;
    if (is_through) {
        p.back = !p.back;
        normal = -normal;
    }
    start = ray_start(p, normal);
    return dot(normal, sun_at(sun, start, normal).towards) > 0.0 ? is_through ? LETS_THROUGH : FACES : 0u;
}

// The share of a place of a sun, or of a lamp, that is seen, in 255ths.
uint sees_sun(int sun, uint place, vec3 start)
{
    Sun at = sun_at(sun, start, vec3(0.0, 1.0, 0.0));
    vec3 d = at.is_lamp ? at.towards : sun_places[16 * min(sun, 3) + int(place)].xyz;
    return ground_passes_from(start, d, at.way) > 0.5 ? uint(255.0 * tree_transmittance(start, d, 0.0, at.way) + 0.5) : 0u;
}
