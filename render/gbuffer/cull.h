/* Culls triangles that cannot change a picture.
 *
 * In a small picture most of a garment's triangles fall between the samples or behind other triangles. The
 * GPU finds that out for itself once it has worked for each of them; on software GL that is most of what a
 * small picture costs. A triangle is left out if it covers the centre of no sample, or if it is hidden at
 * each one that it covers, by more than any rasteriser's rounding: the picture stays the same to the bit. The
 * other triangles stay in order. Pure. */
#ifndef TOILE_RENDER_GBUFFER_CULL_H
#define TOILE_RENDER_GBUFFER_CULL_H

#include "assets/base/surface.h"

struct tl_cull_request {
    const tl_surface *const *surfaces;
    size_t surface_count;
    mat4s view_projection; /* as GL has it */
    int width, height;     /* samples */
    int subpixel_bits;     /* corners are rounded to 2^-bits of a sample */
    /* Hidden triangles are left out, too. Parts whose alpha map cuts holes hide nothing; no more do surfaces
     * from this one on, which fade. */
    bool nearest_only;
    size_t first_fading;
};

/* A vertex projected to the picture: samples from the left and from below, and depth in 0 .. 1. */
struct tl_cull_place {
    float x, y, z;
    bool ahead; /* else it lies on the plane of the eye or behind it, and has no place */
};

struct tl_cull {
    size_t triangle_count, part_count; /* that are kept; parts of all surfaces, in their order */
    uint32_t *indices;                 /* [triangle_count][3]: vertices of their surfaces */
    uint32_t *numbers;                 /* [triangle_count]: counted through all surfaces */
    struct tl_cull_part {
        size_t first, count; /* triangles */
    } * parts;
    size_t triangle_capacity, part_capacity, place_capacity, depth_capacity;
    struct tl_cull_place *places; /* of all vertices */
    float *depths;                /* [height][width]: behind this a sample surely shows nothing */
};

/* `out` is used again from frame to frame. */
void tl_cull_make(const struct tl_cull_request *request, struct tl_cull *out);
void tl_cull_release(struct tl_cull *cull);
size_t tl_cull_bytes(const struct tl_cull *cull);

#endif
