#include "assets/sewing/openings.h"

#include "assets/base/mesh.h"
#include "assets/halfmesh/loops.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Loops ---- */

static vec3s vertex_at(const struct tl_opening *opening, const vec3s *positions, size_t side)
{
    return positions[opening->vertices[side < opening->side_count ? side : 0]];
}

double tl_opening_length(const struct tl_opening *opening, const vec3s *positions)
{
    double length = 0;
    for (size_t i = 0; i < opening->side_count; i++)
        length += (double)glms_vec3_distance(vertex_at(opening, positions, i),
                                             vertex_at(opening, positions, i + 1));
    return length;
}

static void measure(struct tl_opening *opening, const vec3s *positions)
{
    vec3s sum = {{0, 0, 0}}, area = {{0, 0, 0}}, origin = vertex_at(opening, positions, 0);
    for (size_t i = 0; i < opening->side_count; i++) {
        vec3s from = glms_vec3_sub(vertex_at(opening, positions, i), origin);
        vec3s to = glms_vec3_sub(vertex_at(opening, positions, i + 1), origin);
        float length = glms_vec3_distance(from, to);
        sum = glms_vec3_add(sum, glms_vec3_scale(glms_vec3_add(from, to), length / 2));
        area = glms_vec3_add(area, glms_vec3_cross(from, to));
    }
    opening->length = tl_opening_length(opening, positions);
    opening->centre =
        opening->length > 0 ? glms_vec3_add(origin, glms_vec3_divs(sum, (float)opening->length)) : origin;
    opening->normal = glms_vec3_normalize(area);
}

static struct tl_opening take_loop(const struct tl_loops *loops, size_t number, const vec3s *positions)
{
    size_t first = loops->first[number];
    struct tl_opening opening = {.side_count = loops->first[number + 1] - first};
    opening.vertices = TL_NEW_ARRAY(uint32_t, opening.side_count);
    opening.triangles = TL_NEW_ARRAY(uint32_t, opening.side_count);
    for (size_t i = 0; i < opening.side_count; i++) {
        opening.vertices[i] = loops->sides[first + i].from;
        opening.triangles[i] = loops->sides[first + i].triangle;
    }
    measure(&opening, positions);
    return opening;
}

/* Those of about one height are ordered from left to right. */
static int compare_openings(const void *a, const void *b)
{
    const float level_m = 0.02f;
    const struct tl_opening *p = a, *q = b;
    float rows[2] = {floorf(p->centre.y / level_m), floorf(q->centre.y / level_m)};
    if (rows[0] != rows[1])
        return rows[0] > rows[1] ? -1 : 1;
    if (p->centre.x != q->centre.x)
        return p->centre.x > q->centre.x ? -1 : 1;
    return (p->vertices[0] > q->vertices[0]) - (p->vertices[0] < q->vertices[0]);
}

/* ---- Pieces ---- */

/* A connected part of the garment, and its loops by what they are like. */
enum { LIKE_TOP, LIKE_HEM, LIKE_ARM, LIKE_LEG, KINDS };

struct opening_piece {
    struct tl_box box;
    size_t loop_count;
    size_t counts[KINDS];
    struct tl_opening *loops[KINDS][2]; /* of a pair the one on +X first */
};

/* The lowest vertex of the piece of each vertex. The caller frees it. */
static uint32_t *find_pieces(const struct tl_opening_mesh *mesh)
{
    uint32_t *roots = tl_sets_create(mesh->vertex_count);
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int i = 1; i < 3; i++)
            tl_sets_join(roots, mesh->triangles[t][0], mesh->triangles[t][i]);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        roots[i] = tl_sets_find(roots, (uint32_t)i);
    return roots;
}

static struct tl_box box_of_piece(const struct tl_opening_mesh *mesh, const uint32_t *roots, uint32_t root)
{
    struct tl_box box = {{{FLT_MAX, FLT_MAX, FLT_MAX}}, {{-FLT_MAX, -FLT_MAX, -FLT_MAX}}};
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        if (roots[i] != root)
            continue;
        box.lower = glms_vec3_minv(box.lower, mesh->positions[i]);
        box.upper = glms_vec3_maxv(box.upper, mesh->positions[i]);
    }
    return box;
}

/* Distance of a loop from the plane of symmetry, as a share of the piece's width; positive on +X. */
static float side_of(const struct opening_piece *piece, const struct tl_opening *loop)
{
    float width = piece->box.upper.x - piece->box.lower.x;
    return (loop->centre.x - (piece->box.upper.x + piece->box.lower.x) / 2) / fmaxf(width, FLT_MIN);
}

/* Height of a loop in the piece, 0 to 1. */
static float level_of(const struct opening_piece *piece, const struct tl_opening *loop)
{
    float height = piece->box.upper.y - piece->box.lower.y;
    return (loop->centre.y - piece->box.lower.y) / fmaxf(height, FLT_MIN);
}

