#include "render/reference/shading_point.h"

#include "config/memory.h"
#include "render/brdf/coat.h"
#include "render/detail/detail_terms.h"
#include "render/env/exponent.h"
#include "render/surfaces/surfaces.h"

#include <math.h>
#include <stdlib.h>

/* Of the distance that is safe at any price: still a hundred times the rounding of positions, and what rests
 * on a surface is seen as resting on it. */
#define OFFSET_SHARE 0.1f

struct look_map {
    const struct tl_map_texture *texture; /* NULL: none */
    bool clamp_u, clamp_v;
    float rows[6]; /* of its UV transform */
};

struct look_material {
    struct look_map maps[TL_MAP_USES];
    const struct tl_map_texture *weave[TL_WEAVE_USES];
    const struct tl_map_texture *own_moments, *weave_moments; /* NULL: none */
    struct tl_detail_heights heights;                         /* of its first part; empty: none */
};

struct tl_surface_materials {
    size_t count;
    struct look_material *materials;
};

static const struct tl_map_texture *find_texture(struct tl_reference_scene *scene, const tl_image *image,
                                                 bool colour)
{
    if (!image)
        return NULL;
    for (size_t i = 0; i < scene->texture_count; i++)
        if (scene->textures[i]->image == image && scene->textures[i]->colour == colour)
            return scene->textures[i];
    scene->textures = tl_resize(scene->textures, scene->texture_count + 1, sizeof(struct tl_map_texture *));
    struct tl_map_texture *texture = TL_NEW(struct tl_map_texture);
    *texture = tl_map_texture_make(image, colour);
    scene->textures[scene->texture_count++] = texture;
    return texture;
}

static struct look_material make_material(struct tl_reference_scene *scene, const tl_material *material)
{
    const struct tl_map *maps[TL_MAP_USES] = {[TL_MAP_DIFFUSE] = &material->diffuse_map,
                                              [TL_MAP_NORMAL] = &material->normal_map,
                                              [TL_MAP_GLOSS] = &material->gloss_map,
                                              [TL_MAP_SPECULAR] = &material->specular_map,
                                              [TL_MAP_OCCLUSION] = &material->occlusion_map};
    struct look_material look = {0};
    for (enum tl_map_use use = 0; use < TL_MAP_USES; use++) {
        bool colour = use == TL_MAP_DIFFUSE || use == TL_MAP_SPECULAR;
        look.maps[use] = (struct look_map){.texture = find_texture(scene, maps[use]->image, colour),
                                           .clamp_u = maps[use]->clamp_u,
                                           .clamp_v = maps[use]->clamp_v};
        tl_uv_transform_rows(&maps[use]->transform, look.maps[use].rows);
    }
    look.own_moments = tl_reference_moments(&scene->detail, material->normal_map.image);
    const tl_weave *weave = material->weave;
    if (weave && weave->size_m[0] > 0 && weave->size_m[1] > 0) {
        look.weave_moments = tl_reference_moments(&scene->detail, &weave->normal);
        look.weave[TL_WEAVE_NORMAL] = find_texture(scene, &weave->normal, false);
        look.weave[TL_WEAVE_GLOSS] = find_texture(scene, &weave->gloss, false);
        look.weave[TL_WEAVE_TINT] = find_texture(scene, &weave->tint, false);
    }
    return look;
}

static struct tl_surface_materials make_look(struct tl_reference_scene *scene, const tl_surface *surface)
{
    size_t count = 0;
    for (size_t p = 0; p < surface->part_count; p++) {
        size_t needed = (size_t)surface->parts[p].material + 1;
        count = needed > count ? needed : count;
    }
    struct tl_surface_materials look = {count, TL_NEW_ARRAY(struct look_material, count)};
    for (size_t m = 0; m < count; m++)
        look.materials[m] = make_material(scene, &surface->materials[m]);
    const struct tl_detail_params *detail = &scene->detail.params;
    for (size_t p = 0; p < surface->part_count && tl_detail_wants_heights(detail); p++) {
        const struct tl_mesh_part *part = &surface->parts[p];
        struct tl_detail_heights *heights = &look.materials[part->material].heights;
        if (!heights->image.texels)
            tl_detail_heights_make(&surface->materials[part->material], part->uv_metres, detail->height_scale,
                                   heights);
    }
    return look;
}

