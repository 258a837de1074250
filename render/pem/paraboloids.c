#include "render/pem/paraboloids.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* At the centre of a chart p changes half as fast as the angle, so that a texel of a face, 2 / size wide at
 * its centre, is as wide as one of `size` a unit of p. Maps are this many times as dense there, and 1.3 times
 * that at the corners. */
#define DENSITY 2

/* Levels of at most so many texels a face fill their charts: hats are wider than what find_crop follows them
 * by. */
#define WHOLE_SIZE 4

/* A chart ends there: tan(22.5 degrees). */
#define BORDER 0.41421356f

int tl_paraboloid_density(int size, int level)
{
    return DENSITY * (size >> level);
}

static vec3s unproject(int chart, float x, float y)
{
    float square = x * x + y * y, scale = 1 / (1 + square);
    int axis = chart / 2;
    vec3s d;
    d.raw[axis] = (chart % 2 ? square - 1 : 1 - square) * scale;
    d.raw[axis == 0 ? 1 : 0] = 2 * x * scale;
    d.raw[axis == 2 ? 1 : 2] = 2 * y * scale;
    return d;
}

/* The point in any chart, also beyond its border. */
static void project(vec3s direction, int chart, float p[2])
{
    int axis = chart / 2;
    float above = fmaxf(1 + (chart % 2 ? -direction.raw[axis] : direction.raw[axis]), 1e-6f);
    p[0] = direction.raw[axis == 0 ? 1 : 0] / above;
    p[1] = direction.raw[axis == 2 ? 1 : 2] / above;
}

int tl_paraboloid_project(vec3s direction, float p[2])
{
    float x = fabsf(direction.x), y = fabsf(direction.y), z = fabsf(direction.z);
    int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    int chart = 2 * axis + (direction.raw[axis] < 0);
    project(direction, chart, p);
    return chart;
}

static bool is_lit(const tl_cube *cube, size_t texel)
{
    const float *colour = cube->texels + 3 * texel;
    return colour[0] != 0 || colour[1] != 0 || colour[2] != 0;
}

/* A box in the plane of p. */
struct plane_box {
    float low[2], high[2]; /* empty when low > high */
};
static const struct plane_box empty = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

/* Adds the part of a chart that the hat of a texel covers: it ends at the centres of its neighbours. (Across
 * an edge of the cube it ends a little elsewhere than on the continued plane of the face; see MARGIN.) What
 * lies beyond `border` is pulled in to it. */
static void add_hat(int size, int texel, int chart, float border, struct plane_box *box)
{
    int face = texel / (size * size), y = texel / size % size, x = texel % size;
    struct plane_box hat = empty;
    bool within = false;
    for (int i = 0; i < 9; i++) {
        float s = ((float)(x + i % 3) - 0.5f) / (float)size, t = ((float)(y + i / 3) - 0.5f) / (float)size,
              p[2];
        project(glms_vec3_normalize(tl_cube_direction(face, s, t)), chart, p);
        within = within || (fabsf(p[0]) < border && fabsf(p[1]) < border);
        for (int axis = 0; axis < 2; axis++) {
            float place = fminf(fmaxf(p[axis], -border), border);
            hat.low[axis] = fminf(hat.low[axis], place);
            hat.high[axis] = fmaxf(hat.high[axis], place);
        }
    }
    for (int axis = 0; axis < 2 && within; axis++) {
        box->low[axis] = fminf(box->low[axis], hat.low[axis]);
        box->high[axis] = fmaxf(box->high[axis], hat.high[axis]);
    }
}

/* Lattice texels that a box is widened by. */
#define MARGIN 0.1f

static int clamp_index(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* Charts are those of the faces, in their order. Hats of texels that lie within a face end before its border.
 */
static bool may_reach(int size, int texel, int chart)
{
    int x = texel % size, y = texel / size % size;
    bool within = x >= 2 && y >= 2 && x < size - 2 && y < size - 2;
    return !within || size <= WHOLE_SIZE || texel / (size * size) == chart;
}

static struct tl_paraboloid_crop find_crop(const tl_cube *level, int density, int chart)
{
    const float scale = (float)density, border = BORDER + 1.5f / scale;
    struct plane_box box = empty;
    for (int i = 0; i < 6 * level->size * level->size; i++) {
        if (!may_reach(level->size, i, chart) || !is_lit(level, (size_t)i))
            continue;
        if (level->size <= WHOLE_SIZE)
            box = (struct plane_box){{-border, -border}, {border, border}};
        else
            add_hat(level->size, i, chart, border, &box);
    }
    if (box.low[0] > box.high[0])
        return (struct tl_paraboloid_crop){0};
    /* The last texels whose centres lie outside of the box, on each side; or the lattice's. */
    int first[2], last[2], limit = (int)ceilf(BORDER * scale - 0.5f);
    for (int axis = 0; axis < 2; axis++) {
        first[axis] = clamp_index((int)floorf(box.low[axis] * scale - 0.5f - MARGIN), -limit - 1, limit);
        last[axis] = clamp_index((int)ceilf(box.high[axis] * scale - 0.5f + MARGIN), -limit - 1, limit);
    }
    return (struct tl_paraboloid_crop){
        .x0 = first[0], .y0 = first[1], .width = last[0] - first[0] + 1, .height = last[1] - first[1] + 1};
}

struct tl_paraboloid tl_paraboloid_place(const struct tl_chain *chain)
{
    struct tl_paraboloid map = {.level_count = chain->level_count};
    assert(chain->level_count <= TL_PARABOLOID_LEVELS_MAX);
    for (int level = 0; level < chain->level_count; level++)
        for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++)
            map.crops[level][chart] =
                find_crop(&chain->levels[level], tl_paraboloid_density(chain->levels[0].size, level), chart);
    return map;
}

