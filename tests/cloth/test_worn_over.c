/* Three garments worn over each other as one: a dress, a short one over it, and a longer one over both, the
 * upper ones cut larger. They sew, settle and are then pulled about by a hand at the outer hem, while the
 * wearer turns: no two triangles cross in any frame, every garment stays on its side of the others, and none
 * enters the body. TOILE_FRAMES sets the length of the motion, TOILE_BRUTE=1 counts every frame by brute
 * force too. */
#include "assets/avatar.h"
#include "cloth/step/advance.h"
#include "tests/cloth/crossing_oracle.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/twist.h"
#include "tests/testing.h"

#include "config/base/log.h"

#define SETTLING 20
#define MOTION   20
#define HAND_M   0.25f /* how far the hand swings */
/* Sizes grow about this height on the form's axis, as seen from which dresses hide nothing of themselves: so
 * larger ones lie around smaller ones everywhere. */
#define CENTRE_Y 1.035f

static const struct layer {
    float size, longer_m;
} layers[] = {{1, 0}, {1.05f, -0.2f}, {1.1f, 0.05f}};
enum { LAYERS = TL_COUNT(layers) };

/* Vertices of layer i: first[i] to first[i + 1] - 1. */
struct stack {
    tl_garment garment;
    uint32_t first[LAYERS + 1];
};

static void add_seams(tl_garment *all, const tl_garment *garment, uint32_t first)
{
    all->seams = tl_resize(all->seams, all->seam_count + garment->seam_count, sizeof *all->seams);
    for (size_t i = 0; i < garment->seam_count; i++)
        all->seams[all->seam_count++] =
            (struct tl_seam_pair){first + garment->seams[i].a, first + garment->seams[i].b};
}

static void add_layer(struct stack *stack, int layer)
{
    tl_error error = {0};
    tl_garment garment;
    const struct tl_cut_params sizes = {.longer_m = layers[layer].longer_m};
    assert_ok(tl_garment_cut_sized("dress", 0.03f, &sizes, NULL, &garment, &error), error);
    const tl_mesh *mesh = &garment.model.mesh;
    tl_mesh *all = &stack->garment.model.mesh;
    const uint32_t first = stack->first[layer];
    size_t count = first + mesh->vertex_count;
    const float size = layers[layer].size;
    all->positions = tl_resize(all->positions, count, sizeof *all->positions);
    all->normals = tl_resize(all->normals, count, sizeof *all->normals);
    all->uvs = tl_resize(all->uvs, count, sizeof *all->uvs);
    all->indices = tl_resize(all->indices, all->index_count + mesh->index_count, sizeof *all->indices);
    stack->garment.pattern = tl_resize(stack->garment.pattern, count, sizeof(vec2s));
    const vec3s centre = {{0, CENTRE_Y, 0}};
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        all->positions[first + i] =
            glms_vec3_muladds(glms_vec3_sub(mesh->positions[i], centre), size, centre);
        all->normals[first + i] = mesh->normals[i];
        all->uvs[first + i] = mesh->uvs[i];
        stack->garment.pattern[first + i] = glms_vec2_scale(garment.pattern[i], size);
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        all->indices[all->index_count++] = first + mesh->indices[i];
    add_seams(&stack->garment, &garment, first);
    stack->first[layer + 1] = (uint32_t)count;
    all->vertex_count = count;
    tl_garment_release(&garment);
}

/* The lowest vertex of the outer layer at the front. */
static uint32_t find_hem(const struct stack *stack)
{
    const vec3s *x = stack->garment.model.mesh.positions;
    uint32_t hem = stack->first[LAYERS - 1];
    for (uint32_t i = hem; i < stack->first[LAYERS]; i++)
        if (x[i].y - x[i].z < x[hem].y - x[hem].z)
            hem = i;
    return hem;
}

/* The hand leads its vertex to both sides, away from the body and up. */
static vec3s hand_at(vec3s start, int frame)
{
    float turn = 2 * (float)M_PI * (float)frame / 40;
    return glms_vec3_add(
        start, (vec3s){{HAND_M * sinf(turn), HAND_M * (1 - cosf(turn)) / 2, HAND_M * sinf(turn / 2)}});
}

/* Mean distance from the form's axis, m, of a layer's vertices between two heights. */
static double girth_radius(const struct stack *stack, tl_cloth *cloth, int layer, double low, double high)
{
    double sum = 0;
    size_t count = 0;
    for (uint32_t i = stack->first[layer]; i < stack->first[layer + 1]; i++) {
        const vec3d x = cloth->particles.x[cloth->topology.weld[i]];
        if (x.y < low || x.y > high)
            continue;
        sum += sqrt(x.x * x.x + x.z * x.z);
        count++;
    }
    assert_true(count > 0);
    return sum / (double)count;
}

static void test_three_garments(void **state)
{
    (void)state;
    tl_error error = {0};
    struct stack stack = {0};
    for (int i = 0; i < LAYERS; i++)
        add_layer(&stack, i);
    tl_avatar avatar = tl_avatar_form();
    const tl_mesh *body = &avatar.model.mesh;
    vec3s *pose = TL_NEW_ARRAY(vec3s, body->vertex_count);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(body, true, &error);
    tl_cloth *cloth = tl_cloth_create(&stack.garment, &fabric, &params, &error);
    assert_non_null(cloth);
    const uint32_t hem = find_hem(&stack);
    const vec3s start = stack.garment.model.mesh.positions[hem];
    const char *wanted = getenv("TOILE_FRAMES");
    const int motion = wanted ? atoi(wanted) : MOTION;
    double strain = 0, deepest = 0;
    for (int frame = 0; frame < SETTLING + motion; frame++) {
        struct tl_advance_params advance = {.drag = frame < SETTLING ? 5 : 0};
        if (frame >= SETTLING) {
            twist_pose(body, frame - SETTLING + 1, pose);
            tl_collider_move(collider, pose);
            tl_cloth_grab(cloth, hem, hand_at(start, frame - SETTLING));
        }
        assert_ok(tl_cloth_advance(cloth, collider, &advance, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        assert_int_equal(report.crossing_count, 0);
        if (getenv("TOILE_BRUTE") || frame % 10 == 9)
            assert_int_equal(oracle_crossings(&cloth->topology, cloth->particles.x), 0);
        strain = fmax(strain, report.max_strain);
        deepest = fmax(deepest, report.deepest_m);
    }
    double radius[LAYERS];
    for (int i = 0; i < LAYERS; i++)
        radius[i] = girth_radius(&stack, cloth, i, 0.98, 1.1);
    printf("three garments, %zu vertices: no crossing in %d frames, strain %.2f, waist radii %.1f, %.1f, "
           "%.1f mm\n",
           cloth->particles.count, SETTLING + motion, strain, 1e3 * radius[0], 1e3 * radius[1],
           1e3 * radius[2]);
    assert_true(radius[0] < radius[1] && radius[1] < radius[2]);
    assert_true(strain < 1);
    assert_near(deepest, 0, 1e-6);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_garment_release(&stack.garment);
    tl_avatar_release(&avatar);
    free(pose);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_three_garments)};
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
