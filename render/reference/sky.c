#include "render/reference/sky.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"

#include <math.h>
#include <stdlib.h>

#define BRIGHT_SHARE                                                                                         \
    0.9 /* of the samples; the others are uniform, for dim light on points that face away from the bright    \
           one */

/* Hilbert's curve over a square, from `corner` along `a`, in half texels. Texels outside of the map (or the
 * face of a cube) are skipped. */
struct walk {
    int width, height;    /* of the map or face, texels */
    uint32_t first, line; /* index of its first texel; increment per row */
    uint32_t *next;
};

static bool reaches(const struct walk *walk, int x, int y, int across_x, int across_y)
{
    int lower_x = across_x < 0 ? x + across_x : x, lower_y = across_y < 0 ? y + across_y : y;
    return lower_x < 2 * walk->width && lower_y < 2 * walk->height;
}

static void walk_square(struct walk *walk, int x, int y, int ax, int ay, int bx, int by)
{
    if (!reaches(walk, x, y, ax + bx, ay + by))
        return;
    if (abs(ax + ay) == 2) {
        uint32_t column = (uint32_t)(x + (ax + bx) / 2) / 2, row = (uint32_t)(y + (ay + by) / 2) / 2;
        *walk->next++ = walk->first + row * walk->line + column;
        return;
    }
    ax /= 2;
    ay /= 2;
    bx /= 2;
    by /= 2;
    walk_square(walk, x, y, bx, by, ax, ay);
    walk_square(walk, x + ax, y + ay, ax, ay, bx, by);
    walk_square(walk, x + ax + bx, y + ay + by, ax, ay, bx, by);
    walk_square(walk, x + ax + 2 * bx, y + ay + 2 * by, -bx, -by, -ax, -ay);
}

static uint32_t *walk_map(uint32_t *next, int width, int height, uint32_t first)
{
    struct walk walk = {width, height, first, (uint32_t)width, next};
    int side = 2;
    while (side < 2 * width || side < 2 * height)
        side *= 2;
    walk_square(&walk, 0, 0, side, 0, 0, side);
    return walk.next;
}

static bool is_cube(const struct tl_sky *sky)
{
    return sky->environment->layout == TL_ENV_CUBE;
}

static const float *texel_of(const struct tl_sky *sky, size_t texel)
{
    return tl_image_floats(&sky->environment->image) + 3 * texel;
}

static double brightness_of(const struct tl_sky *sky, size_t texel)
{
    const float *rgb = texel_of(sky, texel);
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
}

static double solid_angle_of(const struct tl_sky *sky, size_t texel)
{
    int width = sky->environment->image.width, x = (int)(texel % (size_t)width);
    int y = (int)(texel / (size_t)width);
    return is_cube(sky) ? (double)tl_cube_solid_angle(width, x, y % width) : sky->row_angles[y];
}

/* Mean pdf over a texel, per sr. */
static double pdf_of(const struct tl_sky *sky, size_t texel)
{
    const double uniform = 1 / (4 * M_PI);
    if (!(sky->brightness > 0))
        return uniform;
    return BRIGHT_SHARE * brightness_of(sky, texel) / sky->brightness + (1 - BRIGHT_SHARE) * uniform;
}

static void measure_rows(struct tl_sky *sky)
{
    const tl_image *image = &sky->environment->image;
    sky->row_angles = TL_NEW_ARRAY(double, (size_t)image->height);
    for (int y = 0; y < image->height; y++)
        sky->row_angles[y] =
            2 * M_PI / image->width * (cos(M_PI * y / image->height) - cos(M_PI * (y + 1) / image->height));
}

static void sum_shares(struct tl_sky *sky)
{
    for (size_t i = 0; i < sky->texel_count; i++)
        sky->brightness += brightness_of(sky, i) * solid_angle_of(sky, i);
    sky->before = TL_NEW_ARRAY(double, sky->texel_count + 1);
    for (size_t i = 0; i < sky->texel_count; i++)
        sky->before[i + 1] = sky->before[i] + pdf_of(sky, sky->order[i]) * solid_angle_of(sky, sky->order[i]);
    double total = sky->before[sky->texel_count]; /* 1 except for rounding */
    for (size_t i = 0; i <= sky->texel_count; i++)
        sky->before[i] /= total;
}

static void guide_search(struct tl_sky *sky)
{
    sky->guide = TL_NEW_ARRAY(uint32_t, TL_SKY_GUIDES + 1);
    uint32_t place = 0;
    for (size_t i = 0; i <= TL_SKY_GUIDES; i++) {
        while (place + 1 < sky->texel_count && sky->before[place + 1] <= (double)i / TL_SKY_GUIDES)
            place++;
        sky->guide[i] = place;
    }
}

