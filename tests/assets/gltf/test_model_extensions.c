#include "assets/model.h"
#include "assets/model_export.h"

#include "render/brdf/fuzz.h"
#include "tests/assets/small_glb.h"

/* The small model with `extensions` and other members of pbrMetallicRoughness in its second material, a
 * dielectric of base colour 0.8 0.6 0.4. */
static tl_model load_with(const char *pbr, const char *extensions)
{
    static const char path[] = TOILE_SCRATCH_DIR "/model_extensions.glb";
    char material[2048];
    snprintf(material, sizeof material,
             "{\"name\":\"cloth\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.6,0.4,1],%s},"
             "\"extensions\":{%s}}",
             pbr, extensions);
    struct small_glb glb = small_glb_make();
    small_glb_set_material(&glb, material);
    small_glb_write(&glb, path);
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(path, &model, &error), error);
    return model;
}

#define MATT "\"metallicFactor\":0,\"roughnessFactor\":0.5"

static size_t notes_with(const tl_model *model, const char *what)
{
    size_t count = 0;
    for (size_t i = 0; i < model->approximated_count; i++)
        count += strstr(model->approximated[i], what) != NULL;
    return count;
}

static void plain_materials_have_no_notes(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "");
    const tl_material *cloth = &model.materials[1];
    assert_int_equal(model.approximated_count, 0);
    assert_true(tl_gloss_has_tails(&cloth->gloss)); /* glTF's own model, as wide as it says */
    assert_near(cloth->gloss.width_weft, 0.25, 1e-6);
    assert_near(cloth->specular.y, 0.04, 1e-7);
    assert_true(cloth->coat == 0 && cloth->openness == 0 && cloth->transmission.x == 0);
    tl_model_release(&model);
}

/* alpha = 0.25; along the direction mix(alpha, 1, strength^2), across alpha; the direction from the tangent,
 * counter-clockwise. [KHR_materials_anisotropy, "Implementation notes"] */
static void anisotropy_becomes_ward(void **state)
{
    (void)state;
    tl_model model = load_with(
        MATT, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.6,\"anisotropyRotation\":1.25}");
    const struct tl_gloss *gloss = &model.materials[1].gloss;
    assert_int_equal(gloss->model, TL_REFLECT_WARD);
    assert_near(gloss->width_weft, 0.25 + 0.75 * 0.36, 1e-6);
    assert_near(gloss->width_warp, 0.25, 1e-6);
    assert_near(gloss->rotation, 1.25, 1e-6);
    assert_int_equal(notes_with(&model, "KHR_materials_anisotropy: shown by Ward"), 1);
    assert_int_equal(model.ignored_count, 0);
    tl_model_release(&model);
    model = load_with(MATT, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0}");
    assert_true(tl_gloss_has_tails(&model.materials[1].gloss));
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
}

static double ggx(double u, double v, const double l[3], const double w[3])
{
    double h[3] = {l[0] + w[0], l[1] + w[1], l[2] + w[2]}, square = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    double q = (h[0] * h[0] / (u * u) + h[1] * h[1] / (v * v) + h[2] * h[2]) / square;
    double towards = w[2] * sqrt(u * u * l[0] * l[0] + v * v * l[1] * l[1] + l[2] * l[2]);
    double away = l[2] * sqrt(u * u * w[0] * w[0] + v * v * w[1] * w[1] + w[2] * w[2]);
    return l[2] / (2 * M_PI * u * v * q * q * (towards + away));
}

static double ward(double u, double v, const double l[3], const double w[3])
{
    double x = (l[0] + w[0]) / (u * (l[2] + w[2])), y = (l[1] + w[1]) / (v * (l[2] + w[2]));
    return exp(-(x * x + y * y)) / (4 * M_PI * u * v) * sqrt(l[2] / w[2]);
}

/* The factor that brings Ward's lobe nearest to GGX, by least squares over 4 views by 3 azimuths. */
static double nearest_factor(double u, double v)
{
    const double views[] = {5, 30, 55, 70};
    double across = 0, square = 0;
    for (int i = 0; i < 12; i++) {
        double t = views[i % 4] * M_PI / 180, p = i % 3 * M_PI / 4;
        const double w[3] = {sin(t) * cos(p), sin(t) * sin(p), cos(t)};
        for (int k = 0; k < 90 * 180; k++) {
            double z = (k % 90 + 0.5) / 90, r = sqrt(1 - z * z), q = 2 * M_PI * k / (90 * 180);
            const double l[3] = {r * cos(q), r * sin(q), z};
            across += ggx(u, v, l, w) * ward(u, v, l, w);
            square += ward(u, v, l, w) * ward(u, v, l, w);
        }
    }
    return across / square;
}

