/* Frames on the graphics card. One in motion: what the CPU's jobs trace, ids, points, bounce, ratios,
 * sun_pixels and shade make, by compute shaders, from the surfaces' vertices to the linear image. Nothing is
 * read back. The kernels repeat the CPU's arithmetic from the same texts (*_terms.glsl); where they differ on
 * purpose:
 *
 *     every vertex has light of its own; bounced light is kept where the surfaces' light mesh has it
 *     all regions are traced in every frame, in directions that stay the same, by several rays each
 *     a sun's shadow has four places a pixel, nine in a penumbra, a lamp's one, and both have cells of four
 *     pixels everywhere
 *
 * Rays go through a tree of boxes that is built on the CPU when surfaces change, and again when they have
 * moved far, and refitted in every frame. A step must follow the ones before it: surfaces, view, light,
 * points, ...
 *
 * World space, metres; linear radiance, Rec. 709. Lifetime: owns its GL objects; needs the context of its
 * tl_gpu. Threads: that of the context. Errors: a step fails when a program does not compile or GL has no
 * memory for a buffer. */
#ifndef TOILE_RENDER_CARD_CARD_H
#define TOILE_RENDER_CARD_CARD_H

#include "assets/base/environment.h"
#include "render/bounce/bounce.h"
#include "render/env/sun.h"
#include "render/light/region_lights.h"
#include "render/scene/lamp.h"
#include "render/scene/view.h"
#include "render/shade/materials.h"

typedef struct tl_graphics_card tl_graphics_card;

tl_graphics_card *tl_card_create(tl_gpu *gpu);
void tl_card_destroy(tl_graphics_card **card);
size_t tl_card_bytes(const tl_graphics_card *card);
/* Discards what follows from earlier frames: bounced light. */
void tl_card_forget(tl_graphics_card *card);
bool tl_card_reload(tl_graphics_card *card, tl_error *error); /* its shaders */

/* Returns why the graphics card cannot draw these surfaces; NULL: it can. A constant text. */
const char *tl_card_refusal(const tl_surface *surfaces, size_t count);
/* Returns why this GL cannot run the kernels; NULL: it can. */
const char *tl_card_gl_refusal(const tl_gpu *gpu);

struct tl_card_surfaces {
    const struct tl_triangle_ranges *ranges; /* of the surfaces, the ground last if there is one */
    uint64_t shapes_revision;                /* changes when vertex numbers or materials do */
    const struct tl_ground *ground;          /* NULL: none */
    const struct tl_shade_materials *materials;
};
/* Sends vertices, and whatever of the surfaces has changed; fits the tree to them. */
bool tl_card_send_surfaces(tl_graphics_card *card, const struct tl_card_surfaces *request, tl_error *error);

struct tl_card_view {
    const struct tl_view *view;
    int width, height; /* samples */
};
/* Finds the nearest triangle at every pixel, and lists the vertices that are seen. */
bool tl_card_see(tl_graphics_card *card, const struct tl_card_view *request, tl_error *error);

struct tl_card_light {
    const struct tl_regions *regions;
    const struct tl_suns *suns;
    const struct tl_region_lights *lights;
    const struct tl_lobes *lobes;
    uint64_t light_revision;        /* changes when any of these do */
    float environment_yaw;          /* rad */
    int rays;                       /* a region and vertex, up to TL_CARD_RAYS_MAX */
    const struct tl_ground *ground; /* NULL: none */
    const struct tl_lamp *lamps;    /* [lamp_count], lit */
    size_t lamp_count;
};
#define TL_CARD_RAYS_MAX 8
#define TL_CARD_LOBES    5 /* of a gloss (light.lobes), at most */
/* Sends light, and traces what the listed vertices see of the regions. */
bool tl_card_trace_points(tl_graphics_card *card, const struct tl_card_light *request, tl_error *error);

struct tl_card_bounce {
    const tl_cube *cube; /* without the suns */
    uint64_t cube_revision;
    int shares; /* every N-th of the vertices with bounced light of their own is traced */
};
/* Traces light that surfaces send on to each other. The first frame of new shapes takes several at once. */
bool tl_card_trace_bounce(tl_graphics_card *card, const struct tl_card_bounce *request, tl_error *error);

/* Computes the ratios of seen to exact light at the listed vertices. */
bool tl_card_make_ratios(tl_graphics_card *card, bool bounces, tl_error *error);
/* Traces what every pixel sees of the suns and lamps. */
bool tl_card_trace_suns(tl_graphics_card *card, tl_error *error);
/* Lights every sample of the view, and makes the picture of them: RGBA32F, premultiplied by coverage, rows
 * upwards, whose sides are a whole number of times smaller. The texture becomes the mean of what is made and
 * so many images `before` it; 0: what is made. */
bool tl_card_shade(tl_graphics_card *card, const tl_texture *image, int before, tl_error *error);

struct tl_card_rest {
    const tl_environment *environment; /* lat-long or cube */
    uint64_t environment_revision;
    float environment_yaw; /* rad */
    const struct tl_lamp *lamps;
    size_t lamp_count;
    int bounces;   /* as those of the reference (render/reference/request.h) */
    int footprint; /* samples of a pixel along each side, whose maps are as fine */
    int round;
};
/* Draws a round of an image at rest of the view, which follows tl_card_see alone: paths from every pixel by
 * the real reflectance and the environment's own texels. The mean of rounds goes to the reference's image.
 * The same round gives the same bytes. The texture becomes the mean of it and `round` images before. */
bool tl_card_draw_round(tl_graphics_card *card, const struct tl_card_rest *request, const tl_texture *image,
                        tl_error *error);

#endif
