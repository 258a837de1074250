/* The tree of boxes of a frame's triangles, on the graphics card (tree.h). It is built for the first pose of
 * a mesh, fitted to each other one by refit.comp, and built again where motion has made it a bad tree.
 * Kernels include trace.glsl to follow rays through it.
 *
 * Owns its GL objects; needs the context of its tl_gpu, on whose thread it is used. */
#ifndef TOILE_RENDER_TRACE_TREE_BUFFERS_H
#define TOILE_RENDER_TRACE_TREE_BUFFERS_H

#include "render/gpu/compute.h"
#include "render/trace/tree.h"

/* All zeros: no tree yet. */
struct tl_tree_buffers {
    tl_buffer nodes, triangles; /* what trace.glsl reads */
    tl_buffer boxes, children, heads, order;
    tl_program refit;
    struct tl_tree tree; /* without triangles: none has been built */
    uint64_t topology_revision;
    double built_cost;    /* tl_tree_cost at the pose of the build */
    unsigned since_check; /* refits since the cost was checked */
    bool is_built;
};

struct tl_tree_request {
    const vec3s *positions;  /* metres, world */
    const uint32_t *corners; /* [triangle_count][3] */
    const float *openness;   /* [triangle_count]: what passes through a triangle; NULL: nothing */
    size_t triangle_count;
    size_t caster_count;        /* those from here on cast no shadow: see tl_tree_build */
    uint64_t topology_revision; /* changes when anything but positions does */
    /* The same positions (three floats each) and corners, already on the card. */
    const tl_buffer *position_buffer, *corner_buffer;
};

/* Makes the tree one of this pose. What is dispatched after it sees it. Errors: TL_DEVICE if the buffers are
 * too large; TL_INPUT if the shader does not compile. */
bool tl_tree_buffers_update(struct tl_tree_buffers *buffers, tl_gpu *gpu,
                            const struct tl_tree_request *request, tl_error *error);
/* Binds what trace.glsl reads from TREE_BINDING on, two buffers. */
void tl_tree_buffers_bind(const struct tl_tree_buffers *buffers, unsigned binding);
/* Compiles the program again. */
bool tl_tree_buffers_reload(struct tl_tree_buffers *buffers, tl_error *error);
void tl_tree_buffers_release(struct tl_tree_buffers *buffers);
size_t tl_tree_buffers_bytes(const struct tl_tree_buffers *buffers);

#endif
