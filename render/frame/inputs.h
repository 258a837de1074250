/* The inputs of a frame: the value of each, and a hash that changes when the value does.
 *
 * An input made of options holds a copy of its table in which only those rows have a value whose column
 * `affects` names the input (OPTION_INPUTS in inputs.c); all other fields are 0, so that a job that reads an
 * option which the input does not hold finds nothing. A new row is in value and hash without further code.
 *
 * Units as in the options' rows. Lifetime: an input borrows what its comment says, until the next frame.
 * Threads: pure, but for tl_inputs_set, which writes to the resources. Errors: none. */
#ifndef TOILE_RENDER_FRAME_INPUTS_H
#define TOILE_RENDER_FRAME_INPUTS_H

#include "render/frame/resource.h"
#include "render/frame/settings.h"
#include "render/gbuffer/samples.h"

struct tl_resources;

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
    struct tl_image_params options; /* width, height ... */
    int columns, rows;              /* samples; fewer than pixels where options.scale is below 1 */
};

/* True when there are fewer samples than pixels, so that pixels need ids of their own. */
static inline bool tl_size_has_outlines(const struct tl_size_input *size)
{
    return size->columns < size->options.width || size->rows < size->options.height;
}

struct tl_ground_input {
    struct tl_image_params options;
    bool is_drawn;
    vec3s colour; /* reflectance: the options', else the environment's, else TL_GROUND_GREY */
};

struct tl_lobes_input {
    bool all;         /* of a material; else the diffuse and the glossy one */
    bool are_blended; /* into one between the two: TL_LOBE_SINGLE */
};

struct tl_shadow_input {
    struct tl_light_params options; /* visibility, moments, map_size, blur_m ... */
    bool in_passes;                 /* maps in an array: as many as PEMs in a pass */
};

struct tl_rays_input {
    struct tl_light_params options;
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
    struct tl_maps_params options; /* size, light_map */
    bool is_captured;              /* maps show the scene */
};

/* What moves in this frame. Not an input: no job runs because of it. */
struct tl_motion_state {
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
    uint64_t captured; /* environment maps: the hash of the scene that they show; 0: none */
    int capture_age;   /* ... frames ago */
    bool is_captured;  /* ... and it is the one that is there */
};

/* Computes one number for each input: an input has changed when its number has. `facts` are the frame's
 * (facts.h), `before` the numbers of the frame before; `rest` is that frame's and becomes this one's. */
void tl_frame_hash_inputs(const tl_frame *frame, const struct tl_render_settings *settings, tl_bits facts,
                          const uint64_t before[TL_INPUT_COUNT], struct tl_rest *rest,
                          uint64_t hashes[TL_INPUT_COUNT]);

/* Sets the inputs, and the facts and rounds that jobs see. `hashes` are the frame's; the arrays of `frame`
 * are borrowed. */
void tl_inputs_set(struct tl_resources *resources, const tl_frame *frame,
                   const struct tl_render_settings *settings, tl_bits facts, const struct tl_rest *rest,
                   const uint64_t hashes[TL_INPUT_COUNT]);

#endif
