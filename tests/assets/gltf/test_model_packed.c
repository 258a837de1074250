#include "assets/model.h"

#include "tests/assets/gltf/packed.h"
#include "tests/testing.h"

#include <sys/stat.h>

static tl_model load(const char *name, const struct patch *patch, enum packing packing)
{
    const char *path = scratch(name);
    struct packed_glb *glb = packed_make(patch, packing);
    packed_write(glb, path);
    free(glb);
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(path, &model, &error), error);
    assert_int_equal(model.ignored_count, 0);
    return model;
}

/* The vertex of the patch that a vertex of a file is; UVs tell, whatever its place in the file. */
static uint32_t origin_of(vec2s uv)
{
    return (uint32_t)lroundf(uv.y * PATCH_V) * (PATCH_U + 1) + (uint32_t)lroundf(uv.x * PATCH_U);
}

static int by_number(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Triangles as sorted numbers, each from its smallest vertex: neither order nor first corner count, winding
 * does. */
static void triangles_of(const tl_mesh *mesh, uint64_t out[PATCH_INDICES / 3])
{
    assert_int_equal(mesh->index_count, PATCH_INDICES);
    for (size_t t = 0; t < PATCH_INDICES / 3; t++) {
        uint64_t corners[3];
        for (size_t c = 0; c < 3; c++)
            corners[c] = origin_of(mesh->uvs[mesh->indices[3 * t + c]]);
        size_t first = corners[1] < corners[0] && corners[1] < corners[2] ? 1
                       : corners[2] < corners[0]                          ? 2
                                                                          : 0;
        out[t] = corners[first] << 40 | corners[(first + 1) % 3] << 20 | corners[(first + 2) % 3];
    }
    qsort(out, PATCH_INDICES / 3, sizeof *out, by_number);
}

struct tolerance {
    float position_m, normal, uv, pose_m;
};

static void check_same(const char *name, enum packing packing, struct tolerance tolerance)
{
    struct patch patch = patch_make();
    tl_model plain = load("plain.glb", &patch, PLAIN), packed = load(name, &patch, packing);
    uint64_t triangles[2][PATCH_INDICES / 3];
    triangles_of(&plain.mesh, triangles[0]);
    triangles_of(&packed.mesh, triangles[1]);
    assert_memory_equal(triangles[0], triangles[1], sizeof triangles[0]);
    float worst[4] = {0};
    static vec3s posed[2][PATCH_VERTICES];
    assert_int_equal(packed.mesh.vertex_count, PATCH_VERTICES);
    assert_int_equal(packed.clip_count, 1);
    tl_model_pose(&plain, 0, 0.6, posed[0]);
    tl_model_pose(&packed, 0, 0.6, posed[1]);
    for (size_t i = 0; i < PATCH_VERTICES; i++) {
        uint32_t k = origin_of(packed.mesh.uvs[i]);
        assert_true(k < PATCH_VERTICES);
        worst[0] = fmaxf(worst[0], glms_vec3_distance(packed.mesh.positions[i], plain.mesh.positions[k]));
        worst[1] = fmaxf(worst[1], glms_vec3_distance(packed.mesh.normals[i], plain.mesh.normals[k]));
        worst[2] = fmaxf(worst[2], glms_vec2_distance(packed.mesh.uvs[i], plain.mesh.uvs[k]));
        worst[3] = fmaxf(worst[3], glms_vec3_distance(posed[1][i], posed[0][k]));
    }
    printf("%s: positions within %.2g m, normals %.2g, UVs %.2g, poses %.2g m\n", name, (double)worst[0],
           (double)worst[1], (double)worst[2], (double)worst[3]);
    assert_true(worst[0] <= tolerance.position_m && worst[1] <= tolerance.normal &&
                worst[2] <= tolerance.uv && worst[3] <= tolerance.pose_m);
    tl_model_release(&plain);
    tl_model_release(&packed);
}

/* A coordinate of b bits over an extent of 1 is off by half a step, 2^-(b+1), a vector of three by its root
 * of three times that. Octahedral normals of 10 bits: two steps of 2^-9 of the square, at most twice that on
 * the sphere. Weights of 12 bits move a point by less than their error times the distance between the joints'
 * poses. */
static const struct tolerance draco = {1.8f / (1 << 15), 4.0f / (1 << 9), 1.5f / (1 << 13), 4e-4f};

static void draco_by_edgebreaker(void **state)
{
    (void)state;
    check_same("edgebreaker.glb", DRACO_EDGEBREAKER, draco);
}

static void draco_in_sequence(void **state)
{
    (void)state;
    check_same("sequential.glb", DRACO_SEQUENTIAL, draco);
}

static void meshopt_without_filters_is_exact(void **state)
{
    (void)state;
    check_same("meshopt.glb", MESHOPT_PLAIN, (struct tolerance){0, 0, 0, 0});
}

/* Exponential with 15 bits, sign included: a coordinate up to 1 has a step of 2^-13 at most and is off by
 * half of it. A byte of a normal is off by a half of 1/127, and decoding rounds once more. Quaternions of 12
 * bits turn by less than 2^-10 rad, and no point is more than 1.2 m from the joint. */
static void meshopt_with_filters(void **state)
{
    (void)state;
    check_same("filters.glb", MESHOPT_FILTERS,
               (struct tolerance){1.8f / (1 << 14), 2.0f / 127, 1.5f / (1 << 14), 1.3f / (1 << 10)});
}

/* ---- Broken streams ---- */

static bool try_packed(struct outcome *outcome, const char *path)
{
    tl_model model;
    tl_error error = {0};
    bool loaded = tl_model_load(path, &model, &error);
    count_outcome(outcome, path, loaded, &error);
    for (size_t i = 0; loaded && i < model.mesh.index_count; i++)
        assert_true(model.mesh.indices[i] < model.mesh.vertex_count);
    for (size_t i = 0; loaded && i < model.mesh.vertex_count; i++)
        assert_true(isfinite(glms_vec3_norm(model.mesh.positions[i])));
    tl_model_release(&model);
    return loaded;
}

static void damaged_streams(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum packing packing;
    } files[] = {{"damaged edgebreaker.glb", DRACO_EDGEBREAKER},
                 {"damaged sequential.glb", DRACO_SEQUENTIAL},
                 {"damaged meshopt.glb", MESHOPT_PLAIN},
                 {"damaged filters.glb", MESHOPT_FILTERS}};
    struct patch patch = patch_make();
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        struct packed_glb *glb = packed_make(&patch, files[i].packing);
        size_t size;
        uint8_t *bytes = packed_bytes(glb, &size);
        mutate(files[i].name, bytes, size, 400, false, try_packed);
        mutate(files[i].name, bytes, size, 100, true, try_packed);
        free(bytes);
        free(glb);
    }
}

