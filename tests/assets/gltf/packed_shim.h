/* Draco's encoder for tests. */
#ifndef TOILE_TESTS_PACKED_SHIM_H
#define TOILE_TESTS_PACKED_SHIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct draco_source {
    size_t vertex_count, index_count;
    const uint32_t *indices;
    const float *positions, *normals, *uvs, *weights; /* weights and joints may be NULL */
    const uint16_t *joints;
    const float *hundreds; /* [vertex_count][100], or NULL */
};

/* Encodes positions (14 bits), normals (10), UVs (12), weights (12) and joints, which get the ids 0 to 4.
 * Returns malloc'ed bytes, or NULL. `sequential`: keeps the order of vertices. */
uint8_t *draco_encode(const struct draco_source *source, bool sequential, size_t *size);

#endif
