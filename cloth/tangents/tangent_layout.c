#include "cloth/tangents/tangent_layout.h"

#include "cloth/mesh/topology.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define LANES TL_LANES

struct layout_item {
    uint32_t normal, group; /* group: TL_NONE if the normal has none */
    uint32_t spoke_count;
    uint32_t slot; /* block * LANES + lane */
};

struct layer {
    const struct tl_tangent_groups *groups;
    uint32_t *twins;
    struct tl_fans normal_fans, group_fans;
    bool *pending;        /* [corner_count] corners of the current item that are not written yet */
    uint32_t *first_user; /* [normal_count] the first render vertex with that normal: its position is read */
    struct layout_item *items; /* normal_count of them, then the borrowers */
    size_t item_count;
    uint32_t *item_of; /* [render_count] */
};

/* ---- Items ---- */

/* Lists the items and finds the item of every render vertex. The first group at a normal shares the normal's
 * item; each further group gets a borrower. A vertex without a group uses its normal's item. */
static void list_items(struct layer *layer)
{
    const struct tl_tangent_groups *groups = layer->groups;
    layer->items = TL_NEW_ARRAY(struct layout_item, groups->normal_count + groups->group_count);
    layer->item_of = TL_NEW_ARRAY(uint32_t, groups->render_count);
    layer->first_user = TL_NEW_ARRAY(uint32_t, groups->normal_count);
    uint32_t *item_of_group = TL_NEW_ARRAY(uint32_t, groups->group_count); /* plus 1; 0: none yet */
    for (uint32_t n = 0; n < groups->normal_count; n++)
        layer->items[n] = (struct layout_item){.normal = n, .group = TL_NONE};
    layer->item_count = groups->normal_count;
    for (size_t r = groups->render_count; r-- > 0;)
        layer->first_user[groups->normal_of[r]] = (uint32_t)r;
    for (size_t r = 0; r < groups->render_count; r++) {
        uint32_t normal = groups->normal_of[r], group = groups->group_of[r];
        layer->item_of[r] = normal;
        if (group == TL_NONE)
            continue;
        if (item_of_group[group] == 0 && layer->items[normal].group == TL_NONE) {
            layer->items[normal].group = group;
            item_of_group[group] = normal + 1;
        } else if (item_of_group[group] == 0) {
            layer->items[layer->item_count++] = (struct layout_item){.normal = normal, .group = group};
            item_of_group[group] = (uint32_t)layer->item_count;
        }
        layer->item_of[r] = item_of_group[group] - 1;
    }
    free(item_of_group);
}

/* The corners of each group. */
static struct tl_fans fan_groups(const struct tl_tangent_groups *groups)
{
    uint32_t *lists = TL_NEW_ARRAY(uint32_t, groups->corner_count);
    for (size_t c = 0; c < groups->corner_count; c++) /* the last list takes the corners without a group */
        lists[c] = groups->groups[c] == TL_NONE ? (uint32_t)groups->group_count : groups->groups[c];
    struct tl_fans fans = tl_fans_build(lists, groups->corner_count, groups->group_count + 1);
    free(lists);
    return fans;
}

/* ---- Fans ---- */

/* Destination of a fan: one lane of a block's rows. With `rows` NULL the spokes are counted only. */
struct lane {
    uint32_t (*rows)[LANES];
    float (*gradients)[2][LANES];
    size_t index;
    uint32_t spoke_count;
};

static void add_spoke(struct lane *lane, uint32_t vertex)
{
    if (lane->rows)
        lane->rows[lane->spoke_count][lane->index] = vertex;
    lane->spoke_count++;
}

/* Writes the triangle's tangent in terms of the two edges that leave `corner`. The stored pair g is in terms
 * of the edges from corner 0: e01 g0 + e02 g1. Substituting e01 = -e10, e02 = e12 - e10 it is e12 g1 - e10
 * (g0 + g1) from corner 1, and -e20 (g0 + g1) + e21 g0 from corner 2. */
static void add_gradient(const struct layer *layer, uint32_t corner, struct lane *lane)
{
    if (!lane->gradients)
        return;
    const double *g = layer->groups->gradients[corner / 3];
    const double from[3][2] = {{g[0], g[1]}, {g[1], -g[0] - g[1]}, {-g[0] - g[1], g[0]}};
    for (int i = 0; i < 2; i++)
        lane->gradients[lane->spoke_count - 1][i][lane->index] = (float)from[corner % 3][i];
}

