/* The resources of a frame and the facts about its scene, by bit, for render/plan. A resource is an input,
 * which no job writes, or is made by jobs. Threads: constants. */
#ifndef TOILE_RENDER_FRAME_RESOURCE_H
#define TOILE_RENDER_FRAME_RESOURCE_H

#include "render/plan/plan.h"

/* clang-format off */
/* BIT(resource, name): the name is what `toile plan` prints. */
#define TL_INPUT_BITS(BIT)                                                                                   \
    BIT(TL_INPUT_ENVIRONMENT, "environment")                                                                 \
    BIT(TL_INPUT_YAW, "environment yaw")                                                                     \
    BIT(TL_INPUT_SHAPES, "shapes and materials") /* topology, UVs, materials */                              \
    BIT(TL_INPUT_MOTION, "motion") /* positions, normals, tangents */                                        \
    BIT(TL_INPUT_CAMERA, "camera")                                                                           \
    BIT(TL_INPUT_SIZE, "image size") /* image size and samples per pixel */                                  \
    BIT(TL_INPUT_GROUND, "ground option")                                                                    \
    BIT(TL_INPUT_LOBES, "lobes drawn") /* which lobes of a material are drawn */                             \
    BIT(TL_INPUT_PEM_SIZE, "PEM size")                                                                       \
    BIT(TL_INPUT_FILTER, "filter option")                                                                    \
    BIT(TL_INPUT_SUN, "sun option")                                                                          \
    BIT(TL_INPUT_REGIONS, "regions options")                                                                 \
    BIT(TL_INPUT_PASSES, "PEM storage") /* how PEMs are stored */                                            \
    BIT(TL_INPUT_MAPS, "shadow map options") /* size and blur of the shadow maps */                          \
    BIT(TL_INPUT_RAYS, "ray options") /* how rays are spent */                                               \
    BIT(TL_INPUT_ROUND, "round") /* which of the jittered frames that are averaged while nothing changes */  \
    BIT(TL_INPUT_SCENE_ROUND, "round of the scene") /* the same while the camera alone moves */              \
    /* which of the images that are shifted by parts of a pixel */                                           \
    BIT(TL_INPUT_SHIFT, "shift by a part of a pixel")                                                        \
    BIT(TL_INPUT_LIGHT, "light options") /* how light is composed */                                         \
    BIT(TL_INPUT_LAMPS, "lamps and shading options") /* and how surfaces are shaded under them */            \
    BIT(TL_INPUT_REFERENCE, "reference options")                                                             \
    BIT(TL_INPUT_DETAIL, "detail steps") /* how its maps are read */                                         \
    BIT(TL_INPUT_DETAIL_MAPS, "detail options") /* which there are */                                        \
    BIT(TL_INPUT_SHOW, "exposure and background")                                                            \
    /* size of environment maps, and whether they show the scene */                                          \
    BIT(TL_INPUT_ENVMAP, "environment map options")                                                          \
    BIT(TL_INPUT_LAYOUT, "layout") /* their layout; for a sphere map the view's turn */                      \
    BIT(TL_INPUT_LOOK_UP, "look-up options") /* how they are looked up */                                    \
    BIT(TL_INPUT_CAPTURE, "captured scene") /* the scene as it was when it was to be captured last */        \
    BIT(TL_INPUT_VIEW, "view") /* what is shown in place of light */                                         \
    BIT(TL_INPUT_RATIO, "place of the ratios") /* where the ratio of seen to exact light is computed */      \
    BIT(TL_INPUT_DEVICE, "device") /* the graphics card or the CPU draws */

