#include "app/measure/measure.h"

#include "config/base/memory.h"

#include <math.h>

const struct tl_setup tl_setup_reference = {.assignments = {"light.method=reference", "light.lobe=dual"}};

bool tl_setup_apply(const struct tl_setup *setup, const struct tl_settings *scene, struct tl_settings *out,
                    tl_error *error)
{
    *out = *scene;
    if (setup->preset && !tl_settings_apply_preset(out, setup->preset, error))
        return false;
    out->image = scene->image; /* a preset is compared by its light, at one resolution */
    /* Light that the scene leaves out is not in the reference either. */
    if (out->light.bounce > scene->light.bounce)
        out->light.bounce = scene->light.bounce;
    out->light.reflect_scene = out->light.reflect_scene && scene->light.reflect_scene;
    return tl_settings_assign(out, setup->assignments, TL_COUNT(setup->assignments), error);
}

bool tl_variant_run_create(struct tl_variant_run *run, tl_gpu *gpu, const struct tl_setup *setup,
                           const struct tl_settings *scene, tl_error *error)
{
    *run = (struct tl_variant_run){0};
    struct tl_settings chosen;
    if (!tl_setup_apply(setup, scene, &chosen, error))
        return false;
    run->settings = tl_settings_render(&chosen);
    run->renderer = tl_renderer_create(gpu, error);
    return run->renderer != NULL;
}

void tl_variant_run_release(struct tl_variant_run *run)
{
    tl_renderer_destroy(&run->renderer);
    *run = (struct tl_variant_run){0};
}

bool tl_variant_run_has_history(const struct tl_variant_run *run)
{
    const struct tl_light_params *light = &run->settings.light;
    return light->visibility == TL_VISIBILITY_RAYS || light->jitter;
}

bool tl_variant_run_draw(struct tl_variant_run *run, const tl_frame *frame, struct tl_taken *taken,
                         tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool drawn = tl_renderer_draw(run->renderer, frame, &run->settings, error);
    *taken = tl_stopwatch_read(&watch);
    return drawn;
}

bool tl_reference_frame_draw(struct tl_variant_run *reference, const tl_frame *frame,
                             struct tl_reference_frame *out, tl_error *error)
{
    struct tl_taken unused;
    if (!tl_variant_run_draw(reference, frame, &unused, error) ||
        !tl_renderer_read(reference->renderer, &out->image, error))
        return false;
    out->standard_error = tl_renderer_standard_error(reference->renderer);
    return !frame->aovs || (tl_renderer_show_image(reference->renderer, &out->shown, error) &&
                            tl_renderer_read_garment(reference->renderer, &out->garment, error));
}

void tl_reference_frame_release(struct tl_reference_frame *reference)
{
    tl_image_release(&reference->image);
    tl_image_release(&reference->shown);
    tl_image_release(&reference->garment);
    reference->standard_error = 0;
}

bool tl_reference_frame_compare(const tl_image *image, const tl_image *shown,
                                const struct tl_reference_frame *reference, struct tl_measured_error *out,
                                tl_error *error)
{
    struct tl_comparison result;
    if (!tl_image_compare(image, &reference->image, -1, 0, &result, error))
        return false;
    double square = result.rel_rmse * result.rel_rmse - reference->standard_error * reference->standard_error;
    *out = (struct tl_measured_error){.rel_rmse = sqrt(fmax(square, 0)),
                                      .standard_error = reference->standard_error,
                                      .flip_mean = result.flip_mean,
                                      .max_abs = result.max_abs,
                                      .worst_share = result.worst_share,
                                      .covered = result.covered,
                                      .garment = {.flip_mean = NAN, .flip_worst = NAN}};
    return !reference->garment.texels ||
           tl_image_compare_object(shown, &reference->shown, &reference->garment, 0, &out->garment, error);
}

bool tl_variant_run_compare(struct tl_variant_run *run, const struct tl_reference_frame *reference,
                            struct tl_measured_error *out, tl_error *error)
{
    tl_image image = {0}, shown = {0};
    bool done = tl_renderer_read(run->renderer, &image, error) &&
                (!reference->garment.texels || tl_renderer_show_image(run->renderer, &shown, error)) &&
                tl_reference_frame_compare(&image, &shown, reference, out, error);
    tl_image_release(&image);
    tl_image_release(&shown);
    return done;
}
