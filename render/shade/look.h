/* A material evaluated at a point: the C counterpart of gbuffer.frag's main. Inline, so that it is compiled
 * for each instruction set together with the loops over pixels. World space. Pure; threads: any. */
#ifndef TOILE_RENDER_SHADE_LOOK_H
#define TOILE_RENDER_SHADE_LOOK_H

#include "render/detail/bump_statistics.h"
#include "render/shade/materials.h"

#include <math.h>

/* The point, as rasterisation interpolates it. */
struct tl_look_at {
    vec3s normal;       /* towards the front, not normalised */
    vec3s smooth;       /* ... normalised */
    vec4s tangent;      /* along u, and handedness */
    vec3s viewer;       /* unit, towards the eye */
    float side;         /* 1: the front is seen; -1: the back, whose whole frame turns over */
    float uv[2];        /* must be finite */
    float change[2][2]; /* of u and of v to the next sample across and down */
};

/* What is seen there. */
struct tl_look {
    vec3s normal;  /* shading normal, unit, on the viewer's side */
    vec3s diffuse; /* kd */
    vec3s f0;      /* reflectance at normal incidence */
    float glossiness;
};

TL_INLINE vec3s tl_unit_or(vec3s v, vec3s otherwise)
{
    float square = glms_vec3_dot(v, v);
    return square > 1e-30f ? glms_vec3_scale(v, 1 / sqrtf(square)) : otherwise;
}

/* Base-2 logarithm of the longer of two steps in texels; 0 where a texel is larger than a sample. */
TL_INLINE float tl_level_of(float u_across, float v_across, float u_down, float v_down)
{
    float across = u_across * u_across + v_across * v_across, down = u_down * u_down + v_down * v_down;
    return 0.5f * tl_log2(tl_greater(tl_greater(across, down), 1));
}

TL_INLINE tl_quad tl_look_map(const struct tl_shade_map *map, const struct tl_texels *texels,
                              const struct tl_look_at *at)
{
    const float *r = map->rows, width = (float)texels->widths[0], height = (float)texels->heights[0];
    float u = r[0] * at->uv[0] + r[1] * at->uv[1] + r[2], v = r[3] * at->uv[0] + r[4] * at->uv[1] + r[5];
    float level = tl_level_of(width * (r[0] * at->change[0][0] + r[1] * at->change[1][0]),
                              height * (r[3] * at->change[0][0] + r[4] * at->change[1][0]),
                              width * (r[0] * at->change[0][1] + r[1] * at->change[1][1]),
                              height * (r[3] * at->change[0][1] + r[4] * at->change[1][1]));
    return tl_texels_fetch(texels, u, v, level, map->clamp_u, map->clamp_v);
}

TL_INLINE vec3s tl_look_times(vec3s colour, tl_quad factor)
{
    return (vec3s){{colour.x * factor[0], colour.y * factor[1], colour.z * factor[2]}};
}

TL_INLINE vec4s tl_look_vector(tl_quad q)
{
    return (vec4s){{q[0], q[1], q[2], q[3]}};
}

TL_INLINE struct tl_bump_statistics tl_look_bumps(const struct tl_shade_part *part,
                                                  const struct tl_detail_params *detail,
                                                  const struct tl_look_at *at, float weave_u, float weave_v,
                                                  float weave_level)
{
    const struct tl_shade_map *own = &part->maps[TL_MAP_NORMAL];
    float scale = part->material->normal_scale;
    struct tl_bump_statistics bumps = {.normal = {{0, 0, 1}}, .length = 1};
    if (part->own_moments) {
        bumps = tl_bump_statistics_of_moments(tl_look_vector(tl_look_map(own, part->own_moments, at)), scale);
    } else if (own->texels) {
        tl_quad n = 2 * tl_look_map(own, own->texels, at) - 1;
        bumps = tl_bump_statistics_of_normal((vec3s){{scale * n[0], scale * n[1], n[2]}});
    }
    const struct tl_texels *moments = part->weave_moments, *normals = part->weave_normal;
    if (!moments && !normals)
        return bumps;
    struct tl_bump_statistics weave;
    if (moments) {
        tl_quad texel = tl_texels_fetch(moments, weave_u, weave_v, weave_level, false, false);
        weave = tl_bump_statistics_of_moments(tl_look_vector(texel), detail->height_scale);
    } else {
        tl_quad n = 2 * tl_texels_fetch(normals, weave_u, weave_v, weave_level, false, false) - 1;
        weave = tl_bump_statistics_of_normal(
            (vec3s){{detail->height_scale * n[0], detail->height_scale * n[1], n[2]}});
    }
    return tl_bump_statistics_add(&bumps, &weave);
}