float *tl_paraboloid_sample(const struct tl_paraboloid *map, const struct tl_chain *chain, int level,
                            int chart)
{
    const struct tl_paraboloid_crop *crop = &map->crops[level][chart];
    if (crop->width == 0)
        return NULL;
    float density = (float)tl_paraboloid_density(chain->levels[0].size, level);
    float *texels = TL_NEW_ARRAY(float, 3 * (size_t)crop->width * (size_t)crop->height);
    for (int y = 0; y < crop->height; y++)
        for (int x = 0; x < crop->width; x++) {
            vec3s d = unproject(chart, ((float)(crop->x0 + x) + 0.5f) / density,
                                ((float)(crop->y0 + y) + 0.5f) / density);
            vec3s colour = tl_cube_sample(&chain->levels[level], d);
            memcpy(texels + 3 * ((size_t)y * (size_t)crop->width + (size_t)x), colour.raw, sizeof colour.raw);
        }
    return texels;
}

vec3s tl_paraboloid_fetch(const struct tl_paraboloid_crop *crop, int density, const float *texels,
                          const float p[2])
{
    float x = p[0] * (float)density - (float)crop->x0 - 0.5f;
    float y = p[1] * (float)density - (float)crop->y0 - 0.5f;
    vec3s colour = {{0, 0, 0}};
    if (!(x >= 0 && y >= 0 && x < (float)(crop->width - 1) && y < (float)(crop->height - 1)))
        return colour;
    int column = (int)x, row = (int)y;
    float right = x - (float)column, below = y - (float)row;
    const float *top = texels + 3 * ((size_t)row * (size_t)crop->width + (size_t)column);
    const float *bottom = top + 3 * (size_t)crop->width;
    for (int c = 0; c < 3; c++) {
        float upper = top[c] + right * (top[c + 3] - top[c]);
        float lower = bottom[c] + right * (bottom[c + 3] - bottom[c]);
        colour.raw[c] = upper + below * (lower - upper);
    }
    return colour;
}

void tl_paraboloid_resample(const struct tl_paraboloid_crop *crop, int density, const float *texels,
                            int chart, const tl_cube *out)
{
    for (int i = 0; i < 6 * out->size * out->size; i++) {
        float p[2];
        if (tl_paraboloid_project(tl_cube_texel_direction(out->size, i), p) != chart)
            continue;
        vec3s colour = tl_paraboloid_fetch(crop, density, texels, p);
        memcpy(out->texels + 3 * (size_t)i, colour.raw, sizeof colour.raw);
    }
}

static int compare_heights(const void *a, const void *b)
{
    const struct tl_paraboloid_crop *first = *(struct tl_paraboloid_crop *const *)a;
    const struct tl_paraboloid_crop *second = *(struct tl_paraboloid_crop *const *)b;
    return second->height != first->height ? second->height - first->height : second->width - first->width;
}

/* Packs crops in rows, the tallest first. Returns the height that they take. */
static int pack_rows(struct tl_paraboloid_crop *const *crops, size_t count, int width)
{
    int x = 0, y = 0, row_height = 0;
    for (size_t i = 0; i < count; i++) {
        if (x + crops[i]->width > width) {
            x = 0;
            y += row_height;
            row_height = 0;
        }
        crops[i]->atlas_x = x;
        crops[i]->atlas_y = y;
        x += crops[i]->width;
        row_height = crops[i]->height > row_height ? crops[i]->height : row_height;
    }
    return y + row_height;
}

void tl_paraboloids_pack(struct tl_paraboloid *maps, int count, int *width, int *height)
{
    size_t crop_count = 0, texels = 0;
    int widest = 1;
    struct tl_paraboloid_crop **crops = TL_NEW_ARRAY(
        struct tl_paraboloid_crop *, (size_t)count * TL_PARABOLOID_LEVELS_MAX * TL_PARABOLOID_CHARTS);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < maps[i].level_count * TL_PARABOLOID_CHARTS; k++) {
            struct tl_paraboloid_crop *crop =
                &maps[i].crops[k / TL_PARABOLOID_CHARTS][k % TL_PARABOLOID_CHARTS];
            if (crop->width == 0)
                continue;
            crops[crop_count++] = crop;
            texels += (size_t)crop->width * (size_t)crop->height;
            widest = crop->width > widest ? crop->width : widest;
        }
    qsort(crops, crop_count, sizeof(struct tl_paraboloid_crop *), compare_heights);
    /* The width of the smallest texture, among those that are at most twice as wide as a square one. */
    int limit = widest + (int)(2 * sqrt((double)texels)), best = widest;
    size_t minimum = SIZE_MAX;
    for (int tried = widest; tried <= limit; tried++) {
        size_t area = (size_t)tried * (size_t)pack_rows(crops, crop_count, tried);
        if (area < minimum) {
            minimum = area;
            best = tried;
        }
    }
    *width = best;
    *height = pack_rows(crops, crop_count, best);
    *height = *height > 0 ? *height : 1;
    free(crops);
}