static void ward_factor_is_the_best_fit_to_ggx(void **state)
{
    (void)state;
    const float strengths[] = {0.3f, 0.6f, 1}, roughnesses[] = {0.4f, 0.7f, 1};
    for (int i = 0; i < 9; i++) {
        char pbr[80], extension[80];
        snprintf(pbr, sizeof pbr, "\"metallicFactor\":0,\"roughnessFactor\":%g", (double)roughnesses[i / 3]);
        snprintf(extension, sizeof extension, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":%g}",
                 (double)strengths[i % 3]);
        tl_model model = load_with(pbr, extension);
        const tl_material *satin = &model.materials[1];
        double factor = nearest_factor((double)satin->gloss.width_weft, (double)satin->gloss.width_warp);
        assert_near(satin->specular.x / 0.04f, factor, 0.03); /* a line over the widths */
        tl_model_release(&model);
    }
}

/* The picture is grey, 10 250 / 30 200, mean 122.5: the mean direction is nearly zero, with equal
 * components, on the lower diagonal; the strength is multiplied by the mean; the variation is noted. */
static void anisotropy_takes_a_textures_mean(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1,"
                                     "\"anisotropyTexture\":{\"index\":0}}");
    const struct tl_gloss *gloss = &model.materials[1].gloss;
    double mean = 122.5 / 255;
    assert_near(gloss->rotation, -3 * M_PI / 4, 1e-3);
    assert_near(gloss->width_weft, 0.25 + 0.75 * mean * mean, 1e-5);
    assert_int_equal(notes_with(&model, "its direction or strength varies over a texture: its mean is used"),
                     1);
    tl_model_release(&model);
    model = load_with("\"metallicFactor\":0,\"metallicRoughnessTexture\":{\"index\":0}",
                      "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1}");
    assert_near(model.materials[1].gloss.width_warp, mean * mean, 1e-5);
    assert_int_equal(notes_with(&model, "roughness varies over a texture: its mean is used"), 1);
    tl_model_release(&model);
}

/* ((n - 1)/(n + 1))^2, times factor and colour; a metal's is its base colour regardless. */
static void index_and_specular_make_f0(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_ior\":{\"ior\":1.8}");
    assert_near(model.materials[1].specular.x, 0.8 * 0.8 / (2.8 * 2.8), 1e-6);
    assert_near(model.materials[1].gloss.index, 1.8, 1e-6);
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
    model = load_with(MATT, "\"KHR_materials_ior\":{\"ior\":0}");
    assert_near(model.materials[1].specular.x, 1, 1e-6); /* stands for infinity there */
    tl_model_release(&model);
    model = load_with(
        MATT, "\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularColorFactor\":[1,0.5,0]}");
    assert_near(model.materials[1].specular.x, 0.02, 1e-7);
    assert_near(model.materials[1].specular.y, 0.01, 1e-7);
    assert_near(model.materials[1].specular.z, 0, 0);
    assert_int_equal(notes_with(&model, "KHR_materials_specular: weakens reflection at normal incidence"), 1);
    tl_model_release(&model);
    model = load_with("\"metallicFactor\":1,\"roughnessFactor\":0.5", "\"KHR_materials_ior\":{\"ior\":1.8}");
    assert_near(model.materials[1].specular.x, 0.8, 1e-6);
    tl_model_release(&model);
}

static void specular_colours_are_maps(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_specular\":{\"specularColorTexture\":{\"index\":0,"
                                     "\"extensions\":{\"KHR_texture_transform\":{\"scale\":[3,2]}}}}");
    assert_non_null(model.materials[1].specular_map.image);
    assert_near(model.materials[1].specular_map.transform.scale[0], 3, 0);
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
}

static void clearcoat_is_a_coat(void **state)
{
    (void)state;
    tl_model model = load_with(
        MATT, "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.75,\"clearcoatRoughnessFactor\":0.3}");
    assert_near(model.materials[1].coat, 0.75, 1e-7);
    assert_near(model.materials[1].coat_glossiness, tl_glossiness_from_roughness(0.3f), 1e-7);
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
    model = load_with(MATT,
                      "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,\"clearcoatTexture\":{\"index\":0},"
                      "\"clearcoatNormalTexture\":{\"index\":0}}");
    assert_near(model.materials[1].coat, 122.5 / 255, 1e-5);
    assert_int_equal(notes_with(&model, "KHR_materials_clearcoat: its share varies over a texture"), 1);
    assert_int_equal(notes_with(&model, "follows the surface's own normals"), 1);
    tl_model_release(&model);
}

