/* Views in place of light: what they show is what the frame holds, light is as it was, and nothing runs that
 * they do not need. The read-out under a pixel, and the layers of an image. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/inside.h"
#include "render/inspect/aovs.h"
#include "render/inspect/inspect.h"

#include "tests/testing.h"

#include <string.h>

enum { WIDTH = 96, HEIGHT = 72 };
static const vec3s centre = {{0, 0.5f, 0}};
static const float radius = 0.4f;

static vec3s daylight(vec3s d)
{
    return (vec3s){{0.4f + 0.2f * d.x, 0.5f, 0.6f + 0.3f * d.y}};
}

/* A ball under a sheet that knows its strains. */
struct scene {
    tl_environment environment;
    struct test_shape shapes[2];
    tl_surface surfaces[2];
    vec3s *strains;
    bool *crossed;
    tl_frame frame;
    struct tl_render_settings settings;
};

static void scene_open(struct scene *scene)
{
    scene->environment = test_environment(64, 32, daylight);
    scene->shapes[0] = test_sphere(centre, radius, 48);
    scene->shapes[1] = test_sheet(1.1f, 0.5f, 0.06f, 2, 24);
    for (int i = 0; i < 2; i++) {
        scene->shapes[i].material.glossiness = 0.25f;
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
        scene->surfaces[i].name = i ? "garment" : "avatar";
    }
    const tl_surface *sheet = &scene->surfaces[1];
    scene->strains = TL_NEW_ARRAY(vec3s, sheet->vertex_count);
    for (size_t i = 0; i < sheet->vertex_count; i++)
        scene->strains[i] = (vec3s){{0.1f * sheet->positions[i].x, -0.02f, 0.05f}};
    scene->surfaces[1].strains = scene->strains;
    scene->crossed = TL_NEW_ARRAY(bool, sheet->index_count / 3);
    for (size_t i = 0; i < sheet->index_count / 3; i += 3)
        scene->crossed[i] = true;
    scene->surfaces[1].crossed = scene->crossed;
    scene->frame = test_frame((vec3s){{0.6f, 1.8f, 2}}, (vec3s){{0, 0.75f, 0}}, 40, scene->surfaces, 2,
                              &scene->environment);
    scene->frame.still = true;
    scene->settings = test_settings(WIDTH, HEIGHT);
    scene->settings.light.cut = TL_CUT_SPHERE;
    scene->settings.light.visibility = TL_VISIBILITY_RAYS;
    scene->settings.light.composition = TL_COMPOSE_RATIO;
    scene->settings.light.rounds = 2;
}

static void scene_close(struct scene *scene)
{
    tl_environment_release(&scene->environment);
    test_shape_release(&scene->shapes[0]);
    test_shape_release(&scene->shapes[1]);
    free(scene->strains);
    free(scene->crossed);
}

/* As a still image, through all rounds. */
static void draw(tl_renderer *renderer, const struct scene *scene)
{
    tl_error error = {0};
    do
        assert_ok(tl_renderer_draw(renderer, &scene->frame, &scene->settings, &error), error);
    while (!tl_renderer_is_at_rest(renderer));
}

static tl_image show(tl_renderer *renderer, struct scene *scene, int view)
{
    tl_error error = {0};
    tl_image image;
    scene->settings.image.view = view;
    draw(renderer, scene);
    assert_ok(tl_renderer_show_image(renderer, &image, &error), error);
    return image;
}

static const uint8_t *byte_at(const tl_image *image, int x, int y)
{
    return tl_image_bytes(image) + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static enum tl_job_action action_of(const tl_renderer *renderer, const char *job)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, job) == 0)
            return plan->rows[i].action;
    fail_msg("no job %s", job);
    return TL_JOB_DROP;
}

/* A byte holds a direction to 1/255; a sample in the middle of its pixel is the pixel. */
static void normals_are_the_frames_own(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    scene.settings.image.exposure_ev = 3; /* of light, not of data */
    tl_image image = show(device->renderer, &scene, TL_VIEW_NORMAL);
    int on_ball = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct tl_inspection under;
            if (!tl_renderer_inspect(device->renderer, x, y, &under))
                continue;
            for (int c = 0; c < 3; c++) {
                assert_near(byte_at(&image, x, y)[c] / 127.5 - 1, under.normal.raw[c], 1.01 / 127.5);
                /* No bumps here, but for the outline, where it is turned towards the viewer. */
                vec3s view = glms_vec3_normalize(glms_vec3_sub(scene.frame.camera.eye, under.position));
                if (glms_vec3_dot(under.smooth, view) > 0.021f)
                    assert_near(under.smooth.raw[c], under.normal.raw[c], 0);
            }
            if (strcmp(under.surface, "avatar") != 0)
                continue;
            on_ball++;
            vec3s n = glms_vec3_normalize(glms_vec3_sub(under.position, centre));
            /* The smooth normal of a ball of 96 x 48 facets, at a point of a facet; half floats round places.
             */
            assert_near(glms_vec3_distance(n, under.smooth), 0, 2e-3);
        }
    assert_true(on_ball > 300);
    tl_image_release(&image);
    scene_close(&scene);
}

