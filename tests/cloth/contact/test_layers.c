/* Layers: the order of pieces; a belt that must not show through a shirt; folds that keep their distance.
 * Contact of the cloth with itself does not cross and keeps apart what lies on each other. */
#include "assets/avatar.h"
#include "cloth/measure.h"
#include "cloth/self_contact/crossings.h"
#include "cloth/state.h"
#include "cloth/step/snapshot.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/hash.h"
#include "config/base/log.h"

/* ---- Folds ---- */

static vec3s upright(double u, double v)
{
    return (vec3s){{(float)(u - 0.03), (float)(v + 0.01), (float)(0.004 * sin(25 * v))}};
}

/* Counts the pairs of particles nearer than 1 mm that are not neighbours in the pattern. Contact keeps 1.5
 * mm; of finer cloth a quarter of the mesh's mean side. */
static size_t count_touching(const tl_cloth *cloth, const tl_garment *garment)
{
    const double far_m = 0.02, near_m = 0.001;
    size_t count = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        for (size_t j = i + 1; j < cloth->particles.count; j++)
            if ((double)glms_vec2_distance(garment->pattern[i], garment->pattern[j]) > far_m)
                count += vec3d_distance(cloth->particles.x[i], cloth->particles.x[j]) < near_m;
    return count;
}

struct heap {
    size_t touching, crossings; /* of all frames */
};

/* A strip falls on its edge and folds over itself in a heap. */
static struct heap heap_up(bool self_contact)
{
    tl_error error = {0};
    const struct sheet_shape shape = {9, 60, 0.06, 0.4};
    tl_garment garment = sheet_make(&shape, upright);
    struct tl_cloth_fabric fabric = fabric_defaults();
    fabric.ply_m = 0.0015;
    struct tl_cloth_params params = params_defaults();
    params.self_contact = self_contact;
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    struct heap heap = {0};
    for (int frame = 0; frame < 60; frame++) {
        assert_ok(tl_cloth_step(cloth, ground, &error), error);
        heap.touching += count_touching(cloth, &garment);
        heap.crossings += tl_crossings_count(NULL, &cloth->topology, cloth->particles.x);
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&ground);
    sheet_free(&garment);
    return heap;
}

static void test_heap(void **state)
{
    (void)state;
    struct heap with = heap_up(true), without = heap_up(false);
    printf("heap: in 60 frames %zu pairs nearer than 1 mm and %zu crossings, without contact %zu and %zu\n",
           with.touching, with.crossings, without.touching, without.crossings);
    assert_true(without.touching > 200);
    assert_true(with.touching < without.touching / 10);
    assert_true(without.crossings > 1000);
    assert_int_equal(with.crossings, 0);
}

/* ---- Pieces ---- */

/* A saddle cloth around the upper half of a sphere, `out` metres off it. */
static double out_now;
static vec3s around_sphere(double u, double v)
{
    double east = (u - 0.15) / 0.2, north = (0.15 - v) / 0.2, radius = 0.2 + out_now;
    double length = sqrt(east * east + north * north + 1);
    return (vec3s){
        {(float)(radius * east / length), (float)(0.5 + radius / length), (float)(radius * north / length)}};
}

/* Two cloths over a sphere in one garment, `first` and `second` metres off it; the second turned inside out.
 */
static tl_garment two_cloths(const struct sheet_shape *shape, double first, double second)
{
    out_now = first;
    tl_garment garment = sheet_make(shape, around_sphere);
    out_now = second;
    tl_garment other = sheet_make(shape, around_sphere);
    tl_mesh *mesh = &garment.model.mesh;
    size_t count = mesh->vertex_count;
    mesh->positions = tl_resize(mesh->positions, 2 * count, sizeof(vec3s));
    mesh->uvs = tl_resize(mesh->uvs, 2 * count, sizeof(vec2s));
    mesh->indices = tl_resize(mesh->indices, 2 * mesh->index_count, sizeof(uint32_t));
    memcpy(mesh->positions + count, other.model.mesh.positions, count * sizeof(vec3s));
    memcpy(mesh->uvs + count, other.model.mesh.uvs, count * sizeof(vec2s));
    for (size_t i = 0; i < mesh->index_count; i++)
        mesh->indices[2 * mesh->index_count - 1 - i] = mesh->indices[i] + (uint32_t)count;
    mesh->index_count *= 2;
    mesh->vertex_count *= 2;
    free(garment.pattern); /* its start shape is its rest shape */
    garment.pattern = NULL;
    sheet_free(&other);
    return garment;
}

