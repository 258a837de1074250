/* A flat piece of cloth from photographs under known lamps: photometric stereo [Woodham 1980].
 *
 * The camera looks down on the middle of the swatch. x runs to the right of the pictures, y up, z towards the
 * camera, millimetres from the middle. A texel with the value I_k under lamp k, whose light is e_k and comes
 * from l_k, has
 *
 *     I_k = e_k (a max(0, n.l_k) + S (s + 1) / 2 max(0, r.l_k)^s)
 *
 * with albedo a, normal n, specular reflectance S, exponent s = 1 / (1 - glossiness), and r the mirrored
 * direction to the camera: the model that lamps have here (docs/inside.md). e_k is `intensity`: the value of
 * white matt cloth that faces the lamp; for a lamp with a position at the mean distance of all those from the
 * middle, and falling with the square of the distance.
 *
 * Errors: false with one line, TL_USAGE for the file of lamps, TL_INPUT for pictures. Lifetime: the caller
 * releases what is returned. Threads: pure, but for reading files; the same at any number of threads. */
#ifndef TOILE_ASSETS_SWATCH_SWATCH_H
#define TOILE_ASSETS_SWATCH_SWATCH_H

#include "assets/base/image.h"

#define TL_SWATCH_LAMPS_MIN 4
#define TL_SWATCH_LAMPS_MAX 32
#define TL_SWATCH_SIDE_MAX  2048 /* texels; larger pictures are averaged */

struct tl_swatch_lamp {
    float azimuth_deg, elevation_deg; /* from x towards y, and above the swatch: of a lamp far away ... */
    float position_mm[3];             /* ... unless z is above 0 */
    float intensity;
};

struct tl_swatch_rig {
    float width_mm;  /* what the pictures show of the swatch */
    float camera_mm; /* height of the camera; 0: far away */
    bool even;       /* divide out what darkens towards the corners, as a lens does */
    size_t count;
    struct tl_swatch_lamp lamps[TL_SWATCH_LAMPS_MAX];
};

/* Reads tables `swatch` and `lamps`, a list, from YAML. Refuses fewer than TL_SWATCH_LAMPS_MIN lamps, and
 * lamps that lie in one plane with the swatch's middle or nearly so, which leave normals open. */
bool tl_swatch_rig_load(const char *path, struct tl_swatch_rig *out, tl_error *error);

/* Reads a picture, PNG, JPEG, TIFF (sRGB) or EXR (linear), as linear values, F32 x3, at most
 * TL_SWATCH_SIDE_MAX a side. A texel of 8 bits that is saturated in any channel is -1 in all. Refuses
 * pictures of which a tenth is saturated. */
bool tl_swatch_picture_load(const char *path, tl_image *out, tl_error *error);

struct tl_swatch_lamp_fit {
    float residual; /* root mean square of what the model leaves, relative to the lamp's mean value */
    float bias;     /* mean of it: above 0 the picture is brighter than the model */
    float used;     /* mean weight in [0, 1]: shadows, highlights and saturated texels have little */
};

struct tl_swatch_maps {
    tl_image normal;            /* F32 x3, unit, levelled: slopes of a flat swatch add up to none */
    tl_image albedo;            /* F32 x3, linear */
    bool has_gloss;             /* lamps stand where they would show a highlight of a glossiness of 0.94 */
    float glossiness, specular; /* specular 0: there is none */
    float lean_deg;             /* the mean of normals, before they were levelled */
    float corner;               /* light in the corners over that in the middle, divided out; 1: none */
    float residual;             /* all lamps together */
    float unknown; /* share of texels that fewer than three lamps light: level, of the mean albedo */
    struct tl_swatch_lamp_fit lamps[TL_SWATCH_LAMPS_MAX];
};

/* `pictures`: rig->count, of tl_swatch_picture_load and one size. Refuses when `unknown` is above a
 * twentieth. */
bool tl_swatch_solve(const struct tl_swatch_rig *rig, const tl_image *pictures, struct tl_swatch_maps *out,
                     tl_error *error);
void tl_swatch_release(struct tl_swatch_maps *swatch);

#endif
