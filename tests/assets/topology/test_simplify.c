/* Simplified bodies against the bodies themselves: distances by brute force, attributes as functions of the
 * place, seams, parts and borders by counting sides. */
#include "tests/testing.h"

#include "assets/topology/simplify.h"

#include "assets/base/rig.h"
#include "config/base/memory.h"

#include <float.h>
#include <string.h>

/* ---- A body ---- */

#define COLUMNS 400
#define ROWS    300
#define OPEN_V  0.1 /* the opening at its top */

/* A dented ball of 0.3 m, closed below; UVs have a seam along one meridian. Ripples of 15 mm make it harder
 * to simplify. */
static double ripples_m;
static double wave_v; /* of the opening's outline, in v */
static double radius_at(double u, double v)
{
    double ring = sin(M_PI * v), ripple = sin(2 * M_PI * 60 * u) * sin(M_PI * 30 * v) * ring;
    return 0.15 + 0.006 * sin(2 * M_PI * 5 * u) * ring * ring + 0.004 * cos(9 * M_PI * v) +
           ripples_m * ripple;
}

static vec3s place_at(size_t column, size_t row)
{
    double u = (double)(column % COLUMNS) / COLUMNS, down = (double)row / ROWS;
    double v = OPEN_V + (1 - OPEN_V) * down + wave_v * sin(2 * M_PI * 25 * u) * (1 - down);
    double radius = radius_at(u, v), ring = row == ROWS ? 0 : radius * sin(M_PI * v);
    if (row == ROWS)
        radius = radius_at(0, 1);
    return (vec3s){{(float)(ring * cos(2 * M_PI * u)), (float)(radius * cos(M_PI * v)),
                    (float)(ring * sin(2 * M_PI * u))}};
}

/* What the body's attributes are at a place. */
static float weight_at(vec3s place)
{
    return 0.25f + place.x;
}
static bool is_morphed(vec3s place)
{
    return place.x > 0;
}

static void add_rig(tl_model *model)
{
    const tl_mesh *mesh = &model->mesh;
    tl_rig *rig = model->rig = TL_NEW(tl_rig);
    rig->vertex_count = mesh->vertex_count;
    rig->local = tl_alloc(mesh->vertex_count, sizeof *rig->local);
    rig->influences = tl_alloc(mesh->vertex_count, sizeof *rig->influences);
    rig->morph_count = 1;
    rig->morphs = TL_NEW(struct rig_morph);
    rig->morphs[0].vertices = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    rig->morphs[0].offsets = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3s place = mesh->positions[i];
        rig->local[i] = place;
        rig->influences[i] = (struct rig_influence){{0, 1, 0, 0}, {weight_at(place), 1 - weight_at(place)}};
        if (!is_morphed(place))
            continue;
        struct rig_morph *morph = &rig->morphs[0];
        morph->vertices[morph->offset_count] = i;
        morph->offsets[morph->offset_count++] = place;
    }
}

static tl_model make_body(void)
{
    tl_model model = {0};
    tl_mesh *mesh = &model.mesh;
    mesh->vertex_count = (size_t)(COLUMNS + 1) * (ROWS + 1);
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, (size_t)6 * COLUMNS * ROWS);
    model.pins = TL_NEW_ARRAY(float, mesh->vertex_count);
    model.colours = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    for (size_t row = 0, i = 0; row <= ROWS; row++)
        for (size_t column = 0; column <= COLUMNS; column++, i++) {
            mesh->positions[i] = place_at(column, row);
            mesh->normals[i] = model.colours[i] = mesh->positions[i];
            mesh->uvs[i] = (vec2s){{(float)column / COLUMNS, (float)row / ROWS}};
            model.pins[i] = mesh->positions[i].y;
        }
    for (uint32_t row = 0; row < ROWS; row++)
        for (uint32_t column = 0; column < COLUMNS; column++) {
            uint32_t a = row * (COLUMNS + 1) + column, b = a + 1, c = a + COLUMNS + 1, d = c + 1;
            const uint32_t corners[6] = {a, b, c, b, d, c};
            memcpy(&mesh->indices[mesh->index_count], corners, sizeof corners);
            mesh->index_count += 6;
        }
    mesh->part_count = 2;
    mesh->parts = TL_NEW_ARRAY(struct tl_mesh_part, 2);
    mesh->parts[0].index_count = mesh->parts[1].first_index = mesh->parts[1].index_count =
        (uint32_t)(mesh->index_count / 2);
    mesh->parts[1].material = 1;
    tl_mesh_measure_uvs(mesh);
    add_rig(&model);
    return model;
}

