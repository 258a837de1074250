#include "render/shade/ratios.h"

#include "render/env/exponent.h"

#include "config/base/memory.h"
#include "render/shade/look.h"

#include <stdlib.h>
#include <string.h>

static void follow_surfaces(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    const bool have_fuzz = request->materials->have_fuzz;
    size_t vertices = 0;
    if (ratios->shapes_revision != request->shapes_revision)
        tl_vertex_rings_release(&ratios->rings);
    ratios->shapes_revision = request->shapes_revision;
    for (size_t s = 0; s < ranges->surface_count; s++)
        vertices += ranges->surfaces[s]->vertex_count;
    if (ratios->surface_count != ranges->surface_count || !ratios->first_vertex) {
        free(ratios->first_vertex);
        ratios->first_vertex = TL_NEW_ARRAY(size_t, ranges->surface_count + 1);
        ratios->surface_count = ranges->surface_count;
    }
    for (size_t s = 0; s < ranges->surface_count; s++)
        ratios->first_vertex[s + 1] = ratios->first_vertex[s] + ranges->surfaces[s]->vertex_count;
    if (vertices == ratios->vertex_count && have_fuzz == (ratios->fuzz != NULL))
        return;
    free(ratios->items);
    free(ratios->found);
    free(ratios->fuzz);
    free(ratios->stamps);
    ratios->fuzz = have_fuzz ? tl_alloc_lines(2 * vertices, sizeof *ratios->fuzz) : NULL;
    ratios->items = TL_NEW_ARRAY(struct tl_vertex_ratio, 2 * vertices);
    ratios->found = TL_NEW_ARRAY(struct tl_vertex_ratio, 2 * vertices);
    ratios->stamps = TL_NEW_ARRAY(uint32_t, 2 * vertices);
    ratios->vertex_count = vertices;
    ratios->update = 0;
}

static void reserve(struct tl_vertex_ratios *ratios, size_t count)
{
    if (count <= ratios->capacity)
        return;
    ratios->capacity = count + count / 4;
    ratios->taps = tl_resize(ratios->taps, ratios->capacity, sizeof *ratios->taps);
    ratios->places = tl_resize(ratios->places, ratios->capacity, sizeof *ratios->places);
    ratios->made = tl_resize(ratios->made, ratios->capacity, sizeof *ratios->made);
    tl_samples_reserve(&ratios->samples, ratios->capacity);
}

/* Corners of one part that are evaluated together. */
struct corner_lanes {
    struct tl_look_lanes look;
    struct {
        uint32_t seen, vertex;
        int corner; /* of the triangle `seen` */
        size_t surface_index;
    } items[TL_LANES];
};

/* A vertex has no neighbours to filter over: it looks like the mean of its maps, in the middle of bumps of
 * every direction. */
static void add_corner(struct corner_lanes *lanes, const struct tl_ratios_request *request, uint32_t seen,
                       size_t surface_index, const tl_surface *surface, uint32_t vertex, int corner)
{
    const float whole = 1e3f; /* UV units: all of any map */
    const vec3s up = {{0, 1, 0}};
    struct tl_look_lanes *look = &lanes->look;
    const int lane = look->count++;
    lanes->items[lane].seen = seen;
    lanes->items[lane].vertex = vertex;
    lanes->items[lane].corner = corner;
    lanes->items[lane].surface_index = surface_index;
    tl_lane_store(look->normal, lane, surface->normals[vertex]);
    tl_lane_store(look->viewer, lane,
                  direction_or(glms_vec3_sub(request->eye, surface->positions[vertex]), up));
    const vec4s tangent = surface->tangents ? surface->tangents[vertex] : (vec4s){{0, 0, 0, 0}};
    for (int c = 0; c < 4; c++)
        look->tangent[c][lane] = tangent.raw[c];
    look->side[lane] = seen & TL_SAMPLE_BACK ? -1.0f : 1.0f;
    look->uv[0][lane] = look->uv[1][lane] = 0.5f;
    look->change[0][0][lane] = look->change[1][1][lane] = whole;
    look->change[0][1][lane] = look->change[1][0][lane] = 0;
    look->slopes[0][lane] = look->slopes[1][lane] = 1;
    look->triangle[lane] = TL_NO_TRIANGLE;
}

