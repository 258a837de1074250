/* Triangle meshes as the renderer draws them. Metres, right-handed, +Y up. Immutable once made.
 *
 * Render vertices are split where normals or UVs differ. UVs follow glTF: u to the right, v
 * down from the top row of the image. A pattern in metres has u along the weft and v along minus the warp. */
#ifndef TOILE_ASSETS_BASE_MESH_H
#define TOILE_ASSETS_BASE_MESH_H

#include <cglm/struct.h>

#include <stddef.h>
#include <stdint.h>

#define TL_LIMIT_MESH_VERTICES ((size_t)1 << 24)
#define TL_LIMIT_MESH_INDICES  ((size_t)3 << 24)

struct tl_mesh_part {
    uint32_t first_index, index_count;
    int material;    /* index into the owner's materials */
    float uv_metres; /* metres per UV unit: root of the ratio of summed areas in space and in UV; 1 for a
                        pattern in metres, 0 where UVs are missing or degenerate */
};

typedef struct tl_mesh {
    size_t vertex_count;
    vec3s *positions; /* metres */
    vec3s *normals;   /* unit */
    vec2s *uvs;       /* zero when the file has none */
    vec4s *tangents;  /* unit xyz, handedness w, or NULL: computed by cloth/tangents */
    size_t index_count;
    uint32_t *indices; /* triangles, counter-clockwise seen from outside */
    size_t part_count;
    struct tl_mesh_part *parts;
} tl_mesh;

void tl_mesh_release(tl_mesh *mesh); /* frees and zeroes */

/* Fills every part's uv_metres from positions and uvs. */
void tl_mesh_measure_uvs(tl_mesh *mesh);

struct tl_box {
    vec3s lower, upper;
};
/* The smallest box around the positions; zero for count 0. */
struct tl_box tl_box_of(const vec3s *positions, size_t count);
/* The smallest box about two. */
struct tl_box tl_box_of_both(struct tl_box a, struct tl_box b);

#endif
