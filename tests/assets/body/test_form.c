/* The dress form: a closed manifold facing outwards, symmetric, with the measurements of a size 36 figure. */
#include "tests/testing.h"

#include "assets/avatar.h"
#include "assets/body/form.h"

#include "config/base/memory.h"

#include <string.h>

static tl_avatar form;

static int make_form(void **state)
{
    (void)state;
    form = tl_avatar_form();
    return 0;
}

static int drop_form(void **state)
{
    (void)state;
    free(form.model.name);
    free(form.model.materials);
    tl_mesh_release(&form.model.mesh);
    return 0;
}

static int compare_floats(float a, float b)
{
    return (a > b) - (a < b);
}

static int compare_positions(const void *a, const void *b)
{
    vec3s p = form.model.mesh.positions[*(const uint32_t *)a];
    vec3s q = form.model.mesh.positions[*(const uint32_t *)b];
    int order = compare_floats(p.x, q.x);
    order = order ? order : compare_floats(p.y, q.y);
    return order ? order : compare_floats(p.z, q.z);
}

/* weld[v]: the first render vertex of equal position. */
static uint32_t *weld_by_position(const tl_mesh *mesh)
{
    size_t count = mesh->vertex_count;
    uint32_t *order = TL_NEW_ARRAY(uint32_t, count), *weld = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        order[i] = (uint32_t)i;
    qsort(order, count, sizeof *order, compare_positions);
    for (size_t i = 0; i < count; i++) {
        bool same = i > 0 && compare_positions(&order[i], &order[i - 1]) == 0;
        weld[order[i]] = same ? weld[order[i - 1]] : order[i];
    }
    free(order);
    return weld;
}

static int compare_edges(const void *a, const void *b)
{
    uint64_t i = *(const uint64_t *)a, j = *(const uint64_t *)b;
    return (i > j) - (i < j);
}

/* Closed, manifold and consistently wound: after welding, each directed edge occurs once, and its opposite
 * once. Euler: V - E + F = 2 says one sphere-like component. */
static void check_closed_manifold(const tl_mesh *mesh, const uint32_t *weld)
{
    uint64_t *edges = TL_NEW_ARRAY(uint64_t, mesh->index_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        size_t next = i % 3 == 2 ? i - 2 : i + 1;
        uint64_t a = weld[mesh->indices[i]], b = weld[mesh->indices[next]];
        assert_true(a != b);
        edges[i] = a << 32 | b;
    }
    qsort(edges, mesh->index_count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < mesh->index_count; i++) {
        assert_true(i == 0 || edges[i] != edges[i - 1]);
        uint64_t opposite = edges[i] << 32 | edges[i] >> 32;
        assert_non_null(bsearch(&opposite, edges, mesh->index_count, sizeof *edges, compare_edges));
    }
    size_t vertices = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        vertices += weld[i] == i;
    assert_int_equal((long)vertices - (long)mesh->index_count / 2 + (long)mesh->index_count / 3, 2);
    free(edges);
}

static void test_closed_manifold(void **state)
{
    (void)state;
    uint32_t *weld = weld_by_position(&form.model.mesh);
    check_closed_manifold(&form.model.mesh, weld);
    free(weld);
}

/* Outward, and as large as drawn: the volume by the divergence theorem is the torso's, integrated from its
 * sections, plus the stand's. A chord polygon of 64 columns loses 0.2 %; pole, plate and finial are worth one
 * to three litres (a rod of 3.4 cm and 63 cm length holds 0.6, a plate of 30 cm and 1.5 cm 1.1). */
static void test_volume(void **state)
{
    (void)state;
    const tl_mesh *mesh = &form.model.mesh;
    double volume = 0, torso = 0;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s a = mesh->positions[mesh->indices[i]], b = mesh->positions[mesh->indices[i + 1]];
        vec3s c = mesh->positions[mesh->indices[i + 2]];
        volume += (double)glms_vec3_dot(a, glms_vec3_cross(b, c)) / 6;
    }
    const double dy = 0.0025, turn = 2 * M_PI / 128;
    for (int k = 0; k < (TL_FORM_NECK_TOP - TL_FORM_BOTTOM) / dy; k++) {
        for (int i = 0; i < 128; i++)
            torso += 0.5 * pow(tl_form_radius(TL_FORM_BOTTOM + (k + 0.5) * dy, i * turn), 2) * turn * dy;
    }
    assert_near(volume - torso, 0.002, 0.001);
}

/* Tape measurements agree within 1 cm with the figure that the form was designed for. */
static void test_measurements(void **state)
{
    (void)state;
    assert_near(tl_form_girth(TL_FORM_BUST), 0.88, 0.01);
    assert_near(tl_form_girth(TL_FORM_WAIST), 0.68, 0.01);
    assert_near(tl_form_girth(TL_FORM_HIP), 0.94, 0.01);
    struct tl_box box = tl_box_of(form.model.mesh.positions, form.model.mesh.vertex_count);
    assert_near(box.lower.y, 0, 1e-6);
    assert_near(box.upper.y, 1.6, 1e-6);
    /* Shoulder tips end 1.38 m above the floor. */
    double tip = 0;
    for (int i = 0; i < 150; i++)
        tip = tl_form_distance((double[3]){0.17, 1.3 + 0.001 * i, -0.016}) < 0 ? 1.3 + 0.001 * i : tip;
    assert_near(tip, 1.38, 0.01);
}

