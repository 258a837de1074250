/* Bending against the elastica: a strip clamped at one end that droops under its weight.
 *
 * B theta'' = -w (L - s) cos theta, theta(0) = 0, theta'(L) = 0; w weight per area. Solved here by shooting
 * with Runge-Kutta steps of L/2000. The discrete strip has one column of vertices half a cell before the
 * clamp and one half a cell after it, both held: the curvature of a hinge stands for half a cell on either
 * side. */
#include "cloth/state.h"
#include "sheets.h"
#include "testing.h"

#include "config/log.h"

struct tip {
    double along, below; /* in lengths of the strip */
};

/* Integrates from the clamp with curvature `bend` (times L); returns theta' at the end. */
static double shoot(double load, double bend, struct tip *tip)
{
    const int steps = 2000;
    const double ds = 1.0 / steps;
    double angle = 0, x = 0, y = 0;
    for (int i = 0; i < steps; i++) {
        double s = i * ds;
        double k1 = bend, m1 = -load * (1 - s) * cos(angle);
        double k2 = bend + ds / 2 * m1, m2 = -load * (1 - s - ds / 2) * cos(angle + ds / 2 * k1);
        double k3 = bend + ds / 2 * m2, m3 = -load * (1 - s - ds / 2) * cos(angle + ds / 2 * k2);
        double k4 = bend + ds * m3, m4 = -load * (1 - s - ds) * cos(angle + ds * k3);
        double middle = angle + ds / 2 * k2, end = angle + ds / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        x += ds / 6 * (cos(angle) + 4 * cos(middle) + cos(end));
        y += ds / 6 * (sin(angle) + 4 * sin(middle) + sin(end));
        bend += ds / 6 * (m1 + 2 * m2 + 2 * m3 + m4);
        angle = end;
    }
    *tip = (struct tip){x, y};
    return bend;
}

static struct tip elastica(double load)
{
    double low = 0, high = load;
    struct tip tip;
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        if (shoot(load, middle, &tip) < 0)
            low = middle;
        else
            high = middle;
    }
    return tip;
}

/* The shooting itself, against figures found independently with another program. */
static void test_elastica_figures(void **state)
{
    (void)state;
    const double known[4][3] = {
        {1, 0.99125, 0.12347}, {5, 0.84666, 0.49591}, {8, 0.72443, 0.64063}, {20, 0.44523, 0.82988}};
    for (size_t i = 0; i < 4; i++) {
        struct tip tip = elastica(known[i][0]);
        assert_near(tip.along, known[i][1], 1e-5);
        assert_near(tip.below, known[i][2], 1e-5);
    }
}

#define COLUMNS 40
static const double length_m = 0.4;

struct strip {
    double load;      /* (L/c)^3 = w L^3 / B */
    double turn_deg;  /* of warp and weft against the strip */
    double irregular; /* share of a cell by which inner vertices are moved */
    bool soft_across; /* a tenth of the stiffness at right angles to the strip */
};

/* In [-1, 1], from a fixed hash of the vertex. */
static double noise(uint32_t vertex, uint32_t channel)
{
    uint32_t x = vertex * 2654435761u ^ (channel + 1) * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x ^= x >> 13;
    return (double)x / 2147483648.0 - 1;
}

static void shape_strip(tl_garment *garment, const struct sheet_shape *shape, const struct strip *strip)
{
    double cell = shape->width / shape->columns, turn = strip->turn_deg * M_PI / 180;
    for (uint32_t i = 0; i < garment->model.mesh.vertex_count; i++) {
        int column = (int)i % (shape->columns + 1), row = (int)i / (shape->columns + 1);
        bool inner = column > 1 && column < shape->columns && row > 0 && row < shape->rows;
        double u = (double)garment->pattern[i].x + (inner ? strip->irregular * cell * noise(i, 0) : 0);
        double v = (double)garment->pattern[i].y + (inner ? strip->irregular * cell * noise(i, 1) : 0);
        garment->model.mesh.positions[i] = (vec3s){{(float)(u - cell / 2), 1, (float)-v}};
        garment->pattern[i] =
            (vec2s){{(float)(cos(turn) * u - sin(turn) * v), (float)(sin(turn) * u + cos(turn) * v)}};
        if (column < 2)
            sheet_pin(garment, i);
    }
}

static struct tip droop(const struct strip *strip)
{
    tl_error error = {0};
    double width = length_m * COLUMNS / (COLUMNS - 0.5);
    const struct sheet_shape shape = {COLUMNS, 2, width, width * 2 / COLUMNS};
    tl_garment garment = sheet_make(&shape, NULL);
    shape_strip(&garment, &shape, strip);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    double stiffness = fabric.areal_density * params.gravity * length_m * length_m * length_m / strip->load;
    fabric.bend_weft = stiffness;
    fabric.bend_warp = strip->soft_across ? 0.1 * stiffness : stiffness;
    fabric.stretch_weft = fabric.stretch_warp = fabric.shear = 3000;
    /* Critical damping of the lowest mode, omega = 3.5 sqrt(B/rho)/L^2, ends after 8/omega. A substep that
     * shrinks with sqrt(rho/B) resolves the bending of the triangles: one iteration rests at a shape that is
     * right only in that limit. */
    double omega = 3.516 * sqrt(params.gravity / (strip->load * length_m));
    fabric.damping = 2 * omega;
    params.dt = 1.0 / 180;
    params.substeps = (int)(900 / sqrt(strip->load));
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    for (int frame = 0; frame < (int)(8 / omega * params.frame_rate); frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    struct tip tip = {0};
    for (int row = 0; row <= shape.rows; row++) {
        vec3d end = cloth->particles.x[sheet_vertex(&shape, COLUMNS, row)];
        tip.along += end.x / length_m / (shape.rows + 1);
        tip.below += (1 - end.y) / length_m / (shape.rows + 1);
    }
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return tip;
}

static void check(const struct strip *strip, double tolerance)
{
    struct tip expected = elastica(strip->load), tip = droop(strip);
    printf("load %4.1f turned %2.0f irregular %.1f soft %d: tip (%.4f, %.4f), elastica (%.4f, %.4f)\n",
           strip->load, strip->turn_deg, strip->irregular, strip->soft_across, tip.along, tip.below,
           expected.along, expected.below);
    assert_near(tip.along, expected.along, tolerance);
    assert_near(tip.below, expected.below, tolerance);
}

static void test_loads(void **state)
{
    (void)state;
    const double loads[] = {1, 5, 8, 20};
    for (size_t i = 0; i < 4; i++)
        check(&(struct strip){.load = loads[i]}, 0.005);
}

/* Equal stiffness along warp and weft is isotropic, however the pattern is turned. */
static void test_turned_pattern(void **state)
{
    (void)state;
    check(&(struct strip){.load = 5, .turn_deg = 30}, 0.005);
    check(&(struct strip){.load = 5, .turn_deg = 90}, 0.005);
}

static void test_only_the_bent_direction_counts(void **state)
{
    (void)state;
    check(&(struct strip){.load = 5, .soft_across = true}, 0.005);
}

static void test_irregular_mesh(void **state)
{
    (void)state;
    check(&(struct strip){.load = 5, .irregular = 0.25}, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elastica_figures), cmocka_unit_test(test_loads),
        cmocka_unit_test(test_turned_pattern),   cmocka_unit_test(test_only_the_bent_direction_counts),
        cmocka_unit_test(test_irregular_mesh),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
