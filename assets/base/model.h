/* A model: one mesh in metres with its materials, and the skeleton and clips that move it.
 *
 * Immutable once made. Lifetime: the model owns everything that it points to, until tl_model_release.
 * Threads: all functions only read, except tl_model_release, and may run on several threads at once. */
#ifndef TOILE_ASSETS_BASE_MODEL_H
#define TOILE_ASSETS_BASE_MODEL_H

#include "assets/base/material.h"
#include "assets/base/mesh.h"
#include "assets/base/units.h"

typedef struct tl_rig tl_rig; /* nodes, skins, per-vertex weights, clips */

struct tl_clip {
    char name[64];
    double duration_s;
};

struct tl_material_extension { /* what a material of a glTF file names, and what becomes of it */
    size_t material;
    char name[48];
    const char *shown; /* "exact", "approximated", "ignored" */
};

struct tl_stitch { /* of an OBJ file: a point is sewn to one of an edge (assets/sewing/stitches.h) */
    uint32_t point, edge[2]; /* points of the file */
    float at;                /* share of the edge, from its first end */
};

/* A file that the model's file names and that was not read: a picture, a library of materials. */
struct tl_unread {
    char *file;     /* as it is named, or where it was looked for */
    char *reason;   /* one line */
    bool is_absent; /* not there, or outside the model's folder; else it holds nothing that can be read */
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
    size_t extension_count;
    struct tl_material_extension *extensions; /* by material */
    size_t image_count;
    tl_image *images; /* the maps that materials point to */
    size_t variant_count;
    struct tl_variant *variants; /* no two of one name */
    size_t clip_count;
    struct tl_clip *clips;
    tl_rig *rig; /* NULL for a model without animation */
    struct tl_units_reading units;
    /* Points: the vertices of the file, before they are split into render vertices. Point caches count these.
     */
    size_t point_count;
    uint32_t *points; /* [vertex_count] point of each vertex; NULL: each is its own */
    size_t stitch_count;
    struct tl_stitch *stitches;
    /* Two ways to mark the vertices that hold cloth in place; NULL: the file has none. A glTF's attribute
     * _PIN (or _pin; such names are free to applications [glTF 2.0, 3.7.2.1]), 0 where a part has none; and
     * COLOR_0, white where a part has none. */
    float *pins;    /* [vertex_count] held above a half */
    vec3s *colours; /* [vertex_count] 0 to 1 */
    size_t ignored_count;
    char **ignored; /* features of the file without effect: "morph targets", ...; each once */
    size_t unread_count;
    struct tl_unread *unread; /* each reason once; `ignored` has them too */
    size_t defect_count;
    char **defects; /* of a scan's mesh: "2 open borders, the longest 0.41 m around"; each once */
    size_t approximated_count;
    char **approximated; /* features shown differently from the file: "KHR_materials_sheen: ..."; each once */
} tl_model;

/* Number of points that the model's file counts.
 *
 * Errors: none. Lifetime: nothing is kept. Threads: any. */
size_t tl_model_point_count(const tl_model *model);

/* The file's points, in the file's units, when the render vertices are at `positions` (metres). A point that
 * no triangle uses is put on the first vertex.
 *
 * positions [mesh.vertex_count], points [tl_model_point_count].
 * Errors: none. Lifetime: both arrays are the caller's. Threads: any. */
void tl_model_points(const tl_model *model, const vec3s *positions, vec3s *points);

/* Whether a vertex's colour has more than half of one channel (0 red, 1 green, 2 blue) and less than half of
 * the others. The model must have colours.
 *
 * Errors: none. Lifetime: nothing is kept. Threads: any. */
bool tl_model_is_painted(const tl_model *model, size_t vertex, int channel);

/* Positions of the mesh at `time_s` of clip `clip` (looped), skinned on the CPU. Clip -1, or a model without
 * a rig, gives the rest pose.
 *
 * positions [mesh.vertex_count].
 * Errors: none. Lifetime: `positions` is the caller's. Threads: any; uses OpenMP inside, with results that do
 * not depend on the number of threads. */
void tl_model_pose(const tl_model *model, int clip, double time_s, vec3s *positions);

/* Index of the clip called `name` (exact); the first for ""; -1 when there is none.
 *
 * Errors: none. Lifetime: nothing is kept. Threads: any. */
int tl_model_find_clip(const tl_model *model, const char *name);

/* The variant called `name` (exact), or NULL.
 *
 * Errors: none. Lifetime: the variant lives as long as the model. Threads: any. */
const struct tl_variant *tl_model_find_variant(const tl_model *model, const char *name);

/* Frees what the model owns and zeroes it; a zeroed model is accepted.
 *
 * Errors: none. Lifetime: pointers into the model, its images among them, end here. Threads: one, while no
 * other uses the model. */
void tl_model_release(tl_model *model);

#endif
