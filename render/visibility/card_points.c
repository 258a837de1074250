#include "render/visibility/card_points.h"

#include "config/base/memory.h"
#include "render/gpu/shaders.h"
#include "render/trace/holes.h"
#include "render/trace/trace.h"
#include "render/visibility/cache_probes.h"
#include "render/visibility/card_points.glsl"

#include <epoxy/gl.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* ---- The mesh ---- */

static void free_shapes(struct tl_card_points *points)
{
    free(points->items);
    free(points->scratch.positions);
    free(points->scratch.normals);
    free(points->scratch.corners);
    free(points->scratch.openness);
    points->items = NULL;
    points->scratch = (struct tl_card_scratch){0};
}

static void count_shapes(struct tl_card_points *points, const struct tl_triangle_ranges *ranges)
{
    points->vertex_count = 0;
    for (size_t s = 0; s < ranges->surface_count; s++)
        points->vertex_count += ranges->surfaces[s]->vertex_count;
    points->triangle_count = ranges->first[ranges->surface_count];
    points->probe_count = 2 * points->vertex_count;
    free_shapes(points);
    points->items = TL_NEW_ARRAY(struct tl_cache_probe, points->probe_count);
    points->scratch.positions = TL_NEW_ARRAY(vec3s, points->vertex_count);
    points->scratch.normals = TL_NEW_ARRAY(vec3s, points->vertex_count);
    points->scratch.corners = TL_NEW_ARRAY(uint32_t, 3 * points->triangle_count);
    points->scratch.openness = TL_NEW_ARRAY(float, points->triangle_count);
}

/* Numbers of vertices through all surfaces, and what each triangle is. */
static void number_triangles(const struct tl_card_points *points, const struct tl_triangle_ranges *ranges,
                             uint32_t *facts)
{
    uint32_t first_vertex = 0;
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        const size_t first = ranges->first[s];
        for (size_t i = 0; i < surface->index_count; i++)
            points->scratch.corners[3 * first + i] = first_vertex + surface->indices[i];
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            const tl_material *material = &surface->materials[part->material];
            const size_t begin = first + part->first_index / 3;
            for (size_t t = begin; t < begin + part->index_count / 3; t++) {
                facts[t] = (uint32_t)s | (tl_material_transmits(material) ? CARD_TRANSMITS : 0);
                points->scratch.openness[t] = material->openness;
            }
        }
        first_vertex += (uint32_t)surface->vertex_count;
    }
}

struct numbered_probe {
    uint32_t of_cpu, vertex; /* the probe that the CPU has there */
};

static int compare_numbered(const void *a, const void *b)
{
    const struct numbered_probe *x = a, *y = b;
    if (x->of_cpu != y->of_cpu)
        return x->of_cpu < y->of_cpu ? -1 : 1;
    return x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

/* Puts both sides of all vertices in the CPU's order. `probe_of`: [vertex][front, back]. */
static void number_probes(const struct tl_card_points *points, const struct tl_triangle_ranges *ranges,
                          uint32_t *probe_of, uint32_t (*probes)[2])
{
    struct tl_cache_probes clusters = {0};
    struct numbered_probe *order = TL_NEW_ARRAY(struct numbered_probe, points->vertex_count);
    uint32_t first_vertex = 0, placed = 0;
    tl_cache_probes_build(ranges, &clusters);
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const uint32_t count = (uint32_t)ranges->surfaces[s]->vertex_count;
        for (uint32_t back = 0; back < 2; back++) {
            for (uint32_t v = 0; v < count; v++)
                order[v] = (struct numbered_probe){tl_cache_probe_at(&clusters, s, v, back), v};
            qsort(order, count, sizeof *order, compare_numbered);
            for (uint32_t i = 0; i < count; i++, placed++) {
                const uint32_t vertex = first_vertex + order[i].vertex;
                points->items[placed] =
                    (struct tl_cache_probe){.surface = (uint32_t)s, .vertex = order[i].vertex, .back = back};
                probe_of[2 * (size_t)vertex + back] = placed;
                probes[placed][0] = vertex | (back ? CARD_BACK : 0);
                probes[placed][1] = (uint32_t)s;
            }
        }
        first_vertex += count;
    }
    tl_cache_probes_release(&clusters);
    free(order);
}

