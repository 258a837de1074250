#include "tests/render/scenes.h"
#include "tests/render/bindings.h"

#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"
#include "render/brdf/brdf.h"
#include "render/reference/shading_point.h"
#include "render/scene/view.h"

#include "tests/testing.h"

#include <stdlib.h>

void test_shape_release(struct test_shape *shape)
{
    tl_mesh_release(&shape->mesh);
    tl_light_mesh_release(&shape->light_mesh);
    *shape = (struct test_shape){0};
}

void test_shape_refresh(struct test_shape *shape)
{
    static uint64_t revision; /* no two shapes share one: places in a frame's list are used again */
    revision++;
    shape->surface = tl_surface_of_mesh("shape", &shape->mesh, &shape->material);
    shape->surface.topology_revision = shape->surface.motion_revision = revision;
    shape->surface.light_mesh = shape->light_mesh.from ? &shape->light_mesh : NULL;
}

/* A grid of (columns + 1) x (rows + 1) vertices, to be placed by the caller; u = column / columns, v = row /
 * rows; triangles counter-clockwise where u runs right and v down. */
static tl_mesh grid(int columns, int rows)
{
    size_t count = (size_t)(columns + 1) * (size_t)(rows + 1);
    tl_mesh mesh = {.vertex_count = count,
                    .positions = TL_NEW_ARRAY(vec3s, count),
                    .normals = TL_NEW_ARRAY(vec3s, count),
                    .uvs = TL_NEW_ARRAY(vec2s, count),
                    .tangents = TL_NEW_ARRAY(vec4s, count),
                    .index_count = (size_t)columns * (size_t)rows * 6,
                    .indices = TL_NEW_ARRAY(uint32_t, (size_t)columns * (size_t)rows * 6),
                    .part_count = 1,
                    .parts = TL_NEW(struct tl_mesh_part)};
    uint32_t *index = mesh.indices, stride = (uint32_t)columns + 1;
    for (uint32_t y = 0; y <= (uint32_t)rows; y++)
        for (uint32_t x = 0; x < stride; x++)
            mesh.uvs[y * stride + x] = (vec2s){{(float)x / (float)columns, (float)y / (float)rows}};
    for (uint32_t y = 0; y < (uint32_t)rows; y++)
        for (uint32_t x = 0; x < (uint32_t)columns; x++) {
            uint32_t a = y * stride + x, b = a + 1, c = a + stride, d = c + 1;
            const uint32_t quad[6] = {a, c, b, b, c, d};
            for (int i = 0; i < 6; i++)
                *index++ = quad[i];
        }
    mesh.parts[0] = (struct tl_mesh_part){.index_count = (uint32_t)mesh.index_count};
    return mesh;
}

static struct test_shape finish(tl_mesh mesh)
{
    tl_mesh_measure_uvs(&mesh);
    struct test_shape shape = {.mesh = mesh, .material = tl_material_default("test")};
    return shape;
}

static vec4s tangent_of(vec3s t)
{
    return (vec4s){{t.x, t.y, t.z, 1}};
}

struct test_shape test_sphere(vec3s centre, float radius, int segments)
{
    tl_mesh mesh = grid(2 * segments, segments);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        float phi = 2 * (float)M_PI * mesh.uvs[i].x, theta = (float)M_PI * mesh.uvs[i].y;
        vec3s n = {{sinf(theta) * sinf(phi), cosf(theta), sinf(theta) * cosf(phi)}};
        mesh.normals[i] = n;
        mesh.positions[i] = glms_vec3_add(centre, glms_vec3_scale(n, radius));
        mesh.tangents[i] = tangent_of((vec3s){{cosf(phi), 0, -sinf(phi)}});
    }
    return finish(mesh);
}

