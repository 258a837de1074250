#include "render/shade/look.h"

#include "render/construction/look.h"
#include "render/detail/yarns.h"
#include "render/surfaces/surface_terms.h"

/* ---- Maps ---- */

/* The place at which a map is read. */
struct texel_lanes {
    float u[TL_LANES], v[TL_LANES], level[TL_LANES];
};

TL_INLINE float square_of(float u, float v)
{
    return u * u + v * v;
}

/* `r`: rows of the affine map from the mesh's UV; the size is in texels. */
TL_INLINE void place_texels(const struct tl_look_lanes *lanes, const float r[6], float width, float height,
                            struct texel_lanes *out)
{
    for (int i = 0; i < TL_LANES; i++) {
        float u = lanes->uv[0][i], v = lanes->uv[1][i];
        float u_across = lanes->change[0][0][i], u_up = lanes->change[0][1][i];
        float v_across = lanes->change[1][0][i], v_up = lanes->change[1][1][i];
        out->u[i] = r[0] * u + r[1] * v + r[2];
        out->v[i] = r[3] * u + r[4] * v + r[5];
        out->level[i] =
            texel_level(square_of(width * (r[0] * u_across + r[1] * v_across),
                                  height * (r[3] * u_across + r[4] * v_across)),
                        square_of(width * (r[0] * u_up + r[1] * v_up), height * (r[3] * u_up + r[4] * v_up)));
    }
}

TL_INLINE void read_map(const struct tl_look_lanes *lanes, const struct tl_shade_map *map,
                        const struct tl_texels *texels, tl_quad out[TL_LANES])
{
    struct texel_lanes at;
    place_texels(lanes, map->rows, (float)texels->widths[0], (float)texels->heights[0], &at);
    for (int i = 0; i < lanes->count; i++)
        out[i] = tl_texels_fetch(texels, at.u[i], at.v[i], at.level[i], map->clamp_u, map->clamp_v);
}

TL_INLINE void read_weave(const struct tl_look_lanes *lanes, const struct texel_lanes *at,
                          const struct tl_texels *texels, tl_quad out[TL_LANES])
{
    for (int i = 0; i < lanes->count; i++)
        out[i] = tl_texels_fetch(texels, at->u[i], at->v[i], at->level[i], false, false);
}

TL_INLINE void multiply(tl_quad values[TL_LANES], const tl_quad factors[TL_LANES], int count)
{
    for (int i = 0; i < count; i++)
        values[i] *= factors[i];
}

TL_INLINE vec3s vector_of(tl_quad v)
{
    return (vec3s){{v[0], v[1], v[2]}};
}

TL_INLINE tl_quad quad_of(vec3s v)
{
    return (tl_quad){v.x, v.y, v.z, 0};
}

TL_INLINE float yarns_of(const struct tl_look_lanes *lanes, int i)
{
    return tl_yarn_factor(lanes->part->yarns, lanes->part->uv_metres,
                          (vec2s){{lanes->uv[0][i], lanes->uv[1][i]}},
                          (vec2s){{lanes->change[0][0][i], lanes->change[1][0][i]}},
                          (vec2s){{lanes->change[0][1][i], lanes->change[1][1][i]}});
}

/* The material's own maps of colour, reflectance and gloss. */
TL_INLINE void read_own_maps(struct tl_look_lanes *lanes)
{
    const struct tl_shade_map *maps = lanes->part->maps;
    const int count = lanes->count;
    tl_quad texels[TL_LANES];
    if (maps[TL_MAP_DIFFUSE].texels) {
        read_map(lanes, &maps[TL_MAP_DIFFUSE], maps[TL_MAP_DIFFUSE].texels, texels);
        multiply(lanes->diffuse, texels, count);
    }
    if (maps[TL_MAP_SPECULAR].texels) {
        read_map(lanes, &maps[TL_MAP_SPECULAR], maps[TL_MAP_SPECULAR].texels, texels);
        multiply(lanes->f0, texels, count);
    }
    if (maps[TL_MAP_GLOSS].texels) {
        read_map(lanes, &maps[TL_MAP_GLOSS], maps[TL_MAP_GLOSS].texels, texels);
        for (int i = 0; i < count; i++)
            lanes->glossiness[i] *= texels[i][0];
    }
}