static bool send_holes(struct tl_card_points *points, const struct tl_triangle_ranges *ranges,
                       tl_error *error)
{
    size_t count;
    uint32_t *words = tl_holes_make(ranges->surfaces, ranges->surface_count, &count);
    points->has_holes = count > 1;
    const bool done = tl_buffer_fill(&points->holes, points->gpu, words, count * sizeof *words, error);
    free(words);
    return done;
}

static bool send_shapes(struct tl_card_points *points, const struct tl_triangle_ranges *ranges,
                        tl_error *error)
{
    count_shapes(points, ranges);
    tl_gpu *gpu = points->gpu;
    const size_t triangles = points->triangle_count, probe_count = points->probe_count;
    uint32_t *facts = TL_NEW_ARRAY(uint32_t, triangles), *corners = TL_NEW_ARRAY(uint32_t, 6 * triangles);
    uint32_t *probe_of = TL_NEW_ARRAY(uint32_t, probe_count);
    uint32_t(*probes)[2] = tl_alloc(probe_count, sizeof *probes);
    number_triangles(points, ranges, facts);
    number_probes(points, ranges, probe_of, probes);
    for (size_t t = 0; t < triangles; t++)
        for (size_t back = 0; back < 2; back++)
            for (size_t k = 0; k < 3; k++)
                corners[3 * (2 * t + back) + k] =
                    probe_of[2 * (size_t)points->scratch.corners[3 * t + k] + back];
    const bool done =
        send_holes(points, ranges, error) &&
        tl_buffer_fill(&points->corners, gpu, points->scratch.corners, 3 * triangles * sizeof(uint32_t),
                       error) &&
        tl_buffer_fill(&points->triangle_facts, gpu, facts, triangles * sizeof *facts, error) &&
        tl_buffer_fill(&points->triangle_probes, gpu, corners, 6 * triangles * sizeof *corners, error) &&
        tl_buffer_fill(&points->probes, gpu, probes, probe_count * sizeof *probes, error) &&
        tl_buffer_reserve(&points->side_marks, gpu, 2 * triangles * sizeof(uint32_t), error) &&
        tl_buffer_reserve(&points->probe_marks, gpu, probe_count * sizeof(uint32_t), error) &&
        tl_buffer_reserve(&points->list, gpu, probe_count * sizeof(uint32_t), error) &&
        tl_buffer_reserve(&points->origins, gpu, probe_count * 2 * sizeof(vec4s), error) &&
        tl_buffer_reserve(&points->work, gpu, CARD_WORK_WORDS * sizeof(uint32_t), error);
    free(facts);
    free(corners);
    free(probe_of);
    free(probes);
    return done;
}

static bool send_motion(struct tl_card_points *points, const struct tl_triangle_ranges *ranges,
                        tl_error *error)
{
    size_t first = 0;
    for (size_t s = 0; s < ranges->surface_count; first += ranges->surfaces[s]->vertex_count, s++) {
        const tl_surface *surface = ranges->surfaces[s];
        memcpy(points->scratch.positions + first, surface->positions, surface->vertex_count * sizeof(vec3s));
        memcpy(points->scratch.normals + first, surface->normals, surface->vertex_count * sizeof(vec3s));
    }
    const size_t bytes = points->vertex_count * sizeof(vec3s);
    return tl_buffer_fill(&points->positions, points->gpu, points->scratch.positions, bytes, error) &&
           tl_buffer_fill(&points->normals, points->gpu, points->scratch.normals, bytes, error);
}

