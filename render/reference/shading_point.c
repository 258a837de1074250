#include "render/reference/shading_point.h"

#include "render/brdf/facets.h"
#include "render/construction/look.h"
#include "render/detail/bumps.h"
#include "render/detail/yarns.h"
#include "render/env/exponent.h"
#include "render/surfaces/surface_terms.h"
#include "render/surfaces/surfaces.h"

#include <math.h>

struct tl_ray_differential tl_camera_ray(const struct tl_view *view, int columns, int rows, int x, int y)
{
    float step_x = 2 / (float)columns, step_y = 2 / (float)rows;
    vec3s along = glms_vec3_add(view->forward, glms_vec3_scale(view->right, ((float)x + 0.5f) * step_x - 1));
    along = glms_vec3_add(along, glms_vec3_scale(view->up, 1 - ((float)y + 0.5f) * step_y));
    float length = glms_vec3_norm(along); /* metres along the ray per metre of depth */
    return (struct tl_ray_differential){.origin = view->eye,
                                        .direction = glms_vec3_divs(along, length),
                                        .from_m = view->near_m * length,
                                        .to_m = view->far_m * length,
                                        .across = glms_vec3_scale(view->right, step_x / length),
                                        .down = glms_vec3_scale(view->up, -step_y / length)};
}

/* A point of a surface with all inputs of its material. */
struct sample_place {
    const tl_material *material;
    const struct tl_reference_material *prepared;
    bool woven;
    float weave_scale[2]; /* repeats per UV unit */
    float uv_metres;
    float slopes[2]; /* factors on the weave's slopes along u and v (tl_slope_factors) */
    vec3s p_u, p_v;  /* tl_uv_derivatives of the triangle */
    const struct tl_detail_params *detail;
    struct tl_footprint footprint;
    bool sewn;
    ConstructionLook look; /* of seams and hems, where `sewn` */
    vec3s point, facet;    /* normal of the triangle, on the side of the viewer */
    vec3s normal;          /* interpolated, towards the front, not normalised */
    vec4s tangent;
    float side; /* 1 for the front; -1 for the back, which is a surface of its own with the whole frame turned
                   over */
};

static struct tl_footprint through_rows(const struct tl_footprint *at, const float *rows)
{
    const vec2s given[3] = {at->uv, at->across, at->down};
    vec2s made[3];
    for (int i = 0; i < 3; i++)
        made[i] = (vec2s){{rows[0] * given[i].x + rows[1] * given[i].y + (i == 0 ? rows[2] : 0),
                           rows[3] * given[i].x + rows[4] * given[i].y + (i == 0 ? rows[5] : 0)}};
    return (struct tl_footprint){made[0], made[1], made[2]};
}

static bool has_map(const struct sample_place *place, enum tl_map_use use)
{
    return place->prepared->maps[use].texture != NULL;
}

static vec4s map_at(const struct sample_place *place, enum tl_map_use use)
{
    const struct tl_reference_map *map = &place->prepared->maps[use];
    struct tl_footprint at = through_rows(&place->footprint, map->rows);
    return tl_map_texture_fetch(map->texture, &at, map->clamp_u, map->clamp_v);
}

/* The weave at a point. The footprint is doubled where the spread of normals is kept, as in surface.glsl. */
static vec4s weave_texel(const struct sample_place *place, const struct tl_map_texture *texture)
{
    const float rows[6] = {place->weave_scale[0], 0, 0, 0, place->weave_scale[1], 0};
    struct tl_footprint at = through_rows(&place->footprint, rows);
    if (tl_detail_wants_moments(place->detail)) {
        at.across = glms_vec2_scale(at.across, 2);
        at.down = glms_vec2_scale(at.down, 2);
    }
    return tl_map_texture_fetch(texture, &at, false, false);
}

static vec4s weave_at(const struct sample_place *place, enum tl_weave_use use)
{
    return weave_texel(place, place->prepared->weave[use]);
}

