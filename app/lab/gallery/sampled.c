#include "app/lab/gallery/sampled.h"

#include "config/base/file.h"
#include "render/brdf/tables/factor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SAMPLES 20000

/* Threads and fibres are not sampled. */
static struct tl_brdf model_of(const struct tl_material_params *params)
{
    tl_material material = tl_material_default("sampled");
    material.glossiness = params->glossiness;
    material.gloss = (struct tl_gloss){.model = params->model,
                                       .facets = params->facets,
                                       .masking = params->masking,
                                       .ward = params->ward,
                                       .fresnel = params->fresnel,
                                       .index = params->index,
                                       .extinction = params->extinction,
                                       .width_weft = params->width_weft,
                                       .width_warp = params->width_warp};
    const vec3s f0 = {{params->specular[0], params->specular[1], params->specular[2]}};
    return tl_brdf_of(&material, f0, params->glossiness);
}

static void print_samples(FILE *out, const struct tl_material_params *params)
{
    const struct tl_brdf model = model_of(params);
    struct tl_reflectance_samples samples = tl_brdf_model_samples(&model, SAMPLES);
    fprintf(out, "l_x, l_y, l_z, v_x, v_y, v_z, r, g, b\n");
    for (size_t i = 0; i < samples.count; i++) {
        const struct tl_reflectance_sample *at = &samples.items[i];
        fprintf(out, "%.7f, %.7f, %.7f, %.7f, %.7f, %.7f", (double)at->l.x, (double)at->l.y, (double)at->l.z,
                (double)at->v.x, (double)at->v.y, (double)at->v.z);
        for (int c = 0; c < 3; c++)
            fprintf(out, ", %.6g", (double)at->value.raw[c] + (double)params->diffuse[c] / M_PI);
        fprintf(out, "\n");
    }
    tl_reflectance_samples_release(&samples);
}

bool tl_sampled_make(const struct tl_experiment_picture *picture, tl_error *error)
{
    bool saved = true;
    for (int object = 0; saved && object < TL_PICTURE_OBJECTS; object++) {
        struct tl_settings settings;
        struct tl_writer writer;
        char *path = tl_picture_file(picture, (enum tl_picture_object)object, "samples.txt");
        saved = tl_picture_settings(picture, (enum tl_picture_object)object, 64, true, &settings, error) &&
                tl_writer_begin(&writer, path, error);
        if (saved) {
            print_samples(writer.stream, &settings.material);
            saved = tl_writer_commit(&writer, error);
        }
        free(path);
    }
    return saved;
}
