#include "render/envmap/envmap.h"

#include "config/base/memory.h"
#include "render/brdf/brdf.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COSINES     256 /* width of the Fresnel table: error 0.07 per mille */
#define TEXEL_BYTES 16  /* RGBA32F, so that no light is clamped */

/* std430: struct Part in envmap.frag. */
struct part {
    uint32_t first_triangle;
    float index;
    uint32_t is_ground;
    float coat, coat_glossiness;
    float rest[3]; /* std430 has vectors of three at multiples of 16 bytes */
    float transmission[4];
};

/* Layers of the array texture per picture. */
static int layers_of(enum tl_layout layout)
{
    return layout == TL_LAYOUT_CUBE ? 6 : layout == TL_LAYOUT_PARABOLOID ? 2 : 1;
}

void tl_envmap_release(struct tl_envmap *envmap)
{
    for (size_t i = 0; i < envmap->variant_count; i++) {
        tl_program_destroy(&envmap->variants[i].program);
        free(envmap->variants[i].defines);
    }
    free(envmap->variants);
    tl_texture_destroy(&envmap->maps);
    tl_texture_destroy(&envmap->fresnel);
    tl_target_destroy(&envmap->passed);
    tl_vertex_vectors_release(&envmap->vectors);
    tl_mip_levels_release(&envmap->levels);
    if (envmap->parts_buffer)
        glDeleteBuffers(1, &envmap->parts_buffer);
    *envmap = (struct tl_envmap){0};
}

bool tl_envmap_reload(struct tl_envmap *envmap, tl_error *error)
{
    bool fine = true;
    for (size_t i = 0; i < envmap->variant_count; i++)
        fine = fine && tl_program_reload(&envmap->variants[i].program, error);
    return fine && tl_vertex_vectors_reload(&envmap->vectors, error);
}

size_t tl_envmap_bytes(const struct tl_envmap *envmap)
{
    return tl_texture_bytes(&envmap->maps) + tl_texture_bytes(&envmap->fresnel) + envmap->parts_bytes +
           tl_target_bytes(&envmap->passed) + tl_target_bytes(&envmap->vectors.target);
}

uint64_t tl_envmap_bytes_needed(const struct tl_maps_params *params, uint32_t exponents)
{
    int64_t width, height;
    tl_layout_extent((enum tl_layout)params->layout, params->size, &width, &height);
    uint64_t texels = (uint64_t)width * (uint64_t)height;
    return (uint64_t)__builtin_popcount(exponents) * (texels + texels / 2) *
           TEXEL_BYTES; /* mip levels take another third; rounded up */
}

/* The rotation from world axes to the frame of the picture. */
static mat3s world_to_picture(enum tl_layout layout, const mat3s *into_world, const struct tl_view *view)
{
    mat3s axes = *into_world;
    if (layout == TL_LAYOUT_SPHERE) {
        axes.col[0] = glms_vec3_normalize(view->right);
        axes.col[1] = glms_vec3_normalize(view->up);
        axes.col[2] = glms_vec3_negate(view->forward);
    }
    return glms_mat3_transpose(axes);
}

static void allocate(struct tl_envmap *envmap, tl_gpu *gpu, enum tl_layout layout, int size, int slot_count)
{
    const struct tl_sphere_map *map = &envmap->levels.maps[0];
    bool is_cube = layout == TL_LAYOUT_CUBE;
    if (envmap->levels.count == 0 || map->layout != layout || tl_layout_size(map) != size) {
        tl_mip_levels_release(&envmap->levels);
        envmap->levels = tl_mip_levels_create(layout, size);
    }
    int layers = layers_of(layout) * slot_count, width = layout == TL_LAYOUT_LATLONG ? 2 * size : size;
    if (envmap->layout == layout && envmap->maps.width == width && envmap->maps.layers == layers)
        return;
    tl_texture_destroy(&envmap->maps);
    envmap->layout = layout;
    envmap->maps = tl_texture_create(gpu, is_cube ? GL_TEXTURE_CUBE_MAP_ARRAY : GL_TEXTURE_2D_ARRAY,
                                     GL_RGBA32F, width, size, layers, envmap->levels.count);
    if (layout == TL_LAYOUT_LATLONG)
        glTextureParameteri(envmap->maps.id, GL_TEXTURE_WRAP_S, GL_REPEAT);
}

/* Uploads a picture. The faces of a cube lie below one another in it, as layers do in a texture; discs lie
 * side by side. */