/* A sample at a corner of a seen triangle, to be summed like any other. */
static void place_sample(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request,
                         const struct corner_lanes *lanes, int lane)
{
    const struct tl_look_lanes *look = &lanes->look;
    const uint32_t seen = lanes->items[lane].seen, vertex = lanes->items[lane].vertex;
    const size_t surface_index = lanes->items[lane].surface_index;
    const bool back = seen & TL_SAMPLE_BACK;
    const int corner = lanes->items[lane].corner;
    const vec3s normal = glms_vec3_scale(tl_lane_vector(look->smooth, lane), look->side[lane]);
    const vec3s viewer = tl_lane_vector(look->viewer, lane);
    float cosine = tl_maxf(glms_vec3_dot(normal, viewer), 0);
    /* Facets need a viewer above the surface: one at the horizon stands for those below it. */
    const float minimum = 0.02f;
    vec3s seen_from = viewer;
    if (cosine < minimum)
        seen_from = direction_or(
            glms_vec3_add(viewer, glms_vec3_scale(normal, minimum - glms_vec3_dot(normal, viewer))), normal);
    const tl_quad diffuse = look->diffuse[lane], f0 = look->f0[lane];
    size_t i = ratios->count++;
    ratios->samples.items[i] =
        (tl_sample){.triangle = seen,
                    .weights = {corner == 0, corner == 1, corner == 2},
                    .cover = 1,
                    .point = glms_vec3_sub(request->eye, seen_from), /* compose takes the viewer from it */
                    .normal = normal,
                    .smooth = normal,
                    .mirror = mirror_direction(normal, viewer),
                    .glossiness = look->glossiness[lane],
                    .diffuse = {{diffuse[0], diffuse[1], diffuse[2]}},
                    .specular = {{f0[0], f0[1], f0[2]}},
                    .widening = {look->widening[0][lane], look->widening[1][lane], look->widening[2][lane]}};
    uint32_t value = tl_points_of_vertex(request->points, surface_index, vertex, back);
    ratios->taps[i] = (struct tl_taps){.point = {value, value, value}, .weight = {1}};
    ratios->places[i] = (uint32_t)(2 * (ratios->first_vertex[surface_index] + vertex) + back);
}

static void place_samples(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request,
                          struct corner_lanes *lanes)
{
    if (lanes->look.count == 0)
        return;
    tl_look_evaluate(&request->materials->detail, &lanes->look);
    for (int lane = 0; lane < lanes->look.count; lane++)
        place_sample(ratios, request, lanes, lane);
    lanes->look.count = 0;
}

/* Lists the place of a vertex that is seen; false when it was listed already, or made in the last update and
 * is not due. */
static bool list_place(struct tl_vertex_ratios *ratios, size_t place, bool all)
{
    uint32_t before = ratios->stamps[place];
    ratios->stamps[place] = ratios->update;
    bool is_known = !all && before != 0 && before + 1 == ratios->update;
    return before != ratios->update && (!is_known || (place / 2 + ratios->update) % 2 != 0);
}

/* Lists a vertex as a corner of a triangle of its surface. `at`: the number of the index that names it. */
static void list_corner(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request,
                        struct corner_lanes *lanes, size_t surface_index, size_t at, bool back)
{
    const tl_surface *surface = request->ranges->surfaces[surface_index];
    const struct tl_shade_part *part =
        &request->materials
             ->parts[tl_shade_part_at(request->materials, surface, surface_index, (uint32_t)(at / 3))];
    if (lanes->look.part != part || lanes->look.count == TL_LANES)
        place_samples(ratios, request, lanes);
    lanes->look.part = part;
    reserve(ratios, ratios->count + TL_LANES);
    const uint32_t seen = request->ranges->first[surface_index] + (uint32_t)(at / 3);
    add_corner(lanes, request, seen | (back ? TL_SAMPLE_BACK : 0), surface_index, surface,
               surface->indices[at], (int)(at % 3));
}

/* A triangle that is seen. */
struct seen_triangle {
    const tl_surface *surface;
    size_t surface_index, number; /* in its surface */
    size_t first;                 /* place of its surface's vertex 0 on the side that is seen */
    uint32_t corners[3];
    bool back;
};

static struct seen_triangle find_seen(const struct tl_vertex_ratios *ratios,
                                      const struct tl_ratios_request *request, size_t i)
{
    const uint32_t number = request->ids->seen[i] & ~TL_SAMPLE_BACK;
    struct seen_triangle seen = {.back = request->ids->seen[i] & TL_SAMPLE_BACK};
    seen.surface = tl_triangle_find(request->ranges, number, seen.corners, &seen.surface_index);
    seen.number = number - request->ranges->first[seen.surface_index];
    seen.first = 2 * ratios->first_vertex[seen.surface_index] + (seen.back ? 1 : 0);
    return seen;
}

