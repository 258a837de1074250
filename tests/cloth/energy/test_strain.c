/* Strains against their closed forms under affine maps, and against the energy that is computed from them. */
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "cloth/energy/energy.h"
#include "cloth/energy/strain.h"

static const struct sheet_shape shape = {.columns = 5, .rows = 7, .width = 0.5, .height = 0.7};

/* Float positions near 1 m are rounded by 6e-8: relative to sides of 0.1 m, that is this much with a margin.
 */
#define ROUNDING 3e-6

/* The map x -> F x + t in the sheet's plane. The columns are the images of the first and second axis. */
struct affine {
    vec3s u, v, t;
};

static void place(const tl_garment *garment, const struct affine *map, vec3s *out)
{
    for (size_t i = 0; i < garment->model.mesh.vertex_count; i++) {
        vec3s p = garment->model.mesh.positions[i];
        out[i] =
            glms_vec3_add(map->t, glms_vec3_add(glms_vec3_scale(map->u, p.x), glms_vec3_scale(map->v, p.y)));
    }
}

static void expect(const tl_garment *garment, const struct affine *map, double warp, double weft,
                   double shear)
{
    size_t count = garment->model.mesh.vertex_count;
    vec3s *positions = TL_NEW_ARRAY(vec3s, count), *strains = TL_NEW_ARRAY(vec3s, count);
    tl_strains *rest = tl_strains_create(garment);
    place(garment, map, positions);
    tl_strains_update(rest, positions, strains);
    for (size_t i = 0; i < count; i++) {
        assert_near(strains[i].x, warp, ROUNDING);
        assert_near(strains[i].y, weft, ROUNDING);
        assert_near(strains[i].z, shear, ROUNDING);
    }
    tl_strains_destroy(&rest);
    free(positions);
    free(strains);
}

static const struct affine identity = {.u = {{1, 0, 0}}, .v = {{0, 1, 0}}};

static void closed_forms(void **state)
{
    (void)state;
    tl_garment garment = sheet_make(&shape, NULL);
    struct affine map = identity;
    expect(&garment, &map, 0, 0, 0);
    map.v.y = 1.1f; /* 10 % along the warp */
    expect(&garment, &map, 0.1, 0, 0);
    map = identity;
    map.u.x = 0.93f; /* 7 % shorter along the weft */
    expect(&garment, &map, 0, -0.07, 0);
    map = identity;
    map.v = (vec3s){{tanf(0.3f), 1, 0}}; /* simple shear: warp threads tilt and stretch */
    expect(&garment, &map, 1 / cos(0.3) - 1, 0, sin(0.3));
    map.v = (vec3s){{sinf(0.3f), cosf(0.3f), 0}}; /* pure shear: threads keep their length */
    expect(&garment, &map, 0, 0, sin(0.3));
    tl_garment_release(&garment);
}

static void rigid_motions_strain_nothing(void **state)
{
    (void)state;
    tl_garment garment = sheet_make(&shape, NULL);
    for (int i = 1; i < 6; i++) {
        mat4s turn = glms_rotate_make((float)i, glms_vec3_normalize((vec3s){{1, (float)i, -0.5f}}));
        const struct affine map = {.u = glms_mat4_mulv3(turn, identity.u, 0),
                                   .v = glms_mat4_mulv3(turn, identity.v, 0),
                                   .t = {{0.3f, 1, -0.2f}}};
        expect(&garment, &map, 0, 0, 0);
    }
    tl_garment_release(&garment);
}

/* A panel cut at an angle. Under stretch along y the threads stretch by the square of their cosines. The
 * pattern position of a point is the point rotated back by the angle. */
static void turned_panels(void **state)
{
    (void)state;
    for (int step = 0; step <= 6; step++) {
        double angle = 0.25 * step, c = cos(angle), s = sin(angle), stretch = 1.1;
        /* Threads in the sheet's plane: weft (c, s), warp (-s, c); y grows by `stretch`. */
        double weft = hypot(c, stretch * s), warp = hypot(s, stretch * c);
        double shear = (-c * s + stretch * stretch * s * c) / (weft * warp);
        struct affine map = identity;
        map.v.y = (float)stretch;
        tl_garment garment = sheet_make(&shape, NULL);
        for (size_t i = 0; i < garment.model.mesh.vertex_count; i++) {
            vec3s p = garment.model.mesh.positions[i];
            double u = c * (double)p.x + s * (double)p.y, v = c * (double)p.y - s * (double)p.x;
            garment.pattern[i] = (vec2s){{(float)u, (float)v}};
            /* UVs at another scale: only their directions define the threads. */
            garment.model.mesh.uvs[i] = (vec2s){{3 * (float)u, -3 * (float)v}};
        }
        expect(&garment, &map, warp - 1, weft - 1, shear);
        free(garment.pattern);
        garment.pattern = NULL; /* rest is the start's shape; threads follow the UVs */
        expect(&garment, &map, warp - 1, weft - 1, shear);
        tl_garment_release(&garment);
    }
}

/* E = A/2 [ k_weft weft^2 + k_warp warp^2 + k_shear shear^2 ] of a flat sheet under any deformation in its
 * plane. */
