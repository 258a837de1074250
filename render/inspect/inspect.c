#include "render/inspect/inspect.h"

#include "render/inspect/paint.h"

bool tl_inspect_averages(int view)
{
    return view == TL_VIEW_LIGHT || tl_view_is_visibility(view);
}

float tl_inspect_strain_range(const struct tl_image_params *image, const tl_surface *const *drawn,
                              size_t count, float before)
{
    if (!tl_view_is_strain(image->view))
        return before;
    return image->view_range > 0 ? image->view_range / 100
                                 : tl_paint_strain_range(drawn, count, tl_view_strain_axis(image->view));
}

static struct tl_legend_source legend_source(const struct tl_inspect_request *request, int region_count)
{
    const struct tl_image_params *image = request->image;
    int last = region_count - 1;
    return (struct tl_legend_source){.view = (enum tl_image_view)image->view,
                                     .range = request->strain_range,
                                     .range_is_given = image->view_range > 0,
                                     .region = image->view_region < last ? image->view_region : last,
                                     .regions = request->regions};
}

void tl_inspect_legend(const struct tl_inspect_request *request, struct tl_legend *out)
{
    struct tl_legend_source source = legend_source(request, request->regions ? request->regions->count : 0);
    tl_legend_make(&source, out);
}

void tl_inspect_paint(const struct tl_inspect_request *wanted, float *light)
{
    struct tl_legend_source source = legend_source(wanted, wanted->regions->count);
    struct tl_legend legend;
    struct tl_seen_regions regions;
    tl_legend_make(&source, &legend);
    tl_seen_regions_make(wanted->regions, wanted->environment_yaw, &regions);
    struct tl_paint_request request = {.legend = &legend,
                                       .view = source.view,
                                       .samples = wanted->samples,
                                       .ranges = wanted->ranges,
                                       .eye = wanted->view->eye,
                                       .texel = 2 * glms_vec3_norm(wanted->view->up) /
                                                (float)wanted->samples->height,
                                       .regions = &regions,
                                       .region = source.region};
    if (tl_view_is_visibility(source.view)) {
        request.values = tl_points_values(wanted->points, &request.stride);
        request.taps = tl_points_taps(wanted->points);
    }
    tl_paint(&request, light);
}
