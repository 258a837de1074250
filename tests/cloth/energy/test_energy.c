/* The energy's forces against finite differences; and their sum, torque and invariance under rigid motion. */
#include "cloth/state.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

#include <omp.h>

/* In [-1, 1], from a fixed hash. */
static double noise(uint32_t vertex, uint32_t channel)
{
    uint32_t x = vertex * 2654435761u ^ (channel + 1) * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x ^= x >> 13;
    return (double)x / 2147483648.0 - 1;
}

/* ---- Meshes ---- */

struct mesh {
    const char *name;
    tl_garment garment;
};

static void shake_pattern(tl_garment *garment, double by)
{
    for (uint32_t i = 0; i < garment->model.mesh.vertex_count; i++) {
        garment->pattern[i].x += (float)(by * noise(i, 8));
        garment->pattern[i].y += (float)(by * noise(i, 9));
    }
}

static tl_garment make_sheet(void)
{
    const struct sheet_shape shape = {6, 5, 0.12, 0.1};
    tl_garment garment = sheet_make(&shape, NULL);
    shake_pattern(&garment, 0.005);
    return garment;
}

/* One row of quads a micrometre high: its edges become links. */
static tl_garment make_strip_with_slivers(void)
{
    const struct sheet_shape shape = {2, 6, 0.04, 0.12};
    tl_garment garment = sheet_make(&shape, NULL);
    for (uint32_t i = 0; i < garment.model.mesh.vertex_count; i++) {
        uint32_t row = i / 3;
        double v = row < 3 ? 0.02 * row : 0.02 * (row - 1) + 1e-6;
        garment.pattern[i].y = (float)v;
        garment.model.mesh.positions[i].y = (float)v;
    }
    return garment;
}

static tl_garment make_triangle(void)
{
    const struct sheet_shape shape = {1, 1, 0.03, 0.02};
    tl_garment garment = sheet_make(&shape, NULL);
    garment.model.mesh.index_count = 3;
    return garment;
}

/* A third triangle on an inner edge: no hinge there, but its membrane pulls. */
static tl_garment make_fin(void)
{
    const struct sheet_shape shape = {3, 3, 0.06, 0.06};
    tl_garment garment = sheet_make(&shape, NULL);
    uint32_t *last = &garment.model.mesh.indices[garment.model.mesh.index_count - 3];
    last[0] = 0;
    last[1] = 1;
    last[2] = 15;
    uint32_t *first = garment.model.mesh.indices;
    first[3] = first[0];
    first[4] = first[1];
    first[5] = 14;
    return garment;
}

/* ---- Fabrics: all terms, and each alone ---- */

enum term { ALL, WEFT, WARP, SHEAR, BEND, TERMS };

static struct tl_cloth_fabric fabric_of(enum term term)
{
    struct tl_cloth_fabric fabric = fabric_defaults();
    fabric.damping = 0;
    fabric.bend_weft = 2e-5;
    if (term != ALL && term != WEFT)
        fabric.stretch_weft = 0;
    if (term != ALL && term != WARP)
        fabric.stretch_warp = 0;
    if (term != ALL && term != SHEAR)
        fabric.shear = 0;
    if (term != ALL && term != BEND)
        fabric.bend_weft = fabric.bend_warp = 0;
    return fabric;
}

static double forces_of(const tl_cloth *cloth, const vec3d *x, vec3d *out)
{
    return tl_energy_evaluate(&cloth->energy, &cloth->fabric, cloth->particles.count, x, out);
}

/* Stretched, sheared, bent and turned, then every vertex moved by up to `by` metres. */
static void deform(tl_cloth *cloth, double by)
{
    for (uint32_t i = 0; i < cloth->particles.count; i++) {
        vec3d x = cloth->particles.x[i];
        cloth->particles.x[i] =
            (vec3d){1.05 * x.x + 0.2 * x.y + by * noise(i, 0) + 0.3, 0.97 * x.y + by * noise(i, 1) - 0.2,
                    3 * x.x * x.y + 0.1 * x.x + by * noise(i, 2)};
    }
}

static double largest(const vec3d *vectors, size_t count)
{
    double max_norm = 0;
    for (size_t i = 0; i < count; i++)
        max_norm = fmax(max_norm, vec3d_norm(vectors[i]));
    return max_norm;
}

/* (E(x + d) - E(x - d)) / 2d differs from dE/dx by d^2 E''' / 6, with E''' about E''/l and l no less than the
 * millimetres of the deformation, and by the energy's rounding over d: with d = 1e-7 m both are below 1e-7 of
 * the largest force. */
