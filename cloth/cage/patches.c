#include "cloth/cage/patches.h"

#include "cloth/self_contact/crossings.h"
#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Patches that face within so much of their common direction do not cross: a half space less 5 degrees. */
#define FLAT (85 * (M_PI / 180))

struct tl_patch_bounds {
    struct tl_near_box box;
    vec3d axis;
    double angle; /* between the axis and the normal that is farthest from it */
    uint32_t patch;
};

struct tl_patches tl_patches_make(const struct tl_topology *topology, const uint32_t *patch_of, size_t count,
                                  const uint32_t (*corners)[3])
{
    struct tl_patches patches = {.count = count,
                                 .corners = tl_alloc(count, sizeof *patches.corners),
                                 .lists = tl_fans_build(patch_of, topology->triangle_count, count),
                                 .boxes = TL_NEW_ARRAY(struct tl_near_box, topology->triangle_count),
                                 .normals = TL_NEW_ARRAY(vec3s, topology->triangle_count),
                                 .bounds = TL_NEW_ARRAY(struct tl_patch_bounds, count)};
    memcpy(patches.corners, corners, count * sizeof *corners);
    for (uint32_t i = 0; i < count; i++)
        patches.bounds[i].patch = i;
    return patches;
}

void tl_patches_release(struct tl_patches *patches)
{
    tl_fans_release(&patches->lists);
    free(patches->corners);
    free(patches->boxes);
    free(patches->normals);
    free(patches->bounds);
    *patches = (struct tl_patches){0};
}

static bool overlap(const struct tl_near_box *a, const struct tl_near_box *b)
{
    for (int c = 0; c < 3; c++)
        if (a->low[c] > b->high[c] || b->low[c] > a->high[c])
            return false;
    return true;
}

static void widen(struct tl_near_box *box, const struct tl_near_box *by)
{
    for (int c = 0; c < 3; c++) {
        box->low[c] = fminf(box->low[c], by->low[c]);
        box->high[c] = fmaxf(box->high[c], by->high[c]);
    }
}

static const struct tl_near_box EMPTY = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static vec3d normal_of(const uint32_t triangle[3], const vec3d *x)
{
    const vec3d normal =
        vec3d_cross(vec3d_sub(x[triangle[1]], x[triangle[0]]), vec3d_sub(x[triangle[2]], x[triangle[0]]));
    return vec3d_unit_or(normal, (vec3d){0});
}

/* Boxes are rounded to the nearest float, as the positions of what is drawn are. */
static void bound(struct tl_patches *patches, const struct tl_topology *topology, const vec3d *x,
                  struct tl_patch_bounds *out)
{
    const uint32_t first = patches->lists.first[out->patch], end = patches->lists.first[out->patch + 1];
    vec3d sum = {0};
    float lowest = 1;
    out->box = EMPTY;
    for (uint32_t n = first; n < end; n++) {
        const uint32_t *v = topology->triangles[patches->lists.items[n]];
        struct tl_near_box *box = &patches->boxes[n];
        *box = EMPTY;
        for (int k = 0; k < 3; k++) {
            const vec3s at = vec3d_to_float(x[v[k]]);
            const struct tl_near_box corner = {{at.x, at.y, at.z}, {at.x, at.y, at.z}};
            widen(box, &corner);
        }
        widen(&out->box, box);
        const vec3d normal = normal_of(v, x);
        patches->normals[n] = vec3d_to_float(normal);
        sum = vec3d_add(sum, normal);
    }
    out->axis = vec3d_unit_or(sum, (vec3d){0});
    const vec3s axis = vec3d_to_float(out->axis);
    for (uint32_t n = first; n < end; n++)
        lowest = fminf(lowest, glms_vec3_dot(patches->normals[n], axis));
    out->angle = acos(fmax((double)lowest, -1));
}

static bool are_neighbours(const struct tl_patches *patches, uint32_t a, uint32_t b)
{
    for (int i = 0; i < 9; i++)
        if (patches->corners[a][i / 3] == patches->corners[b][i % 3])
            return true;
    return false;
}

static bool face_alike(const struct tl_patch_bounds *a, const struct tl_patch_bounds *b)
{
    const double axes_angle = acos(fmin(fmax(vec3d_dot(a->axis, b->axis), -1), 1));
    return fmax(fmax(a->angle, b->angle), (a->angle + b->angle + axes_angle) / 2) < FLAT;
}

static void test(const struct tl_patches *patches, const struct tl_topology *topology, const vec3d *x,
                 const struct tl_patch_bounds *a, const struct tl_patch_bounds *b, struct tl_near_pairs *out)
{
    const uint32_t *first = patches->lists.first, *items = patches->lists.items;
    for (uint32_t n = first[a->patch]; n < first[a->patch + 1]; n++) {
        if (!overlap(&patches->boxes[n], &b->box))
            continue;
        const uint32_t from = a == b ? n + 1 : first[b->patch];
        for (uint32_t m = from; m < first[b->patch + 1]; m++)
            if (overlap(&patches->boxes[n], &patches->boxes[m]) &&
                tl_triangles_cross(topology->triangles[items[n]], topology->triangles[items[m]], x)) {
                uint32_t pair[1][2] = {{items[n], items[m]}};
                tl_near_pairs_append(out, &(struct tl_near_pairs){.count = 1, .pairs = pair});
            }
    }
}

static int by_height(const void *one, const void *other)
{
    const struct tl_patch_bounds *a = one, *b = other;
    if (a->box.low[1] != b->box.low[1])
        return a->box.low[1] < b->box.low[1] ? -1 : 1;
    return (a->patch > b->patch) - (a->patch < b->patch);
}

/* Tests a patch against itself and those that begin within its height, from below. */
static void sweep(const struct tl_patches *patches, const struct tl_topology *topology, const vec3d *x,
                  const struct tl_patch_marks *marks, size_t at, struct tl_near_pairs *out)
{
    const struct tl_patch_bounds *a = &patches->bounds[at];
    for (size_t i = at; i < patches->count && patches->bounds[i].box.low[1] <= a->box.high[1]; i++) {
        const struct tl_patch_bounds *b = &patches->bounds[i];
        const bool moved = !marks->changed || marks->changed[a->patch] || marks->changed[b->patch];
        const bool bent = marks->bent && (marks->bent[a->patch] || marks->bent[b->patch]);
        if (!moved || !overlap(&a->box, &b->box) ||
            (!bent && are_neighbours(patches, a->patch, b->patch) && face_alike(a, b)))
            continue;
        test(patches, topology, x, a, b, out);
    }
}

void tl_patches_crossings(struct tl_patches *patches, const struct tl_topology *topology, const vec3d *x,
                          const struct tl_patch_marks *marks, struct tl_near_pairs *out)
{
    struct tl_near_pairs *found = TL_NEW_ARRAY(struct tl_near_pairs, patches->count);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < patches->count; i++)
        if (!marks->changed || marks->changed[patches->bounds[i].patch])
            bound(patches, topology, x, &patches->bounds[i]);
    qsort(patches->bounds, patches->count, sizeof *patches->bounds, by_height);
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < patches->count; i++)
        sweep(patches, topology, x, marks, i, &found[i]);
    out->count = 0;
    for (size_t i = 0; i < patches->count; i++) {
        tl_near_pairs_append(out, &found[i]);
        tl_near_pairs_release(&found[i]);
    }
    free(found);
}
