/* Compressed streams become buffers, views and accessors of an uncompressed document. */
#include "assets/base/mesh.h"
#include "assets/gltf/draco_internal.h"
#include "assets/gltf/gltf_internal.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>
#include <meshoptimizer.h>

#include <stdlib.h>
#include <string.h>

/* The document's arrays with what was decompressed at their ends. */
struct gltf_unpacked {
    struct gltf_buffer *buffers;
    struct gltf_view *views;
    struct gltf_accessor *accessors;
    struct gltf_primitive *primitives;
    uint8_t **blobs; /* the decompressed bytes */
    size_t blob_count;
    size_t byte_count; /* of all blobs */
};

void gltf_unpack_release(gltf_document *document)
{
    struct gltf_unpacked *unpacked = document->unpacked;
    if (!unpacked)
        return;
    for (size_t i = 0; i < unpacked->blob_count; i++)
        free(unpacked->blobs[i]);
    free((void *)unpacked->blobs);
    free(unpacked->buffers);
    free(unpacked->views);
    free(unpacked->accessors);
    free(unpacked->primitives);
    free(unpacked);
    document->unpacked = NULL;
}

/* ---- Content that tinygltf would refuse ---- */

static bool has_extension(const cJSON *object, const char *name)
{
    return cJSON_HasObjectItem(cJSON_GetObjectItemCaseSensitive(object, "extensions"), name);
}

/* Fallback buffers [EXT_meshopt_compression] are room for decompressed bytes: tinygltf would look for them in
 * the file. Each becomes a buffer of one byte. */
static void drop_fallbacks(const cJSON *buffers)
{
    for (cJSON *buffer = buffers ? buffers->child : NULL; buffer; buffer = buffer->next) {
        if (cJSON_HasObjectItem(buffer, "uri") || (!has_extension(buffer, "EXT_meshopt_compression") &&
                                                   !has_extension(buffer, "KHR_meshopt_compression")))
            continue;
        cJSON_DeleteItemFromObjectCaseSensitive(buffer, "byteLength");
        cJSON_AddNumberToObject(buffer, "byteLength", 1);
        cJSON_AddStringToObject(buffer, "uri", "data:application/octet-stream;base64,AA==");
    }
}

/* The accessor of compressed indices has no view. tinygltf asks for one. */
static void drop_indices(const cJSON *meshes)
{
    for (const cJSON *mesh = meshes ? meshes->child : NULL; mesh; mesh = mesh->next) {
        const cJSON *primitives = cJSON_GetObjectItemCaseSensitive(mesh, "primitives");
        for (cJSON *primitive = primitives ? primitives->child : NULL; primitive; primitive = primitive->next)
            if (has_extension(primitive, "KHR_draco_mesh_compression"))
                cJSON_DeleteItemFromObjectCaseSensitive(primitive, "indices");
    }
}

char *gltf_prepare_json(const char *json, size_t size)
{
    static const char meshopt[] = "_meshopt_compression", draco[] = "KHR_draco_mesh_compression";
    if (!memmem(json, size, meshopt, strlen(meshopt)) && !memmem(json, size, draco, strlen(draco)))
        return NULL;
    cJSON *document = cJSON_ParseWithLength(json, size);
    drop_fallbacks(cJSON_GetObjectItemCaseSensitive(document, "buffers"));
    drop_indices(cJSON_GetObjectItemCaseSensitive(document, "meshes"));
    char *prepared = cJSON_PrintUnformatted(document);
    cJSON_Delete(document);
    return prepared;
}

/* ---- Room ---- */