static void check_forces(tl_cloth *cloth, const char *name, enum term term)
{
    const double d = 1e-7;
    size_t count = cloth->particles.count;
    vec3d *x = cloth->particles.x, *forces = TL_NEW_ARRAY(vec3d, count),
          *scratch = TL_NEW_ARRAY(vec3d, count);
    double energy = forces_of(cloth, x, forces), max_norm = largest(forces, count), worst = 0;
    assert_true(isfinite(energy) && energy >= 0);
    for (size_t i = 0; i < 3 * count; i++) {
        double *at = &x[i / 3].x + i % 3, from = *at;
        *at = from + d;
        double above = forces_of(cloth, x, scratch), up = *at;
        *at = from - d;
        double below = forces_of(cloth, x, scratch), down = *at;
        *at = from;
        worst = fmax(worst, fabs((below - above) / (up - down) - (&forces[i / 3].x)[i % 3]));
    }
    printf("%s, term %d: E %.3g J, largest force %.3g N, worst difference %.2g of it\n", name, (int)term,
           energy, max_norm, max_norm > 0 ? worst / max_norm : 0);
    assert_near(worst, 0, 1e-6 * max_norm);
    free(forces);
    free(scratch);
}

/* Internal forces sum to zero, and so do their torques, within the rounding of the terms that meet at a
 * vertex. Each term is no larger than a few times the largest force. */
static void check_balance(tl_cloth *cloth)
{
    size_t count = cloth->particles.count;
    const vec3d *x = cloth->particles.x;
    vec3d *forces = TL_NEW_ARRAY(vec3d, count), sum = {0}, torque = {0};
    double size = 0;
    forces_of(cloth, x, forces);
    for (size_t i = 0; i < count; i++) {
        sum = vec3d_add(sum, forces[i]);
        torque = vec3d_add(torque, vec3d_cross(x[i], forces[i]));
        size += vec3d_norm(forces[i]);
    }
    assert_near(vec3d_norm(sum), 0, 1e-12 * size);
    assert_near(vec3d_norm(torque), 0, 1e-12 * size); /* lever arms below 1 m */
    free(forces);
}

/* A sheet turned and translated from rest has no energy and no force beyond the rounding of positions (1e-16
 * m in edges of 2 cm: strains of 1e-14), relative to the force of a strain of 1 at 1000 N/m on 2 cm. */
static void check_rigid_motion(tl_cloth *cloth, const tl_garment *garment)
{
    size_t count = cloth->particles.count;
    vec3d *x = TL_NEW_ARRAY(vec3d, count), *forces = TL_NEW_ARRAY(vec3d, count);
    for (size_t i = 0; i < cloth->topology.render_count; i++) {
        double u = (double)garment->pattern[i].x, v = (double)garment->pattern[i].y;
        const double c = cos(0.7), s = sin(0.7);
        x[cloth->topology.weld[i]] = (vec3d){c * u - s * v * 0.6 + 1, s * u + c * v * 0.6 - 2, 0.8 * v + 0.5};
    }
    double energy = forces_of(cloth, x, forces);
    const double unit = 20;
    assert_near(energy, 0, 1e-19 * unit);
    assert_near(largest(forces, count), 0, 1e-11 * unit);
    free(x);
    free(forces);
}

static void for_every_mesh_and_term(void (*check)(tl_cloth *, const tl_garment *, const char *, enum term))
{
    struct mesh meshes[] = {{"sheet", make_sheet()},
                            {"slivers", make_strip_with_slivers()},
                            {"triangle", make_triangle()},
                            {"fin", make_fin()}};
    tl_error error = {0};
    for (size_t m = 0; m < TL_COUNT(meshes); m++) {
        for (enum term term = ALL; term < TERMS; term++) {
            struct tl_cloth_fabric fabric = fabric_of(term);
            struct tl_cloth_params params = params_defaults();
            tl_cloth *cloth = tl_cloth_create(&meshes[m].garment, &fabric, &params, &error);
            assert_non_null(cloth);
            check(cloth, &meshes[m].garment, meshes[m].name, term);
            tl_cloth_destroy(&cloth);
        }
        sheet_free(&meshes[m].garment);
    }
}

static void check_deformed(tl_cloth *cloth, const tl_garment *garment, const char *name, enum term term)
{
    (void)garment;
    assert_true((cloth->energy.link_count > 0) == (strcmp(name, "slivers") == 0));
    deform(cloth, 0.003);
    check_forces(cloth, name, term);
    check_balance(cloth);
}

