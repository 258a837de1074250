/* The renderer: surfaces + environment + settings -> a linear HDR image with coverage in alpha.
 *
 * It sees surfaces only, never cloth. The frame is a const table of jobs (render/frame/frame.c); what runs is
 * decided by render/plan. Owns every GL object it makes. Threads: the one its tl_gpu is current on. */
#ifndef TOILE_RENDER_RENDERER_H
#define TOILE_RENDER_RENDERER_H

#include "assets/environment.h"
#include "assets/surface.h"
#include "config/options.h"
#include "render/gpu/gpu.h"
#include "render/plan/plan.h"

enum tl_method { TL_METHOD_PEM, TL_METHOD_UNSHADOWED };
enum tl_lobe { TL_LOBE_SINGLE, TL_LOBE_DUAL };
enum tl_background { TL_BACKGROUND_ENVIRONMENT, TL_BACKGROUND_BLURRED, TL_BACKGROUND_GREY };

struct tl_light_params {   /* table "light" */
    int method;            /* enum tl_method */
    int lobe;              /* enum tl_lobe */
    int regions;           /* N, rounded down to a multiple of six */
    int pem_size;          /* texels per face side, a power of two */
    int filter;            /* enum tl_chain_filter */
    int pems_per_pass;     /* 12 in the paper; 1 to 64 */
    int map_size;          /* texels, side of a shadow map */
    float blur_m;          /* metres: the Gaussian's sigma is blur_m x tan(cone) */
    float depth_bias_m;    /* metres */
    float min_variance;    /* m^2, floor of the VSM variance */
    float bleed_reduction; /* [0, 1): Chebyshev values below it become 0 */
};
extern const struct tl_option_table tl_light_options;

struct tl_material_params { /* table "material": the garment's look, from the fabric or by hand */
    bool use_file;          /* keep the garment file's own materials where it has them */
    float diffuse[3];
    float specular[3];
    float glossiness;
};
extern const struct tl_option_table tl_material_options;

struct tl_image_params { /* table "image" */
    int width, height;
    int supersample;   /* samples per pixel side, box filtered in linear light */
    float exposure_ev; /* for show only */
    int background;    /* enum tl_background; for show only */
    bool ground;       /* a ground disc at y = 0 */
};
extern const struct tl_option_table tl_image_options;

struct tl_camera {
    vec3s eye, target, up; /* metres */
    float fov_y;           /* rad */
    float near_m, far_m;
};

/* Read-only inputs of one frame. */
typedef struct tl_frame {
    struct tl_camera camera;
    const tl_surface *surfaces;
    size_t surface_count;
    const tl_environment *environment;
    uint64_t environment_revision; /* changes when the environment does */
    float environment_yaw;         /* rad: the environment turned about +Y, counter-clockwise from above */
    double time_s;
} tl_frame;

struct tl_render_settings {
    struct tl_light_params light;
    struct tl_image_params image;
};

typedef struct tl_renderer tl_renderer;

tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error);
void tl_renderer_destroy(tl_renderer **renderer);

/* Draws the frame into the renderer's own HDR target. Work that nothing changed is not repeated. */
bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error);

/* The HDR image: F32 RGBA, linear, alpha = coverage, premultiplied, black where nothing is. */
bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error);

/* For show: background, exposure, tone mapping (Khronos PBR Neutral), sRGB. To an image (U8 RGB) or, with
 * `framebuffer`, to the current window's buffer 0 at the given size in pixels. The drawn frame's environment
 * must still be there. */
bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error);
bool tl_renderer_show_window(tl_renderer *renderer, int width, int height, tl_error *error);

/* What draw would do with this frame, and why; and what it has taken so far. Pure but for reading the
 * renderer's state. */
void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out);
const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer);

/* Bytes by use, summed from what is allocated. */
struct tl_render_memory {
    size_t pems, maps, targets, surfaces, other, total;
};
struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer);

#endif