/* A near mirror under open cloth. */
static void make_rich(struct scene *scene)
{
    scene->shapes[0].material.glossiness = 0.999f;
    scene->shapes[0].material.specular = (vec3s){{0.5f, 0.5f, 0.5f}};
    scene->shapes[1].material.openness = 0.4f;
    scene->shapes[1].material.transmission = (vec3s){{0.2f, 0.2f, 0.2f}};
    for (int i = 0; i < 2; i++) {
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
    }
}

static void light_lamps(struct scene *scene)
{
    static const struct tl_lamp lamps[] = {
        {.kind = TL_LAMP_DIRECTIONAL, .direction = {{0, 1, 0}}, .irradiance = {{1, 1, 1}}},
        {.kind = TL_LAMP_POINT, .position = {{1, 2, 1}}, .irradiance = {{2, 1, 1}}}};
    scene->frame.lamps = lamps;
    scene->frame.lamp_count = TL_COUNT(lamps);
}

static void expect_same_light(tl_renderer *renderer, struct scene *scene)
{
    tl_image before, after;
    tl_error error = {0};
    draw(renderer, scene);
    assert_ok(tl_renderer_read(renderer, &before, &error), error);
    for (int view = TL_VIEW_LIGHT + 1; view < TL_VIEW_COUNT; view += 3) {
        scene->settings.image.view = view;
        draw(renderer, scene);
    }
    scene->settings.image.view = TL_VIEW_LIGHT;
    draw(renderer, scene);
    assert_int_equal(action_of(renderer, "inspect"), TL_JOB_DROP);
    assert_ok(tl_renderer_read(renderer, &after, &error), error);
    assert_memory_equal(before.texels, after.texels, 4 * sizeof(float) * WIDTH * HEIGHT);
    tl_image_release(&before);
    tl_image_release(&after);
}

static void light_is_as_it_was(void **state)
{
    struct test_device *device = *state;
    static const struct {
        int method, visibility;
        bool rich, lamps;
    } cases[] = {
        {TL_METHOD_PEM, TL_VISIBILITY_RAYS, false, false},
        {TL_METHOD_PEM, TL_VISIBILITY_RAYS, true, false},
        {TL_METHOD_PEM, TL_VISIBILITY_RAYS, true, true},
        {TL_METHOD_PEM, TL_VISIBILITY_VSM, false, true},
        {TL_METHOD_AO, TL_VISIBILITY_RAYS, false, false},
        {TL_METHOD_UNSHADOWED, TL_VISIBILITY_RAYS, true, false},
        {TL_METHOD_UNSHADOWED, TL_VISIBILITY_DEPTH, false, false},
        {TL_METHOD_REFERENCE, TL_VISIBILITY_RAYS, false, false},
        {TL_METHOD_MAPS, TL_VISIBILITY_RAYS, false, false},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct scene scene;
        scene_open(&scene);
        scene.settings.light.method = cases[i].method;
        scene.settings.light.visibility = cases[i].visibility;
        scene.settings.reference =
            (struct tl_reference_params){.strata = 2, .lobe_samples = 2, .replicates = 1};
        if (cases[i].rich)
            make_rich(&scene);
        if (cases[i].lamps)
            light_lamps(&scene);
        expect_same_light(device->renderer, &scene);
        scene_close(&scene);
    }
}

/* Depth maps know no sheets behind open cloth, and give their memory back; with rays they are there again. */
static void what_was_given_back_is_made_anew(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    tl_image before, after;
    tl_error error = {0};
    scene_open(&scene);
    make_rich(&scene);
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read(device->renderer, &before, &error), error);
    scene.settings.light.visibility = TL_VISIBILITY_DEPTH;
    draw(device->renderer, &scene);
    scene.settings.light.visibility = TL_VISIBILITY_RAYS;
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read(device->renderer, &after, &error), error);
    int seen_through = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) { /* alpha: what is looked through does not depend on rays */
            float alpha = test_pixel(&before, x, y)[3];
            seen_through += alpha > 0 && alpha < 1;
            assert_near(test_pixel(&after, x, y)[3], alpha, 0);
        }
    assert_true(seen_through > 100);
    tl_image_release(&before);
    tl_image_release(&after);
    scene_close(&scene);
}