static void test_forces_are_differences_and_balance(void **state)
{
    (void)state;
    for_every_mesh_and_term(check_deformed);
}

static void check_rigid(tl_cloth *cloth, const tl_garment *garment, const char *name, enum term term)
{
    (void)name;
    (void)term;
    check_rigid_motion(cloth, garment);
}

static void test_rigid_motion_is_free(void **state)
{
    (void)state;
    for_every_mesh_and_term(check_rigid);
}

/* ---- The same by plain loops ---- */

struct tension {
    vec3d u, v; /* dE/dF_u, dE/dF_v per area */
};

static vec3d stretch_tension(vec3d f, double stiffness)
{
    return vec3d_scale(f, stiffness * (1 - 1 / vec3d_norm(f)));
}

static struct tension tension_of(vec3d u, vec3d v, const struct tl_cloth_fabric *fabric)
{
    double length_u = vec3d_norm(u), length_v = vec3d_norm(v),
           cosine = vec3d_dot(u, v) / (length_u * length_v);
    vec3d along_u = vec3d_scale(u, 1 / length_u), along_v = vec3d_scale(v, 1 / length_v);
    struct tension tension = {stretch_tension(u, fabric->stretch_weft),
                              stretch_tension(v, fabric->stretch_warp)};
    tension.u =
        vec3d_muladd(tension.u, vec3d_muladd(along_v, along_u, -cosine), fabric->shear * cosine / length_u);
    tension.v =
        vec3d_muladd(tension.v, vec3d_muladd(along_u, along_v, -cosine), fabric->shear * cosine / length_v);
    return tension;
}

static void add_membrane(const struct tl_membrane *m, size_t lane, const struct tl_cloth_fabric *fabric,
                         const vec3d *x, vec3d *forces)
{
    vec3d u = {0}, v = {0};
    for (int i = 0; i < 3; i++) {
        u = vec3d_muladd(u, x[m->vertices[i][lane]], m->c[i][lane]);
        v = vec3d_muladd(v, x[m->vertices[i][lane]], m->d[i][lane]);
    }
    struct tension tension = tension_of(u, v, fabric);
    for (int i = 0; i < 3; i++) {
        vec3d *force = &forces[m->vertices[i][lane]];
        *force = vec3d_muladd(*force, tension.u, -m->area[lane] * m->c[i][lane]);
        *force = vec3d_muladd(*force, tension.v, -m->area[lane] * m->d[i][lane]);
    }
}

static void add_bend(const struct tl_bend *bend, size_t lane, const double stiffness[3], const vec3d *x,
                     vec3d *forces)
{
    for (int row = 0; row < 3; row++) {
        vec3d curvature = {0};
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            curvature = vec3d_muladd(curvature, x[bend->vertices[i][lane]], bend->rows[row][i][lane]);
        for (int i = 0; i < TL_BEND_STENCIL; i++) {
            vec3d *force = &forces[bend->vertices[i][lane]];
            *force = vec3d_muladd(*force, curvature,
                                  -stiffness[row] * bend->area[lane] * bend->rows[row][i][lane]);
        }
    }
}

static void add_fold(const struct tl_fold *fold, const struct tl_cloth_fabric *fabric, const vec3d *x,
                     vec3d *forces)
{
    double bend =
        pow(sqrt(fabric->bend_weft) * fold->across_weft + sqrt(fabric->bend_warp) * fold->across_warp, 2);
    vec3d between = vec3d_sub(x[fold->ends[1]], x[fold->ends[0]]);
    double push = bend * fold->spring * fmax(0, fold->reach / vec3d_norm(between) - 1);
    forces[fold->ends[0]] = vec3d_muladd(forces[fold->ends[0]], between, -push);
    forces[fold->ends[1]] = vec3d_muladd(forces[fold->ends[1]], between, push);
}

/* Forces by plain loops over the triangles and the folds, from the deformation gradient, the rows of the
 * curvature operator and the distances of far corners. */
static void plain_forces(const tl_cloth *cloth, vec3d *forces)
{
    const struct tl_energy *energy = &cloth->energy;
    const vec3d *x = cloth->particles.x;
    double stiffness[3];
    tl_bend_stiffness(&cloth->fabric, stiffness);
    for (size_t i = 0; i < energy->membrane_count * TL_BATCH; i++)
        if (energy->membranes[i / TL_BATCH].area[i % TL_BATCH] > 0)
            add_membrane(&energy->membranes[i / TL_BATCH], i % TL_BATCH, &cloth->fabric, x, forces);
    for (size_t i = 0; i < energy->bend_count * TL_BATCH; i++)
        if (energy->bends[i / TL_BATCH].area[i % TL_BATCH] > 0)
            add_bend(&energy->bends[i / TL_BATCH], i % TL_BATCH, stiffness, x, forces);
    for (size_t i = 0; i < energy->folds.count; i++)
        add_fold(&energy->folds.all[i], &cloth->fabric, x, forces);
}