/* The kind of a loop; KINDS: nothing known. Small holes and slits are not openings that somebody wears. */
static int kind_of(const struct opening_piece *piece, const struct tl_opening *loop)
{
    const float in_middle = 0.08f, at_side = 0.12f, upright = 0.5f, down = -0.85f, bottom = 0.15f;
    const float small = 0.13f; /* of the piece's height */
    float side = side_of(piece, loop);
    if ((float)loop->length < small * (piece->box.upper.y - piece->box.lower.y))
        return KINDS;
    if (fabsf(side) < in_middle && fabsf(loop->normal.y) > upright)
        return loop->normal.y > 0 ? LIKE_TOP : LIKE_HEM;
    if (fabsf(side) < at_side)
        return KINDS;
    return loop->normal.y < down && level_of(piece, loop) < bottom ? LIKE_LEG : LIKE_ARM;
}

static void sort_in(struct opening_piece *piece, struct tl_opening *loop)
{
    int kind = kind_of(piece, loop);
    if (kind == KINDS || piece->counts[kind]++ >= 2)
        return;
    struct tl_opening **pair = piece->loops[kind];
    pair[1] = pair[0];
    pair[0] = loop;
    if (pair[1] && pair[1]->centre.x > loop->centre.x) {
        pair[0] = pair[1];
        pair[1] = loop;
    }
}

/* One on each side, about as long and as high. */
static bool is_pair(const struct opening_piece *piece, int kind)
{
    const double alike = 0.2;
    struct tl_opening *const *pair = piece->loops[kind];
    return piece->counts[kind] == 2 && side_of(piece, pair[0]) > 0 && side_of(piece, pair[1]) < 0 &&
           fabs(log(pair[0]->length / pair[1]->length)) < alike &&
           fabsf(level_of(piece, pair[0]) - level_of(piece, pair[1])) < (float)alike;
}

/* ---- Names ---- */

static void set_name(struct tl_opening *loop, const char *name)
{
    snprintf(loop->name, sizeof loop->name, "%s", name);
}

static void name_pair(const struct opening_piece *piece, int kind, const char *name)
{
    snprintf(piece->loops[kind][0]->name, TL_OPENING_NAME, "left %s", name);
    snprintf(piece->loops[kind][1]->name, TL_OPENING_NAME, "right %s", name);
}

/* Half the width of a loop across the body. */
static float half_width(const struct tl_opening_mesh *mesh, const struct tl_opening *loop)
{
    float lower = FLT_MAX, upper = -FLT_MAX;
    for (size_t i = 0; i < loop->side_count; i++) {
        float x = mesh->positions[loop->vertices[i]].x;
        lower = fminf(lower, x);
        upper = fmaxf(upper, x);
    }
    return (upper - lower) / 2;
}

/* Armholes lie in the trunk, near the neck, and do not look down as sleeves do, unless those are stretched
 * out and then reach farther. */
static bool is_armhole(const struct tl_opening_mesh *mesh, const struct opening_piece *piece)
{
    const float down = -0.15f, near = 2.2f;
    const struct tl_opening *const neck = piece->loops[LIKE_TOP][0];
    struct tl_opening *const *pair = piece->loops[LIKE_ARM];
    float offset = (pair[0]->centre.x - pair[1]->centre.x) / 2;
    return (pair[0]->normal.y + pair[1]->normal.y) / 2 > down && offset < near * half_width(mesh, neck);
}

/* Mean distance from the loop's own axis of what lies in a slab of the piece, metres; 0: nothing does. */
static double slab_radius(const struct tl_opening_mesh *mesh, const uint32_t *roots,
                          const struct tl_opening *loop, double from, double to)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s at = mesh->positions[i];
        if (roots[i] != roots[loop->vertices[0]] || (double)at.y < from || (double)at.y > to)
            continue;
        sum += hypot((double)(at.x - loop->centre.x), (double)(at.z - loop->centre.z));
        count++;
    }
    return count > 0 ? sum / (double)count : 0;
}

/* Whether the piece is narrower somewhere below its top than there: it hangs from the bust. */
static bool is_above_waist(const struct tl_opening_mesh *mesh, const uint32_t *roots,
                           const struct opening_piece *piece)
{
    enum { SLABS = 16 };
    const double narrower = 0.95;
    double height = (double)(piece->box.upper.y - piece->box.lower.y), top = (double)piece->box.upper.y;
    double radius = slab_radius(mesh, roots, piece->loops[LIKE_TOP][0], top - height / SLABS, top);
    for (int slab = 1; slab < SLABS; slab++) {
        double below = slab_radius(mesh, roots, piece->loops[LIKE_TOP][0], top - (slab + 1) * height / SLABS,
                                   top - slab * height / SLABS);
        if (below > 0 && below < narrower * radius)
            return true;
    }
    return false;
}

