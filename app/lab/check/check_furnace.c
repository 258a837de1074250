/* The furnace test: in white light from everywhere an unshadowed surface reflects its albedo, whatever its
 * shape. */
#include "app/lab/check/check_measures.h"
#include "config/base/memory.h"
#include "render/inside.h"

#include <math.h>
#include <stdlib.h>

/* The expected value of each pixel: the mean albedo of its samples. Pixels with more than two lobes are not
 * compared, because their albedo is not a sum of colours. */
struct albedo {
    float colour[3];
    bool is_known;
};

static bool is_two_lobes(const tl_material *material)
{
    return !tl_material_is_faceted(material) && !(material->coat > 0) && !tl_material_has_fuzz(material) &&
           !tl_material_shows_more(material);
}

static void add_sample(const struct tl_resources *inside, const tl_sample *sample, struct albedo *albedo)
{
    int lobe = inside->light_options.lobe, side = inside->size.options.supersample;
    vec3s colour = lobe == TL_LOBE_SINGLE
                       ? glms_vec3_lerp(sample->diffuse, sample->specular, sample->glossiness)
                       : glms_vec3_add(sample->diffuse, sample->specular);
    if (!is_two_lobes(tl_triangle_material(&inside->shapes.ranges, sample->triangle & ~TL_SAMPLE_BACK)))
        albedo->is_known = false;
    for (int c = 0; c < 3; c++)
        albedo->colour[c] += sample->cover * colour.raw[c] / (float)(side * side);
}

/* Reads the albedos from the G-buffer, of either back-end. New array. */
static struct albedo *find_albedos(const struct tl_resources *inside, int width, int height)
{
    struct albedo *albedos = TL_NEW_ARRAY(struct albedo, (size_t)width * (size_t)height);
    struct tl_samples samples = {0};
    for (int i = 0; i < width * height; i++)
        albedos[i].is_known = true;
    tl_samples_read(&inside->gbuffer, &inside->shapes.ranges, inside->camera.view.eye, &samples);
    int side = inside->size.options.supersample;
    for (size_t i = 0; i < samples.primary_count; i++) {
        int x = (int)samples.items[i].texel % samples.width / side;
        int y = height - 1 - (int)samples.items[i].texel / samples.width / side;
        add_sample(inside, &samples.items[i], &albedos[y * width + x]);
    }
    tl_samples_release(&samples);
    return albedos;
}

void tl_measure_furnace(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->white)
        return;
    const tl_image *image = checked->white_image;
    struct albedo *albedos =
        find_albedos(tl_renderer_frame_resources(checked->white), image->width, image->height);
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; albedos[i].is_known && c < 3; c++) {
            double off = fabs((double)tl_image_floats(image)[4 * i + c] - (double)albedos[i].colour[c]);
            if (tl_finding_add(finding, off))
                tl_finding_pixel(finding, i % image->width, i / image->width);
        }
    free(albedos);
}

void tl_measure_furnace_shadowed(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->white || !checked->white_shadowed)
        return;
    const tl_image *open = checked->white_image, *shadowed = checked->white_shadowed;
    for (int i = 0; i < 4 * open->width * open->height; i++) {
        double gain = (double)tl_image_floats(shadowed)[i] - (double)tl_image_floats(open)[i];
        if (i % 4 != 3 && tl_finding_add(finding, gain < 0 ? 0 : gain))
            tl_finding_pixel(finding, i / 4 % open->width, i / 4 / open->width);
    }
}
