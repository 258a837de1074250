/* Look-ups of environment maps on the GPU: texels, borders, both ways to paraboloids. Directions are given
 * as a G-buffer of mirrors, in floats. */
#include "render/envmap/envmap.h"

#include "config/base/memory.h"
#include "render/light/light.h"

#include "tests/testing.h"

#include <epoxy/gl.h>
#include <string.h>

struct device {
    tl_gpu *gpu;
    struct tl_lighting lighting; /* for its table of exponents */
    struct tl_light_buffer light;
    struct tl_envmap envmap;
};

static int open_device(void **state)
{
    tl_error error = {0};
    struct device *device = TL_NEW(struct device);
    const struct tl_triangle_ranges nothing = {0};
    *state = device;
    device->gpu = tl_gpu_create_headless(&error);
    if (!device->gpu || !tl_lighting_create(&device->lighting, device->gpu, &error)) {
        print_error("%s\n", error.message);
        return -1;
    }
    tl_envmap_set_parts(&device->envmap, device->gpu, &nothing, false);
    return 0;
}

static int close_device(void **state)
{
    struct device *device = *state;
    tl_envmap_release(&device->envmap);
    tl_lighting_release(&device->lighting);
    tl_light_buffer_release(&device->light);
    size_t messages = tl_gpu_message_count(device->gpu), bytes = tl_gpu_bytes(device->gpu);
    tl_gpu_destroy(&device->gpu);
    free(device);
    if (messages || bytes)
        print_error("%zu GL messages, %zu bytes of textures left\n", messages, bytes);
    return messages || bytes ? -1 : 0;
}

#define WIDTH 256

/* A mirror with normal d, seen along d from far away, shows what lies in direction d. */
static tl_target mirrors_of(tl_gpu *gpu, const vec3s *directions, int count)
{
    int height = (count + WIDTH - 1) / WIDTH;
    const unsigned formats[TL_GBUFFER_WIDENING] = {GL_RGBA32F, GL_RGBA32F, GL_RGBA32F, GL_RGBA32F, GL_R32UI};
    tl_target target = tl_target_create(gpu, WIDTH, height, formats, TL_GBUFFER_WIDENING, true);
    const float nearest = 0, nothing[4] = {0};
    const GLuint triangle[4] = {1};
    float *points = TL_NEW_ARRAY(float, (size_t)4 * WIDTH * (size_t)height);
    float *normals = TL_NEW_ARRAY(float, (size_t)4 * WIDTH * (size_t)height);
    for (size_t i = 0; i < (size_t)count; i++)
        for (size_t c = 0; c < 4; c++) {
            points[4 * i + c] = c < 3 ? -directions[i].raw[c] : 1;
            normals[4 * i + c] = c < 3 ? directions[i].raw[c] : 0;
        }
    glTextureSubImage2D(target.colours[TL_GBUFFER_POINT].id, 0, 0, 0, WIDTH, height, GL_RGBA, GL_FLOAT,
                        points);
    glTextureSubImage2D(target.colours[TL_GBUFFER_NORMAL].id, 0, 0, 0, WIDTH, height, GL_RGBA, GL_FLOAT,
                        normals);
    glClearNamedFramebufferfv(target.id, GL_COLOR, TL_GBUFFER_DIFFUSE, nothing);
    glClearNamedFramebufferfv(target.id, GL_COLOR, TL_GBUFFER_SPECULAR, nothing);
    glClearNamedFramebufferuiv(target.id, GL_COLOR, TL_GBUFFER_TRIANGLE, triangle);
    glClearNamedFramebufferfv(target.id, GL_DEPTH, 0, &nearest);
    free(points);
    free(normals);
    return target;
}

