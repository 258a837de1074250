/* Cropped paraboloid maps against angles measured on the sphere, and against the cubes that they are sampled
 * from. */
#include "render/pem/paraboloids.h"

#include "config/base/memory.h"
#include "render/pem/regions.h"

#include "tests/testing.h"

#include <stdlib.h>

#define SIZE   64
#define LEVELS 7
#define PROBES 4000

static vec3s probe(int i)
{
    float y = 1 - 2 * ((float)i + 0.5f) / PROBES, phi = (float)i * 2.39996323f, radius = sqrtf(1 - y * y);
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

static tl_cube make_cube(bool even)
{
    tl_cube cube = tl_cube_create(SIZE);
    for (uint32_t i = 0; i < 18 * SIZE * SIZE; i++)
        cube.texels[i] = even ? 1 : (float)(((i + 1) * 2654435761u) >> 20) / 4096;
    return cube;
}

static struct tl_regions regions;

struct maps {
    struct tl_chain chains[TL_REGIONS_MAX];
    struct tl_paraboloid maps[TL_REGIONS_MAX];
    float *texels[TL_REGIONS_MAX][TL_PARABOLOID_LEVELS_MAX][TL_PARABOLOID_CHARTS];
};

static struct maps *make_maps(const tl_cube *cube)
{
    struct maps *all = TL_NEW(struct maps);
    for (int i = 0; i < regions.count; i++) {
        tl_cube pem = tl_pem_cut(cube, &regions, i);
        all->chains[i] = tl_chain_build(&pem, TL_CHAIN_SQRT_COSINE);
        all->maps[i] = tl_paraboloid_place(&all->chains[i]);
        assert_int_equal(all->maps[i].level_count, LEVELS);
        for (int level = 0; level < LEVELS; level++)
            for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++)
                all->texels[i][level][chart] =
                    tl_paraboloid_sample(&all->maps[i], &all->chains[i], level, chart);
        tl_cube_release(&pem);
    }
    return all;
}

static void release_maps(struct maps *all)
{
    for (int i = 0; i < regions.count; i++) {
        tl_chain_release(&all->chains[i]);
        for (int k = 0; k < LEVELS * TL_PARABOLOID_CHARTS; k++)
            free(all->texels[i][k / TL_PARABOLOID_CHARTS][k % TL_PARABOLOID_CHARTS]);
    }
    free(all);
}

/* Lit texels within an angle of a direction. */
static struct tl_paraboloid map_of_cap(vec3s axis, float angle_deg)
{
    tl_cube cap = tl_cube_create(SIZE);
    for (int i = 0; i < 6 * SIZE * SIZE; i++)
        if (glms_vec3_dot(tl_cube_texel_direction(SIZE, i), axis) > cosf(glm_rad(angle_deg)))
            cap.texels[3 * (size_t)i] = 1;
    struct tl_chain chain = tl_chain_build(&cap, TL_CHAIN_NONE);
    struct tl_paraboloid map = tl_paraboloid_place(&chain);
    tl_chain_release(&chain);
    tl_cube_release(&cap);
    return map;
}

/* A cap of half-angle 30 degrees about an axis: at level 0 it is 2 x 2 x 64 tan(15 degrees) = 68.6 texels
 * wide, and its hats, the black texels around them and rounding add 2 x 2, 2, and up to 2. About an edge of
 * the cube, (1, 0, 1), half of one of 20 degrees lies in either chart: from tan(12.5 degrees) to the border,
 * tan(22.5 degrees), 24.6 texels, on one axis, and over 2 x 2 x 64 sin(20 degrees) / (1 + cos(45 degrees))
 * = 51.3 on the other. */