/* The other maps: weave, yarns, occlusion. */
TL_INLINE void read_texels(const struct tl_detail_params *detail, const struct tl_look_lanes *lanes,
                           struct texel_lanes *weave, SurfaceTexels to[TL_LANES])
{
    const struct tl_shade_part *part = lanes->part;
    const struct tl_shade_map *occlusion = &part->maps[TL_MAP_OCCLUSION];
    const int count = lanes->count;
    tl_quad texels[TL_LANES];
    for (int i = 0; i < count; i++)
        to[i] = surface_texels();
    const struct tl_texels *tint = part->weave_tint;
    if (tint) {
        /* Read a level coarser where the spread of normals is kept, as by WEAVE_BIAS of material.glsl. */
        const float wider = detail->minify != TL_DETAIL_MINIFY_NONE ? 2.0f : 1.0f;
        const float rows[6] = {part->weave_scale[0], 0, 0, 0, part->weave_scale[1], 0};
        place_texels(lanes, rows, wider * (float)tint->widths[0], wider * (float)tint->heights[0], weave);
        read_weave(lanes, weave, tint, texels);
        for (int i = 0; i < count; i++) {
            to[i].tint = vector_of(texels[i]);
            to[i].gloss = texels[i][3];
        }
    }
    for (int i = 0; part->yarns && i < count; i++)
        to[i].yarns = yarns_of(lanes, i);
    if (occlusion->texels) {
        read_map(lanes, occlusion, occlusion->texels, texels);
        for (int i = 0; i < count; i++)
            to[i].occlusion = 1 + (texels[i][0] - 1) * part->material->occlusion_strength;
    }
}

TL_INLINE void apply_texels(struct tl_look_lanes *lanes, const SurfaceTexels texels[TL_LANES])
{
    const tl_material *material = lanes->part->material;
    for (int i = 0; i < lanes->count; i++) {
        const SurfaceColours cloth = {vector_of(lanes->diffuse[i]), vector_of(lanes->f0[i]),
                                      lanes->glossiness[i]};
        const SurfaceColours seen =
            surface_colours(cloth, texels[i], material->back.is_given && lanes->side[i] < 0,
                            material->back.diffuse, material->back.specular, material->construction.thread);
        lanes->diffuse[i] = quad_of(seen.diffuse);
        lanes->f0[i] = quad_of(seen.f0);
        lanes->glossiness[i] = seen.glossiness;
    }
}

/* ---- Bumps ---- */

/* A map of normals, or of the moments of its normals. */
struct bump_lanes {
    bool is_given, has_moments;
    float scale[2][TL_LANES]; /* of the slopes along u and v */
    float texel[4][TL_LANES], cross[TL_LANES];
};

/* `scale` multiplies all slopes, `factors` those of each lane; NULL: 1. */
TL_INLINE void keep_bumps(const tl_quad texels[TL_LANES], float scale, const float (*factors)[TL_LANES],
                          bool has_moments, const tl_quad cross[TL_LANES], struct bump_lanes *bumps)
{
    bumps->is_given = true;
    bumps->has_moments = has_moments;
    for (int axis = 0; axis < 2; axis++)
        for (int i = 0; i < TL_LANES; i++)
            bumps->scale[axis][i] = factors ? scale * factors[axis][i] : scale;
    for (int i = 0; i < TL_LANES; i++)
        for (int c = 0; c < 4; c++)
            bumps->texel[c][i] = texels[i][c];
    for (int i = 0; i < TL_LANES; i++)
        bumps->cross[i] = cross[i][0];
}

TL_INLINE Bumps bumps_at(const struct bump_lanes *bumps, bool has_moments, int lane)
{
    float texel[4];
    for (int c = 0; c < 4; c++)
        texel[c] = bumps->texel[c][lane];
    const float scale[2] = {bumps->scale[0][lane], bumps->scale[1][lane]};
    if (has_moments)
        return bumps_of_moments(texel[0], texel[1], texel[2], texel[3], bumps->cross[lane], scale[0],
                                scale[1]);
    return bumps_of_texel((vec3s){{texel[0], texel[1], texel[2]}}, scale[0], scale[1]);
}

