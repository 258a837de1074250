/* The renderer's memory by use and by resource, as its API reports it. */
#ifndef TOILE_RENDER_FRAME_BYTES_H
#define TOILE_RENDER_FRAME_BYTES_H

#include <stddef.h>

/* Bytes by use, summed from what is allocated. */
struct tl_render_memory {
    size_t pems, maps, rays;
    size_t transparency; /* layers behind open cloth */
    size_t targets, surfaces, other, total;
};

/* One row of the same bytes by resource; resources that hold nothing have no row. */
#define TL_RESOURCES_MAX 64
struct tl_resource_memory {
    const char *name;
    size_t bytes;
};

#endif
