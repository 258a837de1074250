/* The probes at which visibility is kept: every vertex of every surface, seen from either side, in clusters
 * of sixteen neighbours that face much the same way, so that their rays run together. Vertices at one place
 * that share a normal (seams of the mesh) are one probe. Vertices with light of their own are in clusters of
 * their own. Made once for a topology. Pure. */
#ifndef TOILE_RENDER_VISIBILITY_CACHE_PROBES_H
#define TOILE_RENDER_VISIBILITY_CACHE_PROBES_H

#include "render/gbuffer/samples.h"

#define TL_CLUSTER 16 /* probes; as many as a bundle has rays */

struct tl_cache_probe {
    uint32_t surface; /* index into the ranges' surfaces; TL_CACHE_PROBE_NONE: fills up a cluster */
    uint32_t vertex;
    bool back;
};
#define TL_CACHE_PROBE_NONE UINT32_MAX

struct tl_cache_probes {
    size_t cluster_count;
    struct tl_cache_probe *items; /* [cluster_count][TL_CLUSTER] */
    uint32_t *first_vertex;       /* by surface: where its vertices begin in of_vertex */
    uint32_t *of_vertex;          /* [all vertices][front, back]: probe */
};

void tl_cache_probes_build(const struct tl_triangle_ranges *ranges, struct tl_cache_probes *out);
void tl_cache_probes_release(struct tl_cache_probes *probes);

static inline uint32_t tl_cache_probe_at(const struct tl_cache_probes *probes, size_t surface,
                                         uint32_t vertex, bool back)
{
    return probes->of_vertex[2 * ((size_t)probes->first_vertex[surface] + vertex) + back];
}

#endif