static uint32_t position_vertex(const struct layer *layer, uint32_t corner)
{
    return layer->first_user[layer->groups->normals[corner]];
}

/* Writes a chain of adjacent corners from its first one on. Every chain but the first is separated from the
 * one before by a spoke to the vertex itself, whose triangles have no area. */
static void add_chain(struct layer *layer, const struct layout_item *item, uint32_t corner, struct lane *lane)
{
    if (lane->spoke_count > 0)
        add_spoke(lane, layer->first_user[item->normal]);
    add_spoke(lane, position_vertex(layer, tl_corner_turn(corner, 1)));
    for (; corner != TL_NONE && layer->pending[corner]; corner = tl_twins_after(layer->twins, corner)) {
        layer->pending[corner] = false;
        if (item->group != TL_NONE && layer->groups->groups[corner] == item->group)
            add_gradient(layer, corner, lane);
        add_spoke(lane, position_vertex(layer, tl_corner_turn(corner, 2)));
    }
}

/* Writes the fan of an item. Open chains have to start at a corner that has no pending corner before it, so
 * they are written first; every corner that is still pending after that lies on a ring, which may start
 * anywhere. */
static void write_fan(struct layer *layer, size_t index, struct lane *lane)
{
    const struct layout_item *item = &layer->items[index];
    bool borrows = index >= layer->groups->normal_count;
    const struct tl_fans *fans = borrows ? &layer->group_fans : &layer->normal_fans;
    uint32_t list = borrows ? item->group : item->normal;
    const uint32_t *corners = fans->items + fans->first[list];
    size_t count = fans->first[list + 1] - fans->first[list];
    for (size_t i = 0; i < count; i++)
        layer->pending[corners[i]] = true;
    for (size_t i = 0; i < count; i++) {
        uint32_t before = tl_twins_before(layer->twins, corners[i]);
        if (layer->pending[corners[i]] && (before == TL_NONE || !layer->pending[before]))
            add_chain(layer, item, corners[i], lane);
    }
    for (size_t i = 0; i < count; i++)
        if (layer->pending[corners[i]])
            add_chain(layer, item, corners[i], lane);
}

/* ---- Blocks ---- */

/* Items are sorted by their number of spokes within windows of this many. A block is as long as its longest
 * fan, so fans of equal length waste no lanes; a window keeps the items of a block near each other in memory.
 */
#define WINDOW 1024

struct ranked_item {
    uint32_t spoke_count, item;
};

static int compare_ranks(const void *a, const void *b)
{
    const struct ranked_item *left = a, *right = b;
    if (left->spoke_count != right->spoke_count)
        return left->spoke_count < right->spoke_count ? -1 : 1;
    return (left->item > right->item) - (left->item < right->item);
}

/* Assigns slots to items [begin, end), starting with block `first_block`; returns the first block after them.
 */
static size_t place_items(struct layer *layer, size_t begin, size_t end, size_t first_block)
{
    size_t count = end - begin;
    struct ranked_item *order = TL_NEW_ARRAY(struct ranked_item, count);
    for (size_t i = 0; i < count; i++)
        order[i] = (struct ranked_item){layer->items[begin + i].spoke_count, (uint32_t)(begin + i)};
    for (size_t first = 0; first < count; first += WINDOW)
        qsort(order + first, count - first < WINDOW ? count - first : WINDOW, sizeof *order, compare_ranks);
    for (size_t i = 0; i < count; i++)
        layer->items[order[i].item].slot = (uint32_t)(first_block * LANES + i);
    free(order);
    return first_block + (count + LANES - 1) / LANES;
}

