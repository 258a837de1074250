/* Garments drawn smoothly beside the same garments as they are simulated: closed seams, the same pattern,
 * nowhere far from the cloth, no deeper in the body, and through itself nowhere. */
#include "app/scene/session.h"
#include "app/settings/settings.h"
#include "cloth/contact/collider.h"
#include "cloth/self_contact/crossings.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static tl_surface garment_of(tl_session *session)
{
    tl_frame frame = tl_session_frame(session);
    return frame.surfaces[frame.surface_count - 1];
}

/* How many of the corners and middles of the sides of the surface's triangles lie in the body, and how deep.
 */
static size_t count_inside(const tl_surface *surface, const tl_collider *body, double *deepest)
{
    size_t count = 0;
    *deepest = 0;
    for (size_t i = 0; i < surface->index_count; i++) {
        size_t next = i - i % 3 + (i + 1) % 3;
        vec3s a = surface->positions[surface->indices[i]], b = surface->positions[surface->indices[next]];
        for (int k = 0; k < 2; k++) {
            vec3s at = glms_vec3_lerp(a, b, 0.5f * (float)k);
            const double point[3] = {(double)at.x, (double)at.y, (double)at.z};
            struct tl_contact contact;
            if (!tl_collider_query(body, point, 0.05, &contact) || contact.distance_m >= 0)
                continue;
            count++;
            *deepest = fmax(*deepest, -contact.distance_m);
        }
    }
    return count;
}

/* Open sides: those whose ends' positions no other triangle's side has in the other direction. Bitwise. */
struct side {
    vec3s from, to;
};

static int compare_sides(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct side));
}

static size_t count_open(const tl_surface *surface)
{
    struct side *sides = TL_NEW_ARRAY(struct side, surface->index_count);
    size_t open = 0;
    for (size_t i = 0; i < surface->index_count; i++) {
        size_t next = i - i % 3 + (i + 1) % 3;
        sides[i] = (struct side){surface->positions[surface->indices[i]],
                                 surface->positions[surface->indices[next]]};
    }
    qsort(sides, surface->index_count, sizeof *sides, compare_sides);
    for (size_t i = 0; i < surface->index_count; i++) {
        struct side turned = {sides[i].to, sides[i].from};
        open += !bsearch(&turned, sides, surface->index_count, sizeof *sides, compare_sides);
    }
    free(sides);
    return open;
}

/* Twice the area of the triangles of the parts in the UV plane. */
static double uv_area(const tl_surface *surface)
{
    double sum = 0;
    for (size_t p = 0; p < surface->part_count; p++)
        for (uint32_t i = 0; i < surface->parts[p].index_count; i += 3) {
            const uint32_t *at = &surface->indices[surface->parts[p].first_index + i];
            vec2s a = glms_vec2_sub(surface->uvs[at[1]], surface->uvs[at[0]]),
                  b = glms_vec2_sub(surface->uvs[at[2]], surface->uvs[at[0]]);
            sum += fabs((double)a.x * (double)b.y - (double)a.y * (double)b.x);
        }
    return sum;
}

static size_t count_crossing(const tl_surface *surface)
{
    tl_mesh mesh = {.vertex_count = surface->vertex_count, .index_count = surface->index_count};
    struct tl_near_pairs pairs = {0};
    mesh.indices = TL_NEW_ARRAY(uint32_t, surface->index_count);
    memcpy(mesh.indices, surface->indices, surface->index_count * sizeof *mesh.indices);
    tl_crossings_of_mesh(&mesh, surface->positions, &pairs);
    size_t count = pairs.count;
    tl_near_pairs_release(&pairs);
    free(mesh.indices);
    return count;
}

