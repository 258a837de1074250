#include "assets/body/section.h"

#include "config/base/memory.h"

#include <stdlib.h>

struct segment {
    vec2s ends[2]; /* x, z */
    int component;
};

struct tl_plane tl_plane_level(float y_m)
{
    return (struct tl_plane){{{0, y_m, 0}}, {{1, 0, 0}}, {{0, 0, 1}}};
}

/* Coordinates in the plane, and the height above it: onward x across points up. */
static vec3s in_frame(const struct tl_plane *plane, vec3s p)
{
    vec3s from = glms_vec3_sub(p, plane->point), up = glms_vec3_cross(plane->onward, plane->across);
    return (vec3s){
        {glms_vec3_dot(from, plane->across), glms_vec3_dot(from, up), glms_vec3_dot(from, plane->onward)}};
}

static vec2s cross_edge(vec3s a, vec3s b)
{
    float part = -a.y / (b.y - a.y);
    return (vec2s){{a.x + part * (b.x - a.x), a.z + part * (b.z - a.z)}};
}

static size_t cut_mesh(const tl_mesh *mesh, const struct tl_plane *plane, struct segment *segments)
{
    size_t count = 0;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        int ends = 0;
        vec3s p[3];
        for (int k = 0; k < 3; k++)
            p[k] = in_frame(plane, mesh->positions[mesh->indices[i + (size_t)k]]);
        for (int e = 0; e < 3 && ends < 2; e++) {
            vec3s a = p[e], b = p[(e + 1) % 3];
            if ((a.y < 0) != (b.y < 0))
                segments[count].ends[ends++] = a.y < b.y ? cross_edge(a, b) : cross_edge(b, a);
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

/* The convex hull, counter-clockwise: Andrew's monotone chain. */
static size_t find_hull(vec2s *points, size_t count, vec2s *hull)
{
    qsort(points, count, sizeof *points, compare_points);
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
    return size;
}

static struct tl_section section_of(const struct segment *segments, size_t count, int component,
                                    vec2s *points)
{
    struct tl_section section = {0};
    size_t point_count = 0;
    for (size_t i = 0; i < count; i++)
        if (segments[i].component == component) {
            points[point_count++] = segments[i].ends[0];
            points[point_count++] = segments[i].ends[1];
        }
    section.lower = section.upper = points[0];
    for (size_t i = 1; i < point_count; i++) {
        section.lower = glms_vec2_minv(section.lower, points[i]);
        section.upper = glms_vec2_maxv(section.upper, points[i]);
    }
    section.hull = TL_NEW_ARRAY(vec2s, 2 * point_count + 1);
    section.hull_count = find_hull(points, point_count, section.hull);
    for (size_t i = 0; i < section.hull_count; i++)
        section.girth_m += glms_vec2_distance(section.hull[i], section.hull[(i + 1) % section.hull_count]);
    return section;
}

size_t tl_mesh_sections(const tl_mesh *mesh, const struct tl_plane *plane, struct tl_section **out)
{
    struct segment *segments = TL_NEW_ARRAY(struct segment, mesh->index_count / 3);
    size_t count = cut_mesh(mesh, plane, segments);
    size_t components = (size_t)join_segments(segments, count);
    vec2s *points = TL_NEW_ARRAY(vec2s, 2 * count);
    *out = TL_NEW_ARRAY(struct tl_section, components);
    for (size_t c = 0; c < components; c++)
        (*out)[c] = section_of(segments, count, (int)c, points);
    free(points);
    free(segments);
    return components;
}

void tl_sections_release(struct tl_section **sections, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free((*sections)[i].hull);
    free(*sections);
    *sections = NULL;
}

void tl_section_ring(const struct tl_section *section, bool symmetric, double length, struct tl_ring *out)
{
    struct tl_point *points = TL_NEW_ARRAY(struct tl_point, section->hull_count);
    const double girth = (double)section->girth_m;
    for (size_t i = 0; i < section->hull_count; i++)
        points[i] = (struct tl_point){(double)section->hull[i].x, (double)section->hull[i].y};
    tl_ring_around(points, (int)section->hull_count, girth, symmetric, length > 0 ? length : girth, out);
    free(points);
}
