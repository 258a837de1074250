/* Seams, hems and stitches: as drawn against explicit heights; the shader against its counterpart in C; far
 * against the mean of near; and every path that draws them. */
#include "assets/topology/borders.h"
#include "config/base/memory.h"
#include "render/construction/look.h"
#include "render/construction/options.h"
#include "render/inside.h"
#include "render/reference/shading_point.h"
#include "tests/render/scenes.h"

#include "tests/testing.h"

#include <epoxy/gl.h>

#include <string.h>

#define SIDE 128 /* samples */

static vec3s grey(vec3s direction)
{
    float g = 0.4f + 0.6f * fmaxf(direction.x + direction.z, 0); /* light from one side shows slopes */
    return (vec3s){{g, g, g}};
}

static const struct tl_construction jeans = {.seam = TL_SEAM_FLAT_FELLED,
                                             .hem = TL_HEM_TOPSTITCHED,
                                             .hem_m = 0.014f,
                                             .thickness_m = 0.0006f,
                                             .stitch_m = 0.003f,
                                             .thread_m = 0.0006f,
                                             .pucker_m = 0.0003f,
                                             .thread = {{0.6f, 0.3f, 0.05f}}};

/* A square of 0.1 m, whose sides are hems; two of them are made a seam's over and under side. */
static tl_borders make_borders(const tl_mesh *mesh)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        weld[i] = i;
    tl_borders borders = tl_borders_make(mesh, NULL, weld, NULL, 0);
    for (size_t i = 0; i < borders.border_count; i++) {
        struct tl_border *b = &borders.borders[i];
        if (b->from[0] == 0 && b->to[0] == 0) /* on the left */
            b->kind = (float)TL_BORDER_SEAM_OVER;
        if (b->from[1] == 0 && b->to[1] == 0) /* on top */
            b->kind = (float)TL_BORDER_SEAM_UNDER;
    }
    free(weld);
    return borders;
}

/* The square faces +Z; the eye looks at `target` of it from `distance_m`. */
struct cloth {
    struct test_scene scene;
    tl_borders borders;
};

static void open_cloth(struct cloth *cloth, const struct tl_construction *construction, vec3s target,
                       float distance_m)
{
    vec3s eye = glms_vec3_add(target, (vec3s){{0.05f * distance_m, 0.1f * distance_m, distance_m}});
    test_scene_open(&cloth->scene, test_environment(64, 32, grey), eye, target, 30, SIDE, SIDE);
    tl_material *material = test_scene_add(
        &cloth->scene, test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.05f, 8));
    material->diffuse = (vec3s){{0.2f, 0.3f, 0.5f}};
    material->construction = *construction;
    test_scene_refresh(&cloth->scene);
    cloth->borders = make_borders(&cloth->scene.shapes[0].mesh);
    cloth->scene.surfaces[0].borders = &cloth->borders;
    cloth->scene.settings.image.supersample = 1;
    cloth->scene.settings.light.lobe = TL_LOBE_DUAL;
}

static void close_cloth(struct cloth *cloth)
{
    tl_borders_release(&cloth->borders);
    test_scene_close(&cloth->scene);
}

struct layers {
    float normal[SIDE * SIDE][4], diffuse[SIDE * SIDE][4], point[SIDE * SIDE][4];
};

static void draw_layers(const struct cloth *cloth, tl_renderer *renderer, struct layers *out)
{
    tl_image image = test_scene_draw(&cloth->scene, renderer);
    const tl_target *target = &tl_renderer_frame_resources(renderer)->gbuffer.target;
    float(*const to[])[4] = {out->normal, out->diffuse, out->point};
    const enum tl_gbuffer_layer from[] = {TL_GBUFFER_NORMAL, TL_GBUFFER_DIFFUSE, TL_GBUFFER_POINT};
    for (int i = 0; i < 3; i++)
        glGetTextureImage(target->colours[from[i]].id, 0, GL_RGBA, GL_FLOAT, sizeof out->normal, to[i]);
    tl_image_release(&image);
}

/* ---- Explicit heights ---- */

/* The height over a point of the square, from the tables, by its distances to the four sides: left a seam,
 * top its under side, right and bottom hems, the nearest of each pair. */
