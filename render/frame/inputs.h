/* The inputs of a frame: the value of each, and a signature that changes when the value does. An input made
 * of options holds the options that its signature covers and those that earlier resources already depend on.
 * All others are 0, so that a job that reads an option without declaring it finds nothing. Pure. */
#ifndef TOILE_RENDER_FRAME_INPUTS_H
#define TOILE_RENDER_FRAME_INPUTS_H

#include "render/frame/resource.h"
#include "render/frame/settings.h"
#include "render/gbuffer/samples.h"

struct tl_environment_input {
    const tl_environment *map; /* borrowed from the frame */
    uint64_t revision;
};

/* Topology, UVs, materials. Borrowed from the frame; the list and the ranges are owned. */
struct tl_shapes_input {
    const tl_surface *surfaces;
    size_t surface_count;
    const tl_surface **drawn; /* the same, with the ground last when it is drawn */
    size_t drawn_count;
    struct tl_triangle_ranges ranges; /* of these */
    uint64_t revision;
};

/* Positions, normals, tangents: of the same surfaces. */
struct tl_motion_input {
    const tl_surface *surfaces;
    size_t surface_count;
};

struct tl_camera_input {
    struct tl_camera camera;
    struct tl_view view; /* of an image of this size */
};

/* The camera's view of the image that is drawn, and how many were averaged before it. */
struct tl_shift_input {
    struct tl_view view;
    int before;
};

struct tl_size_input {
    int width, height, supersample; /* pixels, samples a pixel side */
    int columns, rows;              /* samples */
};

/* True when there are fewer samples than pixels, so that pixels need ids of their own. */
static inline bool tl_size_has_outlines(const struct tl_size_input *size)
{
    return size->columns < size->width || size->rows < size->height;
}

struct tl_ground_input {
    bool is_drawn;
    vec3s colour; /* reflectance */
};

struct tl_lobes_input {
    bool all;         /* of a material; else the diffuse and the glossy one */
    bool are_blended; /* into one between the two: TL_LOBE_SINGLE */
};

struct tl_cut_input {
    int regions, cut; /* enum tl_cut */
};

struct tl_shadow_input {
    enum tl_visibility kind;
    enum tl_moments moments;
    int map_size;   /* texels */
    bool in_passes; /* maps in an array: as many as PEMs in a pass */
    float blur_m;
};

struct tl_rays_input {
    struct tl_ray_params params;
    bool averages; /* rounds at rest change the image */
};

/* Lamps that shine, and how surfaces are shaded under them. */
struct tl_lamps_input {
    size_t count;
    struct tl_lamp items[TL_LAMPS_MAX];
    struct tl_shading_params shading;
};

struct tl_envmap_input {
    int size;         /* texels */
    bool is_captured; /* maps show the scene */
    int light_map;    /* texels, side; 0: none */
};

/* Not an input: how the frame stands in time. */
struct tl_moment {
    bool still;         /* as tl_frame.still */
    bool moves_shadows; /* surfaces or the environment's yaw differ from the last frame */
    bool moves_lamps;   /* lamps do */
};

/* How many frames have been drawn since something changed: anything, and anything but the camera. */
struct tl_rest {
    int image, scene;
    bool is_done;      /* rays: all rounds of this image are in */
    int shift_set;     /* images of a set that are shifted; 0: none */
    int shifts;        /* ... that there were in this rest */
    int shifts_left;   /* ... that are to come once all rounds are in */
    uint64_t captured; /* environment maps: the signature of the scene that they show; 0: none */
    int capture_age;   /* ... frames ago */
    bool is_captured;  /* ... and it is the one that is there */
};

/* One number for each input: an input has changed when its number has. `rest` becomes that of this frame. */
void tl_frame_sign(const tl_frame *frame, const struct tl_render_settings *settings,
                   const uint64_t before[TL_INPUT_COUNT], struct tl_rest *rest,
                   uint64_t signatures[TL_INPUT_COUNT]);

/* The view of the image to be drawn, `view` being that of the camera. Pixels. */
struct tl_shift_input tl_input_shift(const struct tl_rest *rest, const struct tl_view *view, int width,
                                     int height);

/* The options of the inputs that hold some of a table. */
struct tl_light_params tl_input_light(const struct tl_light_params *light);
struct tl_lobes_input tl_input_lobes(const struct tl_light_params *light);
struct tl_shadow_input tl_input_shadows(const struct tl_light_params *light);
struct tl_detail_params tl_input_detail_maps(const struct tl_detail_params *detail);
struct tl_maps_params tl_input_layout(const struct tl_maps_params *maps);
struct tl_maps_params tl_input_look_up(const struct tl_maps_params *maps);
struct tl_maps_params tl_input_capture(const struct tl_maps_params *maps);
struct tl_ground_input tl_input_ground(const tl_frame *frame, const struct tl_image_params *image);
struct tl_image_params tl_input_show(const struct tl_image_params *image);
struct tl_image_params tl_input_view(const struct tl_image_params *image);
struct tl_lamps_input tl_input_lamps(const tl_frame *frame, const struct tl_shading_params *shading);

#endif
