/* Cropped paraboloid maps against angles measured on the sphere, and against the cubes that they are sampled
 * from. */
#include "render/pem/paraboloids.h"

#include "config/memory.h"

#include "tests/testing.h"

#include <stdlib.h>

#define SIZE   64
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
    int levels;
    struct tl_chain chains[TL_REGIONS_MAX];
    struct tl_paraboloid maps[TL_REGIONS_MAX];
    float *texels[TL_REGIONS_MAX][TL_PARABOLOID_LEVELS_MAX];
};

static struct maps *make_maps(const tl_cube *cube)
{
    struct maps *all = TL_NEW(struct maps);
    all->levels = tl_paraboloid_levels(cube, &regions);
    for (int i = 0; i < regions.count; i++) {
        tl_cube pem = tl_pem_cut(cube, &regions, i);
        all->chains[i] = tl_chain_build(&pem, TL_CHAIN_SQRT_COSINE);
        all->maps[i] = tl_paraboloid_place(&regions.items[i], &all->chains[i], all->levels);
        for (int level = 0; level < all->levels; level++)
            all->texels[i][level] = tl_paraboloid_sample(&all->maps[i], &all->chains[i], level);
        tl_cube_release(&pem);
    }
    return all;
}

static void release_maps(struct maps *all)
{
    for (int i = 0; i < regions.count; i++) {
        tl_chain_release(&all->chains[i]);
        for (int level = 0; level < all->levels; level++)
            free(all->texels[i][level]);
    }
    free(all);
}

/* A cap of half-angle 30 degrees on a cube of 64: at level 0 it is 2 x 2 x 64 tan(15 degrees) = 68.6 texels
 * wide, and its hats, the black texels around them and rounding add 2 x 2, 2, and up to 2. */
static void a_crop_fits_its_region(void **state)
{
    (void)state;
    tl_cube even = make_cube(true), cap = tl_cube_create(SIZE);
    tl_regions_cut_sphere(&even, 1, &regions);
    for (int i = 0; i < 6 * SIZE * SIZE; i++)
        if (tl_cube_texel_direction(SIZE, i).z > cosf((float)M_PI / 6))
            cap.texels[3 * (size_t)i] = 1;
    struct tl_region region = {.face = -1, .direction = {{0, 0, 1}}};
    struct tl_chain chain = tl_chain_build(&cap, TL_CHAIN_NONE);
    struct tl_paraboloid map = tl_paraboloid_place(&region, &chain, 1);
    const struct tl_paraboloid_crop *crop = &map.crops[0];
    printf("cap of 30 degrees: %d x %d texels\n", crop->width, crop->height);
    assert_true(crop->width >= 69 && crop->width <= 77);
    assert_true(crop->height >= 69 && crop->height <= 77);
    assert_int_equal(crop->x0, 1 - crop->x0 - crop->width - 1);
    tl_chain_release(&chain);
    tl_cube_release(&cap);
    tl_cube_release(&even);
    tl_regions_release(&regions);
}

/* Where a filtered region has light, its maps have it, too: a crop that is too small loses the edge of a
 * lobe. And along the direction of a texel's centre the fetch is the cube's. Regions on edges and corners of
 * the cube are among them. */