static void look_up(struct device *device, const struct tl_maps_params *params, const vec3s *directions,
                    int count, vec3s *out)
{
    tl_error error = {0};
    tl_target gbuffer = mirrors_of(device->gpu, directions, count);
    struct tl_maps_params mirror = *params;
    mirror.mode = TL_MAPS_MIRROR;
    const struct tl_view view = {0}; /* the eye is at the origin */
    const struct tl_envmap_request request = {.gbuffer = &gbuffer,
                                              .exponent_levels = &device->lighting.exponent_levels,
                                              .view = &view,
                                              .params = &mirror};
    tl_gpu_reset_state(device->gpu);
    assert_ok(tl_envmap_draw(&device->envmap, device->gpu, &request, &device->light, &error), error);
    tl_gpu_reset_state(device->gpu);
    size_t texels = (size_t)WIDTH * (size_t)gbuffer.height;
    float *light = TL_NEW_ARRAY(float, 4 * texels);
    glGetTextureImage(device->light.target.colours[0].id, 0, GL_RGBA, GL_FLOAT,
                      (GLsizei)(4 * texels * sizeof(float)), light);
    for (int i = 0; i < count; i++)
        memcpy(out[i].raw, light + 4 * (size_t)i, sizeof out[i]);
    free(light);
    tl_target_destroy(&gbuffer);
}

/* A lobe map in the slot of the environment, from a function of direction. */
static struct tl_lobes lobes_of(int size, vec3s (*light)(vec3s))
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s value = light(tl_cube_texel_direction(size, i));
        memcpy(cube.texels + 3 * (size_t)i, value.raw, sizeof value);
    }
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, 1u << TL_EXPONENT_COUNT);
    tl_cube_release(&cube);
    return lobes;
}

static uint32_t scramble(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* Something else in every texel. */
static vec3s noise(vec3s d)
{
    uint32_t hash =
        scramble((uint32_t)(int)(1000 * d.x) * 73856093u ^
                 scramble((uint32_t)(int)(1000 * d.y) * 19349663u ^ scramble((uint32_t)(int)(1000 * d.z))));
    return (vec3s){
        {(float)(hash & 255) / 255, (float)(hash >> 8 & 255) / 255, (float)(hash >> 16 & 255) / 255}};
}

static struct tl_view some_view(void)
{
    struct tl_camera camera = {.eye = {{1, 2, 3}}, .up = {{0, 1, 0}}, .fov_y = 1, .near_m = 1, .far_m = 2};
    return tl_view_make(&camera, 1, 1);
}

static mat3s turned(float yaw)
{
    mat3s axes = glms_mat3_identity();
    for (int i = 0; i < 3; i++)
        axes.col[i] = tl_turn_direction(axes.col[i], yaw);
    return axes;
}

/* At a texel's centre a bilinear look-up reads that texel and no other: GL and the CPU lay every layout out
 * the same way, to well within half a texel. A direction in floats is off by 1e-7 of up to 2 / pi turns of 64
 * texels; near a ball's rim a texel is so thin that it is off by more (its 5 outermost texels are left out).
 */
static void centres_show_their_texels(void **state)
{
    struct device *device = *state;
    struct tl_lobes lobes = lobes_of(32, noise);
    struct tl_view view = some_view();
    mat3s axes = turned(0.6f);
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_maps_params params = {.layout = layout, .size = 32};
        tl_envmap_fill(&device->envmap, device->gpu, &params, &lobes, &axes, &view);
        const struct tl_sphere_map *map = &device->envmap.levels.maps[0];
        mat3s to_world = glms_mat3_transpose(device->envmap.turn);
        struct tl_prefiltered_map picture =
            tl_prefiltered_map_make(&device->envmap.levels, &lobes, TL_EXPONENT_COUNT,
                                    glms_mat3_mul(glms_mat3_transpose(axes), to_world));
        int count = map->width * map->height;
        vec3s *directions = TL_NEW_ARRAY(vec3s, (size_t)count), *seen = TL_NEW_ARRAY(vec3s, (size_t)count);
        for (int i = 0; i < count; i++) {
            int row = i / map->width;
            directions[i] =
                glms_mat3_mulv(to_world, tl_layout_direction(map, i % map->width + 0.5, row + 0.5));
        }
        for (int way = 0; way < (layout == TL_LAYOUT_PARABOLOID ? 2 : 1); way++) {
            double worst = 0;
            params.look_up = way;
            look_up(device, &params, directions, count, seen);
            for (int i = 0; i < count; i++) {
                int row = i / map->width;
                double x = i % map->width % map->height + 0.5 - 16, y = row + 0.5 - 16;
                double rim = layout == TL_LAYOUT_SPHERE ? 11 : layout == TL_LAYOUT_PARABOLOID ? 14 : 100;
                if (layout == TL_LAYOUT_CUBE || layout == TL_LAYOUT_LATLONG || hypot(x, y) < rim)
                    for (int c = 0; c < 3; c++)
                        worst = fmax(worst, fabs((double)(seen[i].raw[c] - picture.texels[0][4 * i + c])));
            }
            print_message("%s%s: off by %.1e of a contrast of 1\n", tl_layout_names[layout],
                          way ? " by matrix" : "", worst);
            assert_true(worst < 1e-3); /* half a texel would be 0.5 */
        }
        tl_prefiltered_map_release(&picture);
        free(directions);
        free(seen);
    }
    tl_lobes_release(&lobes);
}

