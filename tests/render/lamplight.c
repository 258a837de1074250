#include "tests/render/lamplight.h"

#include "render/brdf/brdf.h"
#include "render/reference/shading_point.h"
#include "render/scene/view.h"

#include "tests/testing.h"

static vec3s black(vec3s d)
{
    (void)d;
    return (vec3s){{0, 0, 0}};
}

struct tl_lamp lamp_towards(vec3s direction, float irradiance)
{
    return (struct tl_lamp){.kind = TL_LAMP_DIRECTIONAL,
                            .direction = glms_vec3_normalize(direction),
                            .irradiance = {{irradiance, 0.9f * irradiance, 0.8f * irradiance}}};
}

struct tl_lamp lamp_at(vec3s position, float irradiance)
{
    return (struct tl_lamp){.kind = TL_LAMP_POINT,
                            .position = position,
                            .irradiance = {{irradiance, 0.9f * irradiance, 0.8f * irradiance}}};
}

void lamplit_refresh(struct lamplit *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++) {
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
    }
    scene->frame.surface_count = scene->shape_count;
}

void lamplit_add(struct lamplit *scene, struct test_shape shape)
{
    scene->shapes[scene->shape_count++] = shape;
    lamplit_refresh(scene);
}

void lamplit_open(struct lamplit *scene, struct test_shape shape, int width, int height)
{
    *scene = (struct lamplit){.environment = test_environment(8, 4, black)};
    scene->settings = test_settings(width, height);
    scene->settings.image.supersample = 1;
    scene->settings.light.method = TL_METHOD_UNSHADOWED;
    scene->frame =
        test_frame((vec3s){{0, 0.3f, 2.5f}}, (vec3s){{0, 0, 0}}, 40, scene->surfaces, 0, &scene->environment);
    scene->lamps[0] = lamp_towards((vec3s){{-0.6f, 0.7f, 0.8f}}, 3);
    scene->frame.lamps = scene->lamps;
    scene->frame.lamp_count = 1;
    lamplit_add(scene, shape);
}

void lamplit_close(struct lamplit *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++)
        test_shape_release(&scene->shapes[i]);
    tl_environment_release(&scene->environment);
}

static struct tl_ray_differential pixel_ray(const struct tl_view *view, int width, int height, int x, int y)
{
    float right = 2 * ((float)x + 0.5f) / (float)width - 1, up = 1 - 2 * ((float)y + 0.5f) / (float)height;
    vec3s along = glms_vec3_add(view->forward, glms_vec3_scale(view->right, right));
    along = glms_vec3_add(along, glms_vec3_scale(view->up, up));
    float length = glms_vec3_norm(along);
    return (struct tl_ray_differential){.origin = view->eye,
                                        .direction = glms_vec3_divs(along, length),
                                        .from_m = view->near_m * length,
                                        .to_m = view->far_m * length,
                                        .across = glms_vec3_scale(view->right, 2 / ((float)width * length)),
                                        .down = glms_vec3_scale(view->up, -2 / ((float)height * length))};
}

/* `point` lies on the triangle; the spot's own is where rays start, on the smooth surface. */
static vec3s light_of(const struct tl_shading_point *spot, vec3s point, const struct tl_lamp *lamp)
{
    const struct tl_brdf brdf = tl_brdf_of(spot->material, spot->f0, spot->glossiness);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(spot->normal, spot->tangent, spot->handedness,
                                                          spot->side * spot->material->gloss.rotation);
    bool is_point = lamp->kind == TL_LAMP_POINT;
    vec3s way = is_point ? glms_vec3_sub(lamp->position, point) : lamp->direction;
    float fall = is_point ? 1 / glms_vec3_norm2(way) : 1;
    vec3s l = glms_vec3_normalize(way), gloss = tl_brdf_gloss(&brdf, &frame, l, spot->viewer), sent;
    float cosine = fmaxf(glms_vec3_dot(spot->normal, l), 0);
    float ramp = fminf(fmaxf(32 * glms_vec3_dot(spot->horizon, l), 0), 1);
    for (int c = 0; c < 3; c++)
        sent.raw[c] = ramp * fall * lamp->irradiance.raw[c] *
                      (spot->albedo.raw[c] * cosine / (float)M_PI + gloss.raw[c]);
    return sent;
}

tl_image lamplit_evaluate(const struct lamplit *scene)
{
    const struct tl_image_params *image = &scene->settings.image;
    struct tl_reference_scene traced;
    tl_error error = {0};
    assert_ok(tl_reference_scene_make(&scene->frame, &scene->settings, NULL, &traced, &error), error);
    struct tl_view view = tl_view_make(&scene->frame.camera, image->width, image->height);
    tl_image out = tl_image_create(image->width, image->height, 4, TL_IMAGE_F32);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            struct tl_ray_differential ray = pixel_ray(&view, image->width, image->height, x, y);
            struct tl_shading_point spot = tl_shading_point_find(&traced, &ray);
            struct tl_trace_hit hit =
                tl_trace_nearest(traced.trace, ray.origin, ray.direction, ray.from_m, ray.to_m);
            vec3s point = glms_vec3_add(ray.origin, glms_vec3_scale(ray.direction, hit.distance_m));
            float *pixel = tl_image_floats(&out) + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
            pixel[3] = spot.cover;
            for (size_t i = 0; spot.cover > 0 && i < scene->frame.lamp_count; i++) {
                vec3s light = light_of(&spot, point, &scene->frame.lamps[i]);
                for (int c = 0; c < 3; c++)
                    pixel[c] += light.raw[c];
            }
        }
    tl_reference_scene_release(&traced);
    return out;
}

tl_image lamplit_draw(const struct lamplit *scene, tl_renderer *renderer)
{
    return test_draw(renderer, &scene->frame, &scene->settings);
}

static bool is_inside(const tl_image *image, int x, int y)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (test_pixel(image, x + i, y + j)[3] < 1)
                return false;
    return true;
}

struct lamplit_difference lamplit_compare(const tl_image *drawn, const tl_image *expected)
{
    double squares = 0, sum = 0, peak = 0, largest = 0;
    size_t pixels = 0;
    for (int y = 1; y + 1 < drawn->height; y++)
        for (int x = 1; x + 1 < drawn->width; x++) {
            if (!is_inside(drawn, x, y) || !is_inside(expected, x, y))
                continue;
            pixels++;
            for (int c = 0; c < 3; c++) {
                double is = (double)test_pixel(drawn, x, y)[c], want = (double)test_pixel(expected, x, y)[c];
                if (!isfinite(is))
                    fail_msg("pixel %d, %d is not finite", x, y);
                squares += (is - want) * (is - want);
                sum += want;
                peak = fmax(peak, want);
                largest = fmax(largest, fabs(is - want));
            }
        }
    double count = 3 * (double)pixels;
    return (struct lamplit_difference){sqrt(squares / count) / (sum / count), largest / peak, pixels};
}

struct lamplit_difference lamplit_error(const struct lamplit *scene, tl_renderer *renderer,
                                        const tl_image *expected)
{
    tl_image drawn = lamplit_draw(scene, renderer);
    struct lamplit_difference difference = lamplit_compare(&drawn, expected);
    tl_image_release(&drawn);
    return difference;
}
