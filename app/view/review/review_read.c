#include "app/view/review/review_read.h"

#include "app/display/board.h"
#include "app/view/review/review.h"
#include "app/view/review/review_wipe.h"
#include "config/base/memory.h"
#include "render/inspect/inspect.h"
#include "render/scene/view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The renderer of the appearance under the pointer. */
static const tl_renderer *renderer_under(const struct tl_review *review, int width)
{
    bool is_left = (int)review->input.x < tl_review_wipe_column(review, width);
    return is_left ? review->wipe.renderer : review->renderer;
}

static double percent(float share)
{
    return 100 * (double)share;
}

static void describe(const struct tl_inspection *found, char *text, size_t size)
{
    const double deg = 180 / M_PI, mm = 1000;
    char strain[128] = "", seen[96] = "", place[96];
    if (found->has_strain)
        snprintf(strain, sizeof strain, "\nstrain: warp %+.1f %%, weft %+.1f %%, shear %+.1f\u00b0",
                 percent(found->strain_warp), percent(found->strain_weft),
                 deg * asin(fmin(fmax((double)found->shear, -1), 1)));
    if (found->has_visibility)
        snprintf(seen, sizeof seen, "\nsees %.0f %% of the light; most from region %d",
                 percent(found->visibility), found->strongest_region);
    snprintf(place, sizeof place, "\nat %.0f, %.0f, %.0f mm", mm * (double)found->position.x,
             mm * (double)found->position.y, mm * (double)found->position.z);
    snprintf(text, size, "%.60s, %.60s%s\nnormal %.2f %.2f %.2f, gloss %.2f, uv %.3f %.3f%s%s%s",
             found->surface, found->material, found->back ? ", inner side" : "", (double)found->normal.x,
             (double)found->normal.y, (double)found->normal.z, (double)found->glossiness, (double)found->uv.x,
             (double)found->uv.y, place, strain, seen);
}

static bool inspect_under(const struct tl_review *review, struct tl_inspection *found)
{
    int width, height;
    tl_review_size(review, &width, &height);
    int x = (int)review->input.x, y = (int)review->input.y;
    bool is_over = x >= 0 && y >= 0 && x < width && y < height;
    return is_over && tl_renderer_inspect(renderer_under(review, width), x, y, found);
}

void tl_review_read_out(const struct tl_review *review, char *text, size_t size)
{
    struct tl_inspection found;
    text[0] = '\0';
    if (review->input.reads_out && inspect_under(review, &found))
        describe(&found, text, size);
}

/* A surface that is made of the garment's triangles. */
static bool is_of_cloth(const char *surface)
{
    return strcmp(surface, TL_SURFACE_GARMENT) == 0 || strcmp(surface, TL_SURFACE_PATTERN) == 0;
}

size_t tl_review_marks(const struct tl_review *review, float marks[TL_REVIEW_MARKS][2])
{
    struct tl_inspection found;
    int width, height;
    size_t count = 0;
    if (!tl_session_settings(review->session)->scene.pattern || !inspect_under(review, &found) ||
        !is_of_cloth(found.surface))
        return 0;
    tl_review_size(review, &width, &height);
    const tl_frame frame = tl_session_frame(review->session);
    const struct tl_view view = tl_view_make(&frame.camera, width, height);
    for (size_t s = 0; s < frame.surface_count && count < TL_REVIEW_MARKS; s++) {
        const tl_surface *surface = &frame.surfaces[s];
        if (!is_of_cloth(surface->name) || 3 * (size_t)found.triangle + 2 >= surface->index_count)
            continue;
        vec3s point = glms_vec3_zero();
        for (int k = 0; k < 3; k++)
            point = glms_vec3_muladds(surface->positions[surface->indices[3 * found.triangle + (uint32_t)k]],
                                      found.weights[k], point);
        vec4s clip = glms_mat4_mulv(view.view_projection, glms_vec4(point, 1));
        if (!(clip.w > 0))
            continue;
        marks[count][0] = (float)width * (0.5f + 0.5f * clip.x / clip.w);
        marks[count++][1] = (float)height * (0.5f - 0.5f * clip.y / clip.w);
    }
    return count == TL_REVIEW_MARKS ? count : 0;
}

bool tl_review_legend(const struct tl_review *review, struct tl_panel_legend *out)
{
    struct tl_legend legend;
    tl_renderer_legend(review->renderer, &legend);
    if (legend.stop_count == 0 && legend.entry_count == 0)
        return false;
    *out = (struct tl_panel_legend){.low = legend.low, .high = legend.high};
    snprintf(out->title, sizeof out->title, "%s", legend.title);
    snprintf(out->unit, sizeof out->unit, "%s", legend.unit);
    snprintf(out->note, sizeof out->note, "%s", legend.note);
    for (int i = 0; i < legend.stop_count && i < TL_PANEL_LEGEND_STOPS; i++) {
        out->stop_values[i] = legend.stops[i].value;
        memcpy(out->stop_colours[i], legend.stops[i].colour.raw, sizeof out->stop_colours[i]);
        out->stop_count++;
    }
    for (int i = 0; i < legend.entry_count && i < TL_PANEL_LEGEND_ENTRIES; i++) {
        snprintf(out->entry_labels[i], sizeof out->entry_labels[i], "%s", legend.entries[i].label);
        memcpy(out->entry_colours[i], legend.entries[i].colour.raw, sizeof out->entry_colours[i]);
        out->entry_count++;
    }
    return true;
}
