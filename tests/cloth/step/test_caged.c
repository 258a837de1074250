/* Heavy cloth that is moved by a cage: it falls as it is, hangs where it is pinned, follows a pull, keeps its
 * fine folds and gets no dents, crosses neither itself nor a body, and moves the same way again after a reset
 * and with any number of threads. */
#include "tests/testing.h"

#include "cloth/state.h"
#include "config/base/memory.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 0.8 /* m */
enum { SQUARES = 100, CORNERS = SQUARES + 1, COUNT = CORNERS * CORNERS, FRAMES = 8, PULLED = 20 };

/* Bent about an axis along v, without strain. */
static vec3s bent(double u, double v)
{
    const double radius = 0.3, angle = (u - SIDE / 2) / radius;
    return (vec3s){{(float)(radius * sin(angle)), (float)(1 + radius * cos(angle)), (float)v}};
}

static struct tl_cloth_params heavy(void)
{
    struct tl_cloth_params params = params_defaults();
    params.caged_above = 5000;
    params.self_contact = true;
    return params;
}

static tl_cloth *make_cloth(tl_garment *garment, const struct tl_cloth_params *params, bool pinned)
{
    const struct sheet_shape shape = {.columns = SQUARES, .rows = SQUARES, .width = SIDE, .height = SIDE};
    const struct tl_cloth_fabric fabric = fabric_defaults();
    tl_error error;
    *garment = sheet_make(&shape, bent);
    for (uint32_t i = 0; i < CORNERS && pinned; i++)
        sheet_pin(garment, i);
    tl_cloth *cloth = tl_cloth_create(garment, &fabric, params, &error);
    assert_non_null(cloth);
    return cloth;
}

static void step(tl_cloth *cloth, const tl_collider *collider, int frames)
{
    tl_error error = {0};
    for (int i = 0; i < frames; i++)
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
}

