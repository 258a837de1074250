#include "assets/model.h"

#include "assets/avatar.h"
#include "assets/garment.h"
#include "assets/model_export.h"
#include "config/base/memory.h"

#include "config/colour/srgb.h"
#include "tests/assets/small_glb.h"
#include "tests/testing.h"

#include <dirent.h>
#include <glob.h>
#include <string.h>

static tl_model load(const char *path)
{
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(path, &model, &error), error);
    return model;
}

static tl_model load_data(const char *relative)
{
    return load(test_data(relative));
}

static bool ignores(const tl_model *model, const char *what)
{
    size_t count = 0;
    for (size_t i = 0; i < model->ignored_count; i++)
        count += strcmp(model->ignored[i], what) == 0;
    assert_true(count <= 1);
    return count == 1;
}

/* ---- A file made here, of which every number is known ---- */

static const char *small_path(void)
{
    static const char path[] = TOILE_SCRATCH_DIR "/model_small.glb";
    struct small_glb glb = small_glb_make();
    small_glb_write(&glb, path);
    return path;
}

static void small_geometry(void **state)
{
    (void)state;
    tl_model model = load(small_path());
    assert_string_equal(model.name, "model_small.glb");
    assert_int_equal(model.mesh.vertex_count, 4); /* two primitives share them */
    assert_int_equal(model.mesh.part_count, 2);
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    assert_int_equal(model.mesh.index_count, 6);
    assert_memory_equal(model.mesh.indices, indices, sizeof indices);
    /* the node's own translation is not a skinned mesh's [glTF 2.0, 3.7.3.3]; vertex 3 is sparse */
    const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, uvs[] = {0, 1, 1, 1, 1, 0, 0, 0};
    assert_memory_equal(model.mesh.positions, positions, sizeof positions);
    assert_memory_equal(model.mesh.uvs, uvs, sizeof uvs);
    for (int i = 0; i < 4; i++)
        assert_near(model.mesh.normals[i].z, 1, 1e-6);
    for (int i = 0; i < 2; i++)
        assert_near(model.mesh.parts[i].uv_metres, 1, 1e-6);
    assert_int_equal(model.ignored_count, 0);
    tl_model_release(&model);
}

/* In inches the rest pose and every pose of a clip are 0.0254 times as large; a vertex is its own point. */
static void given_units_scale_poses(void **state)
{
    (void)state;
    tl_model metres = load(small_path()), inches;
    tl_error error = {0};
    assert_ok(tl_model_load_in(small_path(), TL_UNITS_IN, &inches, &error), error);
    for (int clip = -1; clip < 1; clip++) {
        vec3s large[4], small[4], points[4];
        tl_model_pose(&metres, clip, 1.5, large);
        tl_model_pose(&inches, clip, 1.5, small);
        tl_model_points(&inches, small, points);
        for (int i = 0; i < 4; i++) {
            assert_near(glms_vec3_distance(glms_vec3_scale(large[i], 0.0254f), small[i]), 0, 1e-8);
            assert_near(glms_vec3_distance(large[i], points[i]), 0, 1e-6);
        }
    }
    assert_int_equal(tl_model_point_count(&inches), 4);
    tl_model_release(&metres);
    tl_model_release(&inches);
}

static void small_materials(void **state)
{
    (void)state;
    tl_model model = load(small_path());
    assert_int_equal(model.material_count, 3);
    const tl_material *cloth = &model.materials[0], *metal = &model.materials[1];
    assert_string_equal(cloth->name, "cloth");
    assert_near(cloth->diffuse.y, 0.25, 1e-6);
    assert_near(cloth->specular.y, 0.04, 1e-6);
    /* roughness 0.5: alpha 0.25, Phong exponent (2 / 0.0625 - 2) / 4 = 7.5 */
    assert_near(cloth->glossiness, 1 - 1 / 7.5, 1e-6);
    assert_near(cloth->alpha_cutoff, 0.25, 1e-6);
    assert_true(cloth->double_sided && !metal->double_sided);
    assert_non_null(cloth->diffuse_map.image);
    assert_int_equal(tl_image_bytes(cloth->diffuse_map.image)[1], 250);
    /* metallic and roughness are 1 where a file says nothing */
    assert_near(metal->diffuse.x, 0, 1e-6);
    assert_near(metal->specular.x, 0.5, 1e-6);
    assert_near(metal->glossiness, 0, 1e-6);
    assert_near(metal->alpha_cutoff, 0, 0);
    tl_model_release(&model);
}