static void begin(gltf_document *document, size_t packed_views, size_t draco_primitives)
{
    struct gltf_unpacked *unpacked = document->unpacked = TL_NEW(struct gltf_unpacked);
    size_t added = draco_primitives * (GLTF_ATTRIBUTE_COUNT + 1);
    unpacked->buffers = TL_NEW_ARRAY(struct gltf_buffer, document->buffer_count + packed_views + added);
    unpacked->views = TL_NEW_ARRAY(struct gltf_view, document->view_count + added);
    unpacked->accessors = TL_NEW_ARRAY(struct gltf_accessor, document->accessor_count + added);
    unpacked->primitives = TL_NEW_ARRAY(struct gltf_primitive, document->primitive_count);
    unpacked->blobs = (uint8_t **)tl_alloc(packed_views + added, sizeof *unpacked->blobs);
    for (size_t i = 0; i < document->buffer_count; i++)
        unpacked->buffers[i] = document->buffers[i];
    for (size_t i = 0; i < document->view_count; i++)
        unpacked->views[i] = document->views[i];
    for (size_t i = 0; i < document->accessor_count; i++)
        unpacked->accessors[i] = document->accessors[i];
    for (size_t i = 0; i < document->primitive_count; i++)
        unpacked->primitives[i] = document->primitives[i];
    document->buffers = unpacked->buffers;
    document->views = unpacked->views;
    document->accessors = unpacked->accessors;
    document->primitives = unpacked->primitives;
}

/* Whether `bytes` more may be decompressed. */
static bool has_room(const gltf_document *document, size_t bytes, tl_error *error)
{
    return tl_memory_request_for_file(document->path, document->file_bytes,
                                      document->unpacked->byte_count + bytes, error);
}

/* Adds bytes, which the document owns from now on, as a buffer; its index. */
static int add_buffer(gltf_document *document, uint8_t *bytes, size_t size)
{
    struct gltf_unpacked *unpacked = document->unpacked;
    unpacked->blobs[unpacked->blob_count++] = bytes;
    unpacked->byte_count += size;
    unpacked->buffers[document->buffer_count] = (struct gltf_buffer){bytes, size};
    return (int)document->buffer_count++;
}

/* ---- meshoptimizer ---- */

/* The rules of EXT_meshopt_compression; its decoders assert them. */
static const char *problem_of(const struct gltf_meshopt *from)
{
    bool indices = from->mode == GLTF_MESHOPT_TRIANGLES || from->mode == GLTF_MESHOPT_INDICES;
    if (from->mode == GLTF_MESHOPT_OTHER_MODE || from->filter == GLTF_FILTER_OTHER)
        return "has a mode or filter that is not known";
    if (from->count == 0 || from->count > TL_LIMIT_MESH_INDICES)
        return "has no elements or too many";
    if (indices ? from->stride != 2 && from->stride != 4
                : from->stride == 0 || from->stride > 256 || from->stride % 4 != 0)
        return "has elements of a size that is not allowed";
    if (from->mode == GLTF_MESHOPT_TRIANGLES && from->count % 3 != 0)
        return "does not hold whole triangles";
    if ((indices && from->filter != GLTF_FILTER_NONE) ||
        (from->filter == GLTF_FILTER_OCTAHEDRAL && from->stride != 4 && from->stride != 8) ||
        (from->filter == GLTF_FILTER_QUATERNION && from->stride != 8))
        return "has a filter that does not fit its elements";
    return NULL;
}

static bool decode_meshopt(const struct gltf_meshopt *from, const uint8_t *bytes, uint8_t *out)
{
    switch (from->mode) {
    case GLTF_MESHOPT_TRIANGLES:
        return meshopt_decodeIndexBuffer(out, from->count, from->stride, bytes, from->size) == 0;
    case GLTF_MESHOPT_INDICES:
        return meshopt_decodeIndexSequence(out, from->count, from->stride, bytes, from->size) == 0;
    default:
        break;
    }
    if (meshopt_decodeVertexBuffer(out, from->count, from->stride, bytes, from->size) != 0)
        return false;
    if (from->filter == GLTF_FILTER_OCTAHEDRAL)
        meshopt_decodeFilterOct(out, from->count, from->stride);
    else if (from->filter == GLTF_FILTER_QUATERNION)
        meshopt_decodeFilterQuat(out, from->count, from->stride);
    else if (from->filter == GLTF_FILTER_EXPONENTIAL)
        meshopt_decodeFilterExp(out, from->count, from->stride);
    return true;
}

