/* A strip of four vertices with two morph targets, drawn by two nodes: one skinned and animated, one turned,
 * scaled and at rest with weights of its own. All positions follow from glTF's formulas. */
#include "assets/model.h"

#include "tests/assets/small_glb.h"
#include "tests/testing.h"

#include <math.h>

static const vec3s base[4] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}};
static const vec3s bulge[4] = {
    {{0, 0, 0.5f}}, {{0, 0, 1}}, {{0, 0, 1.5f}}, {{0, 0, 2}}}; /* the first target */
static const vec3s lift = {{0, 2, 0}};                         /* the second, of vertex 3 alone */
static const vec3s turn = {{3, 0, 0}};                         /* of normals, in the first target */

enum {
    AT_POSITIONS = 0,
    AT_NORMALS = 48,
    AT_BULGE = 96,
    AT_TURNS = 144,
    AT_LIFT_INDEX = 192,
    AT_LIFT = 196,
    AT_JOINTS = 208,
    AT_WEIGHTS = 224,
    AT_INDICES = 288,
    AT_TIMES = 300,
    AT_LINEAR = 312,
    AT_SPLINE = 336,
    AT_SHIFT = 408,
    BYTES = 444
};

/* Weights at 0, 1 and 2 s; for splines with tangents [in, value, out] for each key and both targets. */
static const float linear[3][2] = {{0, 0}, {1, 0}, {0.5f, 1}};
static const float spline[3][3][2] = {
    {{0, 0}, {0, 0}, {1, 0}}, {{0, 0}, {1, 0}, {0, 2}}, {{-1, 0}, {0.5f, 1}, {0, 0}}};

static const char *json_of(void)
{
    static char json[6000];
    int written = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],"
        "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"name\":\"still\"},{\"mesh\":0,\"weights\":[0.25,0.5],"
        "\"translation\":[10,0,0],\"scale\":[2,2,2],\"children\":[3]},{\"name\":\"moved\"}],"
        "\"skins\":[{\"joints\":[1,3],\"inverseBindMatrices\":10}],"
        "\"meshes\":[{\"weights\":[0,0],\"primitives\":[{\"mode\":5,\"indices\":6,\"attributes\":{"
        "\"POSITION\":0,"
        "\"NORMAL\":1,\"JOINTS_0\":4,\"WEIGHTS_0\":5},"
        "\"targets\":[{\"POSITION\":2,\"NORMAL\":3},{\"POSITION\":9,\"NORMAL\":13}]}]}],"
        "\"animations\":["
        "{\"name\":\"linear\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}},"
        "{\"sampler\":1,\"target\":{\"node\":3,\"path\":\"translation\"}}],"
        "\"samplers\":[{\"input\":7,\"output\":8},{\"input\":7,\"output\":11}]},"
        "{\"name\":\"step\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}],"
        "\"samplers\":[{\"input\":7,\"output\":8,\"interpolation\":\"STEP\"}]},"
        "{\"name\":\"spline\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}],"
        "\"samplers\":[{\"input\":7,\"output\":12,\"interpolation\":\"CUBICSPLINE\"}]}],"
        "\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":144,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":208,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":0,\"byteOffset\":224,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":0,\"byteOffset\":288,\"componentType\":5123,\"count\":4,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"byteOffset\":300,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"bufferView\":0,\"byteOffset\":312,\"componentType\":5126,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{"
        "\"bufferView\":0,"
        "\"byteOffset\":192,\"componentType\":5123},\"values\":{\"bufferView\":0,\"byteOffset\":196}}},"
        "{\"componentType\":5126,\"count\":2,\"type\":\"MAT4\",\"sparse\":{\"count\":2,\"indices\":{"
        "\"bufferView\":1,"
        "\"componentType\":5121},\"values\":{\"bufferView\":1,\"byteOffset\":4}}},"
        "{\"bufferView\":0,\"byteOffset\":408,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":336,\"componentType\":5126,\"count\":18,\"type\":\"SCALAR\"},"
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":444},{\"buffer\":0,\"byteOffset\":444,\"byteLength\":"
        "132}],"
        "\"buffers\":[{\"byteLength\":576}]}");
    assert_true((size_t)written < sizeof json);
    return json;
}