/* Two directions, a tenth of a thousandth of a texel to either side of a border, and which border it is. */
enum border { EDGE, CORNER, RIM, MERIDIAN, POLE, BEHIND, FOLD, BORDERS };
static const char *const border_names[BORDERS] = {"cube edge",      "cube corner",   "paraboloid rim",
                                                  "date line",      "lat-long pole", "ball's -Z",
                                                  "octahedron edge"};
#define PER_BORDER 96
#define STEP       1e-5f

static vec3s beside(vec3s at, vec3s away, float step)
{
    return glms_vec3_normalize(glms_vec3_add(at, glms_vec3_scale(away, step)));
}

/* `along` goes once over the border. */
static void border_pair(enum border border, int number, vec3s pair[2])
{
    float along = ((float)number + 0.37f) / PER_BORDER, turn = 2 * (float)M_PI * along;
    vec3s at = {{0, 0, 0}}, away = {{0, 0, 0}};
    int axis = number % 3, other = (axis + 1) % 3, third = (axis + 2) % 3;
    float sign = number & 4 ? 1 : -1, other_sign = number & 8 ? 1 : -1;
    switch (border) {
    case EDGE: /* all twelve */
        at.raw[axis] = sign;
        at.raw[other] = other_sign;
        at.raw[third] = 2 * along - 1;
        away.raw[axis] = sign;
        away.raw[other] = -other_sign;
        break;
    case CORNER: /* about all eight */
        at = (vec3s){{number & 1 ? 1 : -1, number & 2 ? 1 : -1, number & 4 ? 1 : -1}};
        away.raw[number / 8 % 3] = 1;
        away.raw[(number / 8 + 1) % 3] = -at.raw[number / 8 % 3] * at.raw[(number / 8 + 1) % 3];
        break;
    case RIM:
        at = (vec3s){{cosf(turn), sinf(turn), 0}};
        away.z = 1;
        break;
    case MERIDIAN:
        at = (vec3s){{0, cosf(0.5f * turn), sinf(0.5f * turn)}};
        away.x = 1;
        break;
    case POLE:
        at.y = sign;
        away = (vec3s){{cosf(turn), 0, sinf(turn)}};
        break;
    case BEHIND:
        at.z = -1;
        away = (vec3s){{cosf(turn), sinf(turn), 0}};
        break;
    default: /* where a coordinate vanishes: folds, and the border below the horizon */
        at.raw[other] = cosf(turn);
        at.raw[third] = sinf(turn);
        away.raw[axis] = 1;
    }
    at = glms_vec3_normalize(at);
    pair[0] = beside(at, away, STEP);
    pair[1] = beside(at, away, -STEP);
}

