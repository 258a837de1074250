#include "render/pem/pems.h"

#include "config/memory.h"
#include "render/pem/chain.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

#define BATCH 8 /* chains in memory at a time; each takes about 1.6 MB at 128 texels */

/* The smallest power of two that scales every texel into the range of half floats. */
static float storage_scale(const tl_cube *cube)
{
    float peak = 0;
    for (size_t i = 0; i < (size_t)cube->size * (size_t)cube->size * 18; i++)
        peak = fmaxf(peak, cube->texels[i]);
    int exponent = 0;
    if (peak > TL_PEM_STORED_MAX)
        frexpf(peak / TL_PEM_STORED_MAX, &exponent);
    return ldexpf(1, exponent);
}

static void scale_chain(struct tl_chain *chain, float factor)
{
    for (int level = 0; level < chain->level_count; level++) {
        size_t side = (size_t)chain->levels[level].size;
        for (size_t i = 0; i < side * side * 18; i++)
            chain->levels[level].texels[i] *= factor;
    }
}

/* `first_face` is 6 x the index of the cube in its array. A single cube map is addressed by face in the same
 * way. */
static void upload(const tl_texture *texture, int first_face, const struct tl_chain *chain)
{
    for (int level = 0; level < chain->level_count; level++) {
        int side = chain->levels[level].size;
        glTextureSubImage3D(texture->id, level, 0, 0, first_face, side, side, 6, GL_RGB, GL_FLOAT,
                            chain->levels[level].texels);
    }
}

static void allocate(struct tl_pems *pems, tl_gpu *gpu, int count, int per_array, int size)
{
    int levels = tl_texture_full_levels(size, size);
    if (pems->count == count && pems->per_array == per_array && pems->arrays[0].width == size)
        return;
    tl_pems_release(pems);
    pems->count = count;
    pems->per_array = per_array;
    pems->array_count = (count + per_array - 1) / per_array;
    pems->arrays = TL_NEW_ARRAY(tl_texture, (size_t)pems->array_count);
    for (int i = 0; i < pems->array_count; i++) {
        int cubes = i + 1 < pems->array_count ? per_array : count - i * per_array;
        pems->arrays[i] =
            tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA16F, size, size, 6 * cubes, levels);
    }
}

void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, int per_array)
{
    allocate(pems, gpu, regions->count, per_array, cube->size);
    pems->scale = storage_scale(cube);
    for (int first = 0; first < regions->count; first += BATCH) {
        struct tl_chain chains[BATCH];
        int count = regions->count - first < BATCH ? regions->count - first : BATCH;
#pragma omp parallel for schedule(dynamic)
        for (int i = 0; i < count; i++) {
            tl_cube cut = tl_pem_cut(cube, &regions->items[first + i]);
            chains[i] = tl_chain_build(&cut, (enum tl_chain_filter)filter);
            scale_chain(&chains[i], 1 / pems->scale);
            tl_cube_release(&cut);
        }
        for (int i = 0; i < count; i++) {
            int index = first + i;
            upload(&pems->arrays[index / per_array], 6 * (index % per_array), &chains[i]);
            tl_chain_release(&chains[i]);
        }
    }
}

void tl_pems_release(struct tl_pems *pems)
{
    for (int i = 0; i < pems->array_count; i++)
        tl_texture_destroy(&pems->arrays[i]);
    free(pems->arrays);
    *pems = (struct tl_pems){0};
}

size_t tl_pems_bytes(const struct tl_pems *pems)
{
    size_t bytes = 0;
    for (int i = 0; i < pems->array_count; i++)
        bytes += tl_texture_bytes(&pems->arrays[i]);
    return bytes;
}

tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level)
{
    const tl_texture *array = &pems->arrays[index / pems->per_array];
    tl_cube cube = tl_cube_create(array->width >> level);
    size_t values = 18 * (size_t)cube.size * (size_t)cube.size;
    glGetTextureSubImage(array->id, level, 0, 0, 6 * (index % pems->per_array), cube.size, cube.size, 6,
                         GL_RGB, GL_FLOAT, (GLsizei)(values * sizeof(float)), cube.texels);
    for (size_t i = 0; i < values; i++)
        cube.texels[i] *= pems->scale;
    return cube;
}
