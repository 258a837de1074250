/* A session takes over changed settings, keeps its state when it cannot, and replays to the bit. */
#include "tests/app/quick_session.h"

#include "app/scene/camera.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>

/* Touches everything that a frame lends, so that a sanitizer sees what is no longer there. */
static double sum_of_frame(tl_session *session)
{
    tl_frame frame = tl_session_frame(session);
    double sum = tl_image_floats(&frame.environment->image)[0];
    for (size_t s = 0; s < frame.surface_count; s++) {
        const tl_surface *surface = &frame.surfaces[s];
        for (size_t i = 0; i < surface->vertex_count; i++)
            sum +=
                surface->positions[i].y + surface->normals[i].x + surface->tangents[i].w + surface->uvs[i].x;
        for (size_t p = 0; p < surface->part_count; p++) {
            const tl_material *material = &surface->materials[surface->parts[p].material];
            sum +=
                material->glossiness + (material->weave ? tl_image_floats(&material->weave->height)[0] : 0);
        }
    }
    return sum;
}

static void new_scenes_and_fabrics_are_taken_over(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    struct tl_settings settings = *tl_session_settings(session);
    tl_error error = {0};
    uint64_t revision = tl_session_frame(session).surfaces[0].topology_revision;
    assert_true(isfinite(sum_of_frame(session)));

    settings.scene.garment = "skirt";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_true(isfinite(sum_of_frame(session)));
    assert_true(tl_session_frame(session).surfaces[0].topology_revision > revision);
    assert_ok(tl_session_advance(session, &error), error);

    assert_ok(tl_settings_apply_fabric(&settings, "denim", &error), error);
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_near(tl_session_frame(session).surfaces[1].materials[0].glossiness, settings.material.glossiness,
                0);
    assert_true(isfinite(sum_of_frame(session)));

    settings.scene.garment = "none";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_int_equal(tl_session_frame(session).surface_count, 1);
    assert_null(tl_session_cloth(session));
    assert_true(isfinite(sum_of_frame(session)));
    tl_session_destroy(&session);
}

/* Another colourway is other materials on the same cloth. */
static void colourways_change_looks_only(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    tl_error error = {0};
    assert_ok(tl_session_go_to(session, 2, &error), error);
    struct tl_settings settings = *tl_session_settings(session);
    const char *const *names;
    size_t count = tl_session_colourways(session, &names);
    assert_true(count >= 2);
    tl_surface dress = tl_session_frame(session).surfaces[1];
    size_t bytes = dress.vertex_count * sizeof *dress.positions;
    vec3s *before = malloc(bytes);
    memcpy(before, dress.positions, bytes);
    const tl_cloth *cloth = tl_session_cloth(session);
    float blue = dress.materials[0].diffuse.z;
    const struct tl_material_params *satin = &settings.material;
    const vec3s colour = tl_material_colour(&dress.materials[0]);
    assert_true(dress.materials[0].thread_count > 0);
    for (int c = 0; c < 3; c++) { /* what has been inside of threads is gloss of its own */
        assert_near(dress.materials[0].diffuse.raw[c], (1 - satin->thread) * satin->diffuse[c], 1e-6);
        assert_near(dress.materials[0].specular.raw[c], satin->specular[c], 1e-6);
        assert_near(colour.raw[c], satin->diffuse[c], 1e-5);
    }

    assert_ok(tl_settings_apply_colourway(&settings, names[0], &error), error);
    assert_ok(tl_session_apply(session, &settings, &error), error);
    tl_surface changed = tl_session_frame(session).surfaces[1];
    assert_ptr_equal(tl_session_cloth(session), cloth);
    assert_int_equal(tl_session_frame_number(session), 2);
    assert_memory_equal(changed.positions, before, bytes);
    assert_true(changed.motion_revision == dress.motion_revision);
    assert_true(changed.topology_revision > dress.topology_revision);
    assert_true(changed.materials[0].diffuse.z != blue);
    assert_true(isfinite(sum_of_frame(session)));

    /* The cloth goes on as it would have gone. */
    assert_ok(tl_session_advance(session, &error), error);
    memcpy(before, tl_session_frame(session).surfaces[1].positions, bytes);
    assert_ok(tl_settings_apply_colourway(&settings, "", &error), error);
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_true(tl_session_frame(session).surfaces[1].materials[0].diffuse.z == blue);
    assert_ok(tl_session_go_to(session, 0, &error), error);
    assert_ok(tl_session_go_to(session, 3, &error), error);
    assert_memory_equal(tl_session_frame(session).surfaces[1].positions, before, bytes);

    double sum = sum_of_frame(session);
    assert_ok(tl_settings_apply_colourway(&settings, "Inc", &error), error); /* may be a file's */
    assert_false(tl_session_apply(session, &settings, &error));
    assert_non_null(strstr(error.message, "did you mean Ink?"));
    assert_true(sum_of_frame(session) == sum);
    assert_string_equal(tl_session_settings(session)->scene.colourway, "");
    free(before);
    tl_session_destroy(&session);
}