static void a_crop_fits_its_region(void **state)
{
    (void)state;
    for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++) {
        vec3s axis = {{0, 0, 0}};
        axis.raw[chart / 2] = chart % 2 ? -1 : 1;
        struct tl_paraboloid map = map_of_cap(axis, 30);
        for (int other = 0; other < TL_PARABOLOID_CHARTS; other++) {
            const struct tl_paraboloid_crop *crop = &map.crops[0][other];
            if (other != chart) {
                assert_int_equal(crop->width, 0);
                continue;
            }
            assert_true(crop->width >= 69 && crop->width <= 77);
            assert_true(crop->height >= 69 && crop->height <= 77);
            assert_int_equal(crop->x0 + crop->x0 + crop->width, 0); /* about the middle */
            assert_int_equal(crop->y0 + crop->y0 + crop->height, 0);
        }
    }
    struct tl_paraboloid map = map_of_cap(glms_vec3_normalize((vec3s){{1, 0, 1}}), 20);
    const struct tl_paraboloid_crop *x = &map.crops[0][0], *z = &map.crops[0][4];
    printf("cap at an edge: %d x %d and %d x %d texels\n", x->width, x->height, z->width, z->height);
    assert_true(x->height >= 25 && x->height <= 31 && x->width >= 52 && x->width <= 60);
    assert_true(z->width == x->height && z->height == x->width);
    /* Up to the first centre beyond the border, which lies at 53.02 texels. */
    assert_int_equal(x->y0 + x->height, 54);
    assert_int_equal(z->x0 + z->width, 54);
    for (int chart = 1; chart < TL_PARABOLOID_CHARTS; chart++)
        assert_true(chart == 4 || map.crops[0][chart].width == 0);
}

/* Where a filtered region has light, its maps have it, too: a crop that is too small loses the edge of a
 * lobe, and one that ends within light jumps to black. Regions on edges and corners of the cube and on the
 * rim of the charts are among them. */
