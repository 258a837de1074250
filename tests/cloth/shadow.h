/* The energy that Verlet conserves. Up to a part that is exponentially small in the step, its orbit is an
 * exact solution for a Hamiltonian near the true one, the shadow Hamiltonian. It is measured from the orbit
 * alone [Engle et al. 2005]. An additional
 * variable makes the energy homogeneous: beta' = x.dU/dx - 2 U. Any energy then is (x'.p - p'.x - beta')/2.
 * The shadow is that of the curve through the orbit's positions, momenta and betas, with beta stepped as p
 * is. The derivatives are central differences of orders up to 16; with order 2 n the error against the shadow
 * is O(h^2n). */
#ifndef TOILE_TESTS_CLOTH_SHADOW_H
#define TOILE_TESTS_CLOTH_SHADOW_H

#include "cloth/measure.h"
#include "cloth/state.h"
#include "config/base/memory.h"

#define SHADOW_REACH 8
#define SHADOW_STEPS (2 * SHADOW_REACH + 1)

struct shadow {
    double h, beta, last_slope;
    long count; /* of the recorded steps */
    vec3d *positions[SHADOW_STEPS], *momenta[SHADOW_STEPS];
    double betas[SHADOW_STEPS];
};

static inline struct shadow shadow_begin(const tl_cloth *cloth, double h)
{
    struct shadow shadow = {.h = h};
    for (int i = 0; i < SHADOW_STEPS; i++) {
        shadow.positions[i] = TL_NEW_ARRAY(vec3d, cloth->particles.count);
        shadow.momenta[i] = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    }
    return shadow;
}

static inline void shadow_end(struct shadow *shadow)
{
    for (int i = 0; i < SHADOW_STEPS; i++) {
        free(shadow->positions[i]);
        free(shadow->momenta[i]);
    }
}

/* 2 U - x.dU/dx of elastic energy and gravity, summed over free particles. */
static inline double shadow_slope(const tl_cloth *cloth)
{
    struct tl_energies energies = tl_cloth_energies(cloth);
    const struct tl_particles *p = &cloth->particles;
    vec3d *forces = TL_NEW_ARRAY(vec3d, p->count);
    tl_energy_evaluate(&cloth->energy, &cloth->fabric, p->count, p->x, forces);
    double slope = 2 * energies.elastic + energies.potential; /* gravity's is linear: 2 U - U */
    for (size_t i = 0; i < p->count; i++)
        slope += p->w[i] > 0 ? vec3d_dot(p->x[i], forces[i]) : 0;
    free(forces);
    return slope;
}

/* The coefficient of f(t + j h) - f(t - j h) in h f'(t), for 2 `reach` points. */
static inline double shadow_weight(int reach, int j)
{
    double weight = j % 2 ? 1.0 / j : -1.0 / j;
    for (int m = 1; m <= j; m++)
        weight *= (double)(reach - j + m) / (reach + m);
    return weight;
}

/* The entry j substeps from the middle one. */
static inline size_t shadow_entry(const struct shadow *shadow, int j)
{
    return (size_t)(shadow->count - 1 - SHADOW_REACH + j + SHADOW_STEPS) % SHADOW_STEPS;
}

static inline vec3d shadow_derivative(const struct shadow *shadow, int reach, vec3d *const *curve, size_t i)
{
    vec3d sum = {0};
    for (int j = 1; j <= reach; j++)
        sum = vec3d_muladd(sum,
                           vec3d_sub(curve[shadow_entry(shadow, j)][i], curve[shadow_entry(shadow, -j)][i]),
                           shadow_weight(reach, j) / shadow->h);
    return sum;
}

/* Call after every substep. */
static inline void shadow_record(struct shadow *shadow, const tl_cloth *cloth)
{
    const struct tl_particles *p = &cloth->particles;
    size_t at = (size_t)(shadow->count % SHADOW_STEPS);
    double slope = shadow_slope(cloth);
    shadow->beta -= shadow->count > 0 ? shadow->h / 2 * (slope + shadow->last_slope) : 0;
    shadow->last_slope = slope;
    shadow->betas[at] = shadow->beta;
    for (size_t i = 0; i < p->count; i++) {
        shadow->positions[at][i] = p->x[i];
        shadow->momenta[at][i] = p->w[i] > 0 ? vec3d_scale(p->v[i], 1 / p->w[i]) : (vec3d){0};
    }
    shadow->count++;
}

static inline bool shadow_is_full(const struct shadow *shadow)
{
    return shadow->count >= SHADOW_STEPS;
}

/* The shadow's energy (J) as it was SHADOW_REACH substeps ago, by differences of order 2 `reach`. */
static inline double shadow_energy(const struct shadow *shadow, const tl_cloth *cloth, int reach)
{
    size_t middle = shadow_entry(shadow, 0);
    double sum = 0;
    for (int j = 1; j <= reach; j++)
        sum -= shadow_weight(reach, j) / shadow->h *
               (shadow->betas[shadow_entry(shadow, j)] - shadow->betas[shadow_entry(shadow, -j)]);
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (cloth->particles.w[i] > 0)
            sum +=
                vec3d_dot(shadow_derivative(shadow, reach, shadow->positions, i),
                          shadow->momenta[middle][i]) -
                vec3d_dot(shadow_derivative(shadow, reach, shadow->momenta, i), shadow->positions[middle][i]);
    return sum / 2;
}

/* The h^2 term (J) of the shadow in closed form: h^2 (v.U''v / 12 - |M^-1/2 U'|^2 / 24), from the positions
 * and velocities at a whole step [Hairer et al. 2006, IX.3].
 * U''v is a difference of forces over a displacement of 0.1 um. */
static inline double shadow_second_order(const tl_cloth *cloth, double h)
{
    const struct tl_particles *p = &cloth->particles;
    vec3d *forces[3], *x = TL_NEW_ARRAY(vec3d, p->count + 1);
    double fastest = 0, pushed = 0, curved = 0;
    for (size_t i = 0; i < p->count; i++)
        fastest = fmax(fastest, vec3d_norm(p->v[i]));
    double seconds = 1e-7 / fmax(fastest, 1e-9);
    for (int k = 0; k < 3; k++) {
        forces[k] = TL_NEW_ARRAY(vec3d, p->count);
        for (size_t i = 0; i < p->count; i++)
            x[i] = vec3d_muladd(p->x[i], p->v[i], p->w[i] > 0 ? (k - 1) * seconds : 0);
        tl_energy_evaluate(&cloth->energy, &cloth->fabric, p->count, x, forces[k]);
    }
    for (size_t i = 0; i < p->count; i++) {
        vec3d force = forces[1][i];
        if (!(p->w[i] > 0))
            continue;
        force.y -= cloth->params.gravity / p->w[i];
        pushed += p->w[i] * vec3d_dot(force, force);
        curved += vec3d_dot(vec3d_sub(forces[0][i], forces[2][i]), p->v[i]) / (2 * seconds);
    }
    for (int k = 0; k < 3; k++)
        free(forces[k]);
    free(x);
    return h * h * (curved / 12 - pushed / 24);
}

#endif
