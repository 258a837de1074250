/* Views that show something other than light (image.view): normals, tangents, UVs, visibility, regions,
 * strain; and what lies under a pixel.
 *
 * All on the CPU, from the covered samples of the G-buffer. What these functions tell is of the image that
 * was drawn last: its surfaces, materials and environment must still be there, as for tl_renderer_show_image.
 * Threads: the renderer's. */
#ifndef TOILE_RENDER_INSPECT_INSPECT_H
#define TOILE_RENDER_INSPECT_INSPECT_H

#include "render/inspect/legend.h"

struct tl_inspection {
    const char *surface;  /* "garment", "avatar", "ground"; borrowed from the frame */
    const char *material; /* borrowed from the frame */
    size_t surface_index; /* into the frame's surfaces; their count: the ground */
    uint32_t triangle;    /* of the surface */
    bool back;            /* its inner side is seen */
    float weights[3];     /* barycentric, of the triangle's corners */
    vec3s position;       /* metres, world */
    vec3s normal;         /* world, unit, on the viewer's side: with bumps where has_sample, else smooth */
    vec3s smooth;         /* ... without bumps */
    vec3s tangent;        /* world, unit, along u (the weft); zero where there is none */
    vec2s uv;
    vec2s uv_mm; /* the same in millimetres of cloth; zero where UVs have no scale */
    float glossiness;
    /* Visibility of the environment, where rays keep it. */
    bool has_visibility;
    float visibility;      /* [0, 1]: mean over the regions, weighted by their power */
    int strongest_region;  /* by power, cosine and visibility; -1: all is dark */
    float strongest_share; /* [0, 1]: of the diffuse light */
    /* Strain, where the surface knows it (tl_surface.strains): 0.1 is 10 % longer. */
    bool has_strain;
    float strain_warp, strain_weft; /* length over rest length, less 1 */
    float shear;                    /* cosine of the angle between warp and weft; 0: at right angles */
};

#endif
