/* Shared by the files of this room: the materials that rays meet, the sky that they reach, and what a vertex
 * finds by its rays. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCE_INTERNAL_H
#define TOILE_RENDER_BOUNCE_BOUNCE_INTERNAL_H

#include "render/bounce/bounce.h"

/* Rays of a vertex in an update: spread over its hemisphere, and towards the sky's bright parts. */
#define TL_BOUNCE_RAYS     16
#define TL_BOUNCE_SKY_RAYS 8

/* A part's material by its mean colours; of two: front, back. */
struct tl_bounce_material {
    vec3s albedo[2]; /* of all light that arrives, but what is sent by lobes */
    vec3s whole[2];  /* ... with what is sent by lobes */
    vec3s diffuse[2], specular[2];
    vec3s emission;     /* radiance */
    vec3s transmission; /* from either side to the other */
    float openness;
    bool has_lobes; /* its gloss depends on where it is seen from */
};

/* Reads the materials of all parts, in the order of surfaces and parts; the result is the caller's. */
struct tl_bounce_material *tl_bounce_materials_read(const struct tl_triangle_ranges *ranges);

/* Fills `shown` with the means of each vertex and its neighbours: bounced light varies slowly, the noise of
 * sixteen rays does not. Then vertices without light of their own take what those have whose light they
 * share. In motion only where it is looked at: by the camera in this update, or by rays that metal mirrors.
 */
void tl_bounce_smooth(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, bool in_motion);

/* Follows the environment; and returns the colour of its texel in a direction, in its own frame, and the pdf
 * of tl_bounce_sky_sample there. */
void tl_bounce_sky_follow(struct tl_bounce_sky *sky, const tl_cube *cube, uint64_t revision);
vec3s tl_bounce_sky_colour(const struct tl_bounce_sky *sky, vec3s direction, float *pdf);
/* The direction of a point of the unit square, by the luminance of the sky; false: it is black. */
bool tl_bounce_sky_sample(const struct tl_bounce_sky *sky, vec2s at, vec3s *direction);
void tl_bounce_sky_release(struct tl_bounce_sky *sky);

/* Notes that the camera or a ray has met corners of a triangle from one side. Threads: any at once. */
void tl_bounce_want(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, size_t surface,
                    const uint32_t corners[3], bool back);

/* Traces the rays of a vertex and adds what they find to what its earlier rounds found. Threads: any, each
 * with vertices of its own. */
void tl_bounce_trace(struct tl_bounce *bounce, const struct tl_bounce_request *request, size_t surface,
                     uint32_t vertex, bool back);

#endif
