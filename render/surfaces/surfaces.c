#include "render/surfaces/surfaces.h"

#include "assets/topology/borders.h"
#include "config/base/memory.h"
#include "render/construction/tables.h"
#include "render/detail/bumps.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

enum storage { FIRSTS, NEAR, BORDERS, STORAGES };
enum attribute { POSITION, NORMAL, TANGENT, UV, P_U, P_V, ATTRIBUTES };

/* A texture and the image it was made of: materials share images. */
struct uploaded {
    const tl_image *image;
    bool colour; /* sRGB-decoded: the same image could be used as data elsewhere */
    tl_texture texture;
};

struct yarn_table {
    GLuint buffer; /* 0: the material's yarns are alike */
    float pitch_m[2];
};

struct surface_item {
    bool hidden, has_derivatives;
    GLuint vertex_array, buffers[ATTRIBUTES], indices;
    size_t vertex_count, index_count;
    size_t attribute_counts[ATTRIBUTES]; /* vertices sent; 0 for what the surface does not have */
    uint64_t topology_revision, motion_revision;
    size_t part_count, material_count;
    struct tl_mesh_part *parts;
    tl_material *materials; /* copies: their maps' images are compared, never read, after the upload */
    size_t texture_count;
    struct uploaded *textures;
    GLuint storage[STORAGES]; /* of the borders; 0: there are none */
    size_t storage_bytes;
    GLuint *profiles;                      /* [material_count] buffers; 0: the material is not sewn */
    struct tl_construction_tables *tables; /* [material_count] */
    struct yarn_table *yarns;              /* [material_count] */
};

struct tl_surfaces {
    tl_gpu *gpu;
    size_t count;
    struct surface_item *items;
    const struct tl_detail_maps *detail; /* NULL: none */
    bool has_derivatives;
};

static const size_t attribute_bytes[ATTRIBUTES] = {sizeof(vec3s), sizeof(vec3s), sizeof(vec4s),
                                                   sizeof(vec2s), sizeof(vec3s), sizeof(vec3s)};

static void item_release(struct surface_item *item)
{
    for (size_t i = 0; i < item->texture_count; i++)
        tl_texture_destroy(&item->textures[i].texture);
    free(item->textures);
    free(item->parts);
    free(item->materials);
    if (item->storage[0]) {
        glDeleteBuffers(STORAGES, item->storage);
        glDeleteBuffers((GLsizei)item->material_count, item->profiles);
    }
    for (size_t m = 0; item->yarns && m < item->material_count; m++)
        glDeleteBuffers(1, &item->yarns[m].buffer);
    free(item->yarns);
    free(item->profiles);
    free(item->tables);
    if (item->vertex_array) {
        glDeleteVertexArrays(1, &item->vertex_array);
        glDeleteBuffers(ATTRIBUTES, item->buffers);
        glDeleteBuffers(1, &item->indices);
    }
    *item = (struct surface_item){0};
}

tl_surfaces *tl_surfaces_create(tl_gpu *gpu)
{
    tl_surfaces *surfaces = TL_NEW(tl_surfaces);
    surfaces->gpu = gpu;
    return surfaces;
}

void tl_surfaces_use_detail(tl_surfaces *surfaces, const struct tl_detail_maps *detail)
{
    surfaces->detail = detail;
}

void tl_surfaces_use_derivatives(tl_surfaces *surfaces, bool wanted)
{
    surfaces->has_derivatives = wanted;
}

static void resize(tl_surfaces *surfaces, size_t count)
{
    for (size_t i = count; i < surfaces->count; i++)
        item_release(&surfaces->items[i]);
    surfaces->items = tl_resize(surfaces->items, count, sizeof *surfaces->items);
    for (size_t i = surfaces->count; i < count; i++)
        surfaces->items[i] = (struct surface_item){0};
    surfaces->count = count;
}

void tl_surfaces_destroy(tl_surfaces **surfaces)
{
    if (!*surfaces)
        return;
    resize(*surfaces, 0);
    free((*surfaces)->items);
    free(*surfaces);
    *surfaces = NULL;
}

static GLenum format_of(const tl_image *image, bool colour)
{
    static const GLenum bytes[] = {GL_R8, GL_RG8, GL_RGBA8, GL_RGBA8};
    static const GLenum floats[] = {GL_R32F, GL_RG32F, GL_RGBA32F, GL_RGBA32F};
    int c = image->channels - 1;
    if (image->type == TL_IMAGE_F32)
        return floats[c];
    /* sRGB exists with four channels only; grey colour images are spread by the swizzle below. */
    return colour && !image->linear ? GL_SRGB8_ALPHA8 : bytes[c];
}

