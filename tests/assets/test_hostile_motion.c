/* Broken OBJ files, MTL files and point caches. */
#include "assets/model.h"
#include "assets/motion/point_cache.h"

#include "tests/assets/hostile.h"

/* ---- Loading everything in a file ---- */

static bool try_object(struct outcome *outcome, const char *path)
{
    tl_model model;
    tl_error error = {0};
    bool loaded = tl_model_load(path, &model, &error);
    count_outcome(outcome, path, loaded, &error);
    for (size_t i = 0; i < model.mesh.vertex_count; i++) {
        assert_true(isfinite(glms_vec3_norm(model.mesh.positions[i])));
        assert_near(glms_vec3_norm(model.mesh.normals[i]), 1, 1e-4);
        assert_true(model.points[i] < model.point_count);
    }
    for (size_t i = 0; i < model.mesh.index_count; i++)
        assert_true(model.mesh.indices[i] < model.mesh.vertex_count);
    tl_model_release(&model);
    return loaded;
}

/* Opens, and reads every sample. */
static bool try_cache(struct outcome *outcome, const char *path)
{
    tl_error error = {0};
    tl_point_cache *cache = tl_point_cache_open(path, 0.01, &error);
    bool loaded = cache != NULL;
    const struct tl_point_cache_facts *facts = loaded ? tl_point_cache_facts(cache) : NULL;
    vec3s *points = TL_NEW_ARRAY(vec3s, loaded ? facts->point_count : 0);
    for (size_t s = 0; loaded && s < facts->sample_count; s++) {
        loaded = tl_point_cache_read(cache, (double)s, points, &error);
        for (size_t i = 0; loaded && i < facts->point_count; i++)
            assert_true(isfinite(glms_vec3_norm(points[i])));
        double position = tl_point_cache_position(cache, (double)s / 3, 30, 0);
        assert_true(position >= 0 && position <= (double)facts->sample_count - 1);
    }
    count_outcome(outcome, path, loaded, &error);
    free(points);
    tl_point_cache_destroy(&cache);
    return loaded;
}

/* ---- Small valid files ---- */

enum { POINTS = 4, SAMPLES = 3, CACHE_MAX = 256 };

static size_t cache_bytes(bool big_endian, uint8_t bytes[CACHE_MAX])
{
    tl_error error = {0};
    const char *path = scratch(big_endian ? "valid.mdd" : "valid.pc2");
    tl_point_cache_writer *writer = tl_point_cache_create(path, POINTS, SAMPLES, 0, 30, &error);
    assert_ok(writer != NULL, error);
    for (int s = 0; s < SAMPLES; s++) {
        vec3s points[POINTS];
        for (int i = 0; i < POINTS; i++)
            points[i] = (vec3s){{(float)i, 1.5f * (float)s, -7}};
        tl_point_cache_add(writer, points);
    }
    assert_ok(tl_point_cache_commit(&writer, &error), error);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, CACHE_MAX, stream);
    fclose(stream);
    return size;
}

static const char valid_object[] =
    "mtllib hostile_motion.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.25\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 1 0 0\no one\nusemtl red\n"
    "f 1/1/1 2/2/1 3/3/1 4/1/1\ng two\nusemtl blue\nf -4//2 -3//2 -1//2\nf 1 2 4\n";
static const char valid_material[] = "newmtl red\nKd 0.5 0.25 0.125\nKs 0.5 0.5 0.5\nNs 250\nillum 2\nd 1\n"
                                     "map_Kd -s 2 2 2 -o 0.5 0.5 red.png\nnewmtl blue\nKd 0 0 1\n";

static void write_material(void)
{
    scratch_write(scratch("hostile_motion.mtl"), valid_material, strlen(valid_material));
}

/* ---- False claims ---- */

struct change { /* at `offset`, these bytes */
    size_t offset, size;
    const char *bytes;
};