/* BIT(resource, name, use): `use` is the member of struct tl_render_memory that its bytes count to. */
#define TL_MADE_BITS(BIT)                                                                                    \
    BIT(TL_MADE_CUBE, "cube", other) /* and the suns taken from it */                                        \
    BIT(TL_MADE_REGIONS, "regions", other)                                                                   \
    BIT(TL_MADE_LOBE, "levels of gloss", other) /* in chains, and among exponents */                         \
    BIT(TL_MADE_PEMS, "PEMs", pems)                                                                          \
    BIT(TL_MADE_LOBES, "lobes", pems)                                                                        \
    BIT(TL_MADE_SLICES, "slices", pems)                                                                      \
    BIT(TL_MADE_LIGHTS, "regions as lights", pems) /* regions as lights */                                   \
    BIT(TL_MADE_SURFACES, "surfaces", surfaces)                                                              \
    BIT(TL_MADE_DETAIL, "detail maps", surfaces) /* maps derived from the materials' own */                  \
    BIT(TL_MADE_DEPTHS, "depths", maps)                                                                      \
    BIT(TL_MADE_MAPS, "shadow maps", other)                                                                  \
    BIT(TL_MADE_GBUFFER, "G-buffer", targets)                                                                \
    BIT(TL_MADE_IDS, "ID buffer", targets) /* the number of the nearest triangle at every pixel */           \
    BIT(TL_MADE_SHADE_MATERIALS, "materials on the CPU", surfaces) /* materials and their maps on the CPU */ \
    BIT(TL_MADE_RATIOS, "ratios at vertices", rays) /* of seen to exact light, at vertices */                \
    BIT(TL_MADE_SUN_PIXELS, "suns at pixels", rays) /* what every pixel sees of the suns */                  \
    BIT(TL_MADE_LOBE_SUMS, "sums of lobes", targets) /* of facets, for passes */                             \
    BIT(TL_MADE_SAMPLES, "samples", rays)                                                                    \
    BIT(TL_MADE_TRANSPARENCY, "what is seen through cloth", transparency) /* samples behind open cloth */    \
    BIT(TL_MADE_MIRRORS, "what mirrors show", other) /* samples that near mirrors reflect */                 \
    BIT(TL_MADE_TRACE, "surfaces for rays", rays) /* the surfaces as a BVH */                                \
    BIT(TL_MADE_POINTS, "visibility at points", rays)                                                        \
    BIT(TL_MADE_BOUNCE, "bounced light", rays) /* light that surfaces send on to each other, at vertices */  \
    BIT(TL_MADE_CARD_SURFACES, "surfaces on the card", rays) /* and the tree of rays */                      \
    BIT(TL_MADE_CARD_IDS, "IDs on the card", targets) /* and the vertices that are seen */                   \
    BIT(TL_MADE_CARD_POINTS, "visibility on the card", rays)                                                 \
    BIT(TL_MADE_CARD_BOUNCE, "bounced light on the card", rays)                                              \
    BIT(TL_MADE_CARD_RATIOS, "ratios on the card", rays)                                                     \
    BIT(TL_MADE_CARD_SUNS, "suns on the card", rays)                                                         \
    BIT(TL_MADE_ENVMAP_LOBES, "lobes of the maps", pems)                                                     \
    BIT(TL_MADE_CAPTURE, "capture", pems)                                                                    \
    BIT(TL_MADE_ENVMAP, "environment maps", pems)                                                            \
    BIT(TL_MADE_LIGHT_MAP, "light maps", pems)                                                               \
    BIT(TL_MADE_LIGHT, "light", targets)                                                                     \
    BIT(TL_MADE_LAMP_MAPS, "lamps' shadow maps", maps)                                                       \
    BIT(TL_MADE_LAMP_RAYS, "lamps' shadows by rays", other)                                                  \
    BIT(TL_MADE_LAMPLIGHT, "light of lamps", other) /* added to the light */                                 \
    BIT(TL_MADE_IMAGE, "image", targets)                                                                     \
    BIT(TL_MADE_BACKDROP, "backdrop", other)                                                                 \
    BIT(TL_MADE_SHOWN, "shown image", other)

