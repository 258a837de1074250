/* The memory of a frame's resources. Errors: none. Threads: the renderer's. */
#ifndef TOILE_RENDER_FRAME_MEMORY_H
#define TOILE_RENDER_FRAME_MEMORY_H

#include "render/frame/bytes.h"
#include "render/frame/resources.h"

/* Frees what the members own. The GPU, which is borrowed, must still be there. */
void tl_resources_release(struct tl_resources *all);

/* Bytes of every resource, by bit. Those of caches, and of the parts of a member that another job makes, are
 * added to the resource that they serve. */
void tl_resources_count(const struct tl_resources *from, size_t bytes[TL_RESOURCE_COUNT]);
/* Bytes by use, and by resource; returns the number of rows. Names are constants. */
struct tl_render_memory tl_resources_memory(const struct tl_resources *from);
size_t tl_resources_list(const struct tl_resources *from, struct tl_resource_memory out[TL_RESOURCES_MAX]);

#endif