/* Equal numbers for vertices at one place; found by sorting. */
struct at_place {
    vec3s place;
    uint32_t vertex;
};
static int compare_places(const void *a, const void *b)
{
    const struct at_place *p = a, *q = b;
    const void *place = &p->place, *other = &q->place;
    int order = memcmp(place, other, sizeof p->place);
    return order ? order : (p->vertex > q->vertex) - (p->vertex < q->vertex);
}
static uint32_t *weld_of(const tl_mesh *mesh)
{
    struct at_place *sorted = tl_alloc(mesh->vertex_count, sizeof *sorted);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        sorted[i] = (struct at_place){glms_vec3_adds(mesh->positions[i], 0), i};
    qsort(sorted, mesh->vertex_count, sizeof *sorted, compare_places);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const void *place = &sorted[i].place, *last = i > 0 ? &sorted[i - 1].place : NULL;
        bool joins = last && memcmp(place, last, sizeof(vec3s)) == 0;
        weld[sorted[i].vertex] = joins ? weld[sorted[i - 1].vertex] : sorted[i].vertex;
    }
    free(sorted);
    return weld;
}

static struct tl_simplified simplify(tl_model *model)
{
    uint32_t *weld = weld_of(&model->mesh);
    struct tl_simplified simplified = tl_simplify_model(model, weld);
    free(weld);
    return simplified;
}

/* A smooth body and its simplified copy, made once. */
static tl_model body, simple;
static struct tl_simplified result;

static int set_up(void **state)
{
    (void)state;
    body = make_body();
    simple = make_body();
    result = simplify(&simple);
    return 0;
}
static int tear_down(void **state)
{
    (void)state;
    tl_model_release(&body);
    tl_model_release(&simple);
    return 0;
}

/* ---- Distance ---- */

/* The point of a triangle that is nearest to p, by trying the plane, the three sides and their ends. */
static double distance_to(vec3s p, const vec3s t[3], double weights[3])
{
    double best = DBL_MAX;
    vec3s ab = glms_vec3_sub(t[1], t[0]), ac = glms_vec3_sub(t[2], t[0]), ap = glms_vec3_sub(p, t[0]);
    double d00 = (double)glms_vec3_dot(ab, ab), d01 = (double)glms_vec3_dot(ab, ac),
           d11 = (double)glms_vec3_dot(ac, ac), d20 = (double)glms_vec3_dot(ap, ab),
           d21 = (double)glms_vec3_dot(ap, ac), determinant = d00 * d11 - d01 * d01;
    double v = (d11 * d20 - d01 * d21) / determinant, w = (d00 * d21 - d01 * d20) / determinant;
    if (determinant > 0 && v >= 0 && w >= 0 && v + w <= 1) {
        vec3s at = glms_vec3_add(glms_vec3_scale(ab, (float)v), glms_vec3_scale(ac, (float)w));
        weights[0] = 1 - v - w;
        weights[1] = v;
        weights[2] = w;
        return (double)glms_vec3_distance(ap, at);
    }
    for (int k = 0; k < 3; k++) {
        vec3s from = t[k], side = glms_vec3_sub(t[(k + 1) % 3], from);
        float length2 = glms_vec3_dot(side, side);
        float s = length2 > 0 ? glms_vec3_dot(glms_vec3_sub(p, from), side) / length2 : 0;
        s = s < 0 ? 0 : s > 1 ? 1 : s;
        double distance = (double)glms_vec3_distance(p, glms_vec3_add(from, glms_vec3_scale(side, s)));
        if (distance >= best)
            continue;
        best = distance;
        weights[k] = 1 - (double)s;
        weights[(k + 1) % 3] = (double)s;
        weights[(k + 2) % 3] = 0;
    }
    return best;
}

#define ROUNDING_M 1e-7 /* positions of 0.3 m are floats */

/* How far the simplified copy of a body is from its vertices, and from their UVs. */
struct farthest {
    double distance_m, uv_m;
};

/* Takes every 331st vertex: the nearest of all triangles, and how far the UV is off on the best of those that
 * are as near as allowed. */