bool tl_reference_scene_make(const struct tl_reference_request *request, struct tl_reference_scene *out,
                             tl_error *error)
{
    const tl_frame *frame = request->frame;
    const struct tl_ground *ground = request->ground;
    *out = (struct tl_reference_scene){.surfaces = frame->surfaces,
                                       .surface_count = frame->surface_count,
                                       .ground = ground,
                                       .lobe = request->lobe,
                                       .terminator = request->params->terminator,
                                       .detail.params = *request->detail,
                                       .reflect = request->reflect_scene};
    out->looks = TL_NEW_ARRAY(struct tl_surface_materials, out->surface_count + 1);
    for (size_t i = 0; i < out->surface_count; i++)
        out->looks[i] = make_look(out, &frame->surfaces[i]);
    if (ground)
        out->looks[out->surface_count] = make_look(out, &ground->surface);
    out->lamp_count = tl_lamps_lit(frame, out->lamps);
    tl_sky_make(frame->environment, frame->environment_yaw, &out->sky);
    out->trace = tl_trace_create(error);
    if (!out->trace || !tl_trace_update(out->trace, out->surfaces, out->surface_count, error)) {
        tl_reference_scene_release(out);
        return false;
    }
    out->offset_m = OFFSET_SHARE * tl_trace_offset(out->trace);
    return true;
}

void tl_reference_scene_release(struct tl_reference_scene *scene)
{
    for (size_t i = 0; scene->looks && i <= scene->surface_count; i++) {
        for (size_t m = 0; m < scene->looks[i].count; m++)
            tl_detail_heights_release(&scene->looks[i].materials[m].heights);
        free(scene->looks[i].materials);
    }
    tl_reference_detail_release(&scene->detail);
    free(scene->looks);
    for (size_t i = 0; i < scene->texture_count; i++) {
        tl_map_texture_release(scene->textures[i]);
        free(scene->textures[i]);
    }
    free(scene->textures);
    tl_sky_release(&scene->sky);
    tl_trace_destroy(&scene->trace);
    *scene = (struct tl_reference_scene){0};
}

struct tl_ray_differential tl_camera_ray(const struct tl_view *view, int columns, int rows, int x, int y)
{
    float step_x = 2 / (float)columns, step_y = 2 / (float)rows;
    vec3s along = glms_vec3_add(view->forward, glms_vec3_scale(view->right, ((float)x + 0.5f) * step_x - 1));
    along = glms_vec3_add(along, glms_vec3_scale(view->up, 1 - ((float)y + 0.5f) * step_y));
    float length = glms_vec3_norm(along); /* metres of the ray for each metre of depth */
    return (struct tl_ray_differential){.origin = view->eye,
                                        .direction = glms_vec3_divs(along, length),
                                        .from_m = view->near_m * length,
                                        .to_m = view->far_m * length,
                                        .across = glms_vec3_scale(view->right, step_x / length),
                                        .down = glms_vec3_scale(view->up, -step_y / length)};
}

/* A point of a surface with all that its material is asked with. */
struct place {
    const tl_material *material;
    const struct look_material *look;
    bool woven;
    float weave_scale[2]; /* repeats per UV unit */
    float uv_metres;
    const struct tl_detail_params *detail;
    struct tl_footprint footprint;
    vec3s point, facet; /* normal of the triangle, on the viewer's side */
    vec3s normal;       /* interpolated, towards the outside, as long as it comes out */
    vec4s tangent;
    float
        side; /* 1, or -1 where the back is seen: it is a surface of its own, whose whole frame turns over */
};

