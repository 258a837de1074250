#include "render/card/card_internal.h"

#include "config/base/memory.h"
#include "render/bounce/bounce_scene.h"
#include "render/brdf/brdf.h"
#include "render/env/exponent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* `Part` of card_material.glsl. */
struct card_part {
    float diffuse[4], specular[4], back_diffuse[4], back_specular[4];
    float ward[1 + TL_THREADS_MAX][4], threads[TL_THREADS_MAX][4], turn[4];
    float weave[4], yarns[4];
    float mean_colour[4], mean_specular[4], mean_gloss[4], mean_own[4], mean_weave[4];
    float sizes[4], rows[4], sewing_thread[4];
    float fuzz[4], fuzz_more[4];
    vec4s law;
    float table[4];
    uint32_t table_first[4];
    float optics[4], emission[4], transmission[4];
    float map_rows[TL_MAP_USES + 1][2][4];
    uint32_t flags[4];
};
enum {
    IS_GLOSSY = 1,
    IS_FACETED = 2,
    HAS_OWN_BUMPS = 4,
    OWN_ARE_MOMENTS = 8,
    HAS_WEAVE_BUMPS = 16,
    WEAVE_ARE_MOMENTS = 32,
    HAS_YARNS = 64,
    IS_SEWN = 128,
    FADES = 256,
    HAS_BACK = 512,
    IS_BOUNDED = 1024,
    HAS_FUZZ = 2048,
    IS_WOVEN = 4096,
    HAS_MAP = 8192,
    HAS_BUMPS = 16384,
    HAS_TABLE = 32768,
    TRANSMITS = 65536,
    LEAN = 1 << 20,
    TOKSVIG = 1 << 21
};

/* Bits of a triangle's part (CARD_TRIANGLE_PARTS). */
#define PARTS_MAX    (1 << 12)
#define SURFACES_MAX 16

const char *tl_card_refusal(const tl_surface *surfaces, size_t count)
{
    size_t parts = 1; /* the ground's */
    for (size_t s = 0; s < count; s++)
        parts += surfaces[s].part_count;
    return count + 1 > SURFACES_MAX || parts > PARTS_MAX ? "so many surfaces or parts" : NULL;
}

/* ---- Classes ---- */

static bool same_yarns(const struct tl_yarns *a, const struct tl_yarns *b)
{
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bytes that were sent */
    return a == b || (a && b && memcmp(a, b, sizeof *a) == 0);
}

static bool same_profiles(const struct tl_construction_tables *a, const struct tl_construction_tables *b)
{
    /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bytes that were sent */
    return a == b || (a && b && memcmp(a->profiles, b->profiles, sizeof a->profiles) == 0);
}

/* A map that a part reads, and how it goes on beyond its edges. */
struct class_map {
    const struct tl_texels *texels;
    bool clamp_u, clamp_v;
};

/* The maps of a part in the order of `maps` in card_maps.glsl; then its weave's tint, bumps and mixed
 * moments, and what it emits. */
static void list_maps(const struct tl_shade_part *part, struct class_map out[TL_CARD_MAPS])
{
    for (int use = 0; use < TL_MAP_USES; use++)
        out[use] =
            (struct class_map){part->maps[use].texels, part->maps[use].clamp_u, part->maps[use].clamp_v};
    const struct tl_shade_map *normal = &part->maps[TL_MAP_NORMAL];
    if (part->own_moments)
        out[TL_MAP_NORMAL].texels = part->own_moments;
    out[TL_MAP_USES] = (struct class_map){part->own_cross, normal->clamp_u, normal->clamp_v};
    out[TL_MAP_USES + 1] = (struct class_map){part->weave_tint, false, false};
    out[TL_MAP_USES + 2] =
        (struct class_map){part->weave_moments ? part->weave_moments : part->weave_normal, false, false};
    out[TL_MAP_USES + 3] = (struct class_map){part->weave_cross, false, false};
    out[TL_MAP_USES + 4] =
        (struct class_map){part->emission.texels, part->emission.clamp_u, part->emission.clamp_v};
}

static bool same_maps(const struct tl_shade_part *a, const struct tl_shade_part *b)
{
    struct class_map maps[2][TL_CARD_MAPS];
    list_maps(a, maps[0]);
    list_maps(b, maps[1]);
    for (int i = 0; i < TL_CARD_MAPS; i++)
        if (maps[0][i].texels != maps[1][i].texels || maps[0][i].clamp_u != maps[1][i].clamp_u ||
            maps[0][i].clamp_v != maps[1][i].clamp_v)
            return false;
    return a->borders == b->borders && same_yarns(a->yarns, b->yarns) &&
           same_profiles(a->construction, b->construction);
}