/* A soft room: its steepest slope is 2 a radian or so. */
static vec3s soft(vec3s d)
{
    return (vec3s){{1 + 0.6f * d.x + 0.4f * d.y * d.z, 1 - 0.7f * d.z + 0.3f * d.x * d.x, 1 + 0.8f * d.y}};
}

/* Steepest slope of the soft room, by radian. */
#define SLOPE 1.2

/* The largest step from one side of a border to the other, by layout and border, in texels' worth of slope: a
 * border that were read from the wrong place would show steps of many texels; clamping at the middle of the
 * outermost texel may cost half a texel on either side. A texel is taken for the root of the mean solid
 * angle. A ball's look-up half a texel inside of its rim, 1 / 64 of the radius, shows what lies 2 sqrt(2 /
 * 64) rad from -Z, on either side: that direction is singular, and therefore the map is turned so that nobody
 * looks there. */
static double seam_bound(int layout, enum border border, double texel)
{
    if (layout == TL_LAYOUT_SPHERE && border == BEHIND)
        return 4 * sqrt(2.0 / 64) / texel;
    /* other borders cross the paraboloids' rim, and some of these where it touches the picture's */
    bool clamps = layout == TL_LAYOUT_PARABOLOID || (layout == TL_LAYOUT_LATLONG && border == POLE);
    return clamps ? 1 : 0.02;
}

static void borders_show_no_seam(void **state)
{
    struct device *device = *state;
    struct tl_lobes lobes = lobes_of(128, soft);
    mat3s axes = glms_mat3_identity();
    struct tl_view ahead = {.forward = {{0, 0, -1}}, .right = {{1, 0, 0}}, .up = {{0, 1, 0}}};
    vec3s pairs[2 * BORDERS * PER_BORDER], seen[2 * BORDERS * PER_BORDER];
    for (int i = 0; i < BORDERS * PER_BORDER; i++)
        border_pair((enum border)(i / PER_BORDER), i % PER_BORDER, pairs + (size_t)2 * (size_t)i);
    for (int layout = 0; layout <= TL_LAYOUT_COUNT; layout++) {
        bool by_matrix = layout == TL_LAYOUT_COUNT; /* paraboloids once more */
        struct tl_maps_params params = {
            .layout = by_matrix ? TL_LAYOUT_PARABOLOID : layout, .size = 64, .look_up = by_matrix};
        tl_envmap_fill(&device->envmap, device->gpu, &params, &lobes, &axes, &ahead);
        look_up(device, &params, pairs, 2 * BORDERS * PER_BORDER, seen);
        double texels = 0, worst[BORDERS] = {0};
        for (int i = 0; i < device->envmap.levels.maps[0].width * device->envmap.levels.maps[0].height; i++)
            texels += device->envmap.levels.solid_angles[0][i] > 0;
        double texel = sqrt(4 * M_PI / texels);
        for (int i = 0; i < BORDERS * PER_BORDER; i++)
            for (int c = 0; c < 3; c++) {
                double step = fabs((double)(seen[2 * (size_t)i].raw[c] - seen[2 * (size_t)i + 1].raw[c]));
                worst[i / PER_BORDER] = fmax(worst[i / PER_BORDER], step / (SLOPE * texel));
            }
        print_message("%s:", by_matrix ? "paraboloid by matrix" : tl_layout_names[layout]);
        for (int border = 0; border < BORDERS; border++) {
            print_message(" %s %.3f", border_names[border], worst[border]);
            assert_true(worst[border] < seam_bound(params.layout, (enum border)border, texel));
        }
        print_message(" texels\n");
    }
    tl_lobes_release(&lobes);
}

