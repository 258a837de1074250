#include "cloth/solvers/xpbd.h"

#include "cloth/mesh/team.h"
#include "config/base/simd.h"

#include <string.h>

/* Shorter than this a vector has no direction to push along. */
#define NO_LENGTH 1e-12

/* ---- Batches ---- */

/* Positions of one vertex of each element of a batch. */
struct positions {
    double x[TL_BATCH], y[TL_BATCH], z[TL_BATCH];
};

TL_INLINE void load(const vec3d *x, const uint32_t *vertices, struct positions *to)
{
    for (int lane = 0; lane < TL_BATCH; lane++) {
        to->x[lane] = x[vertices[lane]].x;
        to->y[lane] = x[vertices[lane]].y;
        to->z[lane] = x[vertices[lane]].z;
    }
}

TL_INLINE void store(const struct positions *from, const uint32_t *vertices, vec3d *x)
{
    for (int lane = 0; lane < TL_BATCH; lane++)
        x[vertices[lane]] = (vec3d){from->x[lane], from->y[lane], from->z[lane]};
}

TL_INLINE vec3d at(const struct positions *positions, int lane)
{
    return (vec3d){positions->x[lane], positions->y[lane], positions->z[lane]};
}

TL_INLINE void put(struct positions *positions, int lane, vec3d v)
{
    positions->x[lane] = v.x;
    positions->y[lane] = v.y;
    positions->z[lane] = v.z;
}

TL_INLINE void move(struct positions *positions, int lane, vec3d by, double share)
{
    put(positions, lane, vec3d_muladd(at(positions, lane), by, share));
}

/* Batches of a run that are solved interleaved. */
#define GROUP 8

/* Corners of a group's membranes, as a structure of arrays. */
struct corners {
    double x[GROUP][3][TL_BATCH], y[GROUP][3][TL_BATCH], z[GROUP][3][TL_BATCH];
};

/* The same as in memory: x, y, z and padding to a wide register. */
struct rows {
    _Alignas(TL_CACHE_LINE) double of[GROUP][3][TL_BATCH][4];
};

TL_INLINE void deinterleave(const struct rows *rows, size_t count, struct corners *corners)
{
    const double(*from)[4] = rows->of[0][0];
    double *x = corners->x[0][0], *y = corners->y[0][0], *z = corners->z[0][0];
    for (size_t i = 0; i < count * 3 * TL_BATCH; i++) {
        x[i] = from[i][0];
        y[i] = from[i][1];
        z[i] = from[i][2];
    }
}

/* The padding is written too (z again), since a loop that writes all four numbers vectorises. */
TL_INLINE void interleave(const struct corners *corners, size_t count, struct rows *rows)
{
    double(*to)[4] = rows->of[0][0];
    const double *x = corners->x[0][0], *y = corners->y[0][0], *z = corners->z[0][0];
    for (size_t i = 0; i < count * 3 * TL_BATCH; i++) {
        to[i][0] = x[i];
        to[i][1] = y[i];
        to[i][2] = z[i];
        to[i][3] = z[i];
    }
}

TL_INLINE vec3d corner_at(const struct corners *corners, size_t k, int i, int lane)
{
    return (vec3d){corners->x[k][i][lane], corners->y[k][i][lane], corners->z[k][i][lane]};
}

/* One membrane per lane while its three rows are solved: weft, warp, then shear, Gauss-Seidel within the
 * triangle, on the latest F. A correction p of row c moves vertex i by w_i c_i p, and so F_u by cc p and F_v
 * by cd p: the rows can be solved on F alone, and the vertices move once at the end. All corrections lie in
 * the plane of the first F_u and F_v, called u and v, so only their coefficients in u and v change, and
 * scalar products follow from the first three: no vector is touched between. Work is done in stages over a
 * group, because while one batch waits for its root and division the same stage of the next batches can run.
 */
struct membrane_work {
    struct positions u, v;
    double uu[TL_BATCH], vv[TL_BATCH], uv[TL_BATCH];
    double c_u[TL_BATCH], c_v[TL_BATCH]; /* the whole push on row c: c_u u + c_v v */
    double d_u[TL_BATCH], d_v[TL_BATCH];
};

