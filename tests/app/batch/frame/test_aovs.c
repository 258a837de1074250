/* `toile render --aov` writes layers that other programs find by name. */
#include "tests/exr_channel.h"
#include "tests/testing.h"

#include "app/batch/commands.h"
#include "config/base/log.h"

static void render(const char *output, const char *extra)
{
    char *words[] = {"--garment",  "skirt",
                     "--size",     "64x64",
                     "--preset",   "draft",
                     "--set",      "cloth.edge_m=0.05",
                     "--set",      "cloth.settle_s=0.5",
                     "--set",      "image.ground=false",
                     "--set",      "light.rounds=1",
                     "-o",         (char *)output,
                     (char *)extra};
    struct tl_arguments arguments;
    tl_error error = {0};
    int count = (int)TL_COUNT(words) - (extra ? 0 : 1);
    unsigned flags = TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_AOV;
    assert_ok(tl_arguments_parse(count, words, flags, &arguments, &error), error);
    assert_ok(tl_command_render(&arguments, &error), error);
    tl_arguments_release(&arguments);
}

/* By name; every pixel must be finite. */
static float *read_channel(const char *path, const char *name, size_t *count)
{
    int width, height;
    float *values = exr_read_channel(path, name, &width, &height);
    if (!values) {
        fail_msg("%s: no channel %s", path, name);
        return NULL;
    }
    *count = (size_t)width * (size_t)height;
    for (size_t i = 0; i < *count; i++)
        assert_true(isfinite(values[i]));
    return values;
}

static void layers_are_there(void **state)
{
    (void)state;
    static const char *const names[] = {"R",
                                        "G",
                                        "B",
                                        "A",
                                        "N.x",
                                        "N.y",
                                        "N.z",
                                        "P.x",
                                        "P.y",
                                        "P.z",
                                        "uv.u",
                                        "uv.v",
                                        "albedo.R",
                                        "albedo.G",
                                        "albedo.B",
                                        "visibility.Y",
                                        "strain.warp",
                                        "strain.weft",
                                        "strain.shear",
                                        "garment.Y"};
    enum { COUNT = TL_COUNT(names) };
    const char *path = TOILE_SCRATCH_DIR "/aovs.exr", *plain = TOILE_SCRATCH_DIR "/no_aovs.exr";
    float *channels[COUNT];
    size_t count = 0;
    render(path, "--aov");
    for (int c = 0; c < COUNT; c++)
        channels[c] = read_channel(path, names[c], &count);
    assert_int_equal(count, 64 * 64);
    double strained = 0, garment = 0;
    for (size_t i = 0; i < count; i++) {
        double n = hypot((double)channels[4][i], hypot((double)channels[5][i], (double)channels[6][i]));
        bool covered = channels[8][i] != 0; /* somewhere above the ground */
        assert_near(n, covered, 1e-5);
        assert_true(channels[8][i] >= 0 && channels[8][i] < 2);
        assert_true(channels[15][i] >= 0 && channels[15][i] <= 1);
        strained = fmax(strained, fabs((double)channels[16][i]));
        assert_true(channels[19][i] == 0 || channels[19][i] == 1); // NOLINT: one of two values
        assert_true(channels[19][i] == 0 || covered);              // NOLINT
        assert_true(channels[16][i] == 0 || channels[19][i] == 1); // NOLINT: only the garment has strains
        garment += (double)channels[19][i];
    }
    assert_true(strained > 1e-5);
    assert_true(garment > 100);

    render(plain,
           NULL); /* the image is the same with layers and without; and they are only there when asked for */
    for (int c = 0; c < 4; c++) {
        float *alone = read_channel(plain, names[c], &count);
        assert_memory_equal(alone, channels[c], count * sizeof *alone);
        free(alone);
    }
    int width, height;
    assert_null(exr_read_channel(plain, "N.x", &width, &height));
    for (int c = 0; c < COUNT; c++)
        free(channels[c]);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {cmocka_unit_test(layers_are_there)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
