#include "render/pem/slice_maps.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXPONENTS (TL_EXPONENT_COUNT + 1)

/* The same numbers as in slices.glsl. */
#define MAPS_UNIT      10
#define FRAMES_BINDING 1

/* The largest number of RGB9_E5 [GL 4.5, 8.5.2]. */
#define STORED_MAX 65408.0f

/* struct SliceFrame of slices.glsl, std430. */
struct gpu_frame {
    vec4s right, up, direction;
    float scale[EXPONENTS];
};

struct slice_place {
    int x, y;
};

/* Packs the squares in rows, large ones first, into a strip of the given width. Returns its height. */
static int pack(const struct tl_slices *slices, int width, struct slice_place places[EXPONENTS])
{
    int x = 0, y = 0, row_height = 0;
    for (int k = EXPONENTS - 1; k >= 0;
         k--) { /* sides grow with the exponent, except that of the environment itself */
        int side = slices->made & 1u << k ? slices->side[k] : 0;
        if (x + side > width) {
            x = 0;
            y += row_height;
            row_height = 0;
        }
        places[k] = (struct slice_place){x, y};
        x += side;
        row_height = side > row_height ? side : row_height;
    }
    return y + row_height;
}

/* The width of the strip with the smallest area. */
static int choose_width(const struct tl_slices *slices)
{
    int widest = 1, sum = 0, best = 0, minimum = 0;
    for (int k = 0; k < EXPONENTS; k++) {
        int side = slices->made & 1u << k ? slices->side[k] : 0;
        widest = side > widest ? side : widest;
        sum += side;
    }
    for (int width = widest; width <= sum; width++) {
        struct slice_place places[EXPONENTS];
        int area = width * pack(slices, width, places);
        if (best == 0 || area < minimum) {
            best = width;
            minimum = area;
        }
    }
    return best;
}

/* The smallest power of two that scales every texel into range. */
static float storage_scale(const struct tl_slices *slices)
{
    float peak = 0;
    for (int k = 0; k < EXPONENTS; k++) {
        size_t count = 3 * (size_t)slices->side[k] * (size_t)slices->side[k] * (size_t)slices->region_count;
        for (size_t i = 0; slices->made & 1u << k && i < count; i++)
            peak = slices->texels[k][i] > peak ? slices->texels[k][i] : peak;
    }
    int exponent = 0;
    if (peak > STORED_MAX)
        frexpf(peak / STORED_MAX, &exponent);
    return ldexpf(1, exponent);
}

static void upload_texels(const tl_texture *texture, const struct tl_slices *slices, int k,
                          struct slice_place place, float scale)
{
    size_t count = 3 * (size_t)slices->side[k] * (size_t)slices->side[k] * (size_t)slices->region_count;
    float *scaled = NULL;
    if (scale > 1) { /* rare: a sun that was not extracted */
        scaled = TL_NEW_ARRAY(float, count);
        for (size_t i = 0; i < count; i++)
            scaled[i] = slices->texels[k][i] / scale;
    }
    glTextureSubImage3D(texture->id, 0, place.x, place.y, 0, slices->side[k], slices->side[k],
                        slices->region_count, GL_RGB, GL_FLOAT, scaled ? scaled : slices->texels[k]);
    free(scaled);
}

static vec4s with_zero(vec3s v)
{
    return (vec4s){{v.x, v.y, v.z, 0}};
}

static void upload_frames(unsigned buffer, const struct tl_slices *slices,
                          const struct slice_place places[EXPONENTS], float scale)
{
    vec4s table[EXPONENTS];
    for (int k = 0; k < EXPONENTS; k++)
        table[k] = (vec4s){{(float)places[k].x, (float)places[k].y, (float)slices->side[k], scale}};
    size_t count = (size_t)slices->region_count;
    struct gpu_frame *frames = TL_NEW_ARRAY(struct gpu_frame, count);
    for (size_t i = 0; i < count; i++) {
        const struct tl_slice_frame *frame = &slices->frames[i];
        frames[i] = (struct gpu_frame){.right = with_zero(frame->right),
                                       .up = with_zero(frame->up),
                                       .direction = with_zero(frame->direction)};
        memcpy(frames[i].scale, frame->scale, sizeof frame->scale);
    }
    GLsizeiptr head = sizeof table, body = (GLsizeiptr)(count * sizeof *frames);
    glNamedBufferData(buffer, head + body, NULL, GL_DYNAMIC_DRAW);
    glNamedBufferSubData(buffer, 0, head, table);
    glNamedBufferSubData(buffer, head, body, frames);
    free(frames);
}

void tl_slice_maps_upload(struct tl_slice_maps *maps, tl_gpu *gpu, const struct tl_slices *slices)
{
    struct slice_place places[EXPONENTS];
    int width = choose_width(slices), height = pack(slices, width, places);
    if (maps->texture.width != width || maps->texture.height != height ||
        maps->texture.layers != slices->region_count) {
        tl_texture_destroy(&maps->texture);
        maps->texture =
            tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_RGB9_E5, width, height, slices->region_count, 1);
    }
    float scale = storage_scale(slices);
    for (int k = 0; k < EXPONENTS; k++)
        if (slices->made & 1u << k)
            upload_texels(&maps->texture, slices, k, places[k], scale);
    if (!maps->frames)
        glCreateBuffers(1, &maps->frames);
    upload_frames(maps->frames, slices, places, scale);
}

void tl_slice_maps_bind(const struct tl_slice_maps *maps)
{
    glBindTextureUnit(MAPS_UNIT, maps->texture.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, FRAMES_BINDING, maps->frames);
}

void tl_slice_maps_release(struct tl_slice_maps *maps)
{
    tl_texture_destroy(&maps->texture);
    if (maps->frames)
        glDeleteBuffers(1, &maps->frames);
    *maps = (struct tl_slice_maps){0};
}

size_t tl_slice_maps_bytes(const struct tl_slice_maps *maps)
{
    return tl_texture_bytes(&maps->texture);
}
