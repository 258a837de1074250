/* Frames that the graphics card draws against the CPU's of ratios at vertices, from the same directions: the
 * same cover, nearly the same light, whatever the material, the side, the turn of the light; the same bytes
 * twice, and whatever was drawn before; the CPU's bytes where the card does not draw. */
#include "tests/render/drawn_scene.h"

#include "assets/topology/borders.h"
#include "config/base/memory.h"
#include "render/metrics/compare.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH  120
#define HEIGHT 104

#define SMALL_WIDTH  72
#define SMALL_HEIGHT 64

/* ---- Editors ---- */

#define BALL_HEIGHT_M  0.63f
#define BALL_RADIUS_M  0.38f
#define SHEET_HEIGHT_M 1
#define SHEET_HALF_M   0.55f
#define SHEET_WAVE_M   0.07f /* amplitude */

static void be_faceted(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn_scene_cloth(drawn)->gloss.ward = TL_WARD_BOUNDED;
}

static void have_toksvig(struct drawn_scene *drawn)
{
    be_woven(drawn);
    drawn->scene.settings.detail.minify = TL_DETAIL_MINIFY_TOKSVIG;
}

static void have_occlusion(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    drawn_scene_cloth(drawn)->specular_map = drawn_scene_map(&drawn->maps[MAP_COLOUR]);
    drawn_scene_cloth(drawn)->occlusion_map = drawn_scene_map(&drawn->maps[MAP_COLOUR]);
    drawn_scene_cloth(drawn)->occlusion_strength = 0.8f;
}

static void lean(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    drawn_scene_cloth(drawn)->fuzz = (struct tl_fuzz){{{1, 0.7f, 0.4f}}, 0.5f, 1};
}

static void be_lined(struct drawn_scene *drawn)
{
    have_occlusion(drawn);
    drawn_scene_cloth(drawn)->back = (struct tl_back){true, {{0.1f, 0.2f, 0.6f}}, {{0.1f, 0.1f, 0.1f}}};
    look_up(drawn);
}

static void turn(struct drawn_scene *drawn)
{
    have_threads(drawn);
    drawn->scene.frame.environment_yaw = 1;
}

static void have_a_ground(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.settings.image.ground = true;
}

static void look_from_below_ground(struct drawn_scene *drawn)
{
    have_a_ground(drawn);
    drawn->scene.frame.camera.eye = (vec3s){{0.8f, -0.6f, 1.6f}};
}

static void have_beckmann_facets(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_TORRANCE_SPARROW;
    drawn_scene_cloth(drawn)->gloss.facets = TL_FACETS_BECKMANN;
}

/* Ward's facets, or with `model` others, of a metal or of glass. */
static void have_an_index(struct drawn_scene *drawn, int model, int fresnel)
{
    have_threads(drawn);
    struct tl_gloss *gloss = &drawn_scene_cloth(drawn)->gloss;
    gloss->model = model;
    gloss->fresnel = fresnel;
    gloss->index = fresnel == TL_FRESNEL_CONDUCTOR ? 0.3f : 1.5f;
    gloss->extinction = 3;
    drawn_scene_cloth(drawn)->specular = (vec3s){{1, 0.8f, 0.5f}};
}

static void be_glass(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_WARD, TL_FRESNEL_DIELECTRIC);
}

static void be_metal(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_WARD, TL_FRESNEL_CONDUCTOR);
    look_up(drawn);
}

static void have_metal_facets(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_TORRANCE_SPARROW, TL_FRESNEL_CONDUCTOR);
}

static void blinn_phong(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_BLINN_PHONG, TL_FRESNEL_SCHLICK);
}

static void cosine_lobe(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_COSINE_LOBE, TL_FRESNEL_DIELECTRIC);
}

static void banks(struct drawn_scene *drawn)
{
    have_an_index(drawn, TL_REFLECT_BANKS, TL_FRESNEL_DIELECTRIC);
    drawn_scene_cloth(drawn)->glossiness = 0.97f;
}

static void have_a_coat(struct drawn_scene *drawn)
{
    lean(drawn);
    drawn_scene_cloth(drawn)->coat = 0.8f;
    drawn_scene_cloth(drawn)->coat_glossiness = 0.95f;
}