/* Trilinear only: anisotropic filtering makes the G-buffer of a woven dress twenty times slower on software
 * GL, and an image must not depend on which GL drew it. */
static tl_texture upload(tl_gpu *gpu, const tl_image *image, bool colour)
{
    tl_texture texture =
        tl_texture_create(gpu, GL_TEXTURE_2D, format_of(image, colour), image->width, image->height, 1,
                          tl_texture_full_levels(image->width, image->height));
    tl_texture_fill(&texture, 0, image, colour);
    if (colour && image->channels == 1) {
        const GLint grey[] = {GL_RED, GL_RED, GL_RED, GL_ONE};
        glTextureParameteriv(texture.id, GL_TEXTURE_SWIZZLE_RGBA, grey);
    }
    return texture;
}

/* Expands grey with alpha to four channels, because GL leaves only the fourth channel of sRGB texels
 * undecoded. */
static tl_image spread_grey(const tl_image *image)
{
    tl_image spread = tl_image_create(image->width, image->height, 4, TL_IMAGE_U8);
    spread.linear = image->linear;
    const uint8_t *from = tl_image_bytes(image);
    uint8_t *to = tl_image_bytes(&spread);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        to[4 * i] = to[4 * i + 1] = to[4 * i + 2] = from[2 * i];
        to[4 * i + 3] = from[2 * i + 1];
    }
    return spread;
}

static tl_texture upload_map(tl_gpu *gpu, const tl_image *image, bool colour)
{
    if (!colour || image->channels != 2 || image->type != TL_IMAGE_U8)
        return upload(gpu, image, colour);
    tl_image spread = spread_grey(image);
    tl_texture texture = upload(gpu, &spread, colour);
    tl_image_release(&spread);
    return texture;
}

static bool add_image(tl_gpu *gpu, struct surface_item *item, const char *surface, const tl_image *image,
                      bool colour, tl_error *error)
{
    if (!image)
        return true;
    for (size_t i = 0; i < item->texture_count; i++)
        if (item->textures[i].image == image && item->textures[i].colour == colour)
            return true;
    int limit = tl_gpu_texture_side_max(gpu);
    if (image->width > limit || image->height > limit)
        return tl_fail(error, TL_INPUT, "%s: a map of %d x %d texels is larger than GL holds: scale it to %d",
                       surface, image->width, image->height, limit);
    item->textures = tl_resize(item->textures, item->texture_count + 1, sizeof *item->textures);
    item->textures[item->texture_count++] = (struct uploaded){image, colour, upload_map(gpu, image, colour)};
    return true;
}

static const struct tl_map *map_of(const tl_material *material, enum tl_map_use use)
{
    switch (use) {
    case TL_MAP_DIFFUSE:
        return &material->diffuse_map;
    case TL_MAP_NORMAL:
        return &material->normal_map;
    case TL_MAP_GLOSS:
        return &material->gloss_map;
    case TL_MAP_SPECULAR:
        return &material->specular_map;
    default:
        return &material->occlusion_map;
    }
}

static bool is_colour(enum tl_map_use use)
{
    return use == TL_MAP_DIFFUSE || use == TL_MAP_SPECULAR;
}

static bool upload_material(tl_gpu *gpu, struct surface_item *item, const char *surface,
                            const tl_material *material, tl_error *error)
{
    for (enum tl_map_use use = 0; use < TL_MAP_USES; use++)
        if (!add_image(gpu, item, surface, map_of(material, use)->image, is_colour(use), error))
            return false;
    if (!add_image(gpu, item, surface, material->emission_map.image, true, error))
        return false;
    const tl_weave *weave = material->weave;
    return !weave || (add_image(gpu, item, surface, &weave->normal, false, error) &&
                      add_image(gpu, item, surface, &weave->gloss, false, error) &&
                      add_image(gpu, item, surface, &weave->tint, false, error));
}

