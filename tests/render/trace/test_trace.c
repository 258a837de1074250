#include "render/trace/trace.h"

#include "render/trace/cutout.h"

#include "tests/render/soup.h"
#include "tests/testing.h"

#include <string.h>

enum { TRIANGLES = 300, RAYS = 4000 };

static tl_trace *open_trace(void)
{
    tl_error error = {0};
    tl_trace *trace = tl_trace_create(&error);
    if (!trace)
        fail_msg("%s", error.message);
    return trace;
}

static void update(tl_trace *trace, const tl_surface *surfaces, size_t count)
{
    tl_error error = {0};
    assert_ok(tl_trace_update(trace, surfaces, count, &error), error);
}

/* The nearest hit by trying all. `doubtful`: a hit lies so near to an edge or to another hit that float may
 * decide otherwise; 1e-5 is a hundred times float's rounding here. */
struct expected {
    size_t surface, triangle;
    double distance, u, v;
    bool hit, back, doubtful;
};

static struct expected try_all(const tl_surface *surfaces, size_t count, vec3s origin, vec3s direction)
{
    struct expected best = {.distance = INFINITY};
    double second = INFINITY;
    for (size_t s = 0; s < count; s++)
        for (size_t t = 0; t < surfaces[s].index_count / 3; t++) {
            vec3s corners[3];
            double distance, u, v;
            for (int i = 0; i < 3; i++)
                corners[i] = surfaces[s].positions[surfaces[s].indices[3 * t + (size_t)i]];
            if (!soup_intersect(corners, origin, direction, &distance, &u, &v) || distance < 0)
                continue;
            double inside = fmin(fmin(u, v), 1 - u - v);
            best.doubtful |= fabs(inside) < 1e-5;
            if (inside < 0)
                continue;
            if (distance < best.distance) {
                second = best.distance;
                vec3s normal = glms_vec3_cross(glms_vec3_sub(corners[1], corners[0]),
                                               glms_vec3_sub(corners[2], corners[0]));
                best = (struct expected){
                    s, t, distance, u, v, true, glms_vec3_dot(normal, direction) > 0, best.doubtful};
            } else {
                second = fmin(second, distance);
            }
        }
    best.doubtful |= best.hit && second - best.distance < 1e-5;
    return best;
}

/* Random rays, all of them, against brute force; returns how many hit, and how many backs. */
static int compare_rays(const tl_trace *trace, const tl_surface *surfaces, size_t count, uint64_t seed,
                        int *backs)
{
    int hits = 0, doubtful = 0;
    for (int i = 0; i < RAYS; i++) {
        vec3s origin = soup_point(&seed, 2), direction = soup_direction(&seed);
        struct expected expected = try_all(surfaces, count, origin, direction);
        struct tl_trace_hit hit = tl_trace_nearest(trace, origin, direction, 0, INFINITY);
        if (expected.doubtful) {
            doubtful++;
            continue;
        }
        assert_int_equal(hit.surface != TL_TRACE_NONE, expected.hit);
        assert_int_equal(tl_trace_occluded(trace, origin, direction, 0, INFINITY), expected.hit);
        if (!expected.hit)
            continue;
        hits++;
        *backs += hit.back;
        assert_int_equal(hit.surface, expected.surface);
        assert_int_equal(hit.triangle, expected.triangle);
        assert_int_equal(hit.back, expected.back);
        assert_near(hit.distance_m, expected.distance, 1e-5 * (1 + expected.distance));
        assert_near(hit.u, expected.u, 1e-3); /* needles: a small error of the point is a large one of u */
        assert_near(hit.v, expected.v, 1e-3);
        float before = hit.distance_m * 0.999f, after = hit.distance_m * 1.001f;
        assert_false(tl_trace_occluded(trace, origin, direction, 0, before));
        assert_true(tl_trace_occluded(trace, origin, direction, before, after));
    }
    assert_true(doubtful < RAYS / 50);
    return hits;
}

static void nearest_hits_are_those_of_brute_force(void **state)
{
    (void)state;
    struct soup soups[2];
    soup_create(&soups[0], TRIANGLES, 1);
    soup_create(&soups[1], TRIANGLES / 2, 2);
    tl_surface surfaces[] = {soups[0].surface, soups[1].surface};
    tl_trace *trace = open_trace();
    int backs = 0;
    update(trace, surfaces, 2);
    int hits = compare_rays(trace, surfaces, 2, 3, &backs);
    assert_in_range(hits, RAYS / 8, RAYS);
    assert_in_range(backs, hits / 3, 2 * hits / 3); /* both sides are hit */
    assert_true(tl_trace_bytes(trace) > sizeof(vec3s) * soups[0].surface.vertex_count);
    tl_trace_destroy(&trace);
    assert_null(trace);
    soup_release(&soups[0]);
    soup_release(&soups[1]);
}

