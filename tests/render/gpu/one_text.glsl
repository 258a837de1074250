// One number of each term that GLSL and C share, at a trial: the inputs come from a sequence in whole numbers, which both
// compute to the bit.
#define ONE_TEXT_NUMBERS 113
#define ONE_TEXT_TRIALS 512

TERM float one_text(int number, uint trial)
{
    vec2 a = spread_place(0u, trial), b = spread_place(1u, trial), c = spread_place(2u, trial);
    vec2 d = spread_place(3u, trial), e = spread_place(4u, trial);
    vec3 n = direction_or(vec3(2.0f * a.x - 1.0f, 2.0f * a.y - 1.0f, 2.0f * b.x - 1.0f), vec3(0.0f, 1.0f, 0.0f));
    vec3 v = direction_or(vec3(2.0f * b.y - 1.0f, 2.0f * c.x - 1.0f, 2.0f * c.y - 1.0f), n);
    float s = 1.0f + 200.0f * d.x * d.x;
    float cosine = dot(n, v);
    // Vectors.
    vec3 mixed = vec3_add(vec3_scale(n, d.y), vec3_subtract(cross(n, v), vec3_multiply(n, v)));
    if (number < 3)
        return number == 0 ? mixed.x : number == 1 ? mixed.y : mixed.z;
    vec3 short_one = direction_or(vec3_scale(n, 1e-20f), v);
    if (number < 6)
        return number == 3 ? short_one.x : number == 4 ? short_one.y : short_one.z;
    // The light's terms.
    if (number < 12)
        return number == 6   ? lobe_cosine(s, cosine)
               : number == 7 ? lobe_broadened_exponent(s, d.y)
               : number == 8 ? disc_cosine(cosine, e.x)
               : number == 9 ? disc_share(2.0f * cosine)
               : number == 10 ? region_lobe(cosine, 0.1f + e.x, 1.0f / (0.1f + e.x), s)
                              : region_lobe_diffuse(cosine, 0.1f + e.x, 1.0f / (0.1f + e.x));
    // Maps of lobes.
    vec2 place = octahedral_place(n);
    if (number < 16)
        return number == 12   ? place.x
               : number == 13 ? place.y
               : number == 14 ? lobe_texel(place.x, 32.0f)
                              : float(lobe_blend_number(12.0f * d.y - 1.0f));
    // The ground.
    vec4 disc = vec4(0.2f, -0.1f, 0.3f, number == 17 ? 0.0f : 1.0f);
    if (number < 20)
        return number < 18 ? ground_opacity(disc, 2.0f * e.x, 2.0f * e.y) : ground_passes(disc, vec3(e.x, d.y, e.y), n);
    // Bounced light.
    float basis[BOUNCED_TERMS];
    BouncedShares shares = bounced_lobe(v, n, s, basis);
    if (number < 24) {
        float sum = 0.0f;
        for (int i = 0; i < BOUNCED_TERMS; i++)
            sum += basis[i] * float(i + 1);
        return number == 20 ? sum : number == 21 ? shares.even : number == 22 ? shares.above : share_above(cosine, s);
    }
    // Facets, seen from above.
    float weft = 0.03f + 0.6f * d.x, warp = 0.03f + 0.6f * e.x, z = 0.02f + 0.98f * abs(n.z);
    float level = sqrt(max(1.0f - z * z, 0.0f)), x = level * sin(6.0f * e.y), y = level * cos(6.0f * e.y);
    FacetWidening wider = facet_widening(0.8f, 0.6f, d.y - 0.5f, 0.1f * a.x, 0.1f * a.y, 0.1f * b.x - 0.05f);
    FacetAxes axes = facet_axes(facet_square(weft * weft, wider.weft), facet_square(warp * warp, wider.warp),
                                facet_product(weft * weft, warp * warp, wider.product));
    if (number < 31)
        return number == 24   ? wider.weft
               : number == 25 ? wider.warp
               : number == 26 ? wider.product
               : number == 27 ? axes.square_x
               : number == 28 ? axes.square_y
               : number == 29 ? axes.cosine
                              : axes.sine;
    LobeSet set = lobe_set(weft, warp, x, y, z, 1.0f, 7.0f);
    SlopeLobe lobe = slope_lobe(set, 1.0f, x, y, z);
    SlopeQuadrature nodes = slope_quadrature(weft, warp, x, y, z);
    WardSlope slope = ward_slope(d.y < 0.5f, x, y, z, lobe.slope_x, lobe.slope_y);
    if (number < 40)
        return number == 31   ? set.count
               : number == 32 ? set.first
               : number == 33 ? set.step_by
               : number == 34 ? set.across_x
               : number == 35 ? lobe.slope_x
               : number == 36 ? lobe.slope_y
               : number == 37 ? lobe.share
               : number == 38 ? sqrt(lobe.variance)
                              : slope_above(cosine, slope_exponent(lobe.variance));
    if (number < 47)
        return number == 40   ? nodes.along_x
               : number == 41 ? nodes.across_y
               : number == 42 ? nodes.middle
               : number == 43 ? nodes.share
               : number == 44 ? slope_weight(int(5.0f * e.y), 3.0f * a.x)
               : number == 45 ? min(slope.value, 10.0f)
                              : slope.cosine + slope.towards;
    if (number < 50)
        return number == 47   ? schlick_colour(vec3(e.x, 0.01f, 1.0f), cosine).x
               : number == 48 ? fresnel_dielectric(0.5f + 2.0f * e.x, max(cosine, 0.0f))
                              : min(ward_lobe(d.y < 0.5f, a.x, a.y - 0.5f, 0.1f + b.y, b.x - 0.1f, z, weft * weft,
                                              warp * warp, 0.5f * weft * warp), 100.0f);
    // The reflectance of facets, and the lobes that stand for them.
    WardFacets facets;
    facets.is_bounded = d.y < 0.5f;
    facets.fresnel = int(3.0f * a.x);
    facets.index = 0.5f + 2.0f * b.x;
    facets.extinction = 3.0f * b.y;
    facets.x = x;
    facets.y = y;
    facets.z = z;
    WardValues node = ward_node(facets, nodes, int(5.0f * e.y));
    WardLobe ward = ward_lobe_of(facets, set, 1.0f);
    FacetReflected thread_light = thread_reflected(vec3(0.1f * a.x, a.y, 0.04f), vec3(b.x, b.y, 1.0f), vec3(0.5f, 1.5f, c.x));
    MaterialLayers over = material_layers(vec4(b.y, e.y - 0.5f, 0.0f, 0.0f), a.x, s, vec3(d.x, d.y, e.x), 0.1f + 0.8f * e.x,
                                          b.x - 0.2f, n, v, direction_or(vec3(a.y, b.y, c.y), v),
                                          direction_or(vec3(d.x, d.y, e.y), n));
    vec2 on_map = latlong_place(n), on_face = cube_place(cube_face(v), n);
    vec3 in_row = latlong_direction(a.x, int(18.99f * b.x), 19, b.y), on_cube = cube_direction(int(5.99f * a.x), b.x, c.y);
    vec3 bounced = bounce_direction(n, vec3_scale(v, e.y < 0.1f ? 0.0f : 1.0f), d.x, d.y);
    vec4 lamp = vec4(a.x, b.x, c.x, e.y < 0.5f ? 0.0f : 1.0f);
    vec3 towards = towards_lamp(lamp, v, n);
    vec3 squares = vec3(weft * weft, warp * warp, 0.5f * weft * warp);
    vec2 chosen = facet_slope(squares, a.x, a.y), on_ground = ground_place(disc, 3.0f * b.x, 3.0f * b.y);
    vec3 about = lobe_direction(n, lobe_off_axis(s * s, c.x), c.y);
    vec3 moved = smooth_shift(v, n, direction_or(vec3(d.x, d.y, e.x), n), e.y);
    Frame frame;
    frame.n = n;
    frame.t = thread_direction(n, vec3(d.x, d.y, e.x), 1.0f, 0.0f);
    frame.b = cross(n, frame.t);
    vec3 light = direction_or(vec3_add(n, vec3_scale(v, 0.7f)), n);
    vec3 eye = direction_or(vec3_add(n, vec3(0.5f * d.x, 0.5f * e.x, 0.0f)), n);
    Cosines cosines = cosines_of(frame, light, eye, direction_or(vec3_add(light, eye), light));
    if (number > 109)
        return number == 110   ? fresnel_colour(facets.fresnel, facets.index, facets.extinction, vec3(e.x, 0.1f, 1.0f), cosines.b).x
               : number == 111 ? lobe_scale(int(5.99f * b.x), s)
                               : min(lobe_of(int(5.99f * b.x), int(2.99f * a.y), int(2.99f * c.y), cosines, 1.0f + 20.0f * a.x,
                                              weft), 5.0f);
    if (number > 102)
        return number == 103   ? lobe_off_axis(s * s, c.x)
               : number == 104 ? about.x + about.y - about.z
               : number == 105 ? chosen.x + chosen.y
               : number == 106 ? min(facet_slope_pdf(squares, vec3(x, y, z)), 10.0f)
               : number == 107 ? moved.x + moved.y - moved.z
               : number == 108 ? 0.01f * (on_ground.x + on_ground.y) // a driver may err in its inverse functions
                               : ground_ring_radius(31.0f * a.x);
    if (number > 94)
        return number == 95   ? 0.3f * (on_map.x + on_map.y) // a driver may err in its inverse functions
               : number == 96 ? min(max(on_face.x - on_face.y, -10.0f), 10.0f)
               : number == 97 ? in_row.x + in_row.y - in_row.z
               : number == 98 ? on_cube.x + on_cube.y - on_cube.z + every_second_bit(trial * 77773u)
               : number == 99 ? bounced.x + bounced.y - bounced.z
               : number == 100 ? towards.x + towards.y - towards.z + bounce_pdf(e.x)
               : number == 101 ? lamp_falloff(lamp, v)
                              : light_above(e.y < 0.5f, 0.02f * e.x, 0.05f * (d.x - 0.5f)) + cube_stretch(1.0f + 2.0f * c.x);
    if (number > 92)
        return number == 93 ? over.base + over.coat + over.matt_albedo +
                                  material_matt(over, direction_or(vec3_add(v, vec3(d.x, d.y, e.x)), n))
                            : min(material_over(over, v, direction_or(vec3(c.x, c.y, e.y), n), 0.1f * b.y).z, 10.0f);
    if (number > 84)
        return number == 85   ? coat_share(a.x - 0.1f, cosine)
               : number == 86 ? fresnel_by_index(facets.fresnel, facets.index, facets.extinction, max(cosine, 0.0f))
               : number == 87 ? min(node.plain, 10.0f)
               : number == 88 ? min(node.away, 10.0f) + node.share
               : number == 89 ? ward.x + ward.y + ward.z
               : number == 90 ? min(ward.plain + ward.away, 10.0f)
               : number == 91 ? thread_light.plain.x + thread_light.away.y
                              : min(ward_under_disc(d.y < 0.5f, a.x, a.y - 0.5f, 0.5f + b.x, 1.0f + c.x, b.y, z,
                                                    weft * weft, warp * warp, 0.0f, 0.2f * c.y), 100.0f);
    // Bumps and the surface that they bend.
    int minify = int(3.0f * c.x);
    Bumps mean = bumps_of_moments(a.x - 0.5f, a.y - 0.5f, 0.3f + 0.2f * b.x, 0.3f + 0.2f * b.y, 0.1f * c.x, d.x, d.y);
    Bumps all = bumps_add(mean, bumps_add(bumps_of_texel(vec3(b.x, b.y, 0.5f + 0.5f * c.x), 0.5f, d.y),
                                          bumps_of_slopes(c.x, c.y, vec3(0.1f * d.x, 0.1f * d.y, 0.01f))));
    SurfaceShape shape = surface_shape(minify, all, vec3_scale(n, 0.9f), n, v, e.x - 0.5f, e.y < 0.5f ? 1.0f : -1.0f,
                                       direction_or(vec3(d.x, d.y, e.x), n), c.y, e.y);
    vec3 facing = facing_normal(vec3(n.x, n.y, 0.001f * n.z), v);
    if (number < 58)
        return number == 50   ? shape.normal.x
               : number == 51 ? shape.normal.y
               : number == 52 ? shape.glossiness
               : number == 53 ? shape.widening.x
               : number == 54 ? shape.widening.y
               : number == 55 ? shape.widening.z
               : number == 56 ? shape.open
                              : facing.x + facing.y;
    SurfaceTexels texels = surface_texels();
    texels.tint = vec3(a.x, a.y, 0.5f);
    texels.gloss = b.x;
    texels.occlusion = b.y;
    texels.thread = 1.2f * c.x;
    texels.shade = 1.2f * c.y;
    SurfaceColours cloth;
    cloth.diffuse = vec3(d.x, 0.3f, 0.4f);
    cloth.f0 = vec3(0.3f * d.y, 0.3f, 0.4f);
    cloth.glossiness = d.y;
    SurfaceColours seen = surface_colours(cloth, texels, e.x < 0.5f, vec3(0.1f, e.y, 0.2f), vec3(e.y, 0.1f, 0.2f),
                                          vec3(0.9f, 0.1f, 0.2f));
    // Fuzz, threads and directions.
    float weights[FUZZ_POWERS];
    float albedo = fuzz_lobes(0.1f + 0.8f * e.x, cosine, weights);
    vec3 thread = thread_direction(n, vec3_scale(v, e.y < 0.1f ? 0.0f : 1.0f), 0.8f, 0.6f);
    vec3 mirror = mirror_direction(n, v), turned = turned_direction(0.8f, 0.6f, n);
    if (number >= 64)
        return number == 64   ? albedo
               : number == 65 ? weights[1]
               : number == 66 ? fuzz_lobes_at(weights, e.y)
               : number == 67 ? min(fuzz_value(0.1f + 0.8f * e.x, n, v, direction_or(vec3(d.x, d.y, e.x), n)), 10.0f)
               : number == 68 ? fuzz_axis(d.x - 0.3f, n, v).y
               : number == 69 ? thread.x + thread.y
               : number == 70 ? thread.z
               : number == 71 ? mirror.x
               : number == 72 ? mirror.y + mirror.z
               : number == 73 ? turned.x + turned.z
               : number == 74 ? lobe_exponent(e.x)
               : number == 76 ? min(facet_density(int(3.0f * a.x), 0.05f + e.x, 2.0f * e.y), 100.0f)
               : number == 77 ? facet_lambda(int(3.0f * a.x), 0.05f + e.x, 0.01f + 0.99f * e.y)
               : number == 78 ? facet_masking(1, int(3.0f * a.x), 0.05f + e.x, 0.01f + e.y, 0.01f + b.x, 0.5f + 0.5f * b.y, d.x)
               : number == 79 ? thread_scale(s)
               : number == 80 ? arc_tangent(2.0f * e.x)
               : number == 81 ? register_value(d.x)
               : number == 82 ? register_newton_vector(vec3_scale(n, 0.8f + 0.2f * d.x)).y
               : number == 84 ? unit_series(0.5f + d.x, 1 + int(2.99f * e.y))
               : number == 83 ? register_power(cosine, int(9.0f * d.y))
                              : texel_level(4.0f * d.x, 30.0f * e.y);
    return number == 58   ? seen.diffuse.x
           : number == 59 ? seen.diffuse.y
           : number == 60 ? seen.f0.x
           : number == 61 ? seen.f0.y
                          : seen.glossiness;
}