static void refuse_changes(const char *name, const uint8_t *valid, size_t size, const struct change *changes,
                           size_t count)
{
    const char *path = scratch(name);
    struct outcome outcome = {0};
    uint8_t bytes[CACHE_MAX] = {0};
    scratch_write(path, valid, size);
    assert_true(try_cache(&outcome, path));
    for (size_t i = 0; i < count; i++) {
        memcpy(bytes, valid, size);
        memcpy(bytes + changes[i].offset, changes[i].bytes, changes[i].size);
        scratch_write(path, bytes, size);
        if (try_cache(&outcome, path)) {
            print_error("%s: change %zu was taken\n", name, i);
            fail();
        }
    }
    memcpy(bytes, valid, size);
    bytes[size] = 0;
    scratch_write(path, bytes, size + 1); /* longer than it claims */
    assert_false(try_cache(&outcome, path));
    report(name, outcome);
}

static void pc2_with_false_claims_is_refused(void **state)
{
    (void)state;
    uint8_t valid[CACHE_MAX] = {0};
    size_t size = cache_bytes(false, valid);
    static const struct change changes[] = {
        {0, 1, "p"},                                         /* magic */
        {11, 1, "x"},                                        /* its end */
        {12, 4, "\2\0\0\0"},                                 /* version */
        {16, 4, "\0\0\0\0"},                                 /* points: none */
        {16, 4, "\5\0\0\0"},                                 /* ... too many */
        {16, 4, "\3\0\0\0"},                                 /* ... too few */
        {16, 4, "\377\377\377\377"},                         /* ... -1 */
        {16, 4, "\377\377\377\177"},                         /* ... huge */
        {20, 4, "\0\0\300\177"},                             /* start: NaN */
        {20, 4, "\0\0\200\177"},                             /* ... infinite */
        {24, 4, "\0\0\300\177"},                             /* rate: NaN */
        {24, 4, "\0\0\200\277"},                             /* ... -1 */
        {24, 4, "\0\0\0\0"},                                 /* ... 0 */
        {28, 4, "\0\0\0\0"},                                 /* samples: none */
        {28, 4, "\377\377\377\377"},                         /* ... -1 */
        {28, 4, "\377\377\377\177"},                         /* ... huge */
        {28, 4, "\4\0\0\0"},                                 /* ... one too many */
        {32, 4, "\0\0\300\177"},                             /* first number: NaN */
        {32 + 12 * POINTS * SAMPLES - 4, 4, "\0\0\200\377"}, /* last: -infinity */
        {32 + 12 * POINTS, 4, "\377\377\177\177"},           /* one in between: the largest float */
    };
    refuse_changes("lie.pc2", valid, size, changes, TL_COUNT(changes));
}

static void mdd_with_false_claims_is_refused(void **state)
{
    (void)state;
    uint8_t valid[CACHE_MAX] = {0};
    size_t size = cache_bytes(true, valid);
    static const struct change changes[] = {
        {0, 4, "\0\0\0\0"},                                  /* samples: none */
        {0, 4, "\0\0\0\4"},                                  /* ... one too many */
        {0, 4, "\377\377\377\377"},                          /* ... -1 */
        {0, 4, "\177\377\377\377"},                          /* ... huge */
        {4, 4, "\0\0\0\0"},                                  /* points: none */
        {4, 4, "\377\377\377\377"},                          /* ... -1 */
        {4, 4, "\0\377\377\377"},                            /* ... huge */
        {0, 8, "\3\0\0\0\4\0\0\0"},                          /* little endian */
        {8, 4, "\177\300\0\0"},                              /* times: NaN */
        {12, 4, "\177\200\0\0"},                             /* ... infinite */
        {12, 4, "\0\0\0\0"},                                 /* ... not rising */
        {16, 4, "\277\200\0\0"},                             /* ... falling */
        {20, 4, "\177\300\0\0"},                             /* first number: NaN */
        {20 + 12 * POINTS * SAMPLES - 4, 4, "\177\200\0\0"}, /* last: infinite */
    };
    refuse_changes("lie.mdd", valid, size, changes, TL_COUNT(changes));
}

