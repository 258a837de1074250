/* The scene of the reference renderer: the surfaces of a frame with a BVH, their materials with textures and
 * detail, the environment as a sampler, and the lit lamps.
 *
 * World space, metres. Borrows the frame's surfaces, materials, images and environment, which must outlive
 * it. Threads: any, once made. */
#ifndef TOILE_RENDER_REFERENCE_SCENE_H
#define TOILE_RENDER_REFERENCE_SCENE_H

#include "render/construction/tables.h"
#include "render/gpu/map_texture.h"
#include "render/local/lamp.h"
#include "render/reference/detail.h"
#include "render/reference/request.h"
#include "render/reference/sky.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"
#include "render/trace/trace.h"

/* A map of a material. */
struct tl_reference_map {
    const struct tl_map_texture *texture; /* NULL: none */
    bool clamp_u, clamp_v;
    float rows[6]; /* of its UV transform */
};

/* A material with its textures. */
struct tl_reference_material {
    struct tl_reference_map maps[TL_MAP_USES], emission;
    const struct tl_map_texture *weave[TL_WEAVE_USES];
    const struct tl_moment_map *own_moments, *weave_moments; /* NULL: none */
    struct tl_construction_tables *construction;             /* NULL: not sewn; owned */
    struct tl_detail_heights heights; /* of the first part that uses the material; empty: none */
};

/* The materials of a surface. */
struct tl_surface_materials {
    size_t count;
    struct tl_reference_material *materials;
};

struct tl_reference_scene {
    const tl_surface *surfaces; /* those of the frame, without the ground */
    size_t surface_count;
    const struct tl_ground *ground; /* NULL: none */
    tl_trace *trace;
    struct tl_surface_materials *materials; /* by surface; those of the ground come last */
    size_t texture_count;
    struct tl_map_texture **textures;
    struct tl_sky sky;
    struct tl_reference_detail detail;
    struct tl_lamp lamps[TL_LAMPS_MAX]; /* the lit lamps */
    size_t lamp_count;
    float offset_m; /* distance from a surface at which its rays start */
    int lobe;       /* enum tl_lobe */
    int terminator; /* enum tl_terminator */
    bool reflect;   /* near mirrors reflect the lit scene */
    int bounces;    /* how often surfaces send light on before the one that is seen */
};

/* Makes the scene of a request, whose image size is not used. False with TL_DEVICE if the BVH cannot be
 * built; then nothing needs to be released. */
bool tl_reference_scene_make(const struct tl_reference_request *request, struct tl_reference_scene *out,
                             tl_error *error);
/* Frees and zeroes. */
void tl_reference_scene_release(struct tl_reference_scene *scene);

#endif
