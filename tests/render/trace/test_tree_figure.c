/* Rays through the tree of the graphics card against Embree, for a dressed figure, at the pose of the build
 * and refitted after a motion. Faults put into the shaders are found. */
#include "tests/render/tree_rays.h"

#include "assets/body/form.h"
#include "assets/cut/garment_cut.h"
#include "config/base/memory.h"
#include "render/trace/spread.h"
#include "render/trace/trace.h"

#include "tests/testing.h"

#include <string.h>

/* ---- A dressed figure ---- */

/* DOUBTS_MAX: a tree that is wrong differs everywhere; so many rays are traced in doubles. */
enum { FIGURE_RAYS = 30000, FAULT_RAYS = 6000, DOUBTS_MAX = 10 };

struct figure {
    tl_garment garment;
    tl_avatar form;
    tl_surface surfaces[2];
    struct flat_mesh mesh; /* of both */
    vec3s *rest;           /* its positions at the pose of the build */
    tl_trace *trace;
};

static struct figure *shared; /* by all tests, each of which leaves it in its first pose */

static void update_trace(struct figure *figure)
{
    tl_error error = {0};
    size_t first = 0;
    for (int s = 0; s < 2; first += figure->surfaces[s].vertex_count, s++) {
        figure->surfaces[s].positions = figure->mesh.positions + first;
        figure->surfaces[s].motion_revision++;
    }
    assert_ok(tl_trace_update(figure->trace, figure->surfaces, 2, &error), error);
}

static struct figure *open_figure(void)
{
    tl_error error = {0};
    struct figure *figure = TL_NEW(struct figure);
    assert_ok(tl_garment_cut("dress", 0.02f, &figure->garment, &error), error);
    figure->form = tl_avatar_form();
    const tl_model *models[] = {&figure->garment.model, &figure->form.model};
    for (int s = 0; s < 2; s++)
        figure->surfaces[s] =
            tl_surface_of_mesh(s == 0 ? "garment" : "avatar", &models[s]->mesh, models[s]->materials);
    figure->mesh = flat_mesh_join((const tl_surface *[]){&figure->surfaces[0], &figure->surfaces[1]}, 2);
    figure->rest = TL_NEW_ARRAY(vec3s, figure->mesh.vertex_count);
    memcpy(figure->rest, figure->mesh.positions, figure->mesh.vertex_count * sizeof(vec3s));
    figure->trace = tl_trace_create(&error);
    assert_non_null(figure->trace);
    update_trace(figure);
    return figure;
}

static void close_figure(struct figure *figure)
{
    tl_trace_destroy(&figure->trace);
    tl_garment_release(&figure->garment);
    tl_avatar_release(&figure->form);
    flat_mesh_release(&figure->mesh);
    free(figure->rest);
    free(figure);
}

/* Turns the figure about its axis, the more the higher, and lets it sway: tens of centimetres. `far` 0: as it
 * was built. */
static void move_figure(struct figure *figure, float far)
{
    for (size_t v = 0; v < figure->mesh.vertex_count; v++) {
        const vec3s p = figure->rest[v];
        const float angle = far * 0.6f * p.y, c = cosf(angle), s = sinf(angle);
        figure->mesh.positions[v] = (vec3s){{c * p.x + s * p.z + far * 0.1f * sinf(4 * p.y),
                                             p.y + far * 0.03f * sinf(9 * p.x), c * p.z - s * p.x}};
    }
    update_trace(figure);
}

/* Rays of visibility: from triangles, a tenth of a millimetre above either side, into a hemisphere. */
static void figure_rays(const struct figure *figure, struct card_ray *rays, size_t count)
{
    const struct flat_mesh *mesh = &figure->mesh;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corners = mesh->corners + 3 * (i * 7919 % mesh->triangle_count);
        const vec3s a = mesh->positions[corners[0]], b = mesh->positions[corners[1]],
                    c = mesh->positions[corners[2]];
        const vec2s at = spread_place(1, (uint32_t)i), towards = spread_place(2, (uint32_t)i);
        vec3s normal = glms_vec3_normalize(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
        if (i % 2)
            normal = glms_vec3_negate(normal);
        const vec3s on =
            glms_vec3_add(glms_vec3_add(glms_vec3_scale(a, 1 - at.x), glms_vec3_scale(b, at.x * (1 - at.y))),
                          glms_vec3_scale(c, at.x * at.y));
        const float y = 2 * towards.x - 1, r = sqrtf(1 - y * y), turn = 6.2831853f * towards.y;
        vec3s direction = {{r * cosf(turn), y, r * sinf(turn)}};
        if (glms_vec3_dot(direction, normal) < 0)
            direction = glms_vec3_negate(direction);
        rays[i] = (struct card_ray){
            .origin = glms_vec3_add(on, glms_vec3_scale(normal, 1e-4f)), .direction = direction, .to = FAR_M};
    }
}

