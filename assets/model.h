/* A glTF 2.0 scene or a Wavefront OBJ, flattened into one mesh in metres, with its materials, and the
 * skeleton and clips that move it.
 *
 * Loaded of glTF: node hierarchy (also scaled, mirrored: winding is mended), skins, animations (step, linear,
 * cubic spline), KHR_texture_transform, KHR_mesh_quantization, base colour, normal, occlusion,
 * metallic-roughness, alpha mask, double-sided, sparse accessors, triangle strips and fans,
 * KHR_materials_variants; and, as the
 * nearest that a tl_material can say, KHR_materials_anisotropy, _clearcoat, _diffuse_transmission, _ior,
 * _sheen, _specular and _transmission (model_extensions.c): what that changes is told in `approximated`.
 * Loaded of OBJ: polygons, groups, and of its MTL files Kd, Ks, Ns, illum, map_Kd, map_Ks, norm and alpha.
 * Everything else is ignored, and named once in `ignored`. Immutable after load. Threads: tl_model_pose may
 * run on several threads. */
#ifndef TOILE_ASSETS_MODEL_H
#define TOILE_ASSETS_MODEL_H

#include "assets/base/material.h"
#include "assets/base/mesh.h"
#include "assets/base/surface.h"
#include "assets/base/units.h"

typedef struct tl_rig tl_rig; /* nodes, skins, per-vertex weights, clips */

struct tl_clip {
    char name[64];
    double duration_s;
};

struct tl_variant { /* KHR_materials_variants: another choice of materials for the same parts */
    char name[64];
    int *materials; /* [mesh.part_count] */
};

typedef struct tl_model {
    char *name;   /* file name without folders */
    tl_mesh mesh; /* rest pose: node transforms and skins applied, no animation */
    size_t material_count;
    tl_material *materials; /* at least one */
    size_t image_count;
    tl_image *images; /* the maps that materials point to */
    size_t variant_count;
    struct tl_variant *variants; /* no two of one name */
    size_t clip_count;
    struct tl_clip *clips;
    tl_rig *rig; /* NULL when nothing moves */
    struct tl_units_reading units;
    /* What a point cache counts: the vertices of the file, not the render vertices that they were split into.
     */
    size_t point_count;
    uint32_t *points; /* [vertex_count] point of each vertex; NULL: each is its own */
    /* What may say which vertices of cloth are held; NULL: the file has none. A glTF's attribute _PIN (or
     * _pin; such names are free to applications [glTF 2.0, 3.7.2.1]), 0 where a part has none; and COLOR_0,
     * white where a part has none. */
    float *pins;    /* [vertex_count] held above a half */
    vec3s *colours; /* [vertex_count] 0 to 1 */
    size_t ignored_count;
    char **ignored; /* "KHR_materials_iridescence", "morph targets", ...: each once */
    size_t approximated_count;
    char **approximated; /* "KHR_materials_sheen: ...": each once */
} tl_model;

/* .gltf, .glb or .obj, in units as assets/base/units.h has it. Refuses indices out of range, NaN positions,
 * files without triangles, sizes that lie. */
bool tl_model_load(const char *path, tl_model *out, tl_error *error);
/* The same in units that someone tells; AUTO: as above. */
bool tl_model_load_in(const char *path, enum tl_units units, tl_model *out, tl_error *error);
bool tl_model_is_file(const char *path); /* by the extension */

/* Where the points of the file are, in its units, when render vertices are at `positions` (metres); those
 * that no triangle uses are put on the first vertex. points [tl_model_point_count]. */
size_t tl_model_point_count(const tl_model *model);
void tl_model_points(const tl_model *model, const vec3s *positions, vec3s *points);

/* Whether a vertex's colour has more than half of one channel (0 red, 1 green, 2 blue) and less of the
 * others. Of a model with colours. */
bool tl_model_is_painted(const tl_model *model, size_t vertex, int channel);

void tl_model_release(tl_model *model); /* frees and zeroes */

/* Positions of the mesh at `time_s` of clip `clip` (looped), skinned on the CPU; mesh->vertex_count of them.
 * Clip -1, or a model without a rig, gives the rest pose. */
void tl_model_pose(const tl_model *model, int clip, double time_s, vec3s *positions);

/* Index of the clip called `name` (exact); "" gives 0; -1 when there is none. */
int tl_model_find_clip(const tl_model *model, const char *name);

/* The variant called `name` (exact), or NULL. */
const struct tl_variant *tl_model_find_variant(const tl_model *model, const char *name);

/* Writes surfaces as one GLB: positions, normals, tangents, UVs, materials with colours and PNG maps; atomic.
 */
bool tl_model_export_glb(const char *path, const tl_surface *surfaces, size_t surface_count, tl_error *error);

/* Writes a surface of `model` as OBJ: its file's points in its file's units, UVs, normals, groups; atomic. */
bool tl_model_export_obj(const char *path, const tl_model *model, const tl_surface *surface, tl_error *error);

#endif