/* Loads the file with one piece of JSON exchanged: it must be refused with `reason`. */
static void refuse(enum packing packing, const char *from, const char *to, const char *reason)
{
    struct patch patch = patch_make();
    struct packed_glb *glb = packed_make(&patch, packing);
    char json[sizeof glb->json], *at = strstr(glb->json, from);
    assert_non_null(at);
    snprintf(json, sizeof json, "%.*s%s%s", (int)(at - glb->json), glb->json, to, at + strlen(from));
    memcpy(glb->json, json, sizeof json);
    const char *path = scratch("claims.glb");
    packed_write(glb, path);
    free(glb);
    tl_model model;
    tl_error error = {0};
    if (tl_model_load(path, &model, &error))
        print_error("%s: loaded\n", to);
    assert_int_equal(error.code, TL_INPUT);
    if (!strstr(error.message, reason))
        print_error("%s: refused with \"%s\"\n", to, error.message);
    assert_non_null(strstr(error.message, reason));
    tl_model_release(&model);
}

static void false_claims(void **state)
{
    (void)state;
    enum packing m = MESHOPT_PLAIN, f = MESHOPT_FILTERS;
    refuse(m, "\"mode\":\"ATTRIBUTES\"", "\"mode\":\"OTHER\"", "mode or filter");
    refuse(m, "\"filter\":\"NONE\"", "\"filter\":\"COLOR\"", "mode or filter");
    refuse(m, "\"filter\":\"NONE\"", "\"filter\":\"QUATERNION\"", "does not fit");
    refuse(m, "\"count\":425,\"byteStride\":12", "\"count\":425,\"byteStride\":260", "not allowed");
    refuse(m, "\"count\":425,\"byteStride\":12", "\"count\":425,\"byteStride\":0", "not allowed");
    refuse(m, "\"count\":425,\"byteStride\":12", "\"count\":460,\"byteStride\":12", "is damaged");
    refuse(m, "\"count\":425,\"byteStride\":12", "\"count\":16000000,\"byteStride\":12",
           "are allowed for a file of");
    refuse(m, "\"count\":425,\"byteStride\":12", "\"count\":-1,\"byteStride\":12", "too many");
    refuse(m, "\"count\":2304,\"byteStride\":4", "\"count\":2303,\"byteStride\":4", "whole triangles");
    refuse(f, "\"count\":2304,\"byteStride\":2", "\"count\":2304,\"byteStride\":3", "not allowed");
    refuse(m, "{\"buffer\":0,\"byteOffset\":0,", "{\"buffer\":1,\"byteOffset\":0,", "cut short");
    refuse(m, "{\"buffer\":0,\"byteOffset\":0,", "{\"buffer\":7,\"byteOffset\":0,", "does not exist");
    refuse(DRACO_EDGEBREAKER, "\"bufferView\":0,\"attributes\"", "\"bufferView\":9,\"attributes\"",
           "does not exist");
    refuse(DRACO_EDGEBREAKER, "\"bufferView\":0,\"attributes\"", "\"bufferView\":1,\"attributes\"",
           "does not begin");
    refuse(DRACO_EDGEBREAKER, "\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"WEIGHTS_0\":3,\"JOINTS_0\":4}}",
           "\"POSITION\":0,\"NORMAL\":11,\"TEXCOORD_0\":2,\"WEIGHTS_0\":3,\"JOINTS_0\":4}}", "lacks");
}