static void be_black(struct drawn_scene *drawn)
{
    for (int i = 0; i < 2; i++)
        drawn->scene.shapes[i].material.diffuse = (vec3s){{0, 0, 0}};
}

static void be_lacquered(struct drawn_scene *drawn)
{
    be_black(drawn);
    drawn_scene_cloth(drawn)->coat = 1;
    drawn_scene_cloth(drawn)->coat_glossiness = 0.9f;
}

static void emit(struct drawn_scene *drawn)
{
    lean(drawn);
    drawn_scene_cloth(drawn)->emission = (vec3s){{0.5f, 0.3f, 0.2f}};
    drawn_scene_cloth(drawn)->emission_map = drawn_scene_map(&drawn->maps[MAP_COLOUR]);
}

static void have_a_lamp(struct drawn_scene *drawn)
{
    have_threads(drawn);
    drawn->scene.lamps[0] = test_lamp_towards((vec3s){{-0.5f, 1, 0.3f}}, 2);
    drawn->scene.frame.lamp_count = 1;
}

/* Points on both sides of the sheet, and one that shines from afar. */
static void have_lamps(struct drawn_scene *drawn)
{
    lean(drawn);
    drawn->scene.lamps[0] = test_lamp_at((vec3s){{0.5f, 1.3f, 0.6f}}, 0.6f);
    drawn->scene.lamps[1] = test_lamp_at((vec3s){{-0.3f, 0.82f, 0.4f}}, 0.15f);
    drawn->scene.lamps[2] = test_lamp_towards((vec3s){{0.9f, 0.3f, 0.3f}}, 1);
    drawn->scene.frame.lamp_count = 3;
}

static void be_rough(struct drawn_scene *drawn)
{
    have_lamps(drawn);
    for (int i = 0; i < 2; i++)
        drawn->scene.shapes[i].material.diffuse_roughness = 0.7f;
}

static void be_threads_under_lamps(struct drawn_scene *drawn)
{
    have_lamps(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_BANKS;
}

static void have_a_lamp_below(struct drawn_scene *drawn)
{
    have_lamps(drawn);
    look_up(drawn);
}

static void have_lamps_and_voile(struct drawn_scene *drawn)
{
    have_lamps(drawn);
    be_voile(drawn);
    look_up(drawn);
}

/* Holes that show the ball and the backs of the sheet. */
static void have_clamped_holes(struct drawn_scene *drawn)
{
    have_holes(drawn);
    drawn_scene_cloth(drawn)->diffuse_map.clamp_v = true;
    look_up(drawn);
}

/* Over half of the sheet: light falls through it on the ball, and what that sends back leaves. */
static void have_a_large_hole(struct drawn_scene *drawn)
{
    have_holes(drawn);
    struct tl_map *map = &drawn_scene_cloth(drawn)->diffuse_map;
    map->transform = (struct tl_uv_transform){.scale = {0.07f, 0.12f}};
}

static void look_up_at_voile(struct drawn_scene *drawn)
{
    be_voile(drawn);
    drawn_scene_cloth(drawn)->fuzz = (struct tl_fuzz){{{0.2f, 0.2f, 0.2f}}, 0.5f, 0};
    look_up(drawn);
}

static void supersample(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.settings.image.supersample = 2;
}

/* Each shape is of a class of its own. */
static void be_different(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    tl_material *ball = &drawn->scene.shapes[0].material;
    ball->diffuse_map = drawn_scene_map(&drawn->maps[MAP_HOLES]);
    ball->gloss.model = TL_REFLECT_WARD;
    ball->gloss.width_weft = ball->gloss.width_warp = 0.2f;
    ball->fuzz = (struct tl_fuzz){{{0.3f, 0.3f, 0.3f}}, 0.7f, 0};
}

/* Light comes from the regions alone. */
static void have_no_sun(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn->scene.settings.light.sun = false;
}

static void be_sewn(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->construction = (struct tl_construction){.seam = TL_SEAM_FLAT_FELLED,
                                                                      .hem = TL_HEM_TOPSTITCHED,
                                                                      .hem_m = 0.1f,
                                                                      .thickness_m = 0.01f,
                                                                      .stitch_m = 0.05f,
                                                                      .thread_m = 0.015f,
                                                                      .pucker_m = 0.004f,
                                                                      .thread = {{0.6f, 0.3f, 0.05f}}};
}

/* ---- Drawing ---- */

/* Tilts the normals of a grid so that those of neighbours differ: in motion the CPU takes means of the ratios
 * of neighbours, by how alike their normals are. */
static void tilt_normals(tl_mesh *mesh, size_t columns)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float angle = (float)((i % columns + 2 * (i / columns)) % 3) * 2.0943951f;
        const vec3s n = mesh->normals[i], t = glms_vec3(mesh->tangents[i]);
        const vec3s aside = glms_vec3_add(glms_vec3_scale(t, cosf(angle)),
                                          glms_vec3_scale(glms_vec3_cross(n, t), sinf(angle)));
        mesh->normals[i] = glms_vec3_normalize(glms_vec3_add(n, glms_vec3_scale(aside, 0.5f)));
    }
}

