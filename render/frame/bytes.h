/* The renderer's memory by use and by resource, as its API reports it.
 *
 * Bytes are computed from what is allocated, on the CPU and on the GPU, without what a driver adds. Lifetime:
 * plain values; names are constants. Threads: any. */
#ifndef TOILE_RENDER_FRAME_BYTES_H
#define TOILE_RENDER_FRAME_BYTES_H

#include <stddef.h>

/* Bytes by use; 0: nothing is held for it. The column `use` of TL_MADE_BITS (resource.h) names these. */
struct tl_render_memory {
    /* Light of the environment's regions: PEMs, lobes, slices, lights; environment and light maps. */
    size_t pems;
    /* Shadow maps of regions, suns and lamps. */
    size_t maps;
    /* Rays, and their results: samples, the BVH, visibility and bounced light at vertices. */
    size_t rays;
    /* Layers behind open cloth. */
    size_t transparency;
    /* Images: G-buffer, ID buffers, light, the result. */
    size_t targets;
    /* Vertices, textures, detail maps, materials on the CPU. */
    size_t surfaces;
    /* The cube, the regions, tables, the backdrop. */
    size_t other;
    /* The sum of these. */
    size_t total;
};

/* One row of the same bytes by resource; resources that hold nothing have no row. There are at most as many
 * rows as bits in a set of resources. */
#define TL_RESOURCES_MAX 64
struct tl_resource_memory {
    const char *name;
    size_t bytes;
};

#endif
