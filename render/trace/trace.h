/* Ray tracing against the surfaces of a frame, by Embree's BVH, with alpha cutouts and with cloth that is
 * open between its threads.
 *
 * The BVH follows the motion by refitting or rebuilding, according to the revisions of the surfaces. Both
 * sides of every triangle block rays. The ground is not included: it is an ideal disc whose visibility is
 * tl_ground_visibility. World space, metres.
 *
 * Threads: queries may run on any number of threads after tl_trace_update; their results do not depend on it.
 */
#ifndef TOILE_RENDER_TRACE_TRACE_H
#define TOILE_RENDER_TRACE_TRACE_H

#include "assets/base/surface.h"

typedef struct tl_trace tl_trace;

enum { TL_TRACE_NONE = 0xffffffff };

struct tl_trace_hit {
    uint32_t surface; /* index into the surfaces; TL_TRACE_NONE: no hit */
    uint32_t triangle;
    float u, v; /* barycentric weights of the triangle's second and third corner */
    float distance_m;
    bool back; /* the back of the triangle was hit */
};

/* An empty BVH. Errors: NULL with TL_DEVICE if Embree cannot start. */
tl_trace *tl_trace_create(tl_error *error);
/* Frees and nulls; accepts null. */
void tl_trace_destroy(tl_trace **trace);

/* Updates the BVH; surfaces that did not change are not rebuilt. The surfaces must outlive the queries.
 * Errors: TL_DEVICE if Embree cannot build the BVH. */
bool tl_trace_update(tl_trace *trace, const tl_surface *surfaces, size_t count, tl_error *error);

/* The nearest hit between from_m and to_m along a unit direction. Rays that are not finite hit nothing. */
struct tl_trace_hit tl_trace_nearest(const tl_trace *trace, vec3s origin, vec3s direction, float from_m,
                                     float to_m);
/* True if anything is hit. */
bool tl_trace_occluded(const tl_trace *trace, vec3s origin, vec3s direction, float from_m, float to_m);

/* A packet of up to 16 rays. With one direction and neighbouring origins (`coherent`) packets are several
 * times as fast as single rays. */
struct tl_ray_packet {
    int count; /* 1 to 16 */
    float origin_x[16], origin_y[16], origin_z[16];
    /* unit; or of any length, which is then the unit of from_m and to_m */
    float direction_x[16], direction_y[16], direction_z[16];
    float from_m, to_m;
    bool coherent;
};
/* Bit i of the result: ray i is blocked. */
uint32_t tl_trace_occluded_packet(const tl_trace *trace, const struct tl_ray_packet *packet);

/* The transmittance of each ray of the packet, in [0, 1]: every sheet of an open material multiplies it by
 * its openness, at any angle; other surfaces make it 0. (The other queries treat open sheets as closed.) */
void tl_trace_transmittance_packet(const tl_trace *trace, const struct tl_ray_packet *packet,
                                   float transmittance[16]);

/* The point on the smooth surface that a point of a triangle stands for: the weighted mean of its projections
 * on the tangent planes of the corners, where these lie outside [Hanika 2021]. `weights` are barycentric; the
 * normals point to the side of the viewer. */
vec3s tl_smooth_point(vec3s point, const vec3s corners[3], const vec3s normals[3], const float weights[3]);

/* Distance (m) from its own surface at which a ray may safely start: 1e-4 of the half diagonal of the
 * bounding box of all surfaces. */
float tl_trace_offset(const tl_trace *trace);
/* The same for surfaces in this box. */
float tl_trace_offset_in(vec3s low, vec3s high);

/* Memory of the BVH, as reported by Embree. */
size_t tl_trace_bytes(const tl_trace *trace);

#endif
