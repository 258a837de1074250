#include "tests/render/tree_rays.h"

#include "config/base/memory.h"
#include "render/gpu/shaders.h"
#include "tests/render/bindings.h"

#include <epoxy/gl.h>

#include "tests/testing.h"

#include <string.h>

/* ---- A kernel that follows rays, of shaders as they are or with a fault ---- */

static const char rays_comp[] =
    "#version 450 core\n"
    "#define TREE_BINDING 2\n"
    "#include \"trace.glsl\"\n"
    "layout(local_size_x = 64) in;\n"
    "struct Ray { vec3 origin; float from; vec3 direction; float to; };\n"
    "struct Found { float distance, u, v, through; uint triangle, back, occluded, seen; };\n"
    "layout(std430, binding = 0) restrict readonly buffer Rays { Ray rays[]; };\n"
    "layout(std430, binding = 1) restrict writeonly buffer All { Found all_found[]; };\n"
    "layout(location = 0) uniform uint count;\n"
    "void main()\n"
    "{\n"
    "    uint i = gl_GlobalInvocationID.x;\n"
    "    if (i >= count)\n"
    "        return;\n"
    "    Ray r = rays[i];\n"
    "#ifdef ONLY\n"
    "    all_found[i].distance = tree_walk(TL_TREE_CASTERS, r.origin, r.direction, r.from, r.to, "
    "ONLY).distance;\n"
    "#else\n"
    "    TreeHit hit = tree_nearest(r.origin, r.direction, r.from, r.to);\n"
    "    all_found[i] = Found(hit.distance, hit.u, hit.v, tree_transmittance(r.origin, r.direction, r.from, "
    "r.to),\n"
    "                         hit.triangle, uint(hit.back), uint(tree_occluded(r.origin, r.direction, "
    "r.from, r.to)), tree_seen(r.origin, r.direction, r.from, r.to).triangle);\n"
    "#endif\n"
    "}\n";

struct tl_embedded *card_list_shaders(const struct card_edit edits[CARD_EDITS_MAX],
                                      char *texts[CARD_EDITS_MAX])
{
    size_t count = 0;
    while (tl_embedded_shaders[count].name)
        count++;
    struct tl_embedded *list = TL_NEW_ARRAY(struct tl_embedded, count + 2);
    memcpy(list, tl_embedded_shaders, count * sizeof *list);
    list[count] = (struct tl_embedded){"rays.comp", "render/test/rays.comp", rays_comp, sizeof rays_comp - 1};
    for (int e = 0; edits && e < CARD_EDITS_MAX && edits[e].file; e++)
        for (size_t i = 0; i < count; i++) {
            if (strcmp(list[i].name, edits[e].file) != 0)
                continue;
            const char *at = strstr(list[i].data, edits[e].text);
            if (!at)
                fail_msg("%s does not hold: %s", edits[e].file, edits[e].text);
            texts[e] = tl_format("%.*s%s%s", (int)(at - list[i].data), list[i].data, edits[e].replacement,
                                 at + strlen(edits[e].text));
            list[i].data = texts[e];
        }
    return list;
}

void card_open(struct card *card, tl_gpu *gpu, const struct card_edit edits[CARD_EDITS_MAX],
               const char *defines)
{
    tl_error error = {0};
    *card = (struct card){.gpu = gpu};
    card->shaders = card_list_shaders(edits, card->texts);
    assert_ok(
        tl_program_create_compute(gpu, card->shaders, "rays.comp", defines, &card->rays_program, &error),
        error);
    assert_ok(tl_program_create_compute(gpu, card->shaders, "refit.comp", NULL, &card->tree.refit, &error),
              error);
}

void card_close(struct card *card)
{
    tl_tree_buffers_release(&card->tree);
    tl_program_destroy(&card->rays_program);
    tl_buffer_destroy(&card->positions);
    tl_buffer_destroy(&card->corners);
    tl_buffer_destroy(&card->rays);
    tl_buffer_destroy(&card->found);
    free(card->shaders);
    for (int e = 0; e < CARD_EDITS_MAX; e++)
        free(card->texts[e]);
}

void card_update(struct card *card, const struct flat_mesh *mesh)
{
    tl_error error = {0};
    const size_t vertices = mesh->vertex_count > 0 ? mesh->vertex_count : 1,
                 triangles = mesh->triangle_count > 0 ? mesh->triangle_count : 1;
    assert_ok(tl_buffer_fill(&card->positions, card->gpu, mesh->positions, vertices * sizeof(vec3s), &error),
              error);
    assert_ok(
        tl_buffer_fill(&card->corners, card->gpu, mesh->corners, triangles * 3 * sizeof(uint32_t), &error),
        error);
    const struct tl_tree_request request = {.positions = mesh->positions,
                                            .corners = mesh->corners,
                                            .openness = mesh->openness,
                                            .triangle_count = mesh->triangle_count,
                                            .caster_count = mesh->triangle_count - mesh->other_count,
                                            .position_buffer = &card->positions,
                                            .corner_buffer = &card->corners};
    assert_ok(tl_tree_buffers_update(&card->tree, card->gpu, &request, &error), error);
}

