#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

void gltf_vertices_release(struct gltf_vertices *vertices)
{
    free(vertices->positions);
    free(vertices->normals);
    free(vertices->uvs);
    free(vertices->weights);
    free(vertices->colours);
    free(vertices->pins);
    free(vertices->joints);
    free(vertices->indices);
}

static bool read_attribute(const gltf_document *document, const struct gltf_primitive *from,
                           enum gltf_attribute attribute, const char *what, int components,
                           size_t vertex_count, float **out, tl_error *error)
{
    size_t count;
    if (from->attributes[attribute] < 0)
        return true;
    /* Only positions must be finite: exporters write NaN normals and UVs for degenerate triangles. */
    if (!gltf_read_floats(document, from->attributes[attribute], what, components, TL_LIMIT_MESH_VERTICES,
                          true, out, &count, error))
        return false;
    if (count != vertex_count)
        return tl_fail(error, TL_INPUT, "%s: %s: %zu for %zu vertices: export the file again", document->path,
                       what, count, vertex_count);
    for (size_t i = 0; i < count * (size_t)components; i++)
        if (!isfinite((*out)[i]))
            (*out)[i] = 0;
    return true;
}

static bool read_joints(const gltf_document *document, const struct gltf_primitive *from, size_t joint_count,
                        struct gltf_vertices *to, tl_error *error)
{
    size_t count;
    if (!gltf_read_integers(document, from->attributes[GLTF_JOINTS], "joints", 4, TL_LIMIT_MESH_VERTICES,
                            &to->joints, &count, error) ||
        !read_attribute(document, from, GLTF_WEIGHTS, "joint weights", 4, to->vertex_count, &to->weights,
                        error))
        return false;
    if (count != to->vertex_count || !to->weights)
        return tl_fail(error, TL_INPUT, "%s: a skinned mesh lacks joints or weights: export the file again",
                       document->path);
    for (size_t i = 0; i < 4 * count; i++)
        if (to->weights[i] > 0 && to->joints[i] >= joint_count)
            return tl_fail(error, TL_INPUT, "%s: vertex %zu hangs on joint %u of %zu: export the file again",
                           document->path, i / 4, to->joints[i], joint_count);
    return true;
}

/* Strips and fans become triangles [glTF 2.0, 3.7.2.1]. */
static void expand(int mode, struct gltf_vertices *primitive)
{
    if (mode == GLTF_MODE_TRIANGLES) {
        primitive->index_count -= primitive->index_count % 3;
        return;
    }
    size_t triangles = primitive->index_count < 3 ? 0 : primitive->index_count - 2;
    uint32_t *list = TL_NEW_ARRAY(uint32_t, 3 * triangles);
    for (size_t i = 0; i < triangles; i++) {
        const uint32_t *from = primitive->indices;
        list[3 * i] = mode == GLTF_MODE_STRIP ? from[i] : from[i + 1];
        list[3 * i + 1] = mode == GLTF_MODE_STRIP ? from[i + 1 + i % 2] : from[i + 2];
        list[3 * i + 2] = mode == GLTF_MODE_STRIP ? from[i + 2 - i % 2] : from[0];
    }
    free(primitive->indices);
    primitive->indices = list;
    primitive->index_count = 3 * triangles;
}

bool gltf_primitive_read_indices(const gltf_document *document, const struct gltf_primitive *from,
                                 struct gltf_vertices *to, tl_error *error)
{
    if (from->indices < 0) {
        to->index_count = to->vertex_count;
        to->indices = TL_NEW_ARRAY(uint32_t, to->index_count);
        for (size_t i = 0; i < to->index_count; i++)
            to->indices[i] = (uint32_t)i;
    } else if (!gltf_read_integers(document, from->indices, "indices", 1, TL_LIMIT_MESH_INDICES, &to->indices,
                                   &to->index_count, error)) {
        return false;
    }
    for (size_t i = 0; i < to->index_count; i++)
        if (to->indices[i] >= to->vertex_count)
            return tl_fail(error, TL_INPUT,
                           "%s: index %zu names vertex %u of %zu: out of range, export the file again",
                           document->path, i, to->indices[i], to->vertex_count);
    expand(from->mode, to);
    return true;
}

/* With or without alpha. */
static bool read_colours(const gltf_document *document, const struct gltf_primitive *from,
                         struct gltf_vertices *to, tl_error *error)
{
    int accessor = from->attributes[GLTF_COLOUR];
    bool known = accessor >= 0 && (size_t)accessor < document->accessor_count;
    to->colour_components = known && document->accessors[accessor].components == 4 ? 4 : 3;
    return read_attribute(document, from, GLTF_COLOUR, "vertex colours", to->colour_components,
                          to->vertex_count, &to->colours, error);
}

bool gltf_primitive_read_vertices(const gltf_document *document, const struct gltf_primitive *from,
                                  size_t joint_count, struct gltf_vertices *to, tl_error *error)
{
    if (!gltf_read_floats(document, from->attributes[GLTF_POSITION], "positions", 3, TL_LIMIT_MESH_VERTICES,
                          false, &to->positions, &to->vertex_count, error) ||
        !read_attribute(document, from, GLTF_NORMAL, "normals", 3, to->vertex_count, &to->normals, error) ||
        !read_attribute(document, from, GLTF_UV, "texture coordinates", 2, to->vertex_count, &to->uvs,
                        error) ||
        !read_colours(document, from, to, error) ||
        !read_attribute(document, from, GLTF_PIN, "_PIN", 1, to->vertex_count, &to->pins, error))
        return false;
    return joint_count == 0 || from->attributes[GLTF_JOINTS] < 0 ||
           read_joints(document, from, joint_count, to, error);
}
