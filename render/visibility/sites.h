/* Where visibility may be kept: every vertex of every surface, seen from either side, in clusters of sixteen
 * neighbours that face much the same way, so that their rays run together. Vertices at one place that share a
 * normal (seams of the mesh) are one site. Made once for a topology. Pure. */
#ifndef TOILE_RENDER_VISIBILITY_SITES_H
#define TOILE_RENDER_VISIBILITY_SITES_H

#include "render/light/samples.h"

#define TL_CLUSTER 16 /* sites; as many as a bundle has rays */

struct tl_site {
    uint32_t surface; /* index into the ranges' surfaces; TL_SITE_NONE: fills up a cluster */
    uint32_t vertex;
    bool back;
};
#define TL_SITE_NONE UINT32_MAX

struct tl_sites {
    size_t cluster_count;
    struct tl_site *items;  /* [cluster_count][TL_CLUSTER] */
    uint32_t *first_vertex; /* by surface: where its vertices begin in of_vertex */
    uint32_t *of_vertex;    /* [all vertices][front, back]: site */
};

void tl_sites_build(const struct tl_triangle_ranges *ranges, struct tl_sites *out);
void tl_sites_release(struct tl_sites *sites);

static inline uint32_t tl_site_of(const struct tl_sites *sites, size_t surface, uint32_t vertex, bool back)
{
    return sites->of_vertex[2 * ((size_t)sites->first_vertex[surface] + vertex) + back];
}

#endif