TL_INLINE void measure(const struct tl_preview_membrane *m, const struct corners *corners, size_t k, int lane,
                       struct membrane_work *work)
{
    vec3d origin = corner_at(corners, k, 0, lane), side = vec3d_sub(corner_at(corners, k, 1, lane), origin);
    vec3d other = vec3d_sub(corner_at(corners, k, 2, lane), origin);
    vec3d u = vec3d_muladd(vec3d_scale(side, m->c[0][lane]), other, m->c[1][lane]);
    vec3d v = vec3d_muladd(vec3d_scale(side, m->d[0][lane]), other, m->d[1][lane]);
    put(&work->u, lane, u);
    put(&work->v, lane, v);
    work->uu[lane] = vec3d_dot(u, u);
    work->vv[lane] = vec3d_dot(v, v);
    work->uv[lane] = vec3d_dot(u, v);
}

/* The current F: F_u = u_u u + u_v v, F_v = v_u u + v_v v, and its scalar products. */
struct deformation {
    double u_u, u_v, v_u, v_v;
    double a, b, g; /* |F_u|^2, |F_v|^2, F_u.F_v */
};

/* The correction for C = |F| - 1 - rest is factor C F/|F|; returned in units of F: factor (1 - (1 +
 * rest)/|F|).
 */
TL_INLINE double stretch_push(double squared, double factor, double rest)
{
    return factor *
           (1 - (1 + rest) / sqrt(squared > NO_LENGTH * NO_LENGTH ? squared : NO_LENGTH * NO_LENGTH));
}

/* The correction is push F_u: F_u becomes (1 + cc push) F_u, and F_v gains cd push F_u. */
TL_INLINE double solve_weft(const struct tl_preview_membrane *m, int lane, struct deformation *f)
{
    double push = stretch_push(f->a, m->weft[lane], m->rest_strain[0][lane]);
    double scale = 1 + push * m->cc[lane], lean = push * m->cd[lane], middle = f->g + lean * f->a;
    f->v_u = lean;
    f->b += lean * (f->g + middle);
    f->u_u = scale;
    f->a *= scale * scale;
    f->g = scale * middle;
    return push;
}

TL_INLINE double solve_warp(const struct tl_preview_membrane *m, int lane, struct deformation *f)
{
    double push = stretch_push(f->b, m->warp[lane], m->rest_strain[1][lane]);
    double scale = 1 + push * m->dd[lane], lean = push * m->cd[lane], middle = f->g + lean * f->b;
    f->u_u += lean * f->v_u;
    f->u_v = lean;
    f->a += lean * (f->g + middle);
    f->v_u *= scale;
    f->v_v = scale;
    f->b *= scale * scale;
    f->g = scale * middle;
    return push;
}

/* Shear: C = g / sqrt(p) - rest with p = a b has the gradient
 *     c_i (v a - u g) / (a sqrt(p)) + d_i (u b - v g) / (b sqrt(p)),
 * whose weighted square is (p - g^2) (cc b - 2 cd g + dd a) / p^2. Multiplier times gradient then needs one
 * division. Returns the common factor: row c receives p F_v - b g F_u times it, row d p F_u - a g F_v. */
TL_INLINE double solve_shear(const struct tl_preview_membrane *m, int lane, const struct deformation *f)
{
    double p = f->a * f->b, root = sqrt(p > NO_LENGTH * NO_LENGTH ? p : NO_LENGTH * NO_LENGTH);
    double square = (p - f->g * f->g) * (m->cc[lane] * f->b - 2 * m->cd[lane] * f->g + m->dd[lane] * f->a);
    double sum = m->shear[lane] * p * p + square;
    return sum > 0 ? -(f->g - m->rest_strain[2][lane] * root) / sum : 0;
}

TL_INLINE void solve(const struct tl_preview_membrane *m, int lane, struct membrane_work *work)
{
    struct deformation f = {
        .u_u = 1, .v_v = 1, .a = work->uu[lane], .b = work->vv[lane], .g = work->uv[lane]};
    double weft = solve_weft(m, lane, &f);
    double lean = f.v_u; /* the warp's push is along v + lean u */
    double warp = solve_warp(m, lane, &f), shear = solve_shear(m, lane, &f);
    double across = shear * (f.a * f.b), along_c = shear * f.b * f.g, along_d = shear * f.a * f.g;
    work->c_u[lane] = weft + (across * f.v_u - along_c * f.u_u);
    work->c_v[lane] = across * f.v_v - along_c * f.u_v;
    work->d_u[lane] = warp * lean + (across * f.u_u - along_d * f.v_u);
    work->d_v[lane] = warp + (across * f.u_v - along_d * f.v_v);
}

