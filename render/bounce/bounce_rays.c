#include "render/bounce/bounce_internal.h"

#include "config/colour/luminance.h"
#include "render/brdf/material_lobes.h"
#include "render/env/exponent.h"
#include "render/trace/spread.h"

#include <math.h>

/* Lobes that stand for the gloss of what a ray hits. */
#define HIT_LOBES 3

/* World direction -> direction in the environment. */
static vec3s into_environment(const struct tl_bounce_request *request, vec3s direction)
{
    return tl_turn_direction(direction, -request->environment_yaw);
}

/* ---- Findings of rays ---- */

struct bounce_ray {
    vec3s origin, direction;
    float cosine; /* of the angle to the normal */
};

/* Sums over the rays of a vertex. */
struct gathered {
    int count; /* rays over the hemisphere whose end is known */
    struct tl_bounced light;
    vec3s open, all; /* of the sky, by the cosine */
};

/* Adds light of a direction that was chosen by bounce_pdf. */
TL_INLINE void count_hit(struct tl_bounced *sum, const struct bounce_ray *ray, vec3s light)
{
    float basis[TL_BOUNCED_TERMS];
    const float angle = 1 / bounce_pdf(ray->cosine);
    bounced_basis(ray->direction, basis);
    sum->arrives = glms_vec3_muladds(light, ray->cosine * angle / (float)M_PI, sum->arrives);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TL_BOUNCED_TERMS; i++)
            sum->terms[c][i] += basis[i] * angle * light.raw[c];
}

/* Adds the sky of a direction, of which a share is seen. Both kinds of rays sample it: each counts by the sum
 * of both densities [Veach and Guibas 1995, the balance heuristic]. */
static void count_sky(const struct tl_bounce *bounce, const struct tl_bounce_request *request,
                      vec3s direction, float cosine, float share, struct gathered *sums)
{
    float basis[TL_BOUNCED_TERMS], pdf;
    vec3s sky = tl_bounce_sky_colour(&bounce->sky, into_environment(request, direction), &pdf);
    sky = glms_vec3_divs(sky, TL_BOUNCE_RAYS * bounce_pdf(cosine) + TL_BOUNCE_SKY_RAYS * pdf);
    sums->all = glms_vec3_muladds(sky, cosine, sums->all);
    sums->open = glms_vec3_muladds(sky, cosine * share, sums->open);
    const float luminance = tl_luminance(sky.raw);
    bounced_basis(direction, basis);
    for (int i = 0; i < TL_BOUNCED_TERMS; i++) {
        sums->light.terms[TL_BOUNCED_ALL_SKY][i] += basis[i] * luminance;
        sums->light.terms[TL_BOUNCED_OPEN_SKY][i] += basis[i] * luminance * share;
    }
}

static void add_to_packet(struct tl_ray_packet *packet, vec3s origin, vec3s direction)
{
    const int i = packet->count++;
    packet->origin_x[i] = origin.x;
    packet->origin_y[i] = origin.y;
    packet->origin_z[i] = origin.z;
    packet->direction_x[i] = direction.x;
    packet->direction_y[i] = direction.y;
    packet->direction_z[i] = direction.z;
}

/* The share of a ray's light that open sheets let through; 0 behind anything else. */
static float shown_to(const struct tl_bounce_request *request, vec3s origin, vec3s direction, float to_m)
{
    struct tl_ray_packet packet = {.to_m = to_m};
    float shown[16];
    add_to_packet(&packet, origin, direction);
    tl_trace_transmittance_packet(request->trace, &packet, shown);
    return shown[0];
}

static float open_towards(const struct tl_bounce_request *request, vec3s origin, vec3s direction)
{
    return shown_to(request, origin, direction, INFINITY) *
           tl_ground_visibility(request->ground, origin, direction);
}

/* ---- Hits ---- */

/* A point of a triangle that a ray hits. */
struct hit_place {
    size_t surface;
    uint32_t triangle;
    const uint32_t *corners;
    float weights[3];
    bool back;
};

static size_t corner_of(const struct tl_bounce *bounce, const struct hit_place *place, int k)
{
    return 2 * (bounce->first_vertex[place->surface] + place->corners[k]) + place->back;
}

