/* Open seams. A border is a side of one triangle and of no other. Where a garment should be sewn, two borders
 * lie along one another in opposite directions, with the cloth of one on the far side of the other's. Layers
 * that end together, such as a lining at its hem, lie on one side of their borders, and are none. */
#include "app/audit/audit_internal.h"
#include "app/fit/sewn.h"
#include "assets/topology/sets.h"
#include "cloth/self_contact/near_tree.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* Borders farther apart than this, or than this share of the shorter side, are meant to be apart. */
#define GAP_M     1e-3
#define GAP_SHARE 0.1
/* Cosine between sides, above which they run along one another. */
#define ALONG 0.8
/* Points of a side that must all lie at another border, as shares of its length. */
static const double samples[] = {0.1, 0.5, 0.9};

struct border {
    uint32_t triangle; /* of the topology */
    uint32_t ends[2];  /* sewn vertices */
    vec3d from, along; /* along: unit */
    vec3d inwards;     /* unit: towards the cloth, across the side */
    double length;
    double gap;     /* the widest at a sample */
    unsigned found; /* bit i: sample i lies at another border */
};

/* The number of triangles at each edge of the topology; 2: or more. */
static uint8_t *count_triangles(const struct tl_topology *topology)
{
    uint8_t *counts = TL_NEW_ARRAY(uint8_t, topology->edge_count);
    for (uint32_t i = 0; i < 3 * topology->triangle_count; i++) {
        const uint32_t *corners = topology->triangles[i / 3];
        uint32_t edge = tl_topology_edge(topology, corners[i % 3], corners[(i + 1) % 3]);
        counts[edge] = counts[edge] < 2 ? (uint8_t)(counts[edge] + 1) : 2;
    }
    return counts;
}

/* The border from corner k of a triangle; false where it or the triangle has no extent. */
static bool make_border(const tl_mesh *mesh, const struct tl_topology *topology, uint32_t triangle,
                        uint32_t k, struct border *out)
{
    uint32_t source = topology->source[triangle];
    vec3d from = vec3d_from(audit_corner(mesh, source, k)),
          to = vec3d_from(audit_corner(mesh, source, (k + 1) % 3)),
          far = vec3d_from(audit_corner(mesh, source, (k + 2) % 3));
    *out = (struct border){.triangle = triangle, .from = from, .length = vec3d_distance(from, to)};
    out->ends[0] = topology->triangles[triangle][k];
    out->ends[1] = topology->triangles[triangle][(k + 1) % 3];
    if (out->length == 0)
        return false;
    out->along = vec3d_scale(vec3d_sub(to, from), 1 / out->length);
    vec3d arm = vec3d_sub(far, from), across = vec3d_muladd(arm, out->along, -vec3d_dot(arm, out->along));
    double height = vec3d_norm(across);
    out->inwards = vec3d_scale(across, height > 0 ? 1 / height : 0);
    return height > 0;
}

/* A new array of the borders. */
static struct border *find_borders(const tl_mesh *mesh, const struct tl_topology *topology, size_t *count)
{
    uint8_t *counts = count_triangles(topology);
    size_t maximum = 0;
    for (size_t e = 0; e < topology->edge_count; e++)
        maximum += counts[e] == 1;
    struct border *borders = TL_NEW_ARRAY(struct border, maximum);
    *count = 0;
    for (uint32_t i = 0; *count < maximum && i < 3 * topology->triangle_count; i++) {
        const uint32_t *corners = topology->triangles[i / 3];
        uint32_t edge = tl_topology_edge(topology, corners[i % 3], corners[(i + 1) % 3]);
        if (counts[edge] == 1)
            *count += make_border(mesh, topology, i / 3, i % 3, &borders[*count]);
    }
    free(counts);
    return borders;
}

/* Marks the samples of one border that lie at another one; returns whether there is one. */
static bool mark(struct border *border, const struct border *other)
{
    double gap = tl_min(GAP_M, GAP_SHARE * tl_min(border->length, other->length));
    bool found = false;
    if (vec3d_dot(border->along, other->along) > -ALONG || vec3d_dot(border->inwards, other->inwards) > 0)
        return false;
    for (unsigned i = 0; i < TL_COUNT(samples); i++) {
        vec3d point = vec3d_muladd(border->from, border->along, samples[i] * border->length);
        double at = vec3d_dot(vec3d_sub(point, other->from), other->along);
        at = tl_min(tl_max(at, 0), other->length);
        double distance = vec3d_distance(point, vec3d_muladd(other->from, other->along, at));
        if (distance > gap)
            continue;
        border->gap = tl_max(border->gap, distance);
        border->found |= 1u << i;
        found = true;
    }
    return found;
}