static bool unpack_view(gltf_document *document, size_t index, tl_error *error)
{
    struct gltf_view *view = &document->unpacked->views[index];
    const struct gltf_meshopt *from = &view->meshopt;
    const char *problem = problem_of(from);
    if (problem)
        return tl_fail(error, TL_INPUT, "%s: the compressed buffer view %zu %s: export the file again",
                       document->path, index, problem);
    const uint8_t *bytes = NULL;
    if (!gltf_buffer_bytes(document, from->buffer, from->offset, from->size, "compressed buffer view", &bytes,
                           error) ||
        !has_room(document, from->count * from->stride, error))
        return false;
    uint8_t *out = tl_alloc(from->count, from->stride);
    bool decoded = decode_meshopt(from, bytes, out);
    view->buffer = add_buffer(document, out, from->count * from->stride);
    view->offset = 0;
    view->size = from->count * from->stride;
    return decoded || tl_fail(error, TL_INPUT,
                              "%s: the compressed buffer view %zu is damaged, or newer than the installed "
                              "meshoptimizer: export the file again, or without compression",
                              document->path, index);
}

/* ---- Draco ---- */

/* Adds an accessor of decoded values, normalised as the file's own accessor is; its index. */
static int add_accessor(gltf_document *document, uint8_t *bytes, size_t count, int component_type,
                        int components, int original)
{
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4}; /* from 5120 */
    struct gltf_unpacked *unpacked = document->unpacked;
    size_t size = count * sizes[component_type - 5120] * (size_t)components;
    bool known = original >= 0 && (size_t)original < document->accessor_count;
    unpacked->views[document->view_count] =
        (struct gltf_view){.buffer = add_buffer(document, bytes, size), .size = size};
    unpacked->accessors[document->accessor_count] =
        (struct gltf_accessor){.view = (int)document->view_count++,
                               .count = count,
                               .component_type = component_type,
                               .components = components,
                               .normalized = known && document->accessors[original].normalized};
    return (int)document->accessor_count++;
}

static bool unpack_primitive(gltf_document *document, struct gltf_primitive *primitive, tl_error *error)
{
    const uint8_t *bytes = NULL;
    size_t size = 0;
    struct draco_attribute attributes[GLTF_ATTRIBUTE_COUNT];
    struct draco_mesh mesh;
    if (!gltf_view_bytes(document, primitive->draco.view, "Draco stream", &bytes, &size, error))
        return false;
    for (int i = 0; i < GLTF_ATTRIBUTE_COUNT; i++)
        attributes[i] = (struct draco_attribute){.id = primitive->draco.ids[i]};
    const char *problem = draco_decode(bytes, size, attributes, GLTF_ATTRIBUTE_COUNT, &mesh);
    if (problem)
        return tl_fail(error, TL_INPUT,
                       "%s: the Draco stream in buffer view %d %s: the file is damaged, export "
                       "it again or without compression",
                       document->path, primitive->draco.view, problem);
    primitive->indices =
        add_accessor(document, (uint8_t *)mesh.indices, mesh.index_count, 5125, 1, primitive->indices);
    for (int i = 0; i < GLTF_ATTRIBUTE_COUNT; i++)
        if (attributes[i].values)
            primitive->attributes[i] =
                add_accessor(document, attributes[i].values, mesh.point_count, attributes[i].component_type,
                             attributes[i].components, primitive->attributes[i]);
    return has_room(document, 0, error); /* one stream is limited by draco_decode, many are by this */
}

bool gltf_unpack(gltf_document *document, tl_error *error)
{
    size_t views = 0, primitives = 0, first_views = document->view_count;
    for (size_t i = 0; i < document->view_count; i++)
        views += document->views[i].meshopt.mode != GLTF_MESHOPT_NONE;
    for (size_t i = 0; i < document->primitive_count; i++)
        primitives += document->primitives[i].draco.view >= 0;
    if (views + primitives == 0)
        return true;
    begin(document, views, primitives);
    for (size_t i = 0; i < first_views; i++)
        if (document->views[i].meshopt.mode != GLTF_MESHOPT_NONE && !unpack_view(document, i, error))
            return false;
    for (size_t i = 0; i < document->primitive_count; i++)
        if (document->primitives[i].draco.view >= 0 &&
            !unpack_primitive(document, &document->unpacked->primitives[i], error))
            return false;
    return true;
}
