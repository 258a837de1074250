/* A simulation is written as OBJ and point caches and played back: the same surface comes out. */
#include "tests/assets/small_glb.h"
#include "tests/testing.h"

#include "app/scene/session.h"
#include "assets/model.h"
#include "assets/model_export.h"
#include "assets/motion/point_cache.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>
#include <sys/stat.h>

enum { FRAMES = 5 };

static tl_session *create(const char *const *extra, size_t extra_count)
{
    const char *assignments[16] = {"scene.garment=skirt", "cloth.edge_m=0.08", "cloth.settle_s=0.3",
                                   "cloth.substeps=8", "scene.smooth=false"};
    for (size_t i = 0; i < extra_count; i++)
        assignments[5 + i] = extra[i];
    const struct tl_settings_source source = {.assignments = assignments,
                                              .assignment_count = 5 + extra_count};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

static const tl_surface *garment_of(tl_session *session)
{
    tl_frame frame = tl_session_frame(session);
    assert_string_equal(frame.surfaces[frame.surface_count - 1].name, "garment");
    // cppcheck-suppress returnDanglingLifetime ; a false finding: the session owns them
    return &frame.surfaces[frame.surface_count - 1];
}

struct take { /* of one frame, as simulated */
    vec3s *positions, *normals;
    vec4s *tangents;
};
static struct take takes[FRAMES];
static size_t vertex_count;

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = tl_alloc(count, size);
    memcpy(copy, from, count * size);
    return copy;
}

static int simulate_and_write(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_session *session = create(NULL, 0);
    const tl_model *model = tl_session_garment(session);
    vertex_count = model->mesh.vertex_count;
    mkdir(SCRATCH, 0777);
    tl_point_cache_writer *writers[] = {
        tl_point_cache_create(SCRATCH "/skirt.pc2", vertex_count, FRAMES, 0, 30, &error),
        tl_point_cache_create(SCRATCH "/skirt.mdd", vertex_count, FRAMES, 0, 30, &error)};
    vec3s *points = TL_NEW_ARRAY(vec3s, vertex_count);
    for (int i = 0; i < FRAMES; i++) {
        char path[1024];
        assert_ok(tl_session_go_to(session, i, &error), error);
        const tl_surface *garment = garment_of(session);
        takes[i] = (struct take){copy_of(garment->positions, vertex_count, sizeof(vec3s)),
                                 copy_of(garment->normals, vertex_count, sizeof(vec3s)),
                                 copy_of(garment->tangents, vertex_count, sizeof(vec4s))};
        tl_model_points(model, garment->positions, points);
        for (size_t w = 0; w < TL_COUNT(writers); w++)
            tl_point_cache_add(writers[w], points);
        snprintf(path, sizeof path, SCRATCH "/skirt.%d.obj", i);
        assert_ok(tl_model_export_obj(path, model, garment, &error), error);
    }
    for (size_t w = 0; w < TL_COUNT(writers); w++)
        assert_ok(tl_point_cache_commit(&writers[w], &error), error);
    free(points);
    tl_session_destroy(&session);
    return 0;
}

static int forget(void **state)
{
    (void)state;
    for (int i = 0; i < FRAMES; i++) {
        free(takes[i].positions);
        free(takes[i].normals);
        free(takes[i].tangents);
    }
    return 0;
}

/* Positions to the bit; normals and tangents as they follow from them: UVs went through 1 - v twice, which
 * turns a tangent by some 1e-6 times the ratio of a UV to a triangle's share of it, and smooth normals are
 * sums in another order. */
