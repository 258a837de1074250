#include "assets/base/image.h"
#include "assets/environment/environment.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/model.h"
#include "config/base/memory.h"

#include "tests/assets/hostile.h"
#include "tests/assets/small_glb.h"
#include "tests/testing.h"

#include <ftw.h>
#include <string.h>

static bool try_model(struct outcome *outcome, const char *path)
{
    tl_model model;
    tl_error error = {0};
    bool loaded = tl_model_load(path, &model, &error);
    count_outcome(outcome, path, loaded, &error);
    if (loaded) {
        const tl_mesh *mesh = &model.mesh;
        vec3s *posed = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
        for (size_t clip = 0; clip < model.clip_count; clip++)
            tl_model_pose(&model, (int)clip, 0.7, posed);
        free(posed);
        for (size_t i = 0; i < mesh->vertex_count; i++)
            assert_true(isfinite(glms_vec3_norm(mesh->positions[i])) &&
                        isfinite(glms_vec3_norm(mesh->normals[i])));
        for (size_t i = 0; i < mesh->index_count; i++)
            assert_true(mesh->indices[i] < mesh->vertex_count);
    }
    tl_model_release(&model);
    return loaded;
}

static bool try_environment(struct outcome *outcome, const char *path)
{
    tl_environment environment;
    tl_error error = {0};
    bool loaded = tl_environment_load(path, &environment, &error);
    count_outcome(outcome, path, loaded, &error);
    for (size_t i = 0; loaded && i < (size_t)environment.image.width * (size_t)environment.image.height; i++)
        for (size_t c = 0; c < 3; c++)
            assert_true(isfinite(tl_image_floats(&environment.image)[3 * i + c]));
    tl_environment_release(&environment);
    return loaded;
}

static bool try_image(struct outcome *outcome, const char *path)
{
    tl_image image;
    tl_error error = {0};
    bool loaded = tl_image_load(path, &image, &error);
    count_outcome(outcome, path, loaded, &error);
    tl_image_release(&image);
    return loaded;
}

/* ---- Collections of broken files ---- */

static try_function try_file;
static struct outcome found;

static int visit(const char *path, const struct stat *status, int kind, struct FTW *ftw)
{
    (void)status, (void)ftw;
    const char *name = strrchr(path, '/') + 1;
    if (kind == FTW_F && strcmp(name, "EXPECTED.tsv") != 0)
        try_file(&found, path);
    return 0;
}

static void visit_folder(const char *relative, try_function try)
{
    try_file = try;
    found = (struct outcome){0};
    assert_int_equal(nftw(test_data(relative), visit, 16, FTW_PHYS), 0);
    assert_true(found.loaded + found.refused > 0);
    report(relative, found);
}

static void broken_models(void **state)
{
    (void)state;
    visit_folder("broken/gltf-assimp", try_model);
    visit_folder("broken/gltf-cgltf", try_model);
    visit_folder("broken/gltf-tinygltf", try_model);
    visit_folder("broken/gltf-validator", try_model);
}

static void broken_environments(void **state)
{
    (void)state;
    visit_folder("broken/exr", try_environment);
}

static void broken_images(void **state)
{
    (void)state;
    visit_folder("broken/images", try_image);
    visit_folder("broken/images", try_environment);
}

/* ---- Files with false claims, made here ---- */

/* The small GLB with one piece of its JSON exchanged. */
static struct small_glb exchanged(const char *from, const char *to)
{
    struct small_glb glb = small_glb_make();
    char json[sizeof glb.json];
    const char *at = strstr(glb.json, from);
    if (!at)
        print_error("the small GLB has no %s\n", from);
    assert_non_null(at);
    assert_true(strlen(glb.json) + strlen(to) < sizeof json);
    snprintf(json, sizeof json, "%.*s%s%s", (int)(at - glb.json), glb.json, to, at + strlen(from));
    memcpy(glb.json, json, sizeof json);
    return glb;
}