/* Transmitted light is not reflected: the two shares add up to the material's. */
static void diffuse_transmission_is_transmission(void **state)
{
    (void)state;
    tl_model model =
        load_with(MATT, "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.25,"
                        "\"diffuseTransmissionColorFactor\":[1,0.5,0]}");
    const tl_material *voile = &model.materials[1];
    assert_near(voile->diffuse.x, 0.8 * 0.75, 1e-6);
    assert_near(voile->transmission.x, 0.25, 1e-6);
    assert_near(voile->transmission.y, 0.125, 1e-6);
    assert_near(voile->transmission.z, 0, 0);
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
}

/* Half of the light passes a base of mean 0.6; at roughness 0.5 half of that goes straight. Surface and holes
 * together must reflect and transmit as much as glTF's sheet: kept x (diffuse, transmission) and the holes.
 */
static void transmission_is_holes_and_scatter(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5}");
    const tl_material *sheer = &model.materials[1];
    double kept = 1 - (double)sheer->openness;
    assert_near(sheer->openness, 0.5 * 0.5 * 0.6, 1e-6);
    assert_near(kept * (double)sheer->diffuse.x, 0.8 * 0.5, 1e-6);
    assert_near(kept * (double)sheer->specular.x, 0.04, 1e-7);
    assert_near(kept * (double)sheer->transmission.z, 0.4 * 0.5 * 0.5, 1e-6);
    assert_int_equal(notes_with(&model, "neither tinted nor bent"), 1);
    tl_model_release(&model);
    model = load_with("\"metallicFactor\":0,\"roughnessFactor\":0",
                      "\"KHR_materials_transmission\":{\"transmissionFactor\":1}");
    assert_near(model.materials[1].openness, 0.6, 1e-6);
    assert_near(model.materials[1].transmission.x, 0, 0);
    tl_model_release(&model);
}

/* Albedo of the "Charlie" sheen towards a view of cosine v, by the midpoint rule. */
static double sheen_albedo(double roughness, double v)
{
    enum { STEPS = 100 };
    double inverse = 1 / (roughness * roughness), sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        double l = (i / STEPS + 0.5) / STEPS, turn = M_PI * (i % STEPS + 0.5) / STEPS;
        double x = sqrt(1 - v * v) + sqrt(1 - l * l) * cos(turn), y = sqrt(1 - l * l) * sin(turn), z = v + l;
        double sine = sqrt((x * x + y * y) / (x * x + y * y + z * z));
        sum += (2 + inverse) * pow(sine, inverse) / (2 * M_PI) / (4 * (l + v - l * v)) * l;
    }
    return sum / (STEPS * STEPS) * 2 * M_PI;
}

#define VIEWS 20
/* Root mean square difference of the albedos, relative to the sheen's, over projected solid angle. */
static double differs_by(const double albedos[VIEWS], double amount, double roughness)
{
    double difference = 0, whole = 0;
    for (int i = 0; i < VIEWS; i++) {
        double v = (i + 0.5) / VIEWS;
        double own = amount * (double)fuzz_albedo((float)v, (float)roughness);
        difference += v * (own - albedos[i]) * (own - albedos[i]);
        whole += v * albedos[i] * albedos[i];
    }
    return sqrt(difference / whole);
}

/* Sheen becomes the fuzz whose albedo is nearest to its own, and leaves the rest of the material alone: both
 * scale it by what they leave. A search finds none that is nearer by more than the table's steps cost. */
static void sheen_becomes_fuzz(void **state)
{
    (void)state;
    for (int i = 6; i <= 20; i++) {
        char text[160];
        double roughness = i / 20.0, albedos[VIEWS], best = 1;
        snprintf(text, sizeof text,
                 "\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.5,0],\"sheenRoughnessFactor\":%g}",
                 roughness);
        tl_model model = load_with(MATT, text);
        const tl_material *velvet = &model.materials[1];
        double amount = (double)velvet->fuzz.colour.x;
        for (int k = 0; k < VIEWS; k++)
            albedos[k] = sheen_albedo(roughness, (k + 0.5) / VIEWS);
        for (int y = 40; y <= 100; y += 2)
            for (int a = 50; a <= 160; a += 2)
                best = fmin(best, differs_by(albedos, a / 100.0, y / 100.0));
        assert_near(differs_by(albedos, amount, (double)velvet->fuzz.roughness), best, 0.02);
        assert_true(best < 0.08);
        assert_near(velvet->fuzz.colour.y, amount / 2, 1e-6);
        assert_near(velvet->fuzz.colour.z, 0, 0);
        assert_near(velvet->diffuse.x, 0.8, 1e-6);
        assert_near(velvet->specular.z, 0.04, 1e-7);
        assert_int_equal(notes_with(&model, "KHR_materials_sheen: shown as fuzz"), 1);
        assert_true(amount * (double)fuzz_albedo(0, velvet->fuzz.roughness) <= 1);
        tl_model_release(&model);
    }
}

