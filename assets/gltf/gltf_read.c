#include "assets/gltf/gltf_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool gltf_buffer_bytes(const gltf_document *document, int buffer, size_t offset, size_t size,
                       const char *what, const uint8_t **bytes, tl_error *error)
{
    if (buffer < 0 || (size_t)buffer >= document->buffer_count)
        return tl_fail(error, TL_INPUT, "%s: %s: buffer %d does not exist: export the file again",
                       document->path, what, buffer);
    const struct gltf_buffer *from = &document->buffers[buffer];
    if (offset > from->size || size > from->size - offset)
        return tl_fail(error, TL_INPUT,
                       "%s: %s: wants %zu bytes from byte %zu of a buffer of %zu: the file is cut short or "
                       "damaged, export it again",
                       document->path, what, size, offset, from->size);
    *bytes = from->data + offset;
    return true;
}

bool gltf_view_bytes(const gltf_document *document, int view, const char *what, const uint8_t **bytes,
                     size_t *size, tl_error *error)
{
    if (view < 0 || (size_t)view >= document->view_count)
        return tl_fail(error, TL_INPUT, "%s: %s: buffer view %d does not exist: export the file again",
                       document->path, what, view);
    const struct gltf_view *from = &document->views[view];
    *size = from->size;
    return gltf_buffer_bytes(document, from->buffer, from->offset, from->size, what, bytes, error);
}

static size_t component_size(int type)
{
    switch (type) {
    case 5120: /* byte */
    case 5121: /* unsigned byte */
        return 1;
    case 5122: /* short */
    case 5123: /* unsigned short */
        return 2;
    case 5125: /* unsigned int */
    case 5126: /* float */
        return 4;
    default:
        return 0;
    }
}

/* The elements of an accessor in memory, `stride` bytes apart; `data` NULL: all elements are zero. */
struct elements {
    const uint8_t *data;
    size_t stride;
};

/* Finds `count` elements of `size` bytes in a view, the first at `offset`. */
static bool find_elements(const gltf_document *document, int view, size_t offset, size_t count, size_t size,
                          const char *what, struct elements *out, tl_error *error)
{
    const uint8_t *bytes = NULL;
    size_t available = 0;
    if (!gltf_view_bytes(document, view, what, &bytes, &available, error))
        return false;
    size_t stride = document->views[view].stride ? document->views[view].stride : size;
    /* Counts are below 2^26 and strides below 2^8 here, so only the file's offset could overflow. */
    size_t needed = (count - 1) * stride + size;
    if (stride < size || offset > available || needed > available - offset)
        return tl_fail(
            error, TL_INPUT,
            "%s: %s: %zu elements of %zu bytes do not fit into buffer view %d of %zu bytes: the file is "
            "damaged, export it again",
            document->path, what, count, size, view, available);
    *out = (struct elements){bytes + offset, stride};
    return true;
}

/* An accessor without a view is all zeros: a few bytes of file could request any amount of memory, hence
 * `limit`.
 */
#define LIMIT_ZEROS ((size_t)1 << 20)

static bool check_accessor(const gltf_document *document, int index, const char *what, int components,
                           size_t limit, tl_error *error)
{
    const char *path = document->path;
    if (index < 0 || (size_t)index >= document->accessor_count)
        return tl_fail(error, TL_INPUT, "%s: %s: accessor %d does not exist: export the file again", path,
                       what, index);
    const struct gltf_accessor *accessor = &document->accessors[index];
    if (accessor->components != components || component_size(accessor->component_type) == 0)
        return tl_fail(
            error, TL_INPUT,
            "%s: %s: accessor %d holds %d numbers of type %d an element where %d are expected: export "
            "the file again",
            path, what, index, accessor->components, accessor->component_type, components);
    size_t maximum = accessor->view < 0 && limit > LIMIT_ZEROS ? LIMIT_ZEROS : limit;
    if (accessor->count == 0 || accessor->count > maximum || accessor->sparse_count > accessor->count)
        return tl_fail(error, TL_INPUT, "%s: %s: accessor %d has %zu elements: between 1 and %zu can be read",
                       path, what, index, accessor->count, maximum);
    return true;
}

static uint32_t integer_at(const uint8_t *bytes, int type)
{
    switch (component_size(type)) {
    case 1:
        return bytes[0];
    case 2:
        return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
    default:
        return gltf_little_endian(bytes);
    }
}

/* glTF 2.0, 3.11 "animations" and KHR_mesh_quantization: the decoding of normalised integers. */
static float float_at(const uint8_t *bytes, int type, bool normalized)
{
    uint32_t bits = integer_at(bytes, type);
    float value;
    switch (type) {
    case 5120:
        return normalized ? fmaxf((float)(int8_t)bits / 127, -1) : (float)(int8_t)bits;
    case 5121:
        return normalized ? (float)bits / 255 : (float)bits;
    case 5122:
        return normalized ? fmaxf((float)(int16_t)bits / 32767, -1) : (float)(int16_t)bits;
    case 5123:
        return normalized ? (float)bits / 65535 : (float)bits;
    case 5125:
        return (float)bits;
    default:
        memcpy(&value, &bits, sizeof value);
        return value;
    }
}

