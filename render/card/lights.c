#include "render/card/card_internal.h"

#include "config/base/memory.h"
#include "render/shade/pixel_lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Atlases of lobe maps ---- */

#define ATLAS_WIDTH 2048

/* Places the maps in rows; `diffuse_gain` is the last. Returns the height. */
static int place_maps(const struct tl_lobe_map *const maps[TL_CARD_LOBE_MAPS],
                      float places[TL_CARD_LOBE_MAPS][4])
{
    int x = 0, y = 0, row = 0, height = 1;
    for (int i = 0; i < TL_CARD_LOBE_MAPS; i++) {
        if (!maps[i])
            continue;
        const int side = maps[i]->side + 2;
        if (x + side > ATLAS_WIDTH) {
            x = 0;
            y += row;
            row = 0;
        }
        tl_card_put(places[i], (vec3s){{(float)x, (float)y, (float)maps[i]->side}}, 0);
        x += side;
        row = side > row ? side : row;
        height = y + row;
    }
    return height;
}

static void fill_atlas(tl_graphics_card *card, const struct tl_lobe_map *const maps[TL_CARD_LOBE_MAPS],
                       float places[TL_CARD_LOBE_MAPS][4], tl_texture *atlas)
{
    const int height = place_maps(maps, places);
    tl_card_fit_texture(card, atlas, GL_RGBA16F, ATLAS_WIDTH, height);
    glTextureParameteri(atlas->id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(atlas->id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (int i = 0; i < TL_CARD_LOBE_MAPS; i++)
        if (maps[i])
            glTextureSubImage2D(atlas->id, 0, (int)places[i][0], (int)places[i][1], maps[i]->side + 2,
                                maps[i]->side + 2, GL_RGBA, GL_FLOAT, maps[i]->texels);
}

/* Both atlases have the same maps at the same places: where there is no gain, the light itself. */
static void send_lobes(tl_graphics_card *card, const struct tl_card_light *request)
{
    const struct tl_lobe_map *light[TL_CARD_LOBE_MAPS] = {0}, *gains[TL_CARD_LOBE_MAPS] = {0};
    for (int i = 0; i <= TL_EXPONENT_COUNT; i++) {
        const struct tl_lobe_map *map = &request->lobes->maps[i], *gain = &request->lights->gain.maps[i];
        light[i] = map->side > 0 ? map : NULL;
        gains[i] = gain->side > 0 && gain->side == map->side ? gain : light[i];
    }
    const struct tl_lobe_map *diffuse = &request->lights->diffuse_gain.maps[0];
    light[TL_CARD_LOBE_MAPS - 1] = gains[TL_CARD_LOBE_MAPS - 1] = diffuse->side > 0 ? diffuse : light[0];
    fill_atlas(card, light, card->frame.lobe_maps, &card->lobe_atlas);
    fill_atlas(card, gains, card->frame.lobe_maps, &card->gain_atlas);
}

static bool send_blends(tl_graphics_card *card, tl_error *error)
{
    float blends[LOBE_BLENDS + 1][2] = {{0}}; /* an even number */
    for (int i = 0; i < LOBE_BLENDS; i++) {
        const struct tl_exponent_blend blend = tl_exponent_blend(exp2f((float)i / LOBE_BLEND_STEPS));
        blends[i][0] = (float)blend.index;
        blends[i][1] = blend.weight;
    }
    return tl_buffer_fill(&card->blends, card->gpu, blends, sizeof blends, error);
}

/* ---- Regions and suns ---- */

static bool send_regions(tl_graphics_card *card, const struct tl_card_light *request, tl_error *error)
{
    float regions[TL_REGIONS_MAX][2][4];
    const int count = request->regions->count;
    for (int i = 0; i < count; i++) {
        const struct tl_region_group *group = &request->lights->groups[i / TL_LANES];
        const int k = i % TL_LANES;
        tl_card_put(regions[i][0], (vec3s){{group->x[k], group->y[k], group->z[k]}}, group->sine[k]);
        tl_card_put(regions[i][1], (vec3s){{group->power[0][k], group->power[1][k], group->power[2][k]}},
                    group->spread[k]);
    }
    return tl_buffer_fill(&card->buffers[CARD_REGIONS], card->gpu, regions, (size_t)count * sizeof regions[0],
                          error);
}

/* The number of the sample of a sun that lies farthest from those of `order` before it. */
static int farthest_sample(const struct tl_sun *sun, const int *order, int before)
{
    int best = 0;
    float farthest = -1;
    for (int i = 0; i < sun->sample_count; i++) {
        float nearest = before == 0 ? glms_vec3_distance(sun->samples[i], sun->direction) : INFINITY;
        if (before == 0)
            nearest = -nearest; /* the first one lies in the middle */
        for (int k = 0; k < before; k++)
            nearest = fminf(nearest, glms_vec3_distance(sun->samples[i], sun->samples[order[k]]));
        if (i == 0 || nearest > farthest) {
            farthest = nearest;
            best = i;
        }
    }
    return best;
}

void tl_card_place_lights(tl_graphics_card *card, const struct tl_suns *suns, float yaw,
                          const struct tl_lamp *lamps, size_t lamp_count)
{
    struct tl_card_frame *frame = &card->frame;
    struct tl_pixel_lights lights;
    tl_pixel_lights_make(suns, yaw, lamps, lamp_count, &lights);
    frame->counts[1] = lights.count;
    for (int i = 0; i < lights.count; i++) {
        const struct tl_sun *sun = &lights.items[i].sun;
        const struct tl_lamp *lamp = &lights.items[i].lamp;
        const bool is_near = lamp->kind == TL_LAMP_POINT;
        tl_card_put(frame->suns[i], is_near ? lamp->position : sun->direction,
                    lamp->kind == TL_LAMP_NONE ? sun->radius : -1);
        tl_card_put(frame->sun_powers[i], sun->power, is_near);
        if (lamp->kind != TL_LAMP_NONE)
            continue;
        const int places = sun->sample_count < 9 ? sun->sample_count : 9;
        int order[9];
        for (int k = 0; k < places; k++)
            order[k] = farthest_sample(sun, order, k);
        for (int k = 0; k < TL_CARD_PLACES; k++)
            tl_card_put(frame->sun_places[i][k],
                        places > 0 ? sun->samples[order[k % places]] : sun->direction, 0);
    }
}

bool tl_card_send_light(tl_graphics_card *card, const struct tl_card_light *request, tl_error *error)
{
    struct tl_card_frame *frame = &card->frame;
    const int count = request->regions->count;
    if (!card->have_light || card->light_revision != request->light_revision) {
        card->have_light = false;
        if (!send_regions(card, request, error) || !send_blends(card, error))
            return false;
        send_lobes(card, request);
        card->have_light = true;
        card->light_revision = request->light_revision;
    }
    frame->turn[0] = cosf(request->environment_yaw);
    frame->turn[1] = sinf(request->environment_yaw);
    frame->counts[0] = count;
    tl_card_place_lights(card, request->suns, request->environment_yaw, request->lamps, request->lamp_count);
    return true;
}

/* ---- The sky as bounces see it ---- */

bool tl_card_send_sky(tl_graphics_card *card, const struct tl_card_bounce *request, tl_error *error)
{
    const bool is_new = card->sky.revision != request->cube_revision || !card->sky.cube.texels;
    if (!is_new && card->buffers[CARD_SKY].id != 0)
        return true;
    tl_bounce_sky_follow(&card->sky, request->cube, request->cube_revision);
    const size_t count = 6 * (size_t)card->sky.cube.size * (size_t)card->sky.cube.size;
    float(*texels)[4] = tl_resize(NULL, count, sizeof *texels);
    for (size_t i = 0; i < count; i++) {
        memcpy(texels[i], card->sky.cube.texels + 3 * i, 3 * sizeof(float));
        texels[i][3] = (float)card->sky.sums[i + 1];
    }
    bool fine = tl_buffer_fill(&card->buffers[CARD_SKY], card->gpu, texels, count * sizeof *texels, error);
    free(texels);
    return fine;
}

void tl_card_release_light(tl_graphics_card *card)
{
    tl_texture_destroy(&card->lobe_atlas);
    tl_texture_destroy(&card->gain_atlas);
    tl_bounce_sky_release(&card->sky);
}
