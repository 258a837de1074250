/* The environment's turn (yaw) in every method and back-end. To turn the environment is to turn everything
 * else the other way: both images must agree, and the second one uses no yaw, so that the sign of none can
 * hide in it. */
#include "tests/render/scenes.h"

#include "render/env/cube.h"
#include "render/env/layout.h"

#include "tests/testing.h"

/* Light from one side: a sun small enough to leave the regions (env/sun.h), red from +X, blue from -Z. */
static vec3s sided(vec3s d)
{
    float sun = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.7f, 0.6f, 0.3f}})) > 0.9996f ? 4000 : 0;
    return (vec3s){
        {0.1f + 3 * fmaxf(d.x, 0) + sun, 0.2f + 0.9f * sun, 0.1f + 3 * fmaxf(-d.z, 0) + 0.8f * sun}};
}

typedef void edit(struct test_scene *scene);

static void use_depth(struct test_scene *scene)
{
    struct tl_light_params *light = &scene->settings.light;
    light->visibility = TL_VISIBILITY_DEPTH;
    light->prefilter = TL_PREFILTER_SLICES;
    light->composition = TL_COMPOSE_DIFFERENCE;
    light->sun = true;
}

static void use_ratio(struct test_scene *scene)
{
    use_depth(scene);
    scene->settings.light.composition = TL_COMPOSE_RATIO;
}

static void use_lights(struct test_scene *scene)
{
    scene->settings.light.method = TL_METHOD_LIGHTS;
}

static void use_colour(struct test_scene *scene)
{
    scene->settings.light.method = TL_METHOD_AO_COLOUR;
}

static void use_none(struct test_scene *scene)
{
    scene->settings.light.method = TL_METHOD_UNSHADOWED;
    scene->settings.light.composition = TL_COMPOSE_RATIO;
}

static void use_samples(struct test_scene *scene)
{
    test_scene_use_rays(scene, 24, 1);
}

/* In motion a few regions are traced again, the most important ones. */
static void use_few(struct test_scene *scene)
{
    use_samples(scene);
    scene->settings.light.refresh = 4;
}

static void use_repair(struct test_scene *scene)
{
    use_samples(scene);
    scene->settings.light.repair = scene->settings.light.repair_rest = 0.3f;
}

static void use_bounces(struct test_scene *scene)
{
    use_samples(scene);
    scene->settings.light.bounce = TL_BOUNCE_ALL;
}

static void use_vertices(struct test_scene *scene)
{
    use_samples(scene);
    scene->settings.light.ratio_at = TL_RATIO_AT_VERTICES;
}

static void be_satin(tl_material *cloth)
{
    cloth->diffuse = (vec3s){{0.3f, 0.02f, 0.05f}};
    cloth->specular = (vec3s){{0.12f, 0.1f, 0.1f}};
    cloth->gloss.model = TL_REFLECT_WARD;
    cloth->gloss.width_weft = 0.3f;
    cloth->gloss.width_warp = 0.1f;
    cloth->fuzz = (struct tl_fuzz){{{1, 0.7f, 0.4f}}, 0.5f, 0};
}

static void use_satin(struct test_scene *scene)
{
    use_samples(scene);
    be_satin(&scene->shapes[1].material);
}

static void use_satin_at_vertices(struct test_scene *scene)
{
    use_vertices(scene);
    be_satin(&scene->shapes[1].material);
}

static void use_voile_at_vertices(struct test_scene *scene)
{
    use_vertices(scene);
    scene->shapes[1].material.openness = 0.4f;
    scene->shapes[1].material.transmission = (vec3s){{0.4f, 0.3f, 0.2f}};
}

/* The ball reflects what is lit, the sheet from below. */
static void use_mirror(struct test_scene *scene)
{
    use_samples(scene);
    scene->settings.light.reflect_scene = true;
    scene->shapes[0].material.specular = (vec3s){{0.9f, 0.9f, 0.9f}};
    scene->shapes[0].material.glossiness = 0.998f;
}

static void use_reference(struct test_scene *scene)
{
    scene->settings.light.method = TL_METHOD_REFERENCE;
    scene->shapes[0].material.specular = (vec3s){{0.5f, 0.5f, 0.5f}}; /* rays of its lobe look the sky up */
    scene->shapes[0].material.glossiness = 0.9f;
    scene->settings.reference.strata = 8;
    scene->settings.reference.lobe_samples = 16;
    scene->settings.reference.bounces = 1;
}

static void use_maps(struct test_scene *scene)
{
    scene->settings.light.method = TL_METHOD_MAPS;
    scene->settings.maps.size = 32;
}

static void use_sphere_map(struct test_scene *scene)
{
    use_maps(scene);
    scene->settings.maps.layout = TL_LAYOUT_SPHERE;
}

static void use_matrix(struct test_scene *scene)
{
    use_maps(scene);
    scene->settings.maps.layout = TL_LAYOUT_PARABOLOID;
    scene->settings.maps.look_up = TL_LOOK_UP_MATRIX;
}

/* From a point above the sheet, so that nothing contains it. */
static void use_capture(struct test_scene *scene)
{
    use_maps(scene);
    scene->settings.maps.capture_every = 1;
    scene->settings.maps.capture_at[1] = 0.9f;
}

/* What may differ, root mean square over the mean: roundings, which take a sample at the edge of a shadow to
 * its other side. Where rays are sent on from what they hit, a rounding may send one elsewhere. */
#define ROUNDINGS 0.004
#define SWAPPED   1e-4 /* a quarter swaps coordinates, which rounds nothing */
#define SENT_ON   0.03
/* What came out and is enough: 0.8 % where the sun grazes a wall with variance maps or wide regions, and 0.9
 * % of bounces, where the least of all flips, of the light at what rays hit, makes 1.9 %. */