static uint64_t look_of(tl_session *session, const struct tl_settings *settings)
{
    tl_error error = {0};
    assert_ok(tl_session_apply(session, settings, &error), error);
    return tl_session_frame(session).surfaces[1].topology_revision;
}

/* A look that was made beside the session is the one that it would have made, and three go round without
 * being made again; a fourth takes the place of the one that was seen longest ago. */
static void looks_are_made_beside_the_session(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    struct tl_settings looks[4];
    for (int i = 0; i < 4; i++) {
        looks[i] = *tl_session_settings(session);
        looks[i].material.glossiness = 0.2f * (float)i;
        assert_true(i == 0 || tl_session_needs_appearance(&looks[0], &looks[i]));
    }
    uint64_t first = look_of(session, &looks[0]), second = look_of(session, &looks[1]);

    struct tl_appearance made;
    tl_surface surfaces[2];
    tl_error error = {0};
    const struct tl_session_models models = tl_session_models(session);
    assert_ok(tl_session_make_appearance(&models, &looks[2], &made, &error), error);
    tl_frame frame = tl_session_frame_in(&models, &made, surfaces);
    assert_int_equal(frame.surface_count, 2);
    assert_true(frame.surfaces[1].materials[0].glossiness == looks[2].material.glossiness);
    assert_true(look_of(session, &looks[1]) == second); /* until it is applied nothing shows it */
    tl_session_keep_appearance(session, &looks[2], &made);
    assert_int_equal(made.image_count + made.weave_count + made.name_count, 0);
    uint64_t third = look_of(session, &looks[2]);
    assert_true(third > second);
    assert_true(tl_session_frame(session).surfaces[1].materials[0].glossiness ==
                looks[2].material.glossiness);
    assert_true(look_of(session, &looks[0]) == first);
    assert_true(look_of(session, &looks[1]) == second);
    assert_true(look_of(session, &looks[2]) == third);

    /* An appearance that the session already has is not taken again. */
    assert_ok(tl_session_make_appearance(&models, &looks[1], &made, &error), error);
    tl_session_keep_appearance(session, &looks[1], &made);
    assert_true(look_of(session, &looks[1]) == second);
    look_of(session, &looks[3]);
    assert_true(look_of(session, &looks[1]) == second);
    assert_true(look_of(session, &looks[2]) == third);
    assert_true(look_of(session, &looks[0]) > third);

    struct tl_settings taken = looks[3];
    tl_appearance_take(&looks[0], &taken);
    assert_false(tl_session_needs_appearance(&looks[0], &taken));
    tl_session_destroy(&session);
}

/* The same triangles, flat, in their own size, clear of body and garment; the cloth is not touched. */
static void the_pattern_hangs_beside_the_garment(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    tl_error error = {0};
    struct tl_settings settings = *tl_session_settings(session);
    const tl_cloth *cloth = tl_session_cloth(session);
    uint64_t before = tl_session_frame(session).surfaces[1].topology_revision;
    float near =
        glms_vec3_distance(tl_session_frame(session).camera.eye, tl_session_frame(session).camera.target);
    settings.scene.pattern = true;
    settings.scene.smooth = false; /* its mesh, to compare */
    settings.image.view = TL_VIEW_STRAIN_WEFT;
    assert_true(tl_session_has_pattern(session));
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_ptr_equal(tl_session_cloth(session), cloth);
    const tl_frame frame = tl_session_frame(session);
    assert_int_equal(frame.surface_count, 3);
    assert_true(frame.surfaces[2].topology_revision > before); /* the renderer uploads it */
    assert_true(glms_vec3_distance(frame.camera.eye, frame.camera.target) > near);
    const tl_surface *board = &frame.surfaces[1], *garment = &frame.surfaces[2];
    assert_string_equal(board->name, "pattern");
    assert_string_equal(garment->name, "garment");
    assert_ptr_equal(board->indices, garment->indices);
    assert_non_null(board->strains);
    assert_ptr_equal(board->strains, garment->strains);
    struct tl_box worn = tl_box_of(garment->positions, garment->vertex_count);
    struct tl_box body = tl_box_of(frame.surfaces[0].positions, frame.surfaces[0].vertex_count);
    struct tl_box flat = tl_box_of(board->positions, board->vertex_count);
    assert_true(flat.lower.x > fmaxf(worn.upper.x, body.upper.x));
    assert_true(flat.lower.y > 0);
    assert_near(flat.lower.z, flat.upper.z, 0);
    const vec2s *pattern = tl_session_cut(session)->pattern;
    for (size_t i = 0; i < board->index_count; i++) {
        uint32_t a = board->indices[i], b = board->indices[i - i % 3];
        assert_near(glms_vec3_distance(board->positions[a], board->positions[b]),
                    glms_vec2_distance(pattern[a], pattern[b]), 1e-5);
        assert_true(board->normals[a].z > 0.999f);
    }
    settings.scene.pattern = false;
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_int_equal(tl_session_frame(session).surface_count, 2);
    tl_session_destroy(&session);
}