void card_trace(struct card *card, const struct card_ray *rays, struct card_found *found, size_t count)
{
    tl_error error = {0};
    assert_ok(tl_buffer_fill(&card->rays, card->gpu, rays, count * sizeof *rays, &error), error);
    assert_ok(tl_buffer_reserve(&card->found, card->gpu, count * sizeof *found, &error), error);
    tl_gpu_barrier();
    glUseProgram(card->rays_program.id);
    tl_buffer_bind(&card->rays, 0);
    tl_buffer_bind(&card->found, 1);
    tl_tree_buffers_bind(&card->tree, 2);
    glUniform1ui(0, (GLuint)count);
    tl_gpu_dispatch(tl_gpu_groups(count, 64), 1, 1);
    tl_gpu_barrier();
    tl_buffer_read(&card->found, 0, found, count * sizeof *found);
}

/* ---- Every triangle, in doubles ---- */

/* A ray that passes so near to an edge may be on either side of it: a place is rounded by 2^-24 of the two
 * metres at most that lie between it and the ray's start, sixteen times. */
#define EDGE_M 2e-6
struct certain card_try_all(const struct flat_mesh *mesh, const struct card_ray *ray, size_t triangle_count)
{
    struct certain best = {.distance = INFINITY, .through = 1, .triangle = TL_TREE_NO_CHILD};
    double second = INFINITY;
    for (size_t t = 0; t < triangle_count; t++) {
        vec3s c[3];
        double distance, u, v;
        for (size_t i = 0; i < 3; i++)
            c[i] = mesh->positions[mesh->corners[3 * t + i]];
        if (!soup_intersect(c, ray->origin, ray->direction, &distance, &u, &v))
            continue;
        const vec3s normal = glms_vec3_cross(glms_vec3_sub(c[1], c[0]), glms_vec3_sub(c[2], c[0]));
        const double weights[3] = {1 - u - v, u, v};
        bool is_inside = true, is_near = false;
        for (int i = 0; i < 3; i++) {
            const double height =
                (double)glms_vec3_norm(normal) / (double)glms_vec3_distance(c[(i + 1) % 3], c[(i + 2) % 3]);
            is_inside &= weights[i] >= 0;
            is_near |= fabs(weights[i]) * height < EDGE_M;
        }
        const double margin = DISTANCE_ROUNDING * (1 + fabs(distance));
        if (distance < (double)ray->from - margin || distance > (double)ray->to + margin)
            continue;
        best.is_doubtful |=
            is_near || distance < (double)ray->from + margin || distance > (double)ray->to - margin;
        if (!is_inside)
            continue;
        best.through *= mesh->openness ? (double)mesh->openness[t] : 0;
        if (distance < best.distance) {
            second = best.distance;
            best.distance = distance;
            best.triangle = (uint32_t)t;
            best.back = glms_vec3_dot(normal, ray->direction) > 0;
        } else {
            second = fmin(second, distance);
        }
    }
    best.is_doubtful |= second - best.distance < DISTANCE_ROUNDING * (1 + best.distance);
    return best;
}

static bool is_as_certain(const struct card_found *found, const struct certain *certain)
{
    const bool hits = certain->triangle != TL_TREE_NO_CHILD;
    if (found->triangle != certain->triangle || (found->occluded != 0) != hits ||
        fabs((double)found->through - certain->through) > 1e-6)
        return false;
    return !hits ||
           ((found->back != 0) == certain->back &&
            fabs((double)found->distance - certain->distance) < DISTANCE_ROUNDING * (1 + certain->distance));
}

size_t card_count_faulty(struct card *card, const struct flat_mesh *mesh, const struct card_ray *rays,
                         size_t count, size_t *hits)
{
    struct card_found *found = TL_NEW_ARRAY(struct card_found, count);
    size_t faulty = 0, doubtful = 0;
    card_trace(card, rays, found, count);
    for (size_t i = 0; i < count; i++) {
        const struct certain certain = card_try_all(mesh, &rays[i], mesh->triangle_count - mesh->other_count),
                             all = card_try_all(mesh, &rays[i], mesh->triangle_count);
        doubtful += all.is_doubtful;
        *hits += certain.triangle != TL_TREE_NO_CHILD;
        faulty += !all.is_doubtful && (!is_as_certain(&found[i], &certain) || found[i].seen != all.triangle);
    }
    assert_true(doubtful <= count / 50);
    free(found);
    return faulty;
}

