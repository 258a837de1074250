/* Contact sheets: names, hashes, what each cell shows, where it goes, and what a folder remembers. */
#include "tests/testing.h"

#include "app/report/canvas.h"
#include "app/sheet/contact_names.h"
#include "app/sheet/contact_plan.h"
#include "app/sheet/contact_store.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <string.h>

/* ---- The plan ---- */

static struct tl_arguments arguments_of(const char *line)
{
    static char words[16][256];
    char *list[16];
    int count = 0;
    char *copy = tl_copy_string(line);
    for (char *word = strtok(copy, " "); word && count < 16; word = strtok(NULL, " ")) {
        snprintf(words[count], sizeof words[0], "%s", word);
        list[count] = words[count];
        count++;
    }
    free(copy);
    struct tl_arguments arguments;
    tl_error error = {0};
    assert_ok(
        tl_arguments_parse(count, list, TL_FLAGS_SCENE | TL_FLAGS_FRAME | TL_FLAGS_SHEET, &arguments, &error),
        error);
    return arguments;
}

static struct tl_contact_plan plan_of(const char *line)
{
    struct tl_arguments arguments = arguments_of(line);
    struct tl_contact_plan plan;
    tl_error error = {0};
    assert_ok(tl_contact_plan_make(&arguments, &plan, &error), error);
    tl_arguments_release(&arguments);
    return plan;
}

static void expect_name(const struct tl_contact_plan *plan, size_t row, size_t column, const char *expected)
{
    char *name = tl_contact_cell_name(plan, row, column);
    assert_string_equal(name, expected);
    free(name);
}

static void slugs_are_plain(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"dress", "dress"},
                                           {"folder/My Shirt.GLB", "my-shirt"},
                                           {"sky.####.exr", "sky.----"},
                                           {"Rose and wine", "rose-and-wine"},
                                           {"caf\xc3\xa9.yaml", "caf--"},
                                           {"", ""}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        char *slug = tl_contact_slug(cases[i][0]);
        assert_string_equal(slug, cases[i][1]);
        free(slug);
    }
}

static void cells_have_names_and_settings(void **state)
{
    (void)state;
    struct tl_contact_plan plan = plan_of("--garments dress,skirt --fabrics satin,denim --envs studio,white "
                                          "--views front,3/4,30:10 --size 64x48");
    assert_int_equal(plan.row_count, 4);
    assert_int_equal(plan.column_count, 6);
    expect_name(&plan, 0, 0, "dress_satin_studio_front.png");
    expect_name(&plan, 1, 4, "dress_denim_white_3-4.png");
    expect_name(&plan, 3, 5, "skirt_denim_white_30-10.png");
    assert_int_equal(plan.grid.cell_width, 64);
    assert_int_equal(plan.grid.cell_height, 48);
    assert_string_equal(plan.grid.rows[2].group, "skirt");
    assert_string_equal(plan.grid.rows[2].name, "satin");
    assert_string_equal(plan.grid.columns[3].group, "white");

    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_contact_cell_settings(&plan, 3, 5, &settings, &error), error);
    assert_string_equal(settings.scene.garment, "skirt");
    assert_string_equal(settings.scene.fabric, "denim");
    assert_string_equal(settings.scene.environment, "white");
    assert_near(settings.camera.yaw_deg, 30, 0);
    assert_near(settings.camera.pitch_deg, 10, 0);
    assert_near(settings.fabric.areal_density, 0.4, 0); /* denim falls as denim */
    tl_contact_plan_release(&plan);

    plan = plan_of("--fabrics satin,denim --same-drape");
    assert_near(plan.rows[1].settings.fabric.areal_density, plan.rows[0].settings.fabric.areal_density, 0);
    assert_true(plan.rows[1].settings.material.diffuse[0] != plan.rows[0].settings.material.diffuse[0]);
    assert_string_equal(plan.grid.rows[0].group, ""); /* one garment: the title names it */
    assert_non_null(strstr(plan.title, "dress"));
    tl_contact_plan_release(&plan);
}

/* A view for each key of a camera path. */
static void keys_of_a_path_are_views(void **state)
{
    (void)state;
    FILE *file = fopen(TOILE_SCRATCH_DIR "/looks.yaml", "w");
    assert_non_null(file);
    fputs("keys:\n"
          "  - {time_s: 0, yaw_deg: 10, distance_m: 2, target: [0, 1, 0]}\n"
          "  - {time_s: 1, yaw_deg: 70, environment_yaw_deg: 40}\n",
          file);
    fclose(file);
    struct tl_contact_plan plan = plan_of("--views front," TOILE_SCRATCH_DIR "/looks.yaml");
    assert_int_equal(plan.column_count, 3);
    expect_name(&plan, 0, 2, "dress_satin_studio_looks-2.png");
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_contact_cell_settings(&plan, 0, 2, &settings, &error), error);
    assert_near(settings.camera.yaw_deg, 70, 0);
    assert_near(settings.camera.distance_m, 2, 0);
    assert_near(settings.scene.environment_yaw_deg, 40, 0);
    assert_true(tl_contact_cell_hash(&plan, 0, 1) != tl_contact_cell_hash(&plan, 0, 2));
    tl_contact_plan_release(&plan);
}