static vec3s direction_or(vec3s v, vec3s fallback)
{
    float square = glms_vec3_norm2(v);
    return square > 1e-30f && isfinite(square) ? glms_vec3_scale(v, 1 / sqrtf(square)) : fallback;
}

static struct tl_footprint through_rows(const struct tl_footprint *at, const float *rows)
{
    const vec2s given[3] = {at->uv, at->across, at->down};
    vec2s made[3];
    for (int i = 0; i < 3; i++)
        made[i] = (vec2s){{rows[0] * given[i].x + rows[1] * given[i].y + (i == 0 ? rows[2] : 0),
                           rows[3] * given[i].x + rows[4] * given[i].y + (i == 0 ? rows[5] : 0)}};
    return (struct tl_footprint){made[0], made[1], made[2]};
}

static bool has_map(const struct place *place, enum tl_map_use use)
{
    return place->look->maps[use].texture != NULL;
}

static vec4s map_at(const struct place *place, enum tl_map_use use)
{
    const struct look_map *map = &place->look->maps[use];
    struct tl_footprint at = through_rows(&place->footprint, map->rows);
    return tl_map_texture_fetch(map->texture, &at, map->clamp_u, map->clamp_v);
}

/* A level coarser where the spread of normals is kept, as surface.glsl has it. */
static vec4s weave_texel(const struct place *place, const struct tl_map_texture *texture)
{
    const float rows[6] = {place->weave_scale[0], 0, 0, 0, place->weave_scale[1], 0};
    struct tl_footprint at = through_rows(&place->footprint, rows);
    if (tl_detail_wants_moments(place->detail)) {
        at.across = glms_vec2_scale(at.across, 2);
        at.down = glms_vec2_scale(at.down, 2);
    }
    return tl_map_texture_fetch(texture, &at, false, false);
}

static vec4s weave_at(const struct place *place, enum tl_weave_use use)
{
    return weave_texel(place, place->look->weave[use]);
}

static vec3s decoded(vec4s texel)
{
    return (vec3s){{2 * texel.x - 1, 2 * texel.y - 1, 2 * texel.z - 1}};
}

static struct tl_bump_statistics own_bumps(const struct place *place)
{
    float scale = place->material->normal_scale;
    if (!has_map(place, TL_MAP_NORMAL))
        return tl_bump_statistics_of_normal((vec3s){{0, 0, 1}});
    if (place->look->own_moments) {
        const struct look_map *map = &place->look->maps[TL_MAP_NORMAL];
        struct tl_footprint at = through_rows(&place->footprint, map->rows);
        return tl_bump_statistics_of_moments(
            tl_map_texture_fetch(place->look->own_moments, &at, map->clamp_u, map->clamp_v), scale);
    }
    vec3s n = decoded(map_at(place, TL_MAP_NORMAL));
    return tl_bump_statistics_of_normal((vec3s){{scale * n.x, scale * n.y, n.z}});
}

static struct tl_bump_statistics weave_bumps(const struct place *place)
{
    float scale = place->detail->height_scale;
    if (place->look->weave_moments)
        return tl_bump_statistics_of_moments(weave_texel(place, place->look->weave_moments), scale);
    vec3s n = decoded(weave_at(place, TL_WEAVE_NORMAL));
    return tl_bump_statistics_of_normal((vec3s){{scale * n.x, scale * n.y, n.z}});
}

/* In tangent space: the file's map and the weave. */
static struct tl_bump_statistics bumps_at(const struct place *place)
{
    struct tl_bump_statistics own = own_bumps(place);
    if (!place->woven)
        return own;
    struct tl_bump_statistics weave = weave_bumps(place);
    return tl_bump_statistics_add(&own, &weave);
}