static double min_gap(const tl_cloth *cloth, size_t inner, size_t outer, size_t count)
{
    double min_gap = HUGE_VAL;
    for (size_t i = 0; i < count; i++) { /* the same vertex of both lies on the same ray from the centre */
        const vec3d centre = {0, 0.5, 0};
        min_gap = fmin(min_gap, vec3d_distance(cloth->particles.x[outer + i], centre) -
                                    vec3d_distance(cloth->particles.x[inner + i], centre));
    }
    return min_gap;
}

/* The outer cloth is found and stays outside, whatever the order in the file and the winding. Cloths that
 * are made 1 mm apart keep that distance. */
static void test_two_cloths(void **state)
{
    (void)state;
    const struct sheet_shape shape = {15, 15, 0.3, 0.3};
    for (int swapped = 0; swapped < 2; swapped++) {
        tl_error error = {0};
        tl_garment garment = two_cloths(&shape, swapped ? 0.005 : 0.004, swapped ? 0.004 : 0.005);
        tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 32);
        struct tl_cloth_fabric fabric = fabric_defaults();
        fabric.ply_m = 0.0015;
        struct tl_cloth_params params = params_defaults();
        params.self_contact = true;
        tl_collider *collider = tl_collider_create(&sphere, false, &error);
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        assert_non_null(cloth);
        void *data = NULL;
        size_t size = 0, count = garment.model.mesh.vertex_count / 2;
        size_t inner = swapped ? count : 0, outer = count - inner;
        for (int frame = 0; frame < 30; frame++)
            assert_ok(tl_cloth_step(cloth, collider, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        assert_int_equal(report.piece_count, 2);
        assert_ok(tl_layers_decide(&cloth->layers, &cloth->topology, (const vec2s(*)[3])cloth->rest, collider,
                                   cloth->particles.x, &error),
                  error);
        assert_int_equal(cloth->layers.layer_count, 2);
        assert_false(tl_cloth_save(cloth, &data, &size)); /* layers remember where their surfaces were */
        assert_int_equal(cloth->layers.layer_of[inner], 0);
        assert_int_equal(cloth->layers.layer_of[outer], 1);
        assert_near(report.deepest_m, 0, 0);
        assert_int_equal(tl_crossings_count(NULL, &cloth->topology, cloth->particles.x), 0);
        double gap = min_gap(cloth, inner, outer, count);
        printf("two cloths: smallest gap %.2f mm\n", 1e3 * gap);
        assert_true(gap > 0.5e-3); /* 1 mm as made; they slide, so their vertices leave the common ray */
        tl_cloth_destroy(&cloth);
        tl_collider_destroy(&collider);
        tl_mesh_release(&sphere);
        sheet_free(&garment);
    }
}

/* ---- A shirt over trousers ---- */

/* The triangles of the piece that holds particle `member`. */
static tl_collider *piece_collider(const tl_cloth *cloth, const uint32_t *pieces, uint32_t piece,
                                   vec3s **positions)
{
    tl_error error = {0};
    const struct tl_topology *topology = &cloth->topology;
    *positions = TL_NEW_ARRAY(vec3s, cloth->particles.count);
    tl_mesh mesh = {.vertex_count = cloth->particles.count,
                    .positions = *positions,
                    .indices = TL_NEW_ARRAY(uint32_t, 3 * topology->triangle_count)};
    for (size_t i = 0; i < cloth->particles.count; i++)
        mesh.positions[i] = vec3d_to_float(cloth->particles.x[i]);
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; pieces[topology->triangles[t][0]] == piece && corner < 3; corner++)
            mesh.indices[mesh.index_count++] = topology->triangles[t][corner];
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    free(mesh.indices);
    return collider;
}