struct flat_mesh flat_mesh_of_soup(const struct soup *soup)
{
    return (struct flat_mesh){.positions = soup->positions,
                              .corners = soup->indices,
                              .vertex_count = soup->surface.vertex_count,
                              .triangle_count = soup->surface.index_count / 3};
}

struct flat_mesh flat_mesh_join(const tl_surface *const *surfaces, size_t count)
{
    struct flat_mesh mesh = {0};
    for (size_t s = 0; s < count; s++) {
        const tl_surface *surface = surfaces[s];
        const size_t vertices = mesh.vertex_count, corners = 3 * mesh.triangle_count;
        mesh.positions = tl_resize(mesh.positions, vertices + surface->vertex_count, sizeof(vec3s));
        mesh.corners = tl_resize(mesh.corners, corners + surface->index_count, sizeof(uint32_t));
        memcpy(mesh.positions + vertices, surface->positions, surface->vertex_count * sizeof(vec3s));
        for (size_t i = 0; i < surface->index_count; i++)
            mesh.corners[corners + i] = (uint32_t)vertices + surface->indices[i];
        mesh.vertex_count += surface->vertex_count;
        mesh.triangle_count += surface->index_count / 3;
    }
    return mesh;
}

void flat_mesh_release(struct flat_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->corners);
    *mesh = (struct flat_mesh){0};
}

void random_rays(struct card_ray *rays, size_t count, uint64_t seed)
{
    for (size_t i = 0; i < count; i++) {
        rays[i] = (struct card_ray){
            .origin = soup_point(&seed, 2), .direction = soup_direction(&seed), .to = FAR_M};
        if (i % 8 == 0)
            for (size_t axis = 0; axis < 3; axis++)
                rays[i].direction.raw[axis] = axis == i / 8 % 3 ? (i & 64 ? 1 : -1) : 0;
        if (i % 8 == 1)
            rays[i].to = 2 * soup_random(&seed);
        if (i % 8 == 2)
            rays[i].from = 2 * soup_random(&seed);
    }
}

/* ---- Work ---- */

struct card_work card_measure_work(tl_gpu *gpu, const struct flat_mesh *mesh, const char *walk,
                                   const char *order, const struct card_ray *rays, size_t count)
{
    const struct card_edit edits[CARD_EDITS_MAX] = {
        {"trace.glsl", "const uint TREE_NO_TRIANGLE",
         "layout(std430, binding = 4) restrict buffer Work { uint work[]; };\nconst uint TREE_NO_TRIANGLE"},
        {"trace.glsl", "    const uvec4 head =", "    atomicAdd(work[0], 1u);\n    const uvec4 head ="},
        {"trace.glsl", "    const vec4 first =", "    atomicAdd(work[1], 1u);\n    const vec4 first ="},
        {"trace.glsl", CARD_ORDER, order}};
    tl_error error = {0};
    uint32_t work[2];
    tl_buffer counts = {0};
    struct card card;
    struct card_found *found = TL_NEW_ARRAY(struct card_found, count);
    card_open(&card, gpu, edits, walk);
    card_update(&card, mesh);
    assert_ok(tl_buffer_reserve(&counts, gpu, sizeof work, &error), error);
    tl_buffer_bind(&counts, 4);
    card_trace(&card, rays, found, count);
    tl_buffer_read(&counts, 0, work, sizeof work);
    const double cost = tl_tree_cost(&card.tree.tree, mesh->positions, mesh->corners);
    free(found);
    tl_buffer_destroy(&counts);
    card_close(&card);
    return (struct card_work){(double)work[0] / (double)count, (double)work[1] / (double)count, cost};
}

int card_gpu_open(void **state)
{
    tl_error error = {0};
    *state = tl_gpu_create_headless(&error);
    if (!*state)
        print_error("%s\n", error.message);
    test_bindings_watch();
    return *state ? 0 : -1;
}

int card_gpu_close(void **state)
{
    tl_gpu *gpu = *state;
    const size_t messages = tl_gpu_message_count(gpu), bytes = tl_gpu_bytes(gpu),
                 bindings = test_bindings_take_faults();
    if (messages || bytes || bindings)
        print_error("%zu GL messages, %zu bytes left, %zu bindings that cannot be read\n", messages, bytes,
                    bindings);
    tl_gpu_destroy(&gpu);
    return messages || bytes || bindings ? -1 : 0;
}
