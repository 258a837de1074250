/* Views that show something other than light (image.view): normals, tangents, UVs, visibility, regions,
 * strain; and the description of the surface under a pixel.
 *
 * All on the CPU, from the covered samples of the G-buffer. These functions describe the last frame, whose
 * surfaces, materials and environment must still exist, as for tl_renderer_show_image. Threads: the
 * renderer's. */
#ifndef TOILE_RENDER_INSPECT_INSPECT_H
#define TOILE_RENDER_INSPECT_INSPECT_H

#include "render/gbuffer/samples.h"
#include "render/inspect/legend.h"
#include "render/scene/view.h"
#include "render/visibility/points.h"

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

/* The inputs of a view, all of the same image. Borrowed. */
struct tl_inspect_request {
    const struct tl_image_params *image; /* view, view_region, view_range */
    float strain_range;                  /* views of strain: share of 1 at the ends of the legend */
    const struct tl_samples *samples;
    const struct tl_triangle_ranges *ranges;
    const struct tl_regions *regions; /* NULL: none have been made */
    const tl_points *points;          /* visibility at the samples; NULL: not kept */
    const struct tl_view *view;
    float environment_yaw; /* rad */
};

/* The range of a view of strain: of image.view_range, or of what is drawn; `before` for other views. */
float tl_inspect_strain_range(const struct tl_image_params *image, const tl_surface *const *drawn,
                              size_t count, float before);
/* The legend of a view. */
void tl_inspect_legend(const struct tl_inspect_request *request, struct tl_legend *out);
/* Writes light[4 * texel] of the samples: the view's colours in place of light. */
void tl_inspect_paint(const struct tl_inspect_request *asked, float *light);
/* Whether rounds at rest change what is shown. */
bool tl_inspect_averages(int view);

/* The nearest sample of the texel in the middle of pixel (x, y) of a picture of width x height, counted from
 * its upper left corner; primary_count where nothing is. */
size_t tl_inspect_find(const struct tl_samples *samples, int width, int height, int x, int y);
/* Describes the surface at sample `number`. */
void tl_inspect_sample(const struct tl_inspect_request *request, size_t number, struct tl_inspection *out);
/* Describes the surface that a ray through the centre of the pixel hits, for images whose samples were not
 * kept. False when it hits none.
 */
bool tl_inspect_ray(const struct tl_inspect_request *request, int width, int height, int x, int y,
                    struct tl_inspection *out);

#endif
