/* The materials of all parts of the surfaces, ready to be evaluated on the CPU at every pixel: what the
 * shader of the G-buffer (render/gbuffer/gbuffer.frag) reads from uniforms and textures, with the fit of its
 * facets as a table. Bumps bend normals and widen gloss (detail.mode normal, detail.minify any). Whatever
 * else a material can be is not evaluated here, and tl_shade_materials_fit reports so.
 *
 * Lifetime: owns its maps and tables; borrows the materials from the surfaces. Threads: pure once made. */
#ifndef TOILE_RENDER_SHADE_MATERIALS_H
#define TOILE_RENDER_SHADE_MATERIALS_H

#include "assets/topology/borders.h"
#include "render/construction/tables.h"
#include "render/detail/options.h"
#include "render/gbuffer/samples.h"
#include "render/shade/lobe_set_table.h"
#include "render/shade/texels.h"
#include "render/surfaces/surfaces.h"

struct tl_shade_map {
    const struct tl_texels *texels; /* NULL: none */
    bool clamp_u, clamp_v;
    float rows[6]; /* from the mesh's UV */
};

/* One part of a surface. */
struct tl_shade_part {
    const tl_material *material;
    struct tl_shade_map maps[TL_MAP_USES], emission;
    const struct tl_texels *own_moments;             /* of the normal map: with its UV */
    const struct tl_texels *own_cross, *weave_cross; /* the mixed moments; NULL: 0 */
    const struct tl_texels *weave_tint; /* factor on kd; what is added to glossiness in the fourth channel */
    const struct tl_texels *weave_moments; /* NULL where they are not kept: */
    const struct tl_texels *weave_normal;
    float weave_scale[2];         /* repeats per UV unit */
    const struct tl_yarns *yarns; /* NULL: they are alike */
    float uv_metres;              /* of a UV unit; read where there is a weave */
    const tl_borders *borders;    /* NULL: nothing is sewn; with the profiles of seams and hems: */
    const struct tl_construction_tables *construction;
    float turn_cosine, turn_sine;             /* of gloss.rotation */
    bool has_maps;                            /* UV is read */
    bool has_bumps;                           /* the tangent is read */
    bool is_lambert;                          /* its diffuse reflectance; else by `law`: */
    vec4s law;                                /* tl_material_law */
    bool is_glossy;                           /* something is reflected */
    bool transmits;                           /* light comes through from the other side */
    bool has_fuzz;                            /* fibres stand on it */
    bool is_faceted;                          /* the gloss is not one cosine lobe: */
    float ward_squares[2];                    /* squared widths of Ward's facets without maps and bumps */
    float thread_squares[TL_THREADS_MAX][2];  /* ... of each system of threads */
    int lobe_set_count;                       /* lobes at most that stand for them */
    const struct tl_lobe_set_table *lobe_set; /* of other facets than Ward's */
};

struct tl_shade_image;
struct tl_shade_lobe_set;
struct tl_shade_materials {
    struct tl_detail_params detail;
    uint64_t shapes_revision;
    size_t surface_count;
    size_t *first_parts; /* [surface_count + 1] */
    struct tl_shade_part *parts;
    float openness; /* the greatest; 0: no part can be looked through */
    bool have_fuzz; /* of any part */
    size_t image_count, lobe_set_count, construction_count;
    struct tl_shade_image **images; /* each image is packed once */
    struct tl_shade_lobe_set **lobe_sets;
    struct tl_construction_tables **constructions; /* [construction_count] by part, of those that are sewn */
};

/* Returns true when every material of the surfaces can be evaluated here with these options, but for coats.
 */
bool tl_shade_materials_fit(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail);

/* Makes the materials and replaces the previous ones. Maps and tables of the same `shapes_revision` are kept.
 * `max_lobes`: lobes at most that stand for a gloss of facets. */
void tl_shade_materials_make(struct tl_shade_materials *materials, const tl_surface *const *surfaces,
                             size_t count, uint64_t shapes_revision, const struct tl_detail_params *detail,
                             int max_lobes);
void tl_shade_materials_release(struct tl_shade_materials *materials);
size_t tl_shade_materials_bytes(const struct tl_shade_materials *materials);

/* Index of the part that holds a surface's own triangle. */
size_t tl_shade_part_at(const struct tl_shade_materials *materials, const tl_surface *surface,
                        size_t surface_index, uint32_t triangle);

#endif
