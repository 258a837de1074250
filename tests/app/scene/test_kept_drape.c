/* A drape from the cache steps on as one that was just made, to the bit: under each solver, with pins, with a
 * hand that pulls, after a reset; and what a drape depends on makes another one. */
#include "tests/testing.h"

#include "app/scene/session.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <string.h>

#define FRAMES      3
#define LIMIT_BYTES ((uint64_t)64 << 20)

static char *folder;

static int make_folder(void **state)
{
    (void)state;
    char name[] = TOILE_SCRATCH_DIR "/drape_XXXXXX";
    folder = tl_copy_string(mkdtemp(name));
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    tl_cache_use(NULL, 0);
    tl_cache_clear(folder);
    rmdir(folder);
    free(folder);
    return 0;
}

static size_t kept_count(void)
{
    size_t count;
    free(tl_cache_list(folder, &count));
    return count;
}

static struct tl_settings settings_of(const char *const *assignments, size_t count)
{
    const struct tl_settings_source source = {NULL, assignments, count};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    return settings;
}

static tl_session *open(const struct tl_settings *settings)
{
    tl_error error = {0};
    tl_session *session = tl_session_create(settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

static size_t garment_size(tl_session *session)
{
    return tl_session_garment(session)->mesh.vertex_count;
}

/* Positions of the garment at frame 0 and in frames to come, while a hand pulls; then again after a reset. */
static vec3s *play(tl_session *session, size_t *count)
{
    size_t vertices = garment_size(session);
    *count = 0;
    vec3s *seen = TL_NEW_ARRAY(vec3s, (size_t)2 * (FRAMES + 1) * vertices);
    tl_error error = {0};
    for (int round = 0; round < 2; round++) {
        tl_cloth_grab(tl_session_cloth(session), 0, (vec3s){{0.1f, 1.2f, 0.3f}});
        for (int frame = 0; frame <= FRAMES; frame++, *count += vertices) {
            tl_cloth_positions(tl_session_cloth(session), seen + *count);
            assert_ok(tl_session_advance(session, &error), error);
        }
        assert_ok(tl_session_reset(session, &error), error);
    }
    return seen;
}

/* Keeps what is built in, and another drape, so that drapes alone are counted from then on. */
static void keep_built_in(const struct tl_settings *settings)
{
    struct tl_settings other = *settings;
    other.cloth.gravity = 9;
    tl_cache_use(folder, LIMIT_BYTES);
    tl_session *session = open(&other);
    tl_session_destroy(&session);
}

static void assert_same_play(const char *const *assignments, size_t assignment_count)
{
    struct tl_settings settings = settings_of(assignments, assignment_count);
    vec3s *seen[3];
    keep_built_in(&settings);
    size_t counts[3], kept_before = kept_count();
    struct tl_cloth_report reports[3];
    for (int i = 0; i < 3; i++) { /* without the cache, into it, out of it */
        tl_cache_use(i == 0 ? NULL : folder, LIMIT_BYTES);
        tl_session *session = open(&settings);
        reports[i] = tl_session_report(session);
        seen[i] = play(session, &counts[i]);
        tl_session_destroy(&session);
        assert_int_equal(kept_count(), kept_before + (i > 0));
    }
    for (int i = 1; i < 3; i++) {
        assert_int_equal(counts[i], counts[0]);
        assert_memory_equal(seen[i], seen[0], counts[0] * sizeof(vec3s));
        assert_int_equal(reports[i].settled, reports[0].settled);
        assert_int_equal(reports[i].open_seams, reports[0].open_seams);
        assert_near(reports[i].elastic_energy, reports[0].elastic_energy, 0);
        assert_near(reports[i].max_speed, reports[0].max_speed, 0);
    }
    for (int i = 0; i < 3; i++)
        free(seen[i]);
}

#define SAME_PLAY(...)                                                                                       \
    do {                                                                                                     \
        static const char *const assignments[] = {"cloth.edge_m=0.08", __VA_ARGS__};                         \
        assert_same_play(assignments, TL_COUNT(assignments));                                                \
    } while (0)

static void preview_goes_on_as_it_would(void **state)
{
    (void)state;
    SAME_PLAY("cloth.settle_s=2");
    SAME_PLAY("cloth.settle_s=0.3", "cloth.wind=[2, 0, 1]", "cloth.gust=0.5");
    SAME_PLAY("cloth.settle_s=0.3", "cloth.self_contact=true");
}

static void reference_goes_on_as_it_would(void **state)
{
    (void)state;
    SAME_PLAY("cloth.solver=reference", "cloth.settle_s=0.2", "scene.garment=sheet", "scene.avatar=ball");
}

static void pins_go_on_as_they_would(void **state)
{
    (void)state;
    SAME_PLAY("cloth.settle_s=0.3", "scene.garment=skirt", "cloth.pin_above_m=1");
}

/* Panels that have not met yet are drawn together after the drape is restored. */
static void open_seams_go_on_as_they_would(void **state)
{
    (void)state;
    SAME_PLAY("cloth.settle_s=0");
}

static void clips_go_on_as_they_would(void **state)
{
    (void)state;
    char *avatar = tl_format("scene.avatar=%s", test_data("avatars/CesiumMan.glb"));
    const char *const assignments[] = {"cloth.edge_m=0.08", "cloth.settle_s=0.2", "cloth.longest_edge_m=0",
                                       avatar};
    assert_same_play(assignments, TL_COUNT(assignments));
    free(avatar);
}

/* Each option that affects a drape makes another one; each that does not finds the one that is there. */
static void other_options_make_other_drapes(void **state)
{
    (void)state;
    static const char *const assignments[] = {"cloth.edge_m=0.08", "cloth.settle_s=0.05", "cloth.substeps=4",
                                              "scene.garment=sheet", "scene.avatar=ball"};
    struct tl_settings settings = settings_of(assignments, TL_COUNT(assignments));
    keep_built_in(&settings);
    const size_t kept_before = kept_count();
    static const struct {
        const char *assignment;
        bool is_other;
    } cases[] = {
        {"cloth.substeps=5", true},    {"fabric.friction=0.31", true},     {"cloth.gravity=8", true},
        {"image.ground=false", true},  {"cloth.edge_m=0.07", true},        {"light.regions=48", false},
        {"scene.preset=draft", false}, {"camera.yaw_deg=3", false},        {"image.width=32", false},
        {"material.coat=0.5", false},  {"scene.environment=white", false},
    };
    tl_session *session = open(&settings);
    tl_session_destroy(&session);
    assert_int_equal(kept_count(), kept_before + 1);
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct tl_settings changed = settings;
        tl_error error = {0};
        size_t before = kept_count();
        const char *const assignment[] = {cases[i].assignment};
        assert_ok(tl_settings_assign(&changed, assignment, 1, &error), error);
        session = open(&changed);
        tl_session_destroy(&session);
        if (kept_count() != before + cases[i].is_other)
            fail_msg("%s: %zu drapes after %zu", cases[i].assignment, kept_count(), before);
    }
}

/* Nothing is remembered of contact of the layers with each other. */
static void layers_go_on_as_they_would(void **state)
{
    (void)state;
    SAME_PLAY("cloth.settle_s=0.3", "scene.garment=layers", "cloth.self_contact=true");
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(preview_goes_on_as_it_would), IN_FOLDER(reference_goes_on_as_it_would),
        IN_FOLDER(pins_go_on_as_they_would),    IN_FOLDER(open_seams_go_on_as_they_would),
        IN_FOLDER(clips_go_on_as_they_would),   IN_FOLDER(other_options_make_other_drapes),
        IN_FOLDER(layers_go_on_as_they_would),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