/* Light that the corners of a triangle send to all sides, interpolated. False where that is not known yet. */
static bool sent_from(const struct tl_bounce *bounce, const struct hit_place *place, vec3s *sent)
{
    float known = 0;
    *sent = (vec3s){{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        const size_t at = corner_of(bounce, place, k);
        if (bounce->states[at] == TL_BOUNCE_UNKNOWN)
            continue;
        known += place->weights[k];
        *sent = glms_vec3_muladds(bounce->sent[at], place->weights[k], *sent);
    }
    if (!(known > 0.1f))
        return false;
    *sent = glms_vec3_divs(*sent, known);
    return true;
}

/* Light that the corners receive, interpolated, as far as it is known. */
static struct tl_bounced received_at(const struct tl_bounce *bounce, const struct hit_place *place)
{
    float known = 0;
    struct tl_bounced sum = {0}, mean = {0};
    for (int k = 0; k < 3; k++) {
        const size_t at = corner_of(bounce, place, k);
        if (bounce->states[at] != TL_BOUNCE_UNKNOWN) {
            known += place->weights[k];
            tl_bounced_add(&sum, &bounce->shown[at], place->weights[k]);
        }
    }
    tl_bounced_add(&mean, &sum, known > 0 ? 1 / known : 0);
    return mean;
}

static vec3s smooth_normal(const tl_surface *surface, const struct hit_place *place)
{
    vec3s normal = {{0, 0, 0}};
    for (int k = 0; k < 3; k++)
        normal = glms_vec3_muladds(surface->normals[place->corners[k]], place->weights[k], normal);
    return glms_vec3_normalize(place->back ? glms_vec3_negate(normal) : normal);
}

/* The lobes of a place's gloss towards a unit viewer above its normal; returns their number. */
static int lobes_of(const tl_surface *surface, const tl_material *material,
                    const struct tl_bounce_material *mean, const struct hit_place *place, vec3s normal,
                    vec3s viewer, struct tl_fitted_lobe lobes[TL_LOBE_FIT_SUM_MAX])
{
    const float smooth[3] = {0, 0, 0};
    const vec4s stored = surface->tangents ? surface->tangents[place->corners[0]] : (vec4s){{0, 0, 0, 1}};
    const struct tl_material_sample seen = {.material = material,
                                            .normal = normal,
                                            .viewer = viewer,
                                            .tangent = {{stored.x, stored.y, stored.z}},
                                            .handedness = stored.w,
                                            .side = place->back ? -1.0f : 1.0f,
                                            .diffuse = mean->diffuse[place->back],
                                            .f0 = mean->specular[place->back],
                                            .glossiness = material->glossiness,
                                            .widening = smooth};
    return tl_material_gloss_fit(&seen, HIT_LOBES, lobes);
}

/* Light that a place sends by its gloss to where a ray comes from: of the sky, and of what bounces to it. */
static vec3s gloss_from(const struct tl_bounce *bounce, const struct tl_bounce_request *request,
                        const struct hit_place *place, vec3s viewer)
{
    const tl_surface *surface = request->ranges->surfaces[place->surface];
    const size_t part = (size_t)(tl_triangle_part(surface, place->triangle) - surface->parts);
    const struct tl_bounce_material *mean = &bounce->materials[bounce->first_part[place->surface] + part];
    if (!mean->has_lobes)
        return (vec3s){{0, 0, 0}};
    const float grazing = 0.02f; /* the smooth normal may turn away where the triangle does not */
    const vec3s normal = smooth_normal(surface, place);
    const float lacking = grazing - glms_vec3_dot(normal, viewer);
    if (lacking > 0)
        viewer = glms_vec3_normalize(glms_vec3_muladds(normal, lacking, viewer));
    struct tl_fitted_lobe lobes[TL_LOBE_FIT_SUM_MAX];
    const int count = lobes_of(surface, &surface->materials[surface->parts[part].material], mean, place,
                               normal, viewer, lobes);
    const struct tl_bounced received = received_at(bounce, place);
    vec3s light = {{0, 0, 0}};
    for (int k = 0; k < count; k++) {
        const struct tl_bounced_lobe lobe = tl_bounced_lobe_of(normal, lobes[k].direction, lobes[k].exponent);
        const vec3s sky = tl_lobes_fetch(request->lobes, into_environment(request, lobes[k].direction),
                                         tl_exponent_blend(lobes[k].exponent));
        vec3s arrives = glms_vec3_scale(sky, tl_bounced_open_share(&received, &lobe));
        if (request->all)
            arrives = glms_vec3_add(arrives, tl_bounced_through(&received, &lobe));
        light = glms_vec3_muladd(lobes[k].weight, arrives, light);
    }
    return light;
}

/* The first hit of a ray, as far as it was not counted already. */
struct surface_hit {
    vec3s sent;
    float cover;    /* the share of the ray that ends there */
    float beyond_m; /* where the rest goes on */
    bool is_known;  /* false: the light that it sends is not known yet */
};

static struct surface_hit find_hit(struct tl_bounce *bounce, const struct tl_bounce_request *request,
                                   const struct bounce_ray *ray, float from_m)
{
    const vec3s origin = ray->origin, direction = ray->direction;
    struct tl_trace_hit hit = tl_trace_nearest(request->trace, origin, direction, from_m,
                                               tl_ground_distance(request->ground, origin, direction));
    struct surface_hit found = {.is_known = true, .beyond_m = INFINITY};
    struct hit_place place = {0};
    vec3s point;
    if (hit.surface != TL_TRACE_NONE) {
        place = (struct hit_place){.surface = hit.surface,
                                   .triangle = hit.triangle,
                                   .corners = request->ranges->surfaces[hit.surface]->indices +
                                              3 * (size_t)hit.triangle,
                                   .weights = {1 - hit.u - hit.v, hit.u, hit.v},
                                   .back = hit.back};
        tl_bounce_want(bounce, request->ranges, place.surface, place.corners, place.back);
        found.is_known = sent_from(bounce, &place, &found.sent);
        if (found.is_known)
            found.sent =
                glms_vec3_add(found.sent, gloss_from(bounce, request, &place, glms_vec3_negate(direction)));
        const size_t vertex = bounce->first_vertex[hit.surface] + place.corners[0];
        found.cover = 1 - bounce->materials[bounce->parts[vertex]].openness;
        found.beyond_m = hit.distance_m + tl_trace_offset(request->trace);
    } else if (tl_ground_meet(request->ground, origin, direction, &point, &place.triangle, place.weights)) {
        place.surface = request->ranges->surface_count - 1;
        place.corners = request->ground->indices + 3 * (size_t)place.triangle;
        tl_bounce_want(bounce, request->ranges, place.surface, place.corners, false);
        found.is_known = sent_from(bounce, &place, &found.sent);
        found.cover = tl_ground_cover(request->ground, point.x, point.z);
    }
    return found;
}

/* Follows one ray to its end, through open sheets: to a surface, the ground or the sky. The last sheet counts
 * as closed. */
static void follow_ray(struct tl_bounce *bounce, const struct tl_bounce_request *request,
                       const struct bounce_ray *ray, struct gathered *sums)
{
    vec3s sent = {{0, 0, 0}};
    float share = 1, from_m = 0;
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS && share > 0; layer++) {
        struct surface_hit found = find_hit(bounce, request, ray, from_m);
        if (!found.is_known) {
            count_sky(bounce, request, ray->direction, ray->cosine, 0, sums);
            return;
        }
        if (layer == TL_TRANSPARENCY_LAYERS && found.cover > 0)
            found.cover = 1;
        sent = glms_vec3_muladds(found.sent, share * found.cover, sent);
        share *= 1 - found.cover;
        from_m = found.beyond_m;
        if (!(from_m < INFINITY))
            break;
    }
    sums->count++;
    count_hit(&sums->light, ray, sent);
    count_sky(bounce, request, ray->direction, ray->cosine, share, sums);
}

