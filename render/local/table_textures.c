#include "render/local/table_textures.h"

#include "config/base/memory.h"
#include "render/brdf/tables/tables.h"

#include <epoxy/gl.h>

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static_assert(TL_GLOSS_TABLES_MAX == TL_BRDF_TABLES_MAX, "as many textures as a model has tables");

static void release_gloss(struct tl_gloss_tables *gloss)
{
    for (int i = 0; i < gloss->count; i++)
        tl_texture_destroy(&gloss->tables[i].texture);
}

void tl_table_textures_release(struct tl_table_textures *textures)
{
    for (size_t i = 0; i < textures->gloss_count; i++)
        release_gloss(&textures->gloss[i]);
    for (size_t i = 0; i < textures->power_count; i++)
        tl_texture_destroy(&textures->powers[i].texture);
    for (int i = 0; i < 2; i++)
        tl_texture_destroy(&textures->cubes[i]);
    free(textures->gloss);
    free(textures->powers);
    *textures = (struct tl_table_textures){0};
}

size_t tl_table_textures_bytes(const struct tl_table_textures *textures)
{
    size_t bytes = tl_texture_bytes(&textures->cubes[0]) + tl_texture_bytes(&textures->cubes[1]);
    for (size_t i = 0; i < textures->gloss_count; i++)
        for (int t = 0; t < textures->gloss[i].count; t++)
            bytes += tl_texture_bytes(&textures->gloss[i].tables[t].texture);
    for (size_t i = 0; i < textures->power_count; i++)
        bytes += tl_texture_bytes(&textures->powers[i].texture);
    return bytes;
}

void tl_table_textures_begin(struct tl_table_textures *textures)
{
    for (size_t i = 0; i < textures->gloss_count; i++)
        textures->gloss[i].used = false;
    for (size_t i = 0; i < textures->power_count; i++)
        textures->powers[i].used = false;
    textures->cubes_used[0] = textures->cubes_used[1] = false;
}

void tl_table_textures_end(struct tl_table_textures *textures)
{
    size_t kept = 0;
    for (size_t i = 0; i < textures->gloss_count; i++)
        if (textures->gloss[i].used)
            textures->gloss[kept++] = textures->gloss[i];
        else
            release_gloss(&textures->gloss[i]);
    textures->gloss_count = kept;
    kept = 0;
    for (size_t i = 0; i < textures->power_count; i++)
        if (textures->powers[i].used)
            textures->powers[kept++] = textures->powers[i];
        else
            tl_texture_destroy(&textures->powers[i].texture);
    textures->power_count = kept;
    for (int i = 0; i < 2; i++)
        if (!textures->cubes_used[i])
            tl_texture_destroy(&textures->cubes[i]);
}

/* The texels of a float table, scaled into [0, 1] too, so that passes of 8 bits can hold them. New array. */
static float *bounded_floats(const struct tl_brdf_table *table, float *scale)
{
    const float *texels = table->texels;
    size_t count = (size_t)table->width * (size_t)table->height * (size_t)table->channels;
    float *bounded = TL_NEW_ARRAY(float, count), max = 0;
    for (size_t i = 0; i < count; i++)
        max = texels[i] > max ? texels[i] : max;
    for (size_t i = 0; i < count; i++)
        bounded[i] = max > 0 ? texels[i] / max : 0;
    *scale = table->scale * (max > 0 ? max : 1);
    return bounded;
}

static struct tl_gloss_table upload(tl_gpu *gpu, const struct tl_brdf_table *table)
{
    static const GLenum formats[][2] = {[TL_PRECISION_FIXED8] = {GL_R8, GL_RGBA8},
                                        [TL_PRECISION_FIXED16] = {GL_R16, GL_RGBA16},
                                        [TL_PRECISION_FLOAT] = {GL_R32F, GL_RGBA32F}};
    static const GLenum types[] = {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_FLOAT};
    static const GLint grey[] = {GL_RED, GL_RED, GL_RED, GL_ONE};
    bool coloured = table->channels == 3;
    float scale = table->scale;
    float *bounded = table->precision == TL_PRECISION_FLOAT ? bounded_floats(table, &scale) : NULL;
    struct tl_gloss_table made = {
        .texture = tl_texture_create(gpu, GL_TEXTURE_2D, formats[table->precision][coloured], table->width,
                                     table->height, 1, 1),
        .scale = scale,
        .axes = {table->x.scale, table->x.bias, table->y.scale, table->y.bias},
        .x = table->x.input,
        .y = table->y.input,
        .angles = table->x.angle,
    };
    glTextureSubImage2D(made.texture.id, 0, 0, 0, table->width, table->height, coloured ? GL_RGB : GL_RED,
                        types[table->precision], bounded ? bounded : table->texels);
    free(bounded);
    if (!coloured)
        glTextureParameteriv(made.texture.id, GL_TEXTURE_SWIZZLE_RGBA, grey);
    return made;
}

static void upload_all(tl_gpu *gpu, const struct tl_brdf_tables *tables, struct tl_gloss_tables *out)
{
    out->count = tables->count;
    out->times_cos_a = tables->times_cos_a;
    for (int i = 0; i < tables->count; i++)
        out->tables[i] = upload(gpu, &tables->tables[i]);
}

static void make_gloss(tl_gpu *gpu, struct tl_gloss_tables *gloss)
{
    const struct tl_brdf_table_params wanted = {.size = gloss->size,
                                                .precision = gloss->precision,
                                                .range = gloss->range,
                                                .angles = true,
                                                .folded = gloss->folded,
                                                .ambient = gloss->ambient,
                                                .diffuse = gloss->diffuse};
    struct tl_brdf_tables tables = gloss->reflectance == TL_REFLECTANCE_FACTORED
                                       ? tl_brdf_tables_refactor(&gloss->brdf, gloss->size)
                                       : tl_brdf_tables_make(&gloss->brdf, &wanted);
    upload_all(gpu, &tables, gloss);
    tl_brdf_tables_release(&tables);
}

