/* One Draco stream as plain arrays (draco_shim.cpp). */
#ifndef TOILE_ASSETS_GLTF_DRACO_INTERNAL_H
#define TOILE_ASSETS_GLTF_DRACO_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct draco_attribute {
    int id;                         /* in the stream: what the caller asks for; -1: nothing */
    int component_type, components; /* GL's type, 1 to 4 */
    uint8_t *values;                /* [point_count][components], tightly packed */
};

struct draco_mesh {
    size_t point_count, index_count;
    uint32_t *indices;
};

/* Decodes a mesh of glTF's bitstream (version 2.2) with the attributes that `attributes` [attribute_count]
 * asks for; free() releases `indices` and each `values`. The stream's own counts are compared with its size
 * and with what a mesh may have before memory is asked for. NULL, or what is wrong with the stream; then
 * nothing is to be released. Threads: any. */
const char *draco_decode(const uint8_t *bytes, size_t size, struct draco_attribute *attributes,
                         size_t attribute_count, struct draco_mesh *out);

#endif