static void nothing_is_cropped_away(bool by_faces, int count)
{
    tl_cube cube = make_cube(false);
    if (by_faces)
        tl_regions_cut(&cube, count, &regions);
    else
        tl_regions_cut_sphere(&cube, count, &regions);
    struct maps *all = make_maps(&cube);
    assert_true(all->levels >= 2);
    int lit = 0;
    double lost = 0, worst = 0;
    for (int i = 0; i < regions.count; i++) {
        const struct tl_paraboloid *map = &all->maps[i];
        for (int level = 0; level < all->levels; level++) {
            float density = tl_paraboloid_density(SIZE, level);
            const struct tl_paraboloid_crop *crop = &map->crops[level];
            assert_near(density, 2 * (SIZE >> level), 0);
            for (int k = 0; k < PROBES; k++) {
                vec3s d = probe(k), light = tl_cube_sample(&all->chains[i].levels[level], d);
                float angle = acosf(fminf(fmaxf(glms_vec3_dot(d, map->direction), -1), 1));
                vec3s across =
                    glms_vec3_sub(d, glms_vec3_scale(map->direction, glms_vec3_dot(d, map->direction)));
                float length = fmaxf(glms_vec3_norm(across), 1e-9f), radius = tanf(angle / 2) * density;
                float x = radius * glms_vec3_dot(across, map->right) / length - (float)crop->x0;
                float y = radius * glms_vec3_dot(across, map->up) / length - (float)crop->y0;
                bool inside = crop->width > 0 && x > 0.5f && y > 0.5f && x < (float)crop->width - 0.5f &&
                              y < (float)crop->height - 0.5f;
                if (!inside)
                    lost = fmax(lost, (double)light.x);
                lit += light.x > 0;
                if (!inside || level == 0)
                    continue;
                vec3s got = tl_paraboloid_fetch(map, level, density, all->texels[i][level], d);
                worst = fmax(worst, fabs((double)(got.x - light.x)));
            }
        }
    }
    printf("%d levels, %d lit fetches, %.2g outside of crops, filtered levels differ by %.3f at most\n",
           all->levels, lit, lost, worst);
    assert_true(lit > PROBES);
    assert_near(lost, 0, 1e-6);
    assert_true(worst < 0.05);
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

/* Regions of one face share the lattice, so that white regions add up to white wherever maps of one face
 * alone reach: on a face, further from its edges than the filters do. Elsewhere two or three lattices meet.
 */
static void white_stays_white(void **state)
{
    (void)state;
    tl_cube cube = make_cube(true);
    tl_regions_cut(&cube, 96, &regions);
    struct maps *all = make_maps(&cube);
    for (int level = 0; level < all->levels; level++) {
        float density = tl_paraboloid_density(SIZE, level), margin = 6.0f / (float)(SIZE >> level);
        double worst = 0, inner = 0, squares = 0;
        int inner_count = 0;
        for (int k = 0; k < PROBES; k++) {
            vec3s d = probe(k);
            double sum = 0;
            for (int i = 0; i < regions.count; i++)
                if (all->texels[i][level])
                    sum +=
                        (double)tl_paraboloid_fetch(&all->maps[i], level, density, all->texels[i][level], d)
                            .x;
            int face;
            float s, t;
            tl_cube_locate(d, &face, &s, &t);
            bool is_inner = s > margin && t > margin && s < 1 - margin && t < 1 - margin;
            worst = fmax(worst, fabs(sum - 1));
            squares += (sum - 1) * (sum - 1);
            inner = is_inner ? fmax(inner, fabs(sum - 1)) : inner;
            inner_count += is_inner;
        }
        printf("level %d: off by %.2g within faces (%d probes), by %.3f anywhere, by %.4f root mean square\n",
               level, inner, inner_count, worst, sqrt(squares / PROBES));
        assert_near(inner, 0, 1e-5);
        /* Level 0 is cut and not filtered: at an edge of the cube a step meets another lattice. */
        assert_true(worst < (level == 0 ? 0.25 : 0.05));
        assert_true(sqrt(squares / PROBES) < (level == 0 ? 0.02 : 0.006));
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

static void packed_crops_lie_apart(void **state)
{
    (void)state;
    tl_cube cube = make_cube(false);
    tl_regions_cut(&cube, 96, &regions);
    struct maps *all = make_maps(&cube);
    all->maps[3].crops[1].width = all->maps[3].crops[1].height = 0; /* black */
    int width, height, used = 0;
    tl_paraboloids_pack(all->maps, 12, all->levels, &width, &height);
    for (int i = 0; i < 12 * all->levels; i++) {
        const struct tl_paraboloid_crop *crop = &all->maps[i / all->levels].crops[i % all->levels];
        used += crop->width * crop->height;
        assert_true(crop->atlas_x >= 0 && crop->atlas_x + crop->width <= width);
        assert_true(crop->atlas_y >= 0 && crop->atlas_y + crop->height <= height);
        for (int k = 0; k < i; k++)
            assert_false(overlap(crop, &all->maps[k / all->levels].crops[k % all->levels]));
    }
    printf("%d texels in %d x %d\n", used, width, height);
    assert_true(used <= width * height && used > 0.8 * width * height);
    struct tl_paraboloid black = {0};
    tl_paraboloids_pack(&black, 1, 3, &width, &height);
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