/* In free fall it keeps its shape but for its own stiffness, and its clock runs. */
static void it_falls_as_it_is(void **state)
{
    (void)state;
    tl_garment garment;
    const struct tl_cloth_params params = heavy();
    tl_cloth *cloth = make_cloth(&garment, &params, false);
    vec3d *start = TL_NEW_ARRAY(vec3d, COUNT);
    memcpy(start, cloth->particles.x, COUNT * sizeof *start);
    assert_int_equal(tl_cloth_cage(cloth, NULL), 0);
    step(cloth, NULL, 6);
    assert_true(tl_cloth_cage(cloth, NULL) > 0);
    assert_near(cloth->time_s, 6 / params.frame_rate, 1e-12);
    const double fallen = start[0].y - cloth->particles.x[0].y;
    assert_near(fallen, 0.5 * 9.81 * 0.2 * 0.2, 0.02);
    double worst = 0;
    for (size_t i = 0; i < COUNT; i++)
        worst = fmax(worst, fabs(start[i].y - cloth->particles.x[i].y - fallen));
    print_message("bent by %.2f mm\n", 1000 * worst);
    assert_near(worst, 0, 0.002);
    assert_near(cloth->particles.v[COUNT / 2].y, -9.81 * 0.2, 0.3);
    free(start);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* Where each vertex lies on the cage, and that the corners are such as lie on themselves. */
static void places_are_on_the_cage(void **state)
{
    (void)state;
    tl_garment garment;
    const struct tl_cloth_params params = heavy();
    tl_cloth *cloth = make_cloth(&garment, &params, true);
    struct tl_cage_places places = {tl_alloc(COUNT, sizeof *places.from),
                                    tl_alloc(COUNT, sizeof *places.shares)};
    step(cloth, NULL, 1);
    assert_int_equal(tl_cloth_cage(cloth, &places), tl_cloth_cage(cloth, NULL));
    size_t corners = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        vec3d sum = {0};
        float all = 0;
        corners += places.from[i][0] == i;
        for (int k = 0; k < 3; k++) {
            const uint32_t from = places.from[i][k];
            assert_int_equal(places.from[from][0], from);
            assert_true(places.shares[i][k] >= 0);
            all += places.shares[i][k];
            sum = vec3d_muladd(sum, cloth->particles.x[from], (double)places.shares[i][k]);
        }
        assert_near(all, 1, 1e-5);
        assert_true(vec3d_distance(sum, cloth->particles.x[i]) < 0.005); /* a straightened border */
    }
    assert_in_range(corners, 2500, 4000);
    free(places.from);
    free(places.shares);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static double rms_distance(tl_cloth *const cloths[2])
{
    double sum = 0;
    for (size_t i = 0; i < COUNT; i++) {
        const double distance = vec3d_distance(cloths[0]->particles.x[i], cloths[1]->particles.x[i]);
        sum += distance * distance;
    }
    return sqrt(sum / COUNT);
}

static vec3d normal_of(const vec3d *x, const uint32_t *v)
{
    return vec3d_unit_or(vec3d_cross(vec3d_sub(x[v[1]], x[v[0]]), vec3d_sub(x[v[2]], x[v[0]])), (vec3d){0});
}

/* The root mean square, over all edges, of the change of the sine between the normals on either side since
 * `from`: what dents and creases are made of. */
static double crumpled_rms(const tl_cloth *cloth, const vec3d *from)
{
    const struct tl_topology *topology = &cloth->topology;
    const vec3d *const poses[2] = {from, cloth->particles.x};
    double squares = 0, count = 0;
    for (uint32_t t = 0; t < topology->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t other = topology->neighbour[t][k], *v = topology->triangles[t];
            double sines[2];
            if (other == TL_NONE || other < t)
                continue;
            for (int i = 0; i < 2; i++) {
                const vec3d across =
                    vec3d_cross(normal_of(poses[i], v), normal_of(poses[i], topology->triangles[other]));
                const vec3d side = vec3d_sub(poses[i][v[(k + 2) % 3]], poses[i][v[(k + 1) % 3]]);
                sines[i] = vec3d_dot(across, side) / vec3d_norm(side);
            }
            squares += (sines[1] - sines[0]) * (sines[1] - sines[0]);
            count++;
        }
    return sqrt(squares / count);
}

/* Hung from a border, over the ground. The sheet itself, all simulated, is the oracle of where it swings, and
 * of how much it may crumple. */
static void it_hangs(void **state)
{
    (void)state;
    tl_garment garments[2];
    tl_cloth *cloths[2];
    double crumpled[2];
    tl_error error = {0};
    vec3d *start = TL_NEW_ARRAY(vec3d, COUNT);
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    assert_ok(ground != NULL, error);
    for (int caged = 0; caged < 2; caged++) {
        struct tl_cloth_params params = heavy();
        params.caged_above = caged ? params.caged_above : 0;
        cloths[caged] = make_cloth(&garments[caged], &params, true);
        memcpy(start, cloths[caged]->particles.x, COUNT * sizeof *start);
        for (int i = 0; i < FRAMES; i++) {
            step(cloths[caged], ground, 1);
            const struct tl_cloth_report report = tl_cloth_measure(cloths[caged], ground);
            assert_int_equal(report.inside_count, 0);
            assert_true(report.max_strain < 0.3);
            assert_int_equal(report.crossing_count, 0);
        }
        crumpled[caged] = crumpled_rms(cloths[caged], start);
    }
    print_message("caged and not: %.1f mm root mean square apart; crumpled by %.4f and %.4f\n",
                  1000 * rms_distance(cloths), crumpled[1], crumpled[0]);
    assert_true(rms_distance(cloths) < 0.05);
    assert_true(crumpled[1] < 1.1 * crumpled[0]);
    free(start);
    for (size_t i = 0; i < CORNERS; i++)
        assert_near(
            vec3d_distance(cloths[1]->particles.x[i], vec3d_from(garments[1].model.mesh.positions[i])), 0,
            1e-6);
    for (int caged = 0; caged < 2; caged++) {
        tl_cloth_destroy(&cloths[caged]);
        sheet_free(&garments[caged]);
    }
    tl_collider_destroy(&ground);
}

/* A corner follows the hand, without gravity; the vertex that is held need not be one of the cage's. */
static void it_is_pulled(void **state)
{
    (void)state;
    tl_garment garment;
    struct tl_cloth_params params = heavy();
    params.gravity = 0;
    tl_cloth *cloth = make_cloth(&garment, &params, true);
    const vec3d from = cloth->particles.x[COUNT - 2];
    const vec3s target = {{(float)from.x, (float)from.y + 0.05f, (float)from.z}};
    for (int i = 0; i < PULLED; i++) {
        tl_cloth_grab(cloth, COUNT - 2, target);
        step(cloth, NULL, 1);
    }
    const double held = vec3d_distance(cloth->particles.x[COUNT - 2], vec3d_from(target));
    print_message("held to within %.1f of 50 mm\n", 1000 * held);
    assert_true(held < 0.01);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* Pleats of one square each, folded by 2 x 25 degrees: an isometry. */
static vec3s pleated(double u, double v)
{
    const double angle = 25 * M_PI / 180, edge = SIDE / SQUARES;
    const double column = round(u / edge);
    return (vec3s){
        {(float)(u * cos(angle)), (float)(1 + v), fmod(column, 2) > 0 ? (float)(edge * sin(angle)) : 0}};
}

/* kg */
static double weight_of(const tl_cloth *cloth)
{
    double sum = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        sum += 1 / cloth->particles.w[i];
    return sum;
}

/* Folds finer than the cage are its own shape: nothing spreads it. The cloth itself flattens them. `spin`:
 * rad/s about the vertical. */
static void keep_folds(double spin)
{
    const struct sheet_shape shape = {.columns = SQUARES, .rows = SQUARES, .width = SIDE, .height = SIDE};
    const struct tl_cloth_fabric fabric = fabric_defaults();
    tl_garment garment = sheet_make(&shape, pleated);
    struct tl_cloth_params params = heavy();
    tl_error error = {0};
    params.gravity = 0;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(cloth != NULL, error);
    const double width = vec3d_distance(cloth->particles.x[0], cloth->particles.x[SQUARES]);
    assert_near(width, SIDE * cos(25 * M_PI / 180), 0.005);
    vec3d *start = TL_NEW_ARRAY(vec3d, COUNT);
    memcpy(start, cloth->particles.x, COUNT * sizeof *start);
    for (size_t i = 0; i < COUNT; i++)
        cloth->particles.v[i] = (vec3d){spin * start[i].z, 0, -spin * (start[i].x - width / 2)};
    step(cloth, NULL, 5);
    const double now = vec3d_distance(cloth->particles.x[0], cloth->particles.x[SQUARES]);
    print_message("%.1f mm wide, from %.1f mm; folds changed by %.3f of %.3f\n", 1000 * now, 1000 * width,
                  crumpled_rms(cloth, start), sin(50 * M_PI / 180));
    assert_near(now, width, 0.02 * width);
    assert_true(crumpled_rms(cloth, start) < 0.1);
    assert_near(weight_of(cloth->caged_cloth), weight_of(cloth), 0.01 * weight_of(cloth));
    const vec3d side = vec3d_sub(cloth->particles.x[SQUARES], cloth->particles.x[0]);
    assert_near(atan2(-side.z, side.x), spin * 5 / params.frame_rate, 0.2);
    free(start);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static void fine_folds_stay(void **state)
{
    (void)state;
    keep_folds(0);
    keep_folds(6); /* a radian */
}

/* Pushes a body up and aside into the sheet, which bends over it. A reset forgets it. */
static void push(const tl_mesh *body)
{
    tl_garment garment;
    const struct tl_cloth_params params = heavy();
    tl_cloth *cloth = make_cloth(&garment, &params, false);
    vec3s *positions = TL_NEW_ARRAY(vec3s, body->vertex_count);
    tl_error error = {0};
    tl_collider *collider = tl_collider_create(body, false, &error);
    assert_ok(collider != NULL, error);
    vec3d *first = TL_NEW_ARRAY(vec3d, COUNT);
    tl_cloth_mark_start(cloth);
    step(cloth, NULL, 1);
    memcpy(first, cloth->particles.x, COUNT * sizeof *first);
    tl_cloth_reset(cloth);
    for (int frame = 1; frame <= FRAMES; frame++) {
        for (size_t i = 0; i < body->vertex_count; i++)
            positions[i] =
                glms_vec3_add(body->positions[i], (vec3s){{0.01f * (float)frame, 0.01f * (float)frame, 0}});
        tl_collider_move(collider, positions);
        step(cloth, collider, 1);
        const struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        assert_int_equal(report.inside_count, 0);
        assert_int_equal(report.crossing_count, 0);
    }
    tl_cloth_reset(cloth);
    step(cloth, NULL, 1);
    assert_memory_equal(first, cloth->particles.x, COUNT * sizeof *first);
    free(first);
    free(positions);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    sheet_free(&garment);
}

/* Hung by one corner and blown about by gusts of 4 m/s, it folds more sharply than the cage's triangles. The
 * counter is that of all boxes of triangles, not that of patches. */
static void wind_does_not_cross_it(void **state)
{
    (void)state;
    tl_garment garment;
    struct tl_cloth_params params = heavy();
    tl_error error = {0};
    const float wind[3] = {4, 0, 3};
    memcpy(params.wind, wind, sizeof wind);
    params.gust = 1;
    tl_cloth *cloth = make_cloth(&garment, &params, false);
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    assert_ok(ground != NULL, error);
    tl_cloth_pin(cloth, 0);
    for (int frame = 0; frame < PULLED / 2; frame++) {
        step(cloth, ground, 1);
        const struct tl_cloth_report report = tl_cloth_measure(cloth, ground);
        assert_int_equal(report.crossing_count, 0);
        assert_int_equal(report.inside_count, 0);
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&ground);
    sheet_free(&garment);
}

/* A belt: vertices that are pinned near a body go with it, those that the cage has left out, too. */
static void pins_go_with_the_body(void **state)
{
    (void)state;
    tl_garment garment;
    struct tl_cloth_params params = heavy();
    tl_error error = {0};
    params.gravity = 0;
    tl_mesh body = body_box((vec3s){{0, 1.2f, -0.11f}}, (vec3s){{0.4f, 0.4f, 0.1f}}, 0);
    vec3s *positions = TL_NEW_ARRAY(vec3s, body.vertex_count);
    tl_collider *collider = tl_collider_create(&body, false, &error);
    assert_ok(collider != NULL, error);
    tl_cloth *cloth = make_cloth(&garment, &params, true);
    const vec3d start = cloth->particles.x[CORNERS / 2 + 1];
    for (int frame = 1; frame <= 5; frame++) {
        for (size_t i = 0; i < body.vertex_count; i++)
            positions[i] = glms_vec3_add(body.positions[i], (vec3s){{0, 0.01f * (float)frame, 0}});
        tl_collider_move(collider, positions);
        step(cloth, collider, 1);
    }
    assert_true(tl_cloth_cage(cloth, NULL) > 0);
    assert_near(cloth->particles.x[CORNERS / 2 + 1].y - start.y, 0.05, 1e-6);
    assert_near(cloth->particles.x[CORNERS / 2 + 1].x - start.x, 0, 1e-6);
    assert_true(tl_cloth_measure(cloth, collider).max_strain < 0.3);
    free(positions);
    tl_mesh_release(&body);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    sheet_free(&garment);
}

/* A ball, and a box whose edges lie between the cage's vertices. */
static void bodies_move_it(void **state)
{
    (void)state;
    tl_mesh bodies[] = {body_sphere((vec3s){{0, 1.05f, 0.4f}}, 0.2, 32),
                        body_box((vec3s){{0, 1.05f, 0.4f}}, (vec3s){{0.15f, 0.15f, 0.15f}}, 0.6)};
    for (size_t i = 0; i < TL_COUNT(bodies); i++) {
        push(&bodies[i]);
        tl_mesh_release(&bodies[i]);
    }
}

static void threads_make_no_difference(void **state)
{
    (void)state;
    const int threads = omp_get_max_threads();
    const struct tl_cloth_params params = heavy();
    vec3d *first = TL_NEW_ARRAY(vec3d, COUNT);
    for (int i = 0; i < 2; i++) {
        tl_garment garment;
        tl_cloth *cloth = make_cloth(&garment, &params, true);
        omp_set_num_threads(1 + 2 * i);
        step(cloth, NULL, 3);
        if (i == 0)
            memcpy(first, cloth->particles.x, COUNT * sizeof *first);
        assert_memory_equal(first, cloth->particles.x, COUNT * sizeof *first);
        tl_cloth_destroy(&cloth);
        sheet_free(&garment);
    }
    omp_set_num_threads(threads);
    free(first);
}

static void a_reset_repeats(void **state)
{
    (void)state;
    tl_garment garment;
    const struct tl_cloth_params params = heavy();
    tl_cloth *cloth = make_cloth(&garment, &params, true);
    vec3d *first = TL_NEW_ARRAY(vec3d, COUNT);
    tl_cloth_mark_start(cloth);
    step(cloth, NULL, 5);
    memcpy(first, cloth->particles.x, COUNT * sizeof *first);
    tl_cloth_pin(cloth, COUNT - 1); /* and moved on otherwise, in between */
    step(cloth, NULL, 3);
    assert_true(vec3d_distance(cloth->particles.x[COUNT - 1], first[COUNT - 1]) < 1e-9);
    for (int i = 0; i < 2; i++) { /* from cloth that was pinned by hand, and from cloth that only moved */
        tl_cloth_reset(cloth);
        step(cloth, NULL, 5);
        assert_memory_equal(first, cloth->particles.x, COUNT * sizeof *first);
    }
    free(first);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* The reference solver simulates all of it, and so does every other when the option says so. */
static void others_move_themselves(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        tl_garment garment;
        struct tl_cloth_params params = heavy();
        params.solver = i == 0 ? TL_CLOTH_REFERENCE : TL_CLOTH_PREVIEW;
        params.caged_above = i == 0 ? params.caged_above : 0;
        tl_cloth *cloth = make_cloth(&garment, &params, true);
        step(cloth, NULL, 1);
        assert_int_equal(tl_cloth_cage(cloth, NULL), 0);
        tl_cloth_destroy(&cloth);
        sheet_free(&garment);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_falls_as_it_is),
        cmocka_unit_test(places_are_on_the_cage),
        cmocka_unit_test(it_hangs),
        cmocka_unit_test(it_is_pulled),
        cmocka_unit_test(fine_folds_stay),
        cmocka_unit_test(bodies_move_it),
        cmocka_unit_test(pins_go_with_the_body),
        cmocka_unit_test(wind_does_not_cross_it),
        cmocka_unit_test(a_reset_repeats),
        cmocka_unit_test(others_move_themselves),
        cmocka_unit_test(threads_make_no_difference),
    };
    cmocka_set_test_filter(getenv("TOILE_TESTS")); /* NULL: all */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