static double height_at(const struct tl_construction_tables *tables, double x, double y)
{
    const double left = x + 0.05, right = 0.05 - x, top = 0.05 - y, bottom = y + 0.05;
    const double distances[] = {fmin(left, top), fmin(right, bottom)};
    const int kinds[] = {left < top ? TL_BORDER_SEAM_OVER : TL_BORDER_SEAM_UNDER, TL_BORDER_HEM};
    double sum = 0;
    for (int i = 0; i < 2; i++) {
        if (distances[i] >= (double)TL_BORDER_REACH_M)
            continue;
        double place = distances[i] / (double)CONSTRUCTION_STEP;
        const vec4s *from = &tables->profiles[kinds[i]][(int)place];
        double share = place - floor(place);
        sum += (1 - share) * (double)from[0].x + share * (double)from[1].x;
    }
    return sum;
}

/* Without pucker and with stitches out of sight, the normals are those of the surface at these heights. */
static void check_heights(tl_renderer *renderer, vec3s target)
{
    struct tl_construction plain = jeans;
    plain.pucker_m = 0;
    plain.seam = TL_SEAM_PLAIN;
    plain.hem = TL_HEM_PLAIN;
    struct cloth cloth;
    open_cloth(&cloth, &plain, target, 0.05f);
    struct layers *layers = TL_NEW(struct layers);
    struct tl_construction_tables *tables = TL_NEW(struct tl_construction_tables);
    draw_layers(&cloth, renderer, layers);
    tl_construction_tables_make(&plain, tables);
    int checked = 0, steep = 0;
    double worst = 0;
    const double half = (double)CONSTRUCTION_STEP; /* of the least footprint */
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = (double)layers->point[i][0], y = (double)layers->point[i][1];
        double rim = fmin(0.05 - fabs(x), 0.05 - fabs(y));
        bool near_diagonal = fabs(fabs(x) - fabs(y)) < 0.0005; /* where another border becomes the nearest */
        if (!(layers->point[i][3] > 0) || rim < 2 * half || near_diagonal)
            continue;
        double slope_x = (height_at(tables, x + half, y) - height_at(tables, x - half, y)) / (2 * half);
        double slope_y = (height_at(tables, x, y + half) - height_at(tables, x, y - half)) / (2 * half);
        double length = sqrt(1 + slope_x * slope_x + slope_y * slope_y);
        worst = fmax(worst, fabs((double)layers->normal[i][0] + slope_x / length));
        worst = fmax(worst, fabs((double)layers->normal[i][1] + slope_y / length));
        steep += hypot(slope_x, slope_y) > 0.3;
        checked++;
    }
    printf("heights at (%.3f, %.3f): %d normals, %d of them steep, off by up to %.4f\n", (double)target.x,
           (double)target.y, checked, steep, worst);
    assert_true(checked > SIDE * SIDE / 3 && steep > 50);
    assert_near(worst, 0, 0.02); /* half floats, and the rounding of a place on a table of 0.125 mm */
    free(tables);
    free(layers);
    close_cloth(&cloth);
}

static void test_normals_are_those_of_the_heights(void **state)
{
    struct test_device *device = *state;
    check_heights(device->renderer, (vec3s){{-0.045f, 0, 0}});
    check_heights(device->renderer, (vec3s){{0, 0.045f, 0}});
    check_heights(device->renderer, (vec3s){{0.042f, 0, 0}});
    check_heights(device->renderer, (vec3s){{0, -0.042f, 0}});
    check_heights(device->renderer, (vec3s){{0.042f, -0.042f, 0}});
}

/* ---- Shader and C ---- */

static void check_twins(tl_renderer *renderer, vec3s target, float distance_m)
{
    struct cloth cloth;
    tl_error error;
    open_cloth(&cloth, &jeans, target, distance_m);
    cloth.scene.settings.reference.terminator = TL_TERMINATOR_GEOMETRIC;
    for (size_t i = 0; i < cloth.borders.border_count; i++) /* the lower side is a dart's leg */
        if (cloth.borders.borders[i].from[1] == 1 && cloth.borders.borders[i].to[1] == 1)
            cloth.borders.borders[i].kind = (float)TL_BORDER_DART;
    struct layers *layers = TL_NEW(struct layers);
    draw_layers(&cloth, renderer, layers);
    struct tl_reference_scene scene;
    const struct tl_reference_request request =
        tl_frame_reference_request(&cloth.scene.frame, &cloth.scene.settings, NULL);
    assert_ok(tl_reference_scene_make(&request, &scene, &error), error);
    struct tl_view view = tl_view_make(&cloth.scene.frame.camera, SIDE, SIDE);
    int normals = 0, colours = 0, covered = 0, sewn = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const struct tl_ray_differential ray =
            tl_camera_ray(&view, SIDE, SIDE, i % SIDE, SIDE - 1 - i / SIDE);
        struct tl_shading_point found = tl_shading_point_find(&scene, &ray);
        if (!(found.cover > 0) || !(layers->point[i][3] > 0))
            continue;
        covered++;
        sewn += found.normal.z < 0.999f;
        for (int c = 0; c < 3; c++) {
            normals += fabsf(found.normal.raw[c] - layers->normal[i][c]) > 0.02f;
            colours += fabsf(found.diffuse.raw[c] - layers->diffuse[i][c]) > 0.01f;
        }
    }
    printf("twins from %.2f m: %d samples, %d bent; %d normals and %d colours differ\n", (double)distance_m,
           covered, sewn, normals, colours);
    assert_true(covered > SIDE * SIDE / 20 && sewn > covered / 20);
    /* rounding moves a sample over the middle between two borders, or beside the needle's hole */
    assert_true(normals <= covered / 100 && colours <= covered / 100);
    tl_reference_scene_release(&scene);
    free(layers);
    close_cloth(&cloth);
}

