/* Wavefront OBJ and MTL files: read, as a model, and written.
 *
 * tinyobjloader (2.0rc10) was tried and is not used: it reads `v 1 abc 2` for (1, 0, 2), a
 * missing coordinate for 0, 1e400 for infinity and the index 4294967299 for 3, and only warns of indices out
 * of range. A garment that is silently wrong is worse than one that is refused.
 * Threads: any. */
#ifndef TOILE_ASSETS_OBJ_WAVEFRONT_H
#define TOILE_ASSETS_OBJ_WAVEFRONT_H

#include "assets/base/model.h"
#include "assets/base/surface.h"
#include "config/base/error.h"

#include <stdio.h>

#define WAVE_NONE UINT32_MAX

struct wave_corner {
    uint32_t position, uv, normal; /* uv, normal: WAVE_NONE when the file gives none */
};

struct wave_face {
    uint32_t corner_end; /* one past its last corner */
    uint32_t group;      /* rises with each group or object of the file */
    uint32_t material;   /* index into `materials` */
};

struct wave_object {
    size_t position_count, uv_count, normal_count, corner_count, face_count, triangle_count, material_count,
        library_count;
    vec3s *positions; /* units of the file */
    vec2s *uvs;       /* v runs up */
    vec3s *normals;   /* not yet unit */
    struct wave_corner *corners;
    struct wave_face *faces;
    size_t stitch_count;
    struct tl_stitch *stitches;
    char **materials; /* names; the first is "", of faces without one */
    char **libraries; /* names of MTL files, as given */
    size_t ignored_count;
    char **ignored; /* keywords without effect, each once */
};

/* Reads and checks a whole file: every number is finite, every index in range. wave_release frees *out. */
bool wave_read(const char *path, struct wave_object *out, tl_error *error);
void wave_release(struct wave_object *object);

/* Reads an OBJ file and its MTL files into a model of which only the name is set. On failure the caller
 * releases it. */
bool wave_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error);

/* Writes a surface of `model` as OBJ; numbers in the C locale. The stream remembers a failure to
 * write. */
void wave_write(FILE *stream, const tl_model *model, const tl_surface *surface);

#endif
