#include "render/inspect/inspect.h"

#include "render/inspect/job.h"
#include "render/inspect/paint.h"
#include "render/renderer.h"

tl_bits tl_inspect_facts(int view)
{
    tl_bits facts = TL_BIT(TL_SCENE_RASTER) | TL_BIT(TL_SCENE_SAMPLES) | TL_BIT(TL_SCENE_INSPECT);
    if (tl_view_is_visibility(view))
        facts |= TL_BIT(TL_SCENE_RAYS) | TL_BIT(TL_SCENE_SHADOWS);
    return facts;
}

bool tl_inspect_averages(int view)
{
    return view == TL_VIEW_LIGHT || tl_view_is_visibility(view);
}

static struct tl_legend_source legend_source(const tl_renderer *renderer)
{
    const struct tl_image_params *image = &renderer->settings.image;
    int last = renderer->regions.count - 1;
    return (struct tl_legend_source){.view = (enum tl_image_view)image->view,
                                     .range = renderer->strain_range,
                                     .range_is_given = image->view_range > 0,
                                     .region = image->view_region < last ? image->view_region : last,
                                     .regions = &renderer->regions};
}

static void choose_range(tl_renderer *renderer)
{
    const struct tl_image_params *image = &renderer->settings.image;
    if (!tl_view_is_strain(image->view))
        return;
    renderer->strain_range = image->view_range > 0
                                 ? image->view_range / 100
                                 : tl_paint_strain_range(renderer->drawn, renderer->surface_count,
                                                         tl_view_strain_axis(image->view));
}

bool tl_inspect_run(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_frame_clear_light(renderer);
    choose_range(renderer);
    struct tl_legend_source source = legend_source(renderer);
    struct tl_legend legend;
    struct tl_seen_regions regions;
    tl_legend_make(&source, &legend);
    tl_seen_regions_make(&renderer->regions, renderer->frame.environment_yaw, &regions);
    struct tl_paint_request request = {.legend = &legend,
                                       .view = source.view,
                                       .samples = &renderer->samples,
                                       .ranges = &renderer->ranges,
                                       .eye = renderer->view.eye,
                                       .texel = 2 * glms_vec3_norm(renderer->view.up) /
                                                (float)renderer->samples.height,
                                       .regions = &regions,
                                       .region = source.region};
    if (tl_view_is_visibility(source.view)) {
        request.values = tl_points_values(renderer->points, &request.stride);
        request.taps = tl_points_taps(renderer->points);
    }
    tl_paint(&request, renderer->light);
    tl_lighting_set(&renderer->lighting, renderer->gpu, &renderer->gbuffer, renderer->light);
    return true;
}

void tl_renderer_legend(const tl_renderer *renderer, struct tl_legend *out)
{
    struct tl_legend_source source = legend_source(renderer);
    if (!(renderer->valid & TL_BIT(TL_MADE_REGIONS)))
        source.regions = NULL;
    tl_legend_make(&source, out);
}