static Bumps bumps_of_map(vec4s texel, float scale_u, float scale_v)
{
    return bumps_of_texel((vec3s){{texel.x, texel.y, texel.z}}, scale_u, scale_v);
}

static Bumps bumps_of_means(vec4s means, float product, float scale_u, float scale_v)
{
    return bumps_of_moments(means.x, means.y, means.z, means.w, product, scale_u, scale_v);
}

static Bumps own_bumps(const struct sample_place *place)
{
    const float scale = place->material->normal_scale;
    if (!has_map(place, TL_MAP_NORMAL))
        return bumps_of_normal((vec3s){{0, 0, 1}});
    if (!place->prepared->own_moments)
        return bumps_of_map(map_at(place, TL_MAP_NORMAL), scale, scale);
    const struct tl_reference_map *map = &place->prepared->maps[TL_MAP_NORMAL];
    struct tl_footprint at = through_rows(&place->footprint, map->rows);
    const struct tl_moment_map *moments = place->prepared->own_moments;
    return bumps_of_means(tl_map_texture_fetch(&moments->texture, &at, map->clamp_u, map->clamp_v),
                          tl_map_texture_fetch(&moments->cross_texture, &at, map->clamp_u, map->clamp_v).x,
                          scale, scale);
}

static Bumps weave_bumps(const struct sample_place *place)
{
    const float height = place->detail->height_scale;
    const float u = height * place->slopes[0], v = height * place->slopes[1];
    const struct tl_moment_map *moments = place->prepared->weave_moments;
    if (!moments)
        return bumps_of_map(weave_at(place, TL_WEAVE_NORMAL), u, v);
    return bumps_of_means(weave_texel(place, &moments->texture),
                          weave_texel(place, &moments->cross_texture).x, u, v);
}

/* All bumps in tangent space: those of the normal map of the file plus those of the weave and of what is
 * sewn. */
static Bumps bumps_at(const struct sample_place *place)
{
    const ConstructionLook *sewn = &place->look;
    Bumps sum = own_bumps(place);
    if (place->woven)
        sum = bumps_add(sum, weave_bumps(place));
    if (place->sewn)
        sum = bumps_add(sum, bumps_of_slopes(sewn->slope_x, sewn->slope_y,
                                             (vec3s){{sewn->spread_x, sewn->spread_y, sewn->spread_xy}}));
    return sum;
}

static vec3s tangent_of(const struct sample_place *place)
{
    return (vec3s){{place->tangent.x, place->tangent.y, place->tangent.z}};
}

static bool has_bumps(const struct sample_place *place)
{
    return (has_map(place, TL_MAP_NORMAL) || place->woven || place->sewn) &&
           glms_vec3_norm2(tangent_of(place)) > 0;
}

/* Blinn's form needs no tangents, but heights, which slopes give with the nominal size of a UV unit. */
static bool has_blinn_normals(const struct sample_place *place)
{
    return tl_detail_has_derivatives(place->detail) && place->uv_metres > 0;
}

static vec3s blinn_normal(const struct sample_place *place, vec3s mapped, vec3s smooth)
{
    float metres = place->uv_metres / fmaxf(mapped.z, 1e-3f);
    return tl_blinn_normal(smooth, place->p_u, place->p_v, -mapped.x * metres,
                           mapped.y * metres); /* v runs down */
}

static vec3s times_map(vec3s colour, vec4s texel)
{
    return (vec3s){{colour.x * texel.x, colour.y * texel.y, colour.z * texel.z}};
}

