/* Shared by the files of this room: what a vertex finds by its rays. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCE_INTERNAL_H
#define TOILE_RENDER_BOUNCE_BOUNCE_INTERNAL_H

#include "render/bounce/bounce_scene.h"

/* Rays of a vertex in an update: spread over its hemisphere, and towards the sky's bright parts. */
#define TL_BOUNCE_RAYS     16
#define TL_BOUNCE_SKY_RAYS 8

/* Fills `shown` with the means of each vertex and its neighbours: bounced light varies slowly, the noise of
 * sixteen rays does not. Then vertices without light of their own take what those have whose light they
 * share. In motion only where it is looked at: by the camera in this update, or by rays that metal mirrors.
 */
void tl_bounce_smooth(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, bool in_motion);

/* Notes that the camera or a ray has met corners of a triangle from one side. Threads: any at once. */
void tl_bounce_want(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, size_t surface,
                    const uint32_t corners[3], bool back);

/* Traces the rays of a vertex and adds what they find to what its earlier rounds found. Threads: any, each
 * with vertices of its own. */
void tl_bounce_trace(struct tl_bounce *bounce, const struct tl_bounce_request *request, size_t surface,
                     uint32_t vertex, bool back);

#endif