/* Whatever is in the map: seamless layouts have no step at all, even from noise. */
static void seamless_layouts_are_continuous(void **state)
{
    struct device *device = *state;
    struct tl_lobes lobes = lobes_of(32, noise);
    mat3s axes = glms_mat3_identity();
    vec3s pairs[2 * BORDERS * PER_BORDER], seen[2 * BORDERS * PER_BORDER];
    for (int i = 0; i < BORDERS * PER_BORDER; i++)
        border_pair((enum border)(i / PER_BORDER), i % PER_BORDER, pairs + (size_t)2 * (size_t)i);
    const enum tl_layout layouts[] = {TL_LAYOUT_CUBE, TL_LAYOUT_OCTAHEDRAL};
    for (int k = 0; k < 2; k++) {
        struct tl_maps_params params = {.layout = (int)layouts[k], .size = 32};
        tl_envmap_fill(&device->envmap, device->gpu, &params, &lobes, &axes, NULL);
        look_up(device, &params, pairs, 2 * BORDERS * PER_BORDER, seen);
        double worst = 0;
        for (int i = 0; i < BORDERS * PER_BORDER; i++)
            for (int c = 0; c < 3; c++)
                worst =
                    fmax(worst, fabs((double)(seen[2 * (size_t)i].raw[c] - seen[2 * (size_t)i + 1].raw[c])));
        print_message("%s: largest step over a border %.1e of a contrast of 1\n", tl_layout_names[layouts[k]],
                      worst);
        assert_true(worst < 5e-3); /* 2e-5 rad of texels of 0.05 rad, two steps of 1 and a corner's three */
    }
    tl_lobes_release(&lobes);
}

/* Equation 7, with a turned environment as M: away from the rim the two ways are the same numbers but for
 * rounding; there they choose other discs, of which both show the same. */
static void the_matrix_is_the_direct_way(void **state)
{
    struct device *device = *state;
    struct tl_lobes noisy = lobes_of(32, noise), lobes = lobes_of(64, soft);
    mat3s axes = turned(1.1f);
    enum { COUNT = 8192 };
    vec3s *directions = TL_NEW_ARRAY(vec3s, COUNT), *seen[2];
    for (int i = 0; i < COUNT; i++) {
        float z = 1 - (2 * (float)i + 1) / COUNT, phi = 2.39996323f * (float)i, r = sqrtf(1 - z * z);
        directions[i] = (vec3s){{r * cosf(phi), r * sinf(phi), z}};
    }
    for (int soft_one = 0; soft_one < 2; soft_one++) {
        for (int way = 0; way < 2; way++) {
            struct tl_maps_params params = {.layout = TL_LAYOUT_PARABOLOID, .size = 64, .look_up = way};
            seen[way] = TL_NEW_ARRAY(vec3s, COUNT);
            tl_envmap_fill(&device->envmap, device->gpu, &params, soft_one ? &lobes : &noisy, &axes, NULL);
            look_up(device, &params, directions, COUNT, seen[way]);
        }
        double worst = 0, at_rim = 0;
        for (int i = 0; i < COUNT; i++) {
            vec3s d = glms_mat3_mulv(device->envmap.turn, directions[i]);
            double off = (double)glms_vec3_distance(seen[0][i], seen[1][i]);
            /* three texels of 1/32 from the rim: z = (1 - r^2) / (1 + r^2) */
            bool near_rim = fabs((double)d.z) < 0.1;
            worst = fmax(worst, near_rim ? 0 : off);
            at_rim = fmax(at_rim, near_rim ? off : 0);
        }
        print_message("%s: matrix against direct %.1e, within three texels of the rim %.3f\n",
                      soft_one ? "soft" : "noise", worst, at_rim);
        /* Both ways round the weights of filters, along two axes; texels of noise differ by up to one. */
        assert_true(worst < 1e-4 + 2 * 2 * sqrt(3) * TEST_WEIGHT);
        /* A look-up reads a texel beside at most: of the soft room 1.2 a radian, sqrt 3 channels. */
        assert_true(!soft_one || at_rim < 1.2 * sqrt(3) * 2 / 32);
        free(seen[0]);
        free(seen[1]);
    }
    free(directions);
    tl_lobes_release(&noisy);
    tl_lobes_release(&lobes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(centres_show_their_texels),
        cmocka_unit_test(borders_show_no_seam),
        cmocka_unit_test(seamless_layouts_are_continuous),
        cmocka_unit_test(the_matrix_is_the_direct_way),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