/* Khronos' wording: a sheen of black is none. */
static void black_sheen_is_none(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_sheen\":{\"sheenRoughnessFactor\":0.5}");
    assert_false(tl_material_has_fuzz(&model.materials[1]));
    assert_int_equal(model.approximated_count, 0);
    tl_model_release(&model);
}

/* Numbers outside every valid range. */
static void invalid_parameters_are_clamped(void **state)
{
    (void)state;
    static const char *const extensions[] = {
        "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1e300,\"anisotropyRotation\":\"left\"}",
        "\"KHR_materials_anisotropy\":[1,2]",
        "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1,\"anisotropyTexture\":{\"index\":77}}",
        "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":-3,\"clearcoatTexture\":7}",
        "\"KHR_materials_ior\":{\"ior\":-1}",
        "\"KHR_materials_sheen\":{\"sheenColorFactor\":[9,9],\"sheenRoughnessFactor\":-1}",
        "\"KHR_materials_sheen\":{\"sheenColorFactor\":[9,9,9],\"sheenRoughnessFactor\":0}",
        "\"KHR_materials_specular\":{\"specularFactor\":1e9,\"specularColorFactor\":[1e9,-1,0]}",
        "\"KHR_materials_transmission\":{\"transmissionFactor\":1e9}",
        "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":\"all\"}",
    };
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++) {
        tl_model model = load_with(MATT, extensions[i]);
        const tl_material *m = &model.materials[1];
        const float numbers[] = {m->diffuse.x,        m->specular.x, m->specular.y,
                                 m->transmission.x,   m->coat,       m->gloss.width_weft,
                                 m->gloss.width_warp, m->openness,   m->coat_glossiness};
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
            assert_true(numbers[k] >= 0 && numbers[k] <= 1);
        assert_true(isfinite(m->gloss.rotation) && m->openness < 1);
        tl_model_release(&model);
    }
}

/* A material survives reading, writing and reading: within single precision; the coat's roughness goes
 * through the fourth root of a glossiness. */