#define MAX_THREADS 8

static tl_cloth *make_large(tl_garment *garment, const struct tl_cloth_params *params)
{
    tl_error error = {0};
    const struct sheet_shape shape = {100, 80, 0.8, 0.64};
    *garment = sheet_make(&shape, NULL);
    shake_pattern(garment, 0.001);
    struct tl_cloth_fabric fabric = fabric_of(ALL);
    tl_cloth *cloth = tl_cloth_create(garment, &fabric, params, &error);
    assert_non_null(cloth);
    assert_true(cloth->particles.count > (size_t)MAX_THREADS * TL_VERTICES_PER_THREAD);
    deform(cloth, 0.001);
    return cloth;
}

/* The vectorised form (lanes, squared lengths, constant matrix) gives the same forces within the rounding of
 * strains: 1e-16 of positions over edges of 1 cm, times a few of the largest force. */
static void test_plain_loops_agree(void **state)
{
    (void)state;
    tl_garment garment;
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = make_large(&garment, &params);
    size_t count = cloth->particles.count;
    vec3d *fast = TL_NEW_ARRAY(vec3d, count), *alone = TL_NEW_ARRAY(vec3d, count);
    vec3d *plain = TL_NEW_ARRAY(vec3d, count + 1);
    forces_of(cloth, cloth->particles.x, fast);
    tl_energy_forces(&cloth->energy, &cloth->fabric, cloth->particles.x, alone, NULL);
    plain_forces(cloth, plain);
    assert_memory_equal(fast, alone, count * sizeof *fast);
    double worst = 0;
    for (size_t i = 0; i < count; i++)
        worst = fmax(worst, vec3d_distance(fast[i], plain[i]));
    assert_near(worst, 0, 1e-12 * largest(plain, count));
    free(fast);
    free(alone);
    free(plain);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* ---- Threads ---- */

struct thread_run {
    int solver;
    double bend; /* from 1 on, preview solves it by rows, not as a force */
    /* Shaken so, the sheet has millions of pairs that are near, and a frame with contact takes up to 35 s. */
    bool self_contact;
};

/* Places after a frame from the deformed start. */
static vec3d *places_after_frame(int threads, const struct thread_run *run, size_t *count)
{
    tl_error error = {0};
    tl_garment garment;
    struct tl_cloth_params params = params_defaults();
    params.frame_rate = 500;
    params.substeps = 20; /* small enough for explicit bending in cells of 8 mm */
    tl_cloth *cloth = make_large(&garment, &params);
    struct tl_cloth_fabric fabric = cloth->fabric;
    fabric.bend_weft = fabric.bend_warp = run->bend;
    params.solver = run->solver;
    params.self_contact = run->self_contact;
    assert_ok(tl_cloth_set(cloth, &fabric, &params, &error), error);
    assert_true(cloth->energy.bending_is_force == (run->bend < 1));
    int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    omp_set_num_threads(before);
    *count = cloth->particles.count;
    vec3d *positions = TL_NEW_ARRAY(vec3d, *count);
    memcpy(positions, cloth->particles.x, *count * sizeof *positions);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return positions;
}

static void test_threads_agree(void **state)
{
    (void)state;
    const int threads[] = {2, 3, MAX_THREADS};
    const struct thread_run runs[] = {{TL_CLOTH_PREVIEW, 1e-5, true},
                                      {TL_CLOTH_PREVIEW, 1e-5, false},
                                      {TL_CLOTH_PREVIEW, 10, false},
                                      {TL_CLOTH_REFERENCE, 1e-5, false}};
    for (size_t r = 0; r < TL_COUNT(runs); r++) {
        size_t count;
        vec3d *alone = places_after_frame(1, &runs[r], &count);
        for (size_t t = 0; t < TL_COUNT(threads); t++) {
            vec3d *shared = places_after_frame(threads[t], &runs[r], &count);
            assert_memory_equal(alone, shared, count * sizeof *alone);
            free(shared);
        }
        free(alone);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forces_are_differences_and_balance),
        cmocka_unit_test(test_rigid_motion_is_free),
        cmocka_unit_test(test_plain_loops_agree),
        cmocka_unit_test(test_threads_agree),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