static void upload(const struct tl_envmap *envmap, const struct tl_prefiltered_map *picture, int slot)
{
    int layers = layers_of(envmap->layout), across = envmap->layout == TL_LAYOUT_PARABOLOID ? 2 : 1;
    int at_once = layers / across;
    for (int level = 0; level < picture->level_count; level++) {
        const struct tl_sphere_map *map = &envmap->levels.maps[level];
        glPixelStorei(GL_UNPACK_ROW_LENGTH, map->width);
        for (int part = 0; part < across; part++) {
            glPixelStorei(GL_UNPACK_SKIP_PIXELS, part * map->width / across);
            glTextureSubImage3D(envmap->maps.id, level, 0, 0, layers * slot + part, map->width / across,
                                map->height / at_once, at_once, GL_RGBA, GL_FLOAT, picture->texels[level]);
        }
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
}

void tl_envmap_fill(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_maps_params *params,
                    const struct tl_lobes *lobes, const mat3s *into_world, const struct tl_view *view)
{
    enum tl_layout layout = (enum tl_layout)params->layout;
    allocate(envmap, gpu, layout, params->size, __builtin_popcount(lobes->made));
    envmap->turn = world_to_picture(layout, into_world, view);
    mat3s from_picture = glms_mat3_mul(glms_mat3_transpose(*into_world), glms_mat3_transpose(envmap->turn));
    int slot = 0;
    for (int exponent = 0; exponent <= TL_EXPONENT_COUNT; exponent++) {
        envmap->slots[exponent] = -1;
        if (!(lobes->made & 1u << exponent))
            continue;
        struct tl_prefiltered_map picture =
            tl_prefiltered_map_make(&envmap->levels, lobes, exponent, from_picture);
        upload(envmap, &picture, slot);
        tl_prefiltered_map_release(&picture);
        envmap->slots[exponent] = slot++;
    }
}

static size_t count_parts(const struct tl_triangle_ranges *ranges)
{
    size_t count = 0;
    for (size_t s = 0; s < ranges->surface_count; s++)
        count += ranges->surfaces[s]->part_count;
    return count;
}

/* A part before sorting. */
struct part_source {
    uint32_t first_triangle;
    const tl_material *material;
    bool is_ground;
};

static int by_first_triangle(const void *a, const void *b)
{
    uint32_t first = ((const struct part_source *)a)->first_triangle,
             second = ((const struct part_source *)b)->first_triangle;
    return (first > second) - (first < second);
}

static size_t list_parts(const struct tl_triangle_ranges *ranges, bool has_ground,
                         struct part_source *sources)
{
    size_t count = 0;
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        bool is_ground = has_ground && s + 1 == ranges->surface_count;
        for (size_t p = 0; p < surface->part_count; p++)
            if (surface->parts[p].index_count > 0)
                sources[count++] =
                    (struct part_source){ranges->first[s] + surface->parts[p].first_index / 3,
                                         &surface->materials[surface->parts[p].material], is_ground};
    }
    qsort(sources, count, sizeof *sources, by_first_triangle);
    return count;
}

static bool is_layered(const tl_material *material)
{
    vec3s through = material->transmission;
    return material->coat > 0 || through.x > 0 || through.y > 0 || through.z > 0;
}

static struct part part_of(const struct part_source *source)
{
    const tl_material *material = source->material;
    vec3s through = material->transmission;
    return (struct part){.first_triangle = source->first_triangle,
                         .index = fmaxf(material->gloss.index, 1),
                         .is_ground = source->is_ground,
                         .coat = material->coat,
                         .coat_glossiness = material->coat_glossiness,
                         .transmission = {through.x, through.y, through.z}};
}

static void send_parts(struct tl_envmap *envmap, const struct part_source *sources, size_t count)
{
    struct part *parts = TL_NEW_ARRAY(struct part, count + 1); /* GL does not allow empty buffers */
    envmap->has_layers = false;
    for (size_t i = 0; i < count; i++) {
        parts[i] = part_of(&sources[i]);
        envmap->has_layers |= is_layered(sources[i].material);
    }
    if (!envmap->parts_buffer)
        glCreateBuffers(1, &envmap->parts_buffer);
    envmap->parts_bytes = (count + 1) * sizeof *parts;
    envmap->part_count = (int)count;
    glNamedBufferData(envmap->parts_buffer, (GLsizeiptr)envmap->parts_bytes, parts, GL_STATIC_DRAW);
    free(parts);
}

/* Uploads the Fresnel table. Parts beyond the height limit of a texture share its last row. */
static void send_fresnel(struct tl_envmap *envmap, tl_gpu *gpu, const struct part_source *sources,
                         size_t count)
{
    size_t max_rows = (size_t)tl_gpu_texture_side_max(gpu), rows = count < max_rows ? count : max_rows;
    float *texels = TL_NEW_ARRAY(float, (size_t)4 * COSINES * (rows + 1));
    envmap->has_colours = false;
    for (size_t row = 0; row < rows; row++) {
        const tl_material *material = sources[row].material;
        struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
        for (size_t i = 0; i < COSINES; i++) {
            vec3s reflectance = tl_brdf_fresnel(&brdf, (float)i / (float)(COSINES - 1));
            memcpy(texels + 4 * (row * COSINES + i), reflectance.raw, sizeof reflectance);
            envmap->has_colours |= reflectance.x != reflectance.y || reflectance.y != reflectance.z;
        }
    }
    int height = rows > 0 ? (int)rows : 1;
    if (envmap->fresnel.height != height) {
        tl_texture_destroy(&envmap->fresnel);
        envmap->fresnel = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA32F, (int)COSINES, height, 1, 1);
    }
    glTextureSubImage2D(envmap->fresnel.id, 0, 0, 0, (GLsizei)COSINES, height, GL_RGBA, GL_FLOAT, texels);
    free(texels);
}

void tl_envmap_set_parts(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_triangle_ranges *ranges,
                         bool has_ground)
{
    struct part_source *sources = TL_NEW_ARRAY(struct part_source, count_parts(ranges));
    envmap->has_ground = has_ground;
    size_t count = list_parts(ranges, has_ground, sources);
    send_parts(envmap, sources, count);
    send_fresnel(envmap, gpu, sources, count);
    free(sources);
}