static struct farthest find_farthest(const tl_mesh *from, const tl_mesh *to, double allowed_m)
{
    struct farthest farthest = {0, 0};
    for (size_t i = 0; i < from->vertex_count; i += 331) {
        vec3s p = from->positions[i];
        double nearest = DBL_MAX, nearest_uv = DBL_MAX;
        for (size_t t = 0; t < to->index_count; t += 3) {
            const uint32_t *corners = &to->indices[t];
            vec3s places[3];
            for (int k = 0; k < 3; k++)
                places[k] = to->positions[corners[k]];
            if (fabsf(places[0].x - p.x) > 0.03f || fabsf(places[0].y - p.y) > 0.03f)
                continue; /* no side is so long */
            double weights[3] = {1, 0, 0}, distance = distance_to(p, places, weights), off[2];
            nearest = distance < nearest ? distance : nearest;
            if (distance > allowed_m + ROUNDING_M)
                continue;
            for (int c = 0; c < 2; c++) {
                off[c] = -(double)from->uvs[i].raw[c];
                for (int k = 0; k < 3; k++)
                    off[c] += weights[k] * (double)to->uvs[corners[k]].raw[c];
            }
            nearest_uv = fmin(nearest_uv, (double)from->parts[0].uv_metres * hypot(off[0], off[1]));
        }
        farthest.distance_m = fmax(farthest.distance_m, nearest);
        farthest.uv_m = fmax(farthest.uv_m, nearest_uv);
    }
    return farthest;
}

static void assert_within(const tl_mesh *from, const tl_mesh *to, const struct tl_simplified *simplified)
{
    struct farthest farthest = find_farthest(from, to, simplified->distance_m);
    print_message("%zu triangles as %zu: %.3f mm, reported %.3f mm; UV %.3f mm\n", simplified->before,
                  simplified->after, 1e3 * farthest.distance_m, 1e3 * simplified->distance_m,
                  1e3 * farthest.uv_m);
    assert_int_equal(to->index_count, 3 * simplified->after);
    assert_true(simplified->distance_m <= TL_SIMPLIFY_DISTANCE_M);
    assert_true(farthest.distance_m <= simplified->distance_m + ROUNDING_M);
    assert_true(farthest.distance_m > 0.3 * simplified->distance_m); /* a third: one in 331 was measured */
    assert_true(farthest.uv_m <= TL_SIMPLIFY_UV_M * 1.05);           /* the parts' scales differ by less */
}

static void a_smooth_body_has_the_target_s_number(void **state)
{
    (void)state;
    assert_within(&body.mesh, &simple.mesh, &result);
    /* The last collapse may take two. */
    assert_true(result.after == TL_SIMPLIFY_TARGET || result.after == TL_SIMPLIFY_TARGET - 1);
}

/* The distance decides here, not the target. */
static void a_rough_body_has_as_many_as_it_needs(void **state)
{
    (void)state;
    ripples_m = 0.006;
    tl_model rough = make_body(), simplified = make_body();
    struct tl_simplified report = simplify(&simplified);
    ripples_m = 0;
    assert_within(&rough.mesh, &simplified.mesh, &report);
    assert_true(report.after > TL_SIMPLIFY_TARGET);
    assert_true(report.distance_m > 0.95 * TL_SIMPLIFY_DISTANCE_M);
    tl_model_release(&rough);
    tl_model_release(&simplified);
}

/* The other way: the middles of the new triangles against the formula. */
static void no_triangle_leaves_the_body(void **state)
{
    (void)state;
    const tl_mesh *mesh = &simple.mesh;
    double farthest = 0;
    size_t turned = 0;
    for (size_t t = 0; t < mesh->index_count; t += 3) {
        vec3s sum = {{0, 0, 0}};
        for (size_t k = 0; k < 3; k++)
            sum = glms_vec3_add(sum, mesh->positions[mesh->indices[t + k]]);
        double x = (double)sum.x / 3, y = (double)sum.y / 3, z = (double)sum.z / 3;
        double radius = sqrt(x * x + y * y + z * z), u = atan2(z, x) / (2 * M_PI),
               v = acos(y / radius) / M_PI;
        farthest = fmax(farthest, fabs(radius - radius_at(u, v)));
        const uint32_t *c = &mesh->indices[t];
        vec3s normal = glms_vec3_cross(glms_vec3_sub(mesh->positions[c[1]], mesh->positions[c[0]]),
                                       glms_vec3_sub(mesh->positions[c[2]], mesh->positions[c[0]]));
        bool faces_out = glms_vec3_dot(glms_vec3_normalize(normal), glms_vec3_normalize(sum)) > 0.5f;
        turned += faces_out ? 0 : 1;
    }
    assert_int_equal(turned, 0); /* by more than 60 degrees */
    print_message("middles of triangles: %.3f mm\n", 1e3 * farthest);
    assert_true(farthest <= TL_SIMPLIFY_DISTANCE_M);
}