static void open_small(struct drawn_scene *drawn, int width, int height)
{
    drawn_scene_open(drawn, width, height);
    struct test_shape *shapes = drawn->scene.shapes;
    for (int i = 0; i < 2; i++)
        test_shape_release(&shapes[i]);
    shapes[0] = test_sphere((vec3s){{0, BALL_HEIGHT_M, 0}}, BALL_RADIUS_M, 16); /* it touches the sheet */
    shapes[1] = test_sheet(SHEET_HEIGHT_M, SHEET_HALF_M, SHEET_WAVE_M, 2, 24);
    tilt_normals(&shapes[0].mesh, 33);
    tilt_normals(&shapes[1].mesh, 25);
    struct tl_light_params *light = &drawn->plain.settings.light;
    light->ratio_at = TL_RATIO_AT_VERTICES;
    light->regions = 24;
    light->rays = light->card_rays = 1; /* both trace the middle of each region */
    drawn->plain.frame.still = false;
}

static tl_image draw_by(tl_renderer *renderer, struct drawn_scene *drawn, int device)
{
    drawn->scene.settings.light.device = device;
    return test_scene_draw(&drawn->scene, renderer);
}

static tl_image draw_anew(tl_renderer *renderer, struct drawn_scene *drawn, int device)
{
    tl_error error = {0};
    assert_ok(tl_renderer_forget_scene(renderer, &error), error);
    return draw_by(renderer, drawn, device);
}

/* Of the first channel of all pixels. */
static double mean_of(const tl_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)tl_image_floats(image)[4 * i];
    return sum / (double)count;
}

/* ---- Pictures ---- */

/* Maps, lobe maps and the image are rounded to halves, which is 0.0005 of a value and of cover, and gloss
 * maps and bumps steepen that; visibility to bytes. The ground's normals are alike: the CPU's ratios there
 * are means of neighbours; its ratios of facets are of lobes that are fitted, the card's of those of a
 * table, and a metal has nothing else. What a coat reflects the CPU compares at samples, between vertices,
 * too. That, and what lies at the edges of the sun's shadows, is bounded by what came out, and a half of it.
 */
struct picture_case {
    const char *name;
    editor *edit;
    double rmse, most; /* relative RMSE of all pixels; without those at the edges of the sun's shadows */
    int covers;        /* pixels at the edges of holes and layers, at most */
    editor *without;   /* what the CPU lights at vertices, of what it lights at samples; NULL: all */
};

