/* Shared by pixels.c, which walks over runs of pixels, and pixel_lanes.c, which evaluates those that have a
 * gloss, maps or more than one normal, share. */
#ifndef TOILE_RENDER_SHADE_PIXELS_INTERNAL_H
#define TOILE_RENDER_SHADE_PIXELS_INTERNAL_H

#include "render/env/lobes_fetch.h"
#include "render/light/terms.h"
#include "render/shade/look.h"
#include "render/shade/pixels.h"

struct tl_pixel_blends;

/* Values that all pixels of a layer share. */
struct tl_pixel_scene {
    const struct tl_pixels_request *request;
    int layer;
    const uint32_t *ids;    /* of the layer */
    const uint32_t *nearer; /* of the one before it; NULL: none */
    const struct tl_pixel_blends *blends;
    float turn_cosine, turn_sine; /* of the environment's yaw */
    vec3s first, across, up;      /* the ray through pixel (0, 0), and its changes */
};

/* Pixels of one part, wherever they lie, evaluated together. */
struct tl_pixel_lanes {
    struct tl_look_lanes look; /* its viewers are found from the places: */
    float x[TL_LANES], y[TL_LANES];
    float point[3][TL_LANES]; /* where some lights are near */
    size_t pixel[TL_LANES];
    tl_quad diffuse_ratio[TL_LANES], glossy_ratio[TL_LANES];
    tl_quad other_ratio[TL_LANES]; /* diffuse, of the other side; where the part transmits */
    tl_quad fuzz_ratio[TL_LANES];  /* where the part has fuzz */
    float cover[TL_LANES];
    tl_quad *to[TL_LANES]; /* where the colour is written */
};

/* Evaluates the pixels and writes their colours, premultiplied by cover. */
void tl_pixel_lanes_shade(const struct tl_pixel_scene *scene, struct tl_pixel_lanes *lanes);

/* Blends of exponents as a table. The caller frees it. */
struct tl_pixel_blends *tl_pixel_blends_make(void);

/* K_1 without a power. */
TL_INLINE float tl_pixel_diffuse_lobe(float cosine)
{
    return 0.318309886f * tl_maxf(cosine, 0);
}

/* The visible share of a light at a pixel. */
TL_INLINE float tl_pixel_light_seen(const struct tl_pixel_scene *scene, int light, size_t pixel)
{
    const float *visible = scene->request->sun_pixels->visible[scene->layer][light];
    return visible ? visible[pixel] : 1;
}

TL_INLINE tl_quad tl_pixel_quad(vec3s v)
{
    return (tl_quad){v.x, v.y, v.z, 0};
}

/* A direction of the world in the environment. */
TL_INLINE vec3s tl_pixel_turned(const struct tl_pixel_scene *scene, vec3s d)
{
    return turned_direction(scene->turn_cosine, scene->turn_sine, d);
}

#endif