#define POSITIONS_VIEW "\"byteOffset\":0,\"byteLength\":48"

static void json_with_false_claims_is_refused(void **state)
{
    (void)state;
    static const char *const lies[][2] = {
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":5,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":0,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":-4,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":357913942,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":4294967296,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":1537228672809129302,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":18446744073709551615,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":1e99,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5126,\"count\":4,\"type\":\"VEC4\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"", "5124,\"count\":4,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"",
         "5126,\"byteOffset\":4294967292,\"count\":4,\"type\":\"VEC3\""},
        {"5126,\"count\":4,\"type\":\"VEC3\"",
         "5126,\"byteOffset\":18446744073709551604,\"count\":4,\"type\":\"VEC3\""},
        {POSITIONS_VIEW, "\"byteOffset\":0,\"byteLength\":4800"},
        {POSITIONS_VIEW, "\"byteOffset\":4294967295,\"byteLength\":48"},
        {POSITIONS_VIEW, "\"byteOffset\":18446744073709551615,\"byteLength\":48"},
        {POSITIONS_VIEW, POSITIONS_VIEW ",\"byteStride\":8"},
        {POSITIONS_VIEW, POSITIONS_VIEW ",\"byteStride\":16"},
        {POSITIONS_VIEW, POSITIONS_VIEW ",\"byteStride\":252"},
        {POSITIONS_VIEW, POSITIONS_VIEW ",\"byteStride\":2147483644"},
        {"{\"buffer\":0," POSITIONS_VIEW, "{\"buffer\":7," POSITIONS_VIEW},
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":2"},
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":5"},
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":-1"},
        {"\"indices\":{\"bufferView\":9,\"componentType\":5123}",
         "\"indices\":{\"bufferView\":7,\"componentType\":5125}"}, /* element 0x3f800000 */
        {"\"indices\":{\"bufferView\":9,\"componentType\":5123}",
         "\"indices\":{\"bufferView\":9,\"componentType\":5125}"},
        {"\"indices\":{\"bufferView\":9,\"componentType\":5123}",
         "\"indices\":{\"bufferView\":99,\"componentType\":5123}"},
        {"\"values\":{\"bufferView\":10}", "\"values\":{\"bufferView\":10,\"byteOffset\":-4}"},
        {"\"POSITION\":0", "\"POSITION\":99"},
        {"\"NORMAL\":1", "\"NORMAL\":2"},
        {"\"TEXCOORD_0\":2", "\"TEXCOORD_0\":8"},
        {"\"JOINTS_0\":3", "\"JOINTS_0\":4"},
        {"\"WEIGHTS_0\":4", "\"WEIGHTS_0\":9"},
        {"\"indices\":6", "\"indices\":1"},
        {"\"indices\":6", "\"indices\":99"},
        {"\"mesh\":0,\"skin\":0", "\"mesh\":1,\"skin\":0"},
        {"\"mesh\":0,\"skin\":0", "\"mesh\":0,\"skin\":1"},
        {"\"joints\":[1,2]", "\"joints\":[1]"},
        {"\"joints\":[1,2]", "\"joints\":[1,99]"},
        {"\"joints\":[1,2]", "\"joints\":[1,-2]"},
        {"\"joints\":[1,2]", "\"joints\":[1,2,0]"},
        {"\"inverseBindMatrices\":5", "\"inverseBindMatrices\":4"},
        {"\"children\":[2]", "\"children\":[1]"},
        {"\"children\":[2]", "\"children\":[2,2]"},
        {"\"children\":[2]", "\"children\":[99]"},
        {"\"name\":\"turned\"", "\"children\":[1]"},
        {"\"translation\":[5,6,7]", "\"children\":[0]"},
        {"\"scenes\":[{\"nodes\":[0,1]}]", "\"scenes\":[{\"nodes\":[0,99]}]"},
        {"\"scenes\":[{\"nodes\":[0,1]}]", "\"scenes\":[{\"nodes\":[1]}]"}, /* nothing to be seen */
        {"\"input\":8", "\"input\":6"},
        {"\"input\":8", "\"input\":99"},
        {"\"output\":9", "\"output\":8"},
        {"\"target\":{\"node\":2", "\"target\":{\"node\":99"},
        {"{\"name\":\"turned\"", "{\"translation\":[1e39,0,0]"},
        {"{\"name\":\"turned\"", "{\"scale\":[1e30,1e30,1e30]"},
        {"\"version\":\"2.0\"", "\"version\":\"1.0\""},
        {"\"asset\"", "\"tasse\""},
        {"\"bufferView\":11,", "\"bufferView\":99,"},
    };
    struct outcome outcome = {0};
    const char *path = scratch("lie.glb");
    for (size_t i = 0; i < TL_COUNT(lies); i++) {
        struct small_glb glb = exchanged(lies[i][0], lies[i][1]);
        small_glb_write(&glb, path);
        if (try_model(&outcome, path)) {
            print_error("loaded with %s instead of %s\n", lies[i][1], lies[i][0]);
            fail();
        }
    }
    report("lies", outcome);
}