/* FACT(fact, name). */
#define TL_SCENE_FACTS(FACT)                                                                                 \
    FACT(TL_SCENE_RASTER, "drawn image") /* samples become the image */                                      \
    FACT(TL_SCENE_SHADOWS, "shadowed light of the environment") /* by the method, and there is light */      \
    FACT(TL_SCENE_MAPS, "shadow maps") /* visibility comes from shadow maps */                               \
    FACT(TL_SCENE_RAYS, "rays") /* visibility comes from rays */                                             \
    /* rays; something is seen through, or is lit from behind */                                             \
    FACT(TL_SCENE_TRANSPARENCY, "samples seen through cloth")                                                \
    /* rays; something is so glossy that rays follow what it shows */                                        \
    FACT(TL_SCENE_MIRRORS, "near mirrors by rays")                                                           \
    FACT(TL_SCENE_PASSES, "light passes") /* passes on the GPU light the samples */                          \
    FACT(TL_SCENE_CHAINS, "filter chains") /* the passes read filter chains */                               \
    FACT(TL_SCENE_SLICES, "exact slices") /* the passes read exact slices */                                 \
    FACT(TL_SCENE_LOBE_SUMS, "gloss of facets for light passes") /* they draw it as sums of lobes */         \
    FACT(TL_SCENE_EXACT, "exact light") /* exact light of the whole environment is read */                   \
    FACT(TL_SCENE_BLUR, "variance maps") /* shadow maps are variance maps */                                 \
    FACT(TL_SCENE_DETAIL, "samples that read detail maps") /* a material's bumps need maps of their own */   \
    FACT(TL_SCENE_REFERENCE, "reference")                                                                    \
    FACT(TL_SCENE_ENVMAP, "environment maps") /* environment maps light the image */                         \
    FACT(TL_SCENE_CAPTURE, "captured scene") /* environment maps show the scene */                           \
    FACT(TL_SCENE_LIGHT_MAP, "light maps") /* diffuse light is baked */                                      \
    FACT(TL_SCENE_LAMPS, "lamps")                                                                            \
    FACT(TL_SCENE_LAMP_MAPS, "lamps with shadow maps") /* depth maps shadow a lamp */                        \
    FACT(TL_SCENE_LAMP_RAYS, "lamps with shadow rays") /* rays shadow a lamp */                              \
    FACT(TL_SCENE_SAMPLES, "rays from samples") /* rays start from what is seen */                           \
    FACT(TL_SCENE_COMPOSED, "light from rays") /* light is composed from visibility by rays */               \
    FACT(TL_SCENE_BOUNCE, "bounced light") /* surfaces send light on to each other */                        \
    FACT(TL_SCENE_RATIOS, "ratios at vertices") /* ratios at vertices light the pixels, in one pass */       \
    FACT(TL_SCENE_CARD, "frame on the graphics card")                                                        \
    FACT(TL_SCENE_CARD_BOUNCE, "bounced light on the graphics card")                                         \
    FACT(TL_SCENE_CARD_RATIOS, "ratios at vertices on the graphics card")                                    \
    FACT(TL_SCENE_CARD_REST, "rounds at rest on the graphics card")                                          \
    FACT(TL_SCENE_REGION_LIGHTS, "regions as lights") /* rays or the card sum up their light */              \
    FACT(TL_SCENE_PIXELS, "materials of pixels") /* of ratios at vertices, on the CPU or the card */         \
    FACT(TL_SCENE_INSPECT, "view of something else than light") /* something else than light is shown */     \
    /* ratios at vertices could light the pixels; no job asks, work.c does */                                \
    FACT(TL_SCENE_FITS_VERTICES, "light that vertices can hold")
/* clang-format on */

#define TL_NUMBER(bit, ...) bit,
enum tl_resource {
    TL_INPUT_BITS(TL_NUMBER) TL_INPUT_COUNT,
    TL_LAST_INPUT = TL_INPUT_COUNT - 1, /* the next one follows it */
    TL_MADE_BITS(TL_NUMBER) TL_RESOURCE_COUNT
};
enum tl_scene_fact { TL_SCENE_FACTS(TL_NUMBER) TL_SCENE_FACT_COUNT };
#undef TL_NUMBER

#define TL_BIT(resource) ((tl_bits)1 << (resource))

_Static_assert(TL_RESOURCE_COUNT <= 8 * sizeof(tl_bits),
               "tl_bits (render/plan/plan.h) is too narrow for the resources");

extern const char *const tl_resource_names[TL_RESOURCE_COUNT + 1];
extern const char *const tl_scene_fact_names[TL_SCENE_FACT_COUNT + 1];

#endif
