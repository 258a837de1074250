#include "cloth/xpbd.h"

/* Shorter than this a vector has no direction to push along. */
#define NO_LENGTH 1e-12

/* ---- Batches ---- */

/* The wider of the two where the processor has it: both give the same bits, as neither contracts. Under the
 * address sanitizer there is one only: resolvers run before it is ready. */
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("avx2", "default")))
#else
#define WIDE
#endif
#define INLINE static inline __attribute__((always_inline))

typedef double lanes __attribute__((vector_size(8 * TL_BATCH)));
typedef double lanes_in_memory __attribute__((vector_size(8 * TL_BATCH), aligned(8)));
typedef long long mask __attribute__((vector_size(8 * TL_BATCH)));

struct lanes3 {
    lanes x, y, z;
};

INLINE lanes lanes_of(const double *values)
{
    return *(const lanes_in_memory *)values;
}

INLINE lanes choose(mask which, lanes yes, lanes no)
{
    return (lanes)((which & (mask)yes) | (~which & (mask)no));
}

INLINE lanes root(lanes v)
{
    for (int i = 0; i < TL_BATCH; i++)
        v[i] = sqrt(v[i]);
    return v;
}

INLINE lanes dot(struct lanes3 a, struct lanes3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

INLINE struct lanes3 scale(struct lanes3 a, lanes s)
{
    return (struct lanes3){a.x * s, a.y * s, a.z * s};
}

INLINE struct lanes3 muladd(struct lanes3 a, struct lanes3 b, lanes s)
{
    return (struct lanes3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

INLINE struct lanes3 load(const struct tl_particles *particles, const uint32_t *v)
{
    const vec3d *x = particles->x;
    return (struct lanes3){{x[v[0]].x, x[v[1]].x, x[v[2]].x, x[v[3]].x},
                           {x[v[0]].y, x[v[1]].y, x[v[2]].y, x[v[3]].y},
                           {x[v[0]].z, x[v[1]].z, x[v[2]].z, x[v[3]].z}};
}

INLINE lanes load_inverse_masses(const struct tl_particles *particles, const uint32_t *v)
{
    return (lanes){particles->w[v[0]], particles->w[v[1]], particles->w[v[2]], particles->w[v[3]]};
}

INLINE void store(struct lanes3 x, const uint32_t *v, struct tl_particles *particles)
{
    for (int lane = 0; lane < TL_BATCH; lane++)
        particles->x[v[lane]] = (vec3d){x.x[lane], x.y[lane], x.z[lane]};
}

/* What a stretch C = |F| - 1 of gradient row_i F/|F| pushes, in units of F. */
INLINE lanes stretch_push(struct lanes3 f, lanes factor)
{
    const lanes zero = {0}, one = {1, 1, 1, 1};
    lanes squared = dot(f, f);
    mask has_direction = squared > NO_LENGTH * NO_LENGTH;
    return choose(has_direction, factor * (one - one / root(choose(has_direction, squared, one))), zero);
}

/* Both stretches and the shear, one after the other. A push p on row c moves vertex i by w_i c_i p, and so
 * F_u by cc p and F_v by cd p: the three are solved on F alone, and the vertices move once. */
INLINE void solve_membrane(const struct tl_membrane *m, struct tl_particles *particles)
{
    const lanes zero = {0}, one = {1, 1, 1, 1};
    struct lanes3 x[3] = {0}, u = {0}, v = {0};
    for (int i = 0; i < 3; i++) {
        x[i] = load(particles, m->vertices[i]);
        u = muladd(u, x[i], lanes_of(m->c[i]));
        v = muladd(v, x[i], lanes_of(m->d[i]));
    }
    lanes cc = lanes_of(m->cc), cd = lanes_of(m->cd), dd = lanes_of(m->dd);
    struct lanes3 push_c = scale(u, stretch_push(u, lanes_of(m->weft)));
    u = muladd(u, push_c, cc);
    v = muladd(v, push_c, cd);
    struct lanes3 push_d = scale(v, stretch_push(v, lanes_of(m->warp)));
    u = muladd(u, push_d, cd);
    v = muladd(v, push_d, dd);

    /* C = cosine between the threads, of gradient c_i (v/|v| - C u/|u|)/|u| + d_i (u/|u| - C v/|v|)/|v|. */
    lanes uu = dot(u, u), vv = dot(v, v);
    mask has_angle = (uu > NO_LENGTH * NO_LENGTH) & (vv > NO_LENGTH * NO_LENGTH);
    uu = choose(has_angle, uu, one);
    vv = choose(has_angle, vv, one);
    lanes both = one / root(uu * vv), cosine = dot(u, v) * both;
    struct lanes3 along_u = muladd(scale(v, both), u, -cosine / uu);
    struct lanes3 along_v = muladd(scale(u, both), v, -cosine / vv);
    lanes sum = lanes_of(m->shear) + cc * dot(along_u, along_u) + 2 * cd * dot(along_u, along_v) +
                dd * dot(along_v, along_v);
    mask resists = has_angle & (sum > 0);
    lanes multiplier = choose(resists, -cosine / choose(resists, sum, one), zero);
    push_c = muladd(push_c, along_u, multiplier);
    push_d = muladd(push_d, along_v, multiplier);
    for (int i = 0; i < 3; i++) {
        lanes w = load_inverse_masses(particles, m->vertices[i]);
        x[i] = muladd(muladd(x[i], push_c, w * lanes_of(m->c[i])), push_d, w * lanes_of(m->d[i]));
        store(x[i], m->vertices[i], particles);
    }
}

WIDE static void solve_membranes(const struct tl_energy *energy, struct tl_particles *particles)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        solve_membrane(&energy->membranes[i], particles);
}

/* The three components of the curvature: vectors, linear in the positions. */
INLINE void solve_bend(const struct tl_bend *bend, struct tl_particles *particles)
{
    struct lanes3 x[TL_BEND_STENCIL] = {0};
    lanes w[TL_BEND_STENCIL] = {0};
    for (int i = 0; i < TL_BEND_STENCIL; i++) {
        x[i] = load(particles, bend->vertices[i]);
        w[i] = load_inverse_masses(particles, bend->vertices[i]);
    }
    for (int row = 0; row < 3; row++) {
        struct lanes3 curvature = scale(x[0], lanes_of(bend->rows[row][0]));
        for (int i = 1; i < TL_BEND_STENCIL; i++)
            curvature = muladd(curvature, x[i], lanes_of(bend->rows[row][i]));
        struct lanes3 push = scale(curvature, lanes_of(bend->factors[row]));
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            x[i] = muladd(x[i], push, w[i] * lanes_of(bend->rows[row][i]));
    }
    for (int i = TL_BEND_STENCIL - 1; i >= 0; i--) /* the first last: it stands in for missing ones */
        store(x[i], bend->vertices[i], particles);
}

WIDE static void solve_bends(const struct tl_energy *energy, struct tl_particles *particles)
{
    for (size_t i = 0; i < energy->bend_count; i++)
        solve_bend(&energy->bends[i], particles);
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
    solve_membranes(energy, particles);
    solve_bends(energy, particles);
    for (size_t i = 0; i < energy->link_count; i++)
        tl_xpbd_solve_link(&energy->links[i], particles);
}