static void check_frame(tl_session *session, int number)
{
    const tl_model *model = tl_session_garment(session);
    const tl_surface *garment = garment_of(session);
    const struct take *take = &takes[number];
    for (size_t i = 0; i < garment->vertex_count; i++) {
        size_t point = model->points ? model->points[i] : i;
        assert_memory_equal(&garment->positions[i], &take->positions[point], sizeof(vec3s));
        assert_true(glms_vec3_dot(garment->normals[i], take->normals[point]) > 0.9999f);
        vec3s here = glms_vec3(garment->tangents[i]), there = glms_vec3(take->tangents[point]);
        assert_true(glms_vec3_dot(here, there) > 0.999f);
        assert_near(garment->tangents[i].w, take->tangents[point].w, 0);
        assert_near(glms_vec3_dot(here, garment->normals[i]), 0, 1e-5);
    }
}

static void play_all(const char *const *extra, size_t extra_count)
{
    tl_error error = {0};
    tl_session *session = create(extra, extra_count);
    assert_null(tl_session_cloth(session));
    for (int i = 0; i < FRAMES; i++) {
        assert_ok(tl_session_go_to(session, i, &error), error);
        check_frame(session, i);
    }
    assert_ok(tl_session_go_to(session, FRAMES + 20, &error), error);
    check_frame(session, FRAMES - 1); /* rests at its end */
    assert_ok(tl_session_go_to(session, 2, &error), error);
    check_frame(session, 2);
    assert_ok(tl_session_reset(session, &error), error);
    check_frame(session, 0);
    tl_session_destroy(&session);
}

static void what_was_simulated_is_played(void **state)
{
    (void)state;
    static const char *const garments[] = {"scene.garment=" SCRATCH "/skirt.0.obj", "scene.garment=skirt"};
    static const char *const motions[] = {"scene.motion=" SCRATCH "/skirt.pc2",
                                          "scene.motion=" SCRATCH "/skirt.mdd",
                                          "scene.motion=" SCRATCH "/skirt.#.obj"};
    for (size_t g = 0; g < TL_COUNT(garments); g++)
        for (size_t m = 0; m < TL_COUNT(motions); m++) {
            const char *const extra[] = {garments[g], motions[m]};
            play_all(extra, 2);
        }
}

/* In inches everything is 0.0254 times as large: positions are, and stay together. */
static void units_apply_to_the_motion_too(void **state)
{
    (void)state;
    static const char *const extra[] = {"scene.garment=" SCRATCH "/skirt.0.obj",
                                        "scene.motion=" SCRATCH "/skirt.pc2", "scene.units=in"};
    tl_error error = {0};
    tl_session *session = create(extra, TL_COUNT(extra));
    assert_ok(tl_session_go_to(session, 3, &error), error);
    const tl_model *model = tl_session_garment(session);
    const tl_surface *garment = garment_of(session);
    for (size_t i = 0; i < garment->vertex_count; i++)
        for (int c = 0; c < 3; c++)
            assert_near(garment->positions[i].raw[c],
                        0.0254 * (double)takes[3].positions[model->points[i]].raw[c], 1e-8);
    tl_session_destroy(&session);
}

/* At half the rate frame 3 is half way between samples 1 and 2. */
static void the_rate_can_be_told(void **state)
{
    (void)state;
    static const char *const extra[] = {"scene.motion=" SCRATCH "/skirt.pc2", "scene.motion_rate=15"};
    tl_error error = {0};
    tl_session *session = create(extra, TL_COUNT(extra));
    assert_ok(tl_session_go_to(session, 3, &error), error);
    const tl_surface *garment = garment_of(session);
    for (size_t i = 0; i < garment->vertex_count; i++) {
        vec3s middle = glms_vec3_lerp(takes[1].positions[i], takes[2].positions[i], 0.5f);
        assert_near(glms_vec3_distance(garment->positions[i], middle), 0, 1e-6);
    }
    tl_session_destroy(&session);
}