struct test_shape test_square(vec3s centre, vec3s right, vec3s normal, float half, int cells)
{
    tl_mesh mesh = grid(cells, cells);
    vec3s up = glms_vec3_cross(normal, right);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        vec3s sideways = glms_vec3_scale(right, half * (2 * mesh.uvs[i].x - 1));
        vec3s upward = glms_vec3_scale(up, half * (1 - 2 * mesh.uvs[i].y));
        mesh.positions[i] = glms_vec3_add(centre, glms_vec3_add(sideways, upward));
        mesh.normals[i] = normal;
        mesh.tangents[i] = tangent_of(right);
    }
    return finish(mesh);
}

struct test_shape test_sheet(float height, float half, float amplitude, float waves, int cells)
{
    tl_mesh mesh = grid(cells, cells);
    float k = 2 * (float)M_PI * waves / (2 * half);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        float x = half * (2 * mesh.uvs[i].x - 1), z = half * (2 * mesh.uvs[i].y - 1);
        float dx = amplitude * k * cosf(k * x) * cosf(k * z), dz = -amplitude * k * sinf(k * x) * sinf(k * z);
        mesh.positions[i] = (vec3s){{x, height + amplitude * sinf(k * x) * cosf(k * z), z}};
        mesh.normals[i] = glms_vec3_normalize((vec3s){{-dx, 1, -dz}});
        mesh.tangents[i] = tangent_of(glms_vec3_normalize((vec3s){{1, dx, 0}}));
    }
    return finish(mesh);
}

void test_shape_split(struct test_shape *shape, int cells)
{
    tl_mesh *mesh = &shape->mesh, old = *mesh;
    size_t count = mesh->vertex_count, side = (size_t)cells + 1, own = 0, end = 0;
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, count);
    size_t own_count = (size_t)(cells / 2 + 1) * (size_t)(cells / 2 + 1);
    for (size_t i = 0; i < count; i++)
        numbers[i] = (uint32_t)(i % side % 2 == 0 && i / side % 2 == 0 ? own++ : own_count + end++);
    shape->light_mesh = tl_light_mesh_make(count);
    mesh->positions = TL_NEW_ARRAY(vec3s, count);
    mesh->normals = TL_NEW_ARRAY(vec3s, count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, count);
    mesh->tangents = TL_NEW_ARRAY(vec4s, count);
    for (size_t i = 0; i < count; i++) {
        bool along = i % side % 2 == 1, down = i / side % 2 == 1;
        size_t step = along && down ? side - 1 : along ? 1 : down ? side : 0; /* the diagonal of grid() */
        uint32_t *from = shape->light_mesh.from[numbers[i]];
        float *shares = shape->light_mesh.shares[numbers[i]];
        from[0] = numbers[i - step], from[1] = from[2] = numbers[i + step];
        shares[0] = shares[1] = 0.5f;
        mesh->positions[numbers[i]] = old.positions[i];
        mesh->normals[numbers[i]] = old.normals[i];
        mesh->uvs[numbers[i]] = old.uvs[i];
        mesh->tangents[numbers[i]] = old.tangents[i];
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        mesh->indices[i] = numbers[mesh->indices[i]];
    tl_light_mesh_number(&shape->light_mesh, mesh->indices, mesh->index_count);
    old.indices = NULL;
    old.parts = NULL;
    tl_mesh_release(&old);
    free(numbers);
}

static uint64_t environment_count; /* the revision of the newest one: addresses are used again */

vec3s test_black(vec3s direction)
{
    (void)direction;
    return (vec3s){{0, 0, 0}};
}

vec3s test_white(vec3s direction)
{
    (void)direction;
    return (vec3s){{1, 1, 1}};
}

vec3s test_daylight(vec3s direction)
{
    bool sun = glms_vec3_dot(direction, glms_vec3_normalize((vec3s){{0.3f, 0.8f, 0.5f}})) > 0.99f;
    return sun ? (vec3s){{60, 55, 50}} : (vec3s){{0.4f, 0.5f, 0.6f + 0.3f * direction.y}};
}