static void nothing_runs_that_is_not_needed(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    static const char *const of_light[] = {"compose", "light", "lights",   "lobes",
                                           "pems",    "maps",  "reference"};
    for (int view = TL_VIEW_LIGHT + 1; view < TL_VIEW_COUNT; view++) {
        scene.frame.environment_revision++; /* all is rebuilt */
        scene.settings.image.view = view;
        tl_error error = {0};
        assert_ok(tl_renderer_draw(device->renderer, &scene.frame, &scene.settings, &error), error);
        assert_int_equal(action_of(device->renderer, "inspect"), TL_JOB_RUN);
        for (size_t i = 0; i < TL_COUNT(of_light); i++)
            assert_int_equal(action_of(device->renderer, of_light[i]), TL_JOB_DROP);
        assert_int_equal(action_of(device->renderer, "points"),
                         tl_view_is_visibility(view) ? TL_JOB_RUN : TL_JOB_DROP);
        draw(device->renderer, &scene);
        draw(device->renderer, &scene);
        assert_int_equal(action_of(device->renderer, "inspect"), TL_JOB_REUSE); /* at rest */
    }
    scene_close(&scene);
}

/* The view of visibility equals the sum over the values of tl_points. */
static void visibility_is_that_of_the_points(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    scene.frame.environment_yaw = 0.7f;
    for (int region = -1; region < 24; region += 5) {
        scene.settings.image.view_region = region;
        tl_image image = show(device->renderer, &scene, TL_VIEW_VISIBILITY);
        const struct tl_resources *inside = tl_renderer_frame_resources(device->renderer);
        size_t stride, checked = 0;
        const uint16_t *values = tl_points_values(inside->points, &stride);
        for (size_t i = 0; i < inside->samples.primary_count; i++) {
            const tl_sample *sample = &inside->samples.items[i];
            const struct tl_taps *taps = &tl_points_taps(inside->points)[i];
            double all = 0, seen = 0;
            for (int r = 0; r < inside->regions.count; r++) {
                const struct tl_region *light = &inside->regions.items[r];
                vec3s towards = tl_turn_direction(light->direction, scene.frame.environment_yaw);
                double power = region < 0 ? (double)light->importance *
                                                fmax(0, (double)glms_vec3_dot(towards, sample->smooth))
                                          : r == region;
                all += power;
                for (int t = 0; t < TL_TAPS; t++)
                    seen +=
                        power * (double)taps->weight[t] * values[taps->point[t] * stride + (size_t)r] / 65535;
            }
            int x = (int)(sample->texel % WIDTH), y = HEIGHT - 1 - (int)(sample->texel / WIDTH);
            for (int c = 0; c < 3; c++)
                assert_near(byte_at(&image, x, y)[c] / 255.0, seen / all, 1 / 255.0);
            struct tl_inspection under;
            assert_true(tl_renderer_inspect(device->renderer, x, y, &under) && under.has_visibility);
            if (region < 0)
                assert_near(under.visibility, seen / all, 1e-4);
            checked++;
        }
        assert_true(checked > 1000);
        tl_image_release(&image);
    }
    scene_close(&scene);
}

static void triangles_that_cross_are_painted(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    tl_image image = show(device->renderer, &scene, TL_VIEW_CROSSING);
    int painted = 0, plain = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct tl_inspection under;
            if (!tl_renderer_inspect(device->renderer, x, y, &under) || strcmp(under.surface, "ground") == 0)
                continue;
            const bool *crossed = scene.surfaces[under.surface_index].crossed;
            bool is_painted = crossed && crossed[under.triangle];
            painted += is_painted;
            plain += !is_painted;
            const uint8_t *byte = byte_at(&image, x, y);
            for (int c = 0; c < 3; c++)
                if (is_painted)
                    assert_near(byte[c] / 255.0, tl_legend_crossing.raw[c], 1 / 255.0);
                else
                    assert_int_equal(byte[c], byte[0]); /* grey */
        }
    assert_true(painted > 100 && plain > 300);
    tl_image_release(&image);
    scene_close(&scene);
}