static void energy_follows_from_strains(void **state)
{
    (void)state;
    tl_garment garment = sheet_make(&shape, NULL);
    const tl_mesh *mesh = &garment.model.mesh;
    const struct affine map = {.u = {{1.04f, 0.05f, 0}}, .v = {{-0.12f, 0.97f, 0}}};
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    vec3s *positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count),
          *strains = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    vec3d *x = TL_NEW_ARRAY(vec3d, mesh->vertex_count + 1), *forces = TL_NEW_ARRAY(vec3d, mesh->vertex_count);
    place(&garment, &map, positions);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        weld[i] = i;
        x[i] = vec3d_from(positions[i]);
    }
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, mesh->vertex_count);
    vec2s(*rest)[3] = tl_rest_shapes(&garment, &topology);
    struct tl_energy energy = tl_energy_build(&topology, (const vec2s(*)[3])rest, NULL);
    const struct tl_cloth_fabric fabric = {.stretch_weft = 2800, .stretch_warp = 4500, .shear = 190};
    tl_energy_set_fabric(&energy, &fabric);
    double joules = tl_energy_evaluate(&energy, &fabric, mesh->vertex_count, x, forces);
    tl_strains *own = tl_strains_create(&garment);
    tl_strains_update(own, positions, strains);
    double warp = (double)strains[0].x, weft = (double)strains[0].y, shear = (double)strains[0].z;
    double expected = 0.5 * shape.width * shape.height *
                      (fabric.stretch_weft * weft * weft + fabric.stretch_warp * warp * warp +
                       fabric.shear * shear * shear);
    assert_true(expected > 1);
    assert_near(joules / expected, 1, 1e-3); /* strains of a few percent, each within ROUNDING */
    tl_strains_destroy(&own);
    tl_energy_release(&energy);
    tl_topology_release(&topology);
    free(rest);
    free(weld);
    free(positions);
    free(strains);
    free(x);
    free(forces);
    tl_garment_release(&garment);
}

/* A triangle without area has no strain, and a vertex without triangles has none either. */
static void slivers_have_no_strain(void **state)
{
    (void)state;
    tl_garment garment = sheet_make(&shape, NULL);
    garment.model.mesh.indices[2] = garment.model.mesh.indices[1];
    garment.model.mesh.indices[5] = garment.model.mesh.indices[4] = garment.model.mesh.indices[3];
    struct affine map = identity;
    map.v.y = 1.1f;
    size_t count = garment.model.mesh.vertex_count;
    vec3s *positions = TL_NEW_ARRAY(vec3s, count), *strains = TL_NEW_ARRAY(vec3s, count);
    tl_strains *rest = tl_strains_create(&garment);
    place(&garment, &map, positions);
    tl_strains_update(rest, positions, strains);
    assert_near(strains[0].x, 0, 0); /* both of its triangles are gone */
    for (size_t i = 1; i < count; i++)
        assert_near(strains[i].x, 0.1, ROUNDING);
    tl_strains_destroy(&rest);
    free(positions);
    free(strains);
    tl_garment_release(&garment);
}

/* Panels that meet at a seam have separate vertices there: the strain of one is not averaged with the
 * other's. */
static void strains_are_separate_at_seams(void **state)
{
    (void)state;
    tl_garment garment = sheet_make(&shape, NULL);
    tl_mesh *mesh = &garment.model.mesh;
    size_t half = mesh->vertex_count, count = 2 * half;
    mesh->positions = tl_resize(mesh->positions, count, sizeof *mesh->positions);
    mesh->uvs = tl_resize(mesh->uvs, count, sizeof *mesh->uvs);
    garment.pattern = tl_resize(garment.pattern, count, sizeof *garment.pattern);
    mesh->indices = tl_resize(mesh->indices, 2 * mesh->index_count, sizeof *mesh->indices);
    for (size_t i = 0; i < half; i++) { /* a second panel to the right, sewn on where the first ends */
        mesh->positions[half + i] = glms_vec3_add(mesh->positions[i], (vec3s){{(float)shape.width, 0, 0}});
        mesh->uvs[half + i] = mesh->uvs[i];
        garment.pattern[half + i] = garment.pattern[i];
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        mesh->indices[mesh->index_count + i] = mesh->indices[i] + (uint32_t)half;
    mesh->index_count *= 2;
    mesh->vertex_count = count;
    vec3s *positions = TL_NEW_ARRAY(vec3s, count), *strains = TL_NEW_ARRAY(vec3s, count);
    for (size_t i = 0; i < count; i++) {
        positions[i] = mesh->positions[i];
        if (i >= half)
            positions[i].x = (float)shape.width + 1.2f * (positions[i].x - (float)shape.width);
    }
    tl_strains *rest = tl_strains_create(&garment);
    tl_strains_update(rest, positions, strains);
    for (size_t i = 0; i < count; i++)
        assert_near(strains[i].y, i < half ? 0 : 0.2, ROUNDING);
    tl_strains_destroy(&rest);
    free(positions);
    free(strains);
    tl_garment_release(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms),           cmocka_unit_test(rigid_motions_strain_nothing),
        cmocka_unit_test(turned_panels),          cmocka_unit_test(energy_follows_from_strains),
        cmocka_unit_test(slivers_have_no_strain), cmocka_unit_test(strains_are_separate_at_seams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
