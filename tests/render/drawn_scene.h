/* A ball under a draped sheet above the ground, and editors that change its materials and its view: what
 * tests of pictures by ratios at vertices draw. Every function fails the running test when what it calls
 * fails. Not for threads. */
#ifndef TOILE_TESTS_RENDER_DRAWN_SCENE_H
#define TOILE_TESTS_RENDER_DRAWN_SCENE_H

#include "tests/render/scenes.h"

enum { MAP_COLOUR, MAP_NORMAL, MAP_GLOSS, MAP_HOLES, MAP_COUNT };

struct drawn_scene {
    struct test_scene scene, plain; /* with and without what an editor changed */
    tl_image maps[MAP_COUNT];
    tl_weave weave, streaked;
};

void drawn_scene_open(struct drawn_scene *drawn, int width, int height);
void drawn_scene_close(struct drawn_scene *drawn);
/* The sheet's material. */
tl_material *drawn_scene_cloth(struct drawn_scene *drawn);
/* A map that is scaled and turned. */
struct tl_map drawn_scene_map(const tl_image *image);

/* Changes the plain scene. */
typedef void editor(struct drawn_scene *drawn);
void drawn_scene_edit(struct drawn_scene *drawn, editor *change);
editor be_matt, be_glossy, be_satin, be_fuzzy, be_woven, be_streaked, be_mapped, be_voile;
editor have_warp_threads, have_threads, have_ggx_facets, have_holes, transmit, be_open, glow;
editor look_up; /* from below the sheet */

/* 1 where a shape, not the ground, is seen. */
tl_image drawn_scene_mask(const struct test_device *device, const struct drawn_scene *drawn);
/* Largest difference of cover. GL computes the ground's fading in a shader of its own. */
double drawn_scene_cover_difference(const tl_image *a, const tl_image *b);

/* What the renderer says of the device that draws the scene holds `text`. */
void drawn_scene_expect_device(const tl_renderer *renderer, const struct drawn_scene *drawn, const char *text);
void drawn_scene_expect_same(const tl_image *a, const tl_image *b); /* every bit */

#endif
