/* Triangles that are no triangles, are there twice, or share an edge with two others. */
#include "app/audit/audit_internal.h"
#include "assets/topology/sets.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A triangle lower than this share of its longest side is a line: the positions of a garment are rounded to
 * 1e-7 m, so that such a height on sides of a millimetre is rounding. */
#define FLAT_SHARE 1e-4

/* Whether the height of a triangle above its longest side is nearly zero. */
static bool is_flat(vec3d a, vec3d b, vec3d c)
{
    vec3d ab = vec3d_sub(b, a), ac = vec3d_sub(c, a), bc = vec3d_sub(c, b);
    double longest2 = tl_max(tl_max(vec3d_dot(ab, ab), vec3d_dot(ac, ac)), vec3d_dot(bc, bc));
    return vec3d_norm(vec3d_cross(ab, ac)) <= FLAT_SHARE * longest2;
}

static bool same(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

void audit_degenerate(tl_audit *audit, struct audited *audited)
{
    const tl_mesh *mesh = audited->mesh;
    for (size_t t = 0; t < mesh->index_count / 3; t++) {
        vec3s a = audit_corner(mesh, t, 0), b = audit_corner(mesh, t, 1), c = audit_corner(mesh, t, 2);
        bool has_double = same(a, b) || same(b, c) || same(c, a);
        audited->degenerate[t] = has_double || is_flat(vec3d_from(a), vec3d_from(b), vec3d_from(c));
        if (audited->degenerate[t])
            audit_add(audit, TL_AUDIT_TRIANGLE_DEGENERATE, audited->model, (int64_t)t,
                      has_double ? "two of its corners are at one place" : "its corners lie on a line");
    }
}

/* The topology keeps each set of corners once. */
static void find_repeated(tl_audit *audit, const struct audited *audited)
{
    size_t count = audited->mesh->index_count / 3;
    bool *kept = TL_NEW_ARRAY(bool, count);
    for (size_t t = 0; t < audited->topology.triangle_count; t++)
        kept[audited->topology.source[t]] = true;
    for (size_t t = 0; t < count; t++)
        if (!kept[t] && !audited->degenerate[t])
            audit_add(audit, TL_AUDIT_TRIANGLE_REPEATED, audited->model, (int64_t)t,
                      "another triangle has its three corners");
    free(kept);
}

/* Edges of more than two triangles that touch one another are one finding. */
static void find_crowded(tl_audit *audit, const struct audited *audited)
{
    const struct tl_topology *topology = &audited->topology;
    uint8_t *counts = TL_NEW_ARRAY(uint8_t, topology->edge_count);
    uint32_t *lines = tl_sets_create(topology->vertex_count);
    uint32_t *lengths = TL_NEW_ARRAY(uint32_t, topology->vertex_count);
    for (size_t i = 0; i < 3 * topology->triangle_count; i++) {
        const uint32_t *corners = topology->triangles[i / 3];
        uint32_t edge = tl_topology_edge(topology, corners[i % 3], corners[(i + 1) % 3]);
        counts[edge] = counts[edge] < 3 ? (uint8_t)(counts[edge] + 1) : 3;
    }
    for (size_t e = 0; e < topology->edge_count; e++)
        if (counts[e] > 2)
            tl_sets_join(lines, topology->edges[e][0], topology->edges[e][1]);
    for (size_t e = 0; e < topology->edge_count; e++)
        lengths[tl_sets_find(lines, topology->edges[e][0])] += counts[e] > 2;
    for (size_t i = 0; i < 3 * topology->triangle_count; i++) {
        const uint32_t *corners = topology->triangles[i / 3];
        uint32_t edge = tl_topology_edge(topology, corners[i % 3], corners[(i + 1) % 3]);
        uint32_t *length = &lengths[tl_sets_find(lines, corners[i % 3])];
        if (counts[edge] <= 2 || *length == 0)
            continue;
        audit_add(audit, TL_AUDIT_EDGE_CROWDED, audited->model, topology->source[i / 3],
                  "edges of three triangles or more that touch one another: %u", *length);
        *length = 0;
    }
    free(lengths);
    free(lines);
    free(counts);
}

void audit_repeated(tl_audit *audit, const struct audited *audited)
{
    find_repeated(audit, audited);
    find_crowded(audit, audited);
}
