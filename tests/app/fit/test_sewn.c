/* Openings of garments whose seams are not closed yet, and pins by their names. */
#include "app/fit/sewn.h"
#include "app/scene/session.h"
#include "app/settings/settings.h"
#include "assets/garment.h"
#include "assets/model.h"
#include "assets/pattern/pattern_worn.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static tl_garment cut(const char *name)
{
    tl_garment garment;
    tl_error error = {0};
    assert_ok(tl_garment_cut(name, 0.05f, &garment, &error), error);
    return garment;
}

/* Render vertices of an opening, on all panels that meet there, found by brute force. */
static size_t count_vertices(const tl_garment *garment, const struct tl_opening *opening,
                             const uint32_t *weld)
{
    size_t count = 0;
    for (size_t i = 0; i < garment->model.mesh.vertex_count; i++)
        for (size_t k = 0; k < opening->side_count; k++)
            if (weld[i] == opening->vertices[k]) {
                count++;
                break;
            }
    return count;
}

static void pins_by_name(void **state)
{
    (void)state;
    tl_garment garment = cut("dress");
    tl_error error = {0};
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, garment.model.mesh.vertex_count);
    struct tl_openings openings = tl_sewn_openings(&garment, garment.model.mesh.positions, weld);
    assert_int_equal(openings.count, 4);
    const struct tl_opening *hem = tl_openings_named(&openings, "hem");
    const struct tl_opening *armhole = tl_openings_named(&openings, "left armhole");
    assert_non_null(armhole);
    size_t own = garment.pin_count, of_hem = count_vertices(&garment, hem, weld);
    assert_true(hem && of_hem > hem->side_count); /* the sides' seams have a vertex on each panel */

    assert_ok(tl_sewn_pin("", &garment, &error), error);
    assert_int_equal(garment.pin_count, own);
    assert_ok(tl_sewn_pin("hem, left armhole", &garment, &error), error);
    assert_int_equal(garment.pin_count, own + of_hem + count_vertices(&garment, armhole, weld));
    for (size_t i = own; i < garment.pin_count; i++) {
        vec3s at = garment.model.mesh.positions[garment.pins[i]];
        assert_true(i < own + of_hem ? at.y < 0.7f : at.y > 1.1f && at.x > 0);
    }
    assert_false(tl_sewn_pin("hem,cuff", &garment, &error));
    assert_int_equal(error.code, TL_USAGE);
    assert_non_null(strstr(error.message, "\"cuff\": it has neck, left armhole, right armhole, hem"));
    tl_openings_release(&openings);
    free(weld);
    tl_garment_release(&garment);
}

static void check_pattern(const char *file, const char *const *names, size_t count)
{
    tl_garment garment;
    tl_error error = {0};
    assert_ok(
        tl_pattern_worn(test_data(file), &(struct tl_pattern_wearer){"none", NULL}, 0.04f, &garment, &error),
        error);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, garment.model.mesh.vertex_count);
    struct tl_openings openings = tl_sewn_openings(&garment, garment.model.mesh.positions, weld);
    for (size_t i = 0; i < openings.count; i++)
        printf("%s: %s\n", file, openings.items[i].name);
    assert_int_equal(openings.count, count);
    for (size_t i = 0; i < count; i++)
        assert_string_equal(openings.items[i].name, names[i]);
    tl_openings_release(&openings);
    free(weld);
    tl_garment_release(&garment);
}

/* Panels that hang around nobody, apart: their stitches tell what will be open. */
static void patterns_have_openings(void **state)
{
    (void)state;
    static const char *const shirt[] = {"neck", "left cuff", "right cuff", "hem"};
    static const char *const dress[] = {"neck", "left armhole", "right armhole", "hem"};
    check_pattern("patterns/shirt_mean_specification.json", shirt, TL_COUNT(shirt));
    check_pattern("patterns/dress_pencil_specification.json", dress, TL_COUNT(dress));
}