/* ---- Seams, parts, borders ---- */

struct side {
    uint32_t from, to; /* places, the lower first */
};
static int compare_sides(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    return p->from != q->from ? (p->from > q->from ? 1 : -1) : (p->to > q->to) - (p->to < q->to);
}

/* The sides that one triangle has, between places (numbers of vertices). Fails where a side has more than
 * two, or where there is a border elsewhere than at the opening. */
static struct side *find_border(const tl_mesh *mesh, size_t *border_count)
{
    uint32_t *weld = weld_of(mesh);
    struct side *sides = tl_alloc(mesh->index_count, sizeof *sides);
    size_t count = 0;
    *border_count = 0;
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = weld[mesh->indices[i]], b = weld[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        if (a != b)
            sides[count++] = a < b ? (struct side){a, b} : (struct side){b, a};
    }
    qsort(sides, count, sizeof *sides, compare_sides);
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first; end < count && compare_sides(&sides[first], &sides[end]) == 0; end++)
            continue;
        vec3s from = mesh->positions[sides[first].from], to = mesh->positions[sides[first].to];
        assert_true(end - first <= 2);
        if (end - first == 2)
            continue;
        if (from.y < 0.1f || to.y < 0.1f)
            fail_msg("a crack at %g %g %g", (double)from.x, (double)from.y, (double)from.z);
        sides[(*border_count)++] = sides[first];
    }
    free(weld);
    return sides;
}

/* The opening's outline against that of the body: each of its vertices is as near to it as allowed. */
static void assert_opening_stays(const tl_mesh *mesh)
{
    size_t count;
    struct side *border = find_border(mesh, &count);
    double farthest = 0;
    for (size_t column = 0; column < COLUMNS; column++) {
        vec3s place = place_at(column, 0);
        double nearest = DBL_MAX, weights[3];
        for (size_t i = 0; i < count; i++) {
            vec3s from = mesh->positions[border[i].from], to = mesh->positions[border[i].to];
            nearest = fmin(nearest, distance_to(place, (const vec3s[3]){from, to, to}, weights));
        }
        farthest = fmax(farthest, nearest);
    }
    free(border);
    print_message("opening: %zu sides, were %d, within %.3f mm\n", count, COLUMNS, 1e3 * farthest);
    assert_true(count < COLUMNS);
    assert_true(farthest <= TL_SIMPLIFY_DISTANCE_M + ROUNDING_M);
}

static void the_surface_stays_closed_and_its_opening_open(void **state)
{
    (void)state;
    assert_opening_stays(&simple.mesh);
}

/* A wave of 2 mm along the outline. There are no UVs, whose bound would keep it too. */
static void a_wavy_opening_keeps_its_outline(void **state)
{
    (void)state;
    wave_v = 0.004;
    tl_model wavy = make_body();
    memset(wavy.mesh.uvs, 0, wavy.mesh.vertex_count * sizeof *wavy.mesh.uvs);
    tl_mesh_measure_uvs(&wavy.mesh);
    (void)simplify(&wavy);
    assert_opening_stays(&wavy.mesh);
    wave_v = 0;
    tl_model_release(&wavy);
}

static void seams_and_parts_stay(void **state)
{
    (void)state;
    const tl_mesh *mesh = &simple.mesh;
    const float middle = 0.5f; /* v at which the parts meet */
    assert_int_equal(mesh->part_count, 2);
    assert_int_equal(mesh->parts[0].first_index, 0);
    assert_int_equal(mesh->parts[1].first_index, mesh->parts[0].index_count);
    assert_int_equal(mesh->parts[0].index_count + mesh->parts[1].index_count, mesh->index_count);
    assert_int_equal(mesh->parts[1].material, 1);
    size_t on_seam[2] = {0, 0};
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        float lowest = 1, highest = 0;
        for (size_t k = 0; k < 3; k++) {
            vec2s uv = mesh->uvs[mesh->indices[i + k]];
            lowest = fminf(lowest, uv.u);
            highest = fmaxf(highest, uv.u);
            on_seam[0] += uv.u == 0;
            on_seam[1] += uv.u == 1;
            assert_true(i < mesh->parts[1].first_index ? uv.v <= middle : uv.v >= middle);
        }
        assert_true(highest - lowest < 0.5f); /* else a triangle crosses the seam */
    }
    assert_true(on_seam[0] > 50 && on_seam[1] > 50);
}