static const struct picture_case pictures[] = {
    {"matt", be_matt, 0.035, 0.0015, 0, NULL},
    {"glossy", be_glossy, 0.035, 0.0015, 0, NULL},
    {"no sun", have_no_sun, 0.035, 0.0015, 0, NULL},
    {"Ward", be_satin, 0.035, 0.0015, 0, NULL},
    {"Ward, bounded", be_faceted, 0.035, 0.0015, 0, NULL},
    {"threads of one system", have_warp_threads, 0.035, 0.0015, 0, NULL},
    {"threads of two", have_threads, 0.035, 0.0015, 0, NULL},
    {"threads, light turned", turn, 0.035, 0.0015, 0, NULL},
    {"weave, LEAN", be_woven, 0.035, 0.0015, 0, NULL},
    {"weave, Toksvig", have_toksvig, 0.035, 0.0015, 0, NULL},
    {"streaks", be_streaked, 0.035, 0.0015, 0, NULL},
    {"maps", be_mapped, 0.035, 0.0015, 0, NULL},
    {"occlusion", have_occlusion, 0.035, 0.0015, 0, NULL},
    {"fuzz", be_fuzzy, 0.035, 0.0015, 0, NULL},
    {"fuzz that leans", lean, 0.035, 0.0015, 0, NULL},
    {"a back of its own", be_lined, 0.035, 0.0015, 0, NULL},
    {"seams", be_sewn, 0.035, 0.0015, 0, NULL},
    {"ground", have_a_ground, 0.035, 0.014, 0, NULL},
    {"from below the ground", look_from_below_ground, 0.035, 0.0015, 0, NULL},
    {"Beckmann's facets", have_beckmann_facets, 0.035, 0.0015, 0, NULL},
    {"GGX facets, threads", have_ggx_facets, 0.035, 0.0015, 0, NULL},
    {"glass", be_glass, 0.035, 0.0015, 0, NULL},
    {"metal, from below", be_metal, 0.035, 0.0015, 0, NULL},
    {"facets of metal", have_metal_facets, 0.035, 0.004, 0, NULL},
    {"Blinn and Phong", blinn_phong, 0.035, 0.0015, 0, NULL},
    {"Lewis's lobe", cosine_lobe, 0.035, 0.0015, 0, NULL},
    {"Banks's threads", banks, 0.035, 0.0015, 0, NULL},
    {"coat", have_a_coat, 0.035, 0.015, 0, lean},
    {"coat alone", be_lacquered, 0.25, 0.18, 0, be_black},
    {"emission", emit, 0.035, 0.004, 0, lean},
    {"lamp", have_a_lamp, 0.035, 0.0015, 0, NULL},
    {"three lamps", have_lamps, 0.035, 0.0015, 0, NULL},
    {"rough", be_rough, 0.035, 0.0015, 0, NULL},
    {"Banks's, lamps", be_threads_under_lamps, 0.035, 0.0015, 0, NULL},
    {"lamps, from below", have_a_lamp_below, 0.035, 0.0015, 0, NULL},
    {"lamps through voile", have_lamps_and_voile, 0.035, 0.006, 10, NULL},
    {"holes", have_holes, 0.06, 0.0015, 10, NULL},
    {"holes, from below", have_clamped_holes, 0.08, 0.0015, 10, NULL},
    {"transmission", transmit, 0.035, 0.0015, 0, NULL},
    {"open", be_open, 0.035, 0.006, 10, NULL},
    {"voile", be_voile, 0.035, 0.006, 10, NULL},
    {"voile, from below", look_up_at_voile, 0.035, 0.006, 10, NULL},
    {"four samples a pixel", supersample, 0.035, 0.0015, 0, NULL},
    {"two classes", be_different, 0.035, 0.0015, 0, NULL},
};

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The relative RMSE without the 2 % of the covered pixels that differ most. The card looks for the sun at
 * other places of it, and in cells: what lies at the edge of a shadow differs by up to all of the sun's
 * light. */
static double most_of_difference(const tl_image *made, const tl_image *expected)
{
    const size_t all = (size_t)made->width * (size_t)made->height;
    double *squares = TL_NEW_ARRAY(double, all), sum = 0, mean = 0;
    size_t count = 0;
    for (size_t i = 0; i < all; i++) {
        const float *a = tl_image_floats(made) + 4 * i, *b = tl_image_floats(expected) + 4 * i;
        if (b[3] <= 0)
            continue;
        for (int c = 0; c < 3; c++) {
            squares[count] += (double)((a[c] - b[c]) * (a[c] - b[c]));
            mean += (double)b[c];
        }
        count++;
    }
    qsort(squares, count, sizeof *squares, compare_doubles);
    const size_t kept = count - count / 50;
    for (size_t i = 0; i < kept; i++)
        sum += squares[i];
    free(squares);
    return sqrt(sum / (3 * (double)kept)) / (mean / (3 * (double)count));
}

