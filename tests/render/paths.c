#include "tests/render/paths.h"

#include <math.h>

const char *const test_path_names[TEST_PATHS] = {"samples", "vertices", "reference", "lamp, GL",
                                                 "lamp, exact"};

void test_path_set(struct test_scene *scene, enum test_path path, vec3s towards_lamp)
{
    struct tl_render_settings *settings = &scene->settings;
    settings->light.method = path == BY_REFERENCE ? TL_METHOD_REFERENCE
                             : path >= BY_LAMP    ? TL_METHOD_UNSHADOWED
                                                  : TL_METHOD_PEM;
    settings->light.visibility = TL_VISIBILITY_RAYS;
    settings->light.composition = TL_COMPOSE_RATIO;
    settings->light.ratio_at = path == AT_VERTICES ? TL_RATIO_AT_VERTICES : TL_RATIO_AT_SAMPLES;
    settings->light.lobe = TL_LOBE_DUAL;
    settings->light.cut = TL_CUT_SPHERE;
    settings->light.regions = 48;
    settings->light.pem_size = 64;
    settings->light.lobes = 7;
    settings->detail.minify = TL_DETAIL_MINIFY_LEAN;
    settings->image.supersample = 1;
    settings->reference.strata = settings->reference.lobe_samples = 16;
    settings->reference.replicates = 1;
    scene->lamps[0] = test_lamp_towards(towards_lamp, 3);
    scene->frame.lamp_count = path >= BY_LAMP ? 1 : 0;
}

double test_path_see(struct test_scene *scene, tl_renderer *renderer, enum test_path path, vec3s direction,
                     float distance_m, float side_m, int size)
{
    vec3s eye = glms_vec3_scale(direction, distance_m);
    float fov_deg = 2 * atanf(side_m / 2 / distance_m) * 180 / (float)M_PI;
    tl_frame frame = test_frame(eye, (vec3s){{0, 0, 0}}, fov_deg, scene->surfaces, 1, &scene->environment);
    frame.lamps = scene->lamps;
    frame.lamp_count = scene->frame.lamp_count;
    scene->frame = frame;
    scene->settings.image.width = scene->settings.image.height = size;
    tl_image image = path == BY_LAMP_EXACTLY ? test_scene_evaluate(scene) : test_scene_draw(scene, renderer);
    double sum = 0;
    for (int i = 0; i < size * size; i++)
        sum += (double)tl_image_floats(&image)[4 * i + 1];
    tl_image_release(&image);
    return sum / (size * size);
}
