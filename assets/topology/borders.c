#include "assets/topology/borders.h"

#include "assets/topology/near_internal.h"
#include "assets/topology/pieces_internal.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Borders by side while they are put in order. */
struct outlining {
    const tl_mesh *mesh;
    struct tl_pieces pieces;
    uint32_t *numbers; /* [3 triangle_count] of the border of a side, or TL_NO_BORDER */
    uint32_t *sides;   /* [border_count] */
    uint32_t *loops;   /* [border_count] around which edge of its piece a border lies */
    tl_borders made;
};

static bool is_border(const struct outlining *outlining, uint32_t side)
{
    return outlining->pieces.across[side] == TL_NO_BORDER &&
           outlining->pieces.metres[outlining->pieces.pieces[side / 3]] > 0;
}

static bool is_seam(const struct outlining *outlining, uint32_t side)
{
    return outlining->pieces.partners[side] != TL_NO_BORDER;
}

static vec2s uv_of(const struct outlining *outlining, uint32_t side, uint32_t end)
{
    return outlining->mesh->uvs[outlining->mesh->indices[side - side % 3 + (side % 3 + end) % 3]];
}

static uint32_t place_of(const struct outlining *outlining, uint32_t side, uint32_t end)
{
    return outlining->pieces.places[outlining->mesh->indices[side - side % 3 + (side % 3 + end) % 3]];
}

