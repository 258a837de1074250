#include "render/shade/look.h"

#include "render/construction/look.h"
#include "render/detail/bump_statistics.h"
#include "render/detail/yarns.h"

/* ---- Maps ---- */

/* The place at which a map is read. */
struct texel_lanes {
    float u[TL_LANES], v[TL_LANES], level[TL_LANES];
};

/* Base-2 logarithm of the longer of two steps in texels; 0 where a texel is larger than a sample. */
TL_INLINE float level_of(float u_across, float v_across, float u_up, float v_up)
{
    float across = u_across * u_across + v_across * v_across, up = u_up * u_up + v_up * v_up;
    return 0.5f * tl_log2(tl_maxf(tl_maxf(across, up), 1));
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
        out->level[i] = level_of(width * (r[0] * u_across + r[1] * v_across),
                                 height * (r[3] * u_across + r[4] * v_across),
                                 width * (r[0] * u_up + r[1] * v_up), height * (r[3] * u_up + r[4] * v_up));
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

TL_INLINE void vary_yarn_colour(struct tl_look_lanes *lanes)
{
    const struct tl_shade_part *part = lanes->part;
    for (int i = 0; i < lanes->count; i++) {
        const float factor =
            tl_yarn_factor(part->yarns, part->uv_metres, (vec2s){{lanes->uv[0][i], lanes->uv[1][i]}},
                           (vec2s){{lanes->change[0][0][i], lanes->change[1][0][i]}},
                           (vec2s){{lanes->change[0][1][i], lanes->change[1][1][i]}});
        lanes->diffuse[i] *= factor;
        lanes->f0[i] *= factor;
    }
}

/* A back of its own takes nothing from the front's maps. */
TL_INLINE void show_backs(struct tl_look_lanes *lanes)
{
    const struct tl_back *back = &lanes->part->material->back;
    if (!back->is_given)
        return;
    const tl_quad diffuse = {back->diffuse.x, back->diffuse.y, back->diffuse.z, 0};
    const tl_quad f0 = {back->specular.x, back->specular.y, back->specular.z, 0};
    for (int i = 0; i < lanes->count; i++)
        if (lanes->side[i] < 0) {
            lanes->diffuse[i] = diffuse;
            lanes->f0[i] = f0;
        }
}

/* Colours and glossiness from the material's own maps and from the weave. */
TL_INLINE void read_colours(const struct tl_detail_params *detail, struct tl_look_lanes *lanes,
                            struct texel_lanes *weave)
{
    const struct tl_shade_part *part = lanes->part;
    const struct tl_shade_map *maps = part->maps;
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
    const struct tl_texels *tint = part->weave_tint;
    if (tint) {
        /* Read a level coarser where the spread of normals is kept, as by WEAVE_BIAS of material.glsl. */
        const float wider = detail->minify != TL_DETAIL_MINIFY_NONE ? 2.0f : 1.0f;
        const float rows[6] = {part->weave_scale[0], 0, 0, 0, part->weave_scale[1], 0};
        place_texels(lanes, rows, wider * (float)tint->widths[0], wider * (float)tint->heights[0], weave);
        read_weave(lanes, weave, tint, texels);
        multiply(lanes->diffuse, texels, count);
        for (int i = 0; i < count; i++)
            lanes->glossiness[i] += texels[i][3];
    }
    if (part->yarns)
        vary_yarn_colour(lanes);
    show_backs(lanes);
    for (int i = 0; i < TL_LANES; i++)
        lanes->glossiness[i] = tl_maxf(tl_minf(lanes->glossiness[i], 1), 0);
    if (maps[TL_MAP_OCCLUSION].texels) {
        read_map(lanes, &maps[TL_MAP_OCCLUSION], maps[TL_MAP_OCCLUSION].texels, texels);
        for (int i = 0; i < count; i++)
            lanes->diffuse[i] *= 1 + (texels[i][0] - 1) * part->material->occlusion_strength;
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

TL_INLINE struct tl_bump_statistics bumps_at(const struct bump_lanes *bumps, bool has_moments, int lane)
{
    float texel[4];
    for (int c = 0; c < 4; c++)
        texel[c] = bumps->texel[c][lane];
    const float scale[2] = {bumps->scale[0][lane], bumps->scale[1][lane]};
    if (has_moments)
        return tl_bump_statistics_of_moments((vec4s){{texel[0], texel[1], texel[2], texel[3]}},
                                             bumps->cross[lane], scale);
    return tl_bump_statistics_of_normal(
        (vec3s){{scale[0] * (2 * texel[0] - 1), scale[1] * (2 * texel[1] - 1), 2 * texel[2] - 1}});
}

/* The statistics of one layer of bumps, or of the sum of two. */
struct statistic_lanes {
    float normal[3][TL_LANES], spread[3][TL_LANES], length[TL_LANES];
};

TL_INLINE void store_statistics(struct statistic_lanes *to, int lane, const struct tl_bump_statistics *from)
{
    tl_lane_store(to->normal, lane, from->normal);
    to->spread[0][lane] = from->spread[0];
    to->spread[1][lane] = from->spread[1];
    to->spread[2][lane] = from->spread[2];
    to->length[lane] = from->length;
}

TL_INLINE struct tl_bump_statistics statistics_of(const struct statistic_lanes *from, int lane)
{
    return (struct tl_bump_statistics){tl_lane_vector(from->normal, lane),
                                       {from->spread[0][lane], from->spread[1][lane], from->spread[2][lane]},
                                       from->length[lane]};
}

TL_INLINE void add_bumps_as(const struct bump_lanes *bumps, bool has_moments, struct statistic_lanes *sum)
{
    for (int i = 0; i < TL_LANES; i++) {
        struct tl_bump_statistics more = bumps_at(bumps, has_moments, i);
        const struct tl_bump_statistics so_far = statistics_of(sum, i);
        more = tl_bump_statistics_add(&so_far, &more);
        store_statistics(sum, i, &more);
    }
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

/* MikkTSpace: the interpolated frame is used as it is, and normalised once at the end. */
TL_INLINE vec3s bent(vec3s normal, vec3s tangent, float handedness, vec3s mapped, vec3s otherwise)
{
    vec3s b = glms_vec3_scale(glms_vec3_cross(normal, tangent), handedness);
    vec3s n = glms_vec3_add(glms_vec3_scale(normal, mapped.z),
                            glms_vec3_add(glms_vec3_scale(tangent, mapped.x), glms_vec3_scale(b, mapped.y)));
    return direction_or(n, otherwise);
}

/* The viewer in the tangent space of the front. */
TL_INLINE vec3s local_viewer(vec3s viewer, vec3s n, vec3s t, float handedness)
{
    const vec3s none = {{0, 0, 0}};
    t = direction_or(glms_vec3_sub(t, glms_vec3_scale(n, glms_vec3_dot(n, t))), none);
    vec3s b = glms_vec3_scale(glms_vec3_cross(n, t), handedness < 0 ? -1.0f : 1.0f);
    return (vec3s){{glms_vec3_dot(viewer, t), glms_vec3_dot(viewer, b), glms_vec3_dot(viewer, n)}};
}

/* Bends normals and widens gloss; `open` is a factor on the diffuse light. `minify` is known to the compiler.
 */
TL_INLINE void bend(struct tl_look_lanes *lanes, const struct statistic_lanes *bumps,
                    enum tl_detail_minify minify, float open[TL_LANES])
{
    const struct tl_detail_params params = {.minify = minify};
    for (int i = 0; i < TL_LANES; i++) {
        const struct tl_bump_statistics at = statistics_of(bumps, i);
        vec3s normal = tl_lane_vector(lanes->normal, i);
        vec3s smooth = tl_lane_vector(lanes->smooth, i);
        vec3s tangent = tl_lane_vector(lanes->tangent, i);
        float handedness = lanes->tangent[3][i], side = lanes->side[i];
        bool has_tangent = glms_vec3_dot(tangent, tangent) > 0;
        vec3s n = bent(normal, tangent, handedness, at.normal, smooth);
        vec3s viewer = local_viewer(tl_lane_vector(lanes->viewer, i), smooth, tangent, handedness);
        const float own_rough = 1 - lanes->part->material->glossiness;
        for (int axis = 0; axis < 2; axis++) {
            float wider =
                tl_bump_statistics_widening(&params, own_rough, 1 - lanes->glossiness[i], &at, axis);
            lanes->widening[axis][i] = has_tangent ? wider : lanes->widening[axis][i];
        }
        lanes->widening[2][i] = has_tangent ? tl_bump_statistics_shear(&params, &at) : 0;
        float rough = tl_bump_statistics_roughness(&params, 1 - lanes->glossiness[i], &at, viewer);
        for (int c = 0; c < 3; c++)
            lanes->shown[c][i] = has_tangent ? side * n.raw[c] : lanes->shown[c][i];
        lanes->glossiness[i] = has_tangent ? 1 - rough : lanes->glossiness[i];
        open[i] = has_tangent ? detail_open(at.length) : 1;
    }
}

/* ---- Construction ---- */

/* Puts seams, hems and stitches over colours and bumps, where there are any near by. */
TL_INLINE void sew(struct tl_look_lanes *lanes, struct statistic_lanes *sum)
{
    const struct tl_shade_part *part = lanes->part;
    const vec3s thread = part->material->construction.thread;
    for (int i = 0; i < lanes->count; i++) {
        const uint32_t triangle = lanes->triangle[i];
        if (triangle == TL_NO_TRIANGLE ||
            part->borders->firsts[triangle] == part->borders->firsts[triangle + 1])
            continue;
        const ConstructionLook sewn = tl_construction_look(
            part->construction, part->borders, triangle, (vec2s){{lanes->uv[0][i], lanes->uv[1][i]}},
            (vec2s){{lanes->change[0][0][i], lanes->change[1][0][i]}},
            (vec2s){{lanes->change[0][1][i], lanes->change[1][1][i]}});
        const struct tl_bump_statistics more = tl_construction_bumps(&sewn);
        const struct tl_bump_statistics so_far = statistics_of(sum, i);
        const struct tl_bump_statistics all = tl_bump_statistics_add(&so_far, &more);
        store_statistics(sum, i, &all);
        for (int c = 0; c < 3; c++) {
            lanes->diffuse[i][c] = tl_construction_colour(&sewn, lanes->diffuse[i][c], thread.raw[c]);
            lanes->f0[i][c] = tl_construction_colour(&sewn, lanes->f0[i][c],
                                                     tl_minf(lanes->f0[i][c], CONSTRUCTION_THREAD_F0));
        }
    }
}

TL_INLINE void apply_bumps(const struct tl_detail_params *detail, struct tl_look_lanes *lanes,
                           const struct texel_lanes *weave_at)
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
    struct statistic_lanes sum;
    const struct tl_bump_statistics flat = {.normal = {{0, 0, 1}}, .length = 1};
    for (int i = 0; i < TL_LANES; i++)
        store_statistics(&sum, i, &flat);
    add_bumps(&bumps[0], &sum);
    add_bumps(&bumps[1], &sum);
    if (part->borders)
        sew(lanes, &sum);
    float open[TL_LANES];
    if (detail->minify == TL_DETAIL_MINIFY_LEAN)
        bend(lanes, &sum, TL_DETAIL_MINIFY_LEAN, open);
    else if (detail->minify == TL_DETAIL_MINIFY_TOKSVIG)
        bend(lanes, &sum, TL_DETAIL_MINIFY_TOKSVIG, open);
    else
        bend(lanes, &sum, TL_DETAIL_MINIFY_NONE, open);
    for (int i = 0; i < lanes->count; i++)
        lanes->diffuse[i] *= open[i];
}

TL_INLINE void face_viewers(struct tl_look_lanes *lanes)
{
    for (int i = 0; i < TL_LANES; i++) {
        vec3s n = tl_lane_vector(lanes->shown, i), viewer = tl_lane_vector(lanes->viewer, i);
        float lift = detail_facing(glms_vec3_dot(n, viewer));
        vec3s facing = direction_or(glms_vec3_add(n, glms_vec3_scale(viewer, lift)), n);
        for (int c = 0; c < 3; c++)
            lanes->shown[c][i] = lift > 0 ? facing.raw[c] : n.raw[c];
    }
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
    if (!part->has_maps) {
        show_backs(lanes);
        face_viewers(lanes);
        return;
    }
    struct texel_lanes weave_at;
    read_colours(detail, lanes, &weave_at);
    for (int i = 0; i < TL_LANES; i++)
        lanes->widening[0][i] = lanes->widening[1][i] =
            detail_widening(1 - material->glossiness, 1 - lanes->glossiness[i], 0);
    if (part->has_bumps)
        apply_bumps(detail, lanes, &weave_at);
    face_viewers(lanes);
}
