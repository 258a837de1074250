#include "render/shade/lobe_set_table.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float cosine_of(int row)
{
    float at = ((float)row + TL_LOBE_SET_FIRST) / TL_LOBE_SET_ROWS;
    return sinf(0.5f * (float)M_PI * fminf(at * at, 1));
}

/* All nodes have `count` lobes, the largest number of any, so that they can be interpolated. */
static void fit_node(const tl_material *material, float glossiness, float cosine, float azimuth, int count,
                     struct tl_lobe_set_node *node)
{
    static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
    float sine = sqrtf(1 - cosine * cosine);
    vec3s viewer = {{sine * cosf(azimuth), sine * sinf(azimuth), cosine}};
    struct tl_fitted_lobe low[TL_LOBE_FIT_MAX], high[TL_LOBE_FIT_MAX];
    struct tl_brdf brdf = tl_brdf_of(
        material, (vec3s){{TL_LOBE_SET_LOW_F0, TL_LOBE_SET_LOW_F0, TL_LOBE_SET_LOW_F0}}, glossiness);
    tl_lobe_fit_make(&brdf, &frame, viewer, count, count, low);
    brdf.f0 = (vec3s){{1, 1, 1}};
    tl_lobe_fit_make(&brdf, &frame, viewer, count, count, high);
    for (int k = 0; k < count; k++) {
        struct tl_lobe_set_lobe *lobe = &node->lobes[k];
        for (int i = 0; i < 3; i++)
            lobe->direction[i] = low[k].direction.raw[i];
        lobe->log_exponent = log2f(low[k].exponent);
        lobe->low = low[k].weight.x;
        lobe->high = high[k].weight.x;
    }
}

/* Widths count for lobes of one direction only: those of GGX towards a viewer in front. */
static float distance_of(const struct tl_lobe_set_node *a, const struct tl_lobe_set_node *b, int count,
                         bool reversed)
{
    float sum = 0;
    for (int k = 0; k < count; k++) {
        const struct tl_lobe_set_lobe *other = &b->lobes[reversed ? count - 1 - k : k];
        for (int i = 0; i < 3; i++) {
            float d = a->lobes[k].direction[i] - other->direction[i];
            sum += d * d;
        }
        const float wider = a->lobes[k].log_exponent - other->log_exponent;
        sum += 1e-3f * wider * wider;
    }
    return sum;
}

static struct tl_lobe_set_node *node_at(const struct tl_lobe_set_table *table, int gloss, int row, int column)
{
    return &table->nodes[(size_t)(gloss * TL_LOBE_SET_COSINES + row) * TL_LOBE_SET_AZIMUTHS + (size_t)column];
}

/* Orders the lobes of a cell's corners as those of the corner whose lobes lie farthest apart. */
static void order_cell(const struct tl_lobe_set_table *table, int gloss, int row, int column)
{
    const int count = table->lobe_count, corners = table->gloss_count > 1 ? 8 : 4;
    const struct tl_lobe_set_node *nodes[8], *widest = NULL;
    float width = -1;
    for (int i = 0; i < corners; i++) {
        nodes[i] = node_at(table, gloss + (i >> 2), row + (i >> 1 & 1), column + (i & 1));
        float distance = distance_of(nodes[i], nodes[i], count, true);
        if (distance > width) {
            width = distance;
            widest = nodes[i];
        }
    }
    int orders = 0;
    for (int i = 0; i < corners; i++)
        if (distance_of(widest, nodes[i], count, true) < distance_of(widest, nodes[i], count, false))
            orders |= 1 << i;
    node_at(table, gloss, row, column)->lobes[0].orders = (float)orders;
}

static float glossiness_at(const struct tl_lobe_set_table *table, int gloss)
{
    if (table->gloss_count == 1)
        return table->gloss_low;
    float share = (float)gloss / (float)(table->gloss_count - 1);
    return table->gloss_low + share * (table->gloss_high - table->gloss_low);
}

static int largest_count(const tl_material *material, float glossiness, int max_count)
{
    struct tl_brdf brdf = tl_brdf_of(material, (vec3s){{1, 1, 1}}, glossiness);
    static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
    int largest = 1;
    for (int row = 0; row < TL_LOBE_SET_COSINES; row += 4)
        for (int column = 0; column < TL_LOBE_SET_AZIMUTHS; column += 4) {
            float cosine = cosine_of(row), sine = sqrtf(1 - cosine * cosine);
            float azimuth = (float)M_PI * (float)column / (TL_LOBE_SET_AZIMUTHS - 1);
            vec3s viewer = {{sine * cosf(azimuth), sine * sinf(azimuth), cosine}};
            struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX];
            int count = tl_lobe_fit_make(&brdf, &frame, viewer, 1, max_count, lobes);
            largest = count > largest ? count : largest;
        }
    return largest;
}

void tl_lobe_set_table_make(const tl_material *material, float gloss_low, float gloss_high, int max_count,
                            struct tl_lobe_set_table *out)
{
    bool one = gloss_high - gloss_low < 1e-4f;
    *out = (struct tl_lobe_set_table){
        .gloss_count = one ? 1 : TL_LOBE_SET_GLOSSES, .gloss_low = gloss_low, .gloss_high = gloss_high};
    for (int gloss = 0; gloss < out->gloss_count; gloss++) {
        int count = largest_count(material, glossiness_at(out, gloss), max_count);
        out->lobe_count = count > out->lobe_count ? count : out->lobe_count;
    }
    out->nodes = TL_NEW_ARRAY(struct tl_lobe_set_node,
                              (size_t)out->gloss_count * TL_LOBE_SET_COSINES * TL_LOBE_SET_AZIMUTHS);
#pragma omp parallel for collapse(2) schedule(dynamic)
    for (int gloss = 0; gloss < out->gloss_count; gloss++)
        for (int row = 0; row < TL_LOBE_SET_COSINES; row++)
            for (int column = 0; column < TL_LOBE_SET_AZIMUTHS; column++)
                fit_node(material, glossiness_at(out, gloss), cosine_of(row),
                         (float)M_PI * (float)column / (TL_LOBE_SET_AZIMUTHS - 1), out->lobe_count,
                         node_at(out, gloss, row, column));
    for (int gloss = 0; gloss == 0 || gloss < out->gloss_count - 1; gloss++)
        for (int row = 0; row < TL_LOBE_SET_COSINES - 1; row++)
            for (int column = 0; column < TL_LOBE_SET_AZIMUTHS - 1; column++)
                order_cell(out, gloss, row, column);
}

void tl_lobe_set_table_release(struct tl_lobe_set_table *table)
{
    free(table->nodes);
    *table = (struct tl_lobe_set_table){0};
}
