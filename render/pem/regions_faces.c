#include "config/base/memory.h"
#include "config/colour/luminance.h"
#include "render/pem/regions_internal.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

struct rectangle {
    int x0, y0, x1, y1;
};

/* Importance and solid angle of the texels of one face. */
struct cube_face {
    int index, size;
    double *importance;  /* integral of luminance [Rec. 709] */
    double *solid_angle; /* sr */
};

static struct cube_face face_create(const tl_cube *cube, int index)
{
    size_t texel_count = (size_t)cube->size * (size_t)cube->size;
    struct cube_face face = {.index = index,
                             .size = cube->size,
                             .importance = TL_NEW_ARRAY(double, texel_count),
                             .solid_angle = TL_NEW_ARRAY(double, texel_count)};
    const float *texel = cube->texels + 3 * (size_t)index * texel_count;
    for (size_t i = 0; i < texel_count; i++, texel += 3) {
        face.solid_angle[i] =
            (double)tl_cube_solid_angle(cube->size, (int)i % cube->size, (int)i / cube->size);
        face.importance[i] = tl_luminance_exact(texel) * face.solid_angle[i];
    }
    return face;
}

static void face_release(struct cube_face *face)
{
    free(face->importance);
    free(face->solid_angle);
    *face = (struct cube_face){0};
}

/* x, y in texels. */
static vec3s face_direction(const struct cube_face *face, float x, float y)
{
    return glms_vec3_normalize(tl_cube_direction(face->index, x / (float)face->size, y / (float)face->size));
}

static struct tl_region make_region(const struct cube_face *face, struct rectangle r)
{
    double importance = 0, solid_angle = 0;
    double bright[3] = {0},
           uniform[3] = {0}; /* sums of directions, weighted by importance and by solid angle */
    for (int y = r.y0; y < r.y1; y++) {
        for (int x = r.x0; x < r.x1; x++) {
            int i = y * face->size + x;
            vec3s direction = face_direction(face, (float)x + 0.5f, (float)y + 0.5f);
            importance += face->importance[i];
            solid_angle += face->solid_angle[i];
            for (int c = 0; c < 3; c++) {
                bright[c] += face->importance[i] * (double)direction.raw[c];
                uniform[c] += face->solid_angle[i] * (double)direction.raw[c];
            }
        }
    }
    const double *sum = importance > 0 ? bright : uniform;
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    vec3s direction = face_direction(face, (float)r.x0 + 0.5f, (float)r.y0 + 0.5f);
    if (length > 0)
        for (int c = 0; c < 3; c++)
            direction.raw[c] = (float)(sum[c] / length);
    return (struct tl_region){.face = face->index,
                              .x0 = r.x0,
                              .y0 = r.y0,
                              .x1 = r.x1,
                              .y1 = r.y1,
                              .direction = direction,
                              .solid_angle = (float)solid_angle,
                              .importance = (float)importance,
                              .cone = (float)acos(1 - solid_angle / (2 * M_PI))};
}

/* True if the rectangle subtends a larger angle in width than in height, across its middle. */
static bool is_wide(const struct cube_face *face, struct rectangle r)
{
    float xm = 0.5f * (float)(r.x0 + r.x1), ym = 0.5f * (float)(r.y0 + r.y1);
    float width = glms_vec3_dot(face_direction(face, (float)r.x0, ym), face_direction(face, (float)r.x1, ym));
    float height =
        glms_vec3_dot(face_direction(face, xm, (float)r.y0), face_direction(face, xm, (float)r.y1));
    return width <= height; /* cosines */
}

/* The number of columns (or rows) before the cut that comes closest to `share` of the importance. Ties, as in
 * black areas, are decided by solid angle. */
static int find_cut(const struct cube_face *face, struct rectangle r, bool wide, double share)
{
    int count = wide ? r.x1 - r.x0 : r.y1 - r.y0;
    double *importance = TL_NEW_ARRAY(double, (size_t)count + 1); /* sum over the slices before i */
    double *solid_angle = TL_NEW_ARRAY(double, (size_t)count + 1);
    for (int y = r.y0; y < r.y1; y++) {
        for (int x = r.x0; x < r.x1; x++) {
            int slice = wide ? x - r.x0 : y - r.y0;
            importance[slice + 1] += face->importance[y * face->size + x];
            solid_angle[slice + 1] += face->solid_angle[y * face->size + x];
        }
    }
    for (int i = 0; i < count; i++) {
        importance[i + 1] += importance[i];
        solid_angle[i + 1] += solid_angle[i];
    }
    int best = 1;
    double best_error = INFINITY, best_tie = INFINITY;
    for (int cut = 1; cut < count; cut++) {
        double error = fabs(importance[cut] - share * importance[count]);
        double tie = fabs(solid_angle[cut] - share * solid_angle[count]);
        if (error < best_error || (error == best_error && tie < best_tie))
            best = cut, best_error = error, best_tie = tie;
    }
    free(importance);
    free(solid_angle);
    return best;
}

/* Median cut into `count` regions, out[0 .. count). */
static void cut_rectangle(const struct cube_face *face, struct rectangle r, int count, struct tl_region *out)
{
    int width = r.x1 - r.x0, height = r.y1 - r.y0;
    if (count == 1 || width * height <= 1) { /* with fewer texels than regions some stay empty */
        struct rectangle empty = {r.x0, r.y0, r.x0, r.y0};
        for (int i = 0; i < count; i++)
            out[i] = make_region(face, i == 0 ? r : empty);
        return;
    }
    bool wide = height == 1 || (width > 1 && is_wide(face, r));
    int first_count = count / 2;
    int cut = find_cut(face, r, wide, (double)first_count / count);
    struct rectangle first = r, second = r;
    if (wide)
        first.x1 = second.x0 = r.x0 + cut;
    else
        first.y1 = second.y0 = r.y0 + cut;
    /* Neither half gets more regions than it has texels as long as the other half can take them. */
    int first_texels = (first.x1 - first.x0) * (first.y1 - first.y0);
    int second_texels = width * height - first_texels;
    if (count <= width * height) {
        if (first_count > first_texels)
            first_count = first_texels;
        if (count - first_count > second_texels)
            first_count = count - second_texels;
    }
    cut_rectangle(face, first, first_count, out);
    cut_rectangle(face, second, count - first_count, out + first_count);
}

static void label_rectangle(const struct tl_region *region, uint16_t label, struct tl_regions *out)
{
    for (int y = region->y0; y < region->y1; y++)
        for (int x = region->x0; x < region->x1; x++)
            out->labels[(region->face * out->size + y) * out->size + x] = label;
}

void tl_regions_cut(const tl_cube *cube, int count, struct tl_regions *out)
{
    assert(count >= 6 && count <= TL_REGIONS_MAX && count % 6 == 0);
    int face_count = count / 6;
    tl_regions_begin(cube, out);
    out->count = count;
#pragma omp parallel for
    for (int i = 0; i < 6; i++) {
        struct cube_face face = face_create(cube, i);
        cut_rectangle(&face, (struct rectangle){0, 0, cube->size, cube->size}, face_count,
                      out->items + (size_t)i * (size_t)face_count);
        face_release(&face);
        for (int k = i * face_count; k < (i + 1) * face_count; k++)
            label_rectangle(&out->items[k], (uint16_t)k, out);
    }
    tl_regions_order(out);
    tl_regions_weigh(out);
    tl_regions_colour(cube, out);
}