static void attach_buffer(struct surface_item *item, enum attribute attribute, const void *data, size_t count)
{
    static const GLint components[ATTRIBUTES] = {3, 3, 4, 2, 3, 3};
    item->attribute_counts[attribute] = data ? count : 0;
    if (!data) { /* the attribute then reads GL's constant, zero */
        glDisableVertexArrayAttrib(item->vertex_array, attribute);
        return;
    }
    glNamedBufferData(item->buffers[attribute], (GLsizeiptr)(count * attribute_bytes[attribute]), data,
                      attribute == UV ? GL_STATIC_DRAW : GL_STREAM_DRAW);
    glVertexArrayVertexBuffer(item->vertex_array, attribute, item->buffers[attribute], 0,
                              (GLsizei)attribute_bytes[attribute]);
    glVertexArrayAttribFormat(item->vertex_array, attribute, components[attribute], GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(item->vertex_array, attribute, attribute);
    glEnableVertexArrayAttrib(item->vertex_array, attribute);
}

static void send_derivatives(struct surface_item *item, const tl_surface *surface, bool wanted)
{
    const size_t count = surface->vertex_count;
    vec3s *both = wanted && surface->uvs ? TL_NEW_ARRAY(vec3s, 2 * count) : NULL;
    if (both)
        tl_vertex_derivatives(surface, both, both + count);
    attach_buffer(item, P_U, both, count);
    attach_buffer(item, P_V, both ? both + count : NULL, count);
    free(both);
    item->has_derivatives = wanted;
}

static void send_motion(struct surface_item *item, const tl_surface *surface)
{
    attach_buffer(item, POSITION, surface->positions, surface->vertex_count);
    attach_buffer(item, NORMAL, surface->normals, surface->vertex_count);
    attach_buffer(item, TANGENT, surface->tangents, surface->vertex_count);
    item->motion_revision = surface->motion_revision;
}

static void send_storage(struct surface_item *item, enum storage storage, const void *data, size_t bytes)
{
    glNamedBufferData(item->storage[storage], (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    item->storage_bytes += bytes;
}

static void send_yarns(struct surface_item *item)
{
    item->yarns = TL_NEW_ARRAY(struct yarn_table, item->material_count);
    for (size_t m = 0; m < item->material_count; m++) {
        const tl_weave *weave = item->materials[m].weave;
        if (!weave || !weave->yarns)
            continue;
        memcpy(item->yarns[m].pitch_m, weave->yarns->pitch_m, sizeof weave->yarns->pitch_m);
        glCreateBuffers(1, &item->yarns[m].buffer);
        glNamedBufferData(item->yarns[m].buffer, sizeof weave->yarns->sums, weave->yarns->sums,
                          GL_STATIC_DRAW);
        item->storage_bytes += sizeof weave->yarns->sums;
    }
}

/* Sends the borders of pieces, and the profiles of the materials that have seams or hems. */
static void send_construction(struct surface_item *item, const tl_surface *surface)
{
    const tl_borders *borders = surface->borders;
    bool is_sewn = false;
    for (size_t m = 0; m < item->material_count; m++)
        is_sewn |= tl_material_is_sewn(&item->materials[m]);
    if (!borders || borders->border_count == 0 || !is_sewn)
        return;
    glCreateBuffers(STORAGES, item->storage);
    send_storage(item, FIRSTS, borders->firsts, (borders->triangle_count + 1) * sizeof *borders->firsts);
    send_storage(item, NEAR, borders->near, borders->firsts[borders->triangle_count] * sizeof *borders->near);
    send_storage(item, BORDERS, borders->borders, borders->border_count * sizeof *borders->borders);
    item->profiles = TL_NEW_ARRAY(GLuint, item->material_count);
    item->tables = TL_NEW_ARRAY(struct tl_construction_tables, item->material_count);
    for (size_t m = 0; m < item->material_count; m++) {
        if (!tl_material_is_sewn(&item->materials[m]))
            continue;
        tl_construction_tables_make(&item->materials[m].construction, &item->tables[m]);
        glCreateBuffers(1, &item->profiles[m]);
        glNamedBufferData(item->profiles[m], sizeof item->tables[m].profiles, item->tables[m].profiles,
                          GL_STATIC_DRAW);
        item->storage_bytes += sizeof item->tables[m].profiles;
    }
}

static bool send_topology(tl_gpu *gpu, struct surface_item *item, const tl_surface *surface, tl_error *error)
{
    item_release(item);
    glCreateVertexArrays(1, &item->vertex_array);
    glCreateBuffers(ATTRIBUTES, item->buffers);
    glCreateBuffers(1, &item->indices);
    glNamedBufferData(item->indices, (GLsizeiptr)(surface->index_count * sizeof *surface->indices),
                      surface->indices, GL_STATIC_DRAW);
    glVertexArrayElementBuffer(item->vertex_array, item->indices);
    attach_buffer(item, UV, surface->uvs, surface->vertex_count);
    item->vertex_count = surface->vertex_count;
    item->index_count = surface->index_count;
    item->part_count = surface->part_count;
    item->parts = TL_NEW_ARRAY(struct tl_mesh_part, surface->part_count);
    for (size_t p = 0; p < surface->part_count; p++) {
        item->parts[p] = surface->parts[p];
        size_t needed = (size_t)surface->parts[p].material + 1;
        item->material_count = needed > item->material_count ? needed : item->material_count;
    }
    item->materials = TL_NEW_ARRAY(tl_material, item->material_count);
    for (size_t m = 0; m < item->material_count; m++) {
        item->materials[m] = surface->materials[m];
        if (!upload_material(gpu, item, surface->name, &surface->materials[m], error))
            return false;
    }
    send_construction(item, surface);
    send_yarns(item);
    item->topology_revision = surface->topology_revision;
    return true;
}

static bool update_item(const tl_surfaces *surfaces, struct surface_item *item, const tl_surface *surface,
                        tl_error *error)
{
    bool fresh = item->vertex_array == 0 || item->topology_revision != surface->topology_revision ||
                 item->vertex_count != surface->vertex_count || item->index_count != surface->index_count;
    if (fresh && !send_topology(surfaces->gpu, item, surface, error)) {
        item_release(item);
        return false;
    }
    const bool moved = fresh || item->motion_revision != surface->motion_revision;
    if (moved)
        send_motion(item, surface);
    if (moved || item->has_derivatives != surfaces->has_derivatives)
        send_derivatives(item, surface, surfaces->has_derivatives);
    return true;
}

bool tl_surfaces_update(tl_surfaces *surfaces, const tl_surface *const *items, size_t count, tl_error *error)
{
    resize(surfaces, count);
    for (size_t i = 0; i < count; i++)
        if (!update_item(surfaces, &surfaces->items[i], items[i], error))
            return false;
    return true;
}

static const tl_texture *find_texture(const struct surface_item *item, const tl_image *image, bool colour)
{
    for (size_t i = 0; i < item->texture_count; i++)
        if (item->textures[i].image == image && item->textures[i].colour == colour)
            return &item->textures[i].texture;
    return NULL;
}

static void bind(GLuint unit, const tl_texture *texture, bool clamp_u, bool clamp_v)
{
    glTextureParameteri(texture->id, GL_TEXTURE_WRAP_S, clamp_u ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    glTextureParameteri(texture->id, GL_TEXTURE_WRAP_T, clamp_v ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    glBindTextureUnit(unit, texture->id);
}

static int bind_weave(const struct surface_item *item, const tl_weave *weave, float uv_metres)
{
    if (!weave || !(uv_metres > 0) || !(weave->size_m[0] > 0) || !(weave->size_m[1] > 0))
        return 0;
    const tl_image *images[TL_WEAVE_USES] = {&weave->normal, &weave->gloss, &weave->tint};
    for (GLuint i = 0; i < TL_WEAVE_USES; i++)
        bind(TL_MAP_USES + i, find_texture(item, images[i], false), false, false);
    glUniform2f(TL_UNIFORM_WEAVE_SCALE, uv_metres / weave->size_m[0], uv_metres / weave->size_m[1]);
    return 1 << TL_MAP_USES;
}

static int bind_yarns(const struct surface_item *item, const struct tl_mesh_part *part)
{
    const struct yarn_table *yarns = &item->yarns[part->material];
    if (yarns->buffer == 0 || !(part->uv_metres > 0))
        return 0;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TL_STORAGE_YARNS, yarns->buffer);
    glUniform4f(TL_UNIFORM_YARN_ROWS, part->uv_metres / yarns->pitch_m[0],
                part->uv_metres / yarns->pitch_m[1], TL_WARP_YARNS, TL_WEFT_YARNS);
    return TL_FLAG_YARNS;
}

/* `number` is that of the surface's first triangle in the shader. */
static int bind_construction(const struct surface_item *item, const struct tl_mesh_part *part, size_t number)
{
    if (!item->storage[0] || !item->profiles[part->material])
        return 0;
    const struct tl_construction_tables *tables = &item->tables[part->material];
    for (GLuint i = 0; i < STORAGES; i++)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TL_STORAGE_FIRSTS + i, item->storage[i]);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TL_STORAGE_PROFILES, item->profiles[part->material]);
    glUniform1ui(TL_UNIFORM_SEWN_FIRST, (GLuint)number);
    glUniform4fv(TL_UNIFORM_SEWN_SIZES, 1, tables->sizes.raw);
    glUniform4fv(TL_UNIFORM_SEWN_ROWS, 1, tables->rows.raw);
    glUniform3fv(TL_UNIFORM_SEWN_THREAD, 1, item->materials[part->material].construction.thread.raw);
    return TL_FLAG_SEWN;
}

/* A program may not draw without a buffer in each storage block, even where it does not read it. */
static void bind_any_storage(const struct surface_item *item)
{
    static const GLuint blocks[] = {TL_STORAGE_FIRSTS, TL_STORAGE_NEAR, TL_STORAGE_BORDERS,
                                    TL_STORAGE_PROFILES, TL_STORAGE_YARNS};
    for (size_t i = 0; i < TL_COUNT(blocks); i++)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, blocks[i], item->buffers[0]);
}

static int set_back(const struct tl_back *back)
{
    if (!back->is_given)
        return 0;
    glUniform3fv(TL_UNIFORM_BACK_DIFFUSE, 1, back->diffuse.raw);
    glUniform3fv(TL_UNIFORM_BACK_SPECULAR, 1, back->specular.raw);
    return TL_FLAG_BACK;
}

/* Units without a map are cleared: software GL samples whatever is bound, wanted or not, and compiles each
 * shader again for every set of formats that it meets. */
static void set_material(const struct surface_item *item, const struct tl_mesh_part *part, size_t number)
{
    const tl_material *material = &item->materials[part->material];
    glBindTextures(0, TL_MAP_USES + TL_WEAVE_USES, NULL);
    bind_any_storage(item);
    int flags = bind_weave(item, material->weave, part->uv_metres) | bind_construction(item, part, number) |
                set_back(&material->back) | bind_yarns(item, part);
    float rows[TL_MAP_USES][6];
    for (enum tl_map_use use = 0; use < TL_MAP_USES; use++) {
        const struct tl_map *map = map_of(material, use);
        tl_uv_transform_rows(&map->transform, rows[use]);
        if (!map->image)
            continue;
        bind((GLuint)use, find_texture(item, map->image, is_colour(use)), map->clamp_u, map->clamp_v);
        flags |= 1 << use;
    }
    if (material->gloss.model != TL_REFLECT_PHONG)
        flags |= TL_FLAG_FACETED;
    glUniform3fv(TL_UNIFORM_DIFFUSE, 1, material->diffuse.raw);
    glUniform3fv(TL_UNIFORM_THREAD_GAIN, 1, tl_material_thread_gain(material).raw);
    glUniform3fv(TL_UNIFORM_SPECULAR, 1, material->specular.raw);
    glUniform4f(TL_UNIFORM_SCALARS, material->glossiness, material->normal_scale,
                material->occlusion_strength, material->alpha_cutoff);
    glUniform1i(TL_UNIFORM_MAP_FLAGS, flags);
    glUniform3fv(TL_UNIFORM_UV_ROWS, 2 * TL_MAP_USES, rows[0]);
}

bool tl_surfaces_bind_emission(const tl_surfaces *surfaces, size_t index, size_t part, unsigned unit)
{
    const struct surface_item *item = &surfaces->items[index];
    const struct tl_map *map = &item->materials[item->parts[part].material].emission_map;
    if (map->image)
        bind(unit, find_texture(item, map->image, true), map->clamp_u, map->clamp_v);
    return map->image != NULL;
}

/* GL takes an offset into the bound buffer as a pointer. */
static const void *offset_of_index(size_t index)
{
    return (const void *)(index * sizeof(uint32_t)); /* NOLINT(performance-no-int-to-ptr) */
}

static enum tl_surface_parts kind_of(const struct surface_item *item, const struct tl_mesh_part *part)
{
    return item->materials[part->material].alpha_cutoff > 0 ? TL_PARTS_MASKED : TL_PARTS_OPAQUE;
}

size_t tl_surfaces_part_count(const tl_surfaces *surfaces, size_t index)
{
    return surfaces->items[index].part_count;
}

const tl_material *tl_surfaces_part_material(const tl_surfaces *surfaces, size_t index, size_t part)
{
    const struct surface_item *item = &surfaces->items[index];
    return &item->materials[item->parts[part].material];
}

/* The number of a surface's first triangle among those of all surfaces. */
static size_t first_number(const tl_surfaces *surfaces, size_t index)
{
    size_t number = 0;
    for (size_t i = 0; i < index; i++)
        number += surfaces->items[i].index_count / 3;
    return number;
}

/* Draws from the index buffer that is bound; `number` is the first triangle's number in the shader. */
static void draw_indices(const tl_surfaces *surfaces, size_t index, size_t part_index, size_t first_index,
                         size_t index_count, size_t number)
{
    const struct surface_item *item = &surfaces->items[index];
    const struct tl_mesh_part *part = &item->parts[part_index];
    glBindVertexArray(item->vertex_array);
    set_material(item, part, first_number(surfaces, index));
    tl_detail_maps_bind(surfaces->detail, index, part_index, part->uv_metres, TL_UNIFORM_DETAIL,
                        TL_DETAIL_UNIT);
    glUniform1ui(TL_UNIFORM_FIRST_TRIANGLE, (GLuint)number);
    glDrawElements(GL_TRIANGLES, (GLsizei)index_count, GL_UNSIGNED_INT, offset_of_index(first_index));
}

unsigned tl_surfaces_bind_corners(const tl_surfaces *surfaces, size_t index, size_t part)
{
    const struct surface_item *item = &surfaces->items[index];
    const GLuint buffers[] = {item->indices, item->buffers[POSITION], item->buffers[NORMAL]};
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, TL_STORAGE_CORNERS, TL_COUNT(buffers), buffers);
    return item->parts[part].first_index;
}

