/* A small GLB with most of the features that the reader supports, made by the tests: a square of four
 * vertices on two joints, one of which a clip turns, with a sparse accessor, normals, UVs, an image and a
 * second primitive that shares the first one's vertices. */
#ifndef TOILE_TESTS_SMALL_GLB_H
#define TOILE_TESTS_SMALL_GLB_H

#include "assets/base/image.h"
#include "assets/image/image_file.h"

#include "tests/assets/hostile.h"
#include "tests/testing.h"

#include <string.h>

/* Byte offsets in the binary chunk. */
enum {
    SMALL_POSITIONS = 0,
    SMALL_NORMALS = 48,
    SMALL_UVS = 96,
    SMALL_JOINTS = 128,
    SMALL_WEIGHTS = 144,
    SMALL_INDICES = 208,
    SMALL_BINDS = 220,
    SMALL_TIMES = 348,
    SMALL_TURNS = 356,
    SMALL_SPARSE_INDICES = 388,
    SMALL_SPARSE_VALUES = 392,
    SMALL_PICTURE = 404,
    SMALL_BINARY_MAX = 1024
};

struct small_glb {
    char json[8192];
    uint8_t binary[SMALL_BINARY_MAX];
    size_t binary_size;
};

static inline void small_put(struct small_glb *glb, size_t offset, const void *bytes, size_t size)
{
    memcpy(glb->binary + offset, bytes, size);
}

static inline size_t small_put_picture(struct small_glb *glb)
{
    uint8_t texels[4] = {10, 250, 30, 200};
    tl_image image = {.width = 2, .height = 2, .channels = 1, .type = TL_IMAGE_U8, .texels = texels};
    void *png;
    size_t size;
    tl_error error;
    assert_ok(tl_image_encode_png("picture", &image, &png, &size, &error), error);
    assert_true(SMALL_PICTURE + size <= SMALL_BINARY_MAX);
    small_put(glb, SMALL_PICTURE, png, size);
    free(png);
    return size;
}

static inline struct small_glb small_glb_make(void)
{
    struct small_glb glb = {0};
    const float positions[] = {0, 0, 0, 1, 0, 0,
                               1, 1, 0, 0, 9, 9}; /* the last one is replaced by sparse data */
    const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, uvs[] = {0, 1, 1, 1, 1, 0, 0, 0};
    const uint8_t joints[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1};
    const float weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1}; /* 2: to be normalised */
    const uint16_t indices[] = {0, 1, 2, 0, 2, 3}, sparse_index = 3;
    const float binds[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const float times_s[] = {1, 2}, turns[] = {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f};
    const float sparse_value[] = {0, 1, 0};
    small_put(&glb, SMALL_POSITIONS, positions, sizeof positions);
    small_put(&glb, SMALL_NORMALS, normals, sizeof normals);
    small_put(&glb, SMALL_UVS, uvs, sizeof uvs);
    small_put(&glb, SMALL_JOINTS, joints, sizeof joints);
    small_put(&glb, SMALL_WEIGHTS, weights, sizeof weights);
    small_put(&glb, SMALL_INDICES, indices, sizeof indices);
    small_put(&glb, SMALL_BINDS, binds, sizeof binds);
    small_put(&glb, SMALL_TIMES, times_s, sizeof times_s);
    small_put(&glb, SMALL_TURNS, turns, sizeof turns);
    small_put(&glb, SMALL_SPARSE_INDICES, &sparse_index, sizeof sparse_index);
    small_put(&glb, SMALL_SPARSE_VALUES, sparse_value, sizeof sparse_value);
    size_t picture = small_put_picture(&glb);
    glb.binary_size = (SMALL_PICTURE + picture + 3) / 4 * 4;
    snprintf(
        glb.json, sizeof glb.json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
        "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[5,6,7]},{\"children\":[2]},{\"name\":\"turned\"}]"
        ","
        "\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":5}],"
        "\"meshes\":[{\"primitives\":["
        "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"JOINTS_0\":3,\"WEIGHTS_0\":4},"
        "\"indices\":6,\"material\":0},"
        "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"JOINTS_0\":3,\"WEIGHTS_0\":4},"
        "\"indices\":7,\"material\":1}]}],"
        "\"materials\":[{\"name\":\"cloth\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],"
        "\"metallicFactor\":0,\"roughnessFactor\":0.5,\"baseColorTexture\":{\"index\":0}},"
        "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25,\"doubleSided\":true},"
        "{\"name\":\"metal\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1]}}],"
        "\"textures\":[{\"source\":0}],\"images\":[{\"bufferView\":11,\"mimeType\":\"image/png\"}],"
        "\"animations\":[{\"name\":\"turn\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,"
        "\"path\":\"rotation\"}}],\"samplers\":[{\"input\":8,\"output\":9}]}],"
        "\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],"
        "\"max\":[1,1,0],\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":9,\"componentType\":5123},"
        "\"values\":{\"bufferView\":10}}},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":4,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":6,\"componentType\":5126,\"count\":2,\"type\":\"MAT4\"},"
        "{\"bufferView\":5,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"bufferView\":5,\"byteOffset\":6,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"bufferView\":7,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"},"
        "{\"bufferView\":8,\"componentType\":5126,\"count\":2,\"type\":\"VEC4\"}],"
        "\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48}"
        ","
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":128,\"byteLength\":"
        "16},"
        "{\"buffer\":0,\"byteOffset\":144,\"byteLength\":64},{\"buffer\":0,\"byteOffset\":208,\"byteLength\":"
        "12},"
        "{\"buffer\":0,\"byteOffset\":220,\"byteLength\":128},{\"buffer\":0,\"byteOffset\":348,"
        "\"byteLength\":8},"
        "{\"buffer\":0,\"byteOffset\":356,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":388,\"byteLength\":"
        "2},"
        "{\"buffer\":0,\"byteOffset\":392,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":404,\"byteLength\":%zu}],"
        "\"buffers\":[{\"byteLength\":%zu}]}",
        picture, glb.binary_size);
    return glb;
}

/* Another second material, as JSON. */
static inline void small_glb_set_material(struct small_glb *glb, const char *material)
{
    static const char old[] =
        "{\"name\":\"metal\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1]}}";
    char *at = strstr(glb->json, old), rest[sizeof glb->json];
    assert_non_null(at);
    snprintf(rest, sizeof rest, "%s", at + strlen(old));
    int written = snprintf(at, sizeof glb->json - (size_t)(at - glb->json), "%s%s", material, rest);
    assert_true((size_t)written < sizeof glb->json - (size_t)(at - glb->json));
}

static inline void small_word(uint8_t *to, size_t word)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(word >> 8 * i);
}

/* The file's bytes; returns how many (`out` has room for 16 KiB). */
static inline size_t small_glb_bytes(const struct small_glb *glb, uint8_t out[16384])
{
    size_t json = (strlen(glb->json) + 3) / 4 * 4, size = 28 + json + glb->binary_size;
    memset(out, ' ', 20 + json);
    memcpy(out, "glTF", 4);
    small_word(out + 4, 2);
    small_word(out + 8, size);
    small_word(out + 12, json);
    memcpy(out + 16, "JSON", 4);
    memcpy(out + 20, glb->json, strlen(glb->json));
    small_word(out + 20 + json, glb->binary_size);
    memcpy(out + 24 + json, "BIN", 4);
    memcpy(out + 28 + json, glb->binary, glb->binary_size);
    return size;
}

static inline void small_glb_write(const struct small_glb *glb, const char *path)
{
    uint8_t bytes[16384];
    scratch_write(path, bytes, small_glb_bytes(glb, bytes));
}

#endif
