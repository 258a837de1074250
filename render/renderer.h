/* The renderer: surfaces + environment + settings -> a linear HDR image with coverage in alpha.
 *
 * It sees surfaces only, never cloth. The frame is a const table of jobs (render/frame/frame.c); what runs is
 * decided by render/plan. Owns every GL object it makes. Threads: the one its tl_gpu is current on. */
#ifndef TOILE_RENDER_RENDERER_H
#define TOILE_RENDER_RENDERER_H

#include "assets/base/surface.h"
#include "assets/environment.h"
#include "config/options.h"
#include "render/detail/options.h"
#include "render/gpu/gpu.h"
#include "render/local/shading.h"
#include "render/plan/plan.h"

enum tl_method {
    TL_METHOD_PEM,    /* the environment's regions, shadowed one by one */
    TL_METHOD_LIGHTS, /* the regions as directional lights: no prefiltered maps [002, figure 6 and section 7]
                       */
    TL_METHOD_AO,     /* unshadowed light times ambient occlusion */
    TL_METHOD_AO_COLOUR,  /* ... times the occlusion of the diffuse light, by channel */
    TL_METHOD_UNSHADOWED, /* visibility is 1 everywhere */
    TL_METHOD_REFERENCE,  /* ray traced: render/reference */
    TL_METHOD_MAPS        /* classic environment mapping, unshadowed: render/envmap */
};
enum tl_lobe { TL_LOBE_SINGLE, TL_LOBE_DUAL };
enum tl_cut { TL_CUT_FACES, TL_CUT_SPHERE };
enum tl_prefilter { TL_PREFILTER_CHAIN, TL_PREFILTER_SLICES };
enum tl_visibility { TL_VISIBILITY_VSM, TL_VISIBILITY_DEPTH, TL_VISIBILITY_RAYS };
/* sum: VIS_i P_i [002, eq. 5]. difference: E - (1 - VIS_i) P_i. ratio: E x sum VIS_i w_i / sum w_i, w_i being
 * P_i or what stands for it. E is the exact unshadowed light. */
enum tl_composition { TL_COMPOSE_SUM, TL_COMPOSE_DIFFERENCE, TL_COMPOSE_RATIO };
enum tl_background { TL_BACKGROUND_ENVIRONMENT, TL_BACKGROUND_BLURRED, TL_BACKGROUND_GREY };

struct tl_light_params { /* table "light" */
    int method;          /* enum tl_method */
    int lobe;            /* enum tl_lobe */
    int cut;             /* enum tl_cut */
    int regions;         /* N; cut of the faces: rounded down to a multiple of six */
    bool sun;            /* suns leave the regions and get shadows of their own */
    int prefilter;       /* enum tl_prefilter, of the map back-ends; rays use exact lobes */
    int pem_size;        /* texels per face side, a power of two */
    int filter;          /* enum tl_chain_filter */
    int pems_per_pass;   /* 12 in the paper; 1 to 64 */
    int visibility;      /* enum tl_visibility: the back-end */
    int composition;     /* enum tl_composition; rays: ratio only */
    bool jitter;         /* directions vary inside their regions from frame to frame */
    int rounds;          /* at rest, so many jittered frames are averaged */
    int refresh;         /* rays: regions traced anew for each point and moving frame; 0: all */
    int rays;            /* rays: directions a region and refresh */
    float repair;        /* rays: share of the samples, the least certain, that get rays of their own */
    float repair_rest;   /* ... once nothing moves, when it is more */
    int fan;             /* rays: cosine lobes at most that stand for a gloss of facets */
    bool reflect_scene; /* near mirrors (s >= TL_MIRROR_EXPONENT) see the lit scene; false: black, as [002] */
    int map_size;       /* texels, side of a shadow map */
    float blur_m;       /* metres: the Gaussian's sigma is blur_m x tan(cone) */
    float depth_bias_m; /* metres */
    float min_variance; /* m^2, floor of the VSM variance */
    float bleed_reduction; /* [0, 1): Chebyshev values below it become 0 */
};
extern const struct tl_option_table tl_light_options;
/* So many sheets are looked through, where cloth is open; the next one is taken as closed. */
#define TL_TRANSPARENCY_LAYERS 4
#define TL_MIRROR_EXPONENT     199.0f /* a glossiness of 0.995, however it is rounded */

