/* The backward half of a symmetric sweep of `preview`: bends, then membranes, each in reverse (xpbd.h). Plain
 * loops, since meshes of needles are rare. */
#include "cloth/mesh/team.h"
#include "cloth/solvers/xpbd.h"
#include "config/base/simd.h"

#define NO_LENGTH 1e-12

/* A membrane while its rows are solved: the columns of F, and the accumulated corrections. Vertex i moves by
 * w_i (c_i push_c + d_i push_d). */
struct membrane_state {
    vec3d u, v, push_c, push_d;
};

TL_INLINE void push(const struct tl_preview_membrane *m, int lane, vec3d c, vec3d d,
                    struct membrane_state *state)
{
    state->push_c = vec3d_add(state->push_c, c);
    state->push_d = vec3d_add(state->push_d, d);
    state->u = vec3d_muladd(vec3d_muladd(state->u, c, m->cc[lane]), d, m->cd[lane]);
    state->v = vec3d_muladd(vec3d_muladd(state->v, c, m->cd[lane]), d, m->dd[lane]);
}

/* The same formula as solve_shear in xpbd.c. */
TL_INLINE void push_shear(const struct tl_preview_membrane *m, int lane, struct membrane_state *state)
{
    vec3d u = state->u, v = state->v;
    double a = vec3d_dot(u, u), b = vec3d_dot(v, v), g = vec3d_dot(u, v), p = a * b;
    double square = (p - g * g) * (m->cc[lane] * b - 2 * m->cd[lane] * g + m->dd[lane] * a);
    double sum = m->shear[lane] * p * p + square, root = sqrt(fmax(p, NO_LENGTH * NO_LENGTH));
    double off = g - m->rest_strain[2][lane] * root, multiplier = sum > 0 ? -off / sum : 0;
    push(m, lane, vec3d_scale(vec3d_muladd(vec3d_scale(v, p), u, -b * g), multiplier),
         vec3d_scale(vec3d_muladd(vec3d_scale(u, p), v, -a * g), multiplier), state);
}

TL_INLINE vec3d stretch_push(vec3d f, double factor, double rest)
{
    return vec3d_scale(f, factor * (1 - (1 + rest) / fmax(vec3d_norm(f), NO_LENGTH)));
}

TL_INLINE void solve_membrane(const struct tl_preview_membrane *m, int lane, vec3d corners[3][TL_BATCH])
{
    struct membrane_state state = {0};
    for (int i = 1; i < 3; i++) {
        vec3d side = vec3d_sub(corners[i][lane], corners[0][lane]);
        state.u = vec3d_muladd(state.u, side, m->c[i - 1][lane]);
        state.v = vec3d_muladd(state.v, side, m->d[i - 1][lane]);
    }
    push_shear(m, lane, &state);
    push(m, lane, (vec3d){0}, stretch_push(state.v, m->warp[lane], m->rest_strain[1][lane]), &state);
    push(m, lane, stretch_push(state.u, m->weft[lane], m->rest_strain[0][lane]), (vec3d){0}, &state);
    vec3d ways[3];
    for (int i = 1; i < 3; i++)
        ways[i] = vec3d_muladd(vec3d_scale(state.push_c, m->c[i - 1][lane]), state.push_d, m->d[i - 1][lane]);
    ways[0] = vec3d_scale(vec3d_add(ways[1], ways[2]), -1);
    for (int i = 0; i < 3; i++)
        corners[i][lane] = vec3d_muladd(corners[i][lane], ways[i], m->w[i][lane]);
}

TL_CLONES static void solve_membranes(const struct tl_preview_membrane *membranes, struct tl_range range,
                                      vec3d *x)
{
    for (const struct tl_preview_membrane *m = membranes + range.from; m < membranes + range.to; m++) {
        vec3d corners[3][TL_BATCH];
        for (int i = 0; i < 3; i++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                corners[i][lane] = x[m->from[i][lane] / 4];
        for (int lane = 0; lane < TL_BATCH; lane++)
            solve_membrane(m, lane, corners);
        for (int i = 0; i < 3; i++)
            for (int lane = 0; lane < TL_BATCH; lane++)
                x[m->from[i][lane] / 4] = corners[i][lane];
    }
}

static void solve_bend(const struct tl_bend *bend, int lane, vec3d *x)
{
    for (int row = 2; row >= 0; row--) {
        vec3d curvature = {0};
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            curvature = vec3d_muladd(curvature, x[bend->vertices[i][lane]], bend->rows[row][i][lane]);
        for (int i = 0; i < TL_BEND_STENCIL; i++) {
            uint32_t vertex = bend->vertices[i][lane];
            double share = bend->factors[row][lane] * bend->w[i][lane] * bend->rows[row][i][lane];
            x[vertex] = vec3d_muladd(x[vertex], curvature, share);
        }
    }
}

/* The elements of a run share no vertex: their order does not matter. */
static struct tl_range part_of_run(const size_t *ends, size_t run)
{
    size_t from = run > 0 ? ends[run - 1] : 0;
    struct tl_range part = tl_team_range(ends[run] - from, 1);
    return (struct tl_range){from + part.from, from + part.to};
}

struct backward_sweep {
    const struct tl_energy *energy;
    vec3d *x;
};

static void solve_on_team(void *context)
{
    const struct backward_sweep *sweep = context;
    const struct tl_energy *energy = sweep->energy;
    vec3d *x = sweep->x;
    for (size_t run = energy->bend_run_count; run-- > 0 && !energy->bending_is_force;) {
        struct tl_range part = part_of_run(energy->bend_run_ends, run);
        for (size_t i = part.from * TL_BATCH; i < part.to * TL_BATCH; i++)
            solve_bend(&energy->bends[i / TL_BATCH], (int)(i % TL_BATCH), x);
        tl_team_barrier();
    }
    for (size_t run = energy->membrane_run_count; run-- > 0;) {
        solve_membranes(energy->previewed, part_of_run(energy->membrane_run_ends, run), x);
        tl_team_barrier();
    }
}

void tl_xpbd_solve_backward(const struct tl_energy *energy, struct tl_particles *particles)
{
    for (size_t i = energy->link_count; i-- > 0;)
        tl_xpbd_solve_link(&energy->links[i], particles);
    tl_team_run(particles->count, solve_on_team, &(struct backward_sweep){energy, particles->x});
}