static SurfaceColours colours_of(const struct sample_place *place)
{
    const tl_material *material = place->material;
    const struct tl_footprint *at = &place->footprint;
    SurfaceColours cloth = {material->diffuse, material->specular, material->glossiness};
    SurfaceTexels texels = surface_texels();
    if (has_map(place, TL_MAP_DIFFUSE))
        cloth.diffuse = times_map(cloth.diffuse, map_at(place, TL_MAP_DIFFUSE));
    if (has_map(place, TL_MAP_SPECULAR))
        cloth.f0 = times_map(cloth.f0, map_at(place, TL_MAP_SPECULAR));
    if (has_map(place, TL_MAP_GLOSS))
        cloth.glossiness *= map_at(place, TL_MAP_GLOSS).x;
    if (place->woven) {
        texels.tint = times_map(texels.tint, weave_at(place, TL_WEAVE_TINT));
        texels.gloss = weave_at(place, TL_WEAVE_GLOSS).x;
    }
    if (place->woven && material->weave->yarns)
        texels.yarns = tl_yarn_factor(material->weave->yarns, place->uv_metres, at->uv, at->across, at->down);
    if (has_map(place, TL_MAP_OCCLUSION))
        texels.occlusion = 1 + (map_at(place, TL_MAP_OCCLUSION).x - 1) * material->occlusion_strength;
    if (place->sewn) {
        texels.thread = place->look.thread;
        texels.shade = place->look.shade;
    }
    return surface_colours(cloth, texels, material->back.is_given && place->side < 0, material->back.diffuse,
                           material->back.specular, material->construction.thread);
}

static vec3s emission_of(const struct sample_place *place)
{
    const struct tl_reference_map *map = &place->prepared->emission;
    vec3s sent = place->material->emission;
    if (!map->texture)
        return sent;
    struct tl_footprint at = through_rows(&place->footprint, map->rows);
    return times_map(sent, tl_map_texture_fetch(map->texture, &at, map->clamp_u, map->clamp_v));
}

/* Sets tangent and handedness. On a back face normal and bitangent are turned over and the tangent is
 * kept. */
static void set_tangent(const struct sample_place *place, vec3s n, struct tl_shading_point *result)
{
    vec3s t = tangent_of(place);
    t = glms_vec3_sub(t, glms_vec3_scale(n, glms_vec3_dot(n, t)));
    result->tangent = direction_or(t, (vec3s){{0, 0, 0}});
    result->handedness = place->tangent.w * place->side;
}

static void set_layers(const struct sample_place *place, vec3s smooth, struct tl_shading_point *result)
{
    const tl_material *material = place->material;
    const struct tl_material_sample sample = {.material = material,
                                              .smooth = glms_vec3_scale(smooth, place->side),
                                              .normal = result->normal,
                                              .viewer = result->viewer,
                                              .tangent = result->tangent,
                                              .handedness = result->handedness,
                                              .side = place->side,
                                              .diffuse = result->albedo,
                                              .f0 = result->f0,
                                              .glossiness = result->glossiness,
                                              .widening = result->widening};
    struct tl_shading_layers *layers = &result->layers;
    result->layered = true;
    layers->openness = material->openness;
    layers->lobes = tl_material_lobes_of(&sample);
    const float base = layers->lobes.over.base;
    result->diffuse = glms_vec3_scale(result->diffuse, base);
    result->glossy = glms_vec3_scale(result->glossy, layers->lobes.is_faceted ? 0 : base);
    result->emission = glms_vec3_scale(result->emission, base);
    layers->transmitted = glms_vec3_scale(material->transmission, base);
}