/* Sets each block's spokes to its longest fan's, and its offsets; allocates rows, gradients and states. */
static void size_blocks(tl_tangent_frames *frames, const struct layer *layer)
{
    for (size_t i = 0; i < layer->item_count; i++) {
        struct tl_tangent_block *block = &frames->blocks[layer->items[i].slot / LANES];
        if (layer->items[i].spoke_count > block->spoke_count)
            block->spoke_count = layer->items[i].spoke_count;
    }
    for (size_t b = 0; b < frames->block_count; b++) {
        struct tl_tangent_block *block = &frames->blocks[b];
        uint32_t corner_rows = block->spoke_count > 0 ? block->spoke_count - 1 : 0;
        block[1].first_row = block->first_row + 1 + block->spoke_count;
        block[1].first_gradient = block->first_gradient + corner_rows;
    }
    const struct tl_tangent_block *end = &frames->blocks[frames->block_count];
    frames->rows = tl_alloc(end->first_row, sizeof *frames->rows);
    frames->gradients = tl_alloc(end->first_gradient, sizeof *frames->gradients);
    frames->states = TL_NEW_ARRAY(struct tl_tangent_state, frames->block_count);
}

/* Writes every fan into its lane. The rows are filled with the vertex itself first, so that shorter fans end
 * in triangles without area. A state starts with the normal +Y. */
static void fill_blocks(tl_tangent_frames *frames, struct layer *layer)
{
    for (size_t i = 0; i < layer->item_count; i++) {
        const struct layout_item *item = &layer->items[i];
        size_t lane = item->slot % LANES;
        const struct tl_tangent_block *block = &frames->blocks[item->slot / LANES];
        for (uint32_t k = 0; k <= block->spoke_count; k++)
            frames->rows[block->first_row + k][lane] = layer->first_user[item->normal];
        struct lane place = {frames->rows + block->first_row + 1, frames->gradients + block->first_gradient,
                             lane, 0};
        write_fan(layer, i, &place);
        struct tl_tangent_state *state = &frames->states[item->slot / LANES];
        state->normal[1][lane] = 1;
        state->sign[lane] = item->group == TL_NONE ? 1 : layer->groups->group_signs[item->group];
        if (i >= layer->groups->normal_count)
            frames->lenders[item->slot / LANES - (frames->block_count - frames->borrower_count)][lane] =
                layer->items[item->normal].slot;
    }
}

/* Lists the render vertices of each block by a counting sort. */
static void list_outputs(tl_tangent_frames *frames, const struct layer *layer)
{
    size_t count = layer->groups->render_count;
    frames->outputs = TL_NEW_ARRAY(struct tl_tangent_output, count);
    for (size_t r = 0; r < count; r++)
        frames->blocks[layer->items[layer->item_of[r]].slot / LANES + 1].first_output++;
    for (size_t b = 0; b < frames->block_count; b++)
        frames->blocks[b + 1].first_output += frames->blocks[b].first_output;
    uint32_t *next = TL_NEW_ARRAY(uint32_t, frames->block_count);
    for (size_t r = 0; r < count; r++) {
        uint32_t slot = layer->items[layer->item_of[r]].slot, block = slot / LANES;
        frames->outputs[frames->blocks[block].first_output + next[block]++] =
            (struct tl_tangent_output){(uint32_t)r, slot % LANES};
    }
    free(next);
}

void tl_tangent_frames_lay_out(tl_tangent_frames *frames, const struct tl_tangent_groups *groups)
{
    struct layer layer = {
        .groups = groups,
        .twins = tl_twins_build(groups->normals, groups->corner_count),
        .normal_fans = tl_fans_build(groups->normals, groups->corner_count, groups->normal_count),
        .group_fans = fan_groups(groups),
        .pending = TL_NEW_ARRAY(bool, groups->corner_count),
    };
    list_items(&layer);
    for (size_t i = 0; i < layer.item_count; i++) {
        struct lane counter = {0};
        write_fan(&layer, i, &counter);
        layer.items[i].spoke_count = counter.spoke_count;
    }
    size_t normal_blocks = place_items(&layer, 0, groups->normal_count, 0);
    frames->block_count = place_items(&layer, groups->normal_count, layer.item_count, normal_blocks);
    frames->borrower_count = frames->block_count - normal_blocks;
    frames->blocks = TL_NEW_ARRAY(struct tl_tangent_block, frames->block_count + 1);
    frames->lenders = tl_alloc(frames->borrower_count, sizeof *frames->lenders);
    size_blocks(frames, &layer);
    fill_blocks(frames, &layer);
    list_outputs(frames, &layer);
    free(layer.twins);
    tl_fans_release(&layer.normal_fans);
    tl_fans_release(&layer.group_fans);
    free(layer.pending);
    free(layer.first_user);
    free(layer.items);
    free(layer.item_of);
}
