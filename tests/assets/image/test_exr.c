#include "assets/image/exr.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <glob.h>
#include <string.h>

static size_t value_count(const tl_image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static tl_image load_feature(const char *name)
{
    char relative[128];
    enum tl_exr_envmap envmap;
    tl_image image;
    tl_error error;
    snprintf(relative, sizeof relative, "exr-features/%s.exr", name);
    assert_ok(tl_exr_load(test_data(relative), &image, &envmap, &error), error);
    assert_int_equal(image.type, TL_IMAGE_F32);
    return image;
}

static void every_valid_file_loads(void **state)
{
    (void)state;
    char pattern[1200];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/*.exr", test_data("exr-features"));
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        tl_image image;
        enum tl_exr_envmap envmap;
        tl_error error = {0};
        bool loaded = tl_exr_load(found.gl_pathv[i], &image, &envmap, &error);
        if (strstr(found.gl_pathv[i], "11.deep.exr"))
            assert_true(!loaded && strstr(error.message, "deep"));
        else if (!loaded) {
            print_error("%s\n", error.message);
            fail();
        }
        tl_image_release(&image);
    }
    globfree(&found);
}

/* One image in many codecs: the lossless ones agree to the bit. */
static void codecs_agree(void **state)
{
    (void)state;
    const char *const lossless[] = {"comp_rle", "comp_zips", "comp_zip", "comp_piz"};
    tl_image plain = load_feature("comp_none");
    for (size_t i = 0; i < TL_COUNT(lossless); i++) {
        tl_image other = load_feature(lossless[i]);
        assert_int_equal(value_count(&other), value_count(&plain));
        assert_memory_equal(other.texels, plain.texels, value_count(&plain) * sizeof(float));
        tl_image_release(&other);
    }
    /* B44's file has one column and row less. B44 keeps 6 bits of the range of 4 x 4 texels, in the
     * logarithm: coarse next to the lamps of this image. An image shifted by one texel differs by 8 to 15 %
     * of its mean. */
    const char *const lossy[] = {"comp_b44", "comp_dwaa_v2", "comp_dwab_v2"};
    for (size_t i = 0; i < TL_COUNT(lossy); i++) {
        tl_image other = load_feature(lossy[i]);
        double difference = 0, sum = 0;
        for (int y = 0; y < other.height; y++)
            for (int x = 0; x < other.width; x++)
                for (int c = 0; c < 3; c++) {
                    double a = (double)tl_image_floats(&plain)[(y * plain.width + x) * plain.channels + c];
                    double b = (double)tl_image_floats(&other)[(y * other.width + x) * other.channels + c];
                    difference += fabs(a - b);
                    sum += fabs(a);
                }
        printf("%s: mean difference %.3f %%\n", lossy[i], 100 * difference / sum);
        assert_true(difference < 0.04 * sum);
        tl_image_release(&other);
    }
    tl_image_release(&plain);
}

/* The image holds every 16-bit pattern; each kind of value must be kept. */
static void all_half_values(void **state)
{
    (void)state;
    tl_image image = load_feature("AllHalfValues");
    size_t nan = 0, inf = 0, tiny = 0;
    float largest = 0;
    for (size_t i = 0; i < value_count(&image); i++) {
        float value = tl_image_floats(&image)[i];
        nan += isnan(value) ? 1 : 0;
        inf += isinf(value) ? 1 : 0;
        tiny += fabsf(value) == 0x1p-24f ? 1 : 0;
        if (isfinite(value))
            largest = fmaxf(largest, value);
    }
    assert_true(nan > 0 && inf > 0 && tiny > 0);
    assert_near(largest, 65504, 0);
    tl_image_release(&image);
}

/* The data window is the image, wherever it lies in the display window. */
static void windows(void **state)
{
    (void)state;
    tl_image first = load_feature("DisplayWindow_t01");
    const char *const others[] = {"DisplayWindow_t03", "DisplayWindow_t05", "DisplayWindow_t07",
                                  "DisplayWindow_t09", "DisplayWindow_t11", "DisplayWindow_t13",
                                  "DisplayWindow_t15"};
    for (size_t i = 0; i < TL_COUNT(others); i++) {
        tl_image other = load_feature(others[i]);
        assert_true(other.width == first.width && other.height == first.height);
        tl_image_release(&other);
    }
    tl_image_release(&first);
}

/* Rec709_YC is a photograph: its chroma must give plausible colour, smooth where luminance is. Y is a
 * weighted mean of R, G and B, so of these one is at least Y and one at most. */
static void luminance_and_chroma(void **state)
{
    (void)state;
    tl_image image = load_feature("Rec709_YC");
    size_t texels = (size_t)image.width * (size_t)image.height, coloured = 0, negative = 0;
    for (size_t i = 0; i < texels; i++) {
        const float *t = tl_image_floats(&image) + (size_t)image.channels * i;
        coloured += fabsf(t[0] - t[2]) > 0.1f * t[1];
        negative += t[0] < -0.05f || t[1] < -0.05f || t[2] < -0.05f;
    }
    printf("Rec709_YC: %.1f %% coloured, %.2f %% negative\n", 100.0 * (double)coloured / (double)texels,
           100.0 * (double)negative / (double)texels);
    assert_true(coloured > texels / 4 && negative < texels / 100);
    tl_image_release(&image);
}

static void round_trip(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B", "A"};
    const char *path = TOILE_SCRATCH_DIR "/round.exr";
    const int sizes[][2] = {{1, 1}, {1, 40}, {33, 17}, {100, 3}};
    for (size_t s = 0; s < TL_COUNT(sizes); s++)
        for (int channels = 3; channels <= 4; channels++) {
            tl_image image = tl_image_create(sizes[s][0], sizes[s][1], channels, TL_IMAGE_F32), back;
            const float special[] = {NAN, INFINITY, -INFINITY, -0.0f, 1e-42f, 3.4e38f, -1.5f, 0.1f};
            for (size_t i = 0; i < value_count(&image); i++)
                tl_image_floats(&image)[i] = i % 3 ? (float)i * 0.37f : special[i / 3 % TL_COUNT(special)];
            const struct tl_exr_layer layer = {names, &image};
            enum tl_exr_envmap envmap;
            tl_error error;
            assert_ok(tl_exr_save(path, &layer, 1, &error), error);
            assert_ok(tl_exr_load(path, &back, &envmap, &error), error);
            assert_int_equal(envmap, TL_EXR_NOT_ENVMAP);
            assert_true(back.width == image.width && back.height == image.height);
            assert_int_equal(back.channels, channels);
            assert_memory_equal(back.texels, image.texels, value_count(&image) * sizeof(float));
            tl_image_release(&image);
            tl_image_release(&back);
        }
}

/* Other layers do not affect the colour, whatever the order of their names. */
static void layers_are_kept_apart(void **state)
{
    (void)state;
    static const char *const colours[] = {"R", "G", "B"}, *const normals[] = {"N.X", "N.Y", "N.Z"};
    const char *path = TOILE_SCRATCH_DIR "/layers.exr";
    tl_image colour = tl_image_create(5, 4, 3, TL_IMAGE_F32), normal = tl_image_create(5, 4, 3, TL_IMAGE_F32);
    for (size_t i = 0; i < value_count(&colour); i++) {
        tl_image_floats(&colour)[i] = (float)i;
        tl_image_floats(&normal)[i] = -1000;
    }
    const struct tl_exr_layer layers[] = {{normals, &normal}, {colours, &colour}};
    enum tl_exr_envmap envmap;
    tl_image back;
    tl_error error;
    assert_ok(tl_exr_save(path, layers, 2, &error), error);
    assert_ok(tl_exr_load(path, &back, &envmap, &error), error);
    assert_memory_equal(back.texels, colour.texels, value_count(&colour) * sizeof(float));
    tl_image_release(&back);
    assert_ok(tl_exr_load_channel(path, "B", &back, &error), error);
    assert_int_equal(back.channels, 1);
    assert_true(back.width == 5 && back.height == 4);
    for (size_t i = 0; i < value_count(&back); i++)
        assert_near(tl_image_floats(&back)[i], 3 * i + 2, 0);
    tl_image_release(&back);
    assert_ok(tl_exr_load_channel(path, "N.Y", &back, &error), error);
    assert_near(tl_image_floats(&back)[19], -1000, 0);
    tl_image_release(&back);
    assert_ok(tl_exr_load_channel(path, "N", &back, &error), error); /* a layer is no channel */
    assert_null(back.texels);
    assert_false(tl_exr_load_channel(TOILE_SCRATCH_DIR "/no such file.exr", "N.Y", &back, &error));
    assert_ok(tl_exr_load(path, &back, &envmap, &error), error);
    assert_false(tl_exr_save(TOILE_SCRATCH_DIR "/no such folder/a.exr", layers, 2, &error));
    tl_image_release(&colour);
    tl_image_release(&normal);
    tl_image_release(&back);
}

/* Every file that the reference reader refuses is refused here too. */
static void broken_files(void **state)
{
    (void)state;
    FILE *table = fopen(test_data("broken/exr/EXPECTED.tsv"), "r");
    assert_non_null(table);
    char line[4096], name[256], verdict[16];
    size_t counts[2][2] = {{0}};
    while (fgets(line, sizeof line, table)) {
        if (sscanf(line, "%255[^\t]\t%*[^\t]\t%15s", name, verdict) != 2 || strcmp(name, "file") == 0)
            continue;
        char relative[300];
        snprintf(relative, sizeof relative, "broken/exr/%s", name);
        tl_image image;
        enum tl_exr_envmap envmap;
        tl_error error = {0};
        bool loaded = tl_exr_load(test_data(relative), &image, &envmap, &error), wrong = verdict[0] == 'e';
        counts[wrong][loaded]++;
        if (!loaded && !wrong)
            printf("%s there: %s\n", verdict, error.message);
        tl_image_release(&image);
    }
    fclose(table);
    printf("refused by the reference: %zu refused, %zu loaded; others: %zu refused, %zu loaded\n",
           counts[1][0], counts[1][1], counts[0][0], counts[0][1]);
    assert_int_equal(counts[1][1], 0);
    assert_true(counts[1][0] > 0);
}

static size_t read_bytes(const char *path, uint8_t *bytes, size_t capacity)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, capacity, stream);
    fclose(stream);
    return size;
}