TL_INLINE void move_corners(const struct tl_preview_membrane *m, const struct membrane_work *work, int lane,
                            size_t k, struct corners *corners)
{
    vec3d u = at(&work->u, lane), v = at(&work->v, lane);
    double along_u[3], along_v[3];
    for (int i = 1; i < 3; i++) {
        double c = m->c[i - 1][lane], d = m->d[i - 1][lane];
        along_u[i] = c * work->c_u[lane] + d * work->d_u[lane];
        along_v[i] = c * work->c_v[lane] + d * work->d_v[lane];
    }
    along_u[0] = -(along_u[1] + along_u[2]);
    along_v[0] = -(along_v[1] + along_v[2]);
    for (int i = 0; i < 3; i++) {
        double w = m->w[i][lane];
        vec3d moved = vec3d_muladd(corner_at(corners, k, i, lane), u, w * along_u[i]);
        moved = vec3d_muladd(moved, v, w * along_v[i]);
        corners->x[k][i][lane] = moved.x;
        corners->y[k][i][lane] = moved.y;
        corners->z[k][i][lane] = moved.z;
    }
}

/* Whether the metric's larger eigenvalue exceeds `most`. */
TL_INLINE bool stretches(const struct membrane_work *work, int lane, double max)
{
    double spare_u = max - work->uu[lane], spare_v = max - work->vv[lane], uv = work->uv[lane];
    return (spare_u < 0) | (spare_v < 0) | (spare_u * spare_v < uv * uv);
}

/* Batches of a run from `first` on, GROUP of them or what is left. */
struct group {
    const struct tl_preview_membrane *membranes;
    size_t count;
};

TL_INLINE struct group group_at(const struct tl_preview_membrane *membranes, size_t count, size_t first)
{
    size_t left = first < count ? count - first : 0;
    return (struct group){membranes + first, left < GROUP ? left : GROUP};
}

TL_INLINE void gather(const struct group *group, size_t k, const double *positions, struct rows *rows)
{
    if (k >= group->count)
        return;
    for (size_t line = 0; line < sizeof *group->membranes; line += TL_CACHE_LINE)
        __builtin_prefetch((const char *)&group->membranes[k + GROUP] + line);
    for (int i = 0; i < 3; i++)
        for (int lane = 0; lane < TL_BATCH; lane++)
            memcpy(rows->of[k][i][lane], &positions[group->membranes[k].from[i][lane]],
                   sizeof rows->of[k][i][lane]);
}

TL_INLINE void scatter(const struct group *group, size_t k, const struct rows *rows, double *positions)
{
    for (int i = 0; i < 3 && k < group->count; i++)
        for (int lane = 0; lane < TL_BATCH; lane++)
            memcpy(&positions[group->membranes[k].from[i][lane]], rows->of[k][i][lane],
                   sizeof rows->of[k][i][lane]);
}

/* Software pipeline: while a group waits for roots and divisions, the group before it is scattered and the
 * next one gathered. That is safe since the batches of a run share no vertex. */
