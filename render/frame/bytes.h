/* What a renderer's memory holds, for its API. */
#ifndef TOILE_RENDER_FRAME_BYTES_H
#define TOILE_RENDER_FRAME_BYTES_H

#include <stddef.h>

/* Bytes by use, summed from what is allocated. */
struct tl_render_memory {
    size_t pems, maps, rays;
    size_t transparency; /* of what is seen through cloth */
    size_t targets, surfaces, other, total;
};

/* The same bytes by what they hold; returns how many rows there are, of what is there at all. */
#define TL_RESOURCES_MAX 64
struct tl_resource_memory {
    const char *name;
    size_t bytes;
};

#endif