/* One soup moves and one stands; then one goes, and comes back with other triangles. */
static void updates_follow_motion_and_change(void **state)
{
    (void)state;
    struct soup soups[2];
    soup_create(&soups[0], TRIANGLES, 4);
    soup_create(&soups[1], TRIANGLES / 2, 5);
    tl_trace *trace = open_trace();
    int backs = 0;
    for (uint64_t frame = 0; frame < 70; frame++) { /* past the last refit of a tree */
        soup_place(&soups[0], 10 + frame);
        tl_surface surfaces[] = {soups[0].surface, soups[1].surface};
        update(trace, surfaces, 2);
        if (frame < 3 || frame > 67)
            compare_rays(trace, surfaces, 2, 20 + frame, &backs);
    }
    update(trace, &soups[1].surface, 1); /* another surface in the first slot, none in the second */
    compare_rays(trace, &soups[1].surface, 1, 30, &backs);
    update(trace, NULL, 0);
    assert_false(tl_trace_occluded(trace, (vec3s){{0, 0, 0}}, (vec3s){{0, 1, 0}}, 0, INFINITY));
    assert_true(tl_trace_offset(trace) > 0);
    soup_release(&soups[0]);
    soup_create(&soups[0], TRIANGLES / 3, 6);
    update(trace, &soups[0].surface, 1);
    compare_rays(trace, &soups[0].surface, 1, 31, &backs);
    tl_trace_destroy(&trace);
    soup_release(&soups[0]);
    soup_release(&soups[1]);
}

static void packets_match_single_rays(void **state)
{
    (void)state;
    struct soup soup;
    soup_create(&soup, TRIANGLES, 7);
    tl_trace *trace = open_trace();
    update(trace, &soup.surface, 1);
    uint64_t seed = 8;
    int stopped = 0;
    for (int k = 0; k < 400; k++) {
        struct tl_ray_packet bundle = {.count = 1 + k % 16, .from_m = 0.01f, .to_m = 1.5f, .coherent = k % 2};
        vec3s one = soup_direction(&seed), near = soup_point(&seed, 1.5f);
        for (int i = 0; i < 16; i++) {
            vec3s origin = glms_vec3_add(near, soup_point(&seed, bundle.coherent ? 0.02f : 2));
            vec3s direction = bundle.coherent ? one : soup_direction(&seed);
            bundle.origin_x[i] = origin.x, bundle.origin_y[i] = origin.y, bundle.origin_z[i] = origin.z;
            bundle.direction_x[i] = direction.x, bundle.direction_y[i] = direction.y;
            bundle.direction_z[i] = direction.z;
        }
        uint32_t answer = tl_trace_occluded_packet(trace, &bundle);
        assert_int_equal(answer >> bundle.count, 0);
        for (int i = 0; i < bundle.count; i++) {
            vec3s origin = {{bundle.origin_x[i], bundle.origin_y[i], bundle.origin_z[i]}};
            vec3s direction = {{bundle.direction_x[i], bundle.direction_y[i], bundle.direction_z[i]}};
            bool single = tl_trace_occluded(trace, origin, direction, bundle.from_m, bundle.to_m);
            assert_int_equal(answer >> i & 1, single);
            stopped += single;
        }
    }
    assert_in_range(stopped, 500, 3000);
    tl_trace_destroy(&trace);
    soup_release(&soup);
}

/* A map of 4 x 1 texels, alpha 1 0 0 1 from left to right: bilinear alpha falls below 1/2 between the centres
 * of texels 0 and 1, at u = 1/4, and rises above it at u = 3/4. */