/* Front and back differ like a body's: bust to the front, seat to the back. */
static void test_facing(void **state)
{
    (void)state;
    double bust = tl_form_radius(TL_FORM_BUST, M_PI - 0.6), chest_back = tl_form_radius(TL_FORM_BUST, 0.6);
    double belly = tl_form_radius(TL_FORM_HIP, M_PI - 0.4), seat = tl_form_radius(TL_FORM_HIP, 0.4);
    assert_true(bust > chest_back + 0.01);
    assert_true(seat > belly + 0.01);
}

/* Every canvas vertex lies on the implicit surface it was lofted from: the girths and the garments that are
 * cut around tl_form_distance meet the mesh. Bisection leaves 0.3 m / 2^40; the rest is float rounding. */
static void test_mesh_meets_shape(void **state)
{
    (void)state;
    const tl_mesh *mesh = &form.model.mesh;
    for (size_t p = 0; p < mesh->part_count; p++) {
        if (strcmp(form.model.materials[mesh->parts[p].material].name, "canvas") != 0)
            continue;
        for (uint32_t i = 0; i < mesh->parts[p].index_count; i++) {
            vec3s v = mesh->positions[mesh->indices[mesh->parts[p].first_index + i]];
            assert_near(tl_form_distance((double[3]){(double)v.x, (double)v.y, (double)v.z}), 0, 1e-6);
        }
    }
}

static void test_mirror_symmetry(void **state)
{
    (void)state;
    for (int i = 0; i < 76; i++) {
        for (int k = 1; k < 12; k++) {
            double y = 0.71 + 0.01 * i, angle = k * M_PI / 12;
            assert_near(tl_form_radius(y, angle), tl_form_radius(y, 2 * M_PI - angle), 1e-9);
        }
    }
}

/* Normals are unit and on the side of their triangles; UVs are metres where the torso is nearly a cylinder.
 * The tolerance is the section's change of girth (3 % a ring) and the difference between the front's slope
 * and the side's. */
static void test_normals_and_uvs(void **state)
{
    (void)state;
    const tl_mesh *mesh = &form.model.mesh;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
        vec3s other = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
        vec3s face = glms_vec3_normalize(glms_vec3_cross(side, other));
        for (int k = 0; k < 3; k++) {
            assert_near(glms_vec3_norm(mesh->normals[v[k]]), 1, 1e-5);
            assert_true(glms_vec3_dot(face, mesh->normals[v[k]]) > 0.4f);
        }
    }
    for (size_t p = 0; p < mesh->part_count; p++)
        assert_near(mesh->parts[p].uv_metres, 1, 0.2);
}

/* The figure is one closed surface on its distance function's zero set, with the form's waist, two legs below
 * the crotch and two arms beside the chest. */
static void test_figure(void **state)
{
    (void)state;
    tl_avatar figure = tl_avatar_figure();
    const tl_mesh *mesh = &figure.model.mesh;
    uint32_t *alone = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    double high = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        vec3s p = mesh->positions[v];
        const double point[3] = {(double)p.x, (double)p.y, (double)p.z};
        alone[v] = (uint32_t)v;
        assert_near(tl_figure_distance(point), 0, 1e-4);
        assert_true(p.y > -1e-3f);
        high = fmax(high, point[1]);
    }
    check_closed_manifold(mesh, alone);
    assert_near(high, 1.68, 0.005);
    for (int i = 0; i < 32; i++) {
        double angle = 2 * M_PI * i / 32, r = tl_form_radius(TL_FORM_WAIST, angle);
        const double point[3] = {-r * sin(angle), TL_FORM_WAIST, -r * cos(angle)};
        assert_near(tl_figure_distance(point), 0, 0.002);
    }
    const struct {
        double y, x[3];
    } parts[] = {{0.60, {-0.1, 0, 0.1}}, {1.16, {-0.25, 0.19, 0.25}}};
    for (size_t i = 0; i < TL_COUNT(parts); i++)
        for (int k = 0; k < 3; k++) {
            double distance = tl_figure_distance((double[3]){parts[i].x[k], parts[i].y, 0});
            assert_true((distance < 0) == (k != 1));
        }
    tl_avatar_release(&figure);
    free(alone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_manifold),  cmocka_unit_test(test_volume),
        cmocka_unit_test(test_measurements),     cmocka_unit_test(test_facing),
        cmocka_unit_test(test_mesh_meets_shape), cmocka_unit_test(test_mirror_symmetry),
        cmocka_unit_test(test_normals_and_uvs),  cmocka_unit_test(test_figure),
    };
    return cmocka_run_group_tests(tests, make_form, drop_form);
}