static tl_session *open_session(struct tl_settings *settings, const char *const *assignments, size_t count)
{
    tl_error error = {0};
    assert_ok(tl_settings_load(settings, &(struct tl_settings_source){NULL, assignments, count}, &error),
              error);
    tl_session *session = tl_session_create(settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

static void a_dress_is_drawn_smoothly(void **state)
{
    (void)state;
    const char *const assignments[] = {"cloth.edge_m=0.03", "cloth.settle_s=3", "scene.environment=white",
                                       "scene.smooth=false"};
    tl_error error = {0};
    struct tl_settings *settings = TL_NEW(struct tl_settings);
    tl_session *session = open_session(settings, assignments, TL_COUNT(assignments));
    tl_collider *body = tl_collider_create(&tl_session_models(session).avatar->mesh, false, &error);
    assert_ok(body != NULL, error);

    tl_surface plain = garment_of(session);
    double deep, smooth_deep;
    size_t inside = count_inside(&plain, body, &deep), open = count_open(&plain);
    vec3s *positions = TL_NEW_ARRAY(vec3s, plain.vertex_count);
    memcpy(positions, plain.positions, plain.vertex_count * sizeof *positions);
    assert_true(open > 0); /* neck, armholes, hem */

    settings->scene.smooth = true;
    assert_ok(tl_session_apply(session, settings, &error), error);
    tl_surface smooth = garment_of(session);
    size_t smooth_inside = count_inside(&smooth, body, &smooth_deep);
    print_message("%zu triangles, %zu points in the body, %.2f mm deep; smooth %zu, %zu, %.2f mm\n",
                  plain.index_count / 3, inside, 1e3 * deep, smooth.index_count / 3, smooth_inside,
                  1e3 * smooth_deep);
    assert_int_equal(smooth.index_count, 4 * plain.index_count);
    assert_true(smooth.topology_revision != plain.topology_revision);
    assert_int_equal(count_open(&smooth), 2 * open);
    assert_true(fabs(uv_area(&smooth) / uv_area(&plain) - 1) < 1e-5);
    assert_true(smooth_inside <= inside && smooth_deep <= deep);
    float farthest = 0, longest = 0;
    for (size_t i = 0; i < plain.index_count; i++)
        longest = fmaxf(longest, glms_vec3_distance(positions[plain.indices[i]],
                                                    positions[plain.indices[i - i % 3 + (i + 1) % 3]]));
    for (size_t i = 0; i < plain.vertex_count; i++) /* they keep their numbers */
        farthest = fmaxf(farthest, glms_vec3_distance(smooth.positions[i], positions[i]));
    print_message("moved %.2f mm at most, of edges of %.2f mm\n", 1e3 * (double)farthest,
                  1e3 * (double)longest);
    /* The neighbours of a vertex have at most 0.6 of the weight in its limit position (those of one with
     * three). */
    assert_true(farthest > 1e-4f && farthest < 0.6f * longest);

    /* It follows the cloth. */
    uint64_t revision = smooth.motion_revision;
    assert_ok(tl_session_advance(session, &error), error);
    smooth = garment_of(session);
    assert_true(smooth.motion_revision != revision);
    assert_int_equal(count_open(&smooth), 2 * open);
    settings->scene.smooth = false;
    assert_ok(tl_session_apply(session, settings, &error), error);
    assert_int_equal(garment_of(session).index_count, plain.index_count);
    free(positions);
    tl_collider_destroy(&body);
    tl_session_destroy(&session);
    free(settings);
}

/* The shoulders of the form are rounder than the shirt's triangles: points of Loop's surface are inside of
 * them.
 */
static void a_shirt_stays_off_the_form(void **state)
{
    (void)state;
    const char *const assignments[] = {"scene.garment=shirt", "scene.environment=white", "cloth.edge_m=0.03",
                                       "cloth.settle_s=2"};
    tl_error error = {0};
    struct tl_settings *settings = TL_NEW(struct tl_settings);
    tl_session *session = open_session(settings, assignments, TL_COUNT(assignments));
    tl_collider *body = tl_collider_create(&tl_session_models(session).avatar->mesh, false, &error);
    assert_ok(body != NULL, error);
    for (int frame = 0; frame < 3; frame++) {
        tl_surface shirt = garment_of(session);
        double deepest;
        assert_int_equal(count_inside(&shirt, body, &deepest), 0);
        assert_int_equal(count_crossing(&shirt), 0);
        assert_ok(tl_session_advance(session, &error), error);
    }
    tl_collider_destroy(&body);
    tl_session_destroy(&session);
    free(settings);
}

/* A skirt between the hands and the thighs of a man who walks is folded upon itself: of Loop's surface up to
 * 87 pairs of triangles cross. */
static void folds_do_not_cross(void **state)
{
    (void)state;
    char avatar[TL_STRING_SIZE];
    snprintf(avatar, sizeof avatar, "scene.avatar=%s", test_data("avatars/CesiumMan.glb"));
    const char *const assignments[] = {"scene.garment=skirt", "scene.environment=white", avatar,
                                       "cloth.edge_m=0.03", "cloth.settle_s=2"};
    tl_error error = {0};
    struct tl_settings *settings = TL_NEW(struct tl_settings);
    tl_session *session = open_session(settings, assignments, TL_COUNT(assignments));
    for (int frame = 0; frame < 8; frame++) {
        tl_surface skirt = garment_of(session);
        assert_int_equal(count_crossing(&skirt), 0);
        assert_ok(tl_session_advance(session, &error), error);
    }
    tl_session_destroy(&session);
    free(settings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_dress_is_drawn_smoothly),
                                       cmocka_unit_test(a_shirt_stays_off_the_form),
                                       cmocka_unit_test(folds_do_not_cross)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