/* Broken parts that affect only the appearance are left out and listed; so are unknown features. */
static void broken_appearance_is_left_out(void **state)
{
    (void)state;
    static const char *const faults[][2] = {
        {"\"bufferView\":11,\"mimeType\"", "\"bufferView\":0,\"mimeType\""},
        {"\"textures\":[{\"source\":0}]", "\"textures\":[{\"source\":9}]"},
        {"\"images\":[{\"bufferView\":11,\"mimeType\":\"image/png\"}]",
         "\"images\":[{\"uri\":\"absent.png\"}]"},
    };
    const char *path = scratch("looks.glb");
    for (size_t i = 0; i < TL_COUNT(faults); i++) {
        struct small_glb glb = exchanged(faults[i][0], faults[i][1]);
        tl_model model;
        tl_error error;
        small_glb_write(&glb, path);
        assert_ok(tl_model_load(path, &model, &error), error);
        assert_null(model.materials[0].diffuse_map.image);
        assert_int_equal(model.ignored_count, 1);
        tl_model_release(&model);
    }
}

static void binary_with_false_claims_is_refused(void **state)
{
    (void)state;
    const uint16_t index = 4, sparse = 4;
    const uint8_t joint = 2;
    const float nan_position = NAN, far_position = 1e9f, falling_time = 0;
    const struct {
        size_t offset, size;
        const void *bytes;
    } lies[] = {
        {SMALL_INDICES + 2, sizeof index, &index},       {SMALL_SPARSE_INDICES, sizeof sparse, &sparse},
        {SMALL_JOINTS + 8, sizeof joint, &joint},        {SMALL_POSITIONS + 4, 4, &nan_position},
        {SMALL_POSITIONS + 4, 4, &far_position},         {SMALL_TIMES + 4, 4, &falling_time},
        {SMALL_BINDS + 20, sizeof(float), &nan_position}};
    const char *path = scratch("lie.glb");
    struct outcome outcome = {0};
    for (size_t i = 0; i < TL_COUNT(lies); i++) {
        struct small_glb glb = small_glb_make();
        small_put(&glb, lies[i].offset, lies[i].bytes, lies[i].size);
        small_glb_write(&glb, path);
        assert_false(try_model(&outcome, path));
    }
}