/* A glTF file moves its own vertices by its clip, and not those of another garment. */
static void a_clip_moves_the_garment(void **state)
{
    (void)state;
    const char *path = scratch("turning.glb");
    struct small_glb glb = small_glb_make();
    small_glb_write(&glb, path);
    char garment[1100], motion[1100];
    snprintf(garment, sizeof garment, "scene.garment=%s", path);
    snprintf(motion, sizeof motion, "scene.motion=%s", path);
    const char *const extra[] = {garment, motion, "scene.avatar=none"};
    tl_error error = {0};
    tl_session *session = create(extra, TL_COUNT(extra));
    assert_null(tl_session_cloth(session));
    tl_model model;
    assert_ok(tl_model_load(path, &model, &error), error);
    vec3s posed[8];
    assert_true(model.mesh.vertex_count <= TL_COUNT(posed));
    static const int frames[] = {0, 45, 59, 10}; /* the clip turns from 1 to 2 s, at 30 frames per second */
    for (size_t i = 0; i < TL_COUNT(frames); i++) {
        assert_ok(tl_session_go_to(session, frames[i], &error), error);
        tl_model_pose(&model, 0, frames[i] / 30.0, posed);
        assert_memory_equal(garment_of(session)->positions, posed, model.mesh.vertex_count * sizeof *posed);
    }
    assert_true(glms_vec3_distance(posed[2], model.mesh.positions[2]) <
                1e-6f); /* frame 10 is before the clip */
    struct tl_settings settings = *tl_session_settings(session);
    settings.scene.garment = "skirt";
    assert_false(tl_session_apply(session, &settings, &error));
    assert_non_null(strstr(error.message, "turning.glb: moves 4 points"));
    tl_model_release(&model);
    tl_session_destroy(&session);
}

static int last_frame_with(const char *motion, const char *rate)
{
    const char *const extra[] = {motion, rate};
    tl_session *session = create(extra, TL_COUNT(extra));
    int last = tl_session_last_frame(session);
    tl_session_destroy(&session);
    return last;
}

/* Five samples at 30 frames a second: the last is frame 4; at half the rate frame 8. An MDD states seconds.
 */
static void motions_have_an_end(void **state)
{
    (void)state;
    assert_int_equal(last_frame_with("scene.motion=" SCRATCH "/skirt.pc2", "scene.motion_rate=0"),
                     FRAMES - 1);
    assert_int_equal(last_frame_with("scene.motion=" SCRATCH "/skirt.pc2", "scene.motion_rate=15"),
                     2 * (FRAMES - 1));
    assert_int_equal(last_frame_with("scene.motion=" SCRATCH "/skirt.#.obj", "scene.motion_rate=0"),
                     FRAMES - 1);
    assert_int_equal(last_frame_with("scene.motion=" SCRATCH "/skirt.mdd", "cloth.frame_rate=60"),
                     2 * (FRAMES - 1));
    assert_int_equal(last_frame_with("scene.motion=" SCRATCH "/skirt.mdd", "scene.motion_rate=15"),
                     2 * (FRAMES - 1));
    assert_int_equal(last_frame_with("scene.motion=none", "scene.motion_rate=0"), 0); /* cloth has no end */
}

/* A frame that is gone to is the one that is reached step by step. */
static void an_avatar_alone_is_played_back(void **state)
{
    (void)state;
    const char *path = scratch("turning alone.glb");
    struct small_glb glb = small_glb_make();
    small_glb_write(&glb, path);
    char avatar[1100];
    snprintf(avatar, sizeof avatar, "scene.avatar=%s", path);
    const char *const extra[] = {avatar, "scene.garment=none"};
    tl_error error = {0};
    tl_session *session = create(extra, TL_COUNT(extra));
    assert_int_equal(tl_session_last_frame(session), 60); /* 2 s */
    for (int i = 0; i < 45; i++)
        assert_ok(tl_session_advance(session, &error), error);
    vec3s stepped[4];
    tl_frame frame = tl_session_frame(session);
    memcpy(stepped, frame.surfaces[0].positions, sizeof stepped);
    assert_true(glms_vec3_distance(stepped[2], (vec3s){{1, 1, 0}}) > 0.1f); /* it turns */
    static const int frames[] = {50, 10, 45};
    for (size_t i = 0; i < TL_COUNT(frames); i++)
        assert_ok(tl_session_go_to(session, frames[i], &error), error);
    frame = tl_session_frame(session);
    assert_int_equal(tl_session_frame_number(session), 45);
    assert_memory_equal(stepped, frame.surfaces[0].positions, sizeof stepped);
    tl_session_destroy(&session);
}