static void strains_are_those_of_the_surface(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    for (int given = 0; given < 2; given++) {
        scene.settings.image.view_range = given ? 20 : 0;
        tl_image image = show(device->renderer, &scene, TL_VIEW_STRAIN_WARP);
        struct tl_legend legend;
        tl_renderer_legend(device->renderer, &legend);
        assert_near(legend.high, given ? 20 : 5, 1e-4); /* 10 % x 0.5 m at most */
        int on_sheet = 0;
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                struct tl_inspection under;
                if (!tl_renderer_inspect(device->renderer, x, y, &under) || !under.has_strain)
                    continue;
                on_sheet++;
                assert_string_equal(under.surface, "garment");
                assert_near(under.strain_warp, 0.1 * (double)under.position.x, 1e-5);
                assert_near(under.strain_weft, -0.02, 1e-6);
                assert_near(under.shear, 0.05, 1e-6);
                vec3s colour = tl_legend_colour(&legend, 100 * under.strain_warp);
                for (int c = 0; c < 3; c++)
                    assert_near(byte_at(&image, x, y)[c] / 255.0, colour.raw[c], 1 / 255.0);
            }
        assert_true(on_sheet > 300);
        tl_image_release(&image);
    }
    scene_close(&scene);
}

/* Without samples a ray tells the same. */
static void a_ray_finds_what_samples_hold(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    scene_open(&scene);
    static struct tl_inspection by_sample[HEIGHT][WIDTH];
    static bool covered[HEIGHT][WIDTH];
    draw(device->renderer, &scene);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            covered[y][x] = tl_renderer_inspect(device->renderer, x, y, &by_sample[y][x]);
    scene.settings.light.visibility = TL_VISIBILITY_VSM;
    scene.frame.camera.eye.x += 1e-6f; /* samples of rays are of no use any more */
    draw(device->renderer, &scene);
    int differing = 0, found = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct tl_inspection under, *other = &by_sample[y][x];
            bool meets = tl_renderer_inspect(device->renderer, x, y, &under);
            assert_false(meets && under.has_visibility);
            found += meets;
            if (meets != covered[y][x] || (meets && under.triangle != other->triangle)) {
                differing++; /* an edge within rounding of the pixel's middle */
                continue;
            }
            if (!meets)
                continue;
            assert_ptr_equal(under.surface, other->surface);
            assert_int_equal(under.back, other->back);
            vec3s to_eye = glms_vec3_normalize(glms_vec3_sub(scene.frame.camera.eye, under.position));
            double aslant = fmax((double)fabsf(glms_vec3_dot(under.smooth, to_eye)), 0.05);
            double moved = 2 * TEST_PLACE * 0.03 / aslant; /* of pixels 3 cm wide, along two axes */
            assert_near(glms_vec3_distance(under.position, other->position), 0, 1e-4 + moved);
            assert_near(glms_vec3_distance(under.smooth, other->smooth), 0, 2e-3);
            assert_near(glms_vec2_distance(under.uv, other->uv), 0, 1e-3);
            assert_near(under.glossiness, 0.25, 1e-6);
            assert_near(other->glossiness, 0.25, 1e-3);
        }
    assert_true(found > 1000);
    assert_true(differing < found / 100);
    struct tl_inspection under;
    assert_false(tl_renderer_inspect(device->renderer, -1, 0, &under));
    assert_false(tl_renderer_inspect(device->renderer, 0, HEIGHT, &under));
    scene_close(&scene);
}

static const float *aov_at(const struct tl_aovs *aovs, const char *channel, int x, int y)
{
    for (int i = 0; i < aovs->count; i++)
        if (strcmp(aovs->items[i].channels[0], channel) == 0)
            return test_pixel(&aovs->items[i].image, x, y);
    return NULL;
}