/* A node takes a few bytes of the file; the memory that nodes cause is limited all the same. */
static void repetition_costs_little(void **state)
{
    (void)state;
    const size_t count = 20000;
    char *json = NULL;
    size_t size;
    FILE *stream = open_memstream(&json, &size);
    fprintf(stream, "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0");
    for (size_t i = 1; i < count; i++)
        fprintf(stream, ",%zu", i);
    fprintf(stream, "]}],\"nodes\":[{\"mesh\":0,\"skin\":0}");
    for (size_t i = 1; i < count; i++)
        fprintf(stream, ",{\"mesh\":0,\"skin\":0}");
    fprintf(stream, "],\"skins\":[{\"joints\":[0");
    for (size_t i = 1; i < count; i++)
        fprintf(stream, ",%zu", i);
    fprintf(stream, "]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
                    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}]}");
    assert_int_equal(fclose(stream), 0);
    const char *path = scratch("repetition.gltf");
    scratch_write(path, json, size);
    free(json);
    struct outcome outcome = {0};
    try_model(&outcome, path);
    report("20000 nodes with a skin of 20000 joints", outcome);
}

static void deep_nesting_is_refused(void **state)
{
    (void)state;
    const size_t depth = 1 << 20;
    uint8_t *json = TL_NEW_ARRAY(uint8_t, depth + 16);
    memset(json, '[', depth + 16);
    memcpy(json, "{\"asset\":", 9);
    const char *path = scratch("deep.gltf");
    scratch_write(path, json, depth);
    free(json);
    struct outcome outcome = {0};
    assert_false(try_model(&outcome, path));
}

static void truncated_models(void **state)
{
    (void)state;
    struct small_glb glb = small_glb_make();
    uint8_t bytes[16384];
    size_t size = small_glb_bytes(&glb, bytes);
    const char *path = scratch("short.glb");
    struct outcome outcome = {0};
    for (size_t cut = 16; cut < size; cut += 16) {
        scratch_write(path, bytes, cut);
        assert_false(try_model(&outcome, path)); /* the header states the length */
        small_word(bytes + 8, cut);
        scratch_write(path, bytes, cut);
        try_model(&outcome, path);
        small_word(bytes + 8, size);
    }
    report("truncated GLB", outcome);
}

static void mutated_models(void **state)
{
    (void)state;
    struct small_glb glb = small_glb_make();
    uint8_t bytes[16384];
    size_t size = small_glb_bytes(&glb, bytes);
    mutate("mutated.glb", bytes, size, 4000, false, try_model);
    mutate("numbers.glb", bytes, size, 6000, true, try_model);
}

static void mutated_exr(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B"};
    tl_image image = tl_image_create(12, 6, 3, TL_IMAGE_F32);
    for (int i = 0; i < 12 * 6 * 3; i++)
        tl_image_floats(&image)[i] = (float)(i % 7);
    const struct tl_exr_layer layer = {names, &image};
    tl_error error;
    char whole[1024];
    snprintf(whole, sizeof whole, "%s", scratch("whole.exr"));
    assert_ok(tl_exr_save(whole, &layer, 1, &error), error);
    mutate_file(whole, "mutated.exr", 3000, try_environment);
    tl_image_release(&image);
}

/* Codecs that toile does not write. */
static void mutated_codecs(void **state)
{
    (void)state;
    const struct {
        const char *file;
        int count;
    } files[] = {{"exr-features/DisplayWindow_t01.exr", 300}, {"exr-features/GammaChart.exr", 100},
                 {"exr-features/comp_b44.exr", 40},           {"exr-features/comp_dwaa_v2.exr", 40},
                 {"exr-features/comp_dwab_v2.exr", 40},       {"exr-features/Rec709_YC.exr", 40},
                 {"exr-features/11.deep.exr", 100},           {"exr-features/v1.7.test.planar.exr", 60}};
    for (size_t i = 0; i < TL_COUNT(files); i++)
        mutate_file(test_data(files[i].file), "mutated.exr", files[i].count, try_environment);
}