static void set_lobes(const struct sample_place *place, const struct tl_reference_scene *scene, vec3s viewer,
                      vec3s smooth, struct tl_shading_point *result)
{
    const SurfaceColours colours = colours_of(place);
    const Bumps flat = bumps_of_normal((vec3s){{0, 0, 1}});
    const float own_g = place->material->glossiness;
    SurfaceShape shape = {glms_vec3_scale(smooth, place->side), colours.glossiness,
                          bumps_widening(place->detail->minify, 1 - own_g, 1 - colours.glossiness, flat), 1};
    if (has_bumps(place)) {
        const Bumps bumps = bumps_at(place);
        shape = surface_shape(place->detail->minify, bumps, place->normal, smooth, tangent_of(place),
                              place->tangent.w, place->side, viewer, own_g, colours.glossiness);
        if (has_blinn_normals(place))
            shape.normal = glms_vec3_scale(blinn_normal(place, bumps.normal, smooth), place->side);
    }
    const vec3s n = facing_normal(shape.normal, viewer);
    const float g = shape.glossiness;
    for (int i = 0; i < 3; i++)
        result->widening[i] = shape.widening.raw[i];
    float n_dot_v = glms_vec3_dot(n, viewer);
    result->viewer = viewer;
    result->glossiness = g;
    result->material = place->material;
    set_tangent(place, n, result);
    result->normal = n;
    result->axis = mirror_direction(n, viewer);
    result->exponent = tl_lobe_exponent(g);
    result->side = place->side;
    result->emission = emission_of(place);
    result->f0 = colours.f0;
    result->diffuse = result->albedo = glms_vec3_scale(colours.diffuse, shape.open);
    result->glossy = schlick_colour(result->f0, n_dot_v);
    if (scene->lobe == TL_LOBE_SINGLE && place->material->gloss.model == TL_REFLECT_PHONG) {
        result->axis = direction_or(glms_vec3_lerp(n, result->axis, g), n);
        result->glossy = glms_vec3_lerp(result->diffuse, result->glossy, g);
        result->diffuse = (vec3s){{0, 0, 0}};
    }
    if (tl_material_is_layered(place->material))
        set_layers(place, smooth, result);
}

static struct tl_shading_point point_of(const struct sample_place *place,
                                        const struct tl_reference_scene *scene,
                                        const struct tl_ray_differential *ray, vec3s smooth_point)
{
    struct tl_shading_point result = {.cover = 1};
    vec3s smooth = direction_or(place->normal, glms_vec3_scale(place->facet, place->side));
    set_lobes(place, scene, glms_vec3_negate(ray->direction), smooth, &result);
    bool geometric = scene->terminator == TL_TERMINATOR_GEOMETRIC;
    result.horizon = geometric ? place->facet : glms_vec3_scale(smooth, place->side);
    result.point = geometric ? place->point : smooth_point;
    return result;
}

/* The corners of the triangle that was hit. */
struct triangle_corners {
    vec3s positions[3], normals[3];
    vec4s tangents[3];
    vec2s uvs[3];
};

static struct triangle_corners corners_of(const tl_surface *surface, uint32_t triangle)
{
    struct triangle_corners corners = {0};
    for (size_t i = 0; i < 3; i++) {
        uint32_t vertex = surface->indices[3 * (size_t)triangle + i];
        corners.positions[i] = surface->positions[vertex];
        if (surface->normals)
            corners.normals[i] = surface->normals[vertex];
        if (surface->tangents)
            corners.tangents[i] = surface->tangents[vertex];
        if (surface->uvs)
            corners.uvs[i] = surface->uvs[vertex];
    }
    return corners;
}

static const struct tl_mesh_part *part_of(const tl_surface *surface, uint32_t triangle)
{
    size_t part = 0;
    while (part + 1 < surface->part_count &&
           3 * triangle - surface->parts[part].first_index >= surface->parts[part].index_count)
        part++;
    return &surface->parts[part];
}

/* Shift of the intersection of a ray with a plane when the direction of the ray changes by `change`. */
static vec3s shift_on_plane(const struct tl_ray_differential *ray, float distance, vec3s normal, vec3s change)
{
    float slope = glms_vec3_dot(normal, change) / glms_vec3_dot(normal, ray->direction);
    return glms_vec3_scale(glms_vec3_sub(change, glms_vec3_scale(ray->direction, slope)), distance);
}