/* The small model with another second material. */
static tl_model load_with_material(const char *material)
{
    static const char path[] = TOILE_SCRATCH_DIR "/model_material.glb";
    struct small_glb glb = small_glb_make();
    small_glb_set_material(&glb, material);
    small_glb_write(&glb, path);
    return load(path);
}

/* The image is grey, 10 250 / 30 200: roughness times the factor. */
static void gloss_maps_are_exact_where_glossiest(void **state)
{
    (void)state;
    tl_model model =
        load_with_material("{\"name\":\"satin\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
                           "\"roughnessFactor\":0.5,\"metallicRoughnessTexture\":{\"index\":0}}}");
    const tl_material *satin = &model.materials[1];
    const uint8_t green[] = {10, 250, 30, 200};
    assert_non_null(satin->gloss_map.image);
    assert_near(satin->glossiness, tl_glossiness_from_roughness(0.5f * 10 / 255), 0);
    for (int i = 0; i < 4; i++) {
        float expected = tl_glossiness_from_roughness(0.5f * green[i] / 255);
        float map = (float)tl_image_bytes(satin->gloss_map.image)[i] / 255;
        assert_near(satin->glossiness * map, expected, 0.5 / 255);
    }
    tl_model_release(&model);
}

/* The small GLB with another picture of 2 x 2 texels. */
static tl_model load_with_picture(uint8_t *texels, int channels, const char *material)
{
    struct small_glb glb = small_glb_make();
    tl_image image = {.width = 2, .height = 2, .channels = channels, .type = TL_IMAGE_U8, .texels = texels};
    void *png;
    size_t size;
    tl_error error;
    assert_ok(tl_image_encode_png("picture", &image, &png, &size, &error), error);
    small_glb_set_material(&glb, material);
    assert_true(SMALL_PICTURE + size <= sizeof glb.binary);
    small_put(&glb, SMALL_PICTURE, png, size);
    glb.binary_size = (SMALL_PICTURE + size + 3) / 4 * 4;
    free(png);
    char *view = strstr(glb.json, "\"byteOffset\":404,"); /* the last of the file, before the buffer */
    assert_non_null(view);
    snprintf(view, 128, "\"byteOffset\":404,\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu}]}", size,
             glb.binary_size);
    const char *path = scratch("picture.glb");
    small_glb_write(&glb, path);
    return load(path);
}

static void alpha_factors_go_into_the_cutoff(void **state)
{
    (void)state;
    tl_model model = load_with_material("{\"name\":\"mesh\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3,"
                                        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.6]}}");
    assert_near(model.materials[1].alpha_cutoff, 0.5, 1e-6);
    tl_model_release(&model);
}

/* Blending is c = alpha * surface + (1 - alpha) * behind, which is what openness does. */
static void blending_opens_the_surface(void **state)
{
    (void)state;
    tl_model model = load_with_material("{\"name\":\"glass\",\"alphaMode\":\"BLEND\","
                                        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.3]}}");
    assert_near(model.materials[1].openness, 0.7, 1e-6);
    assert_near(model.materials[1].alpha_cutoff, 0, 0);
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
    /* its texture has no alpha: closed, as opaque */
    model = load_with_material("{\"name\":\"print\",\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":"
                               "{\"baseColorTexture\":{\"index\":0}}}");
    assert_near(model.materials[1].openness, 0, 0);
    assert_near(model.materials[1].alpha_cutoff, 0, 0);
    tl_model_release(&model);
    /* An open surface that also lets light straight through: what is behind is seen through either. */
    model =
        load_with_material("{\"name\":\"both\",\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{"
                           "\"baseColorFactor\":[1,1,1,0.5],\"roughnessFactor\":0,\"metallicFactor\":0},"
                           "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.6}}}");
    assert_near(model.materials[1].openness, 1 - 0.5 * 0.4, 1e-6);
    tl_model_release(&model);
}