struct against_embree {
    size_t hits;
    size_t visibility, nearest; /* rays that differ, and do not pass within EDGE_M of an edge */
    size_t at_edges;            /* rays that differ, and do */
};

static bool differs_in_nearest(const struct figure *figure, const struct card_found *found,
                               const struct tl_trace_hit *hit)
{
    const bool hits = hit->surface != TL_TRACE_NONE;
    if ((found->triangle != TL_TREE_NO_CHILD) != hits || !hits)
        return (found->triangle != TL_TREE_NO_CHILD) != hits;
    const uint32_t first = hit->surface == 0 ? 0 : (uint32_t)(figure->surfaces[0].index_count / 3);
    return found->triangle != first + hit->triangle || (found->back != 0) != hit->back ||
           fabsf(found->distance - hit->distance_m) > (float)DISTANCE_ROUNDING * (1 + hit->distance_m) ||
           fabsf(found->u - hit->u) > 1e-3f || fabsf(found->v - hit->v) > 1e-3f;
}

static struct against_embree compare(struct card *card, const struct figure *figure, size_t count)
{
    struct against_embree result = {0};
    struct card_ray *rays = TL_NEW_ARRAY(struct card_ray, count);
    struct card_found *found = TL_NEW_ARRAY(struct card_found, count);
    figure_rays(figure, rays, count);
    card_trace(card, rays, found, count);
    for (size_t i = 0; i < count; i++) {
        const struct tl_trace_hit hit =
            tl_trace_nearest(figure->trace, rays[i].origin, rays[i].direction, rays[i].from, rays[i].to);
        const bool blocked =
            tl_trace_occluded(figure->trace, rays[i].origin, rays[i].direction, rays[i].from, rays[i].to);
        const bool other_visibility =
            (found[i].occluded != 0) != blocked || found[i].through != (blocked ? 0 : 1);
        const bool other_nearest = differs_in_nearest(figure, &found[i], &hit);
        result.hits += blocked;
        if (!other_visibility && !other_nearest)
            continue;
        if (result.visibility + result.nearest < DOUBTS_MAX &&
            card_try_all(&figure->mesh, &rays[i], figure->mesh.triangle_count).is_doubtful) {
            result.at_edges++;
            continue;
        }
        result.visibility += other_visibility;
        result.nearest += other_nearest;
    }
    free(rays);
    free(found);
    return result;
}

static void expect_equal(struct card *card, const struct figure *figure)
{
    const struct against_embree result = compare(card, figure, FIGURE_RAYS);
    if (result.visibility || result.nearest || result.at_edges)
        print_error("of %d rays: visibility differs in %zu, nearest hits in %zu, at edges %zu\n", FIGURE_RAYS,
                    result.visibility, result.nearest, result.at_edges);
    assert_in_range(result.hits, FIGURE_RAYS / 4, FIGURE_RAYS);
    assert_int_equal(result.visibility, 0);
    assert_int_equal(result.nearest, 0);
    assert_true(result.at_edges <= FIGURE_RAYS / 10000);
}

static void test_figure_is_as_embree(void **state)
{
    struct figure *figure = shared;
    struct card card;
    card_open(&card, *state, NULL, NULL);
    card_update(&card, &figure->mesh);
    move_figure(figure, 1);
    assert_true(compare(&card, figure, FAULT_RAYS).visibility > 0); /* it must follow */
    card_update(&card, &figure->mesh);
    expect_equal(&card, figure);
    card_close(&card);
    move_figure(figure, 0);
}

/* Nearest hits take children in the ray's order: with an axis turned over, and in no order, they take more.
 */
