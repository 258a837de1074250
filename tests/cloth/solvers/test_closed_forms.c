/* Every solver against closed forms of its own discrete equations: free fall, one spring, a hanging strip,
 * the elastic catenary, the picture frame.
 *
 * A strip one quad wide that resists along its warp only is two chains of springs side by side: each triangle
 * has its one warp edge in one of the two columns. With triangles of area A and rows d apart a spring's
 * stiffness is k A / d^2. */
#include "tests/cloth/solvers.h"

#include "cloth/timestep.h"
#include "config/base/log.h"

static const struct sheet_shape chain_shape = {1, 32, 1.0 / 32, 1};

static struct tl_cloth_fabric chain_fabric(double stretch)
{
    struct tl_cloth_fabric fabric = fabric_defaults();
    fabric.stretch_warp = stretch;
    fabric.stretch_weft = fabric.shear = fabric.bend_weft = fabric.bend_warp = 0;
    return fabric;
}

static double triangle_area(const struct sheet_shape *shape)
{
    return shape->width * shape->height / (2.0 * shape->columns * shape->rows);
}

static double chain_stiffness(const struct sheet_shape *shape, const struct tl_cloth_fabric *fabric)
{
    double row = shape->height / shape->rows;
    return fabric->stretch_warp * triangle_area(shape) / (row * row);
}

/* A third of each triangle's mass goes to each of its corners. */
static double vertex_mass(const tl_garment *garment, const struct sheet_shape *shape, double areal_density,
                          uint32_t vertex)
{
    double mass = 0;
    for (size_t i = 0; i < garment->model.mesh.index_count; i++)
        if (garment->model.mesh.indices[i] == vertex)
            mass += areal_density * triangle_area(shape) / 3;
    return mass;
}

/* ---- Free fall: g/2 t (t + h) for the Euler methods, g/2 t^2 for Verlet ---- */

static vec3s lay_flat(double u, double v)
{
    return (vec3s){{(float)u, 1, (float)-v}};
}

