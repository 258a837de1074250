#include "render/pem/pems.h"

#include "config/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH 8 /* chains in memory at a time; each takes about 1.6 MB at 128 texels */

/* The same numbers as in paraboloids.glsl. */
#define MAPS_UNIT           11
#define PARABOLOIDS_BINDING 2

/* struct Paraboloid of paraboloids.glsl, std430. */
struct gpu_paraboloid {
    vec4s right, up, direction;
    vec4s places[TL_PARABOLOID_LEVELS_MAX], bounds[TL_PARABOLOID_LEVELS_MAX];
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

static void allocate_cubes(struct tl_pems *pems, tl_gpu *gpu, int count, int per_array)
{
    int side = pems->size >> pems->cube_level, levels = tl_texture_full_levels(side, side);
    if (pems->count == count && pems->per_array == per_array && pems->arrays[0].width == side)
        return;
    for (int i = 0; i < pems->array_count; i++)
        tl_texture_destroy(&pems->arrays[i]);
    free(pems->arrays);
    pems->count = count;
    pems->per_array = per_array;
    pems->array_count = (count + per_array - 1) / per_array;
    pems->arrays = TL_NEW_ARRAY(tl_texture, (size_t)pems->array_count);
    for (int i = 0; i < pems->array_count; i++) {
        int cubes = i + 1 < pems->array_count ? per_array : count - i * per_array;
        pems->arrays[i] =
            tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP_ARRAY, GL_RGBA16F, side, side, 6 * cubes, levels);
    }
}

static void release_paraboloids(struct tl_pems *pems)
{
    for (int i = 0; i < pems->array_count && pems->maps; i++)
        tl_texture_destroy(&pems->maps[i]);
    free(pems->maps);
    free(pems->paraboloids);
    if (pems->buffer)
        glDeleteBuffers(1, &pems->buffer);
    pems->maps = NULL;
    pems->paraboloids = NULL;
    pems->buffer = 0;
}

/* The samples of one region's paraboloid maps; NULL: black. */
struct sampled {
    float *levels[TL_PARABOLOID_LEVELS_MAX];
};

static void upload_cubes(const struct tl_pems *pems, int index, const struct tl_chain *chain)
{
    const tl_texture *array = &pems->arrays[index / pems->per_array];
    int first_face = 6 * (index % pems->per_array);
    for (int level = pems->cube_level; level < chain->level_count; level++) {
        int side = chain->levels[level].size;
        glTextureSubImage3D(array->id, level - pems->cube_level, 0, 0, first_face, side, side, 6, GL_RGB,
                            GL_FLOAT, chain->levels[level].texels);
    }
}

/* Places the samples of the regions of one array in a texture, and releases them. */
static void upload_maps(struct tl_pems *pems, tl_gpu *gpu, int array, struct sampled *sampled)
{
    int first = array * pems->per_array, left = pems->count - first;
    int count = left < pems->per_array ? left : pems->per_array, width, height;
    tl_paraboloids_pack(&pems->paraboloids[first], count, pems->cube_level, &width, &height);
    pems->maps[array] = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA16F, width, height, 1, 1);
    for (int i = 0; i < count; i++)
        for (int level = 0; level < pems->cube_level; level++) {
            const struct tl_paraboloid_crop *crop = &pems->paraboloids[first + i].crops[level];
            if (crop->width > 0)
                glTextureSubImage2D(pems->maps[array].id, 0, crop->atlas_x, crop->atlas_y, crop->width,
                                    crop->height, GL_RGB, GL_FLOAT, sampled[i].levels[level]);
            free(sampled[i].levels[level]);
            sampled[i].levels[level] = NULL;
        }
}

static vec4s with_zero(vec3s v)
{
    return (vec4s){{v.x, v.y, v.z, 0}};
}

/* A black level has bounds that nothing lies within. */
static void upload_frames(struct tl_pems *pems)
{
    struct gpu_paraboloid *frames = TL_NEW_ARRAY(struct gpu_paraboloid, (size_t)pems->count);
    for (int i = 0; i < pems->count; i++) {
        const struct tl_paraboloid *map = &pems->paraboloids[i];
        frames[i].right = with_zero(map->right);
        frames[i].up = with_zero(map->up);
        frames[i].direction = with_zero(map->direction);
        for (int level = 0; level < pems->cube_level; level++) {
            const struct tl_paraboloid_crop *crop = &map->crops[level];
            float x = (float)crop->atlas_x + 0.5f, y = (float)crop->atlas_y + 0.5f;
            frames[i].places[level] =
                (vec4s){{(float)(crop->atlas_x - crop->x0), (float)(crop->atlas_y - crop->y0),
                         tl_paraboloid_density(pems->size, level), 0}};
            frames[i].bounds[level] =
                (vec4s){{x, y, x + (float)(crop->width - 1), y + (float)(crop->height - 1)}};
        }
    }
    glCreateBuffers(1, &pems->buffer);
    glNamedBufferStorage(pems->buffer, (GLsizeiptr)((size_t)pems->count * sizeof *frames), frames, 0);
    free(frames);
}