/* ---- Arriving light ---- */

/* The bright parts of the sky, which rays over the hemisphere seldom find. */
TL_INLINE void see_sky(const struct tl_bounce *bounce, const struct tl_bounce_request *request, vec3s origin,
                       vec3s normal, uint32_t vertex, uint32_t round, struct gathered *sums)
{
    struct tl_ray_packet packet = {.to_m = INFINITY};
    vec3s directions[TL_BOUNCE_SKY_RAYS];
    float shown[16];
    for (uint32_t k = 0; k < TL_BOUNCE_SKY_RAYS; k++) {
        vec3s direction;
        vec2s at = spread_place(~vertex, round * TL_BOUNCE_SKY_RAYS + k);
        at.x = ((float)k + at.x) / TL_BOUNCE_SKY_RAYS;
        if (!tl_bounce_sky_sample(&bounce->sky, at, &direction))
            return;
        direction = tl_turn_direction(direction, request->environment_yaw);
        if (!(glms_vec3_dot(normal, direction) > 0))
            continue;
        directions[packet.count] = direction;
        add_to_packet(&packet, origin, direction);
    }
    if (packet.count == 0)
        return;
    tl_trace_transmittance_packet(request->trace, &packet, shown);
    for (int i = 0; i < packet.count; i++)
        count_sky(bounce, request, directions[i], glms_vec3_dot(normal, directions[i]),
                  shown[i] * tl_ground_visibility(request->ground, origin, directions[i]), sums);
}

