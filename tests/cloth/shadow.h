/* The energy that Verlet keeps. Its orbit solves exactly, but for a part that is exponentially small in the
 * step, the equations of a Hamiltonian near the true one: which is measured from the orbit alone (Engle,
 * Skeel and Drees 2005, "Monitoring energy drift with shadow Hamiltonians"). With a further variable that
 * makes the energy homogeneous, beta' = x.dU/dx - 2 U, any energy is (x'.p - p'.x - beta')/2; the shadow is
 * that of the curve through the orbit's places, momenta and betas, beta stepped as p is. Its derivatives here
 * are central differences of order 16. */
#ifndef TOILE_TESTS_CLOTH_SHADOW_H
#define TOILE_TESTS_CLOTH_SHADOW_H

#include "cloth/state.h"
#include "config/memory.h"

#define SHADOW_REACH 8
#define SHADOW_STEPS (2 * SHADOW_REACH + 1)

struct shadow {
    double h, beta, last_slope;
    long count; /* of what was recorded */
    vec3d *places[SHADOW_STEPS], *momenta[SHADOW_STEPS];
    double betas[SHADOW_STEPS];
};

static inline struct shadow shadow_begin(const tl_cloth *cloth, double h)
{
    struct shadow shadow = {.h = h};
    for (int i = 0; i < SHADOW_STEPS; i++) {
        shadow.places[i] = TL_NEW_ARRAY(vec3d, cloth->particles.count);
        shadow.momenta[i] = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    }
    return shadow;
}

static inline void shadow_end(struct shadow *shadow)
{
    for (int i = 0; i < SHADOW_STEPS; i++) {
        free(shadow->places[i]);
        free(shadow->momenta[i]);
    }
}

/* 2 U - x.dU/dx of elastic energy and gravity's, of what is not held. */
static inline double shadow_slope(const tl_cloth *cloth)
{
    struct tl_energies energies = tl_cloth_energies(cloth);
    const struct tl_particles *p = &cloth->particles;
    vec3d *forces = TL_NEW_ARRAY(vec3d, p->count);
    tl_energy_forces(&cloth->energy, &cloth->fabric, p->count, p->x, forces);
    double slope = 2 * energies.elastic + energies.potential; /* gravity's is linear: 2 U - U */
    for (size_t i = 0; i < p->count; i++)
        slope += p->w[i] > 0 ? vec3d_dot(p->x[i], forces[i]) : 0;
    free(forces);
    return slope;
}

/* The weight of f(t + j h) - f(t - j h) in h f'(t). */
static inline double shadow_weight(int j)
{
    double weight = j % 2 ? 1.0 / j : -1.0 / j;
    for (int m = 1; m <= j; m++)
        weight *= (double)(SHADOW_REACH - j + m) / (SHADOW_REACH + m);
    return weight;
}

static inline vec3d shadow_derivative(const struct shadow *shadow, vec3d *const *curve, size_t i, long middle)
{
    vec3d sum = {0};
    for (int j = 1; j <= SHADOW_REACH; j++)
        sum = vec3d_muladd(sum,
                           vec3d_sub(curve[(middle + j) % SHADOW_STEPS][i],
                                     curve[(middle - j + SHADOW_STEPS) % SHADOW_STEPS][i]),
                           shadow_weight(j) / shadow->h);
    return sum;
}

/* After every substep. The shadow's energy (J) as it was SHADOW_REACH substeps ago; NAN at first. */
static inline double shadow_record(struct shadow *shadow, const tl_cloth *cloth)
{
    const struct tl_particles *p = &cloth->particles;
    long at = shadow->count % SHADOW_STEPS, middle = (at + SHADOW_STEPS - SHADOW_REACH) % SHADOW_STEPS;
    double slope = shadow_slope(cloth), sum = 0;
    shadow->beta -= shadow->count > 0 ? shadow->h / 2 * (slope + shadow->last_slope) : 0;
    shadow->last_slope = slope;
    shadow->betas[at] = shadow->beta;
    for (size_t i = 0; i < p->count; i++) {
        shadow->places[at][i] = p->x[i];
        shadow->momenta[at][i] = p->w[i] > 0 ? vec3d_scale(p->v[i], 1 / p->w[i]) : (vec3d){0};
    }
    if (++shadow->count < SHADOW_STEPS)
        return NAN;
    for (int j = 1; j <= SHADOW_REACH; j++)
        sum -= shadow_weight(j) / shadow->h *
               (shadow->betas[(middle + j) % SHADOW_STEPS] -
                shadow->betas[(middle - j + SHADOW_STEPS) % SHADOW_STEPS]);
    for (size_t i = 0; i < p->count; i++)
        if (p->w[i] > 0)
            sum +=
                vec3d_dot(shadow_derivative(shadow, shadow->places, i, middle), shadow->momenta[middle][i]) -
                vec3d_dot(shadow_derivative(shadow, shadow->momenta, i, middle), shadow->places[middle][i]);
    return sum / 2;
}

#endif
