/* Model files: a glTF 2.0 scene or a Wavefront OBJ, flattened into one tl_model in metres.
 *
 * Loaded from glTF: node hierarchy (scaled and mirrored nodes too: their winding is repaired), skins,
 * animations (step, linear, cubic spline), KHR_texture_transform, KHR_mesh_quantization, base colour, normal,
 * occlusion, metallic-roughness, alpha mask, double-sided, sparse accessors, triangle strips and fans,
 * KHR_materials_variants. KHR_materials_anisotropy, _clearcoat, _diffuse_transmission, _ior, _sheen,
 * _specular and _transmission become the nearest appearance that a tl_material can represent
 * (assets/gltf/model_extensions.c); `approximated` lists what that changes.
 * Loaded from OBJ: polygons, groups, and from its MTL files Kd, Ks, Ns, illum, map_Kd, map_Ks, norm and
 * alpha. Everything else has no effect, and is listed once in `ignored`. */
#ifndef TOILE_ASSETS_MODEL_H
#define TOILE_ASSETS_MODEL_H

#include "assets/base/model.h"
#include "config/base/error.h"

/* Loads a .gltf, .glb or .obj file; its units are decided as assets/base/units.h describes.
 *
 * Errors: false, *out zeroed, with one message (TL_INPUT) for a file that is missing, cut short or damaged,
 * for indices out of range, positions that are not finite, a file without triangles, and sizes that disagree
 * with the file's length (checked before memory is allocated).
 * Lifetime: *out owns all of it; tl_model_release. The file is closed on return.
 * Threads: several threads may load at once, also the same file. */
bool tl_model_load(const char *path, tl_model *out, tl_error *error);

/* Is tl_model_load with the units given; TL_UNITS_AUTO is tl_model_load.
 *
 * Errors, Lifetime, Threads: as tl_model_load. */
bool tl_model_load_in(const char *path, enum tl_units units, tl_model *out, tl_error *error);

/* Whether the extension is that of a model file. The file need not exist.
 *
 * Errors: none. Lifetime: nothing is kept. Threads: any. */
bool tl_model_is_file(const char *path);

#endif