/* MikkTSpace: the interpolated frame is used as it is, and normalised once at the end. */
TL_INLINE vec3s tl_look_bent(const struct tl_look_at *at, vec3s mapped)
{
    vec3s t = {{at->tangent.x, at->tangent.y, at->tangent.z}};
    vec3s b = glms_vec3_scale(glms_vec3_cross(at->normal, t), at->tangent.w);
    vec3s n = glms_vec3_scale(at->normal, mapped.z);
    n = glms_vec3_add(n, glms_vec3_add(glms_vec3_scale(t, mapped.x), glms_vec3_scale(b, mapped.y)));
    return tl_unit_or(n, at->smooth);
}

/* The viewer in the tangent space of the front. */
TL_INLINE vec3s tl_look_local_viewer(const struct tl_look_at *at)
{
    const vec3s none = {{0, 0, 0}}, n = at->smooth;
    vec3s t = {{at->tangent.x, at->tangent.y, at->tangent.z}};
    t = tl_unit_or(glms_vec3_sub(t, glms_vec3_scale(n, glms_vec3_dot(n, t))), none);
    vec3s b = glms_vec3_scale(glms_vec3_cross(n, t), at->tangent.w < 0 ? -1.0f : 1.0f);
    return (vec3s){
        {glms_vec3_dot(at->viewer, t), glms_vec3_dot(at->viewer, b), glms_vec3_dot(at->viewer, n)}};
}

TL_INLINE struct tl_look tl_look_evaluate(const struct tl_shade_part *part,
                                          const struct tl_detail_params *detail, const struct tl_look_at *at)
{
    const tl_material *material = part->material;
    struct tl_look look = {.normal = glms_vec3_scale(at->smooth, at->side),
                           .diffuse = material->diffuse,
                           .f0 = material->specular,
                           .glossiness = material->glossiness};
    if (!part->has_maps)
        return look;
    const struct tl_shade_map *maps = part->maps;
    if (maps[TL_MAP_DIFFUSE].texels)
        look.diffuse =
            tl_look_times(look.diffuse, tl_look_map(&maps[TL_MAP_DIFFUSE], maps[TL_MAP_DIFFUSE].texels, at));
    if (maps[TL_MAP_GLOSS].texels)
        look.glossiness *= tl_look_map(&maps[TL_MAP_GLOSS], maps[TL_MAP_GLOSS].texels, at)[0];
    if (maps[TL_MAP_SPECULAR].texels)
        look.f0 =
            tl_look_times(look.f0, tl_look_map(&maps[TL_MAP_SPECULAR], maps[TL_MAP_SPECULAR].texels, at));
    float u = 0, v = 0, level = 0;
    const struct tl_texels *tint = part->weave_tint;
    if (tint) {
        /* Read a level coarser where the spread of normals is kept, as by WEAVE_BIAS of material.glsl. */
        float wider = detail->minify != TL_DETAIL_MINIFY_NONE ? 2.0f : 1.0f;
        float x = wider * part->weave_scale[0] * (float)tint->widths[0],
              y = wider * part->weave_scale[1] * (float)tint->heights[0];
        u = part->weave_scale[0] * at->uv[0], v = part->weave_scale[1] * at->uv[1];
        level = tl_level_of(x * at->change[0][0], y * at->change[1][0], x * at->change[0][1],
                            y * at->change[1][1]);
        tl_quad texel = tl_texels_fetch(tint, u, v, level, false, false);
        look.diffuse = tl_look_times(look.diffuse, texel);
        look.glossiness += texel[3];
    }
    look.glossiness = tl_greater(tl_lesser(look.glossiness, 1), 0);
    if (maps[TL_MAP_OCCLUSION].texels) {
        float open = tl_look_map(&maps[TL_MAP_OCCLUSION], maps[TL_MAP_OCCLUSION].texels, at)[0];
        look.diffuse = glms_vec3_scale(look.diffuse, 1 + (open - 1) * material->occlusion_strength);
    }
    bool has_tangent = at->tangent.x != 0 || at->tangent.y != 0 || at->tangent.z != 0;
    if (part->has_bumps && has_tangent) {
        struct tl_bump_statistics bumps = tl_look_bumps(part, detail, at, u, v, level);
        look.normal = glms_vec3_scale(tl_look_bent(at, bumps.normal), at->side);
        look.glossiness =
            1 - tl_bump_statistics_roughness(detail, 1 - look.glossiness, &bumps, tl_look_local_viewer(at));
        look.diffuse = glms_vec3_scale(look.diffuse, detail_open(bumps.length));
    }
    return look;
}

#endif
