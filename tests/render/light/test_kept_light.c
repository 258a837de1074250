/* Cubes of environments, and gains of regions' lights, come from the cache as they are made. Oracle: the same
 * without a cache, to the bit, of lights that differ in one texel or in the number of regions. */
#include "tests/testing.h"

#include "config/base/hash.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"
#include "render/env/from_environment.h"
#include "render/light/region_lights.h"

#include <string.h>

#define FOLDER TOILE_SCRATCH_DIR "/kept_light"

enum { CUBE, GAIN, DIFFUSE_GAIN, TWICE, COUNT, WIDTH = 64, SIZE = 16 };

static uint64_t hash_lobes(const struct tl_lobes *lobes)
{
    uint64_t hash = tl_hash(TL_HASH_START, &lobes->made, sizeof lobes->made);
    for (size_t i = 0; i < TL_COUNT(lobes->maps); i++) {
        size_t side = lobes->maps[i].side > 0 ? (size_t)lobes->maps[i].side + 2 : 0;
        hash = tl_hash_words(hash, lobes->maps[i].texels, 4 * side * side * sizeof(float));
    }
    return hash;
}

static void make_light(float brightest, int regions, uint64_t hashes[COUNT])
{
    tl_environment environment = {.layout = TL_ENV_LATLONG,
                                  .image = tl_image_create(WIDTH, WIDTH / 2, 3, TL_IMAGE_F32)};
    float *texels = tl_image_floats(&environment.image);
    for (size_t i = 0; i < (size_t)3 * WIDTH * WIDTH / 2; i++)
        texels[i] = 0.1f + (float)(i * 2654435761u % 1000) / 1000;
    texels[(size_t)3 * (10 * WIDTH + 20)] = brightest;
    tl_cube cube = tl_cube_from_environment(&environment, SIZE);
    struct tl_regions cut = {0};
    struct tl_lobes lobes = {0};
    struct tl_region_lights lights = {0};
    tl_regions_cut_sphere(&cube, regions, &cut);
    tl_lobes_make(&lobes, &cube, 1u << 0 | 1u << 6);
    tl_region_lights_begin(&lights, &cut, TL_WEIGHT_POWER);
    tl_region_lights_add(&lights, &lobes, ~0u);
    hashes[CUBE] = tl_hash_words(TL_HASH_START, cube.texels, (size_t)18 * SIZE * SIZE * sizeof(float));
    hashes[GAIN] = hash_lobes(&lights.gain);
    hashes[DIFFUSE_GAIN] = hash_lobes(&lights.diffuse_gain);
    /* The same regions for other light. */
    for (size_t i = 0, side = (size_t)lobes.maps[6].side + 2; i < 4 * side * side; i++)
        lobes.maps[6].texels[i] *= 2;
    tl_region_lights_begin(&lights, &cut, TL_WEIGHT_POWER);
    tl_region_lights_add(&lights, &lobes, ~0u);
    hashes[TWICE] = hash_lobes(&lights.gain);
    tl_region_lights_release(&lights);
    tl_lobes_release(&lobes);
    tl_regions_release(&cut);
    tl_cube_release(&cube);
    tl_environment_release(&environment);
}

static void make_all(uint64_t hashes[3][COUNT])
{
    make_light(50, 24, hashes[0]);
    make_light(51, 24, hashes[1]);
    make_light(50, 48, hashes[2]);
}

static void kept_light_is_made_light(void **state)
{
    (void)state;
    uint64_t plain[3][COUNT], first[3][COUNT], second[3][COUNT];
    size_t files, more;
    make_all(plain);
    tl_cache_use(FOLDER, 1 << 26);
    tl_cache_clear(FOLDER);
    make_all(first);
    free(tl_cache_list(FOLDER, &files));
    make_all(second);
    free(tl_cache_list(FOLDER, &more));
    /* Two cubes, two lobes of each; of each of three lights two gains, one of them twice, and a diffuse one.
     */
    assert_int_equal(files, 2 + 2 * 2 + 3 * 4);
    assert_int_equal(more, files);
    assert_memory_equal(plain, first, sizeof plain);
    assert_memory_equal(plain, second, sizeof plain);
    assert_true(plain[0][CUBE] != plain[1][CUBE] && plain[0][CUBE] == plain[2][CUBE]);
    assert_true(plain[0][GAIN] != plain[1][GAIN] && plain[0][GAIN] != plain[2][GAIN]);
    assert_true(plain[0][DIFFUSE_GAIN] != plain[2][DIFFUSE_GAIN]);
    assert_true(plain[0][TWICE] != plain[0][GAIN]);
    tl_cache_clear(FOLDER);
    tl_cache_use(NULL, 0);
    rmdir(FOLDER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(kept_light_is_made_light)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