/* Those of a sheet whose outline is not welded to anything. */
static tl_borders make_borders(const tl_mesh *mesh)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        weld[i] = i;
    tl_borders borders = tl_borders_make(mesh, NULL, weld, NULL, 0);
    free(weld);
    return borders;
}

static void apply(struct drawn_scene *drawn, editor *edit, const tl_borders *borders)
{
    drawn_scene_edit(drawn, edit);
    if (edit == be_sewn)
        drawn->scene.surfaces[1].borders = borders;
}

static tl_image draw_samples(tl_renderer *renderer, struct drawn_scene *drawn, editor *edit)
{
    drawn_scene_edit(drawn, edit);
    drawn->scene.settings.light.ratio_at = TL_RATIO_AT_SAMPLES;
    return draw_anew(renderer, drawn, TL_DEVICE_CPU);
}

/* What the CPU lights at samples only: its picture at vertices `without`, and what the rest changes at
 * samples.
 */
static tl_image draw_expected(tl_renderer *renderer, struct drawn_scene *drawn, const tl_borders *borders,
                              const struct picture_case *item)
{
    apply(drawn, item->without ? item->without : item->edit, borders);
    tl_image image = draw_anew(renderer, drawn, TL_DEVICE_CPU);
    if (!item->without)
        return image;
    tl_image before = draw_samples(renderer, drawn, item->without);
    tl_image after = draw_samples(renderer, drawn, item->edit);
    for (size_t i = 0; i < 4 * (size_t)image.width * (size_t)image.height; i++)
        tl_image_floats(&image)[i] += tl_image_floats(&after)[i] - tl_image_floats(&before)[i];
    tl_image_release(&before);
    tl_image_release(&after);
    return image;
}

/* Pixels whose cover differs by more than GL's fading of the ground does. */
static int count_other_covers(const tl_image *made, const tl_image *expected)
{
    int count = 0;
    for (size_t i = 0; i < (size_t)made->width * (size_t)made->height; i++)
        count += fabsf(tl_image_floats(made)[4 * i + 3] - tl_image_floats(expected)[4 * i + 3]) > 6e-4f;
    return count;
}

static bool check_picture(tl_renderer *renderer, struct drawn_scene *drawn, const tl_borders *borders,
                          const struct picture_case *item)
{
    tl_image expected = draw_expected(renderer, drawn, borders, item);
    apply(drawn, item->edit, borders);
    tl_image made = draw_anew(renderer, drawn, TL_DEVICE_CARD);
    drawn_scene_expect_device(renderer, drawn, "the graphics card, by");
    const struct test_difference difference = test_compare(&made, &expected);
    const int covers = count_other_covers(&made, &expected);
    const double most = most_of_difference(&made, &expected);
    printf("%-22s rel. RMSE %.5f, of most %.5f, cover of %d\n", item->name, difference.rel_rmse, most,
           covers);
    tl_image_release(&expected);
    tl_image_release(&made);
    return difference.pixels > WIDTH * HEIGHT / (item->covers > 0 ? 64 : 8) && covers <= item->covers &&
           difference.rel_rmse < item->rmse && most < item->most;
}

static void test_pictures(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    int faulty = 0;
    open_small(&drawn, WIDTH, HEIGHT);
    drawn.plain.settings.image.ground = false; /* its normals are alike */
    tl_borders borders = make_borders(&drawn.scene.shapes[1].mesh);
    for (size_t i = 0; i < TL_COUNT(pictures); i++)
        if (!check_picture(device->renderer, &drawn, &borders, &pictures[i])) {
            print_error("%s: another picture than the CPU's\n", pictures[i].name);
            faulty++;
        }
    tl_borders_release(&borders);
    drawn_scene_close(&drawn);
    assert_int_equal(faulty, 0);
}

/* ---- Covered corners ---- */

