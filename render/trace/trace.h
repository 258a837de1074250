/* Rays against the surfaces of a frame: Embree's BVH, with the holes that alpha maps cut, and with cloth that
 * is open between its threads.
 *
 * Follows the motion by refitting or rebuilding, by the surfaces' revisions. Both sides of every triangle
 * stop rays. The ground is no part of it: it is an ideal disc whose share is tl_ground_visibility. World
 * space, metres. After tl_trace_update, questions may be asked from any number of threads; answers do not
 * depend on it. */
#ifndef TOILE_RENDER_TRACE_TRACE_H
#define TOILE_RENDER_TRACE_TRACE_H

#include "assets/base/surface.h"

typedef struct tl_trace tl_trace;

enum { TL_TRACE_NONE = 0xffffffff };

struct tl_trace_hit {
    uint32_t surface; /* index into the surfaces given; TL_TRACE_NONE: nothing hit */
    uint32_t triangle;
    float u, v; /* barycentric weights of the triangle's second and third corner */
    float distance_m;
    bool back; /* the triangle's back was hit */
};

tl_trace *tl_trace_create(tl_error *error);
void tl_trace_destroy(tl_trace **trace);

/* The surfaces must outlive the questions. What has not changed is not built again. */
bool tl_trace_update(tl_trace *trace, const tl_surface *surfaces, size_t count, tl_error *error);

struct tl_trace_hit tl_trace_nearest(const tl_trace *trace, vec3s origin, vec3s direction, float from_m,
                                     float to_m);
bool tl_trace_occluded(const tl_trace *trace, vec3s origin, vec3s direction, float from_m, float to_m);

/* Up to 16 rays at once. One direction and neighbouring origins (`coherent`) are several times as fast as
 * single rays. Bit i of the answer: ray i is stopped. */
struct tl_ray_packet {
    int count; /* 1 to 16 */
    float origin_x[16], origin_y[16], origin_z[16];
    /* Unit; or all of any length, which from_m and to_m are then counted in. */
    float direction_x[16], direction_y[16], direction_z[16];
    float from_m, to_m;
    bool coherent;
};
uint32_t tl_trace_occluded_packet(const tl_trace *trace, const struct tl_ray_packet *bundle);

/* What each ray of the bundle is let through, in [0, 1]: every sheet of an open material leaves its openness
 * of it, at whatever angle it is crossed; what is not open stops it. (To the questions above an open sheet is
 * a sheet.) */
void tl_trace_transmittance_packet(const tl_trace *trace, const struct tl_ray_packet *bundle, float seen[16]);

/* A point of a triangle, moved out to where the smooth surface is that the triangle stands for: the weighted
 * mean of its projections on the tangent planes of the corners, where these lie outside [Hanika 2021,
 * "Hacking the shadow terminator", Ray Tracing Gems II, ch. 4]. `weights` are barycentric; normals on the
 * side that is looked at. */
vec3s tl_smooth_point(vec3s point, const vec3s corners[3], const vec3s normals[3], const float weights[3]);

/* Metres: how far off its own surface a ray may safely start, 1e-4 of the half diagonal of all there is. */
float tl_trace_offset(const tl_trace *trace);

size_t tl_trace_bytes(const tl_trace *trace); /* of the BVH, as Embree tells */

#endif