/* Builds the chains of up to BATCH regions from `first` on, uploads their cubes and samples their
 * paraboloids. */
static void build_batch(struct tl_pems *pems, const tl_cube *cube, const struct tl_regions *regions,
                        enum tl_chain_filter filter, int first, int count, struct sampled *sampled)
{
    struct tl_chain chains[BATCH];
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; i++) {
        tl_cube cut = tl_pem_cut(cube, regions, first + i);
        chains[i] = tl_chain_build(&cut, filter);
        scale_chain(&chains[i], 1 / pems->scale);
        tl_cube_release(&cut);
        if (pems->paraboloids)
            pems->paraboloids[first + i] =
                tl_paraboloid_place(&regions->items[first + i], &chains[i], pems->cube_level);
        for (int level = 0; level < pems->cube_level; level++)
            sampled[i].levels[level] = tl_paraboloid_sample(&pems->paraboloids[first + i], &chains[i], level);
    }
    for (int i = 0; i < count; i++) {
        upload_cubes(pems, first + i, &chains[i]);
        tl_chain_release(&chains[i]);
    }
}

void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, struct tl_pem_storage storage)
{
    release_paraboloids(pems);
    pems->size = cube->size;
    pems->scale = storage_scale(cube);
    pems->cube_level = storage.layout == TL_PEM_PARABOLOID ? tl_paraboloid_levels(cube, regions) : 0;
    allocate_cubes(pems, gpu, regions->count, storage.per_array);
    if (pems->cube_level > 0) {
        pems->maps = TL_NEW_ARRAY(tl_texture, (size_t)pems->array_count);
        pems->paraboloids = TL_NEW_ARRAY(struct tl_paraboloid, (size_t)pems->count);
    }
    struct sampled *sampled = TL_NEW_ARRAY(struct sampled, (size_t)pems->per_array);
    for (int array = 0; array < pems->array_count; array++) {
        int begin = array * pems->per_array, end = begin + pems->per_array;
        end = end < pems->count ? end : pems->count;
        for (int first = begin; first < end; first += BATCH)
            build_batch(pems, cube, regions, (enum tl_chain_filter)filter, first,
                        end - first < BATCH ? end - first : BATCH, sampled + (first - begin));
        if (pems->maps)
            upload_maps(pems, gpu, array, sampled);
    }
    free(sampled);
    if (pems->maps)
        upload_frames(pems);
}

void tl_pems_bind(const struct tl_pems *pems, int array, unsigned unit)
{
    glBindTextureUnit(unit, pems->arrays[array].id);
    if (!pems->maps)
        return;
    glBindTextureUnit(MAPS_UNIT, pems->maps[array].id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PARABOLOIDS_BINDING, pems->buffer);
}

void tl_pems_release(struct tl_pems *pems)
{
    release_paraboloids(pems);
    for (int i = 0; i < pems->array_count; i++)
        tl_texture_destroy(&pems->arrays[i]);
    free(pems->arrays);
    *pems = (struct tl_pems){0};
}

size_t tl_pems_bytes(const struct tl_pems *pems)
{
    size_t bytes = 0;
    for (int i = 0; i < pems->array_count; i++)
        bytes += tl_texture_bytes(&pems->arrays[i]) + (pems->maps ? tl_texture_bytes(&pems->maps[i]) : 0);
    return bytes;
}

static void read_paraboloid(const struct tl_pems *pems, int index, int level, const tl_cube *cube)
{
    const struct tl_paraboloid *map = &pems->paraboloids[index];
    const struct tl_paraboloid_crop *crop = &map->crops[level];
    if (crop->width == 0)
        return;
    size_t values = 3 * (size_t)crop->width * (size_t)crop->height;
    float *texels = TL_NEW_ARRAY(float, values);
    glGetTextureSubImage(pems->maps[index / pems->per_array].id, 0, crop->atlas_x, crop->atlas_y, 0,
                         crop->width, crop->height, 1, GL_RGB, GL_FLOAT, (GLsizei)(values * sizeof(float)),
                         texels);
    for (int i = 0; i < 6 * cube->size * cube->size; i++) {
        vec3s colour = tl_paraboloid_fetch(map, level, tl_paraboloid_density(pems->size, level), texels,
                                           tl_cube_texel_direction(cube->size, i));
        memcpy(cube->texels + 3 * (size_t)i, colour.raw, sizeof colour.raw);
    }
    free(texels);
}

tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level)
{
    tl_cube cube = tl_cube_create(pems->size >> level);
    size_t values = 18 * (size_t)cube.size * (size_t)cube.size;
    if (level < pems->cube_level)
        read_paraboloid(pems, index, level, &cube);
    else
        glGetTextureSubImage(pems->arrays[index / pems->per_array].id, level - pems->cube_level, 0, 0,
                             6 * (index % pems->per_array), cube.size, cube.size, 6, GL_RGB, GL_FLOAT,
                             (GLsizei)(values * sizeof(float)), cube.texels);
    for (size_t i = 0; i < values; i++)
        cube.texels[i] *= pems->scale;
    return cube;
}
