/* What is around each vertex, of two sheets that lie above each other over the ground: the same before the
 * cloth has moved as after. */
#include "cloth/cage/clearance.h"
#include "cloth/step/advance.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#define ABOVE_M 0.006
#define GAP_M   0.001

static vec3s over_the_ground(double u, double v)
{
    return (vec3s){{(float)u, (float)ABOVE_M, (float)-v}};
}

static tl_garment two_sheets(const struct sheet_shape *shape)
{
    tl_garment garment = sheet_make(shape, over_the_ground), upper = sheet_make(shape, over_the_ground);
    tl_mesh *mesh = &garment.model.mesh;
    const size_t count = mesh->vertex_count, index_count = mesh->index_count;
    mesh->positions = tl_resize(mesh->positions, 2 * count, sizeof *mesh->positions);
    mesh->normals = tl_resize(mesh->normals, 2 * count, sizeof *mesh->normals);
    mesh->uvs = tl_resize(mesh->uvs, 2 * count, sizeof *mesh->uvs);
    mesh->indices = tl_resize(mesh->indices, 2 * index_count, sizeof *mesh->indices);
    garment.pattern = tl_resize(garment.pattern, 2 * count, sizeof *garment.pattern);
    for (size_t i = 0; i < count; i++) {
        mesh->positions[count + i] = glms_vec3_add(mesh->positions[i], (vec3s){{0, (float)GAP_M, 0}});
        mesh->normals[count + i] = mesh->normals[i];
        mesh->uvs[count + i] = mesh->uvs[i];
        garment.pattern[count + i] = garment.pattern[i];
    }
    for (size_t i = 0; i < index_count; i++)
        mesh->indices[index_count + i] = (uint32_t)count + mesh->indices[i];
    mesh->vertex_count *= 2;
    mesh->index_count *= 2;
    sheet_free(&upper);
    return garment;
}

/* Heights to 0.1 um; no room is larger than half of the gap, and none is lost. */
static void check(const tl_cloth *cloth, const tl_collider *collider, size_t count)
{
    vec3s *positions = TL_NEW_ARRAY(vec3s, count);
    struct tl_clearance *out = TL_NEW_ARRAY(struct tl_clearance, count);
    tl_cloth_positions(cloth, positions);
    tl_cloth_clearances(cloth, collider, out);
    for (size_t i = 0; i < count; i++) {
        const struct tl_clearance *at = &out[tl_cloth_weld(cloth)[i]];
        float gap = fabsf(positions[i].y - positions[(i + count / 2) % count].y);
        assert_near((double)at->height_m, (double)positions[i].y, 1e-7);
        assert_near((double)at->up.y, 1, 1e-6);
        assert_true(at->room_m <= 0.5f * gap + 1e-7f);
        assert_true(at->room_m > 0.3f * gap);
    }
    free(positions);
    free(out);
}

static void sheets_over_the_ground(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {6, 6, 0.12, 0.12};
    tl_garment garment = two_sheets(&shape);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.self_contact = true;
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    assert_ok(ground != NULL, error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(cloth != NULL, error);
    check(cloth, ground, garment.model.mesh.vertex_count);
    const struct tl_advance_params advance = {.drag = 5};
    assert_ok(tl_cloth_advance(cloth, ground, &advance, &error), error);
    check(cloth, ground, garment.model.mesh.vertex_count);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&ground);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sheets_over_the_ground)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