#define GRAZED  0.015
#define BOUNCED 0.013
static const struct {
    const char *name;
    edit *use;
    float turn; /* rad; a quarter where the ground's probes or a cube lie along the axes of the world */
    double bound;
} cases[] = {
    {"variance maps", NULL, 0.7f, GRAZED},
    {"depth maps, slices, suns", use_depth, 0.7f, ROUNDINGS},
    {"depth maps, ratio, suns", use_ratio, 0.7f, ROUNDINGS},
    {"regions as lights", use_lights, 0.7f, GRAZED},
    {"coloured occlusion", use_colour, 0.7f, GRAZED},
    {"unshadowed", use_none, 0.7f, ROUNDINGS},
    {"rays at samples", use_samples, (float)M_PI / 2, SWAPPED},
    {"rays at samples, few again", use_few, (float)M_PI / 2, SENT_ON},
    {"rays at samples, repaired", use_repair, (float)M_PI / 2, SWAPPED},
    {"rays at samples, bounces", use_bounces, (float)M_PI / 2, BOUNCED},
    {"rays at samples, satin", use_satin, (float)M_PI / 2, SWAPPED},
    {"rays at samples, mirror", use_mirror, (float)M_PI / 2, SENT_ON},
    {"rays at vertices", use_vertices, (float)M_PI / 2, SWAPPED},
    {"rays at vertices, satin", use_satin_at_vertices, (float)M_PI / 2, SWAPPED},
    {"rays at vertices, voile", use_voile_at_vertices, (float)M_PI / 2, ROUNDINGS},
    {"reference", use_reference, 0.7f, 0.01},
    {"maps: cube", use_maps, 0.7f, ROUNDINGS},
    {"maps: sphere", use_sphere_map, 0.7f, ROUNDINGS},
    {"maps: paraboloid by matrix", use_matrix, 0.7f, ROUNDINGS},
    {"maps: capture", use_capture, (float)M_PI / 2, ROUNDINGS},
};

static vec3s turned(vec3s v, float angle)
{
    return tl_turn_direction(v, angle);
}

static void turn_scene(struct test_scene *scene, float angle)
{
    for (size_t s = 0; s < scene->shape_count; s++) {
        tl_mesh *mesh = &scene->shapes[s].mesh;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            vec4s *tangent = &mesh->tangents[i];
            mesh->positions[i] = turned(mesh->positions[i], angle);
            mesh->normals[i] = turned(mesh->normals[i], angle);
            *tangent = glms_vec4(turned(glms_vec3(*tangent), angle), tangent->w);
        }
    }
    scene->frame.camera.eye = turned(scene->frame.camera.eye, angle);
    scene->frame.camera.target = turned(scene->frame.camera.target, angle);
    test_scene_refresh(scene);
}

static void scene_open(struct test_scene *scene)
{
    test_scene_open(scene, test_environment(256, 128, sided), (vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.6f, 0}},
                    40, 48, 32);
    test_scene_add(scene, test_sphere((vec3s){{0, 0.5f, 0}}, 0.4f, 16));
    test_scene_add(scene, test_sheet(1.1f, 0.5f, 0.06f, 2, 16));
    /* A wall that the sun grazes, with the sheet's penumbra on it: turned the other way, the sun is behind
     * it. */
    test_scene_add(scene,
                   test_square((vec3s){{-0.75f, 0.6f, 0}}, (vec3s){{0, 0, -1}}, (vec3s){{1, 0, 0}}, 0.6f, 8));
    scene->settings.image.ground = true;
    scene->settings.light.pem_size = 64; /* of smaller texels no sun is found */
}

/* A renderer that has drawn nothing: its rays begin with the same random numbers. */
static tl_renderer *renderer_new(tl_gpu *gpu)
{
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(gpu, &error);
    assert_non_null(renderer);
    return renderer;
}

/* The second of two frames in motion. */
static tl_image draw_moving(tl_renderer *renderer, struct test_scene *scene)
{
    tl_image image = test_scene_draw(scene, renderer);
    tl_image_release(&image);
    scene->surfaces[1].motion_revision++;
    return test_scene_draw(scene, renderer);
}

static void every_method_turns_the_environment(void **state)
{
    struct test_device *device = *state;
    int failures = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct test_scene scene;
        tl_renderer *first = renderer_new(device->gpu), *second = renderer_new(device->gpu);
        scene_open(&scene);
        if (cases[i].use)
            cases[i].use(&scene);
        test_scene_refresh(&scene);
        scene.frame.environment_yaw = cases[i].turn;
        tl_image light = draw_moving(first, &scene);
        scene.frame.environment_yaw = -cases[i].turn;
        tl_image wrong = test_scene_draw(&scene, first);
        scene.frame.environment_yaw = 0;
        turn_scene(&scene, -cases[i].turn);
        tl_image expected = draw_moving(second, &scene);
        double error = test_compare(&light, &expected).rel_rmse,
               flipped = test_compare(&wrong, &expected).rel_rmse;
        bool fine = error < cases[i].bound && flipped > 10 * cases[i].bound;
        print_message("%s: off by %.3f %%, turned the other way by %.0f %%%s\n", cases[i].name, 100 * error,
                      100 * flipped, fine ? "" : ": FAILED");
        failures += !fine;
        tl_image_release(&light);
        tl_image_release(&wrong);
        tl_image_release(&expected);
        test_scene_close(&scene);
        tl_renderer_destroy(&first);
        tl_renderer_destroy(&second);
    }
    assert_int_equal(failures, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_method_turns_the_environment)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