/* Texels of alpha 0, 60, 100 and 120, of 255: the first two are cut away, the others have their mean. */
static void alpha_of_a_texture(void **state)
{
    (void)state;
    static const uint8_t alphas[4] = {0, 59, 100, 120};
    uint8_t texels[16];
    for (int i = 0; i < 16; i++)
        texels[i] = i % 4 == 3 ? alphas[i / 4] : 200;
    tl_model model =
        load_with_picture(texels, 4,
                          "{\"name\":\"veil\",\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{"
                          "\"baseColorFactor\":[1,1,1,0.5],\"baseColorTexture\":{\"index\":0}}}");
    assert_near(model.materials[1].alpha_cutoff, 60.0 / 255, 1e-6);
    assert_near(model.materials[1].openness, 1 - 0.5 * 110 / 255, 1e-6);
    assert_int_equal(model.approximated_count, 1);
    tl_model_release(&model);
}

static void emission_is_radiance(void **state)
{
    (void)state;
    tl_model model = load_with_material(
        "{\"name\":\"led\",\"emissiveFactor\":[1,0.5,0.25],\"emissiveTexture\":{\"index\":0},"
        "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":6}}}");
    const tl_material *led = &model.materials[1];
    assert_near(led->emission.x, 6, 1e-6);
    assert_near(led->emission.y, 3, 1e-6);
    assert_near(led->emission.z, 1.5, 1e-6);
    assert_non_null(led->emission_map.image);
    assert_false(led->emission_map.image->linear);
    assert_true(tl_material_emits(led));
    assert_false(tl_material_emits(&model.materials[0]));
    assert_int_equal(model.ignored_count, 0);
    tl_model_release(&model);
}

/* Texels of metalness 0, 85, 170 and 255 of 255: kd and F0 of each follow glTF's mix. */
static void metalness_of_a_texture(void **state)
{
    (void)state;
    uint8_t texels[12] = {0};
    for (int i = 0; i < 4; i++)
        texels[3 * i + 2] = (uint8_t)(85 * i);
    tl_model model = load_with_picture(texels, 3,
                                       "{\"name\":\"lame\",\"pbrMetallicRoughness\":{\"baseColorFactor\":"
                                       "[0.5,0.25,1,1],\"metallicRoughnessTexture\":{\"index\":0}}}");
    const tl_material *lame = &model.materials[1];
    static const float base[3] = {0.5f, 0.25f, 1};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++) {
            float m = (float)i / 3, step = 0.5f / 255;
            float kd = lame->diffuse.raw[c] *
                       tl_srgb_to_linear((float)tl_image_bytes(lame->diffuse_map.image)[3 * i + c] / 255);
            float f0 = lame->specular.raw[c] *
                       tl_srgb_to_linear((float)tl_image_bytes(lame->specular_map.image)[3 * i + c] / 255);
            assert_near(tl_srgb_from_linear(kd), tl_srgb_from_linear(base[c] * (1 - m)), step);
            assert_near(tl_srgb_from_linear(f0), tl_srgb_from_linear(0.04f * (1 - m) + base[c] * m), step);
        }
    assert_int_equal(model.approximated_count + model.ignored_count, 0);
    tl_model_release(&model);
}

static void metals_have_coloured_reflection(void **state)
{
    (void)state;
    tl_model model =
        load_with_material("{\"name\":\"gilt\",\"pbrMetallicRoughness\":{"
                           "\"baseColorFactor\":[1,0.5,0.25,1],\"baseColorTexture\":{\"index\":0}}}");
    const tl_material *gilt = &model.materials[1];
    assert_near(gilt->diffuse.x, 0, 0);
    assert_near(gilt->specular.y, 0.5, 1e-6);
    assert_non_null(gilt->specular_map.image);
    assert_ptr_equal(gilt->specular_map.image, gilt->diffuse_map.image);
    tl_model_release(&model);
}