/* ---- Attributes ---- */

static void vertices_keep_what_they_have(void **state)
{
    (void)state;
    const tl_mesh *mesh = &simple.mesh;
    const tl_rig *rig = simple.rig;
    const struct rig_morph *morph = &rig->morphs[0];
    assert_int_equal(rig->vertex_count, mesh->vertex_count);
    assert_int_equal(simple.point_count, body.mesh.vertex_count);
    size_t next = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3s place = mesh->positions[i];
        uint32_t was = simple.points[i];
        assert_memory_equal(&body.mesh.positions[was], &place, sizeof place);
        assert_memory_equal(&body.mesh.uvs[was], &mesh->uvs[i], sizeof mesh->uvs[i]);
        assert_memory_equal(&mesh->normals[i], &place, sizeof place);
        assert_memory_equal(&simple.colours[i], &place, sizeof place);
        assert_memory_equal(&rig->local[i], &place, sizeof place);
        assert_true(simple.pins[i] == place.y);
        assert_true(rig->influences[i].weights[0] == weight_at(place));
        if (!is_morphed(place))
            continue;
        assert_true(next < morph->offset_count);
        assert_int_equal(morph->vertices[next], i);
        assert_memory_equal(&morph->offsets[next++], &place, sizeof place);
    }
    assert_int_equal(next, morph->offset_count);
}

static void the_result_is_the_same_each_time(void **state)
{
    (void)state;
    tl_model again = make_body();
    (void)simplify(&again);
    assert_int_equal(again.mesh.index_count, simple.mesh.index_count);
    assert_memory_equal(again.mesh.indices, simple.mesh.indices,
                        simple.mesh.index_count * sizeof *simple.mesh.indices);
    tl_model_release(&again);
}

static void the_line_names_both_numbers(void **state)
{
    (void)state;
    const struct tl_simplified some = {760000, 64000, 0.00028}, none = {5, 5, 0};
    char *line = tl_simplified_describe("body.ply", &some);
    assert_string_equal(line, "body.ply: 760000 triangles drawn as 64000, within 0.28 mm");
    free(line);
    assert_null(tl_simplified_describe("body.ply", &none));
}

/* ---- Bodies that stay as they are ---- */

/* Triangles of a model stay, bit by bit. */
static void assert_untouched(tl_model *model)
{
    const tl_mesh *mesh = &model->mesh;
    size_t bytes = mesh->index_count * sizeof *mesh->indices, vertices = mesh->vertex_count;
    uint32_t *indices = tl_alloc(mesh->index_count, sizeof *indices);
    memcpy(indices, mesh->indices, bytes);
    struct tl_simplified simplified = simplify(model);
    assert_int_equal(simplified.after, simplified.before);
    assert_int_equal(mesh->index_count * sizeof *mesh->indices, bytes);
    assert_int_equal(mesh->vertex_count, vertices);
    assert_memory_equal(mesh->indices, indices, bytes);
    free(indices);
    tl_model_release(model);
}

/* The first triangles of the body. */
static tl_model cut_body(size_t triangles)
{
    tl_model model = make_body();
    model.mesh.index_count = 3 * triangles;
    model.mesh.part_count = 1;
    model.mesh.parts[0].index_count = (uint32_t)(3 * triangles);
    return model;
}

static void a_small_body_stays(void **state)
{
    (void)state;
    tl_model model = cut_body(TL_SIMPLIFY_ABOVE), larger = cut_body(TL_SIMPLIFY_ABOVE + 1);
    assert_untouched(&model);
    assert_true(simplify(&larger).after < TL_SIMPLIFY_ABOVE);
    tl_model_release(&larger);
}

/* Gives each triangle from `first` on its own vertices, with one normal; `step_m`: its own place;
 * `step_uv`: its own part of the UVs. */