static void mutated_hdr(void **state)
{
    (void)state;
    uint8_t bytes[512] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n-Y 4 +X 16\n";
    size_t size = strlen((char *)bytes);
    for (int row = 0; row < 4; row++) {
        const uint8_t start[] = {2, 2, 0, 16};
        memcpy(bytes + size, start, 4);
        size += 4;
        for (int c = 0; c < 4; c++) { /* a run of 12 and four literals */
            const uint8_t runs[] = {128 + 12, 130, 4, 127, 128, 129, 130};
            memcpy(bytes + size, runs, sizeof runs);
            size += sizeof runs;
        }
    }
    mutate("mutated.hdr", bytes, size, 3000, false, try_environment);
}

static void mutated_png(void **state)
{
    (void)state;
    uint8_t texels[32 * 32 * 3];
    for (size_t i = 0; i < sizeof texels; i++)
        texels[i] = (uint8_t)(i * i / 7);
    tl_image image = {.width = 32, .height = 32, .channels = 3, .type = TL_IMAGE_U8, .texels = texels};
    void *png;
    size_t size;
    tl_error error;
    assert_ok(tl_image_encode_png("picture", &image, &png, &size, &error), error);
    mutate("mutated.png", png, size, 500, false, try_image);
    free(png);
}

/* ---- False sizes ---- */

static void huge_images_are_refused(void **state)
{
    (void)state;
    /* headers alone, checksums right: 30000 x 30000 and 16000 x 16000 of 8-bit RGBA */
    static const uint8_t headers[2][33] = {
        {0x89, 'P',  'N',  'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,
         0,    0x75, 0x30, 0,   0,    0x75, 0x30, 8,    6, 0, 0, 0,  0,   0,   0,   0},
        {0x89, 'P',  'N',  'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,
         0,    0x3e, 0x80, 0,   0,    0x3e, 0x80, 8,    6, 0, 0, 0,  0,   0,   0,   0}};
    static const char *const pictures[] = {
        "#?RADIANCE\n\n-Y 30000 +X 30000\n\1\2\3\4", "#?RADIANCE\n\n-Y 16000 +X 16000\n\1\2\3\4",
        "#?RADIANCE\n\n-Y 2147483647 +X 2147483647\n\1\2\3\4", "#?RADIANCE\n\n-Y 0 +X 100\n\1\2\3\4",
        "#?RADIANCE\n\n-Y -5 +X 100\n\1\2\3\4"};
    struct outcome outcome = {0};
    const char *path = scratch("huge");
    for (size_t i = 0; i < TL_COUNT(headers); i++) {
        scratch_write(path, headers[i], sizeof headers[i]);
        assert_false(try_image(&outcome, path));
    }
    for (size_t i = 0; i < TL_COUNT(pictures); i++) {
        scratch_write(path, pictures[i], strlen(pictures[i]));
        assert_false(try_environment(&outcome, path));
    }
    report("huge pictures", outcome);
}

static void paths_without_a_file_are_refused(void **state)
{
    (void)state;
    struct outcome outcome = {0};
    const char *path = scratch("empty");
    scratch_write(path, "", 0);
    const try_function all[] = {try_model, try_environment, try_image};
    for (size_t i = 0; i < TL_COUNT(all); i++) {
        assert_false(all[i](&outcome, path));
        assert_false(all[i](&outcome, SCRATCH));
        assert_false(all[i](&outcome, SCRATCH "/absent"));
        assert_false(all[i](&outcome, "/dev/zero"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_without_a_file_are_refused),
        cmocka_unit_test(json_with_false_claims_is_refused),
        cmocka_unit_test(broken_appearance_is_left_out),
        cmocka_unit_test(binary_with_false_claims_is_refused),
        cmocka_unit_test(repetition_costs_little),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(truncated_models),
        cmocka_unit_test(mutated_models),
        cmocka_unit_test(mutated_exr),
        cmocka_unit_test(mutated_codecs),
        cmocka_unit_test(mutated_hdr),
        cmocka_unit_test(mutated_png),
        cmocka_unit_test(huge_images_are_refused),
        cmocka_unit_test(broken_models),
        cmocka_unit_test(broken_images),
        cmocka_unit_test(broken_environments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
