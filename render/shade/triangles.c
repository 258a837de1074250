#include "render/shade/triangles.h"

#include "config/base/memory.h"
#include "render/detail/bumps.h"

#include <math.h>
#include <stdlib.h>

/* A clip-space corner in pixels, times w. */
struct corner {
    double x, y, w;
};

static struct corner corner_of(const struct tl_view *view, int width, int height, vec3s p)
{
    const vec4s clip = glms_mat4_mulv(view->view_projection, (vec4s){{p.x, p.y, p.z, 1}});
    double w = (double)clip.w;
    return (struct corner){(0.5 * (double)clip.x + 0.5 * w) * width,
                           (0.5 * (double)clip.y + 0.5 * w) * height, w};
}

/* Weights are small differences of large products: they are counted from a place near the triangle. */
static void set_origin(const struct corner corners[3], int width, int height,
                       struct tl_pixel_triangle *triangle)
{
    double x = 0.5 * width, y = 0.5 * height;
    for (int i = 0; i < 3; i++)
        if (corners[i].w > 0) {
            x = corners[i].x / corners[i].w;
            y = corners[i].y / corners[i].w;
            break;
        }
    triangle->x0 = (float)floor(fmin(fmax(x, 0), width));
    triangle->y0 = (float)floor(fmin(fmax(y, 0), height));
}

/* The stretch of cloth matters to weaves only. */
static void set_slopes(const struct tl_shade_part *part, struct tl_pixel_triangle *triangle)
{
    triangle->slopes[0] = triangle->slopes[1] = 1;
    const tl_surface *surface = triangle->surface;
    if (!(part->weave_moments || part->weave_normal) || !surface->uvs)
        return;
    vec3s positions[3];
    vec2s uvs[3];
    for (int i = 0; i < 3; i++) {
        positions[i] = surface->positions[triangle->corners[i]];
        uvs[i] = surface->uvs[triangle->corners[i]];
    }
    tl_slope_factors(positions, uvs, part->uv_metres, triangle->slopes);
}

static struct tl_pixel_triangle make_triangle(const struct tl_view *view, int width, int height,
                                              const struct tl_triangle_ranges *ranges,
                                              const struct tl_shade_materials *materials, uint32_t seen)
{
    struct tl_pixel_triangle triangle = {.back = seen & TL_SAMPLE_BACK};
    uint32_t number = seen & ~TL_SAMPLE_BACK;
    triangle.surface = tl_triangle_find(ranges, number, triangle.corners, &triangle.surface_index);
    triangle.number = number - ranges->first[triangle.surface_index];
    triangle.part = tl_shade_part_at(materials, triangle.surface, triangle.surface_index, triangle.number);
    triangle.transmits = tl_material_transmits(materials->parts[triangle.part].material);
    set_slopes(&materials->parts[triangle.part], &triangle);
    struct corner at[3];
    for (int i = 0; i < 3; i++)
        at[i] = corner_of(view, width, height, triangle.surface->positions[triangle.corners[i]]);
    set_origin(at, width, height, &triangle);
    for (int i = 0; i < 3; i++) {
        at[i].x -= (double)triangle.x0 * at[i].w;
        at[i].y -= (double)triangle.y0 * at[i].w;
    }
    double edges[3][3], largest = 0;
    for (int i = 0; i < 3; i++) {
        const struct corner *p = &at[(i + 1) % 3], *q = &at[(i + 2) % 3];
        edges[i][0] = p->y * q->w - p->w * q->y;
        edges[i][1] = p->w * q->x - p->x * q->w;
        edges[i][2] = p->x * q->y - p->y * q->x;
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fabs(edges[i][k]));
    }
    double determinant = at[0].x * edges[0][0] + at[0].y * edges[0][1] + at[0].w * edges[0][2];
    double scale = largest > 0 ? (determinant < 0 ? -1 : 1) / largest : 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            triangle.edges[i][k] = (float)(scale * edges[i][k]);
    return triangle;
}

void tl_pixel_triangles_make(struct tl_pixel_triangles *triangles, const struct tl_id_buffer *ids,
                             const struct tl_view *view, const struct tl_triangle_ranges *ranges,
                             const struct tl_shade_materials *materials)
{
    if (ids->seen_count > triangles->capacity) {
        free(triangles->items);
        triangles->capacity = ids->seen_count + ids->seen_count / 4;
        triangles->items = tl_alloc(triangles->capacity, sizeof *triangles->items);
    }
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < ids->seen_count; i++)
        triangles->items[i] = make_triangle(view, ids->width, ids->height, ranges, materials, ids->seen[i]);
}

void tl_pixel_triangles_release(struct tl_pixel_triangles *triangles)
{
    free(triangles->items);
    *triangles = (struct tl_pixel_triangles){0};
}