tl_environment test_environment(int width, int height, test_radiance *radiance)
{
    tl_environment environment = {.name = tl_copy_string("test"),
                                  .layout = TL_ENV_LATLONG,
                                  .image = tl_image_create(width, height, 3, TL_IMAGE_F32)};
    float *texel = tl_image_floats(&environment.image);
    environment_count++;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, texel += 3) {
            float phi = 2 * (float)M_PI * (((float)x + 0.5f) / (float)width - 0.5f);
            float theta = (float)M_PI * ((float)y + 0.5f) / (float)height;
            vec3s d = {{sinf(theta) * sinf(phi), cosf(theta), -sinf(theta) * cosf(phi)}};
            vec3s value = radiance(d);
            for (int c = 0; c < 3; c++) {
                texel[c] = value.raw[c];
                environment.peak = fmaxf(environment.peak, value.raw[c]);
            }
        }
    return environment;
}

struct tl_render_settings test_settings(int width, int height)
{
    struct tl_render_settings settings = {
        .light = *(const struct tl_light_params *)tl_light_options.defaults,
        .maps = *(const struct tl_maps_params *)tl_maps_options.defaults,
        .shading = *(const struct tl_shading_params *)tl_shading_options.defaults,
        .image = *(const struct tl_image_params *)tl_image_options.defaults,
        .reference = *(const struct tl_reference_params *)tl_reference_options.defaults,
    };
    settings.detail = *(const struct tl_detail_params *)tl_detail_options.defaults;
    settings.detail.minify = TL_DETAIL_MINIFY_NONE;
    settings.light.regions = 24;
    settings.light.pem_size = 32;
    settings.image.width = width;
    settings.image.height = height;
    settings.image.ground = false;
    return settings;
}

tl_frame test_frame(vec3s eye, vec3s target, float fov_deg, const tl_surface *surfaces, size_t count,
                    const tl_environment *environment)
{
    return (tl_frame){.camera = {.eye = eye,
                                 .target = target,
                                 .up = {{0, 1, 0}},
                                 .fov_y = fov_deg * (float)M_PI / 180,
                                 .near_m = 0.01f,
                                 .far_m = 100},
                      .surfaces = surfaces,
                      .surface_count = count,
                      .environment = environment,
                      .environment_revision = environment_count};
}

tl_image test_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings)
{
    tl_error error = {0};
    tl_image image;
    assert_ok(tl_renderer_draw(renderer, frame, settings, &error), error);
    assert_ok(tl_renderer_read(renderer, &image, &error), error);
    return image;
}

const float *test_pixel(const tl_image *image, int x, int y)
{
    return tl_image_floats(image) + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

double test_brightest(const tl_image *image)
{
    double peak = 0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        peak = fmax(peak, (double)tl_image_floats(image)[4 * i]);
    return peak;
}

int test_device_open(void **state)
{
    tl_error error = {0};
    struct test_device *device = TL_NEW(struct test_device);
    *state = device;
    device->cache = tl_format("%s/maps_%ld", TOILE_SCRATCH_DIR, (long)getpid());
    tl_cache_use(device->cache, TL_CACHE_LIMIT_BYTES);
    device->gpu = tl_gpu_create_headless(&error);
    test_bindings_watch();
    if (device->gpu)
        device->renderer = tl_renderer_create(device->gpu, &error);
    if (!device->renderer)
        print_error("%s\n", error.message);
    return device->renderer ? 0 : -1;
}

int test_device_close(void **state)
{
    struct test_device *device = *state;
    tl_renderer_destroy(&device->renderer);
    size_t messages = tl_gpu_message_count(device->gpu), bytes = tl_gpu_bytes(device->gpu);
    size_t bindings = test_bindings_take_faults();
    tl_gpu_destroy(&device->gpu);
    tl_cache_use(NULL, 0);
    tl_cache_clear(device->cache);
    rmdir(device->cache);
    free(device->cache);
    free(device);
    if (messages || bytes || bindings)
        print_error(
            "%zu GL messages, %zu bytes of textures and buffers left, %zu bindings that cannot be read\n",
            messages, bytes, bindings);
    return messages || bytes || bindings ? -1 : 0;
}

void test_scene_open(struct test_scene *scene, tl_environment environment, vec3s eye, vec3s target,
                     float fov_deg, int width, int height)
{
    *scene = (struct test_scene){.environment = environment, .settings = test_settings(width, height)};
    scene->frame = test_frame(eye, target, fov_deg, scene->surfaces, 0, &scene->environment);
    scene->frame.lamps = scene->lamps;
}

void test_scene_refresh(struct test_scene *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++) {
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
    }
    scene->frame.surface_count = scene->shape_count;
}