/* An accessor whose bytes are all there. */
struct gltf_source {
    const struct gltf_accessor *accessor;
    struct elements elements, sparse_indices, sparse_values;
};

static bool find_sparse(const gltf_document *document, const struct gltf_accessor *accessor,
                        size_t element_size, const char *what, struct elements *indices,
                        struct elements *values, tl_error *error)
{
    size_t index_size = component_size(accessor->sparse_index_type);
    if (index_size == 0)
        return tl_fail(error, TL_INPUT, "%s: %s: sparse indices of unknown type: export the file again",
                       document->path, what);
    return find_elements(document, accessor->sparse_index_view, accessor->sparse_index_offset,
                         accessor->sparse_count, index_size, what, indices, error) &&
           find_elements(document, accessor->sparse_value_view, accessor->sparse_value_offset,
                         accessor->sparse_count, element_size, what, values, error);
}

static bool find_source(const gltf_document *document, int index, const char *what, int components,
                        size_t limit, struct gltf_source *out, tl_error *error)
{
    if (!check_accessor(document, index, what, components, limit, error))
        return false;
    const struct gltf_accessor *accessor = &document->accessors[index];
    size_t size = component_size(accessor->component_type) * (size_t)components;
    *out = (struct gltf_source){.accessor = accessor};
    if (accessor->view >= 0 && !find_elements(document, accessor->view, accessor->offset, accessor->count,
                                              size, what, &out->elements, error))
        return false;
    return accessor->sparse_count == 0 ||
           find_sparse(document, accessor, size, what, &out->sparse_indices, &out->sparse_values, error);
}

/* Exactly one of `floats` and `integers` is given: it receives the components, element by element. */
struct sink {
    float *floats;
    uint32_t *integers;
};

static void store_element(const struct gltf_accessor *accessor, const uint8_t *bytes, size_t element,
                          struct sink sink)
{
    size_t size = component_size(accessor->component_type);
    for (size_t c = 0; c < (size_t)accessor->components; c++) {
        size_t at = element * (size_t)accessor->components + c;
        if (sink.floats)
            sink.floats[at] = float_at(bytes + c * size, accessor->component_type, accessor->normalized);
        else
            sink.integers[at] = integer_at(bytes + c * size, accessor->component_type);
    }
}

static bool read_source(const gltf_document *document, const struct gltf_source *source, const char *what,
                        struct sink sink, tl_error *error)
{
    const struct gltf_accessor *accessor = source->accessor;
    for (size_t i = 0; source->elements.data && i < accessor->count; i++)
        store_element(accessor, source->elements.data + i * source->elements.stride, i, sink);
    for (size_t i = 0; i < accessor->sparse_count; i++) {
        uint32_t element = integer_at(source->sparse_indices.data + i * source->sparse_indices.stride,
                                      accessor->sparse_index_type);
        if (element >= accessor->count)
            return tl_fail(error, TL_INPUT, "%s: %s: sparse index %u of %zu elements: export the file again",
                           document->path, what, element, accessor->count);
        store_element(accessor, source->sparse_values.data + i * source->sparse_values.stride, element, sink);
    }
    return true;
}

static bool check_finite(const gltf_document *document, const char *what, const float *values, size_t count,
                         int components, tl_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return tl_fail(error, TL_INPUT,
                           "%s: %s: element %zu is not a finite number: export the file again",
                           document->path, what, i / (size_t)components);
    return true;
}

bool gltf_read_floats(const gltf_document *document, int accessor, const char *what, int components,
                      size_t limit, bool any_value, float **out, size_t *count, tl_error *error)
{
    *out = NULL;
    *count = 0;
    struct gltf_source source;
    if (!find_source(document, accessor, what, components, limit, &source, error))
        return false;
    size_t elements = source.accessor->count, values = elements * (size_t)components;
    float *floats = TL_NEW_ARRAY(float, values);
    if (!read_source(document, &source, what, (struct sink){.floats = floats}, error) ||
        (!any_value && !check_finite(document, what, floats, values, components, error))) {
        free(floats);
        return false;
    }
    *out = floats;
    *count = elements;
    return true;
}

bool gltf_read_integers(const gltf_document *document, int accessor, const char *what, int components,
                        size_t limit, uint32_t **out, size_t *count, tl_error *error)
{
    *out = NULL;
    *count = 0;
    struct gltf_source source;
    if (!find_source(document, accessor, what, components, limit, &source, error))
        return false;
    int type = source.accessor->component_type;
    if (type != 5121 && type != 5123 && type != 5125)
        return tl_fail(error, TL_INPUT,
                       "%s: %s: accessor %d does not hold unsigned integers: export the file again",
                       document->path, what, accessor);
    size_t elements = source.accessor->count;
    uint32_t *integers = TL_NEW_ARRAY(uint32_t, elements * (size_t)components);
    if (!read_source(document, &source, what, (struct sink){.integers = integers}, error)) {
        free(integers);
        return false;
    }
    *out = integers;
    *count = elements;
    return true;
}
