#include "render/pem/paraboloids.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A box in the plane of p. */
struct plane_box {
    float low[2], high[2]; /* empty when low > high */
};

static const struct plane_box box_empty = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

static void project(const struct tl_paraboloid *map, vec3s unit, float p[2])
{
    float above = fmaxf(1 + glms_vec3_dot(unit, map->direction), 1e-6f);
    p[0] = glms_vec3_dot(unit, map->right) / above;
    p[1] = glms_vec3_dot(unit, map->up) / above;
}

static vec3s unproject(const struct tl_paraboloid *map, float x, float y)
{
    float square = x * x + y * y, scale = 1 / (1 + square);
    vec3s d = glms_vec3_scale(map->direction, (1 - square) * scale);
    d = glms_vec3_muladds(map->right, 2 * x * scale, d);
    return glms_vec3_muladds(map->up, 2 * y * scale, d);
}

/* A face's own axes, or any about the region's direction. */
static void set_frame(const struct tl_region *region, struct tl_paraboloid *map)
{
    if (region->face < 0) {
        map->direction = region->direction;
        map->right = glms_vec3_normalize(glms_vec3_ortho(map->direction));
    } else {
        map->direction = tl_cube_direction(region->face, 0.5f, 0.5f);
        map->right = glms_vec3_sub(tl_cube_direction(region->face, 1, 0.5f), map->direction);
    }
    map->up = glms_vec3_cross(map->direction, map->right);
}

/* Adds the part of the sphere that the hat of a texel covers: it ends at the centres of its neighbours.
 * Across an edge of the cube it ends a little elsewhere than on the continued plane of the face; see MARGIN.
 */
static void add_hat(const struct tl_paraboloid *map, int size, int texel, struct plane_box *box)
{
    int face = texel / (size * size), y = texel / size % size, x = texel % size;
    for (int i = 0; i < 9; i++) {
        float s = ((float)(x + i % 3) - 0.5f) / (float)size, t = ((float)(y + i / 3) - 0.5f) / (float)size,
              p[2];
        project(map, glms_vec3_normalize(tl_cube_direction(face, s, t)), p);
        for (int axis = 0; axis < 2; axis++) {
            box->low[axis] = fminf(box->low[axis], p[axis]);
            box->high[axis] = fmaxf(box->high[axis], p[axis]);
        }
    }
}

static bool is_lit(const tl_cube *cube, size_t texel)
{
    const float *colour = cube->texels + 3 * texel;
    return colour[0] != 0 || colour[1] != 0 || colour[2] != 0;
}

float tl_paraboloid_density(int size, int level)
{
    return (float)(TL_PARABOLOID_DENSITY * (size >> level));
}

/* The half-angle by which a level reaches beyond the texels of the region: each step of the chain halves what
 * the level before reaches, in texels, and adds two; the last half texel is that of the hat. A texel at the
 * centre of a face is 2 / size wide. */
static float reach_of(int size, int level)
{
    float texels = 4 - ldexpf(4, -level) + 0.5f;
    return texels * 2 / (float)(size >> level);
}

/* Texels of a box that is widened by an angle on all sides; more than any cube has if it is too wide. */
static float widened_texels(const struct plane_box *box, float reach, float density)
{
    float texels = 1;
    for (int axis = 0; axis < 2; axis++) {
        float low = atanf(box->low[axis]) - reach / 2, high = atanf(box->high[axis]) + reach / 2;
        if (low < -1.4f || high > 1.4f)
            return INFINITY;
        texels *= (tanf(high) - tanf(low)) * density + 2;
    }
    return texels;
}

static struct plane_box *box_regions(const tl_cube *cube, const struct tl_regions *regions)
{
    struct plane_box *boxes = TL_NEW_ARRAY(struct plane_box, (size_t)regions->count);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < regions->count; i++) {
        struct tl_paraboloid map = {0};
        set_frame(&regions->items[i], &map);
        boxes[i] = box_empty;
        for (uint32_t k = regions->first[i]; k < regions->first[i + 1]; k++)
            if (is_lit(cube, regions->texels[k]))
                add_hat(&map, cube->size, (int)regions->texels[k], &boxes[i]);
    }
    return boxes;
}

int tl_paraboloid_levels(const tl_cube *cube, const struct tl_regions *regions)
{
    struct plane_box *boxes = box_regions(cube, regions);
    int level = 0;
    for (; level < TL_PARABOLOID_LEVELS_MAX && cube->size >> level > 1; level++) {
        float side = (float)(cube->size >> level), texels = 0;
        for (int i = 0; i < regions->count; i++)
            if (boxes[i].low[0] <= boxes[i].high[0])
                texels += widened_texels(&boxes[i], reach_of(cube->size, level),
                                         tl_paraboloid_density(cube->size, level));
        if (texels > 6 * side * side * (float)regions->count)
            break;
    }
    free(boxes);
    return level;
}

