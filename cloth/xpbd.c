#include "cloth/xpbd.h"

#include "config/simd.h"

/* Shorter than this a vector has no direction to push along. */
#define NO_LENGTH 1e-12

/* ---- Batches ---- */

/* The places of one vertex of each element. */
struct places {
    double x[TL_BATCH], y[TL_BATCH], z[TL_BATCH];
};

TL_INLINE void load(const vec3d *x, const uint32_t *vertices, struct places *to)
{
    for (int lane = 0; lane < TL_BATCH; lane++) {
        to->x[lane] = x[vertices[lane]].x;
        to->y[lane] = x[vertices[lane]].y;
        to->z[lane] = x[vertices[lane]].z;
    }
}

TL_INLINE void store(const struct places *from, const uint32_t *vertices, vec3d *x)
{
    for (int lane = 0; lane < TL_BATCH; lane++)
        x[vertices[lane]] = (vec3d){from->x[lane], from->y[lane], from->z[lane]};
}

TL_INLINE vec3d at(const struct places *places, int lane)
{
    return (vec3d){places->x[lane], places->y[lane], places->z[lane]};
}

TL_INLINE void move(struct places *places, int lane, vec3d by, double share)
{
    places->x[lane] += by.x * share;
    places->y[lane] += by.y * share;
    places->z[lane] += by.z * share;
}

/* The square of a length that is divided by. */
TL_INLINE double clear_of_zero(double squared)
{
    return squared > NO_LENGTH * NO_LENGTH ? squared : NO_LENGTH * NO_LENGTH;
}

/* What a stretch C = |F| - 1 of gradient row_i F/|F| pushes, in units of F. */
TL_INLINE double stretch_push(vec3d f, double factor)
{
    return factor * (1 - 1 / sqrt(clear_of_zero(vec3d_dot(f, f))));
}

/* Both stretches and the shear, one after the other. A push p on row c moves vertex i by w_i c_i p, and so
 * F_u by cc p and F_v by cd p: the three are solved on F alone, and the vertices move once. */
TL_INLINE void solve_lane(const struct tl_membrane *m, int lane, struct places x[3])
{
    vec3d origin = at(&x[0], lane), side = vec3d_sub(at(&x[1], lane), origin);
    vec3d other = vec3d_sub(at(&x[2], lane), origin);
    vec3d u = vec3d_muladd(vec3d_scale(side, m->c[1][lane]), other, m->c[2][lane]);
    vec3d v = vec3d_muladd(vec3d_scale(side, m->d[1][lane]), other, m->d[2][lane]);
    double cc = m->cc[lane], cd = m->cd[lane], dd = m->dd[lane];
    vec3d push_c = vec3d_scale(u, stretch_push(u, m->weft[lane]));
    u = vec3d_muladd(u, push_c, cc);
    v = vec3d_muladd(v, push_c, cd);
    vec3d push_d = vec3d_scale(v, stretch_push(v, m->warp[lane]));
    u = vec3d_muladd(u, push_d, cd);
    v = vec3d_muladd(v, push_d, dd);

    /* C = cosine between the threads, of gradient c_i a + d_i b with a = (v/|v| - C u/|u|)/|u| and
     * b = (u/|u| - C v/|v|)/|v|: a.a = (1 - C^2)/|u|^2, b.b = (1 - C^2)/|v|^2, a.b = -C (1 - C^2)/(|u| |v|).
     */
    double uu = 1 / clear_of_zero(vec3d_dot(u, u)), vv = 1 / clear_of_zero(vec3d_dot(v, v));
    double both = sqrt(uu * vv), cosine = vec3d_dot(u, v) * both;
    double sum = m->shear[lane] + (1 - cosine * cosine) * (cc * uu - 2 * cd * cosine * both + dd * vv);
    double multiplier = sum > 0 ? -cosine / sum : 0;
    vec3d along_u = vec3d_muladd(vec3d_scale(v, both), u, -cosine * uu);
    vec3d along_v = vec3d_muladd(vec3d_scale(u, both), v, -cosine * vv);
    push_c = vec3d_muladd(push_c, along_u, multiplier);
    push_d = vec3d_muladd(push_d, along_v, multiplier);
    for (int i = 0; i < 3; i++) {
        move(&x[i], lane, push_c, m->w[i][lane] * m->c[i][lane]);
        move(&x[i], lane, push_d, m->w[i][lane] * m->d[i][lane]);
    }
}

TL_CLONES static void solve_membranes(const struct tl_membrane *membranes, size_t count, vec3d *particles)
{
    for (const struct tl_membrane *m = membranes; m < membranes + count; m++) {
        struct places x[3];
        for (int i = 0; i < 3; i++)
            load(particles, m->vertices[i], &x[i]);
        for (int lane = 0; lane < TL_BATCH; lane++)
            solve_lane(m, lane, x);
        for (int i = 0; i < 3; i++)
            store(&x[i], m->vertices[i], particles);
    }
}

/* The three components of the curvature: vectors, linear in the positions. */
TL_INLINE void solve_curvature(const struct tl_bend *bend, int row, int lane,
                               struct places x[TL_BEND_STENCIL])
{
    vec3d curvature = {0};
    for (int i = 0; i < TL_BEND_STENCIL; i++)
        curvature = vec3d_muladd(curvature, at(&x[i], lane), bend->rows[row][i][lane]);
    vec3d push = vec3d_scale(curvature, bend->factors[row][lane]);
    for (int i = 0; i < TL_BEND_STENCIL; i++)
        move(&x[i], lane, push, bend->w[i][lane] * bend->rows[row][i][lane]);
}

TL_CLONES static void solve_bends(const struct tl_bend *bends, size_t count, vec3d *particles)
{
    for (const struct tl_bend *bend = bends; bend < bends + count; bend++) {
        struct places x[TL_BEND_STENCIL];
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            load(particles, bend->vertices[i], &x[i]);
        for (int row = 0; row < 3; row++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                solve_curvature(bend, row, lane, x);
        for (int i = TL_BEND_STENCIL - 1; i >= 0; i--) /* the first last: it stands in for missing ones */
            store(&x[i], bend->vertices[i], particles);
    }
}

/* ---- Links and the whole ---- */

void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles)
{
    double wa = particles->w[link->a], wb = particles->w[link->b];
    vec3d apart = vec3d_sub(particles->x[link->b], particles->x[link->a]);
    double length = vec3d_norm(apart), sum = wa + wb + link->compliance;
    if (length < NO_LENGTH || !(wa + wb > 0) || !isfinite(sum))
        return;
    vec3d push = vec3d_scale(apart, (length - link->rest) / (length * sum));
    particles->x[link->a] = vec3d_muladd(particles->x[link->a], push, wa);
    particles->x[link->b] = vec3d_muladd(particles->x[link->b], push, -wb);
}

void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles)
{
    solve_membranes(energy->membranes, energy->membrane_count, particles->x);
    solve_bends(energy->bends, energy->bend_count, particles->x);
    for (size_t i = 0; i < energy->link_count; i++)
        tl_xpbd_solve_link(&energy->links[i], particles);
}