/* The clip turns joint 1, to which vertices 2 and 3 are bound, by 90 degrees about z from 1 s to 2 s. */
static void small_clip(void **state)
{
    (void)state;
    tl_model model = load(small_path());
    assert_int_equal(model.clip_count, 1);
    assert_int_equal(tl_model_find_clip(&model, "turn"), 0);
    assert_int_equal(tl_model_find_clip(&model, ""), 0);
    assert_int_equal(tl_model_find_clip(&model, "Turn"), -1);
    assert_near(model.clips[0].duration_s, 2, 1e-6);
    const double times_s[] = {0, 0.5, 1, 1.25, 1.5, 2 - 1e-9, 3.5, -0.5};
    const double turns_deg[] = {0, 0, 0, 22.5, 45, 90, 45, 45}; /* held before the first key; loops */
    for (size_t i = 0; i < TL_COUNT(times_s); i++) {
        vec3s posed[4];
        tl_model_pose(&model, 0, times_s[i], posed);
        double angle = turns_deg[i] * M_PI / 180;
        assert_near(posed[1].x, 1, 1e-6);
        assert_near(posed[2].x, cos(angle) - sin(angle), 1e-6);
        assert_near(posed[2].y, sin(angle) + cos(angle), 1e-6);
        assert_near(posed[3].x, -sin(angle), 1e-6);
    }
    vec3s rest[4];
    tl_model_pose(&model, -1, 1.5, rest);
    assert_memory_equal(rest, model.mesh.positions, sizeof rest);
    tl_model_release(&model);
}

/* ---- glTF Asset Generator ---- */

static void every_conformance_file_loads(void **state)
{
    (void)state;
    char pattern[1200];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/*/*.gltf", test_data("gltf-conformance"));
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    size_t without_triangles = 0;
    for (size_t i = 0; i < found.gl_pathc; i++) {
        tl_model model;
        tl_error error;
        bool loaded = tl_model_load(found.gl_pathv[i], &model, &error);
        if (!loaded) {
            assert_non_null(strstr(error.message, "no mesh with triangles"));
            without_triangles++;
            continue;
        }
        tl_model_release(&model);
    }
    assert_int_equal(without_triangles, 3); /* points, a line loop, a line strip */
    globfree(&found);
}

static void primitive_modes(void **state)
{
    (void)state;
    /* a square as strip, triangles, and fan, without and with indices */
    const char *const files[] = {"04", "06", "11", "12", "15"};
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        char relative[128];
        snprintf(relative, sizeof relative, "gltf-conformance/Mesh_PrimitiveMode/Mesh_PrimitiveMode_%s.gltf",
                 files[i]);
        tl_model model = load_data(relative);
        assert_int_equal(model.mesh.index_count, 6);
        vec3s area = {{0, 0, 0}};
        for (size_t k = 0; k < 6; k += 3) {
            const uint32_t *v = &model.mesh.indices[k];
            vec3s a = model.mesh.positions[v[0]];
            area = glms_vec3_add(area, glms_vec3_cross(glms_vec3_sub(model.mesh.positions[v[1]], a),
                                                       glms_vec3_sub(model.mesh.positions[v[2]], a)));
        }
        assert_near(glms_vec3_norm(area), 2, 1e-5); /* a unit square, both halves wound the same way */
        tl_model_release(&model);
    }
}

/* Expects the rest pose scaled, turned about y and moved, at one time of the only clip. */
static void check_pose(const tl_model *model, double time_s, float scale, double turn_deg, vec3s move)
{
    size_t count = model->mesh.vertex_count;
    vec3s *posed = TL_NEW_ARRAY(vec3s, count);
    tl_model_pose(model, 0, time_s, posed);
    for (size_t i = 0; i < count; i++) {
        vec3s p = glms_vec3_scale(model->mesh.positions[i], scale);
        float c = cosf((float)(turn_deg * M_PI / 180)), s = sinf((float)(turn_deg * M_PI / 180));
        vec3s expected = glms_vec3_add((vec3s){{c * p.x + s * p.z, p.y, c * p.z - s * p.x}}, move);
        assert_near(glms_vec3_distance(posed[i], expected), 0, 1e-5);
    }
    free(posed);
}

static vec3s shift(double x, double y)
{
    return (vec3s){{(float)x, (float)y, 0}};
}

