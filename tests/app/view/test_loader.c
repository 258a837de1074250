/* The loader makes another appearance of a scene while the session plays: it reads only what playing never
 * writes, and neither changes the other's result. Under `./dev tsan` an access that is not ordered fails this
 * test. */
#include "tests/app/quick_session.h"

#include "app/view/loader/loader.h"

#include <stdatomic.h>
#include <time.h>

static atomic_int wake_count;

static void wake(void)
{
    atomic_fetch_add(&wake_count, 1);
}

#define FRAMES 4 /* played while a loader runs: each writes to all that moves */

static void play_beside(tl_session *session, const tl_loader *loader)
{
    const struct timespec tick = {.tv_nsec = 5000000};
    tl_error error = {0};
    for (int frame = 0; frame < FRAMES; frame++)
        assert_ok(tl_session_advance(session, &error), error);
    while (!tl_loader_is_done(loader))
        nanosleep(&tick, NULL);
}

static void an_appearance_is_made_while_the_session_plays(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_session *session = quick_session(NULL), *alone = quick_session(NULL);
    struct tl_settings wanted = *tl_session_settings(session);
    wanted.material.glossiness = 0.7f;
    const struct tl_load_lights lights = {
        .count = 1,
        .of = {{.environment = tl_session_frame(session).environment,
                .settings = tl_settings_render(&wanted),
                .region_counts = {16}}},
    };
    const struct tl_session_models models = tl_session_models(session);
    tl_loader *loader = tl_loader_start(TL_LOAD_APPEARANCE, &wanted, &models, &lights, 1, wake);
    play_beside(session, loader);
    struct tl_loaded loaded;
    assert_ok(tl_loader_take(&loader, &loaded, &error), error);
    assert_int_equal(atomic_load(&wake_count), 1);
    assert_non_null(loaded.prepared[0]);
    assert_true(loaded.appearance.garment.materials[0].glossiness == wanted.material.glossiness);

    /* Frames played while the loader ran are bit-identical to frames played without it. */
    assert_ok(tl_session_go_to(alone, FRAMES, &error), error);
    const tl_frame with = tl_session_frame(session), without = tl_session_frame(alone);
    assert_int_equal(with.surface_count, without.surface_count);
    for (size_t i = 0; i < with.surface_count; i++) {
        const tl_surface *a = &with.surfaces[i], *b = &without.surfaces[i];
        assert_int_equal(a->vertex_count, b->vertex_count);
        assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof *a->positions);
        assert_memory_equal(a->normals, b->normals, a->vertex_count * sizeof *a->normals);
    }
    tl_loaded_release(&loaded);
    tl_session_destroy(&session);
    tl_session_destroy(&alone);
}

static void a_stopped_loader_leaves_the_session_as_it_is(void **state)
{
    (void)state;
    tl_session *session = quick_session(NULL);
    const struct tl_settings before = *tl_session_settings(session);
    struct tl_settings wanted = before;
    wanted.cloth.edge_m = 0.07f;
    const struct tl_load_lights lights = {.count = 0};
    tl_loader *loader = tl_loader_start(TL_LOAD_SCENE, &wanted, NULL, &lights, 1, wake);
    play_beside(session, loader);
    tl_loader_cancel(&loader);
    assert_null(loader);
    tl_loader *stopped = tl_loader_start(TL_LOAD_SCENE, &wanted, NULL, &lights, 1, wake);
    tl_loader_stop(stopped);
    assert_true(tl_loader_is_stopped(stopped));
    tl_loader_cancel(&stopped);
    assert_true(tl_settings_equal(&before, tl_session_settings(session)));
    tl_session_destroy(&session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_appearance_is_made_while_the_session_plays),
        cmocka_unit_test(a_stopped_loader_leaves_the_session_as_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
