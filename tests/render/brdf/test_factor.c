/* Tables factored out of samples: a product that tables can hold, models of which the samples are made, gaps.
 * Row A15. */
#include "render/brdf/tables/factor.h"

#include "config/memory.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <time.h>

static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};

static struct tl_brdf brdf_of(int model, float weft, float warp)
{
    tl_material material = tl_material_default("test");
    material.glossiness = 0.9f;
    material.gloss = (struct tl_gloss){.model = model,
                                       .facets = TL_FACETS_BECKMANN,
                                       .width_weft = weft,
                                       .width_warp = warp,
                                       .index = 1.5f};
    return tl_brdf_of(&material, (vec3s){{0.3f, 0.2f, 0.1f}}, 0.9f);
}

/* Relative RMSE of f_r cos a at other pairs of directions than those of the samples. */
static double error_elsewhere(const struct tl_brdf *brdf, const struct tl_brdf_tables *tables)
{
    enum { SKIPPED = 50021, COUNT = 20000 };
    struct tl_reflectance_samples others = tl_brdf_model_samples(brdf, SKIPPED + COUNT);
    double off = 0, all = 0;
    for (size_t i = SKIPPED; i < others.count; i++) {
        float inputs[TL_AXIS_COUNT];
        const struct tl_reflectance_sample *at = &others.items[i];
        if (fminf(at->l.z, at->v.z) < 0.1f)
            continue;
        tl_brdf_inputs(&frame, at->l, at->v, inputs);
        vec3s wanted = glms_vec3_scale(at->value, at->l.z);
        off += (double)glms_vec3_norm2(glms_vec3_sub(tl_brdf_tables_gloss(tables, inputs), wanted));
        all += (double)glms_vec3_norm2(wanted);
    }
    tl_reflectance_samples_release(&others);
    return sqrt(off / all);
}

static void models_come_back(void **state)
{
    (void)state;
    static const int models[] = {TL_REFLECT_WARD, TL_REFLECT_TORRANCE_SPARROW, TL_REFLECT_PHONG, TL_REFLECT_BLINN_PHONG, TL_REFLECT_COSINE_LOBE};
    static const char *const names[] = {"ward", "torrance_sparrow", "phong", "blinn_phong", "cosine_lobe"};
    for (size_t m = 0; m < TL_COUNT(models); m++)
        for (int size = 32; size <= 128; size *= 2) {
            struct tl_brdf brdf = brdf_of(models[m], 0.3f, 0.15f);
            struct tl_reflectance_samples samples = tl_brdf_model_samples(&brdf, 40000);
            struct tl_factor_report report;
            clock_t start = clock();
            struct tl_brdf_tables tables = tl_brdf_tables_factor(&samples, size, &report);
            print_message("%s %d: samples %.4f, elsewhere %.4f, bridged %.2f, %.2f s\n", names[m], size, report.rel_rmse, error_elsewhere(&brdf, &tables),
                          report.bridged, (double)(clock() - start) / CLOCKS_PER_SEC);
            tl_brdf_tables_release(&tables);
            tl_reflectance_samples_release(&samples);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