void test_scene_use_rays(struct test_scene *scene, int regions, int rounds)
{
    struct tl_light_params *light = &scene->settings.light;
    light->lobe = TL_LOBE_DUAL;
    light->cut = TL_CUT_SPHERE;
    light->regions = regions;
    light->visibility = TL_VISIBILITY_RAYS;
    light->composition = TL_COMPOSE_RATIO;
    light->sun = true;
    light->jitter = true;
    light->rounds = rounds;
    scene->settings.image.supersample = 1;
}

tl_material *test_scene_add(struct test_scene *scene, struct test_shape shape)
{
    assert_true(scene->shape_count < TEST_SHAPES_MAX);
    struct test_shape *added = &scene->shapes[scene->shape_count++];
    *added = shape;
    test_scene_refresh(scene);
    return &added->material;
}

void test_scene_close(struct test_scene *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++)
        test_shape_release(&scene->shapes[i]);
    tl_weave_release(&scene->weave);
    tl_environment_release(&scene->environment);
}

tl_image test_scene_draw(const struct test_scene *scene, tl_renderer *renderer)
{
    return test_draw(renderer, &scene->frame, &scene->settings);
}

void test_scene_open_ball_and_sheet(struct test_scene *scene, test_radiance *radiance)
{
    test_scene_open(scene, test_environment(64, 32, radiance), (vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.6f, 0}},
                    40, 48, 32);
    test_scene_add(scene, test_sphere((vec3s){{0, 0.5f, 0}}, 0.4f, 16));
    test_scene_add(scene, test_sheet(1.1f, 0.5f, 0.06f, 2, 16));
    scene->settings.image.ground = true;
}

struct tl_lamp test_lamp_towards(vec3s direction, float irradiance)
{
    return (struct tl_lamp){.kind = TL_LAMP_DIRECTIONAL,
                            .direction = glms_vec3_normalize(direction),
                            .irradiance = {{irradiance, 0.9f * irradiance, 0.8f * irradiance}}};
}

struct tl_lamp test_lamp_at(vec3s position, float irradiance)
{
    return (struct tl_lamp){.kind = TL_LAMP_POINT,
                            .position = position,
                            .irradiance = {{irradiance, 0.9f * irradiance, 0.8f * irradiance}}};
}

void test_scene_open_lamplit(struct test_scene *scene, struct test_shape shape, int width, int height)
{
    test_scene_open(scene, test_environment(8, 4, test_black), (vec3s){{0, 0.3f, 2.5f}}, (vec3s){{0, 0, 0}},
                    40, width, height);
    scene->settings.image.supersample = 1;
    scene->settings.light.method = TL_METHOD_UNSHADOWED;
    scene->lamps[0] = test_lamp_towards((vec3s){{-0.6f, 0.7f, 0.8f}}, 3);
    scene->frame.lamp_count = 1;
    test_scene_add(scene, shape);
}