static void test_shader_agrees_with_c(void **state)
{
    struct test_device *device = *state;
    check_twins(device->renderer, (vec3s){{-0.04f, 0.01f, 0}}, 0.04f);
    check_twins(device->renderer, (vec3s){{-0.03f, 0.03f, 0}}, 0.1f);
    check_twins(device->renderer, (vec3s){{0.03f, -0.03f, 0}}, 0.1f);
    check_twins(device->renderer, (vec3s){{0, 0, 0}}, 0.6f);
}

/* ---- Footprints ---- */

static uint32_t seed = 7;
static float unit(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / 16777216.0f;
}

/* A sample sees the mean of what smaller samples within it see, and its spread is that of their slopes. */
static void test_far_is_the_mean_of_near(void **state)
{
    (void)state;
    enum { PARTS = 48, TRIALS = 300 };
    struct test_shape shape =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.05f, 8);
    tl_borders borders = make_borders(&shape.mesh);
    struct tl_construction_tables *tables = TL_NEW(struct tl_construction_tables);
    tl_construction_tables_make(&jeans, tables);
    double slopes = 0, slope_errors = 0, spreads = 0, spread_errors = 0, threads = 0, thread_errors = 0;
    double shades = 0, shade_errors = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        const float size = 0.0005f * powf(16, unit()), uv = size / 0.1f; /* 0.5 to 8 mm */
        const float u = 0.5f * size / 0.1f + 0.25f * unit(), v = 0.4f + 0.2f * unit();
        const uint32_t cells = 8; /* the triangle only names a list: that of the same border */
        const uint32_t triangle = 2 * (cells * (uint32_t)(v * (float)cells) + (uint32_t)(u * (float)cells));
        if ((int)((u - uv / 2) * (float)cells) != (int)((u + uv / 2) * (float)cells))
            continue;
        ConstructionLook far = tl_construction_look(tables, &borders, triangle, (vec2s){{u, v}},
                                                    (vec2s){{uv, 0}}, (vec2s){{0, uv}});
        ConstructionLook mean = construction_none();
        double squares = 0;
        const float part = uv / PARTS, share = 1.0f / (PARTS * PARTS);
        for (int i = 0; i < PARTS * PARTS; i++) {
            const int row = i / PARTS;
            vec2s at = {
                {u - uv / 2 + part * ((float)(i % PARTS) + 0.5f), v - uv / 2 + part * ((float)row + 0.5f)}};
            ConstructionLook near =
                tl_construction_look(tables, &borders, triangle, at, (vec2s){{part, 0}}, (vec2s){{0, part}});
            mean.slope_x += share * near.slope_x;
            mean.slope_y += share * near.slope_y;
            mean.thread += share * near.thread;
            mean.shade += share * near.shade;
            squares += (double)(share * (near.slope_x * near.slope_x + near.spread_x));
        }
        double spread = squares - (double)(mean.slope_x * mean.slope_x);
        slopes += fabs((double)mean.slope_x) + fabs((double)mean.slope_y);
        slope_errors +=
            fabs((double)(far.slope_x - mean.slope_x)) + fabs((double)(far.slope_y - mean.slope_y));
        spreads += spread;
        spread_errors += fabs((double)far.spread_x - spread);
        threads += (double)mean.thread;
        thread_errors += fabs((double)(far.thread - mean.thread));
        shades += (double)mean.shade;
        shade_errors += fabs((double)(far.shade - mean.shade));
    }
    printf("far against near: slopes off by %.1f %%, spread %.1f %%, thread %.1f %%, shade %.1f %%\n",
           100 * slope_errors / slopes, 100 * spread_errors / spreads, 100 * thread_errors / threads,
           100 * shade_errors / shades);
    /* Profiles and stitches are averaged exactly but for the blur of the smallest footprint; pucker as if its
     * envelope were even over a sample. */
    assert_near(slope_errors / slopes, 0, 0.1);
    assert_near(spread_errors / spreads, 0, 0.15);
    assert_near(thread_errors / threads, 0, 0.05);
    assert_near(shade_errors / shades, 0, 0.05);
    free(tables);
    tl_borders_release(&borders);
    test_shape_release(&shape);
}

