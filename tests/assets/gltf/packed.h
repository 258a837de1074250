/* A skinned, moving patch of cloth as glTF files: plain, Draco, meshopt. Made by the tests. */
#ifndef TOILE_TESTS_PACKED_H
#define TOILE_TESTS_PACKED_H

#include "tests/assets/gltf/packed_shim.h"
#include "tests/assets/hostile.h"
#include "tests/testing.h"

#include <math.h>
#include <meshoptimizer.h>
#include <string.h>

enum {
    PATCH_U = 24,
    PATCH_V = 16,
    PATCH_VERTICES = (PATCH_U + 1) * (PATCH_V + 1),
    PATCH_INDICES = 6 * PATCH_U * PATCH_V
};
enum { PATCH_KEYS = 5 };

struct patch {
    float positions[3 * PATCH_VERTICES], normals[3 * PATCH_VERTICES], uvs[2 * PATCH_VERTICES];
    float weights[4 * PATCH_VERTICES];
    uint16_t joints[4 * PATCH_VERTICES];
    uint32_t indices[PATCH_INDICES];
    float times_s[PATCH_KEYS], turns[4 * PATCH_KEYS];
};

/* A quarter of a cylinder of radius 0.5 m and height 1 m; the upper half follows a joint that turns. */
static inline struct patch patch_make(void)
{
    struct patch patch = {0};
    for (int v = 0; v <= PATCH_V; v++)
        for (int u = 0; u <= PATCH_U; u++) {
            int i = v * (PATCH_U + 1) + u;
            float s = (float)u / PATCH_U, t = (float)v / PATCH_V, angle = 1.5707963f * s;
            memcpy(patch.positions + 3 * i, (float[]){0.5f * cosf(angle), t, 0.5f * sinf(angle)}, 12);
            memcpy(patch.normals + 3 * i, (float[]){cosf(angle), 0, sinf(angle)}, 12);
            memcpy(patch.uvs + 2 * i, (float[]){s, t}, 8);
            memcpy(patch.weights + 4 * i, (float[]){1 - t, t, 0, 0}, 16);
            patch.joints[4 * i + 1] = 1;
        }
    for (uint32_t v = 0; v < PATCH_V; v++)
        for (uint32_t u = 0; u < PATCH_U; u++) {
            uint32_t a = v * (PATCH_U + 1) + u, c = a + PATCH_U + 1;
            memcpy(patch.indices + 6 * (v * PATCH_U + u), (uint32_t[]){a, c, a + 1, a + 1, c, c + 1}, 24);
        }
    for (int k = 0; k < PATCH_KEYS; k++) {
        float half = 0.2f * (float)k;
        patch.times_s[k] = 0.25f * (float)k;
        memcpy(patch.turns + 4 * k, (float[]){0, 0, sinf(half), cosf(half)}, 16);
    }
    return patch;
}

enum packing {
    PLAIN,
    DRACO_EDGEBREAKER,
    DRACO_SEQUENTIAL,
    DRACO_LARGE_POINTS,
    MESHOPT_PLAIN,
    MESHOPT_FILTERS
};

struct packed_glb {
    char json[8192];
    uint8_t binary[1 << 18];
    size_t binary_size, view_count, fallback_size;
    char views[4096];
};

/* Appends bytes and a view of them; returns the view's index. */
static inline int packed_put(struct packed_glb *glb, const void *bytes, size_t size)
{
    size_t at = glb->binary_size, length = strlen(glb->views);
    assert_true(at + size + 4 <= sizeof glb->binary);
    memcpy(glb->binary + at, bytes, size);
    glb->binary_size = (at + size + 3) / 4 * 4;
    snprintf(glb->views + length, sizeof glb->views - length,
             "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", glb->view_count ? "," : "", at, size);
    return (int)glb->view_count++;
}

/* The same as a compressed view; its uncompressed bytes would be in buffer 1, which has none. */
static inline int packed_put_meshopt(struct packed_glb *glb, const void *bytes, size_t size, const char *mode,
                                     const char *filter, size_t count, size_t stride)
{
    size_t at = glb->binary_size, length = strlen(glb->views);
    assert_true(size > 0 && at + size + 4 <= sizeof glb->binary);
    memcpy(glb->binary + at, bytes, size);
    glb->binary_size = (at + size + 3) / 4 * 4;
    char own_stride[32] = "";
    if (strcmp(mode, "ATTRIBUTES") == 0)
        snprintf(own_stride, sizeof own_stride, "\"byteStride\":%zu,", stride);
    snprintf(
        glb->views + length, sizeof glb->views - length,
        "%s{\"buffer\":1,\"byteOffset\":%zu,\"byteLength\":%zu,%s\"extensions\":{"
        "\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"mode\":\"%s\","
        "\"filter\":\"%s\",\"count\":%zu,\"byteStride\":%zu}}}",
        glb->view_count ? "," : "", glb->fallback_size, count * stride, own_stride, at, size, mode, filter,
        count, stride);
    glb->fallback_size += (count * stride + 3) / 4 * 4;
    return (int)glb->view_count++;
}