static void colourways_are_found(void **state)
{
    (void)state;
    struct tl_contact_plan plan = plan_of("--garments dress,skirt --colourways all");
    assert_int_equal(plan.row_count, 4 + 3); /* config/scenes/dress.yaml and skirt.yaml */
    expect_name(&plan, 0, 0, "dress_satin_ink_studio_front.png");
    assert_string_equal(plan.grid.rows[0].name, "Ink");
    assert_string_equal(plan.grid.rows[6].group, "skirt");
    tl_contact_plan_release(&plan);
}

/* A hash follows what the picture depends on, and nothing else. */
static void hashes_follow_what_is_shown(void **state)
{
    (void)state;
    struct tl_contact_plan plan = plan_of("--fabrics satin,denim --views front,back,scene");
    uint64_t first = tl_contact_cell_hash(&plan, 0, 0);
    for (size_t row = 0; row < 2; row++)
        for (size_t column = 0; column < 3; column++)
            assert_true(tl_contact_cell_hash(&plan, row, column) != first || (row == 0 && column == 0));
    tl_contact_plan_release(&plan);

    plan = plan_of("--fabrics wool,satin --views right,front"); /* elsewhere on another sheet */
    assert_true(tl_contact_cell_hash(&plan, 1, 1) == first);
    tl_contact_plan_release(&plan);
    static const char *const others[] = {"--fabrics satin --views front --set light.regions=25",
                                         "--fabrics satin --views front --frame 1",
                                         "--fabrics satin --views front --envs white",
                                         "--fabrics satin --views 1", "--colourways Ink --views front"};
    for (size_t i = 0; i < TL_COUNT(others); i++) {
        plan = plan_of(others[i]);
        assert_true(tl_contact_cell_hash(&plan, 0, 0) != first);
        tl_contact_plan_release(&plan);
    }
}

/* Not only a file's name counts, but what is in it. */
static void hashes_follow_files(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int i = 0; i < 2; i++) {
        FILE *file = fopen(TOILE_SCRATCH_DIR "/contact.hdr", "w");
        assert_non_null(file);
        fprintf(file, "version %d", i);
        fclose(file);
        struct tl_contact_plan plan = plan_of("--envs " TOILE_SCRATCH_DIR "/contact.hdr");
        hashes[i] = tl_contact_cell_hash(&plan, 0, 0);
        tl_contact_plan_release(&plan);
    }
    assert_true(hashes[0] != hashes[1]);
}

static void wrong_lists_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"--fabrics satin,satn", "did you mean satin?"},
        {"--fabrics satin,,denim", "--fabrics: \"satin,,denim\": expected names with commas"},
        {"--garments dress,dress", "--garments: \"dress\" is named twice"},
        {"--views frnt", "--views: \"frnt\": expected front, 3/4"},
        {"--views 30:100", "--views: \"30:100\": expected"},
        {"--views nan", "--views: \"nan\": expected"},
        {"--envs studo", "did you mean studio?"},
        {"--garments torus --colourways all", "--colourways: torus: has none"},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct tl_arguments arguments = arguments_of(cases[i][0]);
        struct tl_contact_plan plan;
        tl_error error = {0};
        assert_false(tl_contact_plan_make(&arguments, &plan, &error));
        assert_int_equal(error.code, TL_USAGE);
        if (!strstr(error.message, cases[i][1]))
            fail_msg("%s: %s", cases[i][0], error.message);
        tl_arguments_release(&arguments);
    }
}

/* ---- The layout ---- */

static void expect_apart(const struct tl_contact_grid *grid)
{
    int64_t width, height;
    tl_contact_size(grid, &width, &height);
    for (size_t i = 0; i < grid->row_count * grid->column_count; i++) {
        int x, y, other_x, other_y;
        tl_contact_place(grid, i / grid->column_count, i % grid->column_count, &x, &y);
        assert_true(x >= 0 && y >= 0 && x + grid->cell_width <= width && y + grid->cell_height <= height);
        for (size_t k = 0; k < i; k++) {
            tl_contact_place(grid, k / grid->column_count, k % grid->column_count, &other_x, &other_y);
            assert_true(abs(x - other_x) > grid->cell_width || abs(y - other_y) > grid->cell_height);
        }
    }
}