/* The angle by which the outline turns from one border to the next, radians. */
static float turn_between(const struct outlining *outlining, uint32_t side, uint32_t next)
{
    vec2s a = glms_vec2_sub(uv_of(outlining, side, 1), uv_of(outlining, side, 0));
    vec2s b = glms_vec2_sub(uv_of(outlining, next, 1), uv_of(outlining, next, 0));
    return fabsf(atan2f(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
}

/* The begin of a loop of borders: where hem and seam join, or else at the sharpest corner but for tips of
 * darts, so that no seam changes its side half way. */
static uint32_t start_of_loop(const struct outlining *outlining, uint32_t side)
{
    uint32_t best = side, at = side;
    float sharpest = -1;
    for (size_t i = 0; i < 3 * outlining->pieces.triangle_count; i++) {
        uint32_t next = tl_pieces_next(&outlining->pieces, at);
        float turn = turn_between(outlining, at, next);
        if (is_seam(outlining, at) != is_seam(outlining, next))
            turn += 2 * (float)M_PI;
        if (outlining->pieces.partners[at] == next)
            turn = 0;
        if (turn > sharpest) {
            sharpest = turn;
            best = next;
        }
        at = next;
        if (at == side)
            break;
    }
    return best;
}

static void add_border(struct outlining *outlining, uint32_t side, uint32_t loop, float start_m)
{
    tl_borders *made = &outlining->made;
    vec2s from = uv_of(outlining, side, 0), to = uv_of(outlining, side, 1);
    made->borders[made->border_count] =
        (struct tl_border){.from = {from.x, from.y},
                           .to = {to.x, to.y},
                           .start_m = start_m,
                           .metres = outlining->pieces.metres[outlining->pieces.pieces[side / 3]],
                           .kind = (float)TL_BORDER_HEM};
    outlining->sides[made->border_count] = side;
    outlining->loops[made->border_count] = loop;
    outlining->numbers[side] = (uint32_t)made->border_count++;
}

static float length_of(const struct tl_border *border)
{
    return border->metres * hypotf(border->to[0] - border->from[0], border->to[1] - border->from[1]);
}

/* Numbers the borders loop by loop, with the length along them. */
static void order_borders(struct outlining *outlining)
{
    uint32_t loop = 0;
    for (uint32_t side = 0; side < 3 * outlining->pieces.triangle_count; side++) {
        if (!is_border(outlining, side) || outlining->numbers[side] != TL_NO_BORDER)
            continue;
        float start_m = 0;
        uint32_t at = start_of_loop(outlining, side);
        for (; is_border(outlining, at) && outlining->numbers[at] == TL_NO_BORDER;
             at = tl_pieces_next(&outlining->pieces, at)) {
            add_border(outlining, at, loop, start_m);
            start_m += length_of(&outlining->made.borders[outlining->made.border_count - 1]);
        }
        if (outlining->numbers[side] ==
            TL_NO_BORDER) /* its loop is not one: a side that no walk comes back to */
            add_border(outlining, side, loop, 0);
        loop++;
    }
}

/* The border of a seam that comes first lies over the other. */
static void choose_sides(struct outlining *outlining)
{
    for (size_t i = 0; i < outlining->made.border_count; i++) {
        uint32_t partner = outlining->pieces.partners[outlining->sides[i]];
        if (partner == TL_NO_BORDER)
            continue;
        bool is_under = outlining->numbers[partner] != TL_NO_BORDER && outlining->numbers[partner] < i;
        outlining->made.borders[i].kind = is_under ? (float)TL_BORDER_SEAM_UNDER : (float)TL_BORDER_SEAM_OVER;
    }
}

static uint32_t partner_of(const struct outlining *outlining, size_t border)
{
    uint32_t partner = outlining->pieces.partners[outlining->sides[border]];
    return partner == TL_NO_BORDER ? TL_NO_BORDER : outlining->numbers[partner];
}

/* Goes from every tip, where a border is sewn to the next one, outwards along both legs. */
static void find_darts(struct outlining *outlining)
{
    tl_borders *made = &outlining->made;
    for (size_t tip = 0; tip + 1 < made->border_count; tip++)
        for (size_t a = tip, b = tip + 1;
             outlining->loops[a] == outlining->loops[b] && partner_of(outlining, a) == b; a--, b++) {
            made->borders[a].kind = made->borders[b].kind = (float)TL_BORDER_DART;
            if (a == 0 || b + 1 == made->border_count)
                break;
        }
}

/* ---- Openings ---- */

/* The radius of a run of hem from border `first` to before `end`: length by total turn. */
static float radius_of(const struct outlining *outlining, size_t first, size_t end)
{
    float turned = 0, length = 0;
    for (size_t i = first; i < end; i++) {
        length += length_of(&outlining->made.borders[i]);
        if (i + 1 < end)
            turned += turn_between(outlining, outlining->sides[i], outlining->sides[i + 1]);
    }
    return turned > 1e-3f ? length / turned : 1e3f;
}

/* Every hem of an opening (a neck, an armhole, a skirt's hem) is as wide as its most curved run allows. A run
 * ends at corners and at seams; short ones are no measure. */
static void limit_widths(struct outlining *outlining)
{
    const float corner = 0.6f, shortest_m = 0.03f; /* radians */
    tl_borders *made = &outlining->made;
    uint32_t *openings = tl_sets_create(outlining->mesh->vertex_count); /* by place, joined by hems */
    float *widest = TL_NEW_ARRAY(float, outlining->mesh->vertex_count + 1);
    for (size_t i = 0; i < outlining->mesh->vertex_count; i++)
        widest[i] = 1;
    for (size_t i = 0; i < made->border_count; i++)
        if (made->borders[i].kind == (float)TL_BORDER_HEM)
            tl_sets_join(openings, place_of(outlining, outlining->sides[i], 0),
                         place_of(outlining, outlining->sides[i], 1));
    for (size_t first = 0, end; first < made->border_count; first = end) {
        float length = 0;
        for (end = first; end < made->border_count; end++) {
            bool goes_on = end == first || (outlining->loops[end] == outlining->loops[first] &&
                                            turn_between(outlining, outlining->sides[end - 1],
                                                         outlining->sides[end]) < corner);
            if (!goes_on || made->borders[end].kind != made->borders[first].kind)
                break;
            length += length_of(&made->borders[end]);
        }
        uint32_t opening = tl_sets_find(openings, place_of(outlining, outlining->sides[first], 0));
        if (made->borders[first].kind == (float)TL_BORDER_HEM && length >= shortest_m)
            widest[opening] = fminf(widest[opening], TL_BORDER_EASE * radius_of(outlining, first, end));
    }
    for (size_t i = 0; i < made->border_count; i++)
        if (made->borders[i].kind == (float)TL_BORDER_HEM)
            made->borders[i].widest_m =
                widest[tl_sets_find(openings, place_of(outlining, outlining->sides[i], 0))];
    free(openings);
    free(widest);
}

/* ---- Scale ---- */

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Whether most of the area has one size of UV unit: compared with the piece at the middle of the area. */
static bool is_to_scale(const struct tl_pieces *pieces)
{
    struct sized {
        float metres;
        double area;
    } *sized = TL_NEW_ARRAY(struct sized, pieces->piece_count);
    double all = 0, before = 0, same = 0;
    float middle = 0;
    for (size_t i = 0; i < pieces->piece_count; i++) {
        sized[i] = (struct sized){pieces->metres[i], pieces->areas[i]};
        all += pieces->areas[i];
    }
    qsort(sized, pieces->piece_count, sizeof *sized, by_size);
    for (size_t i = 0; i < pieces->piece_count && before <= all / 2; i++) {
        before += sized[i].area;
        middle = sized[i].metres;
    }
    for (size_t i = 0; i < pieces->piece_count; i++)
        if (sized[i].metres > middle / 1.2f && sized[i].metres < middle * 1.2f)
            same += sized[i].area;
    free(sized);
    return middle > 0 && same >= 0.9 * all;
}

tl_borders tl_borders_make(const tl_mesh *mesh, const vec2s *pattern, const uint32_t *weld,
                           const struct tl_seam_pair *seams, size_t seam_count)
{
    struct outlining outlining = {.mesh = mesh};
    outlining.made.triangle_count = mesh->index_count / 3;
    if (!mesh->uvs) {
        outlining.made.firsts = TL_NEW_ARRAY(uint32_t, outlining.made.triangle_count + 1);
        return outlining.made;
    }
    outlining.pieces = tl_pieces_find(mesh, pattern, weld, seams, seam_count);
    outlining.numbers = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    size_t count = 0;
    for (uint32_t side = 0; side < mesh->index_count; side++) {
        outlining.numbers[side] = TL_NO_BORDER;
        count += is_border(&outlining, side);
    }
    outlining.made.borders = TL_NEW_ARRAY(struct tl_border, count);
    outlining.sides = TL_NEW_ARRAY(uint32_t, count);
    outlining.loops = TL_NEW_ARRAY(uint32_t, count);
    order_borders(&outlining);
    choose_sides(&outlining);
    find_darts(&outlining);
    limit_widths(&outlining);
    outlining.made.piece_count = outlining.pieces.piece_count;
    outlining.made.is_to_scale = is_to_scale(&outlining.pieces);
    tl_borders_list_near(mesh, &outlining.pieces, outlining.sides, &outlining.made);
    tl_pieces_release(&outlining.pieces);
    free(outlining.numbers);
    free(outlining.sides);
    free(outlining.loops);
    return outlining.made;
}

void tl_borders_release(tl_borders *borders)
{
    free(borders->borders);
    free(borders->firsts);
    free(borders->near);
    *borders = (tl_borders){0};
}

size_t tl_borders_bytes(const tl_borders *borders)
{
    if (!borders->firsts)
        return 0;
    return borders->border_count * sizeof *borders->borders +
           (borders->triangle_count + 1 + borders->firsts[borders->triangle_count]) * sizeof(uint32_t);
}
