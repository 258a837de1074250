/* Morph targets [glTF 2.0, 3.7.2.2]: offsets of the vertices that a node draws. */
#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define LIMIT_WEIGHTS ((size_t)1 << 20) /* of all nodes */
#define LIMIT_READ                                                                                           \
    ((size_t)1 << 26) /* offsets, zeros among them: a target of zeros takes no bytes of a file */
#define LIMIT_KEPT ((size_t)1 << 25) /* offsets other than zero, 16 bytes each */

static size_t target_count_of(const gltf_document *document, int mesh)
{
    size_t count = 0;
    if (mesh < 0 || (size_t)mesh >= document->mesh_count)
        return 0;
    const struct gltf_mesh *from = &document->meshes[mesh];
    for (size_t i = 0; i < from->primitive_count; i++) {
        size_t own = document->primitives[from->first_primitive + i].target_count;
        count = own > count ? own : count;
    }
    return count;
}

bool rig_read_weights(const gltf_document *document, tl_rig *rig, tl_error *error)
{
    for (size_t i = 0; i < rig->node_count; i++) {
        struct rig_node *node = &rig->nodes[i];
        node->first_weight = rig->weight_count;
        node->weight_count = target_count_of(document, document->nodes[i].mesh);
        if (node->weight_count > LIMIT_WEIGHTS - rig->weight_count)
            return tl_fail(error, TL_INPUT, "%s: has more than %zu weights of morph targets: simplify it",
                           document->path, LIMIT_WEIGHTS);
        rig->weight_count += node->weight_count;
    }
    rig->weights = TL_NEW_ARRAY(float, rig->weight_count);
    for (size_t i = 0; i < rig->node_count; i++) {
        const struct gltf_node *from = &document->nodes[i];
        const struct rig_node *node = &rig->nodes[i];
        if (node->weight_count == 0)
            continue;
        const struct gltf_mesh *mesh = &document->meshes[from->mesh];
        const double *weights = from->weight_count > 0 ? from->weights : mesh->weights;
        size_t count = from->weight_count > 0 ? from->weight_count : mesh->weight_count;
        for (size_t k = 0; k < count && k < node->weight_count; k++)
            rig->weights[node->first_weight + k] = (float)weights[k];
    }
    return true;
}

/* Whether an accessor is zero throughout: without bytes, whatever its count. */
static bool is_zero(const gltf_document *document, int accessor)
{
    return accessor < 0 ||
           ((size_t)accessor < document->accessor_count && document->accessors[accessor].view < 0 &&
            document->accessors[accessor].sparse_count == 0);
}

static bool read_offsets(const gltf_document *document, int accessor, const char *what, size_t vertex_count,
                         struct morph_reading *reading, float **out, tl_error *error)
{
    size_t count;
    *out = NULL;
    if (is_zero(document, accessor))
        return true;
    if (!gltf_read_floats(document, accessor, what, 3, TL_LIMIT_MESH_VERTICES, false, out, &count, error))
        return false;
    reading->read += count;
    if (count != vertex_count)
        return tl_fail(error, TL_INPUT, "%s: %s: %zu for %zu vertices: export the file again", document->path,
                       what, count, vertex_count);
    if (reading->read > LIMIT_READ)
        return tl_fail(error, TL_INPUT, "%s: its morph targets have more than %zu offsets: simplify it",
                       document->path, LIMIT_READ);
    return true;
}

/* Keeps the offsets that move something. */
static bool keep_offsets(const gltf_document *document, const float *offsets, size_t first_vertex,
                         size_t vertex_count, size_t weight, struct morph_reading *reading, tl_rig *rig,
                         tl_error *error)
{
    struct rig_morph morph = {.weight = weight};
    for (size_t i = 0; i < vertex_count; i++)
        morph.offset_count += offsets[3 * i] != 0 || offsets[3 * i + 1] != 0 || offsets[3 * i + 2] != 0;
    if (morph.offset_count == 0)
        return true;
    reading->kept += morph.offset_count;
    if (reading->kept > LIMIT_KEPT)
        return tl_fail(error, TL_INPUT,
                       "%s: its morph targets move vertices more than %zu times: simplify it", document->path,
                       LIMIT_KEPT);
    morph.vertices = TL_NEW_ARRAY(uint32_t, morph.offset_count);
    morph.offsets = TL_NEW_ARRAY(vec3s, morph.offset_count);
    for (size_t i = 0, k = 0; i < vertex_count; i++) {
        if (offsets[3 * i] == 0 && offsets[3 * i + 1] == 0 && offsets[3 * i + 2] == 0)
            continue;
        morph.vertices[k] = (uint32_t)(first_vertex + i);
        memcpy(&morph.offsets[k++], offsets + 3 * i, sizeof *morph.offsets);
    }
    if (rig->morph_count == reading->capacity) {
        reading->capacity = 2 * reading->capacity + 16;
        rig->morphs = tl_resize(rig->morphs, reading->capacity, sizeof *rig->morphs);
    }
    rig->morphs[rig->morph_count++] = morph;
    return true;
}

bool rig_read_morphs(const gltf_document *document, const struct gltf_primitive *from, int node,
                     size_t first_vertex, size_t vertex_count, struct morph_reading *reading, tl_rig *rig,
                     vec3s *normals, tl_error *error)
{
    for (size_t t = 0; t < from->target_count; t++) {
        const struct gltf_target *target = &document->targets[from->first_target + t];
        size_t weight = rig->nodes[node].first_weight + t;
        float *positions = NULL, *turns = NULL, rest = rig->weights[weight];
        bool good = read_offsets(document, target->positions, "positions of a morph target", vertex_count,
                                 reading, &positions, error) &&
                    (!positions || keep_offsets(document, positions, first_vertex, vertex_count, weight,
                                                reading, rig, error)) &&
                    (rest == 0 || read_offsets(document, target->normals, "normals of a morph target",
                                               vertex_count, reading, &turns, error));
        for (size_t i = 0; good && turns && i < vertex_count; i++) {
            const vec3s turn = {{turns[3 * i], turns[3 * i + 1], turns[3 * i + 2]}};
            normals[first_vertex + i] = glms_vec3_muladds(turn, rest, normals[first_vertex + i]);
        }
        free(positions);
        free(turns);
        if (!good)
            return false;
    }
    return true;
}