static const struct tl_contact_label rows[] = {{"", "satin"}, {"", "denim"},  {"", "voile"}, {"", "wool"},
                                               {"", "silk"},  {"", "fleece"}, {"", "ponte"}};
static const struct tl_contact_label groups[] = {{"dress", "Ink"},
                                                 {"dress", "Ivory"},
                                                 {"skirt", "Poppy"},
                                                 {"skirt", "A name that is much too long for its column"}};
static const struct tl_contact_label columns[] = {
    {"studio", "front"}, {"studio", "back"}, {"white", "front"}, {"white", "back"}};

static struct tl_contact_grid grid_of(const struct tl_contact_label *row_labels, size_t row_count,
                                      size_t column_count)
{
    return (struct tl_contact_grid){.title = "title",
                                    .note = "note",
                                    .rows = row_labels,
                                    .columns = columns,
                                    .row_count = row_count,
                                    .column_count = column_count,
                                    .cell_width = 90,
                                    .cell_height = 120};
}

static void cells_lie_apart(void **state)
{
    (void)state;
    for (size_t columns_used = 1; columns_used <= TL_COUNT(columns); columns_used++) {
        struct tl_contact_grid grid = grid_of(rows, TL_COUNT(rows), columns_used);
        expect_apart(&grid);
        grid = grid_of(groups, TL_COUNT(groups), columns_used);
        expect_apart(&grid);
        grid = grid_of(rows, 1, columns_used);
        expect_apart(&grid);
    }
}

/* Seven cells of one column: two lines of four and three, not a tower and no orphan. */
static void one_column_flows(void **state)
{
    (void)state;
    struct tl_contact_grid grid = grid_of(rows, TL_COUNT(rows), 1);
    int x, y, first_x, first_y;
    tl_contact_place(&grid, 0, 0, &first_x, &first_y);
    for (size_t i = 1; i < 4; i++) {
        tl_contact_place(&grid, i, 0, &x, &y);
        assert_int_equal(y, first_y);
    }
    tl_contact_place(&grid, 4, 0, &x, &y);
    assert_int_equal(x, first_x);
    assert_true(y > first_y + grid.cell_height);
}

static bool has_ink(const tl_image *sheet, int x, int y, int width, int height)
{
    for (int row = y; row < y + height; row++)
        for (int column = x; column < x + width; column++)
            if (tl_image_bytes(sheet)[3 * ((size_t)row * (size_t)sheet->width + (size_t)column)] < 60)
                return true;
    return false;
}

/* Words stand left of rows and above columns and never on cells; pictures go where they belong. */
static void words_and_pictures_are_in_their_places(void **state)
{
    (void)state;
    struct tl_contact_grid grid = grid_of(groups, TL_COUNT(groups), TL_COUNT(columns));
    tl_image sheet = tl_contact_draw(&grid);
    int64_t width, height;
    tl_contact_size(&grid, &width, &height);
    assert_int_equal(sheet.width, width);
    assert_int_equal(sheet.height, height);
    for (size_t row = 0; row < grid.row_count; row++)
        for (size_t column = 0; column < grid.column_count; column++) {
            int x, y;
            tl_contact_place(&grid, row, column, &x, &y);
            assert_false(has_ink(&sheet, x, y, grid.cell_width, grid.cell_height));
            if (column == 0)
                assert_true(has_ink(&sheet, 0, y, x, grid.cell_height));
            if (row == 0)
                assert_true(has_ink(&sheet, x, 0, grid.cell_width, y));
        }
    tl_image picture = tl_canvas_create(90, 120, 0x102030);
    int x, y;
    tl_contact_paste(&grid, 2, 3, &picture, &sheet);
    tl_contact_place(&grid, 2, 3, &x, &y);
    const uint8_t *corner =
        tl_image_bytes(&sheet) + 3 * ((size_t)(y + 119) * (size_t)sheet.width + (size_t)x + 89);
    assert_int_equal(corner[0], 0x10);
    assert_int_equal(corner[2], 0x30);
    assert_true(corner[3] > 0x80); /* beside it paper */
    tl_contact_mark_empty(&grid, 0, 0, &sheet);
    tl_contact_place(&grid, 0, 0, &x, &y);
    assert_true(has_ink(&sheet, x, y, grid.cell_width, grid.cell_height)); /* "refused" */
    tl_image_release(&picture);
    tl_image_release(&sheet);
}

/* ---- The folder ---- */

#define FOLDER TOILE_SCRATCH_DIR "/contact"

