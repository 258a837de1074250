#include "tests/render/shapes.h"

#include "config/memory.h"

#include "tests/testing.h"

void test_shape_release(struct test_shape *shape)
{
    tl_mesh_release(&shape->mesh);
    *shape = (struct test_shape){0};
}

void test_shape_refresh(struct test_shape *shape)
{
    static uint64_t revision; /* no two shapes share one: places in a frame's list are used again */
    revision++;
    shape->surface = tl_surface_of_mesh("shape", &shape->mesh, &shape->material);
    shape->surface.topology_revision = shape->surface.motion_revision = revision;
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

static uint64_t environment_count; /* the revision of the newest one: addresses are used again */

tl_environment test_environment(int width, int height, vec3s (*radiance)(vec3s direction))
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

int test_device_open(void **state)
{
    tl_error error = {0};
    struct test_device *device = TL_NEW(struct test_device);
    *state = device;
    device->gpu = tl_gpu_create_headless(&error);
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
    size_t messages = tl_gpu_message_count(device->gpu), bytes = tl_gpu_texture_bytes(device->gpu);
    tl_gpu_destroy(&device->gpu);
    free(device);
    if (messages || bytes)
        print_error("%zu GL messages, %zu bytes of textures left\n", messages, bytes);
    return messages || bytes ? -1 : 0;
}