static void interpolations(void **state)
{
    (void)state;
    tl_model turned = load_data("gltf-conformance/Animation_Node/Animation_Node_01.gltf");
    check_pose(&turned, 0, 1, 90, shift(0, 0));
    check_pose(&turned, 0.5, 1, 45, shift(0, 0)); /* slerp at half way, and elsewhere */
    check_pose(&turned, 1.25, 1, -22.5, shift(0, 0));
    check_pose(&turned, 4 + 1.25, 1, -22.5, shift(0, 0));
    tl_model_release(&turned);
    tl_model scaled = load_data("gltf-conformance/Animation_Node/Animation_Node_02.gltf");
    check_pose(&scaled, 0.25, 0.9f, 0, shift(0, 0));
    check_pose(&scaled, 1.5, 1, 0, shift(0, 0));
    tl_model_release(&scaled);
    tl_model stepped = load_data("gltf-conformance/Animation_Node/Animation_Node_03.gltf");
    check_pose(&stepped, 0.99, 1, 0, shift(-0.1, 0));
    check_pose(&stepped, 1, 1, 0, shift(0, 0));
    check_pose(&stepped, 2.5, 1, 0, shift(0.1, 0));
    tl_model_release(&stepped);
    tl_model splined = load_data("gltf-conformance/Animation_Node/Animation_Node_04.gltf");
    for (int i = 0; i <= 8; i++) { /* flat tangents: 3 t^2 - 2 t^3 */
        double t = i / 8.0;
        check_pose(&splined, t, 1, 0, shift(-0.1 + 0.2 * (3 * t * t - 2 * t * t * t), 0));
    }
    tl_model_release(&splined);
    tl_model both = load_data("gltf-conformance/Animation_NodeMisc/Animation_NodeMisc_02.gltf");
    check_pose(&both, 0, 1, 90, shift(0, -0.1)); /* before the first keys, and after the last of one */
    check_pose(&both, 3, 1, -90, shift(0, 0));
    check_pose(&both, 5.5, 1, 90, shift(0, -0.05));
    tl_model_release(&both);
}

/* Skin_02 is Skin_03 with a rotated mesh node below a root that is rotated alike; a skin ignores its node
 * [glTF 2.0, 3.7.3.3]. */
static void a_skin_ignores_its_node(void **state)
{
    (void)state;
    tl_model plain = load_data("gltf-conformance/Animation_Skin/Animation_Skin_03.gltf");
    tl_model turned = load_data("gltf-conformance/Animation_Skin/Animation_Skin_02.gltf");
    assert_int_equal(plain.mesh.vertex_count, turned.mesh.vertex_count);
    for (size_t i = 0; i < plain.mesh.vertex_count; i++)
        assert_near(glms_vec3_distance(plain.mesh.positions[i], turned.mesh.positions[i]), 0, 1e-6);
    tl_model_release(&plain);
    tl_model_release(&turned);
}

/* ---- Real models ---- */

/* Mirrored nodes must not turn triangles inside out: the file's normals give the outside. */
static void winding_agrees_with_normals(void **state)
{
    (void)state;
    const char *const files[] = {"models/NegativeScaleTest.glb", "models/OrientationTest.glb",
                                 "models/NormalTangentTest.glb", "avatars/CesiumMan.glb"};
    for (size_t f = 0; f < TL_COUNT(files); f++) {
        tl_model model = load_data(files[f]);
        const tl_mesh *mesh = &model.mesh;
        size_t inside_out = 0;
        for (size_t i = 0; i < mesh->index_count; i += 3) {
            const uint32_t *v = &mesh->indices[i];
            vec3s a = mesh->positions[v[0]];
            vec3s area = glms_vec3_cross(glms_vec3_sub(mesh->positions[v[1]], a),
                                         glms_vec3_sub(mesh->positions[v[2]], a));
            vec3s normal =
                glms_vec3_add(mesh->normals[v[0]], glms_vec3_add(mesh->normals[v[1]], mesh->normals[v[2]]));
            inside_out += glms_vec3_dot(area, normal) < 0;
        }
        printf("%s: %zu of %zu triangles against their normals\n", files[f], inside_out,
               mesh->index_count / 3);
        assert_true(inside_out * 200 <= mesh->index_count / 3); /* slivers of real meshes may differ */
        tl_model_release(&model);
    }
}