static inline int packed_put_vertices(struct packed_glb *glb, const void *values, size_t count, size_t stride,
                                      const char *filter)
{
    static uint8_t buffer[1 << 16];
    size_t size = meshopt_encodeVertexBuffer(buffer, sizeof buffer, values, count, stride);
    return packed_put_meshopt(glb, buffer, size, "ATTRIBUTES", filter, count, stride);
}

static inline int packed_put_indices(struct packed_glb *glb, const struct patch *patch, bool triangles)
{
    static uint8_t buffer[1 << 16];
    size_t size = triangles
                      ? meshopt_encodeIndexBuffer(buffer, sizeof buffer, patch->indices, PATCH_INDICES)
                      : meshopt_encodeIndexSequence(buffer, sizeof buffer, patch->indices, PATCH_INDICES);
    return packed_put_meshopt(glb, buffer, size, triangles ? "TRIANGLES" : "INDICES", "NONE", PATCH_INDICES,
                              triangles ? 4 : 2);
}

/* The views' order: positions, normals, UVs, weights, joints, indices, times, turns. */
static inline void packed_put_plain(struct packed_glb *glb, const struct patch *patch)
{
    packed_put(glb, patch->positions, sizeof patch->positions);
    packed_put(glb, patch->normals, sizeof patch->normals);
    packed_put(glb, patch->uvs, sizeof patch->uvs);
    packed_put(glb, patch->weights, sizeof patch->weights);
    packed_put(glb, patch->joints, sizeof patch->joints);
    packed_put(glb, patch->indices, sizeof patch->indices);
    packed_put(glb, patch->times_s, sizeof patch->times_s);
    packed_put(glb, patch->turns, sizeof patch->turns);
}

static inline void packed_put_streams(struct packed_glb *glb, const struct patch *patch)
{
    packed_put_vertices(glb, patch->positions, PATCH_VERTICES, 12, "NONE");
    packed_put_vertices(glb, patch->normals, PATCH_VERTICES, 12, "NONE");
    packed_put_vertices(glb, patch->uvs, PATCH_VERTICES, 8, "NONE");
    packed_put_vertices(glb, patch->weights, PATCH_VERTICES, 16, "NONE");
    packed_put_vertices(glb, patch->joints, PATCH_VERTICES, 8, "NONE");
    packed_put_indices(glb, patch, true);
    packed_put_vertices(glb, patch->times_s, PATCH_KEYS, 4, "NONE");
    packed_put_vertices(glb, patch->turns, PATCH_KEYS, 16, "NONE");
}

/* With each filter once: positions and UVs exponential (15 bits), normals octahedral in bytes, turns as
 * quaternions of 12 bits. */
static inline void packed_put_filtered(struct packed_glb *glb, const struct patch *patch)
{
    static float exponential[3 * PATCH_VERTICES], directions[4 * PATCH_VERTICES];
    static int8_t octahedral[4 * PATCH_VERTICES];
    int16_t turns[4 * PATCH_KEYS];
    for (int i = 0; i < PATCH_VERTICES; i++)
        memcpy(directions + 4 * i, patch->normals + 3 * i, 12);
    meshopt_encodeFilterExp(exponential, PATCH_VERTICES, 12, 15, patch->positions);
    packed_put_vertices(glb, exponential, PATCH_VERTICES, 12, "EXPONENTIAL");
    meshopt_encodeFilterOct(octahedral, PATCH_VERTICES, 4, 8, directions);
    packed_put_vertices(glb, octahedral, PATCH_VERTICES, 4, "OCTAHEDRAL");
    meshopt_encodeFilterExp(exponential, PATCH_VERTICES, 8, 15, patch->uvs);
    packed_put_vertices(glb, exponential, PATCH_VERTICES, 8, "EXPONENTIAL");
    packed_put_vertices(glb, patch->weights, PATCH_VERTICES, 16, "NONE");
    packed_put_vertices(glb, patch->joints, PATCH_VERTICES, 8, "NONE");
    packed_put_indices(glb, patch, false);
    packed_put_vertices(glb, patch->times_s, PATCH_KEYS, 4, "NONE");
    meshopt_encodeFilterQuat(turns, PATCH_KEYS, 8, 12, patch->turns);
    packed_put_vertices(glb, turns, PATCH_KEYS, 8, "QUATERNION");
}

/* View 0 is the stream; the accessors of the mesh have no views. */
static inline void packed_put_draco(struct packed_glb *glb, const struct patch *patch, enum packing packing)
{
    static float many[100 * PATCH_VERTICES];
    const struct draco_source source = {.vertex_count = PATCH_VERTICES,
                                        .index_count = PATCH_INDICES,
                                        .indices = patch->indices,
                                        .positions = patch->positions,
                                        .normals = patch->normals,
                                        .uvs = patch->uvs,
                                        .weights = patch->weights,
                                        .joints = patch->joints,
                                        .hundreds = packing == DRACO_LARGE_POINTS ? many : NULL};
    size_t size = 0;
    uint8_t *bytes = draco_encode(&source, packing == DRACO_SEQUENTIAL, &size);
    assert_non_null(bytes);
    packed_put(glb, bytes, size);
    free(bytes);
    packed_put(glb, patch->times_s, sizeof patch->times_s);
    packed_put(glb, patch->turns, sizeof patch->turns);
}