static void objects_with_false_claims_are_refused(void **state)
{
    (void)state;
    static const char *const lies[] = {
        "",
        "hello world\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
        "f 1 2 3\n",
        "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 abc\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0,5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 1e400\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 -inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4294967299\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999999\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -99999999999999999999999\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3.5\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1/ 2/1/ 3/1/\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1/1/1 2/1 3/1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/-2 2/1 3/1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\",
    };
    const char *path = scratch("lie.obj");
    struct outcome outcome = {0};
    for (size_t i = 0; i < TL_COUNT(lies); i++) {
        scratch_write(path, lies[i], strlen(lies[i]));
        if (try_object(&outcome, path)) {
            print_error("taken:\n%s", lies[i]);
            fail();
        }
    }
    report("objects that lie", outcome);
}

/* Triangles without area, a face on one vertex, a mesh at one point: they are read, and every result is
 * finite. */
static void degenerate_objects_are_read(void **state)
{
    (void)state;
    static const char *const odd[] = {
        "v 0 0 0\nf 1 1 1\n",
        "v 1 1 1\nv 1 1 1\nv 1 1 1\nvn 0 0 0\nf 1//1 2//1 3//1 1//1 2//1\n",
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 1 2 3 1 2 3\n",
        "v 1e-40 0 0\nv 0 1e-42 0\nv 0 0 1e-45\nvn 1e-40 0 0\nf 1//1 2//1 3//1\n",
    };
    const char *path = scratch("odd.obj");
    struct outcome outcome = {0};
    for (size_t i = 0; i < TL_COUNT(odd); i++) {
        scratch_write(path, odd[i], strlen(odd[i]));
        assert_true(try_object(&outcome, path));
    }
}

static void large_faces_are_refused(void **state)
{
    (void)state;
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    for (int i = 0; i < 200000; i++)
        fprintf(stream, " %d", 1 + i % 3);
    fclose(stream);
    const char *path = scratch("large_face.obj");
    scratch_write(path, text, size);
    free(text);
    struct outcome outcome = {0};
    assert_false(try_object(&outcome, path));
}

/* A material that cannot be read is noted, and the shape is read. */
static void broken_materials_are_left_out(void **state)
{
    (void)state;
    static const char *const broken[] = {"newmtl red\nKd 1 x 0\n",
                                         "newmtl red\nNs nan\n",
                                         "\1\2\3",
                                         "newmtl red\nKs 1\n",
                                         "newmtl red\nmap_Kd red.png\n",
                                         "newmtl red\nmap_Kd -o\n",
                                         "newmtl red\nmap_Kd -s 1 2 3\nmap_Kd\nmap_d -clamp\n"};
    const char object[] = "mtllib broken_motion.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (size_t i = 0; i < TL_COUNT(broken); i++) {
        tl_model model;
        tl_error error = {0};
        scratch_write(scratch("broken_motion.mtl"), broken[i], strlen(broken[i]));
        scratch_write(scratch("broken_motion.obj"), object, strlen(object));
        assert_ok(tl_model_load(scratch("broken_motion.obj"), &model, &error), error);
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(model.materials[1].diffuse.raw[c]) &&
                        isfinite(model.materials[1].glossiness));
        assert_null(model.materials[1].diffuse_map.image);
        tl_model_release(&model);
    }
}