/* The ball as a plate 2 to 6 mm above a flat sheet, which covers corners of triangles that are seen beside
 * it. */
static void lie_on_the_sheet(struct drawn_scene *drawn)
{
    tl_mesh *plate = &drawn->scene.shapes[0].mesh, *sheet = &drawn->scene.shapes[1].mesh;
    for (size_t i = 0; i < plate->vertex_count; i++) {
        const float up = plate->positions[i].y - BALL_HEIGHT_M;
        plate->positions[i].y = SHEET_HEIGHT_M + 0.004f + 0.002f * up / BALL_RADIUS_M;
        plate->normals[i] = (vec3s){{0, up < 0 ? -1.0f : 1.0f, 0}};
    }
    for (size_t i = 0; i < sheet->vertex_count; i++) {
        sheet->positions[i].y = SHEET_HEIGHT_M;
        sheet->normals[i] = (vec3s){{0, 1, 0}};
    }
    test_scene_refresh(&drawn->scene);
}

/* Two roundings of visibility; with the light of corners under the plate .029. */
static void test_covered_corners(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    open_small(&drawn, WIDTH, HEIGHT);
    drawn.plain.settings.image.ground = false;
    drawn_scene_edit(&drawn, lie_on_the_sheet);
    tl_image expected = draw_by(device->renderer, &drawn, TL_DEVICE_CPU);
    tl_image made = draw_by(device->renderer, &drawn, TL_DEVICE_CARD);
    drawn_scene_expect_device(device->renderer, &drawn, "the graphics card, by");
    const double most = most_of_difference(&made, &expected);
    printf("beside a plate on the sheet: rel. RMSE of most %.5f\n", most);
    tl_image_release(&expected);
    tl_image_release(&made);
    drawn_scene_close(&drawn);
    assert_true(most < 0.006);
}

/* ---- Emission ---- */

static void shine_under_a_coat(struct drawn_scene *drawn)
{
    have_a_coat(drawn);
    drawn_scene_cloth(drawn)->emission = (vec3s){{1, 0.6f, 0.4f}};
}

