/* The rays of the visibility cache: one cluster of points at a time, all its members in one direction at
 * once. Part of points.c. Threads: different clusters at the same time. */
#ifndef TOILE_RENDER_VISIBILITY_REFRESH_H
#define TOILE_RENDER_VISIBILITY_REFRESH_H

#include "render/gpu/vectors.h"
#include "render/visibility/cache_probes.h"
#include "render/visibility/points_request.h"

#include "render/gpu/terms_begin.h"

#include "render/visibility/visibility_terms.glsl"

#include "render/gpu/terms_end.h"

/* Data of one update that the rays of all clusters share. */
struct tl_refresh {
    const struct tl_points_request *request;
    size_t stride;            /* of values, and of the arrays by region */
    const vec3s *directions;  /* [regions][params->rays]: of all clusters, world; NULL: each has its own */
    const vec3s *centres;     /* [regions]: world */
    const float *importances; /* [regions] */
    float offset_m;           /* where rays start above their surface */
    uint32_t frame;           /* counts updates, from 1 */
    bool whole_rounds;        /* all regions are traced; in motion this is the first round of a rest */
};

/* Factor on the number of rays of a frame at rest. Such a frame saves the G-buffer, its read-back and the
 * BVH, and still costs a third less than one in motion. */
#define TL_REST_RAY_FACTOR 2

/* A cluster in use. */
struct tl_cluster {
    size_t number;                       /* chooses its directions at rest */
    const struct tl_cache_probe *probes; /* TL_CLUSTER of them */
    uint32_t members;                    /* bit i: probe i is visible */
    uint32_t fresh;                      /* bit i: ... and holds nothing of use yet: every region is traced */
    uint16_t *values;                    /* [TL_CLUSTER][stride] */
    uint16_t *weights; /* [TL_CLUSTER][stride]: at rest: of all directions in a mean; 0: none */
    uint16_t *rounds;  /* [stride]: frames at rest in which a region was traced */
    uint16_t *covered; /* bit i: something lies close above probe i; kept up to date */
    uint32_t *stamps;  /* [stride]: frame when each region was last traced */
};

/* Traces the regions that the cluster needs most, and all regions for new members. In motion the results
 * replace the values; at rest they are averaged until every region has had its rounds. Returns the number of
 * rays. */
size_t tl_cluster_refresh(const struct tl_refresh *refresh, const struct tl_cluster *cluster);

/* The smallest number of rounds that any region has had at rest. */
int tl_cluster_rounds(const struct tl_refresh *refresh, const struct tl_cluster *cluster);

/* Traces a round of all regions from bundle number `bundle` of up to TL_CLUSTER places that are not cached
 * points, `normals` on the visible side. `values` and `weights` are [count][stride]. Returns the number of
 * rays. */
size_t tl_places_trace(const struct tl_refresh *refresh, size_t bundle, int round, const vec3s *origins,
                       const vec3s *normals, int count, uint16_t *values, uint16_t *weights);

#endif