/* How environment maps are looked up (render/envmap/envmap.h), and what is made of it. */
enum tl_maps_look_up { TL_LOOK_UP_DIRECT, TL_LOOK_UP_MATRIX };
enum tl_maps_mode {
    TL_MAPS_SURFACE,
    TL_MAPS_MIRROR,
    TL_MAPS_REFRACTION,
    TL_MAPS_DIFFUSE,
    TL_MAPS_GLOSSY,
    TL_MAPS_TRANSMISSION
};
/* off: the reflectance of the G-buffer. Else F of a table over the cosine: Lo = F Lm + Ld, or F Lm + (1 - F)
 * Ld [Heidrich and Seidel 1999, 4.4]. */
enum tl_maps_fresnel { TL_MAPS_FRESNEL_OFF, TL_MAPS_FRESNEL_ADDITIVE, TL_MAPS_FRESNEL_COAT };
struct tl_maps_params {  /* table "maps", of TL_METHOD_MAPS */
    int layout;          /* enum tl_layout (render/env/layout.h) */
    int size;            /* texels, a power of two: side of a cube's face, height of the others */
    int look_up;         /* enum tl_maps_look_up, of paraboloids */
    int mode;            /* enum tl_maps_mode */
    int fresnel;         /* enum tl_maps_fresnel */
    bool minify;         /* mirrors read mip levels */
    int capture_every;   /* frames from one capture of the scene to the next; 0: the environment alone */
    float capture_at[3]; /* metres, from the middle of what casts shadows */
};
extern const struct tl_option_table tl_maps_options;
#define TL_MAPS_SIZE_MIN 4
#define TL_MAPS_SIZE_MAX 512

struct tl_material_params { /* table "material": the garment's look, from the fabric or by hand */
    bool use_file;          /* keep the garment file's own materials where it has them */
    float diffuse[3];
    float specular[3];
    float glossiness;
    int model, facets, masking, fresnel; /* as struct tl_gloss */
    float index, extinction;
    float width_weft, width_warp, rotation_deg;
    float coat, coat_glossiness;
    float transmission[3];
    float openness;
};
extern const struct tl_option_table tl_material_options;
extern const struct tl_option_table
    tl_overlay_options; /* table "overlay": the same, of a garment's second fabric */

/* What the image shows: render/inspect. */
enum tl_image_view {
    TL_VIEW_LIGHT,
    TL_VIEW_NORMAL, /* with bumps */
    TL_VIEW_SMOOTH, /* ... without */
    TL_VIEW_TANGENT,
    TL_VIEW_UV,
    TL_VIEW_ALBEDO,
    TL_VIEW_GLOSS,
    TL_VIEW_VISIBILITY,
    TL_VIEW_REGION,
    TL_VIEW_STRAIN_WARP,
    TL_VIEW_STRAIN_WEFT,
    TL_VIEW_STRAIN_SHEAR,
    TL_VIEW_COUNT
};
extern const char *const tl_image_view_names[]; /* "light", "normal" ...; NULL-terminated */

struct tl_image_params { /* table "image" */
    int width, height;
    int supersample;   /* samples per pixel side, box filtered in linear light */
    float exposure_ev; /* for show only */
    int background;    /* enum tl_background; for show only */
    bool ground;       /* a ground disc at y = 0 */
    int view;          /* enum tl_image_view */
    int view_region;   /* visibility view: of this region; -1: of all, by their power */
    float view_range;  /* strain views: percent at the legend's ends; 0: automatic */
    float scale;       /* samples a side over those that supersample asks for, (0, 1] */
    bool legend;       /* pictures of a view say what its colours mean */
};
/* Size of the G-buffer and of the light. */
void tl_image_samples(const struct tl_image_params *image, int *width, int *height);
extern const struct tl_option_table tl_image_options;

struct tl_reference_params { /* table "reference" */
    int strata;              /* directions a replicate takes from the environment */
    int lobe_samples;        /* ... from the glossy lobe */
    int replicates;
    int terminator; /* enum tl_terminator (render/reference/reference.h) */
};
extern const struct tl_option_table tl_reference_options;

struct tl_camera {
    vec3s eye, target, up; /* metres */
    float fov_y;           /* rad */
    float near_m, far_m;
};

/* A light that is no part of the environment. Its irradiance on a surface that faces it is `irradiance`, at
 * every distance if it is directional, and at 1 m, falling with the square of the distance, if it is a point.
 */
enum tl_lamp_kind { TL_LAMP_NONE, TL_LAMP_DIRECTIONAL, TL_LAMP_POINT };
struct tl_lamp {
    enum tl_lamp_kind kind;
    vec3s direction;  /* DIRECTIONAL: towards the light, unit */
    vec3s position;   /* POINT: metres */
    vec3s irradiance; /* linear Rec. 709, pi times the radiance that a white matt surface facing it sends back
                       */
};
#define TL_LAMPS_MAX 4

