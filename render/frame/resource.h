/* The resources of a frame and the facts about its scene, by bit, for render/plan. The first resources are
 * inputs, which no job writes. */
#ifndef TOILE_RENDER_FRAME_RESOURCE_H
#define TOILE_RENDER_FRAME_RESOURCE_H

#include "render/plan/plan.h"

enum tl_resource {
    TL_INPUT_ENVIRONMENT,
    TL_INPUT_YAW,
    TL_INPUT_SHAPES, /* topology, UVs, materials */
    TL_INPUT_MOTION, /* positions, normals, tangents */
    TL_INPUT_CAMERA,
    TL_INPUT_SIZE, /* image size and samples per pixel */
    TL_INPUT_GROUND,
    TL_INPUT_LOBES, /* which lobes of a material are drawn */
    TL_INPUT_PEM_SIZE,
    TL_INPUT_FILTER,
    TL_INPUT_SUN,
    TL_INPUT_REGIONS,
    TL_INPUT_PASSES,      /* how PEMs are stored */
    TL_INPUT_MAPS,        /* size and blur of the shadow maps */
    TL_INPUT_RAYS,        /* how rays are spent */
    TL_INPUT_ROUND,       /* which of the jittered frames that are averaged while nothing changes */
    TL_INPUT_SCENE_ROUND, /* ... while nothing but the camera does */
    TL_INPUT_SHIFT,       /* which of the images that are shifted by parts of a pixel */
    TL_INPUT_LIGHT,       /* how light is composed */
    TL_INPUT_LAMPS,       /* and how surfaces are shaded under them */
    TL_INPUT_REFERENCE,
    TL_INPUT_DETAIL,      /* how its maps are read */
    TL_INPUT_DETAIL_MAPS, /* which there are */
    TL_INPUT_SHOW,        /* exposure and background */
    TL_INPUT_ENVMAP,      /* size of environment maps, and whether they show the scene */
    TL_INPUT_LAYOUT,      /* their layout; for a sphere map the view's turn */
    TL_INPUT_LOOK_UP,     /* how they are looked up */
    TL_INPUT_CAPTURE,     /* the scene as it was when it was to be captured last */
    TL_INPUT_VIEW,        /* what is shown in place of light */
    TL_INPUT_RATIO,       /* where the ratio of seen to exact light is computed */
    TL_INPUT_COUNT,
    TL_MADE_CUBE = TL_INPUT_COUNT, /* and the suns taken from it */
    TL_MADE_REGIONS,
    TL_MADE_LOBE,
    TL_MADE_PEMS,
    TL_MADE_LOBES,
    TL_MADE_SLICES,
    TL_MADE_LIGHTS, /* regions as lights */
    TL_MADE_SURFACES,
    TL_MADE_DETAIL, /* maps derived from the materials' own */
    TL_MADE_DEPTHS,
    TL_MADE_MAPS,
    TL_MADE_GBUFFER,
    TL_MADE_IDS,             /* the number of the nearest triangle at every pixel */
    TL_MADE_SHADE_MATERIALS, /* materials and their maps on the CPU */
    TL_MADE_RATIOS,          /* of seen to exact light, at vertices */
    TL_MADE_SUN_PIXELS,      /* what every pixel sees of the suns */
    TL_MADE_SAMPLES,
    TL_MADE_TRANSPARENCY, /* samples behind open cloth */
    TL_MADE_MIRRORS,      /* samples that near mirrors reflect */
    TL_MADE_TRACE,        /* the surfaces as a BVH */
    TL_MADE_POINTS,
    TL_MADE_BOUNCE, /* light that surfaces send on to each other, at vertices */
    TL_MADE_ENVMAP_LOBES,
    TL_MADE_CAPTURE,
    TL_MADE_ENVMAP,
    TL_MADE_LIGHT_MAP,
    TL_MADE_LIGHT,
    TL_MADE_LAMP_MAPS,
    TL_MADE_LAMP_RAYS,
    TL_MADE_LAMPLIGHT, /* added to the light */
    TL_MADE_IMAGE,
    TL_MADE_BACKDROP,
    TL_MADE_SHOWN,
    TL_RESOURCE_COUNT
};
#define TL_BIT(resource) ((tl_bits)1 << (resource))

/* Facts about the scene, by bit. */
enum tl_scene_fact {
    TL_SCENE_RASTER,       /* samples become the image */
    TL_SCENE_SHADOWS,      /* the method needs visibility */
    TL_SCENE_MAPS,         /* ... of shadow maps */
    TL_SCENE_RAYS,         /* visibility comes from rays */
    TL_SCENE_TRANSPARENCY, /* ... and something is seen through, or is lit from behind */
    TL_SCENE_MIRRORS,      /* ... and something is so glossy that rays follow what it shows */
    TL_SCENE_PASSES,       /* passes on the GPU light the samples */
    TL_SCENE_CHAINS,       /* ... and read filter chains */
    TL_SCENE_SLICES,       /* ... and read exact slices of the regions */
    TL_SCENE_EXACT,        /* exact light of the whole environment is read */
    TL_SCENE_BLUR,         /* shadow maps are variance maps */
    TL_SCENE_DETAIL,       /* a material's bumps need maps of their own */
    TL_SCENE_REFERENCE,
    TL_SCENE_ENVMAP,    /* environment maps light the image */
    TL_SCENE_CAPTURE,   /* ... and show the scene */
    TL_SCENE_LIGHT_MAP, /* ... beside diffuse light that is baked */
    TL_SCENE_LAMPS,
    TL_SCENE_LAMP_MAPS,     /* ... and depth maps shadow one of them */
    TL_SCENE_LAMP_RAYS,     /* ... and rays do */
    TL_SCENE_SAMPLES,       /* rays start from what is seen */
    TL_SCENE_COMPOSED,      /* light is composed from visibility by rays */
    TL_SCENE_BOUNCE,        /* surfaces send light on to each other */
    TL_SCENE_RATIOS,        /* ratios at vertices light the pixels, in one pass */
    TL_SCENE_INSPECT,       /* something else than light is shown */
    TL_SCENE_FITS_VERTICES, /* ratios at vertices could light the pixels; no job asks, work.c does */
    TL_SCENE_FACT_COUNT
};

extern const char *const tl_resource_names[TL_RESOURCE_COUNT + 1];
extern const char *const tl_scene_fact_names[TL_SCENE_FACT_COUNT + 1];

#endif
