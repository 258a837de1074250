/* The weave generator: detail maps of woven fabrics from their interlacing pattern, to scale in millimetres.
 * Each yarn is a bent tube; the height map is the upper envelope of all yarns, normals
 * are its analytic slopes, gloss and tint are those of the topmost yarn. */
#ifndef TOILE_ASSETS_WEAVE_WEAVE_H
#define TOILE_ASSETS_WEAVE_WEAVE_H

#include "assets/base/material.h"
#include "config/options.h"

/* The face of the cloth: knits have loops (assets/weave/knit.h), rib and purl change between their sides,
 * interlock is two ribs locked into each other; pile is fibres alone, as of fleece, melton and velvet. Of
 * weaves twill is 3/1, its lines rising to the right (Z); satin is of five ends, counter 2; in both the warp
 * floats on the face. */
enum tl_weave_pattern {
    TL_WEAVE_NONE,
    TL_WEAVE_PLAIN,
    TL_WEAVE_TWILL,
    TL_WEAVE_SATIN,
    TL_WEAVE_JERSEY,
    TL_WEAVE_RIB,
    TL_WEAVE_INTERLOCK,
    TL_WEAVE_PURL,
    TL_WEAVE_PILE
};

/* The section of a yarn: an ellipse, of twisted yarns; or a parabola, of filaments that lie flat side by
 * side. The slopes of the ellipse have no bound at its edges, those of the parabola are spread evenly. */
enum tl_yarn_section { TL_YARN_ROUND, TL_YARN_FLAT };

/* Directions in which every other repeat is a mirror image: pictures that do not tile then do. Bits. */
enum tl_picture_mirror {
    TL_PICTURE_MIRROR_NONE,
    TL_PICTURE_MIRROR_WEFT,
    TL_PICTURE_MIRROR_WARP,
    TL_PICTURE_MIRROR_BOTH
};

struct tl_weave_params {
    int pattern;         /* enum tl_weave_pattern; NONE: the material's own maps only */
    int section;         /* enum tl_yarn_section */
    float warp_pitch_mm; /* distance between warp yarns */
    float weft_pitch_mm; /* distance between weft yarns */
    float crimp_mm;      /* height of a yarn's crest over the fabric's middle plane */
    float warp_gloss;    /* added to material.glossiness on warp yarns */
    float weft_gloss;    /* ... on weft yarns */
    float warp_tint[3];  /* factor on material.diffuse on warp yarns, linear */
    float weft_tint[3];
    int texels_per_yarn; /* resolution of the maps; of a wale in knits */
    /* Knits */
    float wale_mm, course_mm; /* distance between wales and between courses */
    float yarn_mm;            /* diameter */
    int rib;                  /* wales of a rib */
    /* Fibres on weaves, knits and pile; the maps are of a larger piece then, which repeats less visibly */
    float slub;     /* how much yarns of a weave vary in width and colour; 0: none does */
    float streaks;  /* how much yarns differ along all of the cloth (struct tl_yarns); 0: they do not */
    float nap;      /* area of the fibres that lie on the surface, as a multiple of the surface's */
    float nap_mm;   /* their mean length */
    float fibre_mm; /* their diameter */
    float curl;     /* turns of a fibre in diameters: rad */
    float clump_mm; /* PILE: size of its clumps, whose height is the crimp */
    float lean;     /* ... how much its fibres lean one way in patches; 0: anywhere, 1: all of a patch */
    float melange;  /* how much fibres differ in colour */
    float cavity;   /* how much valleys darken: 0 with horizon maps, which show it themselves */
    /* A picture of heights instead of yarns (app/scene/height_picture.h reads it) */
    const char *picture; /* "": none */
    /* Pictures of the whole surface instead of yarns and `picture` (assets/fabric/fabric_maps.h) */
    const char *pictures;    /* a folder, an archive or a U3M file; "": none */
    float picture_mm;        /* width on the cloth of either: of a repeat; 0: TL_PICTURE_ASSUMED_MM */
    float picture_length_mm; /* of `pictures`, along the warp; 0: texels are square */
    int picture_mirror;      /* enum tl_picture_mirror, of `pictures` */
    float depth_mm;          /* from its lowest to its highest */
};
#define TL_PICTURE_ASSUMED_MM 100
/* A light cotton sheeting. */
#define TL_WEAVE_DEFAULTS                                                                                    \
    .pattern = TL_WEAVE_PLAIN, .warp_pitch_mm = 0.4f, .weft_pitch_mm = 0.4f, .crimp_mm = 0.1f,               \
    .warp_tint = {1, 1, 1}, .weft_tint = {1, 1, 1}, .texels_per_yarn = 32, .picture_mm = 10,                 \
    .depth_mm = 0.5f, .wale_mm = 0.7f, .course_mm = 0.55f, .yarn_mm = 0.3f, .rib = 2, .nap_mm = 1.5f,        \
    .fibre_mm = 0.03f, .curl = 0.03f, .clump_mm = 2, .cavity = 1
extern const struct tl_option_table tl_weave_options; /* "weave" */

/* The width on the cloth of a repeat of pictures. */
static inline float tl_weave_picture_mm(const struct tl_weave_params *params)
{
    return params->picture_mm > 0 ? params->picture_mm : TL_PICTURE_ASSUMED_MM;
}

/* Makes the maps of one repeat. False, without an error, for the pattern NONE. */
bool tl_weave_create(const struct tl_weave_params *params, tl_weave *out);
void tl_weave_release(tl_weave *weave);

#endif
