/* Light is neither lost nor doubled on its way from the environment into regions and lobes. */
#include "app/lab/check/check_measures.h"
#include "config/base/memory.h"
#include "render/inside.h"
#include "render/pem/chain.h"

#include <math.h>
#include <stdlib.h>

/* Directions in which lobes are evaluated: a uniform spiral. */
enum { DIRECTIONS = 12 };

static vec3s spiral(int i)
{
    const double golden = 2.399963229728653;
    double y = 1 - (2 * i + 1.0) / DIRECTIONS, radius = sqrt(1 - y * y);
    return (vec3s){{(float)(radius * cos(golden * i)), (float)y, (float)(radius * sin(golden * i))}};
}

/* Whether a resource is valid: made in this frame, or kept from an earlier one. */
static bool has(const struct tl_checked *checked, enum tl_resource resource)
{
    return tl_renderer_frame_resources(checked->renderer)->valid & TL_BIT(resource);
}

struct power {
    double rgb[3];
};

/* Radiance times solid angle of every texel, on the environment's own grid. */
static struct power power_of_environment(const tl_environment *environment)
{
    struct power power = {{0}};
    const tl_image *image = &environment->image;
    const float *texels = tl_image_floats(image);
    int side = image->width;
    for (int y = 0; y < image->height; y++) {
        double above = cos(M_PI * y / image->height), below = cos(M_PI * (y + 1) / image->height);
        double in_row = 2 * M_PI * (above - below) / image->width;
        for (int x = 0; x < image->width; x++) {
            double solid_angle = environment->layout == TL_ENV_LATLONG
                                     ? in_row
                                     : (double)tl_cube_solid_angle(side, x, y % side);
            for (int c = 0; c < 3; c++)
                power.rgb[c] +=
                    solid_angle * (double)texels[3 * ((size_t)y * (size_t)side + (size_t)x) + (size_t)c];
        }
    }
    return power;
}

static struct power power_of_cube(const tl_cube *cube)
{
    struct power power = {{0}};
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < cube->size; y++)
            for (int x = 0; x < cube->size; x++) {
                double solid_angle = (double)tl_cube_solid_angle(cube->size, x, y);
                size_t texel =
                    ((size_t)face * (size_t)cube->size + (size_t)y) * (size_t)cube->size + (size_t)x;
                for (size_t c = 0; c < 3; c++)
                    power.rgb[c] += solid_angle * (double)cube->texels[3 * texel + c];
            }
    return power;
}

/* The light that the regions' groups hold, as samples sum it. */
static struct power power_of_lights(const struct tl_region_lights *lights)
{
    struct power power = {{0}};
    for (int g = 0; g < lights->group_count; g++)
        for (int c = 0; c < 3; c++)
            for (int lane = 0; lane < TL_LANES; lane++)
                power.rgb[c] += (double)lights->groups[g].power[c][lane];
    return power;
}

static void add_power(struct power *power, vec3s more)
{
    for (int c = 0; c < 3; c++)
        power->rgb[c] += (double)more.raw[c];
}

/* Relative to the channel's own light; a channel without any must have none. */
static void add_difference(struct tl_finding *finding, const struct power *got, const struct power *expected)
{
    static const char *const channels[] = {"red", "green", "blue"};
    double all = expected->rgb[0] + expected->rgb[1] + expected->rgb[2];
    for (int c = 0; c < 3; c++) {
        double whole = fmax(expected->rgb[c], 1e-6 * all);
        double off =
            got->rgb[c] == expected->rgb[c] ? 0 : fabs(got->rgb[c] - expected->rgb[c]) / whole; // NOLINT
        if (tl_finding_add(finding, off))
            tl_finding_place(finding, "%s: %.6g of %.6g", channels[c], got->rgb[c], expected->rgb[c]);
    }
}

/* Only sampled frames are measured: an environment changes seldom, and summing it takes long. */
static bool is_time(const struct tl_checked *checked)
{
    return checked->is_sampled && has(checked, TL_MADE_CUBE) && has(checked, TL_MADE_REGIONS);
}