/* 16 bits a channel; levels and filtering as tl_texels has them. */
static tl_texture send_map(tl_gpu *gpu, const struct class_map *map)
{
    const struct tl_texels *texels = map->texels;
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA16F, texels->widths[0],
                                           texels->heights[0], 1, texels->level_count);
    glTextureParameteri(texture.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(texture.id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id, GL_TEXTURE_WRAP_S, map->clamp_u ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    glTextureParameteri(texture.id, GL_TEXTURE_WRAP_T, map->clamp_v ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    tl_quad *floats = tl_resize(NULL, (size_t)texels->widths[0] * (size_t)texels->heights[0], sizeof *floats);
    for (int level = 0; level < texels->level_count; level++) {
        const size_t count = (size_t)texels->widths[level] * (size_t)texels->heights[level];
        for (size_t i = 0; i < count; i++)
            floats[i] = tl_texels_at(texels, level, i);
        glTextureSubImage2D(texture.id, level, 0, 0, texels->widths[level], texels->heights[level], GL_RGBA,
                            GL_FLOAT, floats);
    }
    free(floats);
    return texture;
}

static const uint32_t nothing[4];
/* An array, or one entry of zeros where there is none. */
static bool send_or_nothing(tl_graphics_card *card, tl_buffer *buffer, const void *data, size_t bytes,
                            tl_error *error)
{
    return tl_buffer_fill(buffer, card->gpu, data ? data : nothing, data ? bytes : sizeof nothing, error);
}

static bool add_class(tl_graphics_card *card, const struct tl_shade_part *part, tl_error *error)
{
    struct tl_card_class *class = &card->classes[card->class_count++];
    const tl_borders *borders = part->borders;
    struct class_map maps[TL_CARD_MAPS];
    class->part = part;
    list_maps(part, maps);
    for (int i = 0; i < TL_CARD_MAPS; i++)
        if (maps[i].texels)
            class->maps[i] = send_map(card->gpu, &maps[i]);
    return send_or_nothing(card, &class->firsts, borders ? borders->firsts : NULL,
                           borders ? sizeof(uint32_t) * (borders->triangle_count + 1) : 0, error) &&
           send_or_nothing(card, &class->near, borders ? borders->near : NULL,
                           borders ? sizeof(uint32_t) * (size_t)borders->firsts[borders->triangle_count] : 0,
                           error) &&
           send_or_nothing(card, &class->borders, borders ? borders->borders : NULL,
                           borders ? sizeof *borders->borders * borders->border_count : 0, error) &&
           send_or_nothing(card, &class->profiles, part->construction ? part->construction->profiles : NULL,
                           sizeof part->construction->profiles, error) &&
           send_or_nothing(card, &class->yarns, part->yarns ? part->yarns->sums : NULL,
                           sizeof part->yarns->sums, error);
}

/* The class of a part, which is made when it is the first; -1: error. */
static int class_of(tl_graphics_card *card, const struct tl_shade_part *part, tl_error *error)
{
    if (!part->transmits && !part->has_maps && !part->has_bumps && !part->is_faceted && !part->has_fuzz &&
        !(part->material->coat > 0) && part->is_lambert && !tl_material_emits(part->material))
        return 1;
    for (int i = 2; i < card->class_count; i++)
        if (same_maps(card->classes[i].part, part))
            return i;
    if (card->class_count == CARD_CLASSES_MAX) {
        tl_fail(error, TL_INPUT, "materials: more than %d sets of maps: set light.device to cpu",
                CARD_CLASSES_MAX - 2);
        return -1;
    }
    return add_class(card, part, error) ? card->class_count - 1 : -1;
}

void tl_card_release_materials(tl_graphics_card *card)
{
    for (int i = 0; i < card->class_count; i++) {
        struct tl_card_class *class = &card->classes[i];
        for (int k = 0; k < TL_CARD_MAPS; k++)
            tl_texture_destroy(&class->maps[k]);
        tl_buffer_destroy(&class->firsts);
        tl_buffer_destroy(&class->near);
        tl_buffer_destroy(&class->borders);
        tl_buffer_destroy(&class->profiles);
        tl_buffer_destroy(&class->yarns);
        *class = (struct tl_card_class){0};
    }
    card->class_count = 2;
}

/* ---- Parts ---- */

static void put_quad(float to[4], tl_quad v)
{
    memcpy(to, &v, sizeof v);
}

/* A vertex reads the mean of each map. */
static void fill_means(const struct tl_shade_part *part, struct card_part *to)
{
    const struct tl_shade_map *maps = part->maps;
    const tl_quad one = {1, 1, 1, 1};
    tl_quad colour = one, specular = one, gloss = {0, 0, 0, 0};
    if (maps[TL_MAP_DIFFUSE].texels)
        colour = tl_texels_mean(maps[TL_MAP_DIFFUSE].texels);
    if (maps[TL_MAP_SPECULAR].texels)
        specular = tl_texels_mean(maps[TL_MAP_SPECULAR].texels);
    specular[3] = maps[TL_MAP_GLOSS].texels ? tl_texels_mean(maps[TL_MAP_GLOSS].texels)[0] : 1;
    if (part->weave_tint) {
        const tl_quad tint = tl_texels_mean(part->weave_tint);
        colour *= tint;
        gloss[0] = tint[3];
    }
    colour[3] = 1;
    if (maps[TL_MAP_OCCLUSION].texels)
        colour[3] +=
            (tl_texels_mean(maps[TL_MAP_OCCLUSION].texels)[0] - 1) * part->material->occlusion_strength;
    if (part->own_cross)
        gloss[1] = tl_texels_mean(part->own_cross)[0];
    if (part->weave_cross)
        gloss[2] = tl_texels_mean(part->weave_cross)[0];
    put_quad(to->mean_colour, colour);
    put_quad(to->mean_specular, specular);
    put_quad(to->mean_gloss, gloss);
    const struct tl_texels *own = part->own_moments ? part->own_moments : maps[TL_MAP_NORMAL].texels;
    const struct tl_texels *weave = part->weave_moments ? part->weave_moments : part->weave_normal;
    if (own)
        put_quad(to->mean_own, tl_texels_mean(own));
    if (weave)
        put_quad(to->mean_weave, tl_texels_mean(weave));
}

static void fill_maps(const struct tl_shade_materials *materials, const struct tl_shade_part *part,
                      struct card_part *to)
{
    for (int use = 0; use <= TL_MAP_USES; use++) {
        const struct tl_shade_map *map = use < TL_MAP_USES ? &part->maps[use] : &part->emission;
        const float *rows = map->rows;
        to->flags[2] |= map->texels ? 1u << use : 0;
        for (int k = 0; k < 2; k++)
            memcpy(to->map_rows[use][k], rows + (ptrdiff_t)3 * k, 3 * sizeof *rows);
    }
    to->weave[0] = part->weave_scale[0];
    to->weave[1] = part->weave_scale[1];
    to->weave[2] =
        materials->detail.minify != TL_DETAIL_MINIFY_NONE ? 2 : 1; /* WEAVE_BIAS of material.glsl */
    if (part->yarns) {
        to->yarns[0] = part->uv_metres / part->yarns->pitch_m[0];
        to->yarns[1] = part->uv_metres / part->yarns->pitch_m[1];
        to->yarns[2] = TL_WARP_YARNS;
        to->yarns[3] = TL_WEFT_YARNS;
    }
}

static uint32_t flags_of(const struct tl_shade_materials *materials, const struct tl_shade_part *part,
                         bool is_ground)
{
    const tl_material *material = part->material;
    const int minify = materials->detail.minify;
    uint32_t flags = minify == TL_DETAIL_MINIFY_LEAN      ? LEAN
                     : minify == TL_DETAIL_MINIFY_TOKSVIG ? TOKSVIG
                                                          : 0;
    const struct {
        bool is_so;
        uint32_t flag;
    } rows[] = {{part->is_glossy, IS_GLOSSY},
                {part->is_faceted, IS_FACETED},
                {part->own_moments || part->maps[TL_MAP_NORMAL].texels, HAS_OWN_BUMPS},
                {part->own_moments, OWN_ARE_MOMENTS},
                {part->weave_moments || part->weave_normal, HAS_WEAVE_BUMPS},
                {part->weave_moments, WEAVE_ARE_MOMENTS},
                {part->weave_tint, IS_WOVEN},
                {part->yarns, HAS_YARNS},
                {part->borders, IS_SEWN},
                {is_ground, FADES},
                {material->back.is_given, HAS_BACK},
                {material->gloss.ward == TL_WARD_BOUNDED, IS_BOUNDED},
                {part->has_fuzz, HAS_FUZZ},
                {part->has_maps, HAS_MAP},
                {part->has_maps && part->has_bumps, HAS_BUMPS},
                {part->lobe_set, HAS_TABLE},
                {part->transmits, TRANSMITS}};
    for (size_t i = 0; i < TL_COUNT(rows); i++)
        flags |= rows[i].is_so ? rows[i].flag : 0;
    return flags;
}

/* Notes the place of a part's table among all of them; `first` counts vectors. */
static void fill_table(const struct tl_shade_part *part, uint32_t first, struct card_part *to)
{
    const struct tl_lobe_set_table *table = part->lobe_set;
    to->table_first[0] = first;
    const struct tl_brdf own =
        tl_brdf_of(part->material, part->material->specular, part->material->glossiness);
    to->ward[0][0] = own.gloss.width_weft * own.gloss.width_weft;
    to->table[0] = table->gloss_low;
    to->table[1] = table->gloss_high;
    to->table[2] = (float)table->lobe_count;
    to->table[3] = (float)table->gloss_count;
}

static size_t table_nodes(const struct tl_lobe_set_table *table)
{
    return (size_t)table->gloss_count * TL_LOBE_SET_COSINES * TL_LOBE_SET_AZIMUTHS;
}

/* Sends the tables of all parts one after the other; parts that share one have it once. */
static bool send_tables(tl_graphics_card *card, const struct tl_shade_materials *materials,
                        struct card_part *parts, tl_error *error)
{
    const size_t count = materials->first_parts[materials->surface_count],
                 node = sizeof(struct tl_lobe_set_node);
    struct tl_lobe_set_node *nodes = NULL;
    size_t placed = 0;
    for (size_t p = 0; p < count; p++) {
        const struct tl_lobe_set_table *table = materials->parts[p].lobe_set;
        size_t same = 0;
        while (same < p && materials->parts[same].lobe_set != table)
            same++;
        if (!table)
            continue;
        fill_table(&materials->parts[p], (uint32_t)(placed * node / sizeof(vec4s)), &parts[p]);
        if (same < p) {
            parts[p].table_first[0] = parts[same].table_first[0];
            continue;
        }
        nodes = tl_resize(nodes, placed + table_nodes(table), node);
        memcpy(nodes + placed, table->nodes, table_nodes(table) * node);
        placed += table_nodes(table);
    }
    bool fine = send_or_nothing(card, &card->buffers[CARD_LOBE_SETS], nodes, placed * node, error);
    free(nodes);
    return fine;
}

static void fill_part(const struct tl_shade_materials *materials, const struct tl_shade_part *part,
                      bool is_ground, uint32_t first_triangle, struct card_part *to)
{
    const tl_material *material = part->material;
    tl_card_put(to->diffuse, material->diffuse, material->glossiness);
    tl_card_put(to->specular, material->specular, material->normal_scale);
    tl_card_put(to->back_diffuse, material->back.diffuse, material->occlusion_strength);
    tl_card_put(to->back_specular, material->back.specular, materials->detail.height_scale);
    memcpy(to->ward[0], part->ward_squares, sizeof part->ward_squares);
    for (int k = 0; k < material->thread_count; k++) {
        memcpy(to->ward[1 + k], part->thread_squares[k], sizeof part->thread_squares[k]);
        tl_card_put(to->threads[k], material->threads[k].ratio, 0);
    }
    to->turn[0] = part->turn_cosine;
    to->turn[1] = part->turn_sine;
    to->turn[2] = part->uv_metres;
    to->turn[3] = (float)part->lobe_set_count;
    const struct tl_gloss *gloss = &material->gloss;
    to->table_first[1] = (uint32_t)gloss->facets;
    to->table_first[2] = (uint32_t)gloss->masking;
    to->table_first[3] = (uint32_t)gloss->model | (uint32_t)gloss->fresnel << 4;
    to->optics[0] = gloss->index > 0 ? gloss->index : 1; /* as tl_brdf_bumped */
    to->optics[1] = fmaxf(gloss->extinction, 0);
    to->optics[2] = material->coat;
    to->optics[3] = tl_lobe_exponent(material->coat_glossiness);
    tl_card_put(to->emission, material->emission, 0);
    tl_card_put(to->transmission, material->transmission, material->openness);
    fill_means(part, to);
    fill_maps(materials, part, to);
    if (part->construction) {
        memcpy(to->sizes, part->construction->sizes.raw, sizeof to->sizes);
        memcpy(to->rows, part->construction->rows.raw, sizeof to->rows);
    }
    tl_card_put(to->sewing_thread, material->construction.thread, 0);
    tl_card_put(to->fuzz, material->fuzz.colour, material->fuzz.roughness);
    to->fuzz_more[0] = material->fuzz.follow;
    to->law = part->law;
    to->flags[0] = flags_of(materials, part, is_ground);
    to->flags[1] = first_triangle;
    to->flags[3] = (uint32_t)material->thread_count;
}

static void fill_albedos(const struct tl_bounce_material *material, float to[5][4])
{
    for (int side = 0; side < 2; side++) {
        tl_card_put(to[(ptrdiff_t)2 * side], material->albedo[side], 0);
        tl_card_put(to[(ptrdiff_t)2 * side + 1], material->whole[side], 0);
    }
    tl_card_put(to[4], material->transmission, 0);
    for (int c = 0; c < 3; c++)
        to[c][3] = material->emission.raw[c];
}

static bool send_triangle_parts(tl_graphics_card *card, const struct tl_card_surfaces *request,
                                const uint32_t *kinds, tl_error *error)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    uint32_t *of_triangle = TL_NEW_ARRAY(uint32_t, card->points.triangle_count);
    uint32_t *of_vertex = TL_NEW_ARRAY(uint32_t, card->points.vertex_count);
    size_t first = 0;
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        for (uint32_t t = 0; t < surface->index_count / 3; t++) {
            const uint32_t part = (uint32_t)tl_shade_part_at(request->materials, surface, s, t);
            const struct tl_shade_part *of = &request->materials->parts[part];
            of_triangle[ranges->first[s] + t] = part | (uint32_t)s << 12 | kinds[part] << 16 |
                                                (of->material->openness > 0 ? CARD_IS_OPEN : 0) |
                                                (of->transmits ? CARD_TRANSMITS : 0);
            for (size_t k = 0; k < 3; k++)
                of_vertex[first + surface->indices[(size_t)3 * t + k]] = part;
        }
        first += surface->vertex_count;
    }
    bool fine = tl_buffer_fill(&card->buffers[CARD_TRIANGLE_PARTS], card->gpu, of_triangle,
                               card->points.triangle_count * sizeof *of_triangle, error) &&
                tl_buffer_fill(&card->buffers[CARD_VERTEX_PARTS], card->gpu, of_vertex,
                               card->points.vertex_count * sizeof *of_vertex, error);
    free(of_triangle);
    free(of_vertex);
    return fine;
}

