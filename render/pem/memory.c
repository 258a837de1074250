#include "render/pem/memory.h"

#include "config/base/memory.h"
#include "render/pem/paraboloids.h"

#include <stdlib.h>

#define RGBA16F_BYTES 8

const int tl_paper_pem_sizes[TL_PAPER_PEMS] = {128, 256};
const int tl_paper_map_sizes[TL_PAPER_MAPS] = {64, 128, 256, 512, 1024};
const struct tl_paper_memory tl_paper_memory[TL_PAPER_ROWS] = {
    {1, {1.5, 6}, {0.015625, 0.0625, 0.25, 1, 4}}, {12, {18, 72}, {0.1875, 0.75, 3, 12, 48}},
    {32, {48, 192}, {0.5, 2, 8, 32, 128}},         {64, {96, 384}, {1, 4, 16, 64, 256}},
    {128, {192, 768}, {2, 8, 32, 128, 512}},       {256, {384, 1536}, {4, 16, 64, 256, 1024}},
};

/* Texels of a square and of all of its mip levels. */
static size_t chain_texels(int side)
{
    size_t texels = 0;
    for (; side > 0; side /= 2)
        texels += (size_t)side * (size_t)side;
    return texels;
}

size_t tl_memory_cubes(int regions, int size)
{
    return (size_t)regions * 6 * (size_t)size * (size_t)size * RGBA16F_BYTES;
}

size_t tl_memory_chains(int regions, int size)
{
    return (size_t)regions * 6 * chain_texels(size) * RGBA16F_BYTES;
}

size_t tl_memory_shadow_maps(int regions, int size, size_t texel_bytes)
{
    return (size_t)regions * (size_t)size * (size_t)size * texel_bytes;
}

size_t tl_memory_paraboloids(const tl_cube *cube, const struct tl_regions *regions,
                             enum tl_chain_filter filter, int per_array)
{
    struct tl_paraboloid *maps = TL_NEW_ARRAY(struct tl_paraboloid, (size_t)regions->count);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < regions->count; i++) {
        tl_cube cut = tl_pem_cut(cube, regions, i);
        struct tl_chain chain = tl_chain_build(&cut, filter);
        maps[i] = tl_paraboloid_place(&chain);
        tl_chain_release(&chain);
        tl_cube_release(&cut);
    }
    size_t texels = 0;
    for (int first = 0; first < regions->count; first += per_array) {
        int left = regions->count - first, width, height;
        tl_paraboloids_pack(&maps[first], left < per_array ? left : per_array, &width, &height);
        texels += (size_t)width * (size_t)height;
    }
    free(maps);
    return texels * RGBA16F_BYTES;
}
