#include "render/trace/tree_buffers.h"

#include "config/base/memory.h"
#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

/* The tree is built again where a ray has this many times the work that it had at the build: 38 ms for 24,000
 * triangles. After 300 frames of a garment that moves, rays took 5 % more nodes; after a jump of 0.9 m, 30
 * times as many. */
#define WORN 1.5
/* Every so many refits the cost is checked: 0.6 ms for 24,000 triangles. */
#define CHECK_EVERY 8

#define NODE_BYTES     80
#define BOX_BYTES      32
#define TRIANGLE_BYTES 48
#define GROUP_NODES    8

/* A place of the tree's order: the triangle and its openness. */
struct tree_place {
    uint32_t triangle;
    float openness;
};

static bool send_order(struct tl_tree_buffers *buffers, tl_gpu *gpu, const struct tl_tree_request *request,
                       tl_error *error)
{
    const struct tl_tree *tree = &buffers->tree;
    const size_t count = tree->triangle_count > 0 ? tree->triangle_count : 1;
    struct tree_place *places = TL_NEW_ARRAY(struct tree_place, count);
    for (size_t i = 0; i < tree->triangle_count; i++)
        places[i] =
            (struct tree_place){tree->order[i], request->openness ? request->openness[tree->order[i]] : 0};
    const bool done = tl_buffer_fill(&buffers->order, gpu, places, count * sizeof *places, error) &&
                      tl_buffer_reserve(&buffers->triangles, gpu, count * TRIANGLE_BYTES, error);
    free(places);
    return done;
}

static bool build(struct tl_tree_buffers *buffers, tl_gpu *gpu, const struct tl_tree_request *request,
                  tl_error *error)
{
    struct tl_tree *tree = &buffers->tree;
    tl_tree_release(tree);
    *tree =
        tl_tree_build(request->positions, request->corners, request->triangle_count, request->caster_count);
    buffers->built_cost = tl_tree_cost(tree, request->positions, request->corners);
    buffers->topology_revision = request->topology_revision;
    buffers->since_check = 0;
    const size_t count = tree->node_count;
    buffers->is_built =
        tl_buffer_fill(&buffers->children, gpu, tree->children, count * sizeof *tree->children, error) &&
        tl_buffer_fill(&buffers->heads, gpu, tree->heads, count * sizeof *tree->heads, error) &&
        tl_buffer_reserve(&buffers->boxes, gpu, count * BOX_BYTES, error) &&
        tl_buffer_reserve(&buffers->nodes, gpu, count * NODE_BYTES, error) &&
        send_order(buffers, gpu, request, error);
    return buffers->is_built;
}

static bool is_worn(struct tl_tree_buffers *buffers, const struct tl_tree_request *request)
{
    if (++buffers->since_check < CHECK_EVERY)
        return false;
    buffers->since_check = 0;
    return tl_tree_cost(&buffers->tree, request->positions, request->corners) > WORN * buffers->built_cost;
}

static void refit(const struct tl_tree_buffers *buffers, const struct tl_tree_request *request)
{
    const struct tl_tree *tree = &buffers->tree;
    const tl_buffer *const bound[] = {request->position_buffer, request->corner_buffer, &buffers->children,
                                      &buffers->heads,          &buffers->order,        &buffers->boxes,
                                      &buffers->nodes,          &buffers->triangles};
    glUseProgram(buffers->refit.id);
    for (unsigned i = 0; i < TL_COUNT(bound); i++)
        tl_buffer_bind(bound[i], i);
    for (int level = tree->level_count - 1; level >= 0; level--) {
        const uint32_t first = tree->level_first[level], count = tree->level_first[level + 1] - first;
        glUniform2ui(0, first, count);
        tl_gpu_dispatch(tl_gpu_groups(count, GROUP_NODES), 1, 1);
        tl_gpu_barrier();
    }
}

bool tl_tree_buffers_update(struct tl_tree_buffers *buffers, tl_gpu *gpu,
                            const struct tl_tree_request *request, tl_error *error)
{
    if (!buffers->refit.id &&
        !tl_program_create_compute(gpu, tl_embedded_shaders, "refit.comp", NULL, &buffers->refit, error))
        return false;
    const bool is_other = !buffers->is_built || buffers->topology_revision != request->topology_revision ||
                          buffers->tree.triangle_count != request->triangle_count;
    if ((is_other || is_worn(buffers, request)) && !build(buffers, gpu, request, error))
        return false;
    refit(buffers, request);
    return true;
}

void tl_tree_buffers_bind(const struct tl_tree_buffers *buffers, unsigned binding)
{
    tl_buffer_bind(&buffers->nodes, binding);
    tl_buffer_bind(&buffers->triangles, binding + 1);
}

bool tl_tree_buffers_reload(struct tl_tree_buffers *buffers, tl_error *error)
{
    return !buffers->refit.id || tl_program_reload(&buffers->refit, error);
}

void tl_tree_buffers_release(struct tl_tree_buffers *buffers)
{
    tl_buffer_destroy(&buffers->nodes);
    tl_buffer_destroy(&buffers->triangles);
    tl_buffer_destroy(&buffers->boxes);
    tl_buffer_destroy(&buffers->children);
    tl_buffer_destroy(&buffers->heads);
    tl_buffer_destroy(&buffers->order);
    tl_program_destroy(&buffers->refit);
    tl_tree_release(&buffers->tree);
    *buffers = (struct tl_tree_buffers){0};
}

static size_t tree_bytes(const struct tl_tree *tree)
{
    return tree->node_count * (sizeof *tree->children + sizeof *tree->heads) +
           tree->triangle_count * sizeof *tree->order;
}

size_t tl_tree_buffers_bytes(const struct tl_tree_buffers *buffers)
{
    return buffers->nodes.bytes + buffers->triangles.bytes + buffers->boxes.bytes + buffers->children.bytes +
           buffers->heads.bytes + buffers->order.bytes + tree_bytes(&buffers->tree);
}