static void bodies_have_plausible_sizes(void **state)
{
    (void)state;
    const struct {
        const char *file;
        double height_m;
    } people[] = {{"avatars/CesiumMan.glb", 1.5},
                  {"avatars/mannequiny.glb", 1.79},
                  {"avatars/quaternius_men_Casual.glb", 1.87},
                  {"avatars/mh_female_body.glb", 1.6},
                  {"avatars/mh_male_body.glb", 1.8}};
    for (size_t i = 0; i < TL_COUNT(people); i++) {
        tl_avatar avatar;
        tl_error error;
        assert_ok(tl_avatar_load(test_data(people[i].file), &avatar, &error), error);
        struct tl_box box = tl_box_of(avatar.model.mesh.positions, avatar.model.mesh.vertex_count);
        assert_near(box.upper.y - box.lower.y, people[i].height_m, 0.02);
        assert_near(box.lower.y, 0, 0.01);
        assert_true(box.upper.z - box.lower.z < 0.6f);
        tl_avatar_release(&avatar);
    }
}

/* A walk: the lowest point is always near the ground, never below it, and the last pose joins the first. */
static void cesium_man_walks(void **state)
{
    (void)state;
    tl_model man = load_data("avatars/CesiumMan.glb");
    size_t count = man.mesh.vertex_count;
    vec3s *posed = TL_NEW_ARRAY(vec3s, count), *again = TL_NEW_ARRAY(vec3s, count);
    assert_int_equal(man.clip_count, 1);
    assert_near(man.clips[0].duration_s, 2, 1e-3);
    float lowest = 1, highest_sole = -1;
    for (int i = 0; i < 40; i++) {
        tl_model_pose(&man, 0, i / 20.0, posed);
        struct tl_box box = tl_box_of(posed, count);
        lowest = fminf(lowest, box.lower.y);
        highest_sole = fmaxf(highest_sole, box.lower.y);
        assert_near(box.upper.y, 1.5, 0.08);
    }
    printf("soles between %.3f and %.3f m\n", (double)lowest, (double)highest_sole);
    assert_true(lowest > -0.05f && highest_sole < 0.05f);
    tl_model_pose(&man, 0, 0.3, posed);
    tl_model_pose(&man, 0, 0.3 + 3 * man.clips[0].duration_s, again);
    for (size_t i = 0; i < count; i++)
        assert_near(glms_vec3_distance(posed[i], again[i]), 0, 1e-5);
    tl_model_pose(&man, -1, 0.3, posed);
    assert_memory_equal(posed, man.mesh.positions, count * sizeof *posed);
    free(posed);
    free(again);
    tl_model_release(&man);
}

static void garments_have_plausible_sizes(void **state)
{
    (void)state;
    tl_garment garment;
    tl_error error;
    assert_ok(tl_garment_load(test_data("garments/mh_male_casualsuit06.glb"), &garment, &error), error);
    assert_int_equal(garment.model.mesh.vertex_count, 4035);
    assert_int_equal(garment.model.mesh.index_count, 3 * 7168);
    /* an atlas of some square metres of cloth */
    assert_true(garment.model.mesh.parts[0].uv_metres > 0.5f && garment.model.mesh.parts[0].uv_metres < 5);
    tl_garment_release(&garment);
    const char *const bodies[] = {"avatars/mh_female_body.glb", "avatars/mh_male_body.glb"};
    for (size_t i = 0; i < TL_COUNT(bodies); i++) {
        tl_model body = load_data(bodies[i]);
        assert_int_equal(body.mesh.vertex_count, 14517);
        assert_int_equal(body.mesh.index_count, 3 * 26756);
        tl_model_release(&body);
    }
}