void tl_surfaces_draw_part(const tl_surfaces *surfaces, size_t index, size_t part_index)
{
    const struct surface_item *item = &surfaces->items[index];
    const struct tl_mesh_part *part = &item->parts[part_index];
    size_t first_triangle = first_number(surfaces, index) + part->first_index / 3;
    if (item->hidden)
        return;
    draw_indices(surfaces, index, part_index, part->first_index, part->index_count, first_triangle);
}

void tl_surfaces_draw_some(const tl_surfaces *surfaces, size_t index, size_t part, unsigned indices,
                           size_t first, size_t count)
{
    const struct surface_item *item = &surfaces->items[index];
    if (item->hidden || count == 0)
        return;
    glVertexArrayElementBuffer(item->vertex_array, indices);
    draw_indices(surfaces, index, part, 3 * first, 3 * count, first);
    glVertexArrayElementBuffer(item->vertex_array, item->indices);
}

void tl_surfaces_draw(const tl_surfaces *surfaces, size_t index, enum tl_surface_parts parts)
{
    const struct surface_item *item = &surfaces->items[index];
    for (size_t p = 0; p < item->part_count; p++)
        if (kind_of(item, &item->parts[p]) & parts)
            tl_surfaces_draw_part(surfaces, index, p);
}

void tl_surfaces_hide(tl_surfaces *surfaces, size_t index, bool hidden)
{
    surfaces->items[index].hidden = hidden;
}

bool tl_surfaces_is_hidden(const tl_surfaces *surfaces, size_t index)
{
    return surfaces->items[index].hidden;
}

bool tl_surfaces_have(const tl_surfaces *surfaces, enum tl_surface_parts parts)
{
    for (size_t i = 0; i < surfaces->count; i++)
        for (size_t p = 0; p < surfaces->items[i].part_count; p++)
            if (kind_of(&surfaces->items[i], &surfaces->items[i].parts[p]) & parts)
                return true;
    return false;
}

size_t tl_surfaces_bytes(const tl_surfaces *surfaces)
{
    size_t bytes = 0;
    for (size_t i = 0; i < surfaces->count; i++) {
        const struct surface_item *item = &surfaces->items[i];
        for (size_t t = 0; t < item->texture_count; t++)
            bytes += tl_texture_bytes(&item->textures[t].texture);
        bytes += item->index_count * sizeof(uint32_t) + item->storage_bytes;
        for (int a = 0; a < ATTRIBUTES; a++)
            bytes += item->attribute_counts[a] * attribute_bytes[a];
    }
    return bytes;
}