/* The statistics of one layer of bumps, or of the sum of two. */
struct statistic_lanes {
    float normal[3][TL_LANES], spread[3][TL_LANES], mean_length[TL_LANES];
};

TL_INLINE void store_statistics(struct statistic_lanes *to, int lane, Bumps from)
{
    tl_lane_store(to->normal, lane, from.normal);
    tl_lane_store(to->spread, lane, from.spread);
    to->mean_length[lane] = from.mean_length;
}

TL_INLINE Bumps statistics_of(const struct statistic_lanes *from, int lane)
{
    return (Bumps){tl_lane_vector(from->normal, lane), tl_lane_vector(from->spread, lane),
                   from->mean_length[lane]};
}

TL_INLINE void add_bumps_as(const struct bump_lanes *bumps, bool has_moments, struct statistic_lanes *sum)
{
    for (int i = 0; i < TL_LANES; i++)
        store_statistics(sum, i, bumps_add(statistics_of(sum, i), bumps_at(bumps, has_moments, i)));
}

TL_INLINE void add_bumps(const struct bump_lanes *bumps, struct statistic_lanes *sum)
{
    if (!bumps->is_given)
        return;
    if (bumps->has_moments)
        add_bumps_as(bumps, true, sum);
    else
        add_bumps_as(bumps, false, sum);
}

/* `minify` is known to the compiler; `open` is a factor on the diffuse light. */
TL_INLINE void bend(struct tl_look_lanes *lanes, const struct statistic_lanes *bumps,
                    enum tl_detail_minify minify, float open[TL_LANES])
{
    for (int i = 0; i < TL_LANES; i++) {
        const SurfaceShape shape =
            surface_shape((int)minify, statistics_of(bumps, i), tl_lane_vector(lanes->normal, i),
                          tl_lane_vector(lanes->smooth, i), tl_lane_vector(lanes->tangent, i),
                          lanes->tangent[3][i], lanes->side[i], tl_lane_vector(lanes->viewer, i),
                          lanes->part->material->glossiness, lanes->glossiness[i]);
        tl_lane_store(lanes->shown, i, shape.normal);
        tl_lane_store(lanes->widening, i, shape.widening);
        lanes->glossiness[i] = shape.glossiness;
        open[i] = shape.open;
    }
}

/* ---- Construction ---- */

/* Finds seams, hems and stitches, where there are any near by. */
TL_INLINE void sew(const struct tl_look_lanes *lanes, struct statistic_lanes *sum,
                   SurfaceTexels texels[TL_LANES])
{
    const struct tl_shade_part *part = lanes->part;
    for (int i = 0; i < lanes->count; i++) {
        const uint32_t triangle = lanes->triangle[i];
        if (triangle == TL_NO_TRIANGLE ||
            part->borders->firsts[triangle] == part->borders->firsts[triangle + 1])
            continue;
        const ConstructionLook sewn = tl_construction_look(
            part->construction, part->borders, triangle, (vec2s){{lanes->uv[0][i], lanes->uv[1][i]}},
            (vec2s){{lanes->change[0][0][i], lanes->change[1][0][i]}},
            (vec2s){{lanes->change[0][1][i], lanes->change[1][1][i]}});
        const Bumps more = bumps_of_slopes(sewn.slope_x, sewn.slope_y,
                                           (vec3s){{sewn.spread_x, sewn.spread_y, sewn.spread_xy}});
        store_statistics(sum, i, bumps_add(statistics_of(sum, i), more));
        texels[i].thread = sewn.thread;
        texels[i].shade = sewn.shade;
    }
}

