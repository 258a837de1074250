/* The inside of a renderer: what the jobs of a frame read and write. Not for use outside of render/,
 * but by checks that look inside (app/check_*.c), which change nothing. */
#ifndef TOILE_RENDER_FRAME_FRAME_H
#define TOILE_RENDER_FRAME_FRAME_H

#include "render/detail/maps.h"
#include "render/env/lobes.h"
#include "render/env/resample.h"
#include "render/env/sun.h"
#include "render/envmap/capture.h"
#include "render/envmap/envmap.h"
#include "render/frame/prepared.h"
#include "render/frame/settings.h"
#include "render/gbuffer/gbuffer.h"
#include "render/gbuffer/samples.h"
#include "render/light/light.h"
#include "render/light/mirrors.h"
#include "render/light/region_lights.h"
#include "render/light/transparency.h"
#include "render/local/local.h"
#include "render/present/present.h"
#include "render/renderer.h"
#include "render/trace/trace.h"
#include "render/visibility/maps.h"
#include "render/visibility/points.h"

/* Resources, by bit. The first ones are inputs of the frame, which no job writes. */
enum tl_resource {
    TL_INPUT_ENVIRONMENT,
    TL_INPUT_YAW,
    TL_INPUT_SHAPES, /* topology, UVs, materials */
    TL_INPUT_MOTION, /* positions, normals, tangents */
    TL_INPUT_CAMERA,
    TL_INPUT_SIZE, /* image size and samples per pixel */
    TL_INPUT_GROUND,
    TL_INPUT_PEM_SIZE,
    TL_INPUT_FILTER,
    TL_INPUT_SUN,
    TL_INPUT_REGIONS,
    TL_INPUT_PASSES,
    TL_INPUT_MAPS,        /* size and blur of the shadow maps */
    TL_INPUT_RAYS,        /* how rays are spent */
    TL_INPUT_ROUND,       /* which of the jittered frames that are averaged while nothing changes */
    TL_INPUT_SCENE_ROUND, /* ... while nothing but the camera does */
    TL_INPUT_LIGHT,       /* how light is put together */
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
    TL_MADE_SAMPLES,
    TL_MADE_TRANSPARENCY, /* what is seen through cloth */
    TL_MADE_MIRRORS,      /* what near mirrors show */
    TL_MADE_POINTS,
    TL_MADE_ENVMAP_LOBES,
    TL_MADE_CAPTURE,
    TL_MADE_ENVMAP,
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
    TL_SCENE_RASTER,       /* anything but the reference */
    TL_SCENE_SHADOWS,      /* somebody asks for visibility */
    TL_SCENE_MAPS,         /* ... of shadow maps */
    TL_SCENE_RAYS,         /* the back-end of rays says what is seen */
    TL_SCENE_TRANSPARENCY, /* ... and something is seen through, or is lit from behind */
    TL_SCENE_MIRRORS,      /* ... and something is so glossy that rays follow what it shows */
    TL_SCENE_PASSES,       /* passes on the GPU do */
    TL_SCENE_CHAINS,       /* ... and read filter chains */
    TL_SCENE_SLICES,       /* ... and read exact slices of the regions */
    TL_SCENE_EXACT,        /* exact light of the whole environment is read */
    TL_SCENE_BLUR,         /* shadow maps are variance maps */
    TL_SCENE_DETAIL,       /* a material's bumps need maps of their own */
    TL_SCENE_REFERENCE,
    TL_SCENE_ENVMAP,  /* environment maps light the image */
    TL_SCENE_CAPTURE, /* ... and show the scene */
    TL_SCENE_LAMPS,
    TL_SCENE_LAMP_MAPS, /* ... and depth maps shadow one of them */
    TL_SCENE_LAMP_RAYS, /* ... and rays do */
    TL_SCENE_SAMPLES,   /* rays start from what is seen */
    TL_SCENE_COMPOSED,  /* light is put together from what rays see */
    TL_SCENE_INSPECT,   /* something else than light is shown */
    TL_SCENE_FACT_COUNT
};

extern const char *const tl_resource_names[TL_RESOURCE_COUNT + 1];
extern const char *const tl_scene_fact_names[TL_SCENE_FACT_COUNT + 1];

/* The jobs, in execution order; each run function takes the tl_renderer. */
extern const tl_job tl_frame_jobs[];
extern const int tl_frame_job_count;

/* Bytes of a sample: in the largest texture, and in all: G-buffer, its depth, light. */
#define TL_SAMPLE_LAYER_BYTES 16
#define TL_SAMPLE_BYTES       (16 + 3 * 8 + 4 + 4 + 16)

/* How many frames have been drawn since something changed: anything, and anything but the camera. */
struct tl_rest {
    int image, scene;
    bool is_done;      /* rays: all rounds of this image are in */
    uint64_t captured; /* environment maps: the signature of the scene that they show; 0: none */
    int capture_age;   /* ... frames ago */
    bool is_captured;  /* ... and it is the one that is there */
};

/* The option tables of a frame's settings, bound to them. */
#define TL_RENDER_TABLES 6
void tl_render_settings_bind(struct tl_render_settings *settings,
                             struct tl_binding bindings[TL_RENDER_TABLES]);

/* One number for each input of the frame: an input has changed when its number has. `rest` becomes that of
 * this frame. */