/* `point` lies on the triangle; that of `shaded` is the origin of its rays, on the smooth surface. */
static vec3s light_of(const struct tl_shading_point *shaded, vec3s point, const struct tl_lamp *lamp)
{
    const struct tl_brdf_sum brdfs =
        tl_brdf_sum_of(shaded->material, shaded->f0, shaded->albedo, shaded->glossiness,
                       shaded->side * shaded->handedness, shaded->widening);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(shaded->normal, shaded->tangent, shaded->handedness,
                                                          shaded->side * shaded->material->gloss.rotation);
    bool is_point = lamp->kind == TL_LAMP_POINT;
    vec3s to_lamp = is_point ? glms_vec3_sub(lamp->position, point) : lamp->direction;
    float fall = is_point ? 1 / glms_vec3_norm2(to_lamp) : 1;
    vec3s l = glms_vec3_normalize(to_lamp), gloss = tl_brdf_sum_gloss(&brdfs, &frame, l, shaded->viewer),
          sent;
    float cosine = fmaxf(glms_vec3_dot(shaded->normal, l), 0), along = glms_vec3_dot(frame.tangent, l);
    if (shaded->material->gloss.model == TL_REFLECT_BANKS) /* [Heidrich and Seidel 1999, eq. 4] */
        cosine *= sqrtf(1 - along * along);
    float ramp = fminf(fmaxf(32 * glms_vec3_dot(shaded->horizon, l), 0), 1);
    for (int c = 0; c < 3; c++)
        sent.raw[c] = ramp * fall * lamp->irradiance.raw[c] *
                      (shaded->albedo.raw[c] * cosine / (float)M_PI + gloss.raw[c]);
    return sent;
}

tl_image test_scene_evaluate(const struct test_scene *scene)
{
    const struct tl_image_params *image = &scene->settings.image;
    struct tl_reference_scene traced;
    tl_error error = {0};
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene->frame, &scene->settings, NULL);
    assert_ok(tl_reference_scene_make(&request, &traced, &error), error);
    struct tl_view view = tl_view_make(&scene->frame.camera, image->width, image->height);
    tl_image out = tl_image_create(image->width, image->height, 4, TL_IMAGE_F32);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            struct tl_ray_differential ray = tl_camera_ray(&view, image->width, image->height, x, y);
            struct tl_shading_point shaded = tl_shading_point_find(&traced, &ray);
            struct tl_trace_hit hit =
                tl_trace_nearest(traced.trace, ray.origin, ray.direction, ray.from_m, ray.to_m);
            vec3s point = glms_vec3_add(ray.origin, glms_vec3_scale(ray.direction, hit.distance_m));
            float *pixel = tl_image_floats(&out) + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
            pixel[3] = shaded.cover;
            for (size_t i = 0; shaded.cover > 0 && i < scene->frame.lamp_count; i++) {
                vec3s light = light_of(&shaded, point, &scene->frame.lamps[i]);
                for (int c = 0; c < 3; c++)
                    pixel[c] += light.raw[c];
            }
        }
    tl_reference_scene_release(&traced);
    return out;
}

static bool is_inside(const tl_image *image, int x, int y)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (test_pixel(image, x + i, y + j)[3] < 1)
                return false;
    return true;
}

/* The larger of the steps to the two neighbours of a pixel along an axis. */
static double steepest(const tl_image *image, int x, int y, int along_x, int along_y, int channel)
{
    double here = (double)test_pixel(image, x, y)[channel];
    double after = fabs((double)test_pixel(image, x + along_x, y + along_y)[channel] - here);
    double before = fabs((double)test_pixel(image, x - along_x, y - along_y)[channel] - here);
    return fmax(after, before);
}

struct test_difference test_compare(const tl_image *drawn, const tl_image *expected)
{
    double squares = 0, sum = 0, peak = 0, largest = 0, moved_squares = 0, moved_largest = 0;
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
                double moved =
                    TEST_PLACE * (steepest(expected, x, y, 1, 0, c) + steepest(expected, x, y, 0, 1, c));
                moved_squares += moved * moved;
                moved_largest = fmax(moved_largest, moved);
            }
        }
    double count = 3 * (double)pixels;
    double mean = sum / count;
    return (struct test_difference){sqrt(squares / count) / mean, largest / peak, pixels,
                                    sqrt(moved_squares / count) / mean, moved_largest / peak};
}

struct test_difference test_scene_error(const struct test_scene *scene, tl_renderer *renderer,
                                        const tl_image *expected)
{
    tl_image drawn = test_scene_draw(scene, renderer);
    struct test_difference difference = test_compare(&drawn, expected);
    tl_image_release(&drawn);
    return difference;
}