/* Depth of the shirt in the trousers: the largest of 15 points of every shirt triangle. Points whose nearest
 * trouser point lies on the rim are left out. */
static double deepest_in_trousers(const tl_cloth *cloth)
{
    const double reach_m = 0.03;
    uint32_t *pieces = TL_NEW_ARRAY(uint32_t, cloth->particles.count);
    assert_int_equal(tl_layers_pieces(&cloth->topology, pieces), 2);
    uint32_t shirt = 0; /* the first vertex of the file is the shirt's */
    vec3s *positions;
    tl_collider *trousers = piece_collider(cloth, pieces, 1, &positions);
    double deepest = 0;
    for (size_t t = 0; t < cloth->topology.triangle_count; t++) {
        const uint32_t *v = cloth->topology.triangles[t];
        for (int k = 0; pieces[v[0]] == shirt && k < 25; k++) {
            int i = k / 5, j = k % 5;
            if (i + j > 4)
                continue;
            vec3d p = vec3d_scale(cloth->particles.x[v[0]], i / 4.0);
            p = vec3d_muladd(p, cloth->particles.x[v[1]], j / 4.0);
            p = vec3d_muladd(p, cloth->particles.x[v[2]], (4 - i - j) / 4.0);
            const double point[3] = {p.x, p.y, p.z};
            struct tl_contact contact;
            const double rim = 1e-3;
            if (tl_collider_query(trousers, point, reach_m, &contact) && contact.barycentric[0] > rim &&
                contact.barycentric[1] > rim && contact.barycentric[2] > rim)
                deepest = fmax(deepest, -contact.distance_m);
        }
    }
    tl_collider_destroy(&trousers);
    free(positions);
    free(pieces);
    return deepest;
}

static uint64_t hash_positions(const tl_cloth *cloth)
{
    return tl_hash(TL_HASH_START, cloth->particles.x, cloth->particles.count * sizeof(vec3d));
}

static void test_shirt_over_trousers(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment;
    tl_avatar avatar;
    assert_ok(tl_garment_load(test_data("garments/mh_male_casualsuit06.glb"), &garment, &error), error);
    assert_ok(tl_avatar_load(test_data("avatars/mh_male_body.glb"), &avatar, &error), error);
    double depths[2];
    for (int on = 0; on < 2; on++) {
        struct tl_cloth_fabric fabric = fabric_defaults();
        struct tl_cloth_params params = params_defaults();
        params.self_contact = on;
        tl_collider *collider = tl_collider_create(&avatar.model.mesh, true, &error);
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
        assert_ok(tl_cloth_settle(cloth, collider, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        depths[on] = deepest_in_trousers(cloth);
        printf("shirt: trousers %.2f mm deep in it, strain %.2f\n", 1e3 * depths[on], report.max_strain);
        assert_true(tl_cloth_is_still(cloth));
        assert_true(report.max_strain < 1);
        assert_near(report.deepest_m, 0, 0);
        size_t crossings = tl_crossings_count(NULL, &cloth->topology, cloth->particles.x);
        assert_true(on ? crossings == 0 : crossings > 100); /* 170 in the file */
        assert_int_equal(report.layer_count, 0);            /* layers serve to untangle; that is done */
        tl_cloth_mark_start(cloth);
        uint64_t hashes[2];
        for (int run = 0; on && run < 2; run++) {
            for (int frame = 0; frame < 5; frame++)
                assert_ok(tl_cloth_step(cloth, collider, &error), error);
            hashes[run] = hash_positions(cloth);
            assert_true(tl_cloth_is_still(cloth));
            tl_cloth_reset(cloth);
        }
        if (on)
            assert_true(hashes[0] == hashes[1]);
        tl_cloth_destroy(&cloth);
        tl_collider_destroy(&collider);
    }
    assert_true(depths[0] > 5e-3); /* without contact between layers the trousers show through */
    assert_true(depths[1] < 1e-3);
    tl_garment_release(&garment);
    tl_avatar_release(&avatar);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_heap),
        cmocka_unit_test(test_two_cloths),
        cmocka_unit_test(test_shirt_over_trousers),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
