/* A heavy scan is simplified where it wears a garment, and only there; an option keeps it as it is. */
#include "app/scene/load.h"
#include "app/scene/whole_body.h"
#include "assets/topology/simplify.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <string.h>

#define COLUMNS 300
#define ROWS    200
#define SCAN    TOILE_SCRATCH_DIR "/heavy.ply"

static const size_t triangles = (size_t)2 * COLUMNS * ROWS;

/* A column of 1.7 m, open at both ends. */
static int write_scan(void **state)
{
    (void)state;
    FILE *file = fopen(SCAN, "wb");
    assert_non_null(file);
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
            "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n",
            COLUMNS * (ROWS + 1), 2 * COLUMNS * ROWS);
    for (int row = 0; row <= ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            double angle = -2 * M_PI * column / COLUMNS;
            const float place[3] = {(float)(0.15 * cos(angle)), 1.7f * (float)row / ROWS,
                                    (float)(0.15 * sin(angle))};
            fwrite(place, sizeof place, 1, file);
        }
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            int a = row * COLUMNS + column, b = row * COLUMNS + (column + 1) % COLUMNS, c = a + COLUMNS,
                d = b + COLUMNS;
            const int corners[2][3] = {{a, b, c}, {b, d, c}};
            for (int t = 0; t < 2; t++) {
                fputc(3, file);
                fwrite(corners[t], sizeof corners[t], 1, file);
            }
        }
    assert_int_equal(fclose(file), 0);
    return 0;
}

static int remove_scan(void **state)
{
    (void)state;
    return remove(SCAN);
}

static struct tl_settings settings_of(const char *garment, const char *detail)
{
    char *assignments[] = {tl_format("scene.garment=%s", garment), tl_format("scene.body_detail=%s", detail),
                           tl_copy_string("scene.avatar=" SCAN), tl_copy_string("scene.avatar_units=m"),
                           tl_copy_string("cloth.settle_s=0.1")};
    const struct tl_settings_source source = {NULL, (const char *const *)assignments, TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    for (size_t i = 0; i < TL_COUNT(assignments); i++)
        free(assignments[i]);
    return settings;
}

static size_t triangles_of(const char *garment, const char *detail)
{
    struct tl_settings settings = settings_of(garment, detail);
    tl_error error = {0};
    tl_avatar *avatar;
    int clip;
    tl_model none = {0};
    assert_ok(tl_scene_load_avatar(&settings, &none, &avatar, &clip, &error), error);
    size_t count = avatar->model.mesh.index_count / 3;
    tl_avatar_release(avatar);
    free(avatar);
    return count;
}

static void a_heavy_body_in_a_garment_is_simplified(void **state)
{
    (void)state;
    size_t count = triangles_of("dress", "auto");
    assert_true(count <= TL_SIMPLIFY_TARGET && count > TL_SIMPLIFY_TARGET / 2);
}

static void the_option_keeps_all_of_it(void **state)
{
    (void)state;
    assert_true(triangles > TL_SIMPLIFY_ABOVE);
    assert_int_equal(triangles_of("dress", "full"), triangles);
}

static void a_scan_alone_is_shown_as_it_is(void **state)
{
    (void)state;
    assert_int_equal(triangles_of("none", "auto"), triangles);
}

/* An export writes the body of the file. */
static void the_whole_body_is_at_hand(void **state)
{
    (void)state;
    for (int full = 0; full < 2; full++) {
        struct tl_settings settings = settings_of("skirt", full ? "full" : "auto");
        tl_error error = {0};
        tl_session *session = tl_session_create(&settings, &error);
        assert_ok(session != NULL, error);
        tl_surface surface = tl_session_frame(session).surfaces[0];
        size_t drawn = surface.index_count / 3;
        struct tl_whole_body body;
        assert_ok(tl_whole_body_load(session, &body, &surface, &error), error);
        assert_true(full ? drawn == triangles : drawn <= TL_SIMPLIFY_TARGET);
        assert_int_equal(surface.index_count / 3, triangles);
        assert_int_equal(surface.parts[0].index_count, surface.index_count);
        assert_true(full ? body.avatar == NULL : body.avatar != NULL);
        for (size_t i = 0; i < surface.vertex_count; i++) {
            const size_t row = i / COLUMNS;
            assert_near(surface.positions[i].y, 1.7f * (float)row / ROWS, 1e-6);
        }
        tl_whole_body_release(&body);
        tl_session_destroy(&session);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_heavy_body_in_a_garment_is_simplified),
        cmocka_unit_test(the_option_keeps_all_of_it),
        cmocka_unit_test(a_scan_alone_is_shown_as_it_is),
        cmocka_unit_test(the_whole_body_is_at_hand),
    };
    return cmocka_run_group_tests(tests, write_scan, remove_scan);
}