static bool has_lights(const struct tl_checked *checked)
{
    return is_time(checked) && has(checked, TL_MADE_LIGHTS) &&
           tl_renderer_frame_resources(checked->renderer)->lights->gain.made;
}

static bool has_slices(const struct tl_checked *checked)
{
    return is_time(checked) && has(checked, TL_MADE_SLICES) &&
           tl_renderer_frame_resources(checked->renderer)->slices.slices.made;
}

void tl_measure_environment(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!is_time(checked))
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    struct power got = power_of_cube(&inside->cube);
    for (int i = 0; i < inside->suns.count; i++)
        add_power(&got, inside->suns.items[i].power);
    struct power expected = power_of_environment(checked->frame->environment);
    add_difference(finding, &got, &expected);
}

void tl_measure_regions(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!is_time(checked))
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    struct power got = {{0}}, expected = power_of_cube(&inside->cube);
    for (int i = 0; i < inside->regions.count; i++)
        add_power(&got, inside->regions.items[i].power);
    add_difference(finding, &got, &expected);
    if (!has_lights(checked))
        return;
    struct power shone = power_of_lights(inside->lights);
    add_difference(finding, &shone, &expected);
}

/* The cube's texels with what every sum over them needs. */
struct texels {
    size_t count;
    vec3s *directions, *powers; /* radiance times solid angle */
};

static struct texels list_texels(const tl_cube *cube)
{
    size_t side = (size_t)cube->size;
    struct texels texels = {.count = 6 * side * side};
    texels.directions = TL_NEW_ARRAY(vec3s, texels.count);
    texels.powers = TL_NEW_ARRAY(vec3s, texels.count);
#pragma omp parallel for
    for (size_t i = 0; i < texels.count; i++) {
        float solid_angle = tl_cube_solid_angle(cube->size, (int)(i % side), (int)(i / side % side));
        texels.directions[i] = tl_cube_texel_direction(cube->size, (int)i);
        for (size_t c = 0; c < 3; c++)
            texels.powers[i].raw[c] = solid_angle * cube->texels[3 * i + c];
    }
    return texels;
}

static void release_texels(struct texels *texels)
{
    free(texels->directions);
    free(texels->powers);
}

static double lobe_towards(vec3s axis, vec3s direction, double exponent)
{
    double cosine = (double)glms_vec3_dot(axis, direction);
    return cosine > 0 ? (exponent + 1) / (2 * M_PI) * pow(cosine, exponent) : 0;
}

/* integral of L(w) K_s(d, w) dw, texel by texel. */
static struct power gather_lobe(const struct texels *texels, vec3s direction, double exponent)
{
    struct power sum = {{0}};
    for (size_t i = 0; i < texels->count; i++) {
        double lobe = lobe_towards(direction, texels->directions[i], exponent);
        for (int c = 0; c < 3 && lobe > 0; c++)
            sum.rgb[c] += lobe * (double)texels->powers[i].raw[c];
    }
    return sum;
}

/* A lobe with a larger exponent is narrower than a few texels of the coarsest cube in use, and a sum over
 * texels does not resolve it. */
#define EXPONENT_MAX 64.0f

/* The diffuse exponent, and the sharpest of those made that a sum over texels resolves. */
static int choose_exponents(uint32_t made, int exponents[2])
{
    int count = 0;
    for (int k = 0; k < TL_EXPONENT_COUNT && tl_exponent(k) <= EXPONENT_MAX; k++) {
        if (!(made >> k & 1))
            continue;
        exponents[count > 0 ? 1 : 0] = k;
        count = count < 2 ? count + 1 : 2;
    }
    return count;
}

/* The renderer's approximation of the integral, for one direction and one of the lobes' exponents. */
typedef vec3s estimator(const struct tl_resources *inside, vec3s direction, int exponent);