static void alpha_cuts_holes(void **state)
{
    (void)state;
    struct soup soup;
    soup_create(&soup, 2, 9);
    tl_image image = tl_image_create(4, 1, 4, TL_IMAGE_U8);
    tl_image_bytes(&image)[3] = tl_image_bytes(&image)[15] = 255;
    soup.materials[1].diffuse_map.image = &image;
    soup.materials[1].diffuse_map.clamp_u = true;
    soup.materials[1].alpha_cutoff = 0.5f;
    const vec3s triangle[3] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}; /* u = x, v = y */
    memcpy(soup.positions, triangle, sizeof triangle);
    memcpy(soup.positions + 3, triangle, sizeof triangle);
    for (int i = 0; i < 3; i++)
        soup.positions[i].z = -5; /* the opaque one, behind */
    tl_trace *trace = open_trace();
    update(trace, &soup.surface, 1);
    for (int k = 0; k < 90; k++) {
        vec3s origin = {{0.005f + 0.01f * (float)k, 0.05f, 1}}, down = {{0, 0, -1}};
        bool hole = origin.x > 0.25f && origin.x < 0.75f;
        if (fabsf(origin.x - 0.25f) < 0.004f || fabsf(origin.x - 0.75f) < 0.004f)
            continue;
        struct tl_trace_hit hit = tl_trace_nearest(trace, origin, down, 0, INFINITY);
        assert_int_equal(hit.surface, 0);
        assert_int_equal(hit.triangle, hole ? 0 : 1);
        assert_near(hit.distance_m, hole ? 6 : 1, 1e-5);
        assert_int_equal(tl_trace_occluded(trace, origin, down, 0, 2), !hole);
        struct tl_ray_packet bundle = {.count = 1,
                                       .origin_x = {origin.x},
                                       .origin_y = {origin.y},
                                       .origin_z = {1},
                                       .direction_z = {-1},
                                       .to_m = 2};
        assert_int_equal(tl_trace_occluded_packet(trace, &bundle), !hole);
    }
    tl_trace_destroy(&trace);
    tl_image_release(&image);
    soup_release(&soup);
}

/* Wrapping and the map's own turn: a quarter counter-clockwise takes u to -v (KHR_texture_transform). */
static void cutouts_wrap_and_turn(void **state)
{
    (void)state;
    tl_image image = tl_image_create(2, 1, 2, TL_IMAGE_F32);
    tl_image_floats(&image)[1] = 1; /* left: there; right: not */
    tl_material material = tl_material_default("holes");
    material.diffuse_map.image = &image;
    assert_false(tl_cutout_at(&material, (vec2s){{0.8f, 0}})); /* no cutoff: opaque */
    material.alpha_cutoff = 0.5f;
    for (int turn = -3; turn < 4; turn++) {
        assert_false(tl_cutout_at(&material, (vec2s){{(float)turn + 0.3f, 0.2f}}));
        assert_true(tl_cutout_at(&material, (vec2s){{(float)turn + 0.7f, -0.6f}}));
    }
    assert_false(tl_cutout_at(&material, (vec2s){{NAN, INFINITY}}));
    material.diffuse_map.clamp_u = true;
    assert_false(tl_cutout_at(&material, (vec2s){{-7.3f, 0}}));
    assert_true(tl_cutout_at(&material, (vec2s){{9.1f, 0}}));
    material.diffuse_map.clamp_u = false;
    material.diffuse_map.transform.rotation = (float)M_PI / 2; /* u' = v */
    assert_false(tl_cutout_at(&material, (vec2s){{0.7f, 0.3f}}));
    assert_true(tl_cutout_at(&material, (vec2s){{0.3f, 0.7f}}));
    tl_image_release(&image);
}

/* Points, lines and empty surfaces are not hit; invalid rays hit nothing. */
static void degenerate_input_is_harmless(void **state)
{
    (void)state;
    struct soup soup;
    soup_create(&soup, 20, 10);
    for (size_t t = 0; t < 20; t++) {
        soup.positions[3 * t + 1] = soup.positions[3 * t];
        if (t % 2)
            soup.positions[3 * t + 2] = soup.positions[3 * t];
    }
    tl_trace *trace = open_trace();
    update(trace, &soup.surface, 1);
    uint64_t seed = 11;
    for (int i = 0; i < 200; i++)
        assert_false(tl_trace_occluded(trace, soup_point(&seed, 2), soup_direction(&seed), 0, INFINITY));
    vec3s bad = {{NAN, 0, 0}}, good = {{0, 0, 1}}, zero = {{0, 0, 0}}, far = {{INFINITY, 0, 0}};
    assert_false(tl_trace_occluded(trace, bad, good, 0, 1));
    assert_false(tl_trace_occluded(trace, good, bad, 0, 1));
    assert_false(tl_trace_occluded(trace, good, zero, 0, 1));
    assert_int_equal(tl_trace_nearest(trace, far, good, 0, 1).surface, TL_TRACE_NONE);
    struct tl_ray_packet bundle = {
        .count = 2, .origin_x = {NAN, 0}, .direction_z = {1, NAN}, .to_m = INFINITY, .coherent = true};
    assert_int_equal(tl_trace_occluded_packet(trace, &bundle), 0);
    tl_trace_destroy(&trace);
    soup_release(&soup);
}