/* Shift of (u, v) when a point moves within its triangle, by least squares in the plane of the triangle. */
static vec2s shift_of_uv(const struct triangle_corners *corners, vec3s move)
{
    vec3s e1 = glms_vec3_sub(corners->positions[1], corners->positions[0]);
    vec3s e2 = glms_vec3_sub(corners->positions[2], corners->positions[0]);
    float a = glms_vec3_norm2(e1), b = glms_vec3_dot(e1, e2), c = glms_vec3_norm2(e2);
    float p = glms_vec3_dot(e1, move), q = glms_vec3_dot(e2, move), determinant = a * c - b * b;
    float s = (c * p - b * q) / determinant, t = (a * q - b * p) / determinant;
    vec2s along = glms_vec2_scale(glms_vec2_sub(corners->uvs[1], corners->uvs[0]), s);
    return glms_vec2_add(along, glms_vec2_scale(glms_vec2_sub(corners->uvs[2], corners->uvs[0]), t));
}

static struct tl_footprint footprint_of(const struct triangle_corners *corners, const float weights[3],
                                        const struct tl_ray_differential *ray, float distance, vec3s facet)
{
    struct tl_footprint footprint = {0};
    for (int i = 0; i < 3; i++)
        footprint.uv = glms_vec2_add(footprint.uv, glms_vec2_scale(corners->uvs[i], weights[i]));
    if (glms_vec3_norm2(ray->across) > 0) {
        footprint.across = shift_of_uv(corners, shift_on_plane(ray, distance, facet, ray->across));
        footprint.down = shift_of_uv(corners, shift_on_plane(ray, distance, facet, ray->down));
    }
    return footprint;
}

static void set_material(const struct tl_reference_scene *scene, const struct tl_trace_hit *hit,
                         struct sample_place *place)
{
    const tl_surface *surface = &scene->surfaces[hit->surface];
    const struct tl_mesh_part *part = part_of(surface, hit->triangle);
    place->material = &surface->materials[part->material];
    place->prepared = &scene->materials[hit->surface].materials[part->material];
    place->uv_metres = part->uv_metres;
    place->detail = &scene->detail.params;
    place->woven = place->prepared->weave[TL_WEAVE_NORMAL] && part->uv_metres > 0;
    for (int i = 0; place->woven && i < 2; i++)
        place->weave_scale[i] = part->uv_metres / place->material->weave->size_m[i];
}

/* With the footprint as it is after displacement. */
static void set_construction(const struct tl_reference_scene *scene, const struct tl_trace_hit *hit,
                             struct sample_place *place)
{
    const tl_borders *borders = scene->surfaces[hit->surface].borders;
    if (!borders || borders->border_count == 0 || !place->prepared->construction)
        return;
    const struct tl_footprint *at = &place->footprint;
    place->sewn = true;
    place->look = tl_construction_look(place->prepared->construction, borders, hit->triangle, at->uv,
                                       at->across, at->down);
}

/* Origin of rays on the other side of the same sheet. */
static vec3s point_behind(const struct sample_place *place, const struct tl_reference_scene *scene,
                          const struct triangle_corners *corners, const float weights[3])
{
    vec3s normals[3], point = place->point;
    for (int i = 0; i < 3; i++)
        normals[i] = glms_vec3_negate(corners->normals[i]);
    if (scene->terminator != TL_TERMINATOR_GEOMETRIC)
        point = tl_smooth_point(point, corners->positions, normals, weights);
    return glms_vec3_sub(point, glms_vec3_scale(place->facet, scene->offset_m));
}