static vec3s sunlight(const struct tl_bounce_request *request, vec3s origin, vec3s normal)
{
    vec3s light = {{0, 0, 0}};
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        vec3s direction = tl_turn_direction(sun->direction, request->environment_yaw);
        float cosine = glms_vec3_dot(normal, direction);
        if (!(cosine > 0))
            continue;
        float open = open_towards(request, origin, direction);
        light = glms_vec3_add(light, glms_vec3_scale(sun->power, open * cosine / (float)M_PI));
    }
    return light;
}

static vec3s lamplight(const struct tl_bounce_request *request, vec3s origin, vec3s normal)
{
    vec3s light = {{0, 0, 0}};
    for (size_t i = 0; i < request->lamp_count; i++) {
        const struct tl_lamplight lamp = tl_lamp_at(&request->lamps[i], origin, normal);
        float cosine = glms_vec3_dot(normal, lamp.direction);
        if (!(cosine > 0))
            continue;
        float open = shown_to(request, origin, lamp.direction, lamp.distance_m) *
                     tl_ground_visibility_to(request->ground, origin, lamp.direction, lamp.distance_m);
        light = glms_vec3_add(light, glms_vec3_scale(lamp.irradiance, open * cosine / (float)M_PI));
    }
    return light;
}

/* E / pi of the environment, of which so much is seen. */
static vec3s skylight(const struct tl_bounce_request *request, vec3s normal, const struct gathered *sums)
{
    vec3s light = tl_lobes_fetch(request->lobes, into_environment(request, normal),
                                 (struct tl_exponent_blend){.index = 0});
    for (int c = 0; c < 3; c++)
        light.raw[c] *= sums->all.raw[c] > 0 ? sums->open.raw[c] / sums->all.raw[c] : 1;
    return light;
}

/* The mean over rounds, of which `round` are in it. */
static vec3s mean_with(vec3s mean, vec3s light, uint32_t round)
{
    return glms_vec3_lerp(light, mean, (float)round / (float)(round + 1));
}

TL_CLONES void tl_bounce_trace(struct tl_bounce *bounce, const struct tl_bounce_request *request,
                               size_t surface, uint32_t vertex, bool back)
{
    const tl_surface *from = request->ranges->surfaces[surface];
    const size_t at = 2 * (bounce->first_vertex[surface] + vertex) + back;
    const vec3s zero = {{0, 0, 0}};
    const vec3s normal = glms_vec3_scale(from->normals[vertex], back ? -1.0f : 1.0f);
    const vec3s tangent =
        from->tangents
            ? (vec3s){{from->tangents[vertex].x, from->tangents[vertex].y, from->tangents[vertex].z}}
            : zero;
    const vec3s origin =
        glms_vec3_add(from->positions[vertex], glms_vec3_scale(normal, tl_trace_offset(request->trace)));
    const bool adds = !request->moved && bounce->states[at] >= TL_BOUNCE_FIRST;
    const uint32_t round = adds ? bounce->states[at] - TL_BOUNCE_FIRST + 1 : 0;
    struct gathered sums = {0};
    for (uint32_t k = 0; k < TL_BOUNCE_RAYS; k++) {
        const vec2s number = spread_place((uint32_t)at, round * TL_BOUNCE_RAYS + k);
        struct bounce_ray ray = {.origin = origin,
                                 .direction = bounce_direction(normal, tangent, number.x, number.y)};
        ray.cosine = glms_vec3_dot(normal, ray.direction);
        follow_ray(bounce, request, &ray, &sums);
    }
    see_sky(bounce, request, origin, normal, (uint32_t)at, round, &sums);
    const vec3s point_lit =
        glms_vec3_add(sunlight(request, origin, normal), lamplight(request, origin, normal));
    bounce->sky_lit[at] = mean_with(bounce->sky_lit[at], skylight(request, normal, &sums), round);
    bounce->point_lit[at] = mean_with(bounce->point_lit[at], point_lit, round);
    struct tl_bounced now = {0};
    tl_bounced_add(&now, &bounce->found[at], (float)round / (float)(round + 1));
    tl_bounced_add(&now, &sums.light, 1 / (fmaxf((float)sums.count, 1) * (float)(round + 1)));
    bounce->found[at] = now;
}