static void check_free_fall(int solver)
{
    const struct sheet_shape shape = {8, 8, 0.25, 0.25};
    tl_garment garment = sheet_make(&shape, lay_flat);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(solver);
    fabric.damping = 0;
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    double h = solver_rule(solver) == RULE_VERLET ? 0 : tl_cloth_substep(cloth), worst = 0;
    for (int frame = 1; frame <= 15; frame++) {
        cloth_run(cloth, NULL, 1 / params.frame_rate);
        double t = frame / params.frame_rate, fallen = 0.5 * params.gravity * t * (t + h);
        for (size_t i = 0; i < cloth->particles.count; i++)
            worst = fmax(worst, fabs((1 - cloth->particles.x[i].y) / fallen - 1));
    }
    printf("free fall, %s: relative error %.1e\n", tl_cloth_solver_names[solver], worst);
    assert_true(worst <= 1e-9);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static void test_free_fall(void **state)
{
    (void)state;
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        check_free_fall(solver);
}

/* ---- One spring ---- */

/* From stretch 1 at rest, after n steps. Implicit Euler: z = omega x + i v is divided by 1 + i omega h in
 * each step. Verlet: a rotation by 2 asin(omega h / 2) on its ellipse. */
static double spring_after(enum step_rule rule, double omega, double h, double n)
{
    if (rule == RULE_VERLET)
        return cos(n * 2 * asin(omega * h / 2));
    return pow(1 + omega * omega * h * h, -n / 2) * cos(n * atan(omega * h));
}

static void check_spring(int solver)
{
    const struct sheet_shape shape = {1, 1, 0.25, 0.5};
    const double stretch = 1.0 / 16;
    tl_garment garment = sheet_make(&shape, NULL);
    for (int column = 0; column < 2; column++)
        sheet_pin(&garment, sheet_vertex(&shape, column, 1));
    struct tl_cloth_fabric fabric = chain_fabric(2);
    struct tl_cloth_params params = params_exact(solver);
    fabric.damping = params.gravity = 0;
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    for (int column = 0; column < 2; column++)
        cloth->particles.x[column].y = -stretch;
    double h = tl_cloth_substep(cloth), worst = 0;
    for (int frame = 1; frame <= 60; frame++) {
        cloth_run(cloth, NULL, 1 / params.frame_rate);
        double steps = round(frame / (params.frame_rate * h));
        for (uint32_t column = 0; column < 2; column++) {
            double mass = vertex_mass(&garment, &shape, fabric.areal_density, column);
            double omega = sqrt(chain_stiffness(&shape, &fabric) / mass);
            double expected = spring_after(solver_rule(solver), omega, h, steps);
            worst = fmax(worst, fabs(-cloth->particles.x[column].y / stretch - expected));
        }
    }
    printf("spring, %s: error over the amplitude %.1e in 2 s, steps of %.1e s\n",
           tl_cloth_solver_names[solver], worst, h);
    assert_true(worst <= 1e-9);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static void test_spring(void **state)
{
    (void)state;
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        check_spring(solver);
}

/* ---- At rest ---- */

/* The rest shape of a chain. `expect` gives each row's position relative to row 0. */
struct rest_case {
    const char *name;
    double stretch;          /* N/m */
    double damping, seconds; /* 1/s, s: damping and duration of the run to rest */
    vec3s (*place)(double, double);
    bool both_ends; /* held at both ends, not only at the last row */
    void (*expect)(const struct rest_case *, const tl_garment *, uint32_t column, vec3d *rows);
    double scale; /* m, the displacement to which errors are relative */
};

static double spring_of(const struct rest_case *rest)
{
    struct tl_cloth_fabric fabric = chain_fabric(rest->stretch);
    return chain_stiffness(&chain_shape, &fabric);
}

/* The largest distance of any vertex from its expected position, relative to the case's scale. */
static double rest_error(const struct rest_case *rest, int solver, double h)
{
    tl_garment garment = sheet_make(&chain_shape, rest->place);
    for (int column = 0; column < 2; column++) {
        sheet_pin(&garment, sheet_vertex(&chain_shape, column, chain_shape.rows));
        if (rest->both_ends)
            sheet_pin(&garment, sheet_vertex(&chain_shape, column, 0));
    }
    struct tl_cloth_fabric fabric = chain_fabric(rest->stretch);
    struct tl_cloth_params params = params_exact(solver);
    fabric.damping = rest->damping;
    params_set_step(&params, h);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    cloth_run(cloth, NULL, rest->seconds);
    double worst = 0;
    for (uint32_t column = 0; column < 2; column++) {
        vec3d rows[33];
        rest->expect(rest, &garment, column, rows);
        for (int row = 0; row <= chain_shape.rows; row++)
            worst =
                fmax(worst, vec3d_distance(cloth->particles.x[sheet_vertex(&chain_shape, (int)column, row)],
                                           rows[row]));
    }
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return worst / rest->scale;
}

/* The error is rounding if the solver rests exactly; else it falls with the second order in the step, as one
 * sweep leaves it. */
static void check_rest(const struct rest_case *rest, int solver)
{
    double coarse = rest_error(rest, solver, RESTING_STEP);
    if (solver_rests_exactly(solver)) {
        printf("%s, %s: relative error %.1e\n", rest->name, tl_cloth_solver_names[solver], coarse);
        assert_true(coarse <= 1e-9);
        return;
    }
    double fine = rest_error(rest, solver, 1.0 / 3840), finer = rest_error(rest, solver, 1.0 / 7680);
    double order = observed_order(fine, finer);
    printf("%s, %s: relative errors %.2e, %.2e, %.2e at 1/1920, 1/3840, 1/7680 s: order %.2f\n", rest->name,
           tl_cloth_solver_names[solver], coarse, fine, finer, order);
    assert_true(fine < coarse);
    assert_near(order, 2, 0.1);
}

static void check_rest_of_all(const struct rest_case *rest)
{
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        check_rest(rest, solver);
}

/* Hangs from its last row: u_j = (g/k) sum over the springs above j of the masses below them. */
static void expect_hanging(const struct rest_case *rest, const tl_garment *garment, uint32_t column,
                           vec3d *rows)
{
    double below = 0, k = spring_of(rest), longer[33] = {0};
    for (int row = 0; row < chain_shape.rows; row++) {
        below += vertex_mass(garment, &chain_shape, fabric_defaults().areal_density,
                             sheet_vertex(&chain_shape, (int)column, row));
        longer[row] = params_defaults().gravity / k * below;
    }
    double down = 0;
    for (int row = chain_shape.rows; row >= 0; row--) {
        down += longer[row]; /* of the spring above this row; none above the last */
        rows[row] = (vec3d){column * chain_shape.width, (double)row / chain_shape.rows - down, 0};
    }
}

static void test_hanging_strip(void **state)
{
    (void)state;
    const double density = fabric_defaults().areal_density, stretch = 20;
    const struct rest_case rest = {.name = "hanging strip",
                                   .stretch = stretch,
                                   .damping = 3.6,
                                   .seconds = 16,
                                   .expect = expect_hanging,
                                   .scale = density * params_defaults().gravity / (2 * stretch)};
    check_rest_of_all(&rest);
}

static const double span_m = 0.75;

static vec3s sag(double u, double v)
{
    return (vec3s){{(float)(span_m * v), (float)(-1.4 * v * (1 - v)), (float)u}};
}

/* The end of a chain of equal masses whose first spring pulls with (across, up). Every spring has the length
 * d + T/k along its tension. */
static void hang_chain(const struct rest_case *rest, double mass, double across, double up, vec3d *rows)
{
    const double length = chain_shape.height / chain_shape.rows, k = spring_of(rest);
    rows[0].x = rows[0].y = 0;
    for (int row = 0; row < chain_shape.rows; row++) {
        double tension = hypot(across, up), share = length / tension + 1 / k;
        rows[row + 1].x = rows[row].x + across * share;
        rows[row + 1].y = rows[row].y + up * share;
        rows[row + 1].z = rows[row].z;
        up += mass * params_defaults().gravity;
    }
}

/* Newton's method for the pull at the first end that puts the last one at (span, 0); both columns are alike
 * but for their held ends. */
static void expect_catenary(const struct rest_case *rest, const tl_garment *garment, uint32_t column,
                            vec3d *rows)
{
    double mass = vertex_mass(garment, &chain_shape, fabric_defaults().areal_density,
                              sheet_vertex(&chain_shape, (int)column, 1));
    double weight = mass * params_defaults().gravity * (chain_shape.rows - 1), across = weight / 2;
    double up = -weight / 2;
    vec3d *end = &rows[chain_shape.rows], moved[2], from;
    rows[0].z = column * chain_shape.width;
    for (int i = 0; i < 50; i++) {
        const double step = 1e-6 * weight;
        hang_chain(rest, mass, across + step, up, rows);
        moved[0] = *end;
        hang_chain(rest, mass, across, up + step, rows);
        moved[1] = *end;
        hang_chain(rest, mass, across, up, rows);
        from = *end;
        double a = (moved[0].x - from.x) / step, b = (moved[1].x - from.x) / step;
        double c = (moved[0].y - from.y) / step, d = (moved[1].y - from.y) / step;
        double miss_x = span_m - from.x, miss_y = -from.y, determinant = a * d - b * c;
        across += (d * miss_x - b * miss_y) / determinant;
        up += (a * miss_y - c * miss_x) / determinant;
    }
    assert_near(from.x, span_m, 1e-14);
    assert_near(from.y, 0, 1e-14);
}

static void test_catenary(void **state)
{
    (void)state;
    const struct rest_case rest = {.name = "catenary",
                                   .stretch = 50,
                                   .damping = 3,
                                   .seconds = 14,
                                   .place = sag,
                                   .both_ends = true,
                                   .expect = expect_catenary,
                                   .scale = 0.3};
    check_rest_of_all(&rest);
}

/* ---- Picture frame ---- */

/* A square of side L whose edges keep their length while its angle closes by gamma: warp and weft keep their
 * length too, so E = L^2/2 k sin(gamma)^2, and along the frame's long diagonal D = L sqrt(2 (1 + sin gamma))
 * the force is dE/dD = k L sin(gamma) sqrt(2 (1 + sin gamma)). */
static const struct sheet_shape frame_shape = {8, 8, 0.25, 0.25};

static vec3d framed(double u, double v, double gamma)
{
    double lean = gamma / 2;
    return (vec3d){u * cos(lean) + v * sin(lean), u * sin(lean) + v * cos(lean), 0};
}

/* Makes a sheet in a sheared frame: its border is held in the sheared shape, its interior is displaced in the
 * plane. */
static tl_cloth *make_frame(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                            const struct tl_cloth_params *params, double gamma)
{
    tl_cloth *cloth = cloth_make(garment, fabric, params);
    for (size_t i = 0; i < cloth->particles.count; i++) {
        double shake = cloth->particles.w[i] > 0 ? 0.002 : 0;
        cloth->particles.x[i] = framed((double)garment->pattern[i].x + shake * sin(7.0 * (double)i),
                                       (double)garment->pattern[i].y + shake * cos(5.0 * (double)i), gamma);
    }
    for (size_t i = 0; i < cloth->pin_count; i++)
        cloth->pins[i].at = cloth->particles.x[cloth->pins[i].particle];
    return cloth;
}

struct frame_error {
    double energy, force;
};

/* Relative errors of energy and force against the closed forms. The force is measured at the held border: the
 * power of its forces in a further shear, per change of the diagonal. */
static struct frame_error measure_frame(tl_cloth *cloth, const tl_garment *garment, double gamma)
{
    const double side = frame_shape.width, shear = cloth->fabric.shear, s = sin(gamma), turn = 1e-6;
    double expected = 0.5 * side * side * shear * s * s;
    double pull = shear * side * s * sqrt(2 * (1 + s)), power = 0;
    double longer = side * (sqrt(2 * (1 + sin(gamma + turn))) - sqrt(2 * (1 + sin(gamma - turn))));
    vec3d *forces = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    double energy = tl_energy_evaluate(&cloth->energy, &cloth->fabric, cloth->particles.count,
                                       cloth->particles.x, forces);
    for (size_t i = 0; i < cloth->pin_count; i++) {
        uint32_t p = cloth->pins[i].particle;
        double u = (double)garment->pattern[p].x, v = (double)garment->pattern[p].y;
        power -= vec3d_dot(forces[p], vec3d_sub(framed(u, v, gamma + turn), framed(u, v, gamma - turn)));
    }
    free(forces);
    return (struct frame_error){fabs(energy / expected - 1), fabs(power / longer / pull - 1)};
}

static struct frame_error frame_error(int solver, double h)
{
    const double gamma = 0.3;
    tl_garment garment = sheet_make(&frame_shape, NULL);
    for (int i = 0; i <= 8; i++)
        for (int k = 0; k <= 8; k++)
            if (i % 8 == 0 || k % 8 == 0)
                sheet_pin(&garment, sheet_vertex(&frame_shape, i, k));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(solver);
    fabric.stretch_weft = fabric.stretch_warp = 100;
    fabric.shear = 30;
    fabric.damping = 100;
    params.gravity = 0;
    params_set_step(&params, h);
    tl_cloth *cloth = make_frame(&garment, &fabric, &params, gamma);
    cloth_run(cloth, NULL, 1.5);
    struct frame_error error = measure_frame(cloth, &garment, gamma);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return error;
}

static void test_picture_frame(void **state)
{
    (void)state;
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        double h = RESTING_STEP;
        struct frame_error coarse = frame_error(solver, h), fine = frame_error(solver, h / 2);
        printf("picture frame, %s: relative error of energy %.1e then %.1e, of force %.1e then %.1e\n",
               tl_cloth_solver_names[solver], coarse.energy, fine.energy, coarse.force, fine.force);
        /* The numerical derivative along the frame is good to its step squared, 1e-12, and rounding. */
        if (solver_rests_exactly(solver)) {
            assert_true(fine.energy <= 1e-9);
            assert_true(fine.force <= 1e-8);
        } else {
            assert_true(fine.energy < 0.01 && fine.force < 0.01);
            assert_near(observed_order(coarse.force, fine.force), 2, 0.3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_fall),     cmocka_unit_test(test_spring),
        cmocka_unit_test(test_hanging_strip), cmocka_unit_test(test_catenary),
        cmocka_unit_test(test_picture_frame),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