static struct tl_shading_point surface_point(const struct tl_reference_scene *scene,
                                             const struct tl_ray_differential *ray,
                                             const struct tl_trace_hit *hit)
{
    struct triangle_corners corners = corners_of(&scene->surfaces[hit->surface], hit->triangle);
    const float weights[3] = {1 - hit->u - hit->v, hit->u, hit->v};
    vec3s across = glms_vec3_cross(glms_vec3_sub(corners.positions[1], corners.positions[0]),
                                   glms_vec3_sub(corners.positions[2], corners.positions[0]));
    struct sample_place place = {.side = hit->back ? -1.0f : 1.0f};
    set_material(scene, hit, &place);
    place.facet = glms_vec3_scale(direction_or(across, glms_vec3_negate(ray->direction)), place.side);
    for (int i = 0; i < 3; i++) {
        place.point = glms_vec3_add(place.point, glms_vec3_scale(corners.positions[i], weights[i]));
        place.normal = glms_vec3_add(place.normal, glms_vec3_scale(corners.normals[i], weights[i]));
        place.tangent = glms_vec4_add(place.tangent, glms_vec4_scale(corners.tangents[i], weights[i]));
        corners.normals[i] = direction_or(glms_vec3_scale(corners.normals[i], place.side), place.facet);
    }
    place.slopes[0] = place.slopes[1] = 1;
    if (has_blinn_normals(&place))
        tl_uv_derivatives(corners.positions, corners.uvs, &place.p_u, &place.p_v); /* zeros: `smooth` */
    else if (!tl_detail_has_derivatives(place.detail))
        tl_slope_factors(corners.positions, corners.uvs, place.uv_metres, place.slopes);
    place.footprint = footprint_of(&corners, weights, ray, hit->distance_m, place.facet);
    vec3s outside = direction_or(place.normal, glms_vec3_scale(place.facet, place.side));
    vec3s view =
        into_tangent_space(glms_vec3_negate(ray->direction), outside, tangent_of(&place), place.tangent.w);
    place.footprint.uv = glms_vec2_add(
        place.footprint.uv, tl_reference_shift(place.detail, &place.prepared->heights, place.footprint.uv,
                                               place.uv_metres, view, place.side));
    set_construction(scene, hit, &place);
    vec3s smooth = tl_smooth_point(place.point, corners.positions, corners.normals, weights);
    struct tl_shading_point result = point_of(&place, scene, ray, smooth);
    result.distance_m = hit->distance_m;
    result.point = glms_vec3_add(result.point, glms_vec3_scale(place.facet, scene->offset_m));
    if (result.layered)
        result.layers.behind = point_behind(&place, scene, &corners, weights);
    return result;
}

/* Distance along the ray to the upper side of the ground; infinite when there is no intersection. */
static float distance_to_ground(const struct tl_reference_scene *scene, const struct tl_ray_differential *ray)
{
    if (!scene->ground || ray->direction.y > -1e-12f)
        return INFINITY;
    float distance = (scene->ground->centre.y - ray->origin.y) / ray->direction.y;
    return distance > ray->from_m && distance < ray->to_m ? distance : INFINITY;
}

static struct tl_shading_point ground_point(const struct tl_reference_scene *scene,
                                            const struct tl_ray_differential *ray, float distance)
{
    const struct tl_ground *ground = scene->ground;
    vec3s point = glms_vec3_add(ray->origin, glms_vec3_scale(ray->direction, distance));
    point.y = ground->centre.y;
    float cover = tl_ground_cover(ground, point.x, point.z);
    const struct sample_place place = {
        .detail = &scene->detail.params,
        .material = &ground->material,
        .prepared = &scene->materials[scene->surface_count].materials[0],
        .footprint.uv = {{(point.x - ground->centre.x) / ground->radius,
                          (point.z - ground->centre.z) / ground->radius}},
        .point = point,
        .facet = {{0, 1, 0}},
        .normal = {{0, 1, 0}},
        .tangent = {{1, 0, 0, 1}},
        .side = 1,
    };
    struct tl_shading_point result = point_of(&place, scene, ray, point);
    result.cover = cover;
    result.distance_m = distance;
    return result;
}

struct tl_shading_point tl_shading_point_find(const struct tl_reference_scene *scene,
                                              const struct tl_ray_differential *ray)
{
    struct tl_trace_hit hit =
        tl_trace_nearest(scene->trace, ray->origin, ray->direction, ray->from_m, ray->to_m);
    float to_ground = distance_to_ground(scene, ray);
    if (to_ground < (hit.surface == TL_TRACE_NONE ? INFINITY : hit.distance_m)) {
        struct tl_shading_point result = ground_point(scene, ray, to_ground);
        if (result.cover > 0)
            return result;
    }
    return hit.surface == TL_TRACE_NONE ? (struct tl_shading_point){0} : surface_point(scene, ray, &hit);
}
