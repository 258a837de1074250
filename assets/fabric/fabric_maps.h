/* The pictures of a fabric file as maps of one repeat, all of one size, periodic.
 *
 * Pictures are brought to the size of the largest one, or to 2,048 texels a side where that is larger, by
 * averages over texels: colours in linear light, normals as vectors.
 *
 * Errors: false with one line (TL_INPUT) for a picture that cannot be read; `out` is then empty. Lifetime:
 * the caller releases what is returned. Threads: pure, but for reading files; one at a time for a fabric
 * file. */
#ifndef TOILE_ASSETS_FABRIC_FABRIC_MAPS_H
#define TOILE_ASSETS_FABRIC_FABRIC_MAPS_H

#include "assets/fabric/fabric_file.h"

#define TL_LIMIT_FABRIC_SIDE 2048 /* texels, of a map */

/* Maps that no picture gives are empty. */
struct tl_fabric_maps {
    int width, height;
    tl_image colour; /* F32 x3, linear: diffuse albedo, occlusion in it; multiplies the surface's colour */
    tl_image gloss;  /* F32 x1: glossiness less its mean */
    tl_image normal; /* U8 x3, linear, +Y up */
    float lean_deg;  /* of the picture's normals in the mean, above 15, taken out of them; else 0 */
    tl_image height_map; /* F32 x1: 0 deepest, 1 highest */
    tl_image opacity;    /* U8 x4: white, with the cover as alpha */
    tl_image specular;   /* U8 x3, sRGB: reflectance at normal incidence */
};

bool tl_fabric_maps_load(const tl_fabric_file *file, struct tl_fabric_maps *out, tl_error *error);
/* Appends mirror images, so that maps that are not periodic are. */
void tl_fabric_maps_mirror(struct tl_fabric_maps *maps, bool along_u, bool along_v);
void tl_fabric_maps_release(struct tl_fabric_maps *maps); /* frees and zeroes */

/* A picture as it is used, as a picture that needs no rule: a U8 image of its own size. */
bool tl_fabric_maps_bake(const tl_fabric_file *file, enum tl_picture_use use, tl_image *out, tl_error *error);

/* Means over pictures, which options hold; where there is no picture, what the file states. */
struct tl_fabric_means {
    float glossiness;
    float back[3];  /* linear */
    float depth_mm; /* range of the heights; 0: there is no picture of them */
};
bool tl_fabric_maps_means(const tl_fabric_file *file, struct tl_fabric_means *out, tl_error *error);

#endif