static void motions_come_and_go(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_session *session = create(NULL, 0);
    struct tl_settings settings = *tl_session_settings(session);
    settings.scene.motion = SCRATCH "/skirt.pc2";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    check_frame(session, 0);
    assert_null(tl_session_cloth(session));
    settings.scene.garment = "dress"; /* has other points */
    assert_false(tl_session_apply(session, &settings, &error));
    assert_non_null(strstr(error.message, "skirt.pc2"));
    check_frame(session, 0);
    settings.scene.garment = "none";
    assert_false(tl_session_apply(session, &settings, &error));
    settings.scene.garment = "skirt";
    settings.scene.motion = "none";
    assert_ok(tl_session_apply(session, &settings, &error), error);
    assert_non_null(tl_session_cloth(session));
    assert_ok(tl_session_advance(session, &error), error);
    tl_session_destroy(&session);
}

/* A model named in place of a scene is the garment when a motion is named too. */
static void a_model_alone_can_be_moved(void **state)
{
    (void)state;
    static const char *const assignments[] = {"scene.motion=" SCRATCH "/skirt.pc2", "scene.units=m"};
    const struct tl_settings_source source = {SCRATCH "/skirt.0.obj", assignments, TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    assert_string_equal(tl_settings_avatar(&settings.scene), "none");
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    assert_ok(tl_session_go_to(session, 2, &error), error);
    check_frame(session, 2);
    tl_session_destroy(&session);
}

/* The T-shirt: finite frames all through, and the PC2's frame 120 is the OBJ's. */
static void a_real_simulation_is_played(void **state)
{
    (void)state;
    char garment[1100], motion[1100];
    tl_error error = {0};
    snprintf(garment, sizeof garment, "scene.garment=%s", test_data("sequences/tshirt_iter0/000.obj"));
    snprintf(motion, sizeof motion, "scene.motion=%s", test_data("sequences/tshirt_iter0/tshirt.pc2"));
    const char *const extra[] = {garment, motion, "scene.avatar=none"};
    tl_session *session = create(extra, TL_COUNT(extra));
    tl_model expected;
    assert_ok(tl_model_load_in(test_data("sequences/tshirt_iter0/120.obj"), TL_UNITS_DM, &expected, &error),
              error);
    for (int number = 0; number <= 120; number += 30) {
        assert_ok(tl_session_go_to(session, number, &error), error);
        const tl_surface *shirt = garment_of(session);
        for (size_t i = 0; i < shirt->vertex_count; i++) {
            assert_near(glms_vec3_norm(shirt->normals[i]), 1, 1e-5);
            assert_near(glms_vec3_norm(glms_vec3(shirt->tangents[i])), 1, 1e-5);
        }
    }
    const tl_surface *shirt = garment_of(session);
    assert_int_equal(shirt->vertex_count, expected.mesh.vertex_count);
    for (size_t i = 0; i < shirt->vertex_count; i++)
        assert_near(glms_vec3_distance(shirt->positions[i], expected.mesh.positions[i]), 0, 1e-6);
    tl_model_release(&expected);
    tl_session_destroy(&session);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_simulated_is_played), cmocka_unit_test(units_apply_to_the_motion_too),
        cmocka_unit_test(the_rate_can_be_told),         cmocka_unit_test(a_clip_moves_the_garment),
        cmocka_unit_test(motions_have_an_end),          cmocka_unit_test(an_avatar_alone_is_played_back),
        cmocka_unit_test(motions_come_and_go),          cmocka_unit_test(a_model_alone_can_be_moved),
        cmocka_unit_test(a_real_simulation_is_played),
    };
    return cmocka_run_group_tests(tests, simulate_and_write, forget);
}
