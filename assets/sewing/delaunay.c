#include "assets/sewing/delaunay.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct delaunay_triangle {
    uint32_t v[3];
    double centre_x, centre_y, radius2; /* of the circumcircle */
};

struct triangle_list {
    struct delaunay_triangle *items;
    size_t count, capacity;
};

struct delaunay_edge {
    uint32_t a, b;
};

static void push(struct triangle_list *list, const struct delaunay_triangle *triangle)
{
    if (list->count == list->capacity) {
        list->capacity = list->capacity ? 2 * list->capacity : 256;
        list->items = tl_resize(list->items, list->capacity, sizeof *list->items);
    }
    list->items[list->count++] = *triangle;
}

static double twice_area(const struct tl_point *p, const uint32_t v[3])
{
    return (p[v[1]].x - p[v[0]].x) * (p[v[2]].y - p[v[0]].y) -
           (p[v[2]].x - p[v[0]].x) * (p[v[1]].y - p[v[0]].y);
}

/* Makes a counter-clockwise triangle with its circumcircle. A degenerate triangle gets a huge circle, so that
 * the next point removes it. */
static struct delaunay_triangle make_triangle(const struct tl_point *p, uint32_t a, uint32_t b, uint32_t c)
{
    struct delaunay_triangle t = {.v = {a, b, c}};
    double area = twice_area(p, t.v);
    if (area < 0) {
        t.v[1] = c;
        t.v[2] = b;
    }
    struct tl_point o = p[t.v[0]];
    double bx = p[t.v[1]].x - o.x, by = p[t.v[1]].y - o.y, cx = p[t.v[2]].x - o.x, cy = p[t.v[2]].y - o.y;
    double scale = 0.5 / fmax(fabs(area), 1e-18), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    double ux = (cy * b2 - by * c2) * scale, uy = (bx * c2 - cx * b2) * scale;
    t.centre_x = o.x + ux;
    t.centre_y = o.y + uy;
    t.radius2 = ux * ux + uy * uy;
    return t;
}

static int compare_edges(const void *left, const void *right)
{
    const struct delaunay_edge *a = left, *b = right;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

/* Inserts a point [Bowyer, Watson]: removes the open triangles whose circle holds it and connects the
 * boundary of the hole to it. An edge that two removed triangles share is inside the hole: it occurs twice
 * and is dropped. */
static void insert_point(const struct tl_point *p, uint32_t index, struct triangle_list *open,
                         struct triangle_list *done, struct delaunay_edge **rim, size_t *rim_capacity)
{
    size_t rim_count = 0, kept = 0;
    for (size_t i = 0; i < open->count; i++) {
        struct delaunay_triangle t = open->items[i];
        double dx = p[index].x - t.centre_x, dy = p[index].y - t.centre_y;
        if (dx > 0 && dx * dx > t.radius2) {
            push(done, &t); /* points are sorted by x: no later one can lie in this circle */
            continue;
        }
        if (dx * dx + dy * dy >= t.radius2) {
            open->items[kept++] = t;
            continue;
        }
        if (rim_count + 3 > *rim_capacity) {
            *rim_capacity = 2 * *rim_capacity + 64;
            *rim = tl_resize(*rim, *rim_capacity, sizeof **rim);
        }
        for (int k = 0; k < 3; k++) {
            uint32_t a = t.v[k], b = t.v[(k + 1) % 3];
            (*rim)[rim_count++] = (struct delaunay_edge){a < b ? a : b, a < b ? b : a};
        }
    }
    open->count = kept;
    if (rim_count > 0)
        qsort(*rim, rim_count, sizeof **rim, compare_edges);
    for (size_t i = 0; i < rim_count; i++) {
        if (i + 1 < rim_count && compare_edges(&(*rim)[i], &(*rim)[i + 1]) == 0) {
            i++;
            continue;
        }
        struct delaunay_triangle t = make_triangle(p, (*rim)[i].a, (*rim)[i].b, index);
        push(open, &t);
    }
}

struct sorted_point {
    double x;
    uint32_t index;
};

static int compare_x(const void *left, const void *right)
{
    const struct sorted_point *a = left, *b = right;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

/* Copies the points and adds the three corners of a triangle that encloses them all. */
static struct tl_point *with_corners(const struct tl_point *points, size_t count)
{
    double lower_x = INFINITY, lower_y = INFINITY, upper_x = -INFINITY, upper_y = -INFINITY;
    struct tl_point *all = TL_NEW_ARRAY(struct tl_point, count + 3);
    for (size_t i = 0; i < count; i++) {
        all[i] = points[i];
        lower_x = fmin(lower_x, points[i].x);
        lower_y = fmin(lower_y, points[i].y);
        upper_x = fmax(upper_x, points[i].x);
        upper_y = fmax(upper_y, points[i].y);
    }
    /* So far away that circles through a corner are straight lines at the scale of the hull's edges. */
    double reach = 1000 * fmax(upper_x - lower_x, upper_y - lower_y);
    double x = 0.5 * (lower_x + upper_x), y = 0.5 * (lower_y + upper_y);
    all[count] = (struct tl_point){x - reach, y - reach};
    all[count + 1] = (struct tl_point){x + reach, y - reach};
    all[count + 2] = (struct tl_point){x, y + reach};
    return all;
}

size_t tl_delaunay(const struct tl_point *points, size_t count, uint32_t (**triangles)[3])
{
    struct tl_point *all = with_corners(points, count);
    struct sorted_point *order = TL_NEW_ARRAY(struct sorted_point, count);
    for (size_t i = 0; i < count; i++)
        order[i] = (struct sorted_point){points[i].x, (uint32_t)i};
    qsort(order, count, sizeof *order, compare_x);

    struct triangle_list open = {0}, done = {0};
    struct delaunay_edge *rim = NULL;
    size_t rim_capacity = 0;
    struct delaunay_triangle first =
        make_triangle(all, (uint32_t)count, (uint32_t)count + 1, (uint32_t)count + 2);
    push(&open, &first);
    for (size_t i = 0; i < count; i++)
        insert_point(all, order[i].index, &open, &done, &rim, &rim_capacity);
    for (size_t i = 0; i < open.count; i++)
        push(&done, &open.items[i]);

    size_t kept = 0;
    *triangles = tl_alloc(done.count, sizeof **triangles);
    for (size_t i = 0; i < done.count; i++) {
        const uint32_t *v = done.items[i].v;
        if (v[0] < count && v[1] < count && v[2] < count)
            memcpy((*triangles)[kept++], v, sizeof **triangles);
    }
    free(rim);
    free(open.items);
    free(done.items);
    free(order);
    free(all);
    return kept;
}