static double largest_difference(vec3s got, const struct power *expected)
{
    double largest = 0;
    for (int c = 0; c < 3; c++) {
        double difference = fabs((double)got.raw[c] - expected->rgb[c]);
        largest = difference <= largest ? largest : difference; /* a NaN is kept */
    }
    return largest;
}

static double brightest_of(const struct power *light, size_t count)
{
    double brightest = 0;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            brightest = fmax(brightest, light[i].rgb[c]);
    return brightest;
}

static void add_estimates(const struct tl_resources *inside, uint32_t made, estimator *estimate,
                          struct tl_finding *finding)
{
    int exponents[2], count = choose_exponents(made, exponents);
    struct texels texels = list_texels(&inside->cube);
    struct power light[2 * DIRECTIONS];
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count * DIRECTIONS; i++)
        light[i] =
            gather_lobe(&texels, spiral(i % DIRECTIONS), (double)tl_exponent(exponents[i / DIRECTIONS]));
    double brightest = brightest_of(light, (size_t)count * DIRECTIONS);
    for (int i = 0; i < count * DIRECTIONS; i++) {
        vec3s direction = spiral(i % DIRECTIONS);
        int exponent = exponents[i / DIRECTIONS];
        double off = largest_difference(estimate(inside, direction, exponent), &light[i]);
        if (tl_finding_add(finding, brightest > 0 ? off / brightest : off))
            tl_finding_place(finding, "s = %.3g along %.2f %.2f %.2f", (double)tl_exponent(exponent),
                             (double)direction.x, (double)direction.y, (double)direction.z);
    }
    release_texels(&texels);
}

static struct tl_exponent_blend only(int exponent)
{
    return (struct tl_exponent_blend){.index = exponent};
}

static vec3s fetch_exact(const struct tl_resources *inside, vec3s direction, int exponent)
{
    return tl_lobes_fetch(inside->exact.lobes, direction, only(exponent));
}

void tl_measure_exact(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (is_time(checked) && has(checked, TL_MADE_LOBES) &&
        tl_renderer_frame_resources(checked->renderer)->exact.lobes->made)
        add_estimates(tl_renderer_frame_resources(checked->renderer),
                      tl_renderer_frame_resources(checked->renderer)->exact.lobes->made, fetch_exact,
                      finding);
}

/* The sum that every sample makes when it sees all regions (light/region_lights.h). */
static vec3s sum_lights(const struct tl_resources *inside, vec3s direction, int exponent)
{
    const struct tl_region_lights *lights = inside->lights;
    double sum[3] = {0};
    for (int g = 0; g < lights->group_count; g++)
        for (int lane = 0; lane < TL_LANES; lane++) {
            const struct tl_region_group *group = &lights->groups[g];
            float cosine =
                group->x[lane] * direction.x + group->y[lane] * direction.y + group->z[lane] * direction.z;
            float broad = lobe_broadened_exponent(tl_exponent(exponent), group->spread[lane]);
            float sine = group->sine[lane], inverse = group->inverse_sine[lane];
            float lobe = exponent == 0 ? region_lobe_diffuse(cosine, sine, inverse)
                                       : region_lobe(cosine, sine, inverse, broad);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)(lobe * group->power[c][lane]);
        }
    vec3s gain =
        tl_lobes_fetch(exponent == 0 ? &lights->diffuse_gain : &lights->gain, direction, only(exponent));
    return (vec3s){{gain.x * (float)sum[0], gain.y * (float)sum[1], gain.z * (float)sum[2]}};
}

static vec3s sum_slices(const struct tl_resources *inside, vec3s direction, int exponent)
{
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < inside->slices.slices.region_count; i++)
        sum = glms_vec3_add(sum, tl_slices_fetch(&inside->slices.slices, i, direction, only(exponent)));
    return sum;
}

void tl_measure_sum(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    if (has_lights(checked))
        add_estimates(inside, inside->lights->gain.made, sum_lights, finding);
    if (has_slices(checked))
        add_estimates(inside, inside->slices.slices.made, sum_slices, finding);
}