static void exports_round_trip(void **state)
{
    (void)state;
    static const char path[] = TOILE_SCRATCH_DIR "/model_extensions_exported.glb";
    static const char *const cases[][2] = {
        {MATT, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.6,\"anisotropyRotation\":1.25}"},
        {"\"metallicFactor\":1,\"roughnessFactor\":0.3",
         "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.9}"},
        {MATT, "\"KHR_materials_ior\":{\"ior\":1.8},\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.75,"
               "\"clearcoatRoughnessFactor\":0.3}"},
        {MATT, "\"KHR_materials_specular\":{\"specularColorFactor\":[1,0.5,0],\"specularColorTexture\":"
               "{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[3,2]}}}}"},
        {MATT, "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.3,1,0],\"sheenRoughnessFactor\":0.25}"},
        {MATT, "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.9,0.2,0.1],\"sheenRoughnessFactor\":0.97}"},
        {MATT, "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.25,"
               "\"diffuseTransmissionColorFactor\":[1,0.5,0]}"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tl_model model = load_with(cases[i][0], cases[i][1]), back;
        tl_error error;
        const tl_surface surface = tl_surface_of_mesh("cloth", &model.mesh, model.materials);
        assert_ok(tl_model_export_glb(path, &surface, 1, &error), error);
        assert_ok(tl_model_load(path, &back, &error), error);
        size_t last = back.material_count; /* of the materials "cloth" */
        while (last > 0 && strcmp(back.materials[last - 1].name, "cloth") != 0)
            last--;
        assert_true(last > 0);
        const tl_material *a = &model.materials[1], *b = &back.materials[last - 1];
        for (int c = 0; c < 3; c++) {
            assert_near(b->diffuse.raw[c], a->diffuse.raw[c], 2e-6);
            assert_near(b->specular.raw[c], a->specular.raw[c], 2e-6);
            assert_near(b->transmission.raw[c], a->transmission.raw[c], 2e-6);
            assert_near(b->fuzz.colour.raw[c], a->fuzz.colour.raw[c], 2e-6);
        }
        assert_near(b->fuzz.roughness, a->fuzz.roughness, 2e-6);
        assert_int_equal(b->gloss.model, a->gloss.model);
        assert_near(b->gloss.width_weft, a->gloss.width_weft, 2e-6);
        assert_near(b->gloss.width_warp, a->gloss.width_warp, 2e-6);
        assert_near(b->gloss.rotation, a->gloss.rotation, 2e-6);
        assert_near(b->gloss.index, a->gloss.index, 2e-6);
        assert_near(b->glossiness, a->glossiness, 2e-5);
        assert_near(b->coat, a->coat, 2e-6);
        assert_near(b->coat_glossiness, a->coat_glossiness, 2e-5);
        assert_true(!a->specular_map.image == !b->specular_map.image);
        assert_memory_equal(&b->specular_map.transform, &a->specular_map.transform,
                            sizeof a->specular_map.transform);
        tl_model_release(&back);
        tl_model_release(&model);
    }
}

/* Khronos' sample: seven strengths on the same spheres. */
static void real_files_are_read(void **state)
{
    (void)state;
    tl_model model;
    tl_error error;
    assert_ok(tl_model_load(test_data("models/AnisotropyStrengthTest.glb"), &model, &error), error);
    int ward = 0;
    for (size_t i = 0; i < model.material_count; i++)
        ward += model.materials[i].gloss.model == TL_REFLECT_WARD;
    assert_true(ward > 20);
    assert_true(notes_with(&model, "KHR_materials_anisotropy: shown by Ward") == 1);
    tl_model_release(&model);
    assert_ok(tl_model_load(test_data("models/SheenChair/SheenChair.gltf"), &model, &error), error);
    assert_true(notes_with(&model, "KHR_materials_sheen: shown as fuzz") == 1);
    tl_model_release(&model);
}

static const char *shown_as(const tl_model *model, const char *name)
{
    for (size_t i = 0; i < model->extension_count; i++)
        if (strcmp(model->extensions[i].name, name) == 0) {
            assert_int_equal(model->extensions[i].material, 1); /* of the two, the one that names them */
            return model->extensions[i].shown;
        }
    return "";
}

/* By material: what it names, and what becomes of that. */
static void extensions_of_a_material_are_listed(void **state)
{
    (void)state;
    tl_model model = load_with(MATT, "\"KHR_materials_ior\":{\"ior\":1.4},\"KHR_materials_iridescence\":{},"
                                     "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.5,0.5,0.5]},"
                                     "\"KHR_materials_specular\":{\"specularColorFactor\":[1,0.5,0.5]}");
    assert_int_equal(model.extension_count, 4);
    assert_string_equal(shown_as(&model, "KHR_materials_ior"), "exact");
    assert_string_equal(shown_as(&model, "KHR_materials_sheen"), "approximated");
    assert_string_equal(shown_as(&model, "KHR_materials_specular"), "exact"); /* a colour alone */
    assert_string_equal(shown_as(&model, "KHR_materials_iridescence"), "ignored");
    tl_model_release(&model);
    model = load_with(MATT, "\"KHR_materials_specular\":{\"specularFactor\":0.5}");
    assert_string_equal(shown_as(&model, "KHR_materials_specular"), "approximated");
    tl_model_release(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_materials_have_no_notes),
        cmocka_unit_test(anisotropy_becomes_ward),
        cmocka_unit_test(ward_factor_is_the_best_fit_to_ggx),
        cmocka_unit_test(anisotropy_takes_a_textures_mean),
        cmocka_unit_test(index_and_specular_make_f0),
        cmocka_unit_test(specular_colours_are_maps),
        cmocka_unit_test(clearcoat_is_a_coat),
        cmocka_unit_test(diffuse_transmission_is_transmission),
        cmocka_unit_test(transmission_is_holes_and_scatter),
        cmocka_unit_test(sheen_becomes_fuzz),
        cmocka_unit_test(black_sheen_is_none),
        cmocka_unit_test(invalid_parameters_are_clamped),
        cmocka_unit_test(exports_round_trip),
        cmocka_unit_test(real_files_are_read),
        cmocka_unit_test(extensions_of_a_material_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
