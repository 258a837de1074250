/* Light composed from visibility at points, against the integral that it stands for. */
#include "tests/testing.h"

#include "config/base/memory.h"
#include "render/light/compose.h"
#include "render/light/terms.h"

#define CUBE_SIZE 64
#define SAMPLES   300

static vec3s unit(float x, float y, float z)
{
    return glms_vec3_normalize((vec3s){{x, y, z}});
}

/* A fixed sequence in [0, 1). */
static float chance(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

static vec3s random_direction(uint32_t *state)
{
    float y = 2 * chance(state) - 1, angle = 2 * GLM_PIf * chance(state), r = sqrtf(1 - y * y);
    return (vec3s){{r * cosf(angle), y, r * sinf(angle)}};
}

/* A room: soft boxes of different colours on dim walls. */
static vec3s room(vec3s d)
{
    vec3s light = {{0.2f + 0.1f * d.y, 0.25f, 0.3f - 0.1f * d.y}};
    if (glms_vec3_dot(d, unit(1, 1, 0.5f)) > 0.95f)
        light = (vec3s){{9, 8, 6}};
    if (glms_vec3_dot(d, unit(-1, 0.3f, 0.8f)) > 0.9f)
        light = (vec3s){{1, 2, 4}};
    return light;
}

/* The occluder: everything on one side of a slanted plane through the sample is hidden. */
static bool is_open(vec3s d)
{
    return d.x + 0.5f * d.y > -0.1f;
}

struct scene {
    tl_cube cube;
    struct tl_regions regions;
    struct tl_suns suns;
    struct tl_lobes lobes;
    struct tl_region_lights lights;
    struct tl_samples samples;
    struct tl_light_params params;
    uint16_t *values;
    size_t stride;
    struct tl_taps *taps;
    float *light;
};

static vec3s texel_direction(uint32_t texel)
{
    int face = (int)(texel / (CUBE_SIZE * CUBE_SIZE)), rest = (int)(texel % (CUBE_SIZE * CUBE_SIZE));
    int row = rest / CUBE_SIZE;
    return glms_vec3_normalize(tl_cube_direction(face, ((float)(rest % CUBE_SIZE) + 0.5f) / CUBE_SIZE,
                                                 ((float)row + 0.5f) / CUBE_SIZE));
}

static float texel_solid_angle(uint32_t texel)
{
    int rest = (int)(texel % (CUBE_SIZE * CUBE_SIZE));
    return tl_cube_solid_angle(CUBE_SIZE, rest % CUBE_SIZE, rest / CUBE_SIZE);
}

/* The share of each region's luminance that is open. */
static void fill_values(struct scene *scene)
{
    scene->stride = (size_t)(scene->regions.count + 15) / 16 * 16;
    scene->values = TL_NEW_ARRAY(uint16_t, scene->stride);
    for (int i = 0; i < scene->regions.count; i++) {
        double open = 0, all = 0;
        for (uint32_t t = scene->regions.first[i]; t < scene->regions.first[i + 1]; t++) {
            uint32_t texel = scene->regions.texels[t];
            const float *rgb = scene->cube.texels + 3 * (size_t)texel;
            double weight = (double)((rgb[0] + rgb[1] + rgb[2]) * texel_solid_angle(texel));
            all += weight;
            open += is_open(texel_direction(texel)) ? weight : 0;
        }
        scene->values[i] = (uint16_t)lrint((double)TL_VISIBILITY_ONE * open / all);
    }
}

static void fill_samples(struct scene *scene, float glossiness, bool bumped)
{
    uint32_t state = 7;
    scene->samples =
        (struct tl_samples){.width = SAMPLES, .height = 1, .primary_count = SAMPLES, .count = SAMPLES};
    scene->samples.items = TL_NEW_ARRAY(tl_sample, SAMPLES);
    scene->taps = TL_NEW_ARRAY(struct tl_taps, SAMPLES);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        vec3s smooth = random_direction(&state), normal = smooth;
        if (bumped)
            normal =
                glms_vec3_normalize(glms_vec3_add(smooth, glms_vec3_scale(random_direction(&state), 0.4f)));
        vec3s view = random_direction(&state);
        if (glms_vec3_dot(view, normal) < 0)
            view = glms_vec3_negate(view);
        scene->samples.items[i] = (tl_sample){
            .texel = i,
            .cover = 1,
            .normal = normal,
            .smooth = smooth,
            .mirror = glms_vec3_sub(glms_vec3_scale(normal, 2 * glms_vec3_dot(normal, view)), view),
            .glossiness = glossiness,
            .diffuse = {{0.5f, 0.5f, 0.5f}},
            .specular = {{0.5f, 0.5f, 0.5f}}};
        scene->taps[i] = (struct tl_taps){.weight = {1, 0, 0}};
    }
}