/* A frame with another number of vertices, one that is no OBJ, one that is missing. */
static void inconsistent_sequences_are_refused(void **state)
{
    (void)state;
    const char first[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const char *const seconds[] = {"v 0 0 0\nv 1 0 0\n",
                                          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n",
                                          "v 0 0 x\n",
                                          "",
                                          "junk\n",
                                          "v 0 0 nan\nv 1 0 0\nv 0 1 0\n",
                                          "v 0 0 1e20\nv 1 0 0\nv 0 1 0\n"};
    tl_error error = {0};
    scratch_write(scratch("seq.1.obj"), first, strlen(first));
    for (size_t i = 0; i < TL_COUNT(seconds); i++) {
        vec3s points[3];
        scratch_write(scratch("seq.2.obj"), seconds[i], strlen(seconds[i]));
        tl_point_cache *cache = tl_point_cache_open(scratch("seq.#.obj"), 1, &error);
        assert_ok(cache != NULL, error);
        assert_ok(tl_point_cache_read(cache, 0, points, &error), error);
        assert_false(tl_point_cache_read(cache, 1, points, &error));
        assert_int_equal(error.code, TL_INPUT);
        assert_false(tl_point_cache_read(cache, 0.5, points, &error));
        assert_ok(tl_point_cache_read(cache, 0, points, &error), error); /* still good */
        tl_point_cache_destroy(&cache);
    }
    static const char *const names[] = {"absent.#.obj", "seq.##########.obj", "seq.#.#.obj", "seq.1.obj",
                                        "a.txt"};
    for (size_t i = 0; i < TL_COUNT(names); i++)
        assert_null(tl_point_cache_open(scratch(names[i]), 1, &error));
    unlink(scratch("seq.1.obj"));
    unlink(scratch("seq.2.obj"));
}

/* ---- Truncated and damaged at every place ---- */

static void cut_anywhere(const char *name, const uint8_t *bytes, size_t size, try_function try, bool may_load)
{
    struct outcome outcome = {0};
    const char *path = scratch(name);
    for (size_t cut = 0; cut < size; cut++) {
        scratch_write(path, bytes, cut);
        if (try(&outcome, path) && !may_load) {
            print_error("%s: cut at %zu of %zu was taken\n", name, cut, size);
            fail();
        }
    }
    report(name, outcome);
}

static void truncated_files(void **state)
{
    (void)state;
    uint8_t bytes[CACHE_MAX] = {0};
    size_t size = cache_bytes(false, bytes);
    cut_anywhere("cut.pc2", bytes, size, try_cache, false);
    size = cache_bytes(true, bytes);
    cut_anywhere("cut.mdd", bytes, size, try_cache, false);
    write_material();
    cut_anywhere("cut.obj", (const uint8_t *)valid_object, strlen(valid_object), try_object, true);
}

static void mutated_files(void **state)
{
    (void)state;
    uint8_t bytes[CACHE_MAX] = {0};
    size_t size = cache_bytes(false, bytes);
    mutate("mutated.pc2", bytes, size, 1500, false, try_cache);
    size = cache_bytes(true, bytes);
    mutate("mutated.mdd", bytes, size, 1500, false, try_cache);
    write_material();
    const uint8_t *object = (const uint8_t *)valid_object;
    mutate("mutated.obj", object, strlen(valid_object), 1500, false, try_object);
    mutate("numbers.obj", object, strlen(valid_object), 1500, true, try_object);
}

/* The OBJ is intact, its materials are damaged. */
static bool try_material(struct outcome *outcome, const char *path)
{
    static const char object[] =
        "mtllib mutated.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl blue\nf 3 2 1\n";
    (void)path;
    const char *holder = scratch("material.obj");
    scratch_write(holder, object, strlen(object));
    return try_object(outcome, holder);
}

static void mutated_materials(void **state)
{
    (void)state;
    char path[1024];
    uint32_t seed = 20240229;
    struct outcome outcome = {0};
    snprintf(path, sizeof path, "%s", scratch("mutated.mtl"));
    for (int i = 0; i < 500; i++) {
        uint8_t bytes[sizeof valid_material];
        memcpy(bytes, valid_material, sizeof bytes);
        for (int changes = 0; changes < 3; changes++) {
            uint32_t at = next_random(&seed) % (uint32_t)(sizeof bytes - 1);
            bytes[at] = damaged(bytes[at], false, &seed);
        }
        scratch_write(path, bytes, sizeof bytes - 1);
        assert_true(try_material(&outcome, path));
    }
    report("mutated.mtl", outcome);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pc2_with_false_claims_is_refused),
        cmocka_unit_test(mdd_with_false_claims_is_refused),
        cmocka_unit_test(objects_with_false_claims_are_refused),
        cmocka_unit_test(degenerate_objects_are_read),
        cmocka_unit_test(large_faces_are_refused),
        cmocka_unit_test(broken_materials_are_left_out),
        cmocka_unit_test(inconsistent_sequences_are_refused),
        cmocka_unit_test(truncated_files),
        cmocka_unit_test(mutated_files),
        cmocka_unit_test(mutated_materials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