static inline void packed_write_json(struct packed_glb *glb, enum packing packing)
{
    bool draco = packing >= DRACO_EDGEBREAKER && packing <= DRACO_LARGE_POINTS;
    bool filters = packing == MESHOPT_FILTERS, meshopt = filters || packing == MESHOPT_PLAIN;
    char views[6][32] = {""}, fallback[128] = "";
    for (int i = 0; i < 6 && !draco; i++)
        snprintf(views[i], sizeof views[i], "\"bufferView\":%d,", i);
    if (meshopt)
        snprintf(fallback, sizeof fallback,
                 ",{\"byteLength\":%zu,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}",
                 glb->fallback_size);
    const char *name = draco ? "KHR_draco_mesh_compression" : "EXT_meshopt_compression";
    char required[256] = "";
    if (draco || meshopt)
        snprintf(required, sizeof required, ",\"extensionsUsed\":[\"%s\"],\"extensionsRequired\":[\"%s\"]",
                 name, name);
    int written =
        snprintf(glb->json, sizeof glb->json,
                 "{\"asset\":{\"version\":\"2.0\"}%s,\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
                 "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[2]},{\"name\":\"turned\"}],"
                 "\"skins\":[{\"joints\":[1,2]}],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,"
                 "\"WEIGHTS_0\":3,\"JOINTS_0\":4},\"indices\":5%s}]}],"
                 "\"animations\":[{\"name\":\"turn\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,"
                 "\"path\":\"rotation\"}}],\"samplers\":[{\"input\":6,\"output\":7}]}],"
                 "\"accessors\":[{%s\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
                 "{%s\"componentType\":%d,%s\"count\":%d,\"type\":\"VEC3\"},"
                 "{%s\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
                 "{%s\"componentType\":5126,\"count\":%d,\"type\":\"VEC4\"},"
                 "{%s\"componentType\":5123,\"count\":%d,\"type\":\"VEC4\"},"
                 "{%s\"componentType\":%d,\"count\":%d,\"type\":\"SCALAR\"},"
                 "{\"bufferView\":%d,\"componentType\":5126,\"count\":%d,\"type\":\"SCALAR\"},"
                 "{\"bufferView\":%d,\"componentType\":%d,%s\"count\":%d,\"type\":\"VEC4\"}],"
                 "\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}%s]}",
                 required,
                 draco ? ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{"
                         "\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"WEIGHTS_0\":3,\"JOINTS_0\":4}}}"
                       : "",
                 views[0], PATCH_VERTICES, views[1], filters ? 5120 : 5126,
                 filters ? "\"normalized\":true," : "", PATCH_VERTICES, views[2], PATCH_VERTICES, views[3],
                 PATCH_VERTICES, views[4], PATCH_VERTICES, views[5], filters ? 5123 : 5125, PATCH_INDICES,
                 draco ? 1 : 6, PATCH_KEYS, draco ? 2 : 7, filters ? 5122 : 5126,
                 filters ? "\"normalized\":true," : "", PATCH_KEYS, glb->views, glb->binary_size, fallback);
    assert_true((size_t)written < sizeof glb->json);
}

static inline struct packed_glb *packed_make(const struct patch *patch, enum packing packing)
{
    struct packed_glb *glb = TL_NEW(struct packed_glb);
    if (packing == PLAIN)
        packed_put_plain(glb, patch);
    else if (packing == MESHOPT_PLAIN)
        packed_put_streams(glb, patch);
    else if (packing == MESHOPT_FILTERS)
        packed_put_filtered(glb, patch);
    else
        packed_put_draco(glb, patch, packing);
    packed_write_json(glb, packing);
    return glb;
}

static inline void packed_word(uint8_t *to, size_t word)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(word >> 8 * i);
}

/* The file's bytes for free(). */
static inline uint8_t *packed_bytes(const struct packed_glb *glb, size_t *size)
{
    size_t json = (strlen(glb->json) + 3) / 4 * 4;
    *size = 28 + json + glb->binary_size;
    uint8_t *out = TL_NEW_ARRAY(uint8_t, *size);
    memset(out, ' ', 20 + json);
    memcpy(out, "glTF", 4);
    packed_word(out + 4, 2);
    packed_word(out + 8, *size);
    packed_word(out + 12, json);
    memcpy(out + 16, "JSON", 4);
    memcpy(out + 20, glb->json, strlen(glb->json));
    packed_word(out + 20 + json, glb->binary_size);
    memcpy(out + 24 + json, "BIN", 4);
    memcpy(out + 28 + json, glb->binary, glb->binary_size);
    return out;
}

static inline void packed_write(const struct packed_glb *glb, const char *path)
{
    size_t size;
    uint8_t *bytes = packed_bytes(glb, &size);
    scratch_write(path, bytes, size);
    free(bytes);
}

#endif