/* Read-only inputs of one frame. */
typedef struct tl_frame {
    struct tl_camera camera;
    const tl_surface *surfaces;
    size_t surface_count;
    const tl_environment *environment;
    uint64_t environment_revision; /* changes when the environment does */
    float environment_yaw;         /* rad: the environment turned about +Y, counter-clockwise from above */
    const struct tl_lamp *lamps;
    size_t lamp_count; /* at most TL_LAMPS_MAX */
    double time_s;
    bool aovs;  /* what render/inspect/aovs.h reads is kept */
    bool still; /* drawn until it rests: every round is taken whole, however long that takes */
} tl_frame;

struct tl_render_settings {
    struct tl_light_params light;
    struct tl_detail_params detail;
    struct tl_maps_params maps;
    struct tl_shading_params shading; /* under lamps */
    struct tl_image_params image;
    struct tl_reference_params reference;
};

typedef struct tl_renderer tl_renderer;

tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error);
void tl_renderer_destroy(tl_renderer **renderer);

/* Draws the frame into the renderer's own HDR target. Work that nothing changed is not repeated. */
bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error);

/* The next draw makes anew all that follows from surfaces and camera, as a new renderer would; what was made
 * of the environment alone stays. For checks: what is reused must equal what is made anew. */
bool tl_renderer_forget_scene(tl_renderer *renderer, tl_error *error);

/* Of the image by TL_METHOD_REFERENCE that was drawn last, as rel_rmse of render/metrics/compare.h; 0 before.
 */
double tl_renderer_standard_error(const tl_renderer *renderer);

/* True once drawing the same frame again would change nothing: no jittered round is left to be averaged. */
bool tl_renderer_is_at_rest(const tl_renderer *renderer);

/* What is drawn next owes nothing to what was drawn before, as in a new renderer. */
void tl_renderer_forget(tl_renderer *renderer);

/* The HDR image: F32 RGBA, linear, alpha = coverage, premultiplied, black where nothing is. */
bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error);

/* The scene as it was last captured by TL_METHOD_MAPS, a cube in world axes (render/envmap/capture.h); not
 * when nothing was. */
bool tl_renderer_read_capture(const tl_renderer *renderer, tl_image *out, tl_error *error);

/* For show: background, exposure, tone mapping (Khronos PBR Neutral), sRGB. To an image (U8 RGB), or to
 * columns [first, end) of the current window's buffer 0, whose size is given in pixels. The drawn frame's
 * environment must still be there. */
bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error);
bool tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                              tl_error *error);

/* What draw would do with this frame, and why; and what it has taken so far. Pure but for reading the
 * renderer's state. */
void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out);
const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer);

/* What a frame to come would take if it moves as the last ones did, for those who choose its settings: first
 * which jobs (by bit) would run, then how long they would take; the last is cheap enough to be asked for
 * thousands of settings. Both pure but for reading the renderer's state. */
tl_bits tl_renderer_would_run(const tl_renderer *renderer, const tl_frame *frame,
                              const struct tl_render_settings *settings);
double tl_renderer_would_take(const tl_renderer *renderer, const struct tl_render_settings *settings,
                              tl_bits jobs); /* ms */
/* How much slower the machine is than it was: other programs'; 1: not. */
double tl_renderer_load(const tl_renderer *renderer);
/* False while nothing but jittered rounds and options made the last frame different from the one before, and
 * would make this one different from it. */
bool tl_renderer_is_moving(const tl_renderer *renderer, const tl_frame *frame);
/* Going to the regions of these settings is cheap once they have been prepared, which takes as long as some
 * frames do; so are those of the last frames. True where there is nothing to prepare. */
bool tl_renderer_has_regions(const tl_renderer *renderer, const struct tl_render_settings *settings);
void tl_renderer_prepare_regions(tl_renderer *renderer, const struct tl_render_settings *settings);

/* Bytes by use, summed from what is allocated. */
struct tl_render_memory {
    size_t pems, maps, rays;
    size_t transparency; /* of what is seen through cloth */
    size_t targets, surfaces, other, total;
};
struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer);

/* The same bytes by what they hold; returns how many rows there are, of what is there at all. */
#define TL_RESOURCES_MAX 64
struct tl_resource_memory {
    const char *name;
    size_t bytes;
};
size_t tl_renderer_resources(const tl_renderer *renderer, struct tl_resource_memory out[TL_RESOURCES_MAX]);

#endif
