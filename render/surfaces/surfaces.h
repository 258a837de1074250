/* Surfaces on the GPU: vertex buffers that follow the motion, and the maps of their materials.
 *
 * Data whose revision has not changed is not sent again. Both sides of every triangle are drawn: a garment's
 * inside is visible even where a file marks it single-sided. */
#ifndef TOILE_RENDER_SURFACES_SURFACES_H
#define TOILE_RENDER_SURFACES_SURFACES_H

#include "assets/base/surface.h"
#include "render/detail/maps.h"
#include "render/gpu/gpu.h"

enum tl_map_use {
    TL_MAP_DIFFUSE,
    TL_MAP_NORMAL,
    TL_MAP_GLOSS,
    TL_MAP_SPECULAR,
    TL_MAP_OCCLUSION,
    TL_MAP_USES
};
enum tl_weave_use { TL_WEAVE_NORMAL, TL_WEAVE_GLOSS, TL_WEAVE_TINT, TL_WEAVE_USES };

/* Texture units that tl_surfaces_draw binds, detail's last; a pass's own textures come after them. */
#define TL_DETAIL_UNIT   (TL_MAP_USES + TL_WEAVE_USES)
#define TL_SURFACE_UNITS (TL_DETAIL_UNIT + TL_DETAIL_UNITS)

/* Uniform locations shared with surface.glsl. */
enum tl_surface_uniform {
    TL_UNIFORM_DIFFUSE,
    TL_UNIFORM_SPECULAR,
    TL_UNIFORM_SCALARS,     /* glossiness, normal scale, occlusion strength, alpha cutoff */
    TL_UNIFORM_MAP_FLAGS,   /* bits by tl_map_use; the weave's bit is 1 << TL_MAP_USES; and the flags below */
    TL_UNIFORM_WEAVE_SCALE, /* repeats per UV unit */
    TL_UNIFORM_UV_ROWS,     /* 2 vec3 a map: rows of the 2x3 UV transform */
    TL_UNIFORM_FIRST_TRIANGLE =
        TL_UNIFORM_UV_ROWS + 2 * TL_MAP_USES, /* number of the draw's first triangle */
    TL_UNIFORM_SURFACE_END,
    TL_UNIFORM_DETAIL = 20, /* as render/detail/maps.h has them */
    TL_UNIFORM_INTO_EYE_SPACE = 25,
    TL_UNIFORM_SEWN_FIRST = 110, /* as in construction.glsl */
    TL_UNIFORM_SEWN_SIZES,
    TL_UNIFORM_SEWN_ROWS,
    TL_UNIFORM_SEWN_THREAD,
    TL_UNIFORM_BACK_DIFFUSE,
    TL_UNIFORM_BACK_SPECULAR,
    TL_UNIFORM_YARN_ROWS,
    TL_UNIFORM_THREAD_GAIN /* tl_material_thread_gain */
};
/* Bindings of shader storage: the borders by triangle, the profiles of the part's material, and its yarns;
 * three of corners, only where they are asked for. */
enum tl_surface_storage {
    TL_STORAGE_FIRSTS = 4,
    TL_STORAGE_NEAR,
    TL_STORAGE_BORDERS,
    TL_STORAGE_PROFILES,
    TL_STORAGE_YARNS,
    TL_STORAGE_CORNERS
};

/* Seams and hems are drawn; the back has colours of its own. */
#define TL_FLAG_SEWN (1 << (TL_MAP_USES + 1))
#define TL_FLAG_BACK (1 << (TL_MAP_USES + 2))
/* Yarns differ from one another. */
#define TL_FLAG_YARNS (1 << (TL_MAP_USES + 3))
/* The material's gloss is not a lobe about the mirror direction. */
#define TL_FLAG_FACETED (1 << 30)

typedef struct tl_surfaces tl_surfaces;

tl_surfaces *tl_surfaces_create(tl_gpu *gpu);
void tl_surfaces_destroy(tl_surfaces **surfaces);

/* Sets the detail maps that are bound together with the surfaces' own from now on; borrowed. */
void tl_surfaces_use_detail(tl_surfaces *surfaces, const struct tl_detail_maps *detail);

/* Whether the next updates send the derivatives of points by u and v at vertices (detail_vertex.glsl). */
void tl_surfaces_use_derivatives(tl_surfaces *surfaces, bool wanted);

/* Brings the GPU's copies up to date. Fails when a map is larger than GL can hold. */
bool tl_surfaces_update(tl_surfaces *surfaces, const tl_surface *const *items, size_t count, tl_error *error);

/* Opaque parts, and parts whose alpha map cuts holes. */
enum tl_surface_parts { TL_PARTS_OPAQUE = 1, TL_PARTS_MASKED = 2, TL_PARTS_ALL = 3 };

/* Draws these parts of surface `index` with the program in use, which includes surface.glsl. */
void tl_surfaces_draw(const tl_surfaces *surfaces, size_t index, enum tl_surface_parts parts);
/* Part by part, for programs that differ by material. The material is of the last update; its maps' images
 * may be gone. */
size_t tl_surfaces_part_count(const tl_surfaces *surfaces, size_t index);
const tl_material *tl_surfaces_part_material(const tl_surfaces *surfaces, size_t index, size_t part);
/* Binds the emission map of a part to a unit of the pass; false where there is none. */
bool tl_surfaces_bind_emission(const tl_surfaces *surfaces, size_t index, size_t part, unsigned unit);
/* Binds what the corners of a part's triangles are, to storage from TL_STORAGE_CORNERS: numbers of vertices,
 * positions, normals. Returns the place of the part's first number. */
unsigned tl_surfaces_bind_corners(const tl_surfaces *surfaces, size_t index, size_t part);
void tl_surfaces_draw_part(const tl_surfaces *surfaces, size_t index, size_t part);
/* The same with triangles first .. first + count - 1 of a GL buffer of indices in place of its own; the
 * shader's `first_triangle` is then counted through that buffer. */
void tl_surfaces_draw_some(const tl_surfaces *surfaces, size_t index, size_t part, unsigned indices,
                           size_t first, size_t count);
/* ... and then not, until it is shown again. */
void tl_surfaces_hide(tl_surfaces *surfaces, size_t index, bool hidden);
bool tl_surfaces_is_hidden(const tl_surfaces *surfaces, size_t index);
/* Whether any surface has such parts. */
bool tl_surfaces_have(const tl_surfaces *surfaces, enum tl_surface_parts parts);

size_t tl_surfaces_bytes(const tl_surfaces *surfaces); /* buffers and textures */

#endif