static struct small_glb make(void)
{
    struct small_glb glb = {.binary_size = 576};
    const vec3s normals[4] = {{{0, 0, 1}}, {{0, 0, 1}}, {{0, 0, 1}}, {{0, 0, 1}}},
                turns[4] = {turn, turn, turn, turn};
    const uint8_t joints[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, both[4] = {0, 1};
    const float weights[16] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f}, times_s[3] = {0, 1, 2};
    /* The second joint is at rest at (10, 0, 0) and scaled by 2: its bind matrix undoes that. */
    const float binds[32] = {1,    0, 0, 0, 0, 1,    0, 0, 0, 0, 1,    0, 0,  0, 0, 1,
                             0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, -5, 0, 0, 1};
    const float shift[9] = {0, 0, 0, 0, 0, 0, 0, 3, 0}; /* of the second joint, in units twice as large */
    const uint16_t indices[4] = {0, 1, 2, 3}, three = 3;
    small_put(&glb, AT_POSITIONS, base, sizeof base);
    small_put(&glb, AT_NORMALS, normals, sizeof normals);
    small_put(&glb, AT_BULGE, bulge, sizeof bulge);
    small_put(&glb, AT_TURNS, turns, sizeof turns);
    small_put(&glb, AT_LIFT_INDEX, &three, sizeof three);
    small_put(&glb, AT_LIFT, &lift, sizeof lift);
    small_put(&glb, AT_JOINTS, joints, sizeof joints);
    small_put(&glb, AT_WEIGHTS, weights, sizeof weights);
    small_put(&glb, AT_INDICES, indices, sizeof indices);
    small_put(&glb, AT_TIMES, times_s, sizeof times_s);
    small_put(&glb, AT_LINEAR, linear, sizeof linear);
    small_put(&glb, AT_SPLINE, spline, sizeof spline);
    small_put(&glb, AT_SHIFT, shift, sizeof shift);
    small_put(&glb, BYTES, both, sizeof both);
    small_put(&glb, BYTES + 4, binds, sizeof binds);
    snprintf(glb.json, sizeof glb.json, "%s", json_of());
    return glb;
}

static tl_model load(void)
{
    struct small_glb glb = make();
    const char *path = scratch("morphs.glb");
    small_glb_write(&glb, path);
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(path, &model, &error), error);
    assert_int_equal(model.mesh.vertex_count, 8);
    assert_int_equal(model.ignored_count, 0);
    return model;
}

/* A vertex before skinning. */
static vec3s morphed(int vertex, float first, float second)
{
    vec3s moved = glms_vec3_muladds(bulge[vertex], first, base[vertex]);
    return vertex == 3 ? glms_vec3_muladds(lift, second, moved) : moved;
}

static void assert_at(vec3s found, vec3s wanted)
{
    if (glms_vec3_distance(found, wanted) > 2e-5f)
        print_error("(%g %g %g) for (%g %g %g)\n", (double)found.x, (double)found.y, (double)found.z,
                    (double)wanted.x, (double)wanted.y, (double)wanted.z);
    assert_true(glms_vec3_distance(found, wanted) <= 2e-5f);
}

static void weights_at_rest(void **state)
{
    (void)state;
    tl_model model = load();
    for (int i = 0; i < 4; i++) {
        assert_at(model.mesh.positions[i], base[i]); /* of the mesh: zeros */
        assert_at(model.mesh.positions[4 + i],       /* of the node */
                  glms_vec3_add(glms_vec3_scale(morphed(i, 0.25f, 0.5f), 2), (vec3s){{10, 0, 0}}));
        assert_at(model.mesh.normals[i], (vec3s){{0, 0, 1}});
        assert_at(model.mesh.normals[4 + i], (vec3s){{0.6f, 0, 0.8f}}); /* (0, 0, 1) + (3, 0, 0) / 4 */
    }
    tl_model_release(&model);
}

/* The skinned node's vertices; the second joint, when it has moved by `shift_m`, has half of vertex 3 and all
 * of vertex 2. */