static bool is_same_colour(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* A bitwise comparison: values that are equal but differ in their bits (0 and -0) only cause an additional
 * table. */
static bool is_same(const struct tl_gloss_tables *a, const struct tl_gloss_tables *b)
{
    return a->measured == b->measured && a->reflectance == b->reflectance && a->size == b->size &&
           a->precision == b->precision && a->range == b->range && a->folded == b->folded &&
           is_same_colour(a->ambient, b->ambient) && is_same_colour(a->diffuse, b->diffuse) &&
           memcmp(&a->brdf, &b->brdf, sizeof a->brdf) == 0; // NOLINT(bugprone-suspicious-memory-comparison)
}

static struct tl_gloss_tables *find_gloss(struct tl_table_textures *textures,
                                          const struct tl_gloss_tables *key)
{
    for (size_t i = 0; i < textures->gloss_count; i++)
        if (is_same(&textures->gloss[i], key)) {
            textures->gloss[i].used = true;
            return &textures->gloss[i];
        }
    return NULL;
}

static struct tl_gloss_tables *add_gloss(struct tl_table_textures *textures,
                                         const struct tl_gloss_tables *key)
{
    textures->gloss = tl_resize(textures->gloss, textures->gloss_count + 1, sizeof(struct tl_gloss_tables));
    struct tl_gloss_tables *added = &textures->gloss[textures->gloss_count++];
    *added = *key;
    added->used = true;
    return added;
}

vec3s tl_table_ambient(const tl_material *material, const struct tl_shading_params *params)
{
    return glms_vec3_scale(material->diffuse, params->ambient / (float)M_PI);
}

const char *tl_table_terms_refusal(const tl_material *material)
{
    if (material->gloss.model > TL_REFLECT_COSINE_LOBE)
        return "a reflectance of several tables";
    if (material->diffuse_map.image || material->specular_map.image || material->occlusion_map.image)
        return "maps of colour";
    if (material->weave || material->normal_map.image || material->height_map.image)
        return "threads or bumps";
    if (tl_material_is_sewn(material))
        return "seams or hems";
    if (material->back.is_given)
        return "a back of its own";
    return tl_material_is_lambert(material) ? NULL : "a diffuse reflectance that is not Lambert's";
}

const struct tl_gloss_tables *tl_table_textures_gloss(struct tl_table_textures *textures, tl_gpu *gpu,
                                                      const tl_material *material,
                                                      const struct tl_shading_params *params)
{
    struct tl_gloss_tables key = {.brdf = tl_brdf_of(material, material->specular, material->glossiness),
                                  .reflectance = params->reflectance,
                                  .size = params->table_size,
                                  .precision = params->table_precision,
                                  .range = params->table_range};
    key.folded = params->reflectance == TL_REFLECTANCE_TABLE && params->table_terms == TL_TERMS_ALL &&
                 !tl_table_terms_refusal(material);
    if (key.folded) {
        key.ambient = tl_table_ambient(material, params);
        key.diffuse = material->diffuse;
    }
    struct tl_gloss_tables *found = find_gloss(textures, &key);
    if (!found) {
        found = add_gloss(textures, &key);
        make_gloss(gpu, found);
    }
    return found;
}

const struct tl_gloss_tables *tl_table_textures_measured(struct tl_table_textures *textures, tl_gpu *gpu,
                                                         const struct tl_measured *measured)
{
    const struct tl_gloss_tables key = {.measured = measured->hash};
    struct tl_gloss_tables *found = find_gloss(textures, &key);
    if (!found) {
        found = add_gloss(textures, &key);
        upload_all(gpu, &measured->tables, found);
    }
    return found;
}

const tl_texture *tl_table_textures_power(struct tl_table_textures *textures, tl_gpu *gpu, float exponent)
{
    for (size_t i = 0; i < textures->power_count; i++)
        if (textures->powers[i].exponent == exponent) {
            textures->powers[i].used = true;
            return &textures->powers[i].texture;
        }
    uint8_t values[TL_POWER_TABLE_SIZE];
    tl_power_table_make(exponent, TL_POWER_TABLE_SIZE, values);
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R8, TL_POWER_TABLE_SIZE, 1, 1, 1);
    glTextureSubImage2D(texture.id, 0, 0, 0, TL_POWER_TABLE_SIZE, 1, GL_RED, GL_UNSIGNED_BYTE, values);
    textures->powers =
        tl_resize(textures->powers, textures->power_count + 1, sizeof(struct tl_power_texture));
    textures->powers[textures->power_count++] = (struct tl_power_texture){exponent, true, texture};
    return &textures->powers[textures->power_count - 1].texture;
}

const tl_texture *tl_table_textures_cube(struct tl_table_textures *textures, tl_gpu *gpu, int normalisation)
{
    bool wide = normalisation == TL_NORMALISE_CUBE16;
    tl_texture *texture = &textures->cubes[wide];
    textures->cubes_used[wide] = true;
    if (texture->id)
        return texture;
    struct tl_normal_cube cube = tl_normal_cube_make(TL_NORMALISE_CUBE_SIZE, wide ? 16 : 8);
    *texture =
        tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP, wide ? GL_RGBA16 : GL_RGBA8, cube.size, cube.size, 6, 1);
    glTextureSubImage3D(texture->id, 0, 0, 0, 0, cube.size, cube.size, 6, GL_RGB,
                        wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, cube.texels);
    tl_normal_cube_release(&cube);
    return texture;
}
