/* Visibility by rays, kept at points of the surfaces: one number for each point and region, which stays with
 * the vertex and so survives deformation. This cache is refreshed by importance and age
 * (docs/notes/visibility.md).
 *
 * A point is a render vertex seen from one side, or an extra point that a sample owns (repair). A sample
 * reads up to three points with weights. In motion R regions of each visible point are traced again each
 * frame, in directions jittered inside the region, and replace what was there; at rest as many are averaged
 * in, until every region has had its rounds. Results do not depend on the number of threads. */
#ifndef TOILE_RENDER_VISIBILITY_POINTS_H
#define TOILE_RENDER_VISIBILITY_POINTS_H

#include "render/visibility/points_request.h"

typedef struct tl_points tl_points;

tl_points *tl_points_create(void);
void tl_points_destroy(tl_points **points);

void tl_points_update(tl_points *points, const struct tl_points_request *request);
/* Returns, after an update at rest, whether another one would change nothing. */
bool tl_points_are_done(const tl_points *points);

/* After an update. Visibility of region i at point p is values[p * stride + i] / TL_VISIBILITY_ONE; stride is
 * a multiple of 16 and what lies beyond the regions is 0. One taps entry a sample. */
const uint16_t *tl_points_values(const tl_points *points, size_t *stride);
/* The world directions of the rays of all vertices in motion, [regions][rays]. The caller frees them. */
vec3s *tl_points_directions(const struct tl_regions *regions, int rays, float environment_yaw);
/* Updates since the region was traced from there, or since nothing moved; 0 of points that samples own, which
 * are traced in every moving frame. */
uint32_t tl_points_age(const tl_points *points, uint32_t point, int region);
/* Whether the last update was for samples. Others are for triangles, and may move the points that earlier
 * taps name: then tl_points_taps is NULL. */
bool tl_points_are_for_samples(const tl_points *points);
const struct tl_taps *tl_points_taps(const tl_points *points);
/* Whether the last update was for triangles in motion: then vertices without light of their own (struct
 * tl_light_mesh) have no points. */
bool tl_points_are_sparse(const tl_points *points);
/* The point of a vertex of a triangle that was seen in the last update, from the side that was seen; and
 * whether something lies close above it, so that its values do not hold for neighbours that are not covered.
 */
float tl_points_cover_m(const tl_trace *trace); /* so close */
uint32_t tl_points_of_vertex(const tl_points *points, size_t surface, uint32_t vertex, bool back);
bool tl_points_is_covered(const tl_points *points, uint32_t point);
/* Visibility of the sun by sample, [sun][sample], in [0, 1]; NULL when no sun stands apart. */
const float *tl_points_sun(const tl_points *points, int sun);

/* For `toile plan`, tests and tuning: how much was done in the last update. */
struct tl_points_report {
    size_t points, visible_points, repaired_samples, rays;
    double disagreement; /* mean over samples of the largest difference between a sample's points */
};
struct tl_points_report tl_points_report(const tl_points *points);
size_t tl_points_visible(const tl_points *points); /* in the last update */
size_t tl_points_bytes(const tl_points *points);

#endif
