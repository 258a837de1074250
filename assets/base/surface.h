/* The interface between the floors that move meshes (cloth, animated avatars) and the renderer: a view of one
 * frame's geometry. Lifetime: it owns nothing; its arrays must outlive the frame. */
#ifndef TOILE_ASSETS_BASE_SURFACE_H
#define TOILE_ASSETS_BASE_SURFACE_H

#include "assets/base/material.h"
#include "assets/base/mesh.h"

/* The name of the surface that is judged: errors of a picture in motion are those of its pixels. */
#define TL_SURFACE_GARMENT "garment"

struct tl_borders;

/* The places of light on a surface that is drawn finer than light varies: at some of its vertices, from
 * which the others take means. Vertices of one place need not be one vertex. It owns its arrays:
 * tl_light_mesh_release. */
struct tl_light_mesh {
    uint32_t (*from)[3]; /* [vertex_count]; of a vertex with light of its own, three times that vertex */
    float (*shares)[3];  /* [vertex_count] of the three; their sum is 1 */
    uint32_t *corners;   /* [vertex_count] an index that names it, of those with light of their own */
};

typedef struct tl_surface {
    const char *name; /* TL_SURFACE_GARMENT, "avatar", "ground" */
    size_t vertex_count;
    const vec3s *positions; /* metres, world */
    const vec3s *normals;   /* unit; towards the outside */
    bool has_own_normals;   /* they are a file's, or of other positions: no means of the faces */
    const vec4s *tangents;  /* unit xyz, handedness w: bitangent = w * cross(n, t) */
    const vec2s *uvs;
    const vec3s *strains; /* along the warp, along the weft (length over rest length, less 1), shear (cosine
                             of the angle between them); NULL: unknown or not requested */
    const bool *crossed; /* [index_count / 3] triangles that pass through others of the surface; NULL: unknown
                            or not requested */
    size_t index_count;
    const uint32_t *indices;
    size_t part_count;
    const struct tl_mesh_part *parts;
    const tl_material *materials;
    const struct tl_light_mesh *light_mesh; /* NULL: light is computed at all vertices */
    const struct tl_borders
        *borders; /* of its pieces (assets/topology/borders.h); NULL: no construction is drawn */
    uint64_t topology_revision; /* changes when anything but positions, normals and tangents does */
    uint64_t motion_revision;   /* changes when positions do */
} tl_surface;

/* A view of a mesh that does not move: its own parts, no strains, revisions 0. */
tl_surface tl_surface_of_mesh(const char *name, const tl_mesh *mesh, const tl_material *materials);

/* Whether light is computed at a vertex. */
static inline bool tl_has_own_light(const tl_surface *surface, uint32_t vertex)
{
    return !surface->light_mesh || surface->light_mesh->from[vertex][0] == vertex;
}

/* The vertices from which a vertex takes its light: three, or only `vertex` itself, which is returned. */
static inline const uint32_t *tl_light_from(const tl_surface *surface, const uint32_t *vertex)
{
    return tl_has_own_light(surface, *vertex) ? vertex : surface->light_mesh->from[*vertex];
}

/* Numbers the corners of a light mesh whose `from` is filled. */
void tl_light_mesh_number(struct tl_light_mesh *light_mesh, const uint32_t *indices, size_t index_count);
struct tl_light_mesh tl_light_mesh_make(size_t vertex_count); /* empty arrays */
void tl_light_mesh_release(struct tl_light_mesh *light_mesh); /* frees and zeroes */

#endif