static void name_piece(const struct tl_opening_mesh *mesh, const uint32_t *roots,
                       const struct opening_piece *piece)
{
    bool has_top = piece->counts[LIKE_TOP] == 1, has_arms = is_pair(piece, LIKE_ARM);
    bool has_legs = is_pair(piece, LIKE_LEG);
    if (piece->loop_count == 1) /* a sheet */
        return;
    if (has_top && has_arms)
        set_name(piece->loops[LIKE_TOP][0], "neck");
    else if (has_top && piece->counts[LIKE_ARM] == 0 && (has_legs || piece->counts[LIKE_HEM] == 1))
        set_name(piece->loops[LIKE_TOP][0],
                 !has_legs && is_above_waist(mesh, roots, piece) ? "top" : "waist");
    if (piece->counts[LIKE_HEM] == 1)
        set_name(piece->loops[LIKE_HEM][0], "hem");
    if (has_arms && has_top)
        name_pair(piece, LIKE_ARM, is_armhole(mesh, piece) ? "armhole" : "cuff");
    if (has_legs)
        name_pair(piece, LIKE_LEG, "leg hem");
}

/* Counts those of the first `end` openings that have a name, not counting the numbers that were added to it.
 */
static size_t count_named(const struct tl_openings *openings, size_t end, const char *name)
{
    size_t count = 0, length = strlen(name);
    for (size_t i = 0; i < end; i++) {
        const char *rest = openings->items[i].name + length;
        count += strncmp(openings->items[i].name, name, length) == 0 &&
                 (*rest == '\0' || (*rest == ' ' && strspn(rest + 1, "0123456789") == strlen(rest + 1)));
    }
    return count;
}

/* Gives a name to those that have none, and numbers to those that share one. */
static void make_distinct(struct tl_openings *openings, const bool *sheets)
{
    for (size_t i = 0; i < openings->count; i++) {
        char *name = openings->items[i].name;
        bool known = name[0] != '\0';
        if (!known)
            set_name(&openings->items[i], sheets[i] ? "outline" : "opening");
        size_t before = count_named(openings, i, name), length = strlen(name);
        if (!known || before > 0)
            snprintf(name + length, TL_OPENING_NAME - length, " %u", (unsigned)before + 1);
    }
}

static void name_all(const struct tl_opening_mesh *mesh, struct tl_openings *openings)
{
    uint32_t *roots = find_pieces(mesh);
    bool *sheets = TL_NEW_ARRAY(bool, openings->count), *done = TL_NEW_ARRAY(bool, openings->count);
    for (size_t first = 0; first < openings->count; first++) {
        uint32_t root = roots[openings->items[first].vertices[0]];
        if (done[first])
            continue;
        struct opening_piece piece = {.box = box_of_piece(mesh, roots, root)};
        for (size_t i = first; i < openings->count; i++) {
            if (roots[openings->items[i].vertices[0]] != root)
                continue;
            done[i] = true;
            piece.loop_count++;
        }
        sheets[first] = piece.loop_count == 1;
        for (size_t i = first; i < openings->count; i++)
            if (roots[openings->items[i].vertices[0]] == root)
                sort_in(&piece, &openings->items[i]);
        name_piece(mesh, roots, &piece);
    }
    make_distinct(openings, sheets);
    free(done);
    free(sheets);
    free(roots);
}

/* A raised arm may come first by its height: of a pair the left one does. */
static void order_pairs(struct tl_openings *openings)
{
    for (size_t i = 0; i < openings->count; i++)
        for (size_t j = i + 1; j < openings->count; j++) {
            struct tl_opening *first = &openings->items[i], *second = &openings->items[j];
            if (strncmp(first->name, "right ", 6) != 0 || strncmp(second->name, "left ", 5) != 0 ||
                strcmp(first->name + 6, second->name + 5) != 0)
                continue;
            struct tl_opening right = *first;
            *first = *second;
            *second = right;
        }
}

bool tl_openings_find(const struct tl_opening_mesh *mesh, struct tl_openings *out)
{
    const struct tl_loop_source source = {mesh->vertex_count, mesh->triangle_count, mesh->triangles};
    struct tl_loops loops;
    *out = (struct tl_openings){0};
    if (!tl_loops_find(&source, &loops))
        return false;
    out->count = loops.count;
    out->items = TL_NEW_ARRAY(struct tl_opening, loops.count);
    for (size_t i = 0; i < loops.count; i++)
        out->items[i] = take_loop(&loops, i, mesh->positions);
    tl_loops_release(&loops);
    qsort(out->items, out->count, sizeof *out->items, compare_openings);
    name_all(mesh, out);
    order_pairs(out);
    return true;
}

void tl_openings_release(struct tl_openings *openings)
{
    for (size_t i = 0; i < openings->count; i++) {
        free(openings->items[i].vertices);
        free(openings->items[i].triangles);
    }
    free(openings->items);
    *openings = (struct tl_openings){0};
}

const struct tl_opening *tl_openings_named(const struct tl_openings *openings, const char *name)
{
    for (size_t i = 0; i < openings->count; i++)
        if (strcmp(openings->items[i].name, name) == 0)
            return &openings->items[i];
    return NULL;
}