static bool has_bumps(const struct place *place)
{
    vec3s tangent = {{place->tangent.x, place->tangent.y, place->tangent.z}};
    return (has_map(place, TL_MAP_NORMAL) || place->woven) && glms_vec3_norm2(tangent) > 0;
}

static vec3s bent_normal(const struct place *place, vec3s mapped, vec3s smooth)
{
    vec3s tangent = {{place->tangent.x, place->tangent.y, place->tangent.z}};
    vec3s bitangent = glms_vec3_scale(glms_vec3_cross(place->normal, tangent), place->tangent.w);
    vec3s sum = glms_vec3_scale(tangent, mapped.x);
    sum = glms_vec3_add(sum, glms_vec3_scale(bitangent, mapped.y));
    sum = glms_vec3_add(sum, glms_vec3_scale(place->normal, mapped.z));
    return direction_or(sum, smooth);
}

/* A direction in the outside's tangent space. */
static vec3s into_tangent(const struct place *place, vec3s smooth, vec3s d)
{
    vec3s t = {{place->tangent.x, place->tangent.y, place->tangent.z}};
    t = direction_or(glms_vec3_sub(t, glms_vec3_scale(smooth, glms_vec3_dot(smooth, t))), (vec3s){{0, 0, 0}});
    vec3s b = glms_vec3_scale(glms_vec3_cross(smooth, t), place->tangent.w < 0 ? -1 : 1);
    return (vec3s){{glms_vec3_dot(d, t), glms_vec3_dot(d, b), glms_vec3_dot(d, smooth)}};
}

static float glossiness_of(const struct place *place)
{
    float g = place->material->glossiness;
    if (has_map(place, TL_MAP_GLOSS))
        g *= map_at(place, TL_MAP_GLOSS).x;
    if (place->woven)
        g += weave_at(place, TL_WEAVE_GLOSS).x;
    return fminf(fmaxf(g, 0), 1);
}

static vec3s times_map(vec3s colour, vec4s texel)
{
    return (vec3s){{colour.x * texel.x, colour.y * texel.y, colour.z * texel.z}};
}

static vec3s diffuse_of(const struct place *place)
{
    vec3s colour = place->material->diffuse;
    if (has_map(place, TL_MAP_DIFFUSE))
        colour = times_map(colour, map_at(place, TL_MAP_DIFFUSE));
    if (place->woven)
        colour = times_map(colour, weave_at(place, TL_WEAVE_TINT));
    if (has_map(place, TL_MAP_OCCLUSION)) {
        float open = map_at(place, TL_MAP_OCCLUSION).x;
        colour = glms_vec3_scale(colour, 1 + (open - 1) * place->material->occlusion_strength);
    }
    return colour;
}

static vec3s f0_of(const struct place *place)
{
    vec3s f0 = place->material->specular;
    return has_map(place, TL_MAP_SPECULAR) ? times_map(f0, map_at(place, TL_MAP_SPECULAR)) : f0;
}

/* Schlick's Fresnel term with f90 = min(50 F0, 1). */
static vec3s specular_of(vec3s f0, float n_dot_v)
{
    float away = 1 - fminf(fmaxf(n_dot_v, 0), 1), fifth = away * away * away * away * away;
    for (int c = 0; c < 3; c++)
        f0.raw[c] += (fminf(50 * f0.raw[c], 1) - f0.raw[c]) * fifth;
    return f0;
}

/* A back is a surface of its own: with its normal the bitangent turns over, the tangent stays. */
static void set_tangent(const struct place *place, vec3s n, struct tl_shading_point *spot)
{
    vec3s t = {{place->tangent.x, place->tangent.y, place->tangent.z}};
    t = glms_vec3_sub(t, glms_vec3_scale(n, glms_vec3_dot(n, t)));
    spot->tangent = direction_or(t, (vec3s){{0, 0, 0}});
    spot->handedness = place->tangent.w * place->side;
}