/* ---- Paths ---- */

static tl_image draw_path(struct cloth *cloth, tl_renderer *renderer, int method, int ratio_at)
{
    struct tl_render_settings *settings = &cloth->scene.settings;
    settings->light.method = method;
    settings->light.visibility = TL_VISIBILITY_RAYS;
    settings->light.composition = TL_COMPOSE_RATIO;
    settings->light.ratio_at = ratio_at;
    settings->light.cut = TL_CUT_SPHERE;
    settings->light.regions = 48;
    settings->light.pem_size = 64;
    settings->reference.strata = 64;
    settings->reference.lobe_samples = 16;
    settings->reference.replicates = 16;
    return test_scene_draw(&cloth->scene, renderer);
}

static void test_paths_agree(void **state)
{
    struct test_device *device = *state;
    struct cloth cloth;
    open_cloth(&cloth, &jeans, (vec3s){{-0.02f, 0.02f, 0}}, 0.12f);
    tl_image plain, truth = draw_path(&cloth, device->renderer, TL_METHOD_REFERENCE, TL_RATIO_AT_SAMPLES);
    tl_image samples = draw_path(&cloth, device->renderer, TL_METHOD_PEM, TL_RATIO_AT_SAMPLES);
    tl_image vertices = draw_path(&cloth, device->renderer, TL_METHOD_PEM, TL_RATIO_AT_VERTICES);
    cloth.scene.surfaces[0].borders = NULL;
    cloth.scene.surfaces[0].topology_revision++;
    plain = draw_path(&cloth, device->renderer, TL_METHOD_PEM, TL_RATIO_AT_SAMPLES);
    double by_samples = test_compare(&samples, &truth).rel_rmse;
    double by_vertices = test_compare(&vertices, &truth).rel_rmse;
    double without = test_compare(&plain, &truth).rel_rmse;
    printf("against the reference: samples %.3f, vertices %.3f; without construction %.3f\n", by_samples,
           by_vertices, without);
    assert_true(without > 0.1);
    assert_near(by_samples, 0, 0.02); /* measured 0.010 */
    assert_near(by_vertices, 0, 0.02);
    tl_image_release(&plain);
    tl_image_release(&truth);
    tl_image_release(&samples);
    tl_image_release(&vertices);
    close_cloth(&cloth);
}

/* The back, with a colour of its own, by every path. */
static void test_back_has_its_colour(void **state)
{
    struct test_device *device = *state;
    const struct tl_construction none = {0};
    struct cloth cloth;
    open_cloth(&cloth, &none, (vec3s){{0, 0, 0}}, 0.2f);
    tl_material *material = &cloth.scene.shapes[0].material;
    material->specular = (vec3s){{0, 0, 0}};
    material->back = (struct tl_back){.is_given = true, .diffuse = {{0.1f, 0.6f, 0.3f}}};
    test_scene_refresh(&cloth.scene);
    vec3s behind = {{0, 0.05f, -0.2f}};
    cloth.scene.frame.camera.eye = behind;
    const int methods[] = {TL_METHOD_REFERENCE, TL_METHOD_PEM, TL_METHOD_PEM};
    const int ratios[] = {TL_RATIO_AT_SAMPLES, TL_RATIO_AT_SAMPLES, TL_RATIO_AT_VERTICES};
    for (size_t i = 0; i < TL_COUNT(methods); i++) {
        tl_image image = draw_path(&cloth, device->renderer, methods[i], ratios[i]);
        const float *middle = test_pixel(&image, SIDE / 2, SIDE / 2);
        assert_true(middle[0] > 0.001f); /* lit: grey light keeps the colour's ratios */
        assert_near(middle[1] / middle[0], 6, 0.1);
        assert_near(middle[2] / middle[0], 3, 0.05);
        tl_image_release(&image);
    }
    close_cloth(&cloth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normals_are_those_of_the_heights), cmocka_unit_test(test_shader_agrees_with_c),
        cmocka_unit_test(test_far_is_the_mean_of_near), cmocka_unit_test(test_paths_agree),
        cmocka_unit_test(test_back_has_its_colour)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