/* A skirt on nobody, held by its hem: the hem stays, the rest hangs over it. */
static void pinned_openings_are_held(void **state)
{
    (void)state;
    static const char *const assignments[] = {
        "scene.garment=dress", "scene.avatar=none", "image.ground=false",    "cloth.edge_m=0.08",
        "cloth.settle_s=0.3",  "cloth.substeps=8",  "cloth.pin_openings=hem"};
    const struct tl_settings_source source = {NULL, assignments, TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    const tl_garment *garment = tl_session_cut(session);
    tl_frame frame = tl_session_frame(session);
    const tl_surface *shown = &frame.surfaces[frame.surface_count - 1];
    size_t held = 0;
    float farthest = 0;
    for (size_t i = 0; i < shown->vertex_count; i++) {
        float way = glms_vec3_distance(shown->positions[i], garment->model.mesh.positions[i]);
        bool is_pinned = false;
        for (size_t k = 0; k < garment->pin_count; k++)
            is_pinned = is_pinned || garment->pins[k] == i;
        held += is_pinned;
        farthest = fmaxf(farthest, way);
        if (is_pinned)
            assert_true(way < 0.01f); /* where a seam closed, its two sides met halfway */
    }
    assert_true(held > 20);
    assert_true(farthest > 0.05f);
    settings.cloth.pin_openings = "xem";
    assert_false(tl_session_apply(session, &settings, &error));
    assert_int_equal(error.code, TL_USAGE);
    tl_session_destroy(&session);
}

/* A cone's side between two rings, 0.2 m around the top and 0.6 m around the bottom of 0.5 m: a skirt. With
 * lids it is a body. */
static const char *write_cone(const char *name, bool has_lids)
{
    enum { STEPS = 16 };
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", TOILE_SCRATCH_DIR, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int ring = 0; ring < 2; ring++)
        for (int i = 0; i < STEPS; i++) {
            double turn = 2 * M_PI * i / STEPS, radius = ring == 0 ? 0.3 : 0.1;
            fprintf(file, "v %.6f %.6f %.6f\n", radius * cos(turn), 0.5 * ring, -radius * sin(turn));
        }
    for (int i = 0; i < STEPS; i++) {
        int next = (i + 1) % STEPS;
        fprintf(file, "f %d %d %d %d\n", i + 1, next + 1, STEPS + next + 1, STEPS + i + 1);
    }
    if (has_lids) {
        fprintf(file, "f");
        for (int i = 0; i < STEPS; i++)
            fprintf(file, " %d", STEPS + i + 1);
        fprintf(file, "\nf");
        for (int i = STEPS; i > 0; i--)
            fprintf(file, " %d", i);
        fprintf(file, "\n");
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

/* A file alone is a garment where it has a neck or a waist, and else a model that is shown: the session that
 * loads it decides. */
static void a_file_alone_is_worn(void **state)
{
    (void)state;
    for (int lids = 0; lids < 2; lids++) {
        tl_error error = {0};
        struct tl_settings settings;
        const char *path = write_cone(lids ? "closed_cone.obj" : "cone.obj", lids);
        assert_ok(tl_settings_load(&settings, &(struct tl_settings_source){.scene_file = path}, &error),
                  error);
        tl_session *session = tl_session_create(&settings, &error);
        assert_ok(session != NULL, error);
        const struct tl_scene_params *scene = &tl_session_settings(session)->scene;
        assert_string_equal(scene->garment, lids ? "none" : path);
        assert_string_equal(tl_settings_avatar(scene), lids ? path : "none");
        assert_string_equal(scene->fabric, "none");
        assert_true((tl_session_garment(session) != NULL) == !lids);
        tl_session_destroy(&session);
    }
}

/* A body that a clip moves is none, whatever holes it has; nor is furniture, nor what is made of plates. */
static void figures_are_not_worn(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        bool is_worn;
    } cases[] = {
        {"garments/diffcloth_skirt3448.obj", true},
        {"garments/diffcloth_tshirt1000-tri.obj", true},
        {"garments/mh_male_casualsuit06.glb", true},
        {"garments/mh_female_sportsuit01.glb", true},
        {"garments/diffcloth_dress-v5k-f10k.obj", true},
        {"garments/bjs_clothFolds.glb", true},
        {"sequences/tshirt_iter0/120.obj", true}, /* crumpled: none of its openings has a name */
        {"sequences/tshirt_iter0/250.obj", true},
        {"avatars/mannequiny.glb", false},
        {"avatars/quaternius_men_Casual.glb", false},
        {"avatars/mh_female_body.glb", false},
        {"avatars/mean_all.stl", false},
        {"models/GlamVelvetSofa.glb", false},
        {"models/VertexColorTest.glb", false},
        {"models/OrientationTest.glb", false},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_error error = {0};
        tl_model model;
        assert_ok(tl_model_load(test_data(cases[i].file), &model, &error), error);
        if (tl_sewn_is_worn(&model) != cases[i].is_worn)
            fail_msg("%s: taken for %s", cases[i].file, cases[i].is_worn ? "a model" : "a garment");
        tl_model_release(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pins_by_name), cmocka_unit_test(a_file_alone_is_worn),
                                       cmocka_unit_test(figures_are_not_worn),
                                       cmocka_unit_test(patterns_have_openings),
                                       cmocka_unit_test(pinned_openings_are_held)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
