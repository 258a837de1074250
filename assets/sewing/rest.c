#include "assets/sewing/rest.h"

#include "config/base/memory.h"

#include <stdlib.h>

static bool takes_chart(enum tl_rest_choice choice, const struct tl_chart *chart)
{
    return choice == TL_REST_UV ? chart->unmapped_share < 1 : chart->verdict == TL_CHART_IS_PATTERN;
}

/* UVs as a pattern in metres: v runs downwards, the warp upwards. */
static void set_pattern(const double scale[2], tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    garment->pattern = tl_resize(garment->pattern, mesh->vertex_count, sizeof *garment->pattern);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        garment->pattern[i] = (vec2s){
            {(float)(scale[0] * (double)mesh->uvs[i].x), (float)(-scale[1] * (double)mesh->uvs[i].y)}};
}

bool tl_rest_take(enum tl_rest_choice choice, const struct tl_charts *charts, tl_garment *garment,
                  tl_error *error)
{
    if (choice == TL_REST_UV && !(charts->metres_per_unit[0] > 0))
        return tl_fail(error, TL_USAGE, "cloth.rest=uv: %s has no UVs: leave it out", garment->model.name);
    if (choice == TL_REST_MESH || (choice == TL_REST_AUTO && charts->whole.verdict != TL_CHART_IS_PATTERN))
        return true;
    set_pattern(charts->metres_per_unit, garment);
    free(garment->modelled);
    garment->modelled = TL_NEW_ARRAY(bool, charts->triangle_count);
    for (size_t t = 0; t < charts->triangle_count; t++)
        garment->modelled[t] = !takes_chart(choice, &charts->items[charts->of_triangle[t]]);
    return true;
}

static char *describe_pattern(const char *name, const struct tl_charts *charts)
{
    const double *scale = charts->metres_per_unit;
    char *scales = scale[0] == scale[1] ? tl_format("%.4g mm", 1e3 * scale[0])
                                        : tl_format("%.4g x %.4g mm", 1e3 * scale[0], 1e3 * scale[1]);
    char *rest = charts->pattern_count == charts->count
                     ? tl_copy_string("")
                     : tl_format("; the other %.3g %% of the area keeps the shape of its mesh",
                                 100 * (1 - charts->pattern_share));
    char *line =
        tl_format("%s: its rest shape is that of its UVs: %zu of %zu charts are a pattern, at %s per "
                  "unit, with a residual of %.3g %%%s",
                  name, charts->pattern_count, charts->count, scales, 100 * charts->pattern_residual, rest);
    free(scales);
    free(rest);
    return line;
}

char *tl_rest_describe(const char *name, const struct tl_charts *charts)
{
    const char *why = "";
    switch (charts->whole.verdict) {
    case TL_CHART_IS_PATTERN:
        return describe_pattern(name, charts);
    case TL_CHART_IS_UNMAPPED:
        return tl_format("%s: its rest shape is that of its mesh: it has no UVs on %.3g %% of its area", name,
                         100 * charts->whole.unmapped_share);
    case TL_CHART_IS_RESCALED:
        why = "its charts have scales of their own";
        break;
    case TL_CHART_IS_FOLDED:
        why = "its charts lie upon themselves";
        break;
    case TL_CHART_IS_STRETCHED:
        why = "its charts are stretched unevenly";
        break;
    }
    return tl_format(
        "%s: its rest shape is that of its mesh: its UVs are no pattern: %s (residual %.3g %%, a "
        "pattern's is at most %g %%)",
        name, why, 100 * charts->whole.residual, 100 * TL_CHART_RESIDUAL);
}