static tl_model make_soup(size_t first, float step_m, float step_uv)
{
    tl_model model = cut_body(TL_SIMPLIFY_ABOVE + 1000);
    tl_mesh *mesh = &model.mesh;
    size_t count = mesh->vertex_count + mesh->index_count;
    mesh->positions = tl_resize(mesh->positions, count, sizeof *mesh->positions);
    mesh->normals = tl_resize(mesh->normals, count, sizeof *mesh->normals);
    mesh->uvs = tl_resize(mesh->uvs, count, sizeof *mesh->uvs);
    for (size_t i = 3 * first; i < mesh->index_count; i++) {
        uint32_t was = mesh->indices[i];
        size_t own = mesh->indices[i] = (uint32_t)mesh->vertex_count++;
        mesh->positions[own] = mesh->positions[was];
        const size_t triangle = i / 3;
        mesh->positions[own].x += step_m * (float)triangle;
        mesh->normals[own] = mesh->normals[mesh->indices[i - i % 3]];
        mesh->uvs[own] = mesh->uvs[was];
        mesh->uvs[own].u += step_uv * (float)triangle;
    }
    free(model.pins);
    free(model.colours);
    model.pins = NULL;
    model.colours = NULL;
    rig_destroy(&model.rig);
    return model;
}

static void loose_triangles_stay(void **state)
{
    (void)state;
    tl_model loose = make_soup(0, 1e-5f, 0), split = make_soup(0, 0, 1), partly = make_soup(20000, 0, 1);
    assert_untouched(&loose);
    assert_untouched(&split);  /* each side is a seam */
    assert_untouched(&partly); /* a tenth fewer triangles are not worth another body */
}

/* Each triangle has vertices of its own, as in a file with a normal for each face. */
static void split_normals_are_no_seams(void **state)
{
    (void)state;
    tl_model whole = make_soup(SIZE_MAX / 6, 0, 0), split = make_soup(0, 0, 0);
    struct tl_simplified one = simplify(&whole), other = simplify(&split);
    assert_true(one.after < TL_SIMPLIFY_ABOVE);
    assert_int_equal(one.after, other.after);
    assert_int_equal(whole.mesh.vertex_count, split.mesh.vertex_count);
    tl_model_release(&whole);
    tl_model_release(&split);
}

/* Fins through the body, from each second triangle of its first column: their sides have three triangles. */
static void a_body_with_fins_is_simplified(void **state)
{
    (void)state;
    tl_model model = cut_body(TL_SIMPLIFY_ABOVE + 20000);
    tl_mesh *mesh = &model.mesh;
    size_t fins = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3)
        if (mesh->indices[i] % (COLUMNS + 1) == 0 && i % 2 == 0) {
            mesh->indices[i + 1] = mesh->indices[i] + COLUMNS / 2;
            fins++;
        }
    assert_true(fins > 50);
    struct tl_simplified simplified = simplify(&model);
    assert_true(simplified.after < simplified.before);
    assert_true(simplified.distance_m <= TL_SIMPLIFY_DISTANCE_M);
    size_t left = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        float lowest = 1, highest = 0;
        for (size_t k = 0; k < 3; k++) {
            assert_true(mesh->indices[i + k] < mesh->vertex_count);
            lowest = fminf(lowest, mesh->uvs[mesh->indices[i + k]].u);
            highest = fmaxf(highest, mesh->uvs[mesh->indices[i + k]].u);
        }
        left += highest - lowest > 0.4f;
    }
    assert_int_equal(left, fins); /* their corners stay */
    tl_model_release(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smooth_body_has_the_target_s_number),
        cmocka_unit_test(a_rough_body_has_as_many_as_it_needs),
        cmocka_unit_test(no_triangle_leaves_the_body),
        cmocka_unit_test(the_surface_stays_closed_and_its_opening_open),
        cmocka_unit_test(a_wavy_opening_keeps_its_outline),
        cmocka_unit_test(seams_and_parts_stay),
        cmocka_unit_test(vertices_keep_what_they_have),
        cmocka_unit_test(the_result_is_the_same_each_time),
        cmocka_unit_test(the_line_names_both_numbers),
        cmocka_unit_test(a_small_body_stays),
        cmocka_unit_test(loose_triangles_stay),
        cmocka_unit_test(split_normals_are_no_seams),
        cmocka_unit_test(a_body_with_fins_is_simplified),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