static struct scene scene_open(int regions, float glossiness, bool bumped)
{
    struct scene scene = {.cube = tl_cube_create(CUBE_SIZE), .params = {.lobe = TL_LOBE_DUAL}};
    for (uint32_t t = 0; t < 6 * CUBE_SIZE * CUBE_SIZE; t++) {
        vec3s light = room(texel_direction(t));
        for (int c = 0; c < 3; c++)
            scene.cube.texels[3 * (size_t)t + (size_t)c] = light.raw[c];
    }
    tl_regions_cut_sphere(&scene.cube, regions, &scene.regions);
    tl_lobes_make(&scene.lobes, &scene.cube, tl_exponents_needed(glossiness, glossiness));
    tl_region_lights_begin(&scene.lights, &scene.regions, TL_WEIGHT_POWER);
    tl_region_lights_add(&scene.lights, &scene.lobes, ~0u);
    fill_values(&scene);
    fill_samples(&scene, glossiness, bumped);
    scene.light = TL_NEW_ARRAY(float, (size_t)4 * SAMPLES);
    return scene;
}

static void scene_close(struct scene *scene)
{
    tl_cube_release(&scene->cube);
    tl_regions_release(&scene->regions);
    tl_lobes_release(&scene->lobes);
    tl_region_lights_release(&scene->lights);
    free(scene->samples.items);
    free(scene->values);
    free(scene->taps);
    free(scene->light);
}

static void compose(const struct scene *scene)
{
    const struct tl_compose_request request = {.samples = &scene->samples,
                                               .lights = &scene->lights,
                                               .suns = &scene->suns,
                                               .lobes = &scene->lobes,
                                               .values = scene->values,
                                               .stride = scene->stride,
                                               .taps = scene->taps,
                                               .params = &scene->params};
    tl_compose(&request, scene->light);
}

/* The integral that a pixel is (docs/inside.md), texel by texel. */
static vec3s truth(const struct scene *scene, const tl_sample *sample, bool shadowed)
{
    double sum[3] = {0};
    float exponent = 1 / (1 - sample->glossiness);
    for (uint32_t t = 0; t < 6 * CUBE_SIZE * CUBE_SIZE; t++) {
        vec3s d = texel_direction(t);
        if (shadowed && (!is_open(d) || glms_vec3_dot(d, sample->smooth) <= 0))
            continue;
        float lobes = 0.5f * lobe_cosine(1, glms_vec3_dot(d, sample->normal)) +
                      0.5f * lobe_cosine(exponent, glms_vec3_dot(d, sample->mirror));
        for (int c = 0; c < 3; c++)
            sum[c] += (double)(scene->cube.texels[3 * (size_t)t + (size_t)c] * texel_solid_angle(t) * lobes);
    }
    return (vec3s){{(float)sum[0], (float)sum[1], (float)sum[2]}};
}

/* Relative RMSE over all samples, as images are compared. */
static double error_of(struct scene *scene)
{
    bool shadowed = scene->params.method != TL_METHOD_UNSHADOWED;
    compose(scene);
    double square = 0, mean = 0;
    for (size_t i = 0; i < SAMPLES; i++) {
        vec3s expected = truth(scene, &scene->samples.items[i], shadowed);
        for (int c = 0; c < 3; c++) {
            double difference = (double)(scene->light[4 * i + (size_t)c] - expected.raw[c]);
            square += difference * difference;
            mean += (double)expected.raw[c];
        }
    }
    return sqrt(square / (3 * SAMPLES)) / (mean / (3 * SAMPLES));
}

/* With exact visibility of every region what is left is its being one number a region:
 * docs/notes/visibility.md, 5, has 1.4 to 2.2 % at 96 regions, 0.3 to 0.6 % at 384. Here the obstacle is half
 * the sphere, which cuts more regions. */
static void exact_visibility_gives_the_light(void **state)
{
    static const struct {
        int regions;
        float glossiness;
        bool bumped;
        double bound;
    } cases[] = {
        {96, 0, false, 0.025},   {96, 0.7f, false, 0.025},  {96, 0.95f, false, 0.04},
        {384, 0, false, 0.012},  {384, 0.7f, false, 0.012}, {384, 0.95f, false, 0.02},
        {384, 0.7f, true, 0.02},
    };
    (void)state;
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct scene scene = scene_open(cases[i].regions, cases[i].glossiness, cases[i].bumped);
        double error = error_of(&scene);
        print_message("N = %d, g = %.2f%s: %.2f %%\n", cases[i].regions, (double)cases[i].glossiness,
                      cases[i].bumped ? ", bumped" : "", 100 * error);
        assert_true(error <= cases[i].bound);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_visibility_gives_the_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