/* Vertices that triangles share are listed once, for the first of these. */
static void list_corners(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    bool all = ratios->update == 0 || ratios->light_revision != request->light_revision;
    ratios->light_revision = request->light_revision;
    ratios->count = 0;
    ratios->update++;
    struct corner_lanes lanes = {0};
    const bool sparse = tl_points_are_sparse(request->points);
    for (size_t i = 0; i < request->ids->seen_count; i++) {
        const struct seen_triangle seen = find_seen(ratios, request, i);
        const struct tl_light_mesh *mesh = seen.surface->light_mesh;
        for (size_t k = 0; k < 3; k++) {
            if (!sparse || tl_has_own_light(seen.surface, seen.corners[k])) {
                if (list_place(ratios, seen.first + 2 * (size_t)seen.corners[k], all))
                    list_corner(ratios, request, &lanes, seen.surface_index, 3 * seen.number + k, seen.back);
                continue;
            }
            const uint32_t *from = mesh->from[seen.corners[k]];
            for (int j = 0; j < 3; j++)
                if (list_place(ratios, seen.first + 2 * (size_t)from[j], all))
                    list_corner(ratios, request, &lanes, seen.surface_index, mesh->corners[from[j]],
                                seen.back);
        }
    }
    place_samples(ratios, request, &lanes);
    ratios->samples.count = ratios->samples.primary_count = ratios->count;
}

/* A vertex without light of its own has the mean of those from which it takes it. What is covered there has
 * a share only where all is: it is dark under what lies on it. */
static void take_mean(struct tl_vertex_ratios *ratios, const struct tl_light_mesh *mesh, uint32_t vertex,
                      size_t first)
{
    const size_t place = first + 2 * (size_t)vertex;
    struct tl_vertex_ratio mean = {0};
    float shares[3], sum = 0, fuzz[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const struct tl_vertex_ratio *from = &ratios->items[first + 2 * (size_t)mesh->from[vertex][k]];
        shares[k] = mesh->shares[vertex][k] * (1 - from->glossy[3]);
        sum += shares[k];
    }
    for (int k = 0; k < 3; k++) {
        const size_t from = first + 2 * (size_t)mesh->from[vertex][k];
        const float share = sum > 0 ? shares[k] / sum : mesh->shares[vertex][k];
        for (int c = 0; c < 3; c++) {
            mean.diffuse[c] += share * ratios->items[from].diffuse[c];
            mean.glossy[c] += share * ratios->items[from].glossy[c];
            fuzz[c] += ratios->fuzz ? share * ratios->fuzz[from][c] : 0;
        }
    }
    mean.glossy[3] = sum > 0 ? 0.0f : 1.0f;
    ratios->items[place] = mean;
    if (ratios->fuzz)
        memcpy(ratios->fuzz[place], fuzz, sizeof fuzz);
}

static void fill_seen(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    for (size_t i = 0; i < request->ids->seen_count; i++) {
        const struct seen_triangle seen = find_seen(ratios, request, i);
        for (int k = 0; k < 3; k++) {
            uint32_t *stamp = &ratios->stamps[seen.first + 2 * (size_t)seen.corners[k]];
            if (tl_has_own_light(seen.surface, seen.corners[k]) || *stamp == ratios->update)
                continue;
            *stamp = ratios->update;
            take_mean(ratios, seen.surface->light_mesh, seen.corners[k], seen.first);
        }
    }
}

/* ---- In motion: means over neighbours ---- */

/* The weight of a neighbour, where the vertex itself has 1. Means take away the noise of single rays, but
 * blur what differs: a gloss whose direction, and so the normal, changes along a fold; and the more regions
 * there are, the less noise there is. Satin and cotton in flights of 48 and 96 regions have less FLIP for
 * it, satin at 192 as much (docs/notes/budgets.md). */
static float neighbour_share(vec3s normal, vec3s other, float doubt)
{
    const float narrowness = 64;
    const float overlap = 1 / (1 + narrowness * glms_vec3_distance2(normal, other));
    return doubt * overlap * overlap;
}

static float doubt_of(int regions)
{
    const float single = 96.0f / (float)regions;
    return tl_minf(single * single, 1);
}

