/* The bytes that a frame's resources hold. */
#ifndef TOILE_RENDER_FRAME_MEMORY_H
#define TOILE_RENDER_FRAME_MEMORY_H

#include "render/frame/bytes.h"
#include "render/frame/resources.h"

struct tl_render_memory tl_resources_memory(const struct tl_resources *from);
size_t tl_resources_list(const struct tl_resources *from, struct tl_resource_memory out[TL_RESOURCES_MAX]);

#endif