/* A stream that claims many faces is refused before memory is asked for. After the header (11 bytes) and the
 * byte of the traversal: varints of 8 million vertices and 16 million faces, no attribute seams, 16 million
 * symbols, no splits. Draco takes 400 MB for these. */
static void draco_claims_faces(void **state)
{
    (void)state;
    struct patch patch = patch_make();
    struct packed_glb *glb = packed_make(&patch, DRACO_EDGEBREAKER);
    static const uint8_t claim[] = {0x80, 0xa4, 0xe8, 0x03, 0x80, 0xc8, 0xd0,
                                    0x07, 0,    0x80, 0xc8, 0xd0, 0x07, 0};
    memcpy(glb->binary + 12, claim, sizeof claim);
    const char *path = scratch("faces.glb");
    packed_write(glb, path);
    free(glb);
    tl_model model;
    tl_error error = {0};
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    assert_false(tl_model_load(path, &model, &error));
    assert_non_null(strstr(error.message, "cannot be decoded"));
    tl_model_release(&model);
#ifndef __SANITIZE_ADDRESS__
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 16L * 1024);
#endif
}

/* An attribute of 100 numbers, which a stream can have for as many points as it likes. */
static void draco_with_large_points(void **state)
{
    (void)state;
    struct patch patch = patch_make();
    struct packed_glb *glb = packed_make(&patch, DRACO_LARGE_POINTS);
    const char *path = scratch("points.glb");
    packed_write(glb, path);
    free(glb);
    tl_model model;
    tl_error error = {0};
    assert_false(tl_model_load(path, &model, &error));
    assert_non_null(strstr(error.message, "cannot be decoded"));
    tl_model_release(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draco_by_edgebreaker),
        cmocka_unit_test(draco_in_sequence),
        cmocka_unit_test(meshopt_without_filters_is_exact),
        cmocka_unit_test(meshopt_with_filters),
        cmocka_unit_test(false_claims),
        cmocka_unit_test(draco_claims_faces),
        cmocka_unit_test(draco_with_large_points),
        cmocka_unit_test(damaged_streams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