static void assert_refused(const char *path, const uint8_t *bytes, size_t size, const char *why)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
    tl_image image;
    enum tl_exr_envmap envmap;
    tl_error error = {0};
    assert_false(tl_exr_load(path, &image, &envmap, &error));
    assert_int_equal(error.code, TL_INPUT);
    if (!strstr(error.message, why)) {
        print_error("%s\n", error.message);
        fail();
    }
}

/* The library allocates what an attribute's size claims before it reads the attribute: a claim beyond the
 * file's end must be refused first, however small the file. */
static void attributes_lie_within_the_file(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B"};
    static const char attribute[] = "comments\0string"; /* and its NUL; the size follows */
    const char *path = TOILE_SCRATCH_DIR "/attribute.exr", *why = "claims more bytes than the file has";
    uint8_t bytes[1024];
    tl_image image = tl_image_create(2, 2, 3, TL_IMAGE_F32);
    const struct tl_exr_layer layer = {names, &image};
    tl_error error;
    assert_ok(tl_exr_save_commented(path, &layer, 1, "ten letters", &error), error);
    size_t size = read_bytes(path, bytes, sizeof bytes);
    assert_true(size < sizeof bytes);
    uint8_t *claim = memmem(bytes, size, attribute, sizeof attribute);
    assert_non_null(claim);
    claim += sizeof attribute;
    const uint8_t claims[][4] = {
        {0xff, 0xff, 0xff, 0x7f}, {0xff, 0xff, 0xff, 0xff}, {0, 0, 0, 0x80}, {0, 0x04, 0, 0}};
    for (size_t i = 0; i < TL_COUNT(claims); i++) {
        memcpy(claim, claims[i], 4);
        assert_refused(path, bytes, size, why);
    }
    tl_image_release(&image);
}