TL_CLONES static void smooth_place(struct tl_vertex_ratios *ratios, const tl_surface *surface, size_t first,
                                   size_t vertex, size_t side, float doubt)
{
    const struct tl_vertex_rings *rings = &ratios->rings;
    const uint32_t *ring = rings->neighbours + rings->first[first + vertex];
    const size_t place = 2 * (first + vertex) + side;
    struct tl_vertex_ratio sum = ratios->found[place];
    float shares = 1;
    for (uint32_t i = 0; i < rings->counts[first + vertex] && sum.glossy[3] == 0; i++) {
        const size_t from = 2 * (size_t)ring[i] + side;
        const struct tl_vertex_ratio *other = &ratios->found[from];
        if (ratios->stamps[from] != ratios->update || other->glossy[3] > 0)
            continue; /* not seen, or covered */
        const float share =
            neighbour_share(surface->normals[vertex], surface->normals[ring[i] - first], doubt);
        shares += share;
        for (int c = 0; c < 3; c++) {
            sum.diffuse[c] += share * other->diffuse[c];
            sum.glossy[c] += share * other->glossy[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        sum.diffuse[c] /= shares;
        sum.glossy[c] /= shares;
    }
    ratios->items[place] = sum;
}

static void smooth_seen(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    const float doubt = doubt_of(request->region_count);
    if (!ratios->rings.first)
        ratios->rings = tl_vertex_rings_make(request->ranges);
    for (size_t s = 0; s < ratios->surface_count; s++) {
        const tl_surface *surface = request->ranges->surfaces[s];
        const size_t first = ratios->first_vertex[s];
#pragma omp parallel for schedule(dynamic, 256)
        for (size_t v = 0; v < surface->vertex_count; v++)
            for (size_t side = 0; side < 2; side++)
                if (ratios->stamps[2 * (first + v) + side] == ratios->update)
                    smooth_place(ratios, surface, first, v, side, doubt);
    }
}

static void show_found(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    if (tl_points_are_sparse(request->points)) {
        smooth_seen(ratios, request);
        fill_seen(ratios, request);
        return;
    }
    for (size_t i = 0; i < ratios->count; i++)
        ratios->items[ratios->places[i]] = ratios->found[ratios->places[i]];
}

void tl_ratios_make(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request)
{
    follow_surfaces(ratios, request);
    list_corners(ratios, request);
    struct tl_compose_request compose = {.samples = &ratios->samples,
                                         .lights = request->lights,
                                         .lobes = request->lobes,
                                         .taps = ratios->taps,
                                         .environment_yaw = request->environment_yaw,
                                         .params = request->params,
                                         .bounce = request->bounce,
                                         .ranges = request->ranges,
                                         .any_layered = true,
                                         .eye = request->eye};
    compose.values = tl_points_values(request->points, &compose.stride);
    tl_compose_ratios(&compose, ratios->made);
    for (size_t i = 0; i < ratios->count; i++) {
        struct tl_vertex_ratio *ratio = &ratios->found[ratios->places[i]];
        bool covered = tl_points_is_covered(request->points, ratios->taps[i].point[0]);
        *ratio = (struct tl_vertex_ratio){.glossy = {0, 0, 0, covered ? 1.0f : 0.0f}};
        memcpy(ratio->diffuse, ratios->made[i].diffuse.raw, sizeof(vec3s));
        memcpy(ratio->glossy, ratios->made[i].glossy.raw, sizeof(vec3s));
        if (ratios->fuzz) {
            float *fuzz = ratios->fuzz[ratios->places[i]];
            memcpy(fuzz, ratios->made[i].fuzz.raw, sizeof(vec3s));
            fuzz[3] = 0;
        }
    }
    show_found(ratios, request);
}

void tl_ratios_release(struct tl_vertex_ratios *ratios)
{
    free(ratios->first_vertex);
    free(ratios->items);
    free(ratios->found);
    free(ratios->fuzz);
    free(ratios->stamps);
    tl_vertex_rings_release(&ratios->rings);
    free(ratios->taps);
    free(ratios->places);
    free(ratios->made);
    tl_samples_release(&ratios->samples);
    *ratios = (struct tl_vertex_ratios){0};
}

size_t tl_ratios_bytes(const struct tl_vertex_ratios *ratios)
{
    const size_t fuzz = ratios->fuzz ? sizeof *ratios->fuzz : 0;
    return 2 * ratios->vertex_count *
               (sizeof *ratios->items + sizeof *ratios->found + fuzz + sizeof *ratios->stamps) +
           tl_vertex_rings_bytes(&ratios->rings) +
           ratios->capacity *
               (sizeof(tl_sample) + sizeof *ratios->taps + sizeof *ratios->places + sizeof *ratios->made);
}