bool tl_card_send_materials(tl_graphics_card *card, const struct tl_card_surfaces *request, tl_error *error)
{
    const struct tl_shade_materials *materials = request->materials;
    const struct tl_triangle_ranges *ranges = request->ranges;
    const size_t count = materials->first_parts[materials->surface_count];
    tl_card_release_materials(card);
    card->layers = materials->openness > 0 ? TL_CARD_LAYERS : 1;
    struct card_part *parts = TL_NEW_ARRAY(struct card_part, count);
    uint32_t *kinds = TL_NEW_ARRAY(uint32_t, count);
    float(*albedos)[5][4] = tl_resize(NULL, count, sizeof *albedos);
    struct tl_bounce_material *bounced = tl_bounce_materials_read(ranges);
    bool fine = true;
    for (size_t s = 0; s < materials->surface_count; s++)
        for (size_t p = materials->first_parts[s]; fine && p < materials->first_parts[s + 1]; p++) {
            const bool is_ground = request->ground && s + 1 == materials->surface_count;
            const int kind = class_of(card, &materials->parts[p], error);
            fine = kind >= 0;
            kinds[p] = (uint32_t)kind;
            fill_part(materials, &materials->parts[p], is_ground, ranges->first[s], &parts[p]);
            fill_albedos(&bounced[p], albedos[p]);
        }
    fine = fine && send_tables(card, materials, parts, error) &&
           tl_buffer_fill(&card->buffers[CARD_PARTS], card->gpu, parts, count * sizeof *parts, error) &&
           tl_buffer_fill(&card->buffers[CARD_ALBEDOS], card->gpu, albedos, count * sizeof *albedos, error) &&
           send_triangle_parts(card, request, kinds, error);
    free(parts);
    free(kinds);
    free(albedos);
    free(bounced);
    return fine;
}