static void check_pose(const tl_model *model, const char *clip, double time_s, float first, float second,
                       float shift_m)
{
    vec3s posed[8];
    static const float shares[4] = {0, 0, 1, 0.5f};
    tl_model_pose(model, tl_model_find_clip(model, clip), time_s, posed);
    for (int i = 0; i < 4; i++)
        assert_at(posed[i], glms_vec3_add(morphed(i, first, second), (vec3s){{0, shares[i] * shift_m, 0}}));
    for (int i = 4; i < 8; i++)
        assert_at(posed[i], model->mesh.positions[i]); /* the other node has weights of its own */
}

static void weights_in_clips(void **state)
{
    (void)state;
    tl_model model = load();
    assert_int_equal(model.clip_count, 3);
    assert_float_equal(model.clips[1].duration_s, 2, 0);
    check_pose(&model, "linear", 0, 0, 0, 0);
    check_pose(&model, "linear", 0.25, 0.25f, 0, 0);
    check_pose(&model, "linear", 1.5, 0.75f, 0.5f, 3); /* half of 3, in units of 2 m */
    check_pose(&model, "linear", 3.5, 0.75f, 0.5f, 3); /* looped */
    check_pose(&model, "step", 0.99, 0, 0, 0);
    check_pose(&model, "step", 1.99, 1, 0, 0);
    /* Hermite, by hand: at the middle of a span of 1 s, (p0 + p1) / 2 + (out0 - in1) / 8. */
    check_pose(&model, "spline", 0.5, 0.5f + 0.125f, 0, 0);
    check_pose(&model, "spline", 1.5, 0.75f + 0.125f, 0.5f + 0.25f, 0);
    tl_model_release(&model);
}

/* ---- Broken files ---- */

static void refuse(const char *from, const char *to, const char *reason)
{
    struct small_glb glb = make();
    char json[sizeof glb.json], *at = strstr(glb.json, from);
    assert_non_null(at);
    snprintf(json, sizeof json, "%.*s%s%s", (int)(at - glb.json), glb.json, to, at + strlen(from));
    memcpy(glb.json, json, sizeof json);
    const char *path = scratch("broken morphs.glb");
    small_glb_write(&glb, path);
    tl_model model;
    tl_error error = {0};
    assert_false(tl_model_load(path, &model, &error));
    if (!strstr(error.message, reason))
        print_error("%s: %s\n", to, error.message);
    assert_non_null(strstr(error.message, reason));
    tl_model_release(&model);
}

static bool try_morphs(struct outcome *outcome, const char *path)
{
    tl_model model;
    tl_error error = {0};
    bool loaded = tl_model_load(path, &model, &error);
    count_outcome(outcome, path, loaded, &error);
    vec3s *posed = loaded ? TL_NEW_ARRAY(vec3s, model.mesh.vertex_count) : NULL;
    for (size_t clip = 0; loaded && clip < model.clip_count; clip++)
        tl_model_pose(&model, (int)clip, 0.7, posed);
    free(posed);
    tl_model_release(&model);
    return loaded;
}

static void broken_targets(void **state)
{
    (void)state;
    refuse("{\"POSITION\":2,", "{\"POSITION\":99,", "does not exist");
    refuse("{\"POSITION\":2,", "{\"POSITION\":11,", "3 for 4 vertices");
    refuse("{\"POSITION\":2,", "{\"POSITION\":6,", "are expected");
    refuse("\"NORMAL\":3}", "\"NORMAL\":11}", "3 for 4 vertices");
    refuse("\"input\":7,\"output\":8}", "\"input\":7,\"output\":7}", "3 times but 3 values, 2 each");
    struct small_glb glb = make();
    uint8_t bytes[16384];
    size_t size = small_glb_bytes(&glb, bytes);
    mutate("damaged morphs.glb", bytes, size, 1000, true, try_morphs);
    mutate("damaged morphs.glb", bytes, size, 1000, false, try_morphs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_at_rest),
        cmocka_unit_test(weights_in_clips),
        cmocka_unit_test(broken_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
