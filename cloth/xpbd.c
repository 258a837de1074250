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

/* Away from 0, for it is divided by. */
TL_INLINE double length_of(vec3d v)
{
    double squared = vec3d_dot(v, v);
    return sqrt(squared > NO_LENGTH * NO_LENGTH ? squared : NO_LENGTH * NO_LENGTH);
}

TL_INLINE void move(struct places *places, int lane, vec3d by, double share)
{
    places->x[lane] += by.x * share;
    places->y[lane] += by.y * share;
    places->z[lane] += by.z * share;
}

/* Both stretches at once, then the shear. A push p on row c moves vertex i by w_i c_i p, and so F_u by cc p
 * and F_v by cd p: they are solved on F alone, and the vertices move once.
 *
 * A stretch C = |F_u| - 1 pushes by factor C along F_u/|F_u|. At once, the two overshoot by no more than the
 * cosine between the threads, and one root and one division less are waited for.
 *
 * The shear's C = cos = g/sqrt(p), with g = u.v, a = |u|^2, b = |v|^2, p = a b, has the gradient
 * c_i (v a - u g) / (a sqrt(p)) + d_i (u b - v g) / (b sqrt(p)), of weighted square
 * (p - g^2) (cc b - 2 cd g + dd a) / p^2: its push needs no root, and one division. */
TL_INLINE void solve_lane(const struct tl_membrane *m, int lane, struct places x[3])
{
    vec3d origin = at(&x[0], lane), side = vec3d_sub(at(&x[1], lane), origin);
    vec3d other = vec3d_sub(at(&x[2], lane), origin);
    vec3d u = vec3d_muladd(vec3d_scale(side, m->c[1][lane]), other, m->c[2][lane]);
    vec3d v = vec3d_muladd(vec3d_scale(side, m->d[1][lane]), other, m->d[2][lane]);
    double cc = m->cc[lane], cd = m->cd[lane], dd = m->dd[lane];
    double length_u = length_of(u), length_v = length_of(v), inverse = 1 / (length_u * length_v);
    vec3d push_c = vec3d_scale(u, m->weft[lane] * (1 - inverse * length_v));
    vec3d push_d = vec3d_scale(v, m->warp[lane] * (1 - inverse * length_u));
    u = vec3d_muladd(vec3d_muladd(u, push_c, cc), push_d, cd);
    v = vec3d_muladd(vec3d_muladd(v, push_c, cd), push_d, dd);

    double a = vec3d_dot(u, u), b = vec3d_dot(v, v), g = vec3d_dot(u, v), p = a * b;
    double sum = m->shear[lane] * p * p + (p - g * g) * (cc * b - 2 * cd * g + dd * a);
    double multiplier = sum > 0 ? -g / sum : 0;
    push_c = vec3d_muladd(vec3d_muladd(push_c, v, multiplier * p), u, -multiplier * b * g);
    push_d = vec3d_muladd(vec3d_muladd(push_d, u, multiplier * p), v, -multiplier * a * g);

    double c0 = -(m->c[1][lane] + m->c[2][lane]), d0 = -(m->d[1][lane] + m->d[2][lane]);
    move(&x[0], lane, vec3d_muladd(vec3d_scale(push_c, c0), push_d, d0), m->w[0][lane]);
    for (int i = 1; i < 3; i++) {
        vec3d push = vec3d_muladd(vec3d_scale(push_c, m->c[i][lane]), push_d, m->d[i][lane]);
        move(&x[i], lane, push, m->w[i][lane]);
    }
}

/* Batches of one run. All are loaded before the first is solved: one batch's roots and divisions are then not
 * waited for by the next. */
#define GROUP 8

TL_CLONES static void solve_run(const struct tl_membrane *membranes, size_t count, vec3d *particles)
{
    struct places x[GROUP][3];
    for (size_t first = 0; first < count; first += GROUP) {
        const struct tl_membrane *m = membranes + first;
        size_t size = count - first < GROUP ? count - first : GROUP;
        for (size_t k = 0; k < size; k++)
            for (int i = 0; i < 3; i++)
                load(particles, m[k].vertices[i], &x[k][i]);
        for (size_t k = 0; k < size; k++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                solve_lane(&m[k], lane, x[k]);
        for (size_t k = 0; k < size; k++)
            for (int i = 0; i < 3; i++)
                store(&x[k][i], m[k].vertices[i], particles);
    }
}

static void solve_membranes(const struct tl_energy *energy, vec3d *particles)
{
    for (size_t run = 0, from = 0; run < energy->membrane_run_count; run++) {
        solve_run(energy->membranes + from, energy->membrane_run_ends[run] - from, particles);
        from = energy->membrane_run_ends[run];
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
    solve_membranes(energy, particles->x);
    if (!energy->bends_as_force)
        solve_bends(energy->bends, energy->bend_count, particles->x);
    for (size_t i = 0; i < energy->link_count; i++)
        tl_xpbd_solve_link(&energy->links[i], particles);
}