static bool make_programs(struct tl_card_points *points, tl_error *error)
{
    static const char *const files[TL_CARD_POINTS_PROGRAMS] = {[TL_CARD_MARK] = "mark.comp",
                                                               [TL_CARD_SEEN] = "seen.comp",
                                                               [TL_CARD_GATHER] = "gather.comp",
                                                               [TL_CARD_PLACE] = "place.comp",
                                                               [TL_CARD_TRACE] = "visible.comp"};
    for (int i = 0; i < TL_CARD_POINTS_PROGRAMS; i++)
        if (!points->programs[i].id && !tl_program_create_compute(points->gpu, tl_embedded_shaders, files[i],
                                                                  NULL, &points->programs[i], error))
            return false;
    return true;
}

bool tl_card_points_follow(struct tl_card_points *points, tl_gpu *gpu,
                           const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                           uint64_t shapes_revision, tl_error *error)
{
    points->gpu = gpu;
    if (!make_programs(points, error))
        return false;
    if (!points->has_shapes || points->shapes_revision != shapes_revision) {
        points->has_shapes = send_shapes(points, ranges, error);
        points->shapes_revision = shapes_revision;
    }
    if (!points->has_shapes || !send_motion(points, ranges, error))
        return false;
    const size_t casters = ranges->first[ranges->surface_count - (ground ? 1 : 0)];
    const struct tl_tree_request request = {.positions = points->scratch.positions,
                                            .corners = points->scratch.corners,
                                            .openness = points->scratch.openness,
                                            .triangle_count = points->triangle_count,
                                            .caster_count = casters,
                                            .topology_revision = shapes_revision,
                                            .position_buffer = &points->positions,
                                            .corner_buffer = &points->corners};
    const struct tl_box box = tl_box_of(points->scratch.positions,
                                        points->vertex_count - (ground ? ground->surface.vertex_count : 0));
    points->offset_m = tl_trace_offset_in(box.lower, box.upper);
    return tl_tree_buffers_update(&points->tree, gpu, &request, error);
}

/* ---- Lists and rays ---- */

static void use(const struct tl_card_points *points, int program)
{
    const tl_buffer *const bound[] = {[CARD_POSITIONS] = &points->positions,
                                      [CARD_NORMALS] = &points->normals,
                                      [CARD_FACTS] = &points->triangle_facts,
                                      [CARD_PROBES] = &points->probes,
                                      [CARD_CORNERS] = &points->triangle_probes,
                                      [CARD_SIDES] = &points->side_marks,
                                      [CARD_MARKS] = &points->probe_marks,
                                      [CARD_LIST] = &points->list,
                                      [CARD_WORK] = &points->work,
                                      [CARD_ORIGINS] = &points->origins};
    glUseProgram(points->programs[program].id);
    for (unsigned i = 0; i < TL_COUNT(bound); i++)
        tl_buffer_bind(bound[i], i);
    if (points->values.id) {
        tl_buffer_bind(&points->directions, CARD_DIRECTIONS);
        tl_buffer_bind(&points->values, CARD_VALUES);
    }
    tl_tree_buffers_bind(&points->tree, CARD_TREE);
    tl_buffer_bind(&points->holes, CARD_HOLES);
}

void tl_card_points_list(struct tl_card_points *points, const tl_texture *ids, int count)
{
    uint32_t work[CARD_WORK_WORDS] = {0};
    for (int i = 1; i < 3; i++)
        work[CARD_GROUPS + i] = work[CARD_BY_REGIONS + i] = 1;
    tl_buffer_write(&points->work, 0, work, sizeof work);
    points->frame++;
    use(points, TL_CARD_MARK);
    glUniform1ui(0, points->frame);
    for (int i = 0; i < count; i++) {
        glBindTextureUnit(0, ids[i].id);
        tl_gpu_dispatch(tl_gpu_groups((size_t)ids->width, 8), tl_gpu_groups((size_t)ids->height, 8), 1);
    }
    tl_gpu_barrier();
    glUseProgram(points->programs[TL_CARD_SEEN].id);
    glUniform1ui(0, points->frame);
    glUniform1ui(1, (GLuint)(2 * points->triangle_count));
    tl_gpu_dispatch(tl_gpu_groups(2 * points->triangle_count, 64), 1, 1);
    tl_gpu_barrier();
    glUseProgram(points->programs[TL_CARD_GATHER].id);
    glUniform1ui(0, points->frame);
    glUniform1ui(1, (GLuint)points->probe_count);
    tl_gpu_dispatch(tl_gpu_groups(points->probe_count, 256), 1, 1);
    tl_gpu_barrier();
}