TL_INLINE void find_bumps(const struct tl_detail_params *detail, const struct tl_look_lanes *lanes,
                          const struct texel_lanes *weave_at, struct statistic_lanes *sum)
{
    const struct tl_shade_part *part = lanes->part;
    const struct tl_shade_map *own = &part->maps[TL_MAP_NORMAL];
    tl_quad texels[TL_LANES] = {{0}}, cross[TL_LANES] = {{0}};
    struct bump_lanes bumps[2] = {{0}};
    if (part->own_moments || own->texels) {
        read_map(lanes, own, part->own_moments ? part->own_moments : own->texels, texels);
        if (part->own_cross)
            read_map(lanes, own, part->own_cross, cross);
        keep_bumps(texels, part->material->normal_scale, NULL, part->own_moments, cross, &bumps[0]);
    }
    const struct tl_texels *weave = part->weave_moments ? part->weave_moments : part->weave_normal;
    if (weave) {
        read_weave(lanes, weave_at, weave, texels);
        if (part->weave_cross)
            read_weave(lanes, weave_at, part->weave_cross, cross);
        keep_bumps(texels, detail->height_scale, lanes->slopes, part->weave_moments, cross, &bumps[1]);
    }
    const Bumps flat = bumps_of_normal((vec3s){{0, 0, 1}});
    for (int i = 0; i < TL_LANES; i++)
        store_statistics(sum, i, flat);
    add_bumps(&bumps[0], sum);
    add_bumps(&bumps[1], sum);
}

TL_INLINE void apply_bumps(const struct tl_detail_params *detail, struct tl_look_lanes *lanes,
                           const struct statistic_lanes *sum)
{
    float open[TL_LANES];
    if (detail->minify == TL_DETAIL_MINIFY_LEAN)
        bend(lanes, sum, TL_DETAIL_MINIFY_LEAN, open);
    else if (detail->minify == TL_DETAIL_MINIFY_TOKSVIG)
        bend(lanes, sum, TL_DETAIL_MINIFY_TOKSVIG, open);
    else
        bend(lanes, sum, TL_DETAIL_MINIFY_NONE, open);
    for (int i = 0; i < lanes->count; i++)
        lanes->diffuse[i] *= open[i];
}

TL_INLINE void face_viewers(struct tl_look_lanes *lanes)
{
    for (int i = 0; i < TL_LANES; i++)
        tl_lane_store(lanes->shown, i,
                      facing_normal(tl_lane_vector(lanes->shown, i), tl_lane_vector(lanes->viewer, i)));
}

TL_CLONES void tl_look_evaluate(const struct tl_detail_params *detail, struct tl_look_lanes *lanes)
{
    const struct tl_shade_part *part = lanes->part;
    const tl_material *material = part->material;
    const tl_quad diffuse = {material->diffuse.x, material->diffuse.y, material->diffuse.z, 0};
    const tl_quad f0 = {material->specular.x, material->specular.y, material->specular.z, 0};
    const vec3s up = {{0, 1, 0}};
    for (int i = 0; i < TL_LANES; i++) {
        vec3s smooth = direction_or(tl_lane_vector(lanes->normal, i), up);
        tl_lane_store(lanes->smooth, i, smooth);
        tl_lane_store(lanes->shown, i, glms_vec3_scale(smooth, lanes->side[i]));
    }
    for (int i = 0; i < TL_LANES; i++) {
        lanes->glossiness[i] = material->glossiness;
        lanes->widening[0][i] = lanes->widening[1][i] = lanes->widening[2][i] = 0;
        lanes->diffuse[i] = diffuse;
        lanes->f0[i] = f0;
    }
    SurfaceTexels texels[TL_LANES];
    struct texel_lanes weave_at;
    struct statistic_lanes bumps;
    if (part->has_maps) {
        read_own_maps(lanes);
        read_texels(detail, lanes, &weave_at, texels);
        if (part->has_bumps)
            find_bumps(detail, lanes, &weave_at, &bumps);
        if (part->has_bumps && part->borders)
            sew(lanes, &bumps, texels);
        apply_texels(lanes, texels);
        for (int i = 0; i < TL_LANES; i++)
            lanes->widening[0][i] = lanes->widening[1][i] =
                detail_widening(1 - material->glossiness, 1 - lanes->glossiness[i], 0);
        if (part->has_bumps)
            apply_bumps(detail, lanes, &bumps);
    } else if (material->back.is_given) {
        for (int i = 0; i < lanes->count; i++)
            texels[i] = surface_texels();
        apply_texels(lanes, texels);
    }
    face_viewers(lanes);
}