static void ignored_features_are_listed_once(void **state)
{
    (void)state;
    static const char *const expected[][5] = {
        {"models/SheenChair/SheenChair.gltf", "TEXCOORD_1 and beyond"},
        {"models/GlamVelvetSofa.glb", "KHR_lights_punctual"},
        {"models/VertexColorTest.glb", "vertex colours"},
        {"models/TextureTransformMultiTest.glb", "KHR_materials_unlit"},
    };
    for (size_t f = 0; f < TL_COUNT(expected); f++) {
        tl_model model = load_data(expected[f][0]);
        for (size_t i = 1; i < TL_COUNT(expected[f]) && expected[f][i]; i++)
            assert_true(ignores(&model, expected[f][i]));
        tl_model_release(&model);
    }
    tl_model spheres = load_data("models/MetalRoughSpheresNoTextures.glb");
    assert_int_equal(spheres.ignored_count, 0);
    tl_model_release(&spheres);
}

static void texture_transforms_are_kept(void **state)
{
    (void)state;
    tl_model model = load_data("models/TextureTransformMultiTest.glb");
    size_t changed = 0;
    for (size_t i = 0; i < model.material_count; i++) {
        const struct tl_map *map = &model.materials[i].diffuse_map;
        changed += map->image && (map->transform.scale[0] != 1 || map->transform.offset[0] != 0 ||
                                  map->transform.rotation != 0);
    }
    assert_true(changed > 0);
    tl_model_release(&model);
}

/* ---- Export ---- */

struct exported {
    tl_model model;
    vec4s *tangents;
    tl_surface surface;
};

static struct exported make_exported(const char *path)
{
    struct exported e = {.model = load(path)};
    const tl_mesh *mesh = &e.model.mesh;
    e.tangents = TL_NEW_ARRAY(vec4s, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        e.tangents[i] = (vec4s){{1, 0, 0, 1}};
    e.surface = tl_surface_of_mesh("garment", mesh, NULL);
    e.surface.tangents = e.tangents;
    return e;
}

static void release_exported(struct exported *e)
{
    free(e->tangents);
    tl_model_release(&e->model);
}

/* Roughness is stored in steps of 1/255. g = 1 - 2 r^4 / (1 - r^4) is steepest, 8 r^3 / (1 - r^4)^2 = 7.9,
 * where it leaves 0 (r^4 = 1/3); r is at most half a step off, and the map that is read back another half. */
static void check_glossiness(const tl_material *a, const tl_material *b)
{
    const tl_image *first = a->gloss_map.image, *second = b->gloss_map.image;
    if (!first || !second) {
        assert_true(!first && !second);
        assert_near(b->glossiness, a->glossiness, 1e-4);
        return;
    }
    size_t texels = (size_t)first->width * (size_t)first->height;
    for (size_t i = 0; i < texels; i++) {
        double before = (double)a->glossiness * tl_image_bytes(first)[i] / 255;
        double after = (double)b->glossiness * tl_image_bytes(second)[i] / 255;
        assert_near(after, before, (7.9 / 2 + 0.5) / 255);
    }
}

static void check_round_trip(const char *from)
{
    static const char path[] = TOILE_SCRATCH_DIR "/model_exported.glb";
    struct exported e = make_exported(from);
    e.surface.materials = e.model.materials;
    tl_error error;
    assert_ok(tl_model_export_glb(path, &e.surface, 1, &error), error);
    tl_model back = load(path);
    const tl_mesh *old = &e.model.mesh, *new = &back.mesh;
    assert_int_equal(new->vertex_count, old->vertex_count);
    assert_int_equal(new->index_count, old->index_count);
    assert_int_equal(new->part_count, old->part_count);
    assert_memory_equal(new->positions, old->positions, old->vertex_count * sizeof *old->positions);
    assert_memory_equal(new->uvs, old->uvs, old->vertex_count * sizeof *old->uvs);
    assert_memory_equal(new->indices, old->indices, old->index_count * sizeof *old->indices);
    for (size_t i = 0; i < old->vertex_count; i++) /* normalised again: the last bits may change */
        assert_near(glms_vec3_distance(new->normals[i], old->normals[i]), 0, 1e-6);
    for (size_t i = 0; i < old->part_count; i++) {
        const tl_material *a = &e.model.materials[old->parts[i].material];
        const tl_material *b = &back.materials[new->parts[i].material];
        assert_string_equal(b->name, a->name);
        assert_true(b->double_sided == a->double_sided);
        assert_near(b->alpha_cutoff, a->alpha_cutoff, 1e-6);
        assert_near(b->openness, a->openness, 1e-6);
        for (int c = 0; c < 3; c++)
            assert_near(b->emission.raw[c], a->emission.raw[c], 1e-6 * (1 + (double)a->emission.raw[c]));
        assert_true(!b->emission_map.image == !a->emission_map.image);
        check_glossiness(a, b);
        assert_true(!b->diffuse_map.image == !a->diffuse_map.image);
        if (a->diffuse_map.image && b->diffuse_map.image)
            assert_memory_equal(b->diffuse_map.image->texels, a->diffuse_map.image->texels,
                                (size_t)a->diffuse_map.image->width * (size_t)a->diffuse_map.image->height *
                                    (size_t)a->diffuse_map.image->channels);
    }
    tl_model_release(&back);
    release_exported(&e);
}

static void exports_round_trip(void **state)
{
    (void)state;
    check_round_trip(small_path());
    static const char path[] = TOILE_SCRATCH_DIR "/model_material.glb";
    tl_model veil =
        load_with_material("{\"name\":\"veil\",\"alphaMode\":\"BLEND\",\"emissiveFactor\":[1,0.5,0],"
                           "\"emissiveTexture\":{\"index\":0},\"extensions\":{"
                           "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":3}},"
                           "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.3],"
                           "\"metallicFactor\":0}}");
    tl_model_release(&veil);
    check_round_trip(path);
    check_round_trip(test_data("avatars/CesiumMan.glb"));
    check_round_trip(test_data("models/SheenChair/SheenChair.gltf"));
}