/* Lattice texels that a box is widened by before the black texels around it. */
#define MARGIN 0.1f

static struct tl_paraboloid_crop find_crop(const struct tl_paraboloid *map, const tl_cube *level,
                                           float density)
{
    struct plane_box box = box_empty;
    for (size_t i = 0; i < 6 * (size_t)level->size * (size_t)level->size; i++)
        if (is_lit(level, i))
            add_hat(map, level->size, (int)i, &box);
    if (box.low[0] > box.high[0])
        return (struct tl_paraboloid_crop){0};
    /* The last texels whose centres lie outside of the box, on each side. */
    int first[2], last[2];
    for (int axis = 0; axis < 2; axis++) {
        first[axis] = (int)floorf(box.low[axis] * density - 0.5f - MARGIN);
        last[axis] = (int)ceilf(box.high[axis] * density - 0.5f + MARGIN);
    }
    return (struct tl_paraboloid_crop){
        .x0 = first[0], .y0 = first[1], .width = last[0] - first[0] + 1, .height = last[1] - first[1] + 1};
}

struct tl_paraboloid tl_paraboloid_place(const struct tl_region *region, const struct tl_chain *chain,
                                         int levels)
{
    struct tl_paraboloid map = {0};
    set_frame(region, &map);
    for (int level = 0; level < levels; level++)
        map.crops[level] =
            find_crop(&map, &chain->levels[level], tl_paraboloid_density(chain->levels[0].size, level));
    return map;
}

float *tl_paraboloid_sample(const struct tl_paraboloid *map, const struct tl_chain *chain, int level)
{
    const struct tl_paraboloid_crop *crop = &map->crops[level];
    if (crop->width == 0)
        return NULL;
    float density = tl_paraboloid_density(chain->levels[0].size, level);
    float *texels = TL_NEW_ARRAY(float, 3 * (size_t)crop->width * (size_t)crop->height);
    for (int y = 1; y < crop->height - 1; y++)
        for (int x = 1; x < crop->width - 1; x++) {
            vec3s d = unproject(map, ((float)(crop->x0 + x) + 0.5f) / density,
                                ((float)(crop->y0 + y) + 0.5f) / density);
            vec3s colour = tl_cube_sample(&chain->levels[level], d);
            memcpy(texels + 3 * ((size_t)y * (size_t)crop->width + (size_t)x), colour.raw, sizeof colour.raw);
        }
    return texels;
}

vec3s tl_paraboloid_fetch(const struct tl_paraboloid *map, int level, float density, const float *texels,
                          vec3s direction)
{
    const struct tl_paraboloid_crop *crop = &map->crops[level];
    float p[2];
    project(map, direction, p);
    float x = p[0] * density - (float)crop->x0 - 0.5f, y = p[1] * density - (float)crop->y0 - 0.5f;
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

void tl_paraboloids_pack(struct tl_paraboloid *maps, int count, int levels, int *width, int *height)
{
    size_t crop_count = 0, texels = 0;
    int widest = 1;
    struct tl_paraboloid_crop **crops =
        TL_NEW_ARRAY(struct tl_paraboloid_crop *, (size_t)count * (size_t)levels + 1);
    for (int i = 0; i < count; i++)
        for (int level = 0; level < levels; level++) {
            struct tl_paraboloid_crop *crop = &maps[i].crops[level];
            if (crop->width == 0)
                continue;
            crops[crop_count++] = crop;
            texels += (size_t)crop->width * (size_t)crop->height;
            widest = crop->width > widest ? crop->width : widest;
        }
    qsort(crops, crop_count, sizeof(struct tl_paraboloid_crop *), compare_heights);
    /* The width of the smallest texture, among those that are at most twice as wide as a square one. */
    int limit = widest + (int)(2 * sqrt((double)texels)), best = widest;
    size_t least = SIZE_MAX;
    for (int tried = widest; tried <= limit; tried++) {
        size_t area = (size_t)tried * (size_t)pack_rows(crops, crop_count, tried);
        if (area < least) {
            least = area;
            best = tried;
        }
    }
    *width = best;
    *height = pack_rows(crops, crop_count, best);
    *height = *height > 0 ? *height : 1;
    free(crops);
}