/* The pairs of borders whose boxes come within the gap, as of flat triangles. */
static struct tl_near_pairs near_pairs(const struct border *borders, size_t count)
{
    struct tl_topology sides = {.vertex_count = 2 * count,
                                .triangle_count = count,
                                .triangles = tl_alloc(count, sizeof *sides.triangles)};
    vec3d *x = TL_NEW_ARRAY(vec3d, 2 * count);
    double *margins = TL_NEW_ARRAY(double, 2 * count);
    for (uint32_t i = 0; i < count; i++) {
        sides.triangles[i][0] = 2 * i;
        sides.triangles[i][1] = sides.triangles[i][2] = 2 * i + 1;
        x[2 * i] = borders[i].from;
        x[2 * i + 1] = vec3d_muladd(borders[i].from, borders[i].along, borders[i].length);
        margins[2 * i] = margins[2 * i + 1] = GAP_M / 2;
    }
    struct tl_near_tree tree = tl_near_tree_create(&sides, x);
    tl_near_tree_refit(&tree, &sides, x, margins, NULL);
    /* A border has two neighbours, and at a seam two or three more; a damaged file may be one heap. */
    const size_t for_small = 1 << 20, of_border = 64;
    struct tl_near_pairs all = {0};
    for (size_t task = 0; task < tree.task_count; task++) {
        struct tl_near_pairs found = {.limit = (for_small + of_border * count) / tree.task_count + 1};
        tl_near_tree_pairs(&tree, task, &found);
        tl_near_pairs_append(&all, &found);
        tl_near_pairs_release(&found);
    }
    tl_near_tree_release(&tree);
    free(margins);
    free(x);
    free(sides.triangles);
    return all;
}

static bool is_open(const struct border *border)
{
    return border->found == (1u << TL_COUNT(samples)) - 1;
}

struct seam {
    double length_m, gap_m; /* of both borders together; the widest */
};

/* Adds a finding for each set of open borders that follow or face one another. */
static void report(tl_audit *audit, const tl_model *model, const struct tl_topology *topology,
                   const struct border *borders, size_t count, uint32_t *sets)
{
    struct seam *seams = TL_NEW_ARRAY(struct seam, count);
    uint32_t *at_vertex = tl_alloc(topology->vertex_count, sizeof *at_vertex); /* plus one */
    for (uint32_t i = 0; i < count; i++)
        for (int end = 0; is_open(&borders[i]) && end < 2; end++) {
            uint32_t *known = &at_vertex[borders[i].ends[end]];
            if (*known > 0)
                tl_sets_join(sets, i, *known - 1);
            *known = i + 1;
        }
    for (uint32_t i = 0; i < count; i++) {
        struct seam *seam = &seams[tl_sets_find(sets, i)];
        seam->length_m += is_open(&borders[i]) ? borders[i].length : 0;
        seam->gap_m = is_open(&borders[i]) ? tl_max(seam->gap_m, borders[i].gap) : seam->gap_m;
    }
    for (uint32_t i = 0; i < count; i++) {
        struct seam *seam = &seams[tl_sets_find(sets, i)];
        if (!is_open(&borders[i]) || seam->length_m == 0)
            continue;
        audit_add(audit, TL_AUDIT_SEAM_OPEN, model, topology->source[borders[i].triangle],
                  "open along %.1f mm, up to %.3g mm wide", 1e3 * seam->length_m / 2, 1e3 * seam->gap_m);
        seam->length_m = 0;
    }
    free(at_vertex);
    free(seams);
}

void audit_seams(tl_audit *audit, const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t sewn = tl_sewn_weld(garment, weld);
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, sewn);
    size_t count;
    struct border *borders = find_borders(mesh, &topology, &count);
    struct tl_near_pairs pairs = near_pairs(borders, count);
    uint32_t *sets = tl_sets_create(count);
    for (size_t i = 0; i < pairs.count; i++) {
        struct border *a = &borders[pairs.pairs[i][0]], *b = &borders[pairs.pairs[i][1]];
        bool a_at_b = mark(a, b), b_at_a = mark(b, a);
        if (a_at_b || b_at_a)
            tl_sets_join(sets, pairs.pairs[i][0], pairs.pairs[i][1]);
    }
    report(audit, &garment->model, &topology, borders, count, sets);
    free(sets);
    tl_near_pairs_release(&pairs);
    free(borders);
    tl_topology_release(&topology);
    free(weld);
}
