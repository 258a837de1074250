/* The scene that rays of bounced light meet: the materials of surfaces by their mean colours, and the sky, coarse.
 * Linear radiance, Rec. 709; directions of the sky in its own frame. Errors: none. Threads: read by any. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCE_SCENE_H
#define TOILE_RENDER_BOUNCE_BOUNCE_SCENE_H

#include "render/bounce/bounce.h"

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

/* Follows the environment; and returns the colour of its texel in a direction, in its own frame, and the pdf
 * of tl_bounce_sky_sample there. */
void tl_bounce_sky_follow(struct tl_bounce_sky *sky, const tl_cube *cube, uint64_t revision);
vec3s tl_bounce_sky_colour(const struct tl_bounce_sky *sky, vec3s direction, float *pdf);
/* The direction of a point of the unit square, by the luminance of the sky; false: it is black. */
bool tl_bounce_sky_sample(const struct tl_bounce_sky *sky, vec2s at, vec3s *direction);
void tl_bounce_sky_release(struct tl_bounce_sky *sky);

#endif
