/* Every solver gives the same bits in every run and at any number of threads: an FNV-1a hash of all positions
 * after each frame. test_threads prints hashes that equal those of a Debug build. */
#include "cloth/mesh/team.h"
#include "cloth/state.h"
#include "cloth/tangents/tangent_frames.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/hash.h"
#include "config/base/log.h"

#include <omp.h>

#define FRAMES 12

static vec3s above(double u, double v)
{
    return (vec3s){{(float)(u - 0.3), 0.71f, (float)(0.3 - v)}};
}

struct run {
    tl_garment garment;
    tl_mesh sphere;
    tl_collider *collider;
    tl_cloth *cloth;
    tl_tangent_frames *frames;
};

static void begin_at(struct run *run, int solver, int cells, vec3s (*place)(double u, double v))
{
    tl_error error = {0};
    const struct sheet_shape shape = {cells, cells, 0.6, 0.6};
    run->garment = sheet_make(&shape, place); /* the cloth keeps a pointer to it, so it must not move */
    run->sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 24);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.solver = solver;
    params.substeps = 5;
    run->collider = tl_collider_create(&run->sphere, true, &error);
    run->cloth = tl_cloth_create(&run->garment, &fabric, &params, &error);
    assert_non_null(run->cloth);
    run->frames = tl_tangent_frames_create(&run->garment.model.mesh, tl_cloth_weld(run->cloth));
}

static void begin(struct run *run, int solver, int cells)
{
    begin_at(run, solver, cells, above);
}

/* The sphere sways while the cloth falls on it. */
static void play(struct run *run, int frames, uint64_t *hashes)
{
    tl_error error = {0};
    size_t count = run->garment.model.mesh.vertex_count;
    vec3s *positions = TL_NEW_ARRAY(vec3s, count), *normals = TL_NEW_ARRAY(vec3s, count);
    vec4s *tangents = TL_NEW_ARRAY(vec4s, count);
    vec3s *body = TL_NEW_ARRAY(vec3s, run->sphere.vertex_count);
    for (int frame = 0; frame < frames; frame++) {
        for (size_t i = 0; i < run->sphere.vertex_count; i++)
            body[i] = (vec3s){{run->sphere.positions[i].x + 0.02f * sinf(0.5f * (float)frame),
                               run->sphere.positions[i].y, run->sphere.positions[i].z}};
        tl_collider_move(run->collider, body);
        assert_ok(tl_cloth_step(run->cloth, run->collider, &error), error);
        tl_cloth_positions(run->cloth, positions);
        tl_tangent_frames_update(run->frames, positions, normals, tangents);
        hashes[frame] = tl_hash(TL_HASH_START, positions, count * sizeof *positions);
        hashes[frame] = tl_hash(hashes[frame], normals, count * sizeof *normals);
        hashes[frame] = tl_hash(hashes[frame], tangents, count * sizeof *tangents);
    }
    free(positions);
    free(normals);
    free(tangents);
    free(body);
}

static void end(struct run *run)
{
    tl_tangent_frames_destroy(&run->frames);
    tl_cloth_destroy(&run->cloth);
    tl_collider_destroy(&run->collider);
    tl_mesh_release(&run->sphere);
    sheet_free(&run->garment);
}

#define MAX_THREADS 8

/* Enough vertices for all threads. */
static void test_threads(void **state)
{
    (void)state;
    const int counts[] = {1, 3, MAX_THREADS}, frames = 2, cells = 72;
    assert_true((cells + 1) * (cells + 1) > MAX_THREADS * TL_VERTICES_PER_THREAD);
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        uint64_t hashes[TL_COUNT(counts)][FRAMES] = {0};
        for (size_t i = 0; i < TL_COUNT(counts); i++) {
            struct run run;
            omp_set_num_threads(counts[i]);
            begin(&run, solver, cells);
            play(&run, frames, hashes[i]);
            end(&run);
            assert_memory_equal(hashes[0], hashes[i], sizeof hashes[0]);
        }
        print_message("%s: %016llx\n", tl_cloth_solver_names[solver],
                      (unsigned long long)hashes[0][frames - 1]);
        assert_true(hashes[0][frames - 1] != hashes[0][frames - 2]); /* something moves */
    }
}

/* After a reset the same frames follow; after a change of material they differ. */
static void test_reset(void **state)
{
    (void)state;
    tl_error error = {0};
    uint64_t first[FRAMES], again[FRAMES], other[FRAMES];
    struct run run;
    begin(&run, TL_CLOTH_PREVIEW, 40);
    play(&run, FRAMES, first);
    tl_cloth_reset(run.cloth);
    tl_collider_move(run.collider, run.sphere.positions);
    tl_collider_move(run.collider, run.sphere.positions);
    play(&run, FRAMES, again);
    assert_memory_equal(first, again, sizeof first);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.substeps = 5;
    fabric.shear *= 2;
    assert_ok(tl_cloth_set(run.cloth, &fabric, &params, &error), error);
    tl_cloth_reset(run.cloth);
    tl_collider_move(run.collider, run.sphere.positions);
    tl_collider_move(run.collider, run.sphere.positions);
    play(&run, FRAMES, other);
    assert_true(first[FRAMES - 1] != other[FRAMES - 1]);
    end(&run);
}

/* A marked start with the sheet already on the sphere is restored, with the same frames after it. */
static void check_marked_start(int solver, int cells)
{
    uint64_t first[FRAMES], again[FRAMES], away[FRAMES];
    struct run run;
    begin(&run, solver, cells);
    play(&run, FRAMES, away);
    for (int i = 0; i < 2; i++)
        tl_collider_move(run.collider, run.sphere.positions);
    tl_cloth_mark_start(run.cloth);
    play(&run, FRAMES, first);
    for (int i = 0; i < 2; i++)
        tl_collider_move(run.collider, run.sphere.positions);
    tl_cloth_reset(run.cloth);
    play(&run, FRAMES, again);
    assert_memory_equal(first, again, sizeof first);
    end(&run);
}

static void test_marked_start(void **state)
{
    (void)state;
    check_marked_start(TL_CLOTH_PREVIEW, 40);
    check_marked_start(TL_CLOTH_REFERENCE, 12);
}

static vec3s pulled_apart(double u, double v)
{
    return (vec3s){{(float)(4 * (u - 0.3)), 0.71f, (float)(0.3 - v)}};
}

/* Cloth that starts stretched to several times its length contracts at a limited speed, and does so again
 * after a reset, however long it was simulated before. */
static void test_stretched_start(void **state)
{
    (void)state;
    const int frames = 90; /* three seconds: all of it has contracted */
    uint64_t first[90], again[FRAMES];
    struct run run;
    begin_at(&run, TL_CLOTH_PREVIEW, 20, pulled_apart);
    for (int i = 0; i < 2; i++)
        tl_collider_move(run.collider, run.sphere.positions);
    tl_cloth_mark_start(run.cloth);
    play(&run, frames, first);
    for (int i = 0; i < 2; i++)
        tl_collider_move(run.collider, run.sphere.positions);
    tl_cloth_reset(run.cloth);
    tl_tangent_frames_reset(run.frames);
    play(&run, FRAMES, again);
    assert_memory_equal(first, again, sizeof again);
    end(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_reset),
        cmocka_unit_test(test_marked_start),
        cmocka_unit_test(test_stretched_start),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