static void aovs_tell_what_is_under_each_pixel(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    tl_error error = {0};
    scene_open(&scene);
    for (int back_end = 0; back_end < 2; back_end++) {
        struct tl_aovs aovs;
        bool rays = back_end == 0;
        int garment = 0, avatar = 0;
        scene.settings.light.visibility = rays ? TL_VISIBILITY_RAYS : TL_VISIBILITY_VSM;
        scene.settings.image.supersample = 1 + back_end;
        scene.frame.aovs = true;
        draw(device->renderer, &scene);
        assert_ok(tl_renderer_read_aovs(device->renderer, &aovs, &error), error);
        assert_int_equal(aovs.count, rays ? 7 : 6); /* visibility is of rays */
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                struct tl_inspection under;
                if (!tl_renderer_inspect(device->renderer, x, y, &under)) {
                    assert_near(aov_at(&aovs, "N.x", x, y)[1], 0, 0);
                    assert_near(*aov_at(&aovs, TL_AOV_GARMENT, x, y), 0, 0);
                    continue;
                }
                bool is_garment = under.surface_index == 1;
                assert_near(*aov_at(&aovs, TL_AOV_GARMENT, x, y), is_garment, 0);
                garment += is_garment;
                avatar += under.surface_index == 0;
                assert_memory_equal(aov_at(&aovs, "N.x", x, y), &under.normal, sizeof under.normal);
                assert_memory_equal(aov_at(&aovs, "P.x", x, y), &under.position, sizeof under.position);
                assert_memory_equal(aov_at(&aovs, "uv.u", x, y), &under.uv, sizeof under.uv);
                assert_near(aov_at(&aovs, "strain.warp", x, y)[2], under.shear, 0);
                assert_near(aov_at(&aovs, "albedo.R", x, y)[0], scene.shapes[0].material.diffuse.x, 1e-3);
                if (rays)
                    assert_near(*aov_at(&aovs, "visibility.Y", x, y), under.visibility, 0);
            }
        assert_true(garment > 500 && avatar > 200);
        tl_image alone;
        assert_ok(tl_renderer_read_garment(device->renderer, &alone, &error), error);
        assert_memory_equal(alone.texels, aov_at(&aovs, TL_AOV_GARMENT, 0, 0),
                            (size_t)WIDTH * HEIGHT * sizeof(float));
        tl_image_release(&alone);
        tl_aovs_release(&aovs);
    }
    scene.frame.aovs = false;
    scene.frame.camera.eye.x += 0.1f;
    struct tl_aovs none;
    tl_image no_garment;
    draw(device->renderer, &scene);
    assert_false(tl_renderer_read_aovs(device->renderer, &none, &error));
    assert_false(tl_renderer_read_garment(device->renderer, &no_garment, &error));
    assert_null(no_garment.texels);
    tl_aovs_release(&none);
    scene_close(&scene);
}

/* Light in motion has visibility at vertices only, which no sample has points of: a view that shows
 * visibility makes them, although nothing has moved since. A renderer that has drawn nothing before draws the
 * same. */
static void visibility_follows_light_at_vertices(void **state)
{
    struct test_device *device = *state;
    struct scene scene;
    tl_error error = {0};
    tl_renderer *renderers[2];
    tl_image images[2];
    scene_open(&scene);
    scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    scene.frame.still = false;
    for (int i = 0; i < 2; i++) {
        renderers[i] = tl_renderer_create(device->gpu, &error);
        assert_ok(renderers[i] != NULL, error);
        scene.settings.image.view = TL_VIEW_LIGHT;
        if (i == 1) {
            assert_ok(tl_renderer_draw(renderers[i], &scene.frame, &scene.settings, &error), error);
            assert_int_equal(action_of(renderers[i], "ratios"), TL_JOB_RUN);
        }
        scene.settings.image.view = TL_VIEW_VISIBILITY;
        assert_ok(tl_renderer_draw(renderers[i], &scene.frame, &scene.settings, &error), error);
        assert_int_equal(action_of(renderers[i], "points"), TL_JOB_RUN);
        assert_ok(tl_renderer_show_image(renderers[i], &images[i], &error), error);
    }
    double sum = 0;
    size_t count = (size_t)images[0].width * (size_t)images[0].height * 3;
    for (size_t i = 0; i < count; i++)
        sum += abs(tl_image_bytes(&images[0])[i] - tl_image_bytes(&images[1])[i]);
    assert_true(sum / (double)count < 8); /* of 255: other rays of the same regions; 4.4 was measured */
    for (int i = 0; i < 2; i++) {
        tl_image_release(&images[i]);
        tl_renderer_destroy(&renderers[i]);
    }
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_the_frames_own),
        cmocka_unit_test(visibility_follows_light_at_vertices),
        cmocka_unit_test(light_is_as_it_was),
        cmocka_unit_test(what_was_given_back_is_made_anew),
        cmocka_unit_test(nothing_runs_that_is_not_needed),
        cmocka_unit_test(visibility_is_that_of_the_points),
        cmocka_unit_test(strains_are_those_of_the_surface),
        cmocka_unit_test(triangles_that_cross_are_painted),
        cmocka_unit_test(a_ray_finds_what_samples_hold),
        cmocka_unit_test(aovs_tell_what_is_under_each_pixel),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