static size_t count_files(const char *folder)
{
    size_t count = 0;
    DIR *stream = opendir(folder);
    assert_non_null(stream);
    while (readdir(stream))
        count++;
    closedir(stream);
    return count;
}

static void failed_exports_leave_no_file(void **state)
{
    (void)state;
    struct exported e = make_exported(small_path());
    e.surface.materials = e.model.materials;
    size_t before = count_files(TOILE_SCRATCH_DIR);
    tl_error error;
    assert_false(tl_model_export_glb("/dev/full", &e.surface, 1, &error));
    assert_non_null(strstr(error.message, "/dev/full"));
    assert_false(tl_model_export_glb(TOILE_SCRATCH_DIR "/no such folder/a.glb", &e.surface, 1, &error));
    assert_non_null(strstr(error.message, "no such folder"));
    /* a map that is not 8-bit cannot become PNG, which is found when the file is already begun */
    float texel = 1;
    tl_image wrong = {.width = 1, .height = 1, .channels = 1, .type = TL_IMAGE_F32, .texels = &texel};
    e.model.materials[0].normal_map.image = &wrong;
    assert_false(tl_model_export_glb(TOILE_SCRATCH_DIR "/model_failed.glb", &e.surface, 1, &error));
    assert_int_equal(count_files(TOILE_SCRATCH_DIR), before);
    release_exported(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_geometry),
        cmocka_unit_test(given_units_scale_poses),
        cmocka_unit_test(small_materials),
        cmocka_unit_test(gloss_maps_are_exact_where_glossiest),
        cmocka_unit_test(alpha_factors_go_into_the_cutoff),
        cmocka_unit_test(blending_opens_the_surface),
        cmocka_unit_test(alpha_of_a_texture),
        cmocka_unit_test(emission_is_radiance),
        cmocka_unit_test(metalness_of_a_texture),
        cmocka_unit_test(metals_have_coloured_reflection),
        cmocka_unit_test(small_clip),
        cmocka_unit_test(every_conformance_file_loads),
        cmocka_unit_test(primitive_modes),
        cmocka_unit_test(interpolations),
        cmocka_unit_test(a_skin_ignores_its_node),
        cmocka_unit_test(winding_agrees_with_normals),
        cmocka_unit_test(bodies_have_plausible_sizes),
        cmocka_unit_test(cesium_man_walks),
        cmocka_unit_test(garments_have_plausible_sizes),
        cmocka_unit_test(ignored_features_are_listed_once),
        cmocka_unit_test(texture_transforms_are_kept),
        cmocka_unit_test(exports_round_trip),
        cmocka_unit_test(failed_exports_leave_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
