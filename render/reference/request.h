/* The scene, view and options of one image by the reference renderer. */
#ifndef TOILE_RENDER_REFERENCE_REQUEST_H
#define TOILE_RENDER_REFERENCE_REQUEST_H

#include "render/reference/options.h"
#include "render/scene/frame.h"

struct tl_detail_params;
struct tl_ground;

struct tl_reference_request {
    const tl_frame *frame;
    const struct tl_ground *ground; /* not among the frame's surfaces; NULL: none */
    const struct tl_reference_params *params;
    const struct tl_detail_params *detail;
    int lobe;           /* enum tl_lobe (render/light/options.h) */
    bool reflect_scene; /* near mirrors see the lit scene; false: black */
    int bounces;        /* how often light is sent on by surfaces before the one that is seen */
    int width, height;  /* pixels */
    int supersample;    /* samples a pixel side */
};

#endif