static bool send_directions(struct tl_card_points *points, const struct tl_card_points_light *light,
                            tl_error *error)
{
    const size_t count = (size_t)light->region_count * (size_t)light->ray_count;
    const size_t words = ((size_t)light->region_count + 3) / 4 * points->probe_count;
    vec4s *directions = TL_NEW_ARRAY(vec4s, count);
    for (size_t i = 0; i < count; i++)
        directions[i] = glms_vec4(light->directions[i], 0);
    const bool done =
        tl_buffer_fill(&points->directions, points->gpu, directions, count * sizeof *directions, error) &&
        tl_buffer_reserve(&points->values, points->gpu, words * sizeof(uint32_t), error);
    free(directions);
    return done;
}

bool tl_card_points_trace(struct tl_card_points *points, const struct tl_card_points_light *light,
                          tl_error *error)
{
    const uint32_t region_groups = ((uint32_t)light->region_count + 3) / 4;
    const struct tl_ground *ground = light->ground;
    if (!send_directions(points, light, error))
        return false;
    tl_buffer_write(&points->work, (CARD_BY_REGIONS + 1) * sizeof region_groups, &region_groups,
                    sizeof region_groups);
    use(points, TL_CARD_PLACE);
    glUniform1f(0, points->offset_m);
    tl_gpu_dispatch_indirect(&points->work, CARD_GROUPS * sizeof(uint32_t));
    tl_gpu_barrier();
    glUseProgram(points->programs[TL_CARD_TRACE].id);
    glUniform1ui(0, (GLuint)light->region_count);
    glUniform1ui(1, (GLuint)light->ray_count);
    glUniform1ui(2, (GLuint)points->probe_count);
    glUniform4f(3, ground ? ground->centre.x : 0, ground ? ground->centre.y : 0,
                ground ? ground->centre.z : 0, ground ? ground->radius : 0);
    tl_gpu_dispatch_indirect(&points->work, CARD_BY_REGIONS * sizeof(uint32_t));
    tl_gpu_barrier();
    return true;
}

bool tl_card_points_reload(struct tl_card_points *points, tl_error *error)
{
    for (int i = 0; i < TL_CARD_POINTS_PROGRAMS; i++)
        if (points->programs[i].id && !tl_program_reload(&points->programs[i], error))
            return false;
    return tl_tree_buffers_reload(&points->tree, error);
}

#define BUFFERS(points)                                                                                      \
    {                                                                                                        \
        &(points)->positions, &(points)->normals, &(points)->corners, &(points)->triangle_facts,             \
            &(points)->probes, &(points)->triangle_probes, &(points)->holes, &(points)->side_marks,          \
            &(points)->probe_marks, &(points)->list, &(points)->work, &(points)->origins,                    \
            &(points)->directions, &(points)->values                                                         \
    }

void tl_card_points_release(struct tl_card_points *points)
{
    tl_buffer *const buffers[] = BUFFERS(points);
    for (size_t i = 0; i < TL_COUNT(buffers); i++)
        tl_buffer_destroy(buffers[i]);
    for (int i = 0; i < TL_CARD_POINTS_PROGRAMS; i++)
        tl_program_destroy(&points->programs[i]);
    tl_tree_buffers_release(&points->tree);
    free_shapes(points);
    *points = (struct tl_card_points){0};
}

size_t tl_card_points_bytes(const struct tl_card_points *points)
{
    const tl_buffer *const buffers[] = BUFFERS(points);
    size_t bytes = tl_tree_buffers_bytes(&points->tree);
    for (size_t i = 0; i < TL_COUNT(buffers); i++)
        bytes += buffers[i]->bytes;
    return bytes + points->probe_count * sizeof *points->items + points->vertex_count * 2 * sizeof(vec3s) +
           points->triangle_count * (3 * sizeof(uint32_t) + sizeof(float));
}
