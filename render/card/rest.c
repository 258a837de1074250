#include "render/card/card_internal.h"

#include "config/base/memory.h"
#include "render/reference/sky.h"

#include <math.h>
#include <stdlib.h>

/* Radiance and pdf of a texel at a place of the curve, and the texel with the share of all before it. */
static void put_texel(const struct tl_sky *sky, size_t place, float texels[][4], uint32_t curve[][2])
{
    const tl_image *image = &sky->environment->image;
    const uint32_t texel = sky->order[place];
    const size_t width = (size_t)image->width;
    const double share = sky->before[place + 1] - sky->before[place];
    const double angle = sky->environment->layout == TL_ENV_CUBE ? 4.0 / ((double)image->width * image->width)
                                                                 : sky->row_angles[texel / width];
    const float *rgb = tl_image_floats(image) + 3 * (size_t)texel;
    tl_card_put(texels[texel], (vec3s){{rgb[0], rgb[1], rgb[2]}}, (float)(share / angle));
    curve[place][0] = texel;
    curve[place][1] = (uint32_t)fmin(sky->before[place] * 0x1p32, 0x1p32 - 1);
}

static void send_sky(tl_graphics_card *card, const struct tl_card_rest *request)
{
    if (card->sky_texels.id != 0 && card->sky_revision == request->environment_revision)
        return;
    struct tl_sky sky;
    tl_sky_make(request->environment, 0, &sky);
    float(*texels)[4] = tl_resize(NULL, sky.texel_count, sizeof *texels);
    uint32_t(*curve)[2] = tl_resize(NULL, sky.texel_count, sizeof *curve);
    for (size_t i = 0; i < sky.texel_count; i++)
        put_texel(&sky, i, texels, curve);
    const int width = request->environment->image.width, height = request->environment->image.height;
    tl_card_fit_texture(card, &card->sky_texels, GL_RGBA32F, width, height);
    tl_card_fit_texture(card, &card->sky_curve, GL_RG32UI, width, height);
    glTextureSubImage2D(card->sky_texels.id, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels);
    glTextureSubImage2D(card->sky_curve.id, 0, 0, 0, width, height, GL_RG_INTEGER, GL_UNSIGNED_INT, curve);
    card->sky_revision = request->environment_revision;
    free(texels);
    free(curve);
    tl_sky_release(&sky);
}

/* Lights the places of one class of materials that paths have come to after so many bounces. */
static void light_class(tl_graphics_card *card, const struct tl_card_rest *request, int class, int bounces)
{
    const bool is_rich = class > 1;
    glUseProgram(is_rich ? card->rest_rich.id : card->rest_plain.id);
    if (is_rich)
        tl_card_bind_class(card, &card->classes[class]);
    glUniform4i(0, class, bounces, request->bounces, request->round);
    glUniform2f(1, 1 / (float)request->footprint, (float)card->traced_triangles);
    glUniform1i(2, request->environment->layout == TL_ENV_CUBE);
    glUniform1i(3, card->layers);
    tl_gpu_dispatch((unsigned)card->frame.size[2], (unsigned)card->frame.size[3], 1);
    tl_gpu_barrier();
}

bool tl_card_draw_round(tl_graphics_card *card, const struct tl_card_rest *request, const tl_texture *image,
                        tl_error *error)
{
    enum { PATH_BYTES = 48 };
    const int32_t *size = card->frame.size;
    const size_t samples = (size_t)size[0] * (size_t)size[1];
    card->frame.turn[0] = cosf(request->environment_yaw);
    card->frame.turn[1] = sinf(request->environment_yaw);
    const struct tl_suns none = {0}; /* suns are in the environment's texels */
    tl_card_place_lights(card, &none, 0, request->lamps, request->lamp_count);
    if (!tl_buffer_reserve(&card->buffers[CARD_PATHS], card->gpu, PATH_BYTES * samples, error) ||
        !tl_card_send_frame(card, error))
        return false;
    send_sky(card, request);
    tl_card_fit_texture(card, &card->round, GL_RGBA32F, size[0], size[1]);
    glBindTextureUnit(0, card->ids[0].id);
    glBindTextureUnit(6, card->sky_texels.id);
    glBindTextureUnit(7, card->sky_curve.id);
    glBindImageTexture(0, card->round.id, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    for (int layer = 1; layer < card->layers; layer++)
        glBindImageTexture((GLuint)layer, card->ids[layer].id, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32UI);
    for (int bounces = 0; bounces <= request->bounces; bounces++)
        for (int class = bounces > 0; class < card->class_count; class ++)
            light_class(card, request, class, bounces);
    tl_card_resolve(card, &card->round, image, request->round);
    return true;
}
