#include "render/pem/pems.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

#define BATCH 8 /* chains in memory at a time; each takes about 1.6 MB at 128 texels */

/* The same numbers as in paraboloids.glsl. */
#define MAPS_UNIT           11
#define PARABOLOIDS_BINDING 2

/* struct Paraboloid of paraboloids.glsl, std430. */
struct gpu_paraboloid {
    float bounds[TL_PARABOLOID_CHARTS][4], shifts[TL_PARABOLOID_CHARTS][2];
};

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

static void free_arrays(struct tl_pems *pems)
{
    for (int i = 0; i < pems->array_count; i++)
        tl_texture_destroy(&pems->arrays[i]);
    free(pems->arrays);
    free(pems->paraboloids);
    if (pems->buffer)
        glDeleteBuffers(1, &pems->buffer);
    *pems = (struct tl_pems){0};
}

static int regions_in(const struct tl_pems *pems, int array)
{
    int left = pems->count - array * pems->per_array;
    return left < pems->per_array ? left : pems->per_array;
}

/* Cubes of the same size and number stay where they are. Paraboloid maps get their textures when their crops
 * are known. */
static void allocate(struct tl_pems *pems, tl_gpu *gpu, int count, int size, struct tl_pem_storage storage)
{
    bool cubes = storage.layout == TL_PEM_CUBE;
    if (cubes && !pems->paraboloids && pems->count == count && pems->per_array == storage.per_array &&
        pems->size == size)
        return;
    free_arrays(pems);
    pems->count = count;
    pems->size = size;
    pems->per_array = storage.per_array;
    pems->array_count = (count + storage.per_array - 1) / storage.per_array;
    pems->arrays = TL_NEW_ARRAY(tl_texture, (size_t)pems->array_count);
    if (!cubes)
        pems->paraboloids = TL_NEW_ARRAY(struct tl_paraboloid, (size_t)count);
    for (int i = 0; i < pems->array_count && cubes; i++)
        pems->arrays[i] = tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA16F, size, size,
                                            6 * regions_in(pems, i), tl_texture_full_levels(size, size));
}

static void upload_cubes(const struct tl_pems *pems, int index, const struct tl_chain *chain)
{
    for (int level = 0; level < chain->level_count; level++) {
        int side = chain->levels[level].size;
        glTextureSubImage3D(pems->arrays[index / pems->per_array].id, level, 0, 0,
                            6 * (index % pems->per_array), side, side, 6, GL_RGB, GL_FLOAT,
                            chain->levels[level].texels);
    }
}

/* The samples of one region's paraboloid maps; NULL: black. */
struct sampled_maps {
    float *texels[TL_PARABOLOID_LEVELS_MAX][TL_PARABOLOID_CHARTS];
};

/* Places the samples of the regions of one array in a texture, and releases them. */
static void upload_maps(struct tl_pems *pems, tl_gpu *gpu, int array, struct sampled_maps *sampled)
{
    struct tl_paraboloid *maps = &pems->paraboloids[array * pems->per_array];
    int count = regions_in(pems, array), width, height;
    tl_paraboloids_pack(maps, count, &width, &height);
    pems->arrays[array] = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA16F, width, height, 1, 1);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < maps[i].level_count * TL_PARABOLOID_CHARTS; k++) {
            int level = k / TL_PARABOLOID_CHARTS, chart = k % TL_PARABOLOID_CHARTS;
            const struct tl_paraboloid_crop *crop = &maps[i].crops[level][chart];
            float **texels = &sampled[i].texels[level][chart];
            if (*texels)
                glTextureSubImage2D(pems->arrays[array].id, 0, crop->atlas_x, crop->atlas_y, crop->width,
                                    crop->height, GL_RGB, GL_FLOAT, *texels);
            free(*texels);
            *texels = NULL;
        }
}

/* A black region has bounds that nothing lies within. */
static struct gpu_paraboloid gpu_paraboloid_of(const struct tl_paraboloid_crop crops[TL_PARABOLOID_CHARTS])
{
    struct gpu_paraboloid out;
    for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++) {
        const struct tl_paraboloid_crop *crop = &crops[chart];
        float x = (float)crop->atlas_x + 0.5f, y = (float)crop->atlas_y + 0.5f;
        out.shifts[chart][0] = (float)(crop->atlas_x - crop->x0);
        out.shifts[chart][1] = (float)(crop->atlas_y - crop->y0);
        out.bounds[chart][0] = x;
        out.bounds[chart][1] = y;
        out.bounds[chart][2] = x + (float)(crop->width - 1);
        out.bounds[chart][3] = y + (float)(crop->height - 1);
    }
    return out;
}

