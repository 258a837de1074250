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
    /* Borrowed from the frame. */
    const tl_environment *map;
    /* Differs for each environment; 0 is a revision like any other. */
    uint64_t revision;
};

/* Topology, UVs, materials. */
struct tl_shapes_input {
    /* Borrowed from the frame. */
    const tl_surface *surfaces;
    size_t surface_count;
    /* The same surfaces, with the ground last when it is drawn. The list is owned, the surfaces are not. */
    const tl_surface **drawn;
    size_t drawn_count;
    /* The triangles of these. Owned. */
    struct tl_triangle_ranges ranges;
    /* The hash of this input. */
    uint64_t revision;
};

/* Positions, normals, tangents: of the same surfaces, borrowed. */
struct tl_motion_input {
    const tl_surface *surfaces;
    size_t surface_count;
};

struct tl_camera_input {
    struct tl_camera camera;
    /* The view of an image of this size, not shifted. */
    struct tl_view view;
};

/* The camera's view of the image that is drawn, shifted by a part of a pixel, and the number of images that
 * it is averaged with; 0: it replaces them. */
struct tl_shift_input {
    struct tl_view view;
    int before;
    /* Images that a job draws at once; 1 but for still ones of rounds on the graphics card. */
    int rounds;
};

struct tl_size_input {
    /* Width and height in pixels, samples a pixel side ... */
    struct tl_image_params options;
    /* Samples of the image; fewer than pixels where options.scale x options.supersample is below 1. */
    int columns, rows;
};

/* True when there are fewer samples than pixels, so that pixels need ids of their own. */
static inline bool tl_size_has_outlines(const struct tl_size_input *size)
{
    return size->columns < size->options.width || size->rows < size->options.height;
}

struct tl_ground_input {
    struct tl_image_params options;
    bool is_drawn;
    /* Reflectance, linear: the options', else the environment's, else TL_GROUND_GREY. */
    vec3s colour;
};

struct tl_lobes_input {
    /* All lobes of a material are drawn; else the diffuse and the glossy one. */
    bool all;
    /* They are blended into one between the two: TL_LOBE_SINGLE. */
    bool are_blended;
};

struct tl_shadow_input {
    /* Visibility, moments, map_size, blur_m ... */
    struct tl_light_params options;
    /* Maps lie in arrays of as many as there are PEMs in a pass; else all in one array. */
    bool in_passes;
};

struct tl_rays_input {
    struct tl_light_params options;
    /* Options of the back-end of rays: tl_light_ray_params of the table. */
    struct tl_ray_params params;
    /* Rounds at rest change the image. */
    bool averages;
};

/* Lamps that shine, and how surfaces are shaded under them. */
struct tl_lamps_input {
    size_t count;
    struct tl_lamp items[TL_LAMPS_MAX];
    struct tl_shading_params shading;
};

struct tl_envmap_input {
    /* Size in texels, light_map ... */
    struct tl_maps_params options;
    /* Maps show the scene; else the environment alone. */
    bool is_captured;
};

/* Movement in this frame. It is not an input: no job runs because of it. */
struct tl_motion_state {
    /* As tl_frame.still: the image takes all its rounds at once. */
    bool still;
    /* Surfaces or the environment's yaw differ from the last frame. */
    bool moves_shadows;
    /* Lamps do. */
    bool moves_lamps;
};

/* The frames since something changed, and what they have averaged. A zeroed struct: there was no frame. */
struct tl_rest {
    /* Frames since anything changed, and since anything but the camera did: the number of the round. */
    int image, scene;
    /* Rays: all rounds of this image are in. */
    bool is_done;
    /* Images of a set that are shifted; 0: none. Those of them drawn in this rest, and those to come once all
     * rounds are in. */
    int shift_set, shifts, shifts_left;
    /* Environment maps: the hash of the scene that they show; 0: none. */
    uint64_t captured;
    /* Frames since that capture. */
    int capture_age;
    /* It is the capture that is there. */
    bool is_captured;
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

/* The view of one of the images that are shifted by parts of a pixel, the first by none. */
struct tl_view tl_frame_shifted_view(const struct tl_view *view, int number, int width, int height);

#endif