/* What emission adds is what the coat and the fibres leave of it. */
static void test_emission_under_a_coat(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    tl_image images[2][2];
    open_small(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    drawn.plain.settings.image.ground = false;
    static editor *const edits[] = {have_a_coat, shine_under_a_coat};
    for (int i = 0; i < 2; i++) {
        images[0][i] = draw_samples(device->renderer, &drawn, edits[i]);
        drawn_scene_edit(&drawn, edits[i]);
        images[1][i] = draw_anew(device->renderer, &drawn, TL_DEVICE_CARD);
        drawn_scene_expect_device(device->renderer, &drawn, "the graphics card, by");
    }
    double off = 0, sum = 0;
    for (size_t i = 0; i < (size_t)4 * SMALL_WIDTH * SMALL_HEIGHT; i++) {
        double added[2];
        for (int k = 0; k < 2; k++)
            added[k] = (double)(tl_image_floats(&images[k][1])[i] - tl_image_floats(&images[k][0])[i]);
        off += fabs(added[1] - added[0]);
        sum += added[0];
    }
    printf("emission adds %.1f in all, off by %.5f of it\n", sum, off / sum);
    assert_true(sum > 100);
    assert_near(off, 0, 0.002 * sum); /* halves, and tables of halves */
    for (int i = 0; i < 4; i++)
        tl_image_release(&images[i / 2][i % 2]);
    drawn_scene_close(&drawn);
}

/* ---- Bounced light ---- */

/* Light bounces from random points: after as many frames the means of both agree. */
static void check_bounces(tl_renderer *renderer, struct drawn_scene *drawn, editor *edit, double least,
                          double flip)
{
    struct tl_comparison all;
    tl_error error = {0};
    drawn_scene_edit(drawn, edit);
    tl_image expected = draw_anew(renderer, drawn, TL_DEVICE_CPU);
    tl_image made = draw_anew(renderer, drawn, TL_DEVICE_CARD);
    drawn_scene_expect_device(renderer, drawn, "the graphics card, by");
    drawn->scene.settings.light.bounce = TL_BOUNCE_OFF;
    tl_image without = draw_anew(renderer, drawn, TL_DEVICE_CARD);
    assert_ok(tl_image_compare(&made, &expected, 0, 0, &all, &error), error);
    const double light = mean_of(&made), bounced = light - mean_of(&without);
    printf("bounced %.4f of the light, off by %.4f; FLIP %.4f\n", bounced / light,
           light / mean_of(&expected) - 1, all.flip_mean);
    assert_true(bounced > least * light);
    assert_near(light, mean_of(&expected), 0.01 * light);
    assert_near(all.flip_mean, 0, flip);
    tl_image_release(&expected);
    tl_image_release(&made);
    tl_image_release(&without);
}

static void test_bounces(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    open_small(&drawn, WIDTH, HEIGHT);
    drawn.plain.settings.image.ground = false; /* its normals are alike */
    drawn.plain.settings.light.bounce = TL_BOUNCE_ALL;
    drawn.plain.settings.light.bounce_shares = 1;
    check_bounces(device->renderer, &drawn, be_satin, 0.05, 0.006);
    check_bounces(device->renderer, &drawn, glow, 0.03, 0.05); /* the CPU's is lit at samples */
    check_bounces(device->renderer, &drawn, have_lamps, 0.05, 0.08);
    check_bounces(device->renderer, &drawn, be_voile, 0.05, 0.02);
    check_bounces(device->renderer, &drawn, have_a_large_hole, 0.01, 0.011);
    drawn_scene_close(&drawn);
}

/* ---- From frame to frame ---- */

/* The same bytes twice, after other pictures by either device, and by another renderer. */
static void test_frames_repeat(void **state)
{
    tl_renderer *renderer = ((const struct test_device *)*state)->renderer;
    struct drawn_scene drawn;
    open_small(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    drawn.plain.settings.light.bounce = TL_BOUNCE_ALL;
    drawn_scene_edit(&drawn, have_threads);
    tl_image first = draw_anew(renderer, &drawn, TL_DEVICE_CARD);
    assert_true(tl_renderer_is_at_rest(renderer));
    tl_image by_cpu = draw_anew(renderer, &drawn, TL_DEVICE_CPU);
    tl_image second = draw_anew(renderer, &drawn, TL_DEVICE_CARD);
    tl_image by_cpu_again = draw_by(renderer, &drawn, TL_DEVICE_CPU);
    drawn_scene_expect_same(&second, &first);
    drawn_scene_expect_same(&by_cpu_again, &by_cpu);
    assert_memory_not_equal(first.texels, by_cpu.texels, (size_t)16 * SMALL_WIDTH * SMALL_HEIGHT);
    tl_image_release(&second);
    tl_renderer_forget(renderer);
    second = draw_by(renderer, &drawn, TL_DEVICE_CARD);
    drawn_scene_expect_same(&second, &first);
    tl_image_release(&second);
    tl_image_release(&first);
    tl_image_release(&by_cpu);
    tl_image_release(&by_cpu_again);
    drawn_scene_close(&drawn);
}

/* Nothing of larger pictures, of more shapes, of a sun is left; and nothing is missing after smaller ones. */
static void test_changes(void **state)
{
    static const struct {
        editor *edit;
        int width, height;
        size_t shapes;
        bool sun;
    } frames[] = {{be_sewn, 40, 32, 1, false},
                  {have_threads, SMALL_WIDTH, SMALL_HEIGHT, 3, true},
                  {be_matt, 20, 48, 2, false},
                  {be_different, 48, 20, 2, true},
                  {have_lamps, SMALL_WIDTH, SMALL_HEIGHT, 3, true},
                  {be_voile, SMALL_WIDTH, SMALL_HEIGHT, 3, true},
                  {have_a_lamp, SMALL_WIDTH, SMALL_HEIGHT, 3, true},
                  {lean, SMALL_WIDTH, SMALL_HEIGHT, 3, false}};
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    tl_image images[TL_COUNT(frames)];
    open_small(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    test_scene_add(&drawn.scene, test_sphere((vec3s){{-0.5f, 0.2f, 0.4f}}, 0.2f, 12));
    for (size_t pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < TL_COUNT(frames); k++) {
            const size_t i = pass == 0 ? k : TL_COUNT(frames) - 1 - k;
            drawn_scene_edit(&drawn, frames[i].edit);
            struct tl_render_settings *settings = &drawn.scene.settings;
            settings->image.width = frames[i].width;
            settings->image.height = frames[i].height;
            settings->light.sun = frames[i].sun;
            drawn.scene.frame.surface_count = frames[i].shapes;
            drawn.scene.frame.still = pass == 0; /* which nothing follows from */
            tl_image image = draw_by(device->renderer, &drawn, TL_DEVICE_CARD);
            if (pass == 0) {
                images[i] = image;
                continue;
            }
            drawn_scene_expect_same(&image, &images[i]);
            tl_image_release(&image);
            tl_image_release(&images[i]);
        }
    drawn_scene_close(&drawn);
}

/* ---- What the card does not draw ---- */

static void bounce_once(struct drawn_scene *drawn)
{
    drawn->scene.settings.light.bounce = TL_BOUNCE_ONE;
}

static void have_steps(struct drawn_scene *drawn)
{
    have_a_lamp(drawn);
    drawn->scene.settings.shading.self_shadow = TL_SELF_SHADOW_STEP;
}

static void test_refusals(void **state)
{
    static const struct {
        editor *edit;
        const char *text;
    } refused[] = {{bounce_once, "light that bounces once"},
                   {have_steps, "lamps whose shading is not exact"}};
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    open_small(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    for (size_t i = 0; i < TL_COUNT(refused); i++) {
        drawn_scene_edit(&drawn, refused[i].edit);
        tl_image expected = draw_anew(device->renderer, &drawn, TL_DEVICE_CPU);
        tl_image drawn_instead = draw_anew(device->renderer, &drawn, TL_DEVICE_CARD);
        drawn_scene_expect_device(device->renderer, &drawn, refused[i].text);
        drawn_scene_expect_same(&drawn_instead, &expected);
        tl_image_release(&expected);
        tl_image_release(&drawn_instead);
    }
    drawn_scene_close(&drawn);
}

/* ---- Memory ---- */

/* Bytes of a resource; 0: it holds nothing. */
static size_t bytes_of(const tl_renderer *renderer, const char *name)
{
    struct tl_resource_memory rows[TL_RESOURCES_MAX];
    const size_t count = tl_renderer_resources(renderer, rows);
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].name, name) == 0)
            return rows[i].bytes;
    return 0;
}

/* All that a frame on the card has of GL is counted, and goes with the renderer; what is counted beside it is
 * the CPU's part of the tree and of the vertices, which does not change with materials, light, or size. */
static void test_memory(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    tl_error error = {0};
    const size_t others = tl_gpu_bytes(device->gpu);
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    open_small(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    static editor *const edits[] = {have_no_sun, have_occlusion, have_threads};
    size_t kept = 0;
    for (size_t i = 0; i < TL_COUNT(edits); i++) {
        drawn_scene_edit(&drawn, edits[i]);
        drawn.scene.settings.image.width += 8 * (int)i;
        tl_image image = draw_by(renderer, &drawn, TL_DEVICE_CARD);
        const size_t counted = bytes_of(renderer, "surfaces on the card") + bytes_of(renderer, "surfaces") +
                               bytes_of(renderer, "image");
        const size_t made = tl_gpu_bytes(device->gpu) - others;
        assert_in_range(counted, made, made + made / 10);
        if (i == 0)
            kept = counted - made;
        assert_int_equal(counted - made, kept);
        tl_image_release(&image);
    }
    tl_renderer_destroy(&renderer);
    assert_int_equal(tl_gpu_bytes(device->gpu), others);
    drawn_scene_close(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),      cmocka_unit_test(test_covered_corners),
        cmocka_unit_test(test_bounces),       cmocka_unit_test(test_emission_under_a_coat),
        cmocka_unit_test(test_frames_repeat), cmocka_unit_test(test_changes),
        cmocka_unit_test(test_refusals),      cmocka_unit_test(test_memory)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