static void a_failure_keeps_what_was(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    struct tl_settings settings = *tl_session_settings(session);
    double before = sum_of_frame(session);
    tl_error error = {0};
    settings.scene.environment = "nowhere.exr";
    assert_false(tl_session_apply(session, &settings, &error));
    assert_non_null(strstr(error.message, "nowhere.exr"));
    settings = *tl_session_settings(session);
    settings.scene.avatar = "nowhere.glb";
    assert_false(tl_session_apply(session, &settings, &error));
    assert_true(sum_of_frame(session) == before);
    assert_string_equal(tl_session_settings(session)->scene.avatar, "auto");
    tl_session_destroy(&session);
}

static void frames_replay_to_the_bit(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    tl_error error = {0};
    double start = sum_of_frame(session);
    assert_ok(tl_session_go_to(session, 5, &error), error);
    double fifth = sum_of_frame(session);
    assert_int_equal(tl_session_frame_number(session), 5);
    assert_ok(tl_session_go_to(session, 0, &error), error);
    assert_true(sum_of_frame(session) == start);
    assert_ok(tl_session_go_to(session, 5, &error), error);
    assert_true(sum_of_frame(session) == fifth);
    tl_session_destroy(&session);
}

static void picking_finds_the_front(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    uint32_t vertex;
    float distance;
    assert_true(tl_session_pick(session, (vec3s){{0, 1.1f, 3}}, (vec3s){{0, 0, -1}}, &vertex, &distance));
    tl_frame frame = tl_session_frame(session);
    assert_true(distance > 2.5f && distance < 3);
    assert_true(frame.surfaces[1].positions[vertex].z > 0); /* the side that faces the ray */
    assert_false(tl_session_pick(session, (vec3s){{0, 1.1f, 3}}, (vec3s){{0, 0, 1}}, &vertex, &distance));
    tl_session_destroy(&session);
}

/* The garment's, which comes last. */
static const vec3s *strains_shown(tl_session *session)
{
    tl_frame frame = tl_session_frame(session);
    return frame.surfaces[frame.surface_count - 1].strains;
}

static void strains_are_told_when_they_are_looked_at(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    struct tl_settings settings = *tl_session_settings(session);
    tl_error error = {0};
    assert_null(strains_shown(session));
    tl_session_want_strains(session, true);
    assert_non_null(strains_shown(session));
    tl_session_want_strains(session, false);
    settings.image.view = TL_VIEW_STRAIN_WARP;
    assert_ok(tl_session_apply(session, &settings, &error), error);

    /* Against the drape's own measure, of edges: across an equilateral triangle strain is up to 5/3 of the
     * largest of its edges' (of squared lengths), across a panel's less regular ones somewhat more. */
    size_t count = tl_session_frame(session).surfaces[1].vertex_count;
    double largest = 0, maximum = tl_session_report(session).max_strain;
    vec3s *first = TL_NEW_ARRAY(vec3s, count);
    memcpy(first, strains_shown(session), count * sizeof *first);
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, (double)first[i].x);
    assert_true(largest > 1e-4 && largest < 3 * maximum);

    assert_ok(tl_session_advance(session, &error), error); /* they follow the cloth */
    assert_true(memcmp(first, strains_shown(session), count * sizeof *first) != 0);
    settings.scene.garment = "skirt";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_non_null(strains_shown(session));
    settings.image.view = TL_VIEW_NORMAL;
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_null(strains_shown(session));
    free(first);
    tl_session_destroy(&session);
}