/* A preview of 30,000 x 30,000 texels in an attribute of eight bytes. */
static void previews_lie_within_their_attribute(void **state)
{
    (void)state;
    static const uint8_t bytes[] = "\x76\x2f\x31\x01\x02\0\0\0preview\0preview\0\x08\0\0\0"
                                   "\x30\x75\0\0\x30\x75\0\0";
    assert_refused(TOILE_SCRATCH_DIR "/preview.exr", bytes, sizeof bytes, "has not the size of its type");
}

/* The library goes by the type of a value, not by its size: what is left of a longer one would be its next
 * attribute, with a claim that nobody has checked. Inside each value here is such an attribute, "b" of type
 * "t", that claims 2 GB. */
static void values_are_as_long_as_their_type(void **state)
{
    (void)state;
    static const char inner[] = "b\0t\0\xff\xff\xff\x7f";
    static const struct {
        const char *type;
        size_t length; /* of a sound value */
        const char *value;
    } cases[] = {{"float", 4, "\0\0\0\0"},
                 {"compression", 1, "\0"},
                 {"chlist", 19, "R\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"},
                 {"chlist", 1, ""},
                 {"preview", 8, "\0\0\0\0\0\0\0\0"},
                 {"stringvector", 5, "\1\0\0\0a"}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        uint8_t bytes[128] = "\x76\x2f\x31\x01\x02";
        uint8_t *at = bytes + 8, length = (uint8_t)(cases[i].length + sizeof inner - 1);
        at = (uint8_t *)stpcpy((char *)at, "a") + 1;
        at = (uint8_t *)stpcpy((char *)at, cases[i].type) + 1;
        *at = length;
        memcpy(at + 4, cases[i].value, cases[i].length);
        memcpy(at + 4 + cases[i].length, inner, sizeof inner - 1);
        at += 4 + length;
        assert_refused(TOILE_SCRATCH_DIR "/long.exr", bytes, (size_t)(at + 1 - bytes),
                       "has not the size of its type");
    }
}