/* A coat levels the threads out: its mirror direction is the smooth surface's. */
static void set_coat(const struct place *place, vec3s smooth, struct tl_shading_point *spot)
{
    struct tl_shading_layers *layers = &spot->layers;
    vec3s n = glms_vec3_scale(smooth, place->side);
    float cosine = fmaxf(glms_vec3_dot(n, spot->viewer), 0);
    vec3s mirror = glms_vec3_sub(glms_vec3_scale(n, 2 * cosine), spot->viewer);
    layers->coat = place->material->coat * tl_coat_reflectance(cosine);
    layers->coat_axis = direction_or(mirror, n);
    layers->coat_exponent = tl_lobe_exponent(place->material->coat_glossiness);
}

static void set_layers(const struct place *place, vec3s smooth, struct tl_shading_point *spot)
{
    const tl_material *material = place->material;
    struct tl_shading_layers *layers = &spot->layers;
    spot->layered = true;
    layers->openness = material->openness;
    if (material->coat > 0)
        set_coat(place, smooth, spot);
    layers->base = 1 - layers->coat;
    layers->faceted = material->gloss.model != TL_REFLECT_PHONG;
    if (layers->faceted) {
        layers->brdf = tl_brdf_of(material, spot->f0, spot->glossiness);
        layers->frame = tl_brdf_frame_make(spot->normal, spot->tangent, spot->handedness,
                                           place->side * material->gloss.rotation);
        spot->glossy = (vec3s){{0, 0, 0}};
    }
    spot->diffuse = glms_vec3_scale(spot->diffuse, layers->base);
    spot->glossy = glms_vec3_scale(spot->glossy, layers->base);
    layers->transmitted = glms_vec3_scale(material->transmission, layers->base);
}

static void set_lobes(const struct place *place, const struct tl_reference_scene *scene, vec3s viewer,
                      vec3s smooth, struct tl_shading_point *spot)
{
    vec3s n = glms_vec3_scale(smooth, place->side);
    float g = glossiness_of(place), open = 1;
    if (has_bumps(place)) {
        struct tl_bump_statistics bumps = bumps_at(place);
        n = glms_vec3_scale(bent_normal(place, bumps.normal, smooth), place->side);
        g = 1 -
            tl_bump_statistics_roughness(place->detail, 1 - g, &bumps, into_tangent(place, smooth, viewer));
        open = detail_open(bumps.length);
    }
    float n_dot_v = glms_vec3_dot(n, viewer);
    vec3s mirror = glms_vec3_sub(glms_vec3_scale(n, 2 * fmaxf(n_dot_v, 0)), viewer);
    spot->viewer = viewer;
    spot->glossiness = g;
    spot->material = place->material;
    set_tangent(place, n, spot);
    spot->normal = n;
    spot->axis = direction_or(mirror, n);
    spot->exponent = tl_lobe_exponent(g);
    spot->side = place->side;
    spot->f0 = f0_of(place);
    spot->diffuse = spot->albedo = glms_vec3_scale(diffuse_of(place), open);
    spot->glossy = specular_of(spot->f0, n_dot_v);
    if (scene->lobe == TL_LOBE_SINGLE && place->material->gloss.model == TL_REFLECT_PHONG) {
        spot->axis = direction_or(glms_vec3_lerp(n, mirror, g), n);
        spot->glossy = glms_vec3_lerp(spot->diffuse, spot->glossy, g);
        spot->diffuse = (vec3s){{0, 0, 0}};
    }
    if (tl_material_is_layered(place->material))
        set_layers(place, smooth, spot);
}

static struct tl_shading_point spot_of(const struct place *place, const struct tl_reference_scene *scene,
                                       const struct tl_ray_differential *ray, vec3s smooth_point)
{
    struct tl_shading_point spot = {.cover = 1};
    vec3s smooth = direction_or(place->normal, glms_vec3_scale(place->facet, place->side));
    set_lobes(place, scene, glms_vec3_negate(ray->direction), smooth, &spot);
    bool geometric = scene->terminator == TL_TERMINATOR_GEOMETRIC;
    spot.horizon = geometric ? place->facet : glms_vec3_scale(smooth, place->side);
    spot.point = geometric ? place->point : smooth_point;
    return spot;
}