/* P_i along the region's own direction, from the texels that bear its label. New array by region. */
static struct power *gather_regions(const struct tl_resources *inside, double exponent)
{
    const struct tl_regions *regions = &inside->regions;
    struct power *light = TL_NEW_ARRAY(struct power, (size_t)regions->count);
    struct texels texels = list_texels(&inside->cube);
    for (size_t i = 0; i < texels.count; i++) {
        int region = regions->labels[i];
        double lobe = lobe_towards(regions->items[region].direction, texels.directions[i], exponent);
        for (int c = 0; c < 3; c++)
            light[region].rgb[c] += lobe * (double)texels.powers[i].raw[c];
    }
    release_texels(&texels);
    return light;
}

void tl_measure_slices(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!has_slices(checked))
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    struct power *light = gather_regions(inside, (double)tl_exponent(0));
    for (int i = 0; i < inside->regions.count; i++) {
        vec3s got = tl_slices_fetch(&inside->slices.slices, i, inside->regions.items[i].direction, only(0));
        double own = brightest_of(&light[i], 1), off = largest_difference(got, &light[i]);
        if (tl_finding_add(finding, own > 0 ? off / own : off))
            tl_finding_place(finding, "region %d of %d", i, inside->regions.count);
    }
    free(light);
}

/* A level of the undivided cube, as it is stored: paraboloid maps are fetched at the centres of its texels.
 */
static tl_cube whole_level(const struct tl_pems *pems, const struct tl_chain *whole, int level)
{
    tl_cube out = tl_cube_copy(&whole->levels[level]);
    const struct tl_paraboloid map = tl_paraboloid_place(whole);
    for (int chart = 0; chart < TL_PARABOLOID_CHARTS && pems->paraboloids; chart++) {
        float *texels = tl_paraboloid_sample(&map, whole, level, chart);
        if (texels)
            tl_paraboloid_resample(&map.crops[level][chart], tl_paraboloid_density(pems->size, level), texels,
                                   chart, &out);
        free(texels);
    }
    return out;
}

/* Compares the sum of all PEMs at one level with that level of the undivided cube. They are equal, as filters
 * and sampling are linear. */
static void add_pem_level(const struct tl_resources *inside, const struct tl_chain *whole, int level,
                          struct tl_finding *finding)
{
    tl_cube expected = whole_level(&inside->pems, whole, level);
    size_t values = 18 * (size_t)expected.size * (size_t)expected.size;
    double *sums = TL_NEW_ARRAY(double, values), mean = 0;
    for (int i = 0; i < inside->pems.count; i++) {
        tl_cube pem = tl_pems_read(&inside->pems, i, level);
        for (size_t v = 0; v < values; v++)
            sums[v] += (double)pem.texels[v];
        tl_cube_release(&pem);
    }
    for (size_t v = 0; v < values; v++)
        mean += (double)expected.texels[v] / (double)values;
    for (size_t v = 0; v < values; v++) {
        double off = fabs(sums[v] - (double)expected.texels[v]);
        if (tl_finding_add(finding, off > 0 ? off / ((double)expected.texels[v] + mean) : off))
            tl_finding_place(finding, "level %d, texel %zu of %zu", level, v / 3, values / 3);
    }
    tl_cube_release(&expected);
    free(sums);
}

void tl_measure_pems(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!is_time(checked) || !has(checked, TL_MADE_PEMS) ||
        tl_renderer_frame_resources(checked->renderer)->pems.count == 0)
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    struct tl_chain whole =
        tl_chain_build(&inside->cube, (enum tl_chain_filter)inside->filter_options.filter);
    if (whole.level_count >
        1) /* the first level is cut, not filtered, and takes four times as long to read */
        add_pem_level(inside, &whole, 1, finding);
    add_pem_level(inside, &whole, whole.level_count - 1, finding);
    tl_chain_release(&whole);
}
