#include "cloth/cage/cage_rest.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* A symmetric matrix in a triangle's rest plane. */
struct tensor {
    double uu, uv, vv;
};

/* F^T F, F the gradient from the rest shape to `places`. False for a rest shape without area. */
static bool metric_of(const vec3d places[3], const vec2s rest[3], struct tensor *out)
{
    const vec2s a = glms_vec2_sub(rest[1], rest[0]), b = glms_vec2_sub(rest[2], rest[0]);
    const double ax = (double)a.x, ay = (double)a.y, bx = (double)b.x, by = (double)b.y;
    const double area = ax * by - ay * bx;
    const vec3d p = vec3d_sub(places[1], places[0]), q = vec3d_sub(places[2], places[0]);
    const vec3d u = vec3d_scale(vec3d_sub(vec3d_scale(p, by), vec3d_scale(q, ay)), 1 / area);
    const vec3d v = vec3d_scale(vec3d_sub(vec3d_scale(q, ax), vec3d_scale(p, bx)), 1 / area);
    *out = (struct tensor){vec3d_dot(u, u), vec3d_dot(u, v), vec3d_dot(v, v)};
    return fabs(area) > 0;
}

/* The square root of a matrix without negative eigenvalues (Cayley & Hamilton). */
static struct tensor root_of(struct tensor m)
{
    const double det = sqrt(fmax(m.uu * m.vv - m.uv * m.uv, 0)), sum = sqrt(m.uu + m.vv + 2 * det);
    return (struct tensor){(m.uu + det) / sum, m.uv / sum, (m.vv + det) / sum};
}

/* The mean metrics of the cloth's triangles on each of the cage's; 0 where there are none. */
static struct tensor *mean_metrics(const struct tl_cage *cage, const tl_cloth *cloth)
{
    struct tensor *means = TL_NEW_ARRAY(struct tensor, cage->triangle_count);
    double *areas = TL_NEW_ARRAY(double, cage->triangle_count);
    for (size_t t = 0; t < cloth->topology.triangle_count; t++) {
        const uint32_t *v = cloth->topology.triangles[t];
        const vec3d places[3] = {cloth->particles.x[v[0]], cloth->particles.x[v[1]],
                                 cloth->particles.x[v[2]]};
        const uint32_t on = cage->points[v[0]].triangle;
        const vec2s *rest = cloth->rest[t];
        struct tensor metric;
        if (!metric_of(places, rest, &metric))
            continue;
        const double area =
            fabs((double)glms_vec2_cross(glms_vec2_sub(rest[1], rest[0]), glms_vec2_sub(rest[2], rest[0])));
        means[on].uu += area * metric.uu;
        means[on].uv += area * metric.uv;
        means[on].vv += area * metric.vv;
        areas[on] += area;
    }
    for (size_t t = 0; t < cage->triangle_count; t++)
        if (areas[t] > 0)
            means[t] =
                (struct tensor){means[t].uu / areas[t], means[t].uv / areas[t], means[t].vv / areas[t]};
    free(areas);
    return means;
}

/* Changes a rest shape to R^-1 S of it, R and S the roots of the metrics that it is to have and that it has:
 * then its gradient is F S^-1 R. */
static void give_metric(struct tensor wanted, struct tensor found, vec2s rest[3])
{
    const struct tensor r = root_of(wanted), s = root_of(found);
    const double det = r.uu * r.vv - r.uv * r.uv;
    if (!(det > 0.01)) /* crushed, or nothing lies there */
        return;
    for (int k = 0; k < 3; k++) {
        const double x = (double)rest[k].x, y = (double)rest[k].y;
        const double u = s.uu * x + s.uv * y, v = s.uv * x + s.vv * y;
        rest[k].x = (float)((r.vv * u - r.uv * v) / det);
        rest[k].y = (float)((r.uu * v - r.uv * u) / det);
    }
}

void tl_cage_rest(const struct tl_cage *cage, const tl_cloth *cloth, const vec3d *places, vec2s *out)
{
    struct tensor *wanted = mean_metrics(cage, cloth);
    for (size_t t = 0; t < cage->triangle_count; t++) {
        vec2s *rest = &out[3 * t];
        vec3d corners[3];
        struct tensor found;
        for (int k = 0; k < 3; k++) {
            corners[k] = places[cage->triangles[t][k]];
            rest[k] = (vec2s){{cage->rest[t][k][0], cage->rest[t][k][1]}};
        }
        if (metric_of(corners, rest, &found))
            give_metric(wanted[t], found, rest);
    }
    free(wanted);
}
