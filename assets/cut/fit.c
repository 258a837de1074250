#include "assets/cut/fit.h"

#include "assets/builtin/form.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>

struct segment {
    vec2s ends[2]; /* x, z */
    int component;
};

static vec2s cross_edge(vec3s a, vec3s b, float y)
{
    float part = (y - a.y) / (b.y - a.y);
    return (vec2s){{a.x + part * (b.x - a.x), a.z + part * (b.z - a.z)}};
}

static size_t cut_mesh(const tl_mesh *mesh, float y, struct segment *segments)
{
    size_t count = 0;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        int ends = 0;
        for (int e = 0; e < 3 && ends < 2; e++) {
            vec3s a = mesh->positions[mesh->indices[i + (size_t)e]];
            vec3s b = mesh->positions[mesh->indices[i + (size_t)(e + 1) % 3]];
            if ((a.y < y) != (b.y < y))
                segments[count].ends[ends++] = a.y < b.y ? cross_edge(a, b, y) : cross_edge(b, a, y);
        }
        if (ends == 2)
            segments[count++].component = -1;
    }
    return count;
}

/* Joins segments into sections: neighbouring triangles cut their common edge at the same point, so that equal
 * ends connect. */
static int join_segments(struct segment *segments, size_t count)
{
    const float same_m = 1e-5f;
    size_t *stack = TL_NEW_ARRAY(size_t, count);
    int components = 0;
    for (size_t seed = 0; seed < count; seed++) {
        if (segments[seed].component >= 0)
            continue;
        size_t depth = 0;
        segments[seed].component = components;
        stack[depth++] = seed;
        while (depth) {
            const struct segment *from = &segments[stack[--depth]];
            for (size_t i = 0; i < count; i++) {
                bool touch = false;
                for (int e = 0; e < 4; e++)
                    touch |= glms_vec2_distance(from->ends[e / 2], segments[i].ends[e % 2]) < same_m;
                if (touch && segments[i].component < 0) {
                    segments[i].component = components;
                    stack[depth++] = i;
                }
            }
        }
        components++;
    }
    free(stack);
    return components;
}

static int compare_points(const void *a, const void *b)
{
    const vec2s *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

static float turn(vec2s a, vec2s b, vec2s c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Length of the convex hull: Andrew's monotone chain. */
static float hull_length(vec2s *points, size_t count)
{
    qsort(points, count, sizeof *points, compare_points);
    vec2s *hull = TL_NEW_ARRAY(vec2s, 2 * count + 1);
    size_t size = 0;
    for (size_t pass = 0; pass < 2; pass++) {
        size_t floor = size + 1;
        for (size_t i = 0; i < count; i++) {
            vec2s point = points[pass ? count - 1 - i : i];
            while (size > floor && turn(hull[size - 2], hull[size - 1], point) <= 0)
                size--;
            hull[size++] = point;
        }
        size--; /* the last point of one half is the first of the other */
    }
    float length = 0;
    for (size_t i = 0; i < size; i++)
        length += glms_vec2_distance(hull[i], hull[(i + 1) % size]);
    free(hull);
    return length;
}

bool tl_mesh_girth(const tl_mesh *mesh, float y_m, struct tl_girth *out)
{
    struct segment *segments = TL_NEW_ARRAY(struct segment, mesh->index_count / 3);
    size_t count = cut_mesh(mesh, y_m, segments);
    int components = join_segments(segments, count);
    vec2s *points = TL_NEW_ARRAY(vec2s, 2 * count);
    *out = (struct tl_girth){0};
    for (int component = 0; component < components; component++) {
        size_t point_count = 0;
        for (size_t i = 0; i < count; i++)
            if (segments[i].component == component) {
                points[point_count++] = segments[i].ends[0];
                points[point_count++] = segments[i].ends[1];
            }
        vec2s lower = points[0], upper = points[0];
        for (size_t i = 1; i < point_count; i++) {
            lower = glms_vec2_minv(lower, points[i]);
            upper = glms_vec2_maxv(upper, points[i]);
        }
        float length = hull_length(points, point_count);
        if (length > out->length_m)
            *out = (struct tl_girth){length, glms_vec2_scale(glms_vec2_add(lower, upper), 0.5f)};
    }
    free(points);
    free(segments);
    return count > 0;
}

struct waist {
    float y_m;
    struct tl_girth girth;
};

/* The narrowest section where the waist of a standing person is. */
static bool find_waist(const tl_mesh *mesh, struct waist *out)
{
    const float from = 0.56f, to = 0.66f; /* of the body's height */
    const int sections = 21;
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    float height = box.upper.y - box.lower.y;
    *out = (struct waist){.girth = {.length_m = INFINITY}};
    for (int i = 0; i < sections; i++) {
        float y = box.lower.y + height * (from + (to - from) * (float)i / (float)(sections - 1));
        struct tl_girth girth;
        if (tl_mesh_girth(mesh, y, &girth) && girth.length_m < out->girth.length_m)
            *out = (struct waist){y, girth};
    }
    return isfinite(out->girth.length_m);
}

bool tl_garment_fit(tl_garment *garment, const char *body_name, const tl_mesh *body, tl_error *error)
{
    struct waist waist;
    if (!find_waist(body, &waist))
        return tl_fail(error, TL_INPUT,
                       "%s: no waist was found to fit a built-in garment to: name a garment file", body_name);
    float scale = waist.girth.length_m / (float)tl_form_girth(TL_FORM_WAIST);
    tl_mesh *mesh = &garment->model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s *p = &mesh->positions[i];
        p->x = waist.girth.centre.x + scale * p->x;
        p->y = waist.y_m + scale * (p->y - (float)TL_FORM_WAIST);
        p->z = waist.girth.centre.y + scale * p->z;
        garment->pattern[i] = glms_vec2_scale(garment->pattern[i], scale);
        mesh->uvs[i] = glms_vec2_scale(mesh->uvs[i], scale);
    }
    return true;
}
