#include "app/measure/measure.h"

#include "config/memory.h"
#include "render/metrics/compare.h"

#include <math.h>

bool tl_setup_apply(const struct tl_setup *choice, const struct tl_settings *scene, struct tl_settings *out,
                    tl_error *error)
{
    *out = *scene;
    if (choice->preset && !tl_settings_apply_preset(out, choice->preset, error))
        return false;
    out->image = scene->image; /* a preset is measured for its light */
    return tl_settings_assign(out, choice->assignments, TL_COUNT(choice->assignments), error);
}

bool tl_variant_run_create(struct tl_variant_run *variant, tl_gpu *gpu, const struct tl_setup *choice,
                           const struct tl_settings *scene, tl_error *error)
{
    *variant = (struct tl_variant_run){.name = choice->name};
    struct tl_settings chosen;
    if (!tl_setup_apply(choice, scene, &chosen, error))
        return false;
    variant->settings = tl_settings_render(&chosen);
    variant->renderer = tl_renderer_create(gpu, error);
    return variant->renderer != NULL;
}

void tl_variant_run_release(struct tl_variant_run *variant)
{
    tl_renderer_destroy(&variant->renderer);
    *variant = (struct tl_variant_run){0};
}

bool tl_variant_run_has_history(const struct tl_variant_run *variant)
{
    const struct tl_light_params *light = &variant->settings.light;
    return light->visibility == TL_VISIBILITY_RAYS || light->jitter;
}

bool tl_variant_run_draw(struct tl_variant_run *variant, const tl_frame *frame, struct tl_taken *taken,
                         tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool drawn = tl_renderer_draw(variant->renderer, frame, &variant->settings, error);
    *taken = tl_stopwatch_read(&watch);
    return drawn;
}

struct tl_setup tl_reference_settings(void)
{
    return (struct tl_setup){.name = "reference",
                             .assignments = {"light.method=reference", "light.lobe=dual"}};
}

bool tl_reference_frame_draw(struct tl_variant_run *oracle, const tl_frame *frame,
                             struct tl_reference_frame *out, tl_error *error)
{
    struct tl_taken unused;
    if (!tl_variant_run_draw(oracle, frame, &unused, error) ||
        !tl_renderer_read(oracle->renderer, &out->image, error))
        return false;
    out->standard_error = tl_renderer_standard_error(oracle->renderer);
    return true;
}

void tl_reference_frame_release(struct tl_reference_frame *truth)
{
    tl_image_release(&truth->image);
    truth->standard_error = 0;
}

bool tl_reference_frame_compare(const tl_image *image, const struct tl_reference_frame *truth,
                                struct tl_measured_error *out, tl_error *error)
{
    struct tl_comparison result;
    if (!tl_image_compare(image, &truth->image, -1, 0, &result, error))
        return false;
    double square = result.rel_rmse * result.rel_rmse - truth->standard_error * truth->standard_error;
    *out = (struct tl_measured_error){.rel_rmse = sqrt(fmax(square, 0)),
                                      .standard_error = truth->standard_error,
                                      .flip_mean = result.flip_mean,
                                      .max_abs = result.max_abs,
                                      .worst_share = result.worst_share,
                                      .covered = result.covered};
    return true;
}

bool tl_variant_run_compare(struct tl_variant_run *variant, const struct tl_reference_frame *truth,
                            struct tl_measured_error *out, tl_error *error)
{
    tl_image image = {0};
    bool done = tl_renderer_read(variant->renderer, &image, error) &&
                tl_reference_frame_compare(&image, truth, out, error);
    tl_image_release(&image);
    return done;
}
