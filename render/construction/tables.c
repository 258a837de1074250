#include "render/construction/tables.h"

#include "assets/topology/borders.h"
#include "render/construction/terms.h"

#include <math.h>

#define MM 0.001f

/* A profile in closed form. Lengths in metres; 0 leaves a term out. */
struct cross_section {
    float ditch, ditch_width;    /* where two pieces meet */
    float layer, layer_to, edge; /* more layers of cloth up to a distance, and how sharply they end */
    float fold;                  /* radius of a turned-over rim */
    float rows[2];               /* of stitches, which draw the cloth down */
    float row_depth;
    float pucker_at, pucker_reach; /* waves about a row, or away from a seam (pucker_at 0) */
    float pucker;                  /* factor on their amplitude */
};

static float gauss(float x, float width)
{
    return width > 0 ? expf(-(x / width) * (x / width)) : 0;
}

static float step_down(float x, float edge)
{
    float s = fminf(fmaxf(0.5f - x / edge, 0), 1);
    return s * s * (3 - 2 * s);
}

static float height_at(const struct cross_section *shape, float d)
{
    float height = -shape->ditch * gauss(d, shape->ditch_width);
    if (shape->layer > 0)
        height += shape->layer * step_down(d - shape->layer_to, shape->edge);
    if (d < shape->fold) {
        float away = 1 - d / shape->fold;
        height -= shape->fold * (1 - sqrtf(fmaxf(1 - away * away, 0)));
    }
    for (int i = 0; i < 2; i++)
        if (shape->rows[i] > 0)
            height -= shape->row_depth * gauss(d - shape->rows[i], 0.9f * MM);
    return height;
}

/* The share of light that does not reach the cloth: deep in the ditch, and under the edge of a layer. */
static float shade_at(const struct cross_section *shape, float d)
{
    float shade = shape->ditch > 0 ? 0.55f * gauss(d, 1.2f * shape->ditch_width) : 0;
    if (shape->layer > 0)
        shade += fminf(250 * shape->layer, 0.2f) * gauss(d - shape->layer_to - 0.3f * MM, 0.5f * MM);
    for (int i = 0; i < 2; i++)
        if (shape->rows[i] > 0)
            shade += 0.12f * gauss(d - shape->rows[i], 0.7f * MM);
    return shade;
}

static float pucker_at(const struct cross_section *shape, float d)
{
    float fading = 1 - d / ((float)CONSTRUCTION_LAST * CONSTRUCTION_STEP);
    if (shape->pucker_at > 0)
        return shape->pucker * gauss(d - shape->pucker_at, shape->pucker_reach) * fading;
    return shape->pucker * (1 - gauss(d, 1.2f * MM)) * expf(-d / shape->pucker_reach) * fading;
}

static void fill(const struct cross_section *shape, vec4s *profile)
{
    enum { PARTS = 16 }; /* of a step, for the integrals */
    const float part = CONSTRUCTION_STEP / PARTS;
    double squares = 0, shade = 0;
    for (int i = 0; i < TL_CONSTRUCTION_ENTRIES; i++) {
        float d = (float)i * CONSTRUCTION_STEP;
        profile[i] = (vec4s){{height_at(shape, d), (float)squares, (float)shade, pucker_at(shape, d)}};
        for (int k = 0; k < PARTS; k++) {
            float from = d + (float)k * part;
            float slope = (height_at(shape, from + part) - height_at(shape, from)) / part;
            squares += (double)(slope * slope * part);
            shade += (double)(shade_at(shape, from + 0.5f * part) * part);
        }
    }
}