void tl_sky_make(const tl_environment *environment, float yaw, struct tl_sky *out)
{
    const tl_image *image = &environment->image;
    *out = (struct tl_sky){.environment = environment,
                           .turn_cos = cosf(yaw),
                           .turn_sin = sinf(yaw),
                           .texel_count = (size_t)image->width * (size_t)image->height};
    out->order = TL_NEW_ARRAY(uint32_t, out->texel_count);
    if (is_cube(out)) {
        uint32_t *next = out->order;
        for (uint32_t face = 0; face < 6; face++)
            next = walk_map(next, image->width, image->width,
                            face * (uint32_t)image->width * (uint32_t)image->width);
    } else {
        walk_map(out->order, image->width, image->height, 0);
        measure_rows(out);
    }
    sum_shares(out);
    guide_search(out);
}

void tl_sky_release(struct tl_sky *sky)
{
    free(sky->row_angles);
    free(sky->order);
    free(sky->before);
    free(sky->guide);
    *sky = (struct tl_sky){0};
}

/* The pdf at a point of a cube face. An area dA of the face at distance 1 subtends dA / |p|^3 [area of a
 * face: 4], so uniform sampling of the texel in the plane is not uniform in solid angle. */
static double cube_pdf(const struct tl_sky *sky, size_t texel, vec3s on_face)
{
    const double size = sky->environment->image.width, area = 4 / (size * size);
    const float square = glms_vec3_norm2(on_face);
    return pdf_of(sky, texel) * solid_angle_of(sky, texel) / area * (double)cube_stretch(square);
}

static struct tl_sky_sample sample_of(const struct tl_sky *sky, size_t texel, vec3s world, double pdf)
{
    const float *rgb = texel_of(sky, texel);
    return (struct tl_sky_sample){world, {{rgb[0], rgb[1], rgb[2]}}, (float)pdf};
}

static struct tl_sky_sample sample_cube(const struct tl_sky *sky, size_t texel, double x, double y)
{
    size_t size = (size_t)sky->environment->image.width;
    double s = ((double)(texel % size) + x) / (double)size;
    double t = ((double)(texel / size % size) + y) / (double)size;
    vec3s on_face = tl_cube_direction((int)(texel / size / size), (float)s, (float)t);
    return sample_of(sky, texel,
                     turned_direction(sky->turn_cos, -sky->turn_sin, glms_vec3_normalize(on_face)),
                     cube_pdf(sky, texel, on_face));
}

static struct tl_sky_sample sample_latlong(const struct tl_sky *sky, size_t texel, double x, double y)
{
    const tl_image *image = &sky->environment->image;
    const size_t width = (size_t)image->width;
    const vec3s direction = latlong_direction((float)(((double)(texel % width) + x) / image->width),
                                              (int)(texel / width), image->height, (float)y);
    return sample_of(sky, texel, turned_direction(sky->turn_cos, -sky->turn_sin, direction),
                     pdf_of(sky, texel));
}

struct tl_sky_sample tl_sky_sample_at(const struct tl_sky *sky, double share)
{
    size_t guide =
        (size_t)fmin(share * TL_SKY_GUIDES, TL_SKY_GUIDES - 1); /* a share may have been rounded to 1 */
    size_t low = sky->guide[guide], high = (size_t)sky->guide[guide + 1] + 1;
    while (high - low > 1) { /* before[low] <= share < before[high] */
        size_t middle = (low + high) / 2;
        if (sky->before[middle] <= share)
            low = middle;
        else
            high = middle;
    }
    /* The remainder of the share selects a point within the texel in Z order, so that a sun of one texel is
     * stratified, too. */
    double left = (share - sky->before[low]) / (sky->before[low + 1] - sky->before[low]);
    uint32_t bits = (uint32_t)fmin(fmax(left, 0) * 0x1p32, 0x1p32 - 1);
    const double x = (double)every_second_bit(bits), y = (double)every_second_bit(bits >> 1);
    size_t texel = sky->order[low];
    return is_cube(sky) ? sample_cube(sky, texel, x, y) : sample_latlong(sky, texel, x, y);
}

struct tl_sky_sample tl_sky_lookup(const struct tl_sky *sky, vec3s direction)
{
    const tl_image *image = &sky->environment->image;
    const vec3s d = turned_direction(sky->turn_cos, sky->turn_sin, direction);
    if (is_cube(sky)) {
        const int texel = cube_texel(d, image->width);
        const float major = fmaxf(fabsf(d.x), fmaxf(fabsf(d.y), fabsf(d.z)));
        return sample_of(sky, (size_t)texel, direction,
                         cube_pdf(sky, (size_t)texel, glms_vec3_divs(d, major)));
    }
    const vec2s place = latlong_place(d);
    const size_t texel = (size_t)texel_within(place.y, image->height) * (size_t)image->width +
                         (size_t)texel_within(place.x, image->width);
    return sample_of(sky, texel, direction, pdf_of(sky, texel));
}