static void upload_places(struct tl_pems *pems)
{
    size_t count = (size_t)pems->count * TL_PARABOLOID_LEVELS_MAX;
    struct gpu_paraboloid *places = TL_NEW_ARRAY(struct gpu_paraboloid, count);
    for (size_t i = 0; i < count; i++)
        places[i] = gpu_paraboloid_of(
            pems->paraboloids[i / TL_PARABOLOID_LEVELS_MAX].crops[i % TL_PARABOLOID_LEVELS_MAX]);
    if (!pems->buffer)
        glCreateBuffers(1, &pems->buffer);
    glNamedBufferData(pems->buffer, (GLsizeiptr)(count * sizeof *places), places, GL_STATIC_DRAW);
    free(places);
}

/* Builds the chains of up to BATCH regions from `first` on, and uploads their cubes or samples their maps. */
static void build_batch(struct tl_pems *pems, const tl_cube *cube, const struct tl_regions *regions,
                        enum tl_chain_filter filter, int first, int count, struct sampled_maps *sampled)
{
    struct tl_chain chains[BATCH];
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; i++) {
        tl_cube cut = tl_pem_cut(cube, regions, first + i);
        chains[i] = tl_chain_build(&cut, filter);
        scale_chain(&chains[i], 1 / pems->scale);
        tl_cube_release(&cut);
        if (!pems->paraboloids)
            continue;
        struct tl_paraboloid *map = &pems->paraboloids[first + i];
        *map = tl_paraboloid_place(&chains[i]);
        for (int level = 0; level < map->level_count; level++)
            for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++)
                sampled[i].texels[level][chart] = tl_paraboloid_sample(map, &chains[i], level, chart);
    }
    for (int i = 0; i < count; i++) {
        if (!pems->paraboloids)
            upload_cubes(pems, first + i, &chains[i]);
        tl_chain_release(&chains[i]);
    }
}

void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, struct tl_pem_storage storage)
{
    allocate(pems, gpu, regions->count, cube->size, storage);
    pems->scale = storage_scale(cube);
    struct sampled_maps *sampled = TL_NEW_ARRAY(struct sampled_maps, (size_t)pems->per_array);
    for (int array = 0; array < pems->array_count; array++) {
        int begin = array * pems->per_array, count = regions_in(pems, array);
        for (int done = 0; done < count; done += BATCH)
            build_batch(pems, cube, regions, (enum tl_chain_filter)filter, begin + done,
                        count - done < BATCH ? count - done : BATCH, sampled + done);
        if (pems->paraboloids)
            upload_maps(pems, gpu, array, sampled);
    }
    free(sampled);
    if (pems->paraboloids)
        upload_places(pems);
}

void tl_pems_bind(const struct tl_pems *pems, int array, unsigned unit)
{
    glBindTextureUnit(pems->paraboloids ? MAPS_UNIT : unit, pems->arrays[array].id);
    if (pems->paraboloids)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PARABOLOIDS_BINDING, pems->buffer);
}

void tl_pems_release(struct tl_pems *pems)
{
    free_arrays(pems);
}

size_t tl_pems_bytes(const struct tl_pems *pems)
{
    size_t bytes = 0;
    for (int i = 0; i < pems->array_count; i++)
        bytes += tl_texture_bytes(&pems->arrays[i]);
    return bytes;
}

/* Fills the texels of a cube that lie in a chart. */
static void read_chart(const struct tl_pems *pems, int index, int level, int chart, const tl_cube *cube)
{
    const struct tl_paraboloid_crop *crop = &pems->paraboloids[index].crops[level][chart];
    if (crop->width == 0)
        return;
    size_t values = 3 * (size_t)crop->width * (size_t)crop->height;
    float *texels = TL_NEW_ARRAY(float, values);
    glGetTextureSubImage(pems->arrays[index / pems->per_array].id, 0, crop->atlas_x, crop->atlas_y, 0,
                         crop->width, crop->height, 1, GL_RGB, GL_FLOAT, (GLsizei)(values * sizeof(float)),
                         texels);
    tl_paraboloid_resample(crop, tl_paraboloid_density(pems->size, level), texels, chart, cube);
    free(texels);
}

tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level)
{
    tl_cube cube = tl_cube_create(pems->size >> level);
    size_t values = 18 * (size_t)cube.size * (size_t)cube.size;
    for (int chart = 0; chart < TL_PARABOLOID_CHARTS && pems->paraboloids; chart++)
        read_chart(pems, index, level, chart, &cube);
    if (!pems->paraboloids)
        glGetTextureSubImage(pems->arrays[index / pems->per_array].id, level, 0, 0,
                             6 * (index % pems->per_array), cube.size, cube.size, 6, GL_RGB, GL_FLOAT,
                             (GLsizei)(values * sizeof(float)), cube.texels);
    for (size_t i = 0; i < values; i++)
        cube.texels[i] *= pems->scale;
    return cube;
}