static struct cross_section seam_of(const struct tl_construction *construction, bool is_over)
{
    const float t = construction->thickness_m;
    struct cross_section shape = {.ditch = 0.25f * MM + t,
                                  .ditch_width = 0.4f * MM + 0.4f * t,
                                  .edge = 0.8f * MM + t,
                                  .row_depth = 0.05f * MM + 0.2f * t,
                                  .pucker_reach = 9 * MM,
                                  .pucker = 1};
    switch (construction->seam) {
    case TL_SEAM_PLAIN: /* pressed open */
        shape.layer = 0.6f * t;
        shape.layer_to = 12 * MM;
        shape.edge = 2 * MM + 2 * t;
        break;
    case TL_SEAM_TOPSTITCHED: /* pressed to one side and stitched down */
        if (is_over) {
            shape.layer = t;
            shape.layer_to = 9 * MM;
            shape.rows[0] = 2.2f * MM;
        }
        break;
    case TL_SEAM_FLAT_FELLED: /* both allowances folded into one band */
        if (is_over) {
            shape.layer = 1.3f * t;
            shape.layer_to = 9.5f * MM;
            shape.edge = 0.3f * MM + 0.4f * t;
            shape.rows[0] = 1.9f * MM;
            shape.rows[1] = 8.1f * MM;
            shape.pucker_at = 5 * MM;
            shape.pucker_reach = 4 * MM;
        }
        break;
    case TL_SEAM_OVERLOCK: /* narrow, soft, pressed to one side */
        shape.ditch *= 0.7f;
        if (is_over) {
            shape.layer = 0.8f * t;
            shape.layer_to = 6 * MM;
            shape.edge = 1.5f * MM + t;
        }
        break;
    case TL_SEAM_BOUND: /* pressed open, its edges in tape */
        shape.layer = 1.2f * t;
        shape.layer_to = 10 * MM;
        shape.edge = 0.4f * MM + 0.4f * t;
        break;
    default:
        return (struct cross_section){0};
    }
    return shape;
}

/* The intake of a dart is folded to one side and gets narrower towards its tip. */
static struct cross_section dart_of(const struct tl_construction *construction)
{
    struct cross_section shape = seam_of(construction, false);
    shape.layer = 0;
    return shape;
}

static struct cross_section hem_of(const struct tl_construction *construction)
{
    const float t = construction->thickness_m, width = construction->hem_m;
    struct cross_section shape = {.layer = t,
                                  .layer_to = width,
                                  .edge = 0.5f * MM + t,
                                  .fold = 0.2f * MM + 1.2f * t,
                                  .row_depth = 0.05f * MM + 0.2f * t,
                                  .pucker_at = width,
                                  .pucker_reach = 6 * MM,
                                  .pucker = 0.45f};
    switch (construction->hem) {
    case TL_HEM_PLAIN: /* sewn from the inside */
        break;
    case TL_HEM_TOPSTITCHED:
        shape.rows[0] = width - 1.8f * MM;
        break;
    case TL_HEM_TWICE: /* two rows, as by a twin needle */
        shape.rows[0] = width - 1.8f * MM;
        shape.rows[1] = width - 5.2f * MM;
        break;
    case TL_HEM_BOUND: /* a tape around the edge */
        shape.layer = 1.4f * t;
        shape.edge = 0.2f * MM + 0.4f * t;
        shape.rows[0] = width - 1.2f * MM;
        break;
    default:
        return (struct cross_section){0};
    }
    return shape;
}

void tl_construction_tables_make(const struct tl_construction *construction,
                                 struct tl_construction_tables *out)
{
    const struct cross_section over = seam_of(construction, true), under = seam_of(construction, false);
    const struct cross_section hem = hem_of(construction), dart = dart_of(construction);
    fill(&over, out->profiles[TL_BORDER_SEAM_OVER]);
    fill(&under, out->profiles[TL_BORDER_SEAM_UNDER]);
    fill(&hem, out->profiles[TL_BORDER_HEM]);
    fill(&dart, out->profiles[TL_BORDER_DART]);
    out->sizes = (vec4s){
        {construction->hem_m, construction->stitch_m, construction->pucker_m, 0.5f * construction->thread_m}};
    out->rows = (vec4s){{over.rows[0], over.rows[1], fmaxf(hem.rows[0], 0), fmaxf(hem.rows[1], 0)}};
}
