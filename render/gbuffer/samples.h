/* The covered samples of a G-buffer, on the CPU. World space, metres. */
#ifndef TOILE_RENDER_GBUFFER_SAMPLES_H
#define TOILE_RENDER_GBUFFER_SAMPLES_H

#include "render/gbuffer/gbuffer.h"

/* `triangle` counts through all surfaces in their order; its top bit marks that the back is seen. */
#define TL_SAMPLE_BACK 0x80000000u

typedef struct tl_sample {
    uint32_t texel;    /* y * width + x, rows upwards as GL has them */
    uint32_t triangle; /* global number, and TL_SAMPLE_BACK */
    float weights[3];  /* barycentric, of the triangle's corners; they sum to 1 */
    float cover;       /* (0, 1] */
    vec3s point;       /* on the triangle */
    vec3s normal;      /* shading normal, unit, on the viewer's side */
    vec3s smooth;      /* interpolated normal without maps, unit, on the viewer's side: the horizon's */
    vec3s mirror; /* r: the view vector reflected about `normal`, unit; continued where that faces away */
    float glossiness;
    vec3s diffuse;     /* kd */
    vec3s specular;    /* F ks */
    float widening[3]; /* added to squared widths of facets along u and v, and to their product; 0 where
                          nothing is faceted */
} tl_sample;

/* In tiles of 4 x 4 texels, so that sixteen samples in a row are neighbours. */
struct tl_samples {
    int width, height;    /* of the target */
    size_t primary_count; /* nearest to the camera, one a texel */
    /* After them, with the texels that they are seen in, come those behind open cloth, and the other sides of
     * what scatters light through (transparency.h). What mirrors show is last. */
    size_t behind_count, other_count;
    size_t count, capacity;
    tl_sample *items;
    void *staging; /* rows of the G-buffer as they were read */
    size_t staging_bytes;
};

/* The first global triangle number of each surface (the ground comes last). */
struct tl_triangle_ranges {
    const tl_surface *const *surfaces;
    size_t surface_count;
    uint32_t *first; /* surface_count + 1 numbers; owned */
};
/* The surfaces must outlive the ranges; `out` is used again from frame to frame. */
void tl_triangle_ranges_make(const tl_surface *const *surfaces, size_t count, struct tl_triangle_ranges *out);
void tl_triangle_ranges_release(struct tl_triangle_ranges *ranges);
/* Returns the surface that holds global triangle `number` (without the top bit), and its three corners there.
 */
const tl_surface *tl_triangle_find(const struct tl_triangle_ranges *ranges, uint32_t number,
                                   uint32_t corners[3], size_t *surface);

/* The part that holds a surface's own triangle `number`. */
const struct tl_mesh_part *tl_triangle_part(const tl_surface *surface, uint32_t number);

/* The number of layers that the camera sees. */
static inline size_t tl_samples_seen(const struct tl_samples *samples)
{
    return samples->primary_count + samples->behind_count + samples->other_count;
}

/* The material of a global triangle number (without the top bit). */
const tl_material *tl_triangle_material(const struct tl_triangle_ranges *ranges, uint32_t number);

/* The origin of a sample's rays: on the smooth surface that its triangle approximates, `offset_m` above it.
 */
vec3s tl_sample_start(const tl_sample *sample, const struct tl_triangle_ranges *ranges, float offset_m);

/* The tangent along u, interpolated, on the side that is seen: unit or zero; and handedness. A back face's
 * normal and bitangent are turned over and its tangent is kept. */
vec4s tl_sample_tangent(const tl_sample *sample, const struct tl_triangle_ranges *ranges);

/* Reads the G-buffer back. The arrays of `out` are used again from frame to frame. */
void tl_samples_read(const struct tl_gbuffer *gbuffer, const struct tl_triangle_ranges *ranges, vec3s eye,
                     struct tl_samples *out);
/* Makes room for `count` samples and keeps those that are there. */
void tl_samples_reserve(struct tl_samples *samples, size_t count);
void tl_samples_release(struct tl_samples *samples);

#endif