static void nothing_is_cropped_away(bool by_faces, int count)
{
    tl_cube cube = make_cube(false);
    if (by_faces)
        tl_regions_cut(&cube, count, &regions);
    else
        tl_regions_cut_sphere(&cube, count, &regions);
    struct maps *all = make_maps(&cube);
    int lit = 0;
    double lost = 0, worst = 0;
    for (int i = 0; i < regions.count; i++) {
        for (int level = 0; level < LEVELS; level++) {
            int density = tl_paraboloid_density(SIZE, level);
            assert_int_equal(density, 2 * (SIZE >> level));
            double peak = 0;
            for (int k = 0; k < PROBES; k++)
                peak = fmax(peak, (double)tl_cube_sample(&all->chains[i].levels[level], probe(k)).x);
            for (int k = 0; k < PROBES; k++) {
                vec3s d = probe(k), light = tl_cube_sample(&all->chains[i].levels[level], d);
                /* By the angle from the nearest axis: p is tan(a / 2) long. */
                int axis = 0;
                for (int c = 1; c < 3; c++)
                    axis = fabsf(d.raw[c]) > fabsf(d.raw[axis]) ? c : axis;
                int chart = 2 * axis + (d.raw[axis] < 0);
                double angle = acos(fabs((double)d.raw[axis]));
                double turn = atan2((double)d.raw[axis == 2 ? 1 : 2], (double)d.raw[axis == 0 ? 1 : 0]);
                double x = tan(angle / 2) * cos(turn) * density, y = tan(angle / 2) * sin(turn) * density;
                const struct tl_paraboloid_crop *crop = &all->maps[i].crops[level][chart];
                x -= crop->x0;
                y -= crop->y0;
                bool inside = crop->width > 0 && x > 0.499 && y > 0.499 && x < crop->width - 0.499 &&
                              y < crop->height - 0.499;
                if (!inside)
                    lost = fmax(lost, (double)light.x);
                lit += light.x > 0;
                if (!inside || level == 0)
                    continue;
                float p[2];
                assert_int_equal(tl_paraboloid_project(d, p), chart);
                vec3s got = tl_paraboloid_fetch(crop, density, all->texels[i][level][chart], p);
                worst = fmax(worst, fabs((double)(got.x - light.x)) / fmax(peak, 1e-3));
            }
        }
    }
    printf("%d lit fetches, %.2g outside of crops, filtered levels differ by %.3f of their peak at most\n",
           lit, lost, worst);
    assert_true(lit > PROBES);
    assert_near(lost, 0, 1e-6);
    assert_true(worst < 0.18); /* see test_pem_layouts.c */
    release_maps(all);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static void crops_hold_all_light(void **state)
{
    (void)state;
    nothing_is_cropped_away(true, 6);
    nothing_is_cropped_away(true, 96);
    nothing_is_cropped_away(false, 24);
}

/* All regions share the lattices: the maps of all white regions add up to white. */
static void white_stays_white(void **state)
{
    (void)state;
    tl_cube cube = make_cube(true);
    tl_regions_cut(&cube, 96, &regions);
    struct maps *all = make_maps(&cube);
    for (int level = 0; level < LEVELS; level++) {
        double worst = 0;
        for (int k = 0; k < PROBES; k++) {
            float p[2];
            double sum = 0;
            int chart = tl_paraboloid_project(probe(k), p);
            for (int i = 0; i < regions.count; i++)
                if (all->texels[i][level][chart])
                    sum += (double)tl_paraboloid_fetch(&all->maps[i].crops[level][chart],
                                                       tl_paraboloid_density(SIZE, level),
                                                       all->texels[i][level][chart], p)
                               .x;
            worst = fmax(worst, fabs(sum - 1));
        }
        printf("level %d: white is off by %.2g\n", level, worst);
        assert_near(worst, 0, 1e-5);
    }
    release_maps(all);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static bool overlap(const struct tl_paraboloid_crop *a, const struct tl_paraboloid_crop *b)
{
    return a->width > 0 && b->width > 0 && a->atlas_x < b->atlas_x + b->width &&
           b->atlas_x < a->atlas_x + a->width && a->atlas_y < b->atlas_y + b->height &&
           b->atlas_y < a->atlas_y + a->height;
}

static const struct tl_paraboloid_crop *nth_crop(const struct maps *all, int i)
{
    int in_map = i % (LEVELS * TL_PARABOLOID_CHARTS);
    return &all->maps[i / (LEVELS * TL_PARABOLOID_CHARTS)]
                .crops[in_map / TL_PARABOLOID_CHARTS][in_map % TL_PARABOLOID_CHARTS];
}

static void packed_crops_lie_apart(void **state)
{
    (void)state;
    tl_cube cube = make_cube(false);
    tl_regions_cut(&cube, 96, &regions);
    struct maps *all = make_maps(&cube);
    all->maps[3].crops[1][0].width = all->maps[3].crops[1][0].height = 0; /* black */
    int width, height, used = 0;
    tl_paraboloids_pack(all->maps, 12, &width, &height);
    for (int i = 0; i < 12 * LEVELS * TL_PARABOLOID_CHARTS; i++) {
        const struct tl_paraboloid_crop *crop = nth_crop(all, i);
        if (crop->width == 0)
            continue;
        used += crop->width * crop->height;
        assert_true(crop->atlas_x >= 0 && crop->atlas_x + crop->width <= width);
        assert_true(crop->atlas_y >= 0 && crop->atlas_y + crop->height <= height);
        for (int k = 0; k < i; k++)
            assert_false(overlap(crop, nth_crop(all, k)));
    }
    printf("%d texels in %d x %d\n", used, width, height);
    assert_true(used <= width * height && used > 0.8 * width * height);
    struct tl_paraboloid black = {.level_count = 3};
    tl_paraboloids_pack(&black, 1, &width, &height);
    assert_true(width == 1 && height == 1);
    release_maps(all);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crop_fits_its_region),
        cmocka_unit_test(crops_hold_all_light),
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(packed_crops_lie_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