/* Lowest and highest place of a surface in the picture, in half heights of it from the middle. */
static void only_balance_is_called_rest(void **state)
{
    (void)state;
    char words[96];
    tl_error error = {0};
    tl_session *session = quick_session(NULL); /* 0.3 s are too short */
    tl_session_describe_state(session, words, sizeof words);
    print_message("settled for 0.3 s: %s\n", words);
    assert_non_null(strstr(words, "not at rest, out of balance by "));
    for (int frame = 0; frame < 600 && !(frame > 0 && tl_cloth_is_still(tl_session_cloth(session))); frame++)
        assert_ok(tl_session_advance(session, &error), error);
    tl_session_describe_state(session, words, sizeof words);
    print_message("after frame %d: %s\n", tl_session_frame_number(session), words);
    assert_int_equal(tl_session_garment_state(session), TL_GARMENT_STILL);
    tl_session_destroy(&session);

    struct tl_settings settings = quick_settings(NULL);
    settings.scene.garment = "sheet";
    settings.scene.avatar = "ball";
    settings.cloth.settle_s = 10;
    settings.cloth.substeps = 0;
    session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    tl_session_describe_state(session, words, sizeof words);
    print_message("settled: %s\n", words);
    assert_int_equal(strncmp(words, "at rest, out of balance by 0.0", 30), 0);
    tl_session_destroy(&session);
}

static void find_extent(const tl_surface *surface, const struct tl_camera *camera, float *lowest,
                        float *highest)
{
    mat4s view = glms_lookat(camera->eye, camera->target, camera->up);
    *lowest = INFINITY, *highest = -INFINITY;
    for (size_t i = 0; i < surface->vertex_count; i++) {
        vec3s at = glms_mat4_mulv3(view, surface->positions[i], 1);
        float place = at.y / (-at.z * tanf(0.5f * camera->fov_y));
        *lowest = fminf(*lowest, place);
        *highest = fmaxf(*highest, place);
    }
}

/* As its vertices are projected, from whichever side it is seen first: 75 % of the height, or 1.5 % more
 * where a point lies between the directions in which the furthest ones are kept; all of it is in the picture.
 * A head above is in the picture as well, for which a shirt is less high; a body that is far
 * higher than its skirt or trousers is cut. */
static void the_garment_fills_three_quarters(void **state)
{
    (void)state;
    static const char *const garments[] = {"dress", "skirt", "layers", "trousers", "shirt"};
    for (size_t g = 0; g < TL_COUNT(garments); g++) {
        struct tl_settings settings = quick_settings(NULL);
        tl_error error = {0};
        settings.scene.garment = garments[g];
        tl_session *session = tl_session_create(&settings, &error);
        assert_ok(session != NULL, error);
        for (int yaw = 25; yaw < 360; yaw += 90) {
            float lowest, highest, feet, head;
            settings.camera.yaw_deg = (float)yaw;
            assert_ok(tl_session_apply(session, &settings, &error), error);
            tl_frame frame = tl_session_frame(session);
            find_extent(&frame.surfaces[frame.surface_count - 1], &frame.camera, &lowest, &highest);
            find_extent(&frame.surfaces[0], &frame.camera, &feet, &head);
            print_message("%s from %d degrees: %.3f of the height, from %.3f to %.3f, body to %.3f\n",
                          garments[g], yaw, (double)(0.5f * (highest - lowest)), (double)lowest,
                          (double)highest, (double)head);
            bool is_shirt = strcmp(garments[g], "shirt") == 0, has_head = is_shirt || g == 0 || g == 2;
            float minimum = is_shirt ? 0.72f : TL_CAMERA_GARMENT - 0.015f;
            assert_true(0.5f * (highest - lowest) > minimum);
            assert_true(0.5f * (highest - lowest) < TL_CAMERA_GARMENT + 0.015f);
            assert_true(lowest > -0.96f && highest < 0.9f);
            assert_true(has_head == (head < 0.955f));
        }
        tl_session_destroy(&session);
    }
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_scenes_and_fabrics_are_taken_over),
        cmocka_unit_test(colourways_change_looks_only),
        cmocka_unit_test(looks_are_made_beside_the_session),
        cmocka_unit_test(a_failure_keeps_what_was),
        cmocka_unit_test(frames_replay_to_the_bit),
        cmocka_unit_test(picking_finds_the_front),
        cmocka_unit_test(the_pattern_hangs_beside_the_garment),
        cmocka_unit_test(strains_are_told_when_they_are_looked_at),
        cmocka_unit_test(only_balance_is_called_rest),
        cmocka_unit_test(the_garment_fills_three_quarters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