/* A file truncated at any byte is refused. */
static void cut_files_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B"};
    const char *path = TOILE_SCRATCH_DIR "/cut.exr";
    uint8_t bytes[4096];
    tl_image image = tl_image_create(8, 40, 3, TL_IMAGE_F32);
    for (size_t i = 0; i < value_count(&image); i++)
        tl_image_floats(&image)[i] = (float)(i * i % 7);
    const struct tl_exr_layer layer = {names, &image};
    tl_error error;
    assert_ok(tl_exr_save(path, &layer, 1, &error), error);
    size_t size = read_bytes(path, bytes, sizeof bytes);
    assert_true(size < sizeof bytes);
    for (size_t cut = 1; cut < size; cut++)
        assert_refused(path, bytes, cut, "is not a whole OpenEXR file");
    tl_image_release(&image);
}

/* A file whose colours are layers: the first layer that has red, green and blue is read, with its alpha; a
 * layer without blue is not. Channels of the file's own come before any layer. */
static void layers_are_read(void **state)
{
    (void)state;
    static const char *const shallow[] = {"aaa.R", "aaa.G"},
                             *const beauty[] = {"beauty.R", "beauty.G", "beauty.B", "beauty.A"},
                             *const other[] = {"light.R", "light.G", "light.B"},
                             *const own[] = {"R", "G", "B"};
    tl_image two = tl_image_create(2, 1, 2, TL_IMAGE_F32), four = tl_image_create(2, 1, 4, TL_IMAGE_F32),
             three = tl_image_create(2, 1, 3, TL_IMAGE_F32), read;
    for (int i = 0; i < 8; i++)
        tl_image_floats(&four)[i] = (float)(i + 1);
    for (int i = 0; i < 6; i++)
        tl_image_floats(&three)[i] = (float)(100 + i);
    const struct tl_exr_layer layers[] = {{shallow, &two}, {beauty, &four}, {other, &three}, {own, &three}};
    const char *path = TOILE_SCRATCH_DIR "/layers.exr";
    enum tl_exr_envmap envmap;
    tl_error error;
    assert_ok(tl_exr_save(path, layers, 3, &error), error);
    assert_ok(tl_exr_load(path, &read, &envmap, &error), error);
    assert_int_equal(read.channels, 4);
    assert_memory_equal(read.texels, four.texels, 8 * sizeof(float));
    tl_image_release(&read);
    assert_ok(tl_exr_save(path, layers, 4, &error), error);
    assert_ok(tl_exr_load(path, &read, &envmap, &error), error);
    assert_int_equal(read.channels, 3);
    assert_memory_equal(read.texels, three.texels, 6 * sizeof(float));
    tl_image_release(&read);
    tl_image_release(&two);
    tl_image_release(&three);
    tl_image_release(&four);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_read),
        cmocka_unit_test(round_trip),
        cmocka_unit_test(layers_are_kept_apart),
        cmocka_unit_test(codecs_agree),
        cmocka_unit_test(all_half_values),
        cmocka_unit_test(windows),
        cmocka_unit_test(luminance_and_chroma),
        cmocka_unit_test(broken_files),
        cmocka_unit_test(every_valid_file_loads),
        cmocka_unit_test(attributes_lie_within_the_file),
        cmocka_unit_test(previews_lie_within_their_attribute),
        cmocka_unit_test(values_are_as_long_as_their_type),
        cmocka_unit_test(cut_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