/* A triangle that was hit. */
struct corners {
    vec3s positions[3], normals[3];
    vec4s tangents[3];
    vec2s uvs[3];
};

static struct corners corners_of(const tl_surface *surface, uint32_t triangle)
{
    struct corners corners = {0};
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

/* How far the point where a ray meets a plane moves when the ray's direction changes by `change`. */
static vec3s shift_on_plane(const struct tl_ray_differential *ray, float distance, vec3s normal, vec3s change)
{
    float slope = glms_vec3_dot(normal, change) / glms_vec3_dot(normal, ray->direction);
    return glms_vec3_scale(glms_vec3_sub(change, glms_vec3_scale(ray->direction, slope)), distance);
}

/* How far (u, v) moves when a point moves within its triangle: the plane's coordinates by least squares. */
static vec2s shift_of_uv(const struct corners *corners, vec3s move)
{
    vec3s e1 = glms_vec3_sub(corners->positions[1], corners->positions[0]);
    vec3s e2 = glms_vec3_sub(corners->positions[2], corners->positions[0]);
    float a = glms_vec3_norm2(e1), b = glms_vec3_dot(e1, e2), c = glms_vec3_norm2(e2);
    float p = glms_vec3_dot(e1, move), q = glms_vec3_dot(e2, move), determinant = a * c - b * b;
    float s = (c * p - b * q) / determinant, t = (a * q - b * p) / determinant;
    vec2s along = glms_vec2_scale(glms_vec2_sub(corners->uvs[1], corners->uvs[0]), s);
    return glms_vec2_add(along, glms_vec2_scale(glms_vec2_sub(corners->uvs[2], corners->uvs[0]), t));
}

static struct tl_footprint footprint_of(const struct corners *corners, const float weights[3],
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
                         struct place *place)
{
    const tl_surface *surface = &scene->surfaces[hit->surface];
    const struct tl_mesh_part *part = part_of(surface, hit->triangle);
    place->material = &surface->materials[part->material];
    place->look = &scene->looks[hit->surface].materials[part->material];
    place->uv_metres = part->uv_metres;
    place->detail = &scene->detail.params;
    place->woven = place->look->weave[TL_WEAVE_NORMAL] && part->uv_metres > 0;
    for (int i = 0; place->woven && i < 2; i++)
        place->weave_scale[i] = part->uv_metres / place->material->weave->size_m[i];
}

/* Where the same sheet's other side is looked at from. */
static vec3s point_behind(const struct place *place, const struct tl_reference_scene *scene,
                          const struct corners *corners, const float weights[3])
{
    vec3s normals[3], point = place->point;
    for (int i = 0; i < 3; i++)
        normals[i] = glms_vec3_negate(corners->normals[i]);
    if (scene->terminator != TL_TERMINATOR_GEOMETRIC)
        point = tl_smooth_point(point, corners->positions, normals, weights);
    return glms_vec3_sub(point, glms_vec3_scale(place->facet, scene->offset_m));
}

static struct tl_shading_point surface_spot(const struct tl_reference_scene *scene,
                                            const struct tl_ray_differential *ray,
                                            const struct tl_trace_hit *hit)
{
    struct corners corners = corners_of(&scene->surfaces[hit->surface], hit->triangle);
    const float weights[3] = {1 - hit->u - hit->v, hit->u, hit->v};
    vec3s across = glms_vec3_cross(glms_vec3_sub(corners.positions[1], corners.positions[0]),
                                   glms_vec3_sub(corners.positions[2], corners.positions[0]));
    struct place place = {.side = hit->back ? -1.0f : 1.0f};
    set_material(scene, hit, &place);
    place.facet = glms_vec3_scale(direction_or(across, glms_vec3_negate(ray->direction)), place.side);
    for (int i = 0; i < 3; i++) {
        place.point = glms_vec3_add(place.point, glms_vec3_scale(corners.positions[i], weights[i]));
        place.normal = glms_vec3_add(place.normal, glms_vec3_scale(corners.normals[i], weights[i]));
        place.tangent = glms_vec4_add(place.tangent, glms_vec4_scale(corners.tangents[i], weights[i]));
        corners.normals[i] = direction_or(glms_vec3_scale(corners.normals[i], place.side), place.facet);
    }
    place.footprint = footprint_of(&corners, weights, ray, hit->distance_m, place.facet);
    vec3s outside = direction_or(place.normal, glms_vec3_scale(place.facet, place.side));
    vec3s view = into_tangent(&place, outside, glms_vec3_negate(ray->direction));
    place.footprint.uv = glms_vec2_add(
        place.footprint.uv, tl_reference_shift(place.detail, &place.look->heights, place.footprint.uv,
                                               place.uv_metres, view, place.side));
    vec3s smooth = tl_smooth_point(place.point, corners.positions, corners.normals, weights);
    struct tl_shading_point spot = spot_of(&place, scene, ray, smooth);
    spot.distance_m = hit->distance_m;
    spot.point = glms_vec3_add(spot.point, glms_vec3_scale(place.facet, scene->offset_m));
    if (spot.layered)
        spot.layers.behind = point_behind(&place, scene, &corners, weights);
    return spot;
}

/* How far along the ray the ground's plane is met; infinite when it is not. */
static float distance_to_ground(const struct tl_reference_scene *scene, const struct tl_ray_differential *ray)
{
    if (!scene->ground || fabsf(ray->direction.y) < 1e-12f)
        return INFINITY;
    float distance = (scene->ground->centre.y - ray->origin.y) / ray->direction.y;
    return distance > ray->from_m && distance < ray->to_m ? distance : INFINITY;
}

static struct tl_shading_point ground_spot(const struct tl_reference_scene *scene,
                                           const struct tl_ray_differential *ray, float distance)
{
    const struct tl_ground *ground = scene->ground;
    vec3s point = glms_vec3_add(ray->origin, glms_vec3_scale(ray->direction, distance));
    point.y = ground->centre.y;
    float cover = tl_ground_cover(ground, point.x, point.z), side = ray->direction.y < 0 ? 1.0f : -1.0f;
    const struct place place = {
        .detail = &scene->detail.params,
        .material = &ground->material,
        .look = &scene->looks[scene->surface_count].materials[0],
        .footprint.uv = {{(point.x - ground->centre.x) / ground->radius,
                          (point.z - ground->centre.z) / ground->radius}},
        .point = point,
        .facet = {{0, side, 0}},
        .normal = {{0, 1, 0}},
        .tangent = {{1, 0, 0, 1}},
        .side = side,
    };
    struct tl_shading_point spot = spot_of(&place, scene, ray, point);
    spot.cover = cover;
    spot.distance_m = distance;
    return spot;
}

struct tl_shading_point tl_shading_point_find(const struct tl_reference_scene *scene,
                                              const struct tl_ray_differential *ray)
{
    struct tl_trace_hit hit =
        tl_trace_nearest(scene->trace, ray->origin, ray->direction, ray->from_m, ray->to_m);
    float to_ground = distance_to_ground(scene, ray);
    if (to_ground < (hit.surface == TL_TRACE_NONE ? INFINITY : hit.distance_m)) {
        struct tl_shading_point spot = ground_spot(scene, ray, to_ground);
        if (spot.cover > 0)
            return spot;
    }
    return hit.surface == TL_TRACE_NONE ? (struct tl_shading_point){0} : surface_spot(scene, ray, &hit);
}