TL_CLONES static void solve_run(const struct tl_preview_membrane *membranes, size_t count, double max,
                                double *positions, bool (*seen)[TL_BATCH])
{
    struct membrane_work work[GROUP];
    struct corners corners;
    struct rows in, out;
    struct group now = group_at(membranes, count, 0), before = {0};
    for (size_t k = 0; k < now.count; k++)
        gather(&now, k, positions, &in);
    for (size_t first = 0; first < count; first += GROUP) {
        const struct tl_preview_membrane *m = now.membranes;
        struct group next = group_at(membranes, count, first + GROUP);
        deinterleave(&in, now.count, &corners);
        for (size_t k = 0; k < now.count; k++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                measure(&m[k], &corners, k, lane, &work[k]);
        for (size_t k = 0; k < now.count && seen; k++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                seen[first + k][lane] = stretches(&work[k], lane, max);
        for (size_t k = 0; k < GROUP; k++) {
            for (int lane = 0; lane < TL_BATCH && k < now.count; lane++)
                solve(&m[k], lane, &work[k]);
            scatter(&before, k, &out, positions);
            gather(&next, k, positions, &in);
        }
        for (size_t k = 0; k < now.count; k++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                move_corners(&m[k], &work[k], lane, k, &corners);
        interleave(&corners, now.count, &out);
        before = now;
        now = next;
    }
    for (size_t k = 0; k < before.count; k++)
        scatter(&before, k, &out, positions);
}

/* Copies positions back from the padded array. */
TL_CLONES static void read_positions(const double *positions, struct tl_range range, vec3d *x)
{
    for (size_t i = range.from; i < range.to; i++)
        x[i] = (vec3d){positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]};
}

/* Called by all threads of a team: batches of a run in any order, runs one after the other. */
static void solve_membranes(const struct tl_energy *energy, const struct tl_stretch_watch *watch, vec3d *x)
{
    double *positions = energy->pairs.positions;
    struct tl_range mine = tl_team_range(energy->pairs.vertex_count, TL_PAIR_BLOCK);
    tl_pair_forces_load_positions(&energy->pairs, x, mine);
    tl_team_barrier();

    size_t from = 0;
    for (size_t run = 0; run < energy->membrane_run_count; run++) {
        size_t end = energy->membrane_run_ends[run];
        struct tl_range part = tl_team_range(end - from, 1);
        solve_run(energy->previewed + from + part.from, part.to - part.from, watch ? watch->max : 0,
                  positions, watch ? watch->seen + from + part.from : NULL);
        from = end;
        tl_team_barrier();
    }
    read_positions(positions, mine, x);
    tl_team_barrier();
}

/* One component of the curvature tensor, a vector and linear in the positions: L <- L + factor-weighted
 * correction. */
TL_INLINE void solve_curvature(const struct tl_bend *bend, int row, int lane,
                               struct positions x[TL_BEND_STENCIL])
{
    vec3d curvature = {0};
    for (int i = 0; i < TL_BEND_STENCIL; i++)
        curvature = vec3d_muladd(curvature, at(&x[i], lane), bend->rows[row][i][lane]);
    vec3d push = vec3d_scale(curvature, bend->factors[row][lane]);
    for (int i = 0; i < TL_BEND_STENCIL; i++)
        move(&x[i], lane, push, bend->w[i][lane] * bend->rows[row][i][lane]);
}

TL_CLONES static void solve_bend_run(const struct tl_bend *bends, size_t count, vec3d *particles)
{
    for (const struct tl_bend *bend = bends; bend < bends + count; bend++) {
        struct positions x[TL_BEND_STENCIL];
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            load(particles, bend->vertices[i], &x[i]);
        for (int row = 0; row < 3; row++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                solve_curvature(bend, row, lane, x);
        for (int i = TL_BEND_STENCIL - 1; i >= 0;
             i--) /* the first vertex last: it also stands in for missing ones, whose copies are stale */
            store(&x[i], bend->vertices[i], particles);
    }
}

static void solve_bends(const struct tl_energy *energy, vec3d *x)
{
    size_t from = 0;
    for (size_t run = 0; run < energy->bend_run_count; run++) {
        size_t end = energy->bend_run_ends[run];
        struct tl_range part = tl_team_range(end - from, 1);
        solve_bend_run(energy->bends + from + part.from, part.to - part.from, x);
        from = end;
        tl_team_barrier();
    }
}

/* ---- Links and the whole ---- */

void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles)
{
    double wa = particles->w[link->a], wb = particles->w[link->b];
    vec3d offset = vec3d_sub(particles->x[link->b], particles->x[link->a]);
    double length = vec3d_norm(offset), sum = wa + wb + link->compliance;
    if (length < NO_LENGTH || !(wa + wb > 0) || !isfinite(sum))
        return;
    vec3d push = vec3d_scale(offset, (length - link->rest) / (length * sum));
    particles->x[link->a] = vec3d_muladd(particles->x[link->a], push, wa);
    particles->x[link->b] = vec3d_muladd(particles->x[link->b], push, -wb);
}

struct forward_sweep {
    const struct tl_energy *energy;
    const struct tl_stretch_watch *watch;
    vec3d *x;
};

static void solve_on_team(void *context)
{
    const struct forward_sweep *sweep = context;
    solve_membranes(sweep->energy, sweep->watch, sweep->x);
    if (!sweep->energy->bending_is_force)
        solve_bends(sweep->energy, sweep->x);
}

void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles,
                   const struct tl_stretch_watch *watch)
{
    tl_team_run(particles->count, solve_on_team, &(struct forward_sweep){energy, watch, particles->x});
    for (size_t i = 0; i < energy->link_count; i++)
        tl_xpbd_solve_link(&energy->links[i], particles);
}