static void a_folder_remembers(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_image picture = tl_canvas_create(4, 4, 0xff0000);
    tl_contact_store *store = tl_contact_store_open(FOLDER, 0, 0, &error);
    assert_ok(store != NULL, error);
    assert_ok(tl_contact_store_put(store, "a.png", 1, &picture, &error), error);
    assert_ok(tl_contact_store_put(store, "b.png", 2, &picture, &error), error);
    tl_contact_store_close(&store);
    store = tl_contact_store_open(FOLDER, 0, 0, &error);
    assert_ok(store != NULL, error);
    assert_true(tl_contact_store_has(store, "a.png", 1));
    assert_false(tl_contact_store_has(store, "a.png", 2));
    assert_false(tl_contact_store_has(store, "c.png", 1));
    assert_ok(tl_contact_store_put(store, "a.png", 3, &picture, &error), error);
    assert_true(tl_contact_store_has(store, "a.png", 3));
    remove(FOLDER "/b.png");
    assert_false(tl_contact_store_has(store, "b.png", 2)); /* gone: to be drawn again */
    tl_contact_store_remove(&store);
    assert_null(store);
    assert_false(tl_file_exists(FOLDER "/a.png"));
    tl_image_release(&picture);
}

/* Shards write at the same time, each a manifest of its own; the next run without shards has them all. A
 * picture of which two manifests say different things is drawn again, and so is one that was being replaced.
 */
static void shards_add_up(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_image picture = tl_canvas_create(4, 4, 0xff0000);
    tl_contact_store *all = tl_contact_store_open(FOLDER, 0, 0, &error);
    assert_ok(all && tl_contact_store_put(all, "old.png", 1, &picture, &error), error);
    assert_ok(tl_contact_store_put(all, "new.png", 1, &picture, &error), error);
    tl_contact_store_close(&all);
    tl_contact_store *shards[2];
    for (int i = 0; i < 2; i++) {
        shards[i] = tl_contact_store_open(FOLDER, i, 2, &error);
        assert_ok(shards[i] != NULL, error);
        assert_true(tl_contact_store_has(shards[i], "old.png", 1));
        assert_ok(tl_contact_store_put(shards[i], i ? "b.png" : "a.png", 5, &picture, &error), error);
        assert_ok(tl_contact_store_put(shards[i], "both.png", 6 + (uint64_t)i, &picture, &error), error);
    }
    assert_ok(tl_contact_store_put(shards[1], "new.png", 2, &picture, &error), error);
    assert_false(tl_contact_store_has(shards[1], "new.png", 1));
    assert_false(tl_contact_store_has(shards[0], "b.png", 5)); /* it is the other's */
    tl_contact_store_close(&shards[0]);
    tl_contact_store_close(&shards[1]);
    all = tl_contact_store_open(FOLDER, 0, 0, &error);
    assert_ok(all != NULL, error);
    assert_true(tl_contact_store_has(all, "a.png", 5) && tl_contact_store_has(all, "b.png", 5));
    assert_true(tl_contact_store_has(all, "old.png", 1) && tl_contact_store_has(all, "new.png", 2));
    assert_false(tl_contact_store_has(all, "both.png", 6) || tl_contact_store_has(all, "both.png", 7));
    assert_false(tl_file_exists(FOLDER "/manifest.0-2.json") || tl_file_exists(FOLDER "/manifest.1-2.json"));
    tl_contact_store_remove(&all);
    assert_false(tl_file_exists(FOLDER));
    tl_image_release(&picture);
}

static void a_strange_manifest_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "{", "[]", "{\"contact_sheet\": 7}", "not JSON"};
    tl_error error = {0};
    assert_ok(tl_folder_make(FOLDER, &error), error);
    for (size_t i = 0; i < TL_COUNT(texts); i++) {
        FILE *file = fopen(FOLDER "/manifest.json", "w");
        assert_non_null(file);
        fputs(texts[i], file);
        fclose(file);
        assert_null(tl_contact_store_open(FOLDER, 0, 0, &error));
        assert_non_null(strstr(error.message, FOLDER "/manifest.json"));
    }
    remove(FOLDER "/manifest.json");
}

int main(void)
{
    tl_log_set_level(TL_LOG_QUIET);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slugs_are_plain),
        cmocka_unit_test(cells_have_names_and_settings),
        cmocka_unit_test(keys_of_a_path_are_views),
        cmocka_unit_test(colourways_are_found),
        cmocka_unit_test(hashes_follow_what_is_shown),
        cmocka_unit_test(hashes_follow_files),
        cmocka_unit_test(wrong_lists_are_refused),
        cmocka_unit_test(cells_lie_apart),
        cmocka_unit_test(one_column_flows),
        cmocka_unit_test(words_and_pictures_are_in_their_places),
        cmocka_unit_test(a_folder_remembers),
        cmocka_unit_test(a_strange_manifest_is_refused),
        cmocka_unit_test(shards_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