/* A triangle inscribed in the unit sphere. Its middle m lies 1 - m.c_i below corner i's tangent plane, 1 -
 * m^2 on average, which is twice the sag 1 - |m| to first order: so the moved point is that much further out.
 * (The next order is below a fifth of it here.) Seen from inside, as a bowl, it stays; and at a corner. */
static void smooth_points_lie_on_the_smooth_side(void **state)
{
    (void)state;
    vec3s corners[3], inward[3];
    uint64_t seed = 12;
    vec3s near = {{0.3f, 0.8f, 0.52f}};
    for (int i = 0; i < 3; i++) {
        corners[i] = glms_vec3_normalize(glms_vec3_add(near, soup_point(&seed, 0.3f)));
        inward[i] = glms_vec3_negate(corners[i]);
    }
    const float thirds[3] = {1 / 3.0f, 1 / 3.0f, 1 / 3.0f}, first[3] = {1, 0, 0};
    vec3s middle =
        glms_vec3_scale(glms_vec3_add(glms_vec3_add(corners[0], corners[1]), corners[2]), 1 / 3.0f);
    vec3s out = tl_smooth_point(middle, corners, corners, thirds);
    double sag = 1 - (double)glms_vec3_norm(middle);
    assert_true(sag > 0.005);
    assert_near((double)glms_vec3_norm(out) - 1 + sag, 2 * sag, 0.4 * sag);
    assert_true(glms_vec3_eqv_eps(tl_smooth_point(middle, corners, inward, thirds), middle));
    assert_true(glms_vec3_eqv_eps(tl_smooth_point(corners[0], corners, corners, first), corners[0]));
}

/* Open sheets across a ray: each multiplies the transmittance by its openness, a hole of an alpha map by 1, a
 * closed surface by 0. The other queries treat open sheets as closed. */
static void open_sheets_let_light_through(void **state)
{
    (void)state;
    static const vec3s corners[3] = {{{-1, -1, 0}}, {{3, -1, 0}}, {{-1, 3, 0}}};
    static const uint32_t indices[3] = {0, 1, 2};
    const struct tl_mesh_part part = {.index_count = 3};
    const float openness[3] = {0.5f, 0.25f, 0};
    vec3s positions[3][3];
    tl_material materials[3];
    tl_surface surfaces[3];
    for (int s = 0; s < 3; s++) {
        materials[s] = tl_material_default("sheet");
        materials[s].openness = openness[s];
        for (int i = 0; i < 3; i++)
            positions[s][i] = (vec3s){{corners[i].x, corners[i].y, (float)s}};
        surfaces[s] = (tl_surface){.vertex_count = 3,
                                   .positions = positions[s],
                                   .index_count = 3,
                                   .indices = indices,
                                   .part_count = 1,
                                   .parts = &part,
                                   .materials = &materials[s]};
    }
    tl_trace *trace = open_trace();
    update(trace, surfaces, 3);
    /* Ray i starts before sheet i and goes on; the last two go the other way, from behind two sheets and from
     * none. */
    struct tl_ray_packet bundle = {.count = 5, .to_m = INFINITY};
    const float from[5] = {-0.5f, 0.5f, 1.5f, 1.5f, -0.5f}, ahead[5] = {1, 1, 1, -1, -1};
    const float expected[5] = {0, 0, 0, 0.125f, 1};
    for (int i = 0; i < 5; i++) {
        bundle.origin_z[i] = from[i];
        bundle.direction_z[i] = ahead[i];
    }
    float seen[16];
    tl_trace_transmittance_packet(trace, &bundle, seen);
    for (int i = 0; i < 5; i++)
        assert_near(seen[i], expected[i], 0);
    assert_int_equal(tl_trace_occluded_packet(trace, &bundle), 0xf);
    assert_int_equal(tl_trace_nearest(trace, (vec3s){{0, 0, -0.5f}}, (vec3s){{0, 0, 1}}, 0, INFINITY).surface,
                     0);
    update(trace, surfaces, 2);
    bundle.count = 2;
    tl_trace_transmittance_packet(trace, &bundle, seen);
    assert_near(seen[0], 0.125, 0);
    assert_near(seen[1], 0.25, 0);
    tl_trace_destroy(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_hits_are_those_of_brute_force),
        cmocka_unit_test(updates_follow_motion_and_change),
        cmocka_unit_test(packets_match_single_rays),
        cmocka_unit_test(alpha_cuts_holes),
        cmocka_unit_test(cutouts_wrap_and_turn),
        cmocka_unit_test(open_sheets_let_light_through),
        cmocka_unit_test(degenerate_input_is_harmless),
        cmocka_unit_test(smooth_points_lie_on_the_smooth_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