void tl_frame_sign(const tl_frame *frame, const struct tl_render_settings *settings,
                   const uint64_t before[TL_INPUT_COUNT], struct tl_rest *rest,
                   uint64_t signatures[TL_INPUT_COUNT]);

/* Facts about the scene and how it is to be drawn, and the exponents that its materials need (env/lobes.h).
 */
tl_bits tl_frame_facts(const tl_frame *frame, const struct tl_render_settings *settings);
uint32_t tl_frame_exponents(const tl_frame *frame, const struct tl_detail_params *detail);
/* Whether any material, or any drawn, has this property. */
bool tl_frame_has(const tl_frame *frame, bool (*property)(const tl_material *material));
bool tl_material_is_faceted(const tl_material *material);
/* ... and those of environment maps, with the environment itself for mirrors. */
uint32_t tl_frame_map_exponents(const tl_frame *frame, const struct tl_detail_params *detail);

/* Makes renderer->light as large as its samples, and black. */
void tl_frame_clear_light(tl_renderer *renderer);

/* Lists what is drawn, with the ground last when it is drawn. */
void tl_frame_list_surfaces(tl_renderer *renderer);

/* Regions as lights that are not those of the last frame: whether they are kept, and what keeps them. */
#define TL_LIGHTS_KEPT TL_PREPARED_COUNTS_MAX
bool tl_frame_has_lights(const tl_renderer *renderer, const struct tl_light_params *light);
void tl_frame_prepare_lights(tl_renderer *renderer, const struct tl_light_params *light);
/* Regions of the present cube and their lights that were made elsewhere: what of both is not there yet is
 * taken. */
void tl_frame_keep_lights(tl_renderer *renderer, const struct tl_light_params *light,
                          struct tl_regions *regions, struct tl_region_lights *lights);

void tl_frame_cut_regions(const tl_cube *cube, const struct tl_light_params *light, struct tl_regions *out);
enum tl_region_weight tl_frame_region_weight(const struct tl_light_params *light);

/* In place of cube, suns, lobes and lights: those made ready for this frame's environment; false when there
 * are none. */
bool tl_frame_use_prepared(tl_renderer *renderer);

struct tl_renderer {
    tl_gpu *gpu;

    /* of the last draw; borrowed pointers in `frame` live as long as tl_frame says */
    tl_frame frame;
    struct tl_render_settings settings;
    struct tl_suns suns; /* of its environment */
    struct tl_view view;

    struct tl_resampling pour; /* from environments of one size to the cube */
    tl_cube cube;              /* without the suns */
    struct tl_regions regions;
    uint64_t regions_revision;
    struct tl_pems pems;
    struct tl_lobes lobes;
    struct tl_slices slices;
    struct tl_slice_maps slice_maps;
    const struct tl_region_lights *lights; /* among those kept */
    struct tl_kept_lights {
        uint64_t revision; /* of the light that they add up to; 0: empty */
        int regions, cut;
        enum tl_region_weight weight;
        uint64_t used; /* when, counted by kept_uses */
        struct tl_regions cut_regions;
        struct tl_region_lights lights;
    } kept[TL_LIGHTS_KEPT]; /* so that going to more or fewer regions and back costs little */
    uint64_t kept_uses;
    uint64_t light_revision;   /* rises with the cube */
    uint32_t exponents;        /* of the lobes: that the last frame needed */
    uint32_t exponents_before; /* ... that were needed last before these: kept for looks that go to and fro */
    uint32_t exponents_sent;   /* ... that the GPU has */
    tl_prepared *prepared;     /* NULL: nothing was made ready */
    tl_surfaces *surfaces;
    struct tl_detail_maps detail;
    size_t surface_count; /* with the ground, which comes last */
    struct tl_casters casters;
    struct tl_ground ground;
    tl_shadow_maps *maps;
    struct tl_gbuffer gbuffer;
    const tl_surface **drawn; /* what is drawn, with the ground last */
    struct tl_triangle_ranges ranges;
    struct tl_samples samples;
    struct tl_transparency transparency;
    struct tl_mirrors mirrors;
    tl_trace *trace;
    tl_points *points;
    float *light; /* [height][width][4] of samples, composed on the CPU */
    size_t light_bytes;
    struct tl_lighting lighting;
    struct {                       /* what environment maps are made of: the whole light, suns and all */
        struct tl_resampling pour; /* ... to their size */
        tl_cube cube;
        struct tl_lobes lobes;
    } surroundings;
    struct tl_capture capture;
    struct tl_envmap envmap;
    struct tl_local local;
    struct tl_present present;
    double standard_error; /* of the last reference */

    /* where the show job draws */
    unsigned show_framebuffer;
    int show_width, show_height;
    int show_first, show_end; /* columns */

    float strain_range; /* share of 1 at the ends of the legend, of the last view of strain */

    uint64_t signatures[TL_INPUT_COUNT]; /* of the last draw's inputs */
    tl_bits facts;                       /* of its scene */
    struct tl_rest rest;
    uint64_t shaders_stamp;
    tl_bits valid; /* resources that hold what their inputs call for */
    struct tl_work_counts {
        double triangles;
        int lamps;
        bool is_glossy, is_faceted, is_bumpy; /* any material */
    } counted;                                /* of the last frame: work.h */
    tl_bits moving;                           /* inputs that changed from one frame to the last */
    tl_plan plan;
    struct tl_cost_job costs[TL_JOBS_MAX];
    struct tl_machine_load load;
};

#endif