static void test_order_saves_work(void **state)
{
    struct figure *figure = shared;
    static struct card_ray rays[FAULT_RAYS];
    static const char *const orders[] = {
        "tree_first_slot(slots, octant)", "tree_first_slot(slots, 0u)", "tree_first_slot(slots, octant ^ 1u)",
        "tree_first_slot(slots, octant ^ 2u)", "tree_first_slot(slots, octant ^ 4u)"};
    double fewest = 0;
    figure_rays(figure, rays, TL_COUNT(rays));
    for (size_t i = 0; i < TL_COUNT(orders); i++) {
        const struct card_work work = card_measure_work(*state, &figure->mesh, "#define ONLY TREE_NEAREST\n",
                                                        orders[i], rays, TL_COUNT(rays));
        fewest = i == 0 ? work.nodes : fewest;
        assert_true(i == 0 || work.nodes > fewest);
    }
}

/* ---- Faults ---- */

enum { SOUP_TRIANGLES = 300, SOUP_RAYS = 500 };

/* Each is found: rays differ from Embree's, or from all triangles of a soup. */
static void test_faults_are_found(void **state)
{
    struct figure *figure = shared;
    static const struct card_edit faults[] = {
        /* boxes rounded to the inside, leaves and nodes numbered wrongly */
        {"refit.comp", "floor((low - node_low) * a_step - MARGIN)",
         "ceil((low - node_low) * a_step + MARGIN)"},
        {"refit.comp", "ceil((high - node_low) * a_step + MARGIN)",
         "floor((high - node_low) * a_step - MARGIN)"},
        {"refit.comp", "place - first_place", "place"},
        {"refit.comp", "1u << 24u + slot", "1u << 24u"},
        /* a stack of two, siblings lost, one axis taken for a forward one, slopes that are flattened */
        {"trace.glsl", "stack[height++]", "stack[min(height++, 1)]"},
        {"trace.glsl", "stack[height].y & 255u", "stack[height].y & 127u"},
        {"trace.glsl", "(1u << slot) - 1u", "(2u << slot) - 1u"},
        {"trace.glsl", "turned.z ? uvec4(", "false ? uvec4("},
        {"trace.glsl", "const vec3 slope_min = vec3(1e-20)", "const vec3 slope_min = vec3(0.1)"},
        /* one side of a triangle, its other side, the end of a ray, what open triangles leave */
        {"trace.glsl", " || min(u, min(v, w)) >= -slack", ""},
        {"trace.glsl", "hit.back = facing > 0.0", "hit.back = facing < 0.0"},
        {"trace.glsl", "&& distance <= hit.distance", ""},
        {"trace.glsl", "distance >= from && ", ""},
        {"trace.glsl", "hit.open = second.w", "hit.open = 0.0"},
        /* what casts no shadow */
        {"tree_terms.glsl", "TL_TREE_ALL     0u", "TL_TREE_ALL     1u"},
        {"tree_terms.glsl", "TL_TREE_CASTERS 1u", "TL_TREE_CASTERS 0u"},
    };
    static struct card_ray rays[SOUP_RAYS];
    struct soup soup;
    float openness[SOUP_TRIANGLES];
    soup_create(&soup, SOUP_TRIANGLES, 1);
    struct flat_mesh mesh = flat_mesh_of_soup(&soup);
    mesh.openness = openness;
    mesh.other_count = SOUP_TRIANGLES / 10;
    for (size_t t = 0; t < SOUP_TRIANGLES; t++)
        openness[t] = 0.5f;
    random_rays(rays, SOUP_RAYS, 3);
    for (size_t i = 0; i < TL_COUNT(faults); i++) {
        const struct card_edit edits[CARD_EDITS_MAX] = {faults[i]};
        struct card card;
        size_t hits = 0;
        card_open(&card, *state, edits, NULL);
        card_update(&card, &mesh);
        size_t faulty = card_count_faulty(&card, &mesh, rays, SOUP_RAYS, &hits);
        card_update(&card, &figure->mesh);
        const struct against_embree result = compare(&card, figure, FAULT_RAYS);
        faulty += result.visibility + result.nearest;
        if (faulty == 0)
            print_error("a fault is not found: %s: %s\n", faults[i].file, faults[i].text);
        assert_true(faulty > 0);
        card_close(&card);
    }
    soup_release(&soup);
}

static int open_all(void **state)
{
    if (card_gpu_open(state) != 0)
        return -1;
    shared = open_figure();
    return 0;
}

static int close_all(void **state)
{
    close_figure(shared);
    return card_gpu_close(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_figure_is_as_embree),
        cmocka_unit_test(test_order_saves_work),
        cmocka_unit_test(test_faults_are_found),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
