#include "app/lab/trade/baseline.h"

#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

#include <stdint.h>
#include <stdlib.h>

#define DENSITY   0.2    /* kg/m^2 */
#define STIFFNESS 1000.0 /* N/m, of structural springs */
#define GRAVITY   9.81
/* Below the critical step of Verlet's method, for which h_c = min sqrt(2 m / sum k) is a lower bound. */
#define SAFETY 0.9

struct spring {
    uint32_t a, b;
    double rest, stiffness;
};

struct tl_baseline {
    size_t side, spring_count;
    struct spring *springs;
    vec3d *x, *v, *forces;
    double mass, h;
};

static void add_springs(tl_baseline *baseline, size_t across, size_t down, double stiffness)
{
    size_t side = baseline->side;
    double cell = 1.0 / (double)(side - 1);
    for (size_t row = 0; row + down < side; row++)
        for (size_t column = 0; column + across < side; column++) {
            uint32_t a = (uint32_t)(row * side + column), b = a + (uint32_t)(down * side + across);
            double rest = cell * hypot((double)across, (double)down);
            baseline->springs[baseline->spring_count++] = (struct spring){a, b, rest, stiffness};
            if (across == 1 && down == 1) /* the other diagonal */
                baseline->springs[baseline->spring_count++] = (struct spring){a + 1, b - 1, rest, stiffness};
        }
}

tl_baseline *tl_baseline_create(int side)
{
    tl_baseline *baseline = TL_NEW(tl_baseline);
    size_t count = (size_t)side * (size_t)side;
    baseline->side = (size_t)side;
    baseline->springs = TL_NEW_ARRAY(struct spring, 6 * count);
    baseline->x = TL_NEW_ARRAY(vec3d, count);
    baseline->v = TL_NEW_ARRAY(vec3d, count);
    baseline->forces = TL_NEW_ARRAY(vec3d, count);
    baseline->mass = DENSITY / (double)count;
    add_springs(baseline, 1, 0, STIFFNESS);
    add_springs(baseline, 0, 1, STIFFNESS);
    add_springs(baseline, 1, 1, STIFFNESS / 2);
    add_springs(baseline, 2, 0, STIFFNESS / 10);
    add_springs(baseline, 0, 2, STIFFNESS / 10);
    double all = 4 * STIFFNESS + 4 * STIFFNESS / 2 + 4 * STIFFNESS / 10; /* on one particle */
    baseline->h = SAFETY * sqrt(2 * baseline->mass / all);
    for (size_t i = 0; i < count; i++) {
        size_t column = i % baseline->side, row = i / baseline->side;
        baseline->x[i] = (vec3d){(double)column / (double)(side - 1), -(double)row / (double)(side - 1), 0};
    }
    return baseline;
}

void tl_baseline_destroy(tl_baseline **baseline)
{
    if (!*baseline)
        return;
    free((*baseline)->springs);
    free((*baseline)->x);
    free((*baseline)->v);
    free((*baseline)->forces);
    free(*baseline);
    *baseline = NULL;
}

static void find_forces(tl_baseline *baseline)
{
    vec3d *forces = baseline->forces;
    for (size_t i = 0; i < baseline->side * baseline->side; i++)
        forces[i] = (vec3d){0, -baseline->mass * GRAVITY, 0};
    for (size_t s = 0; s < baseline->spring_count; s++) {
        const struct spring *spring = &baseline->springs[s];
        vec3d apart = vec3d_sub(baseline->x[spring->b], baseline->x[spring->a]);
        double length = vec3d_norm(apart);
        double pull = spring->stiffness * (length - spring->rest) / length;
        forces[spring->a] = vec3d_muladd(forces[spring->a], apart, pull);
        forces[spring->b] = vec3d_muladd(forces[spring->b], apart, -pull);
    }
}

/* The first row is held. */
void tl_baseline_step(tl_baseline *baseline)
{
    find_forces(baseline);
    for (size_t i = baseline->side; i < baseline->side * baseline->side; i++) {
        baseline->v[i] = vec3d_muladd(baseline->v[i], baseline->forces[i], baseline->h / baseline->mass);
        baseline->x[i] = vec3d_muladd(baseline->x[i], baseline->v[i], baseline->h);
    }
}

double tl_baseline_stretch(const tl_baseline *baseline)
{
    double longest = 0;
    for (size_t s = 0; s < baseline->spring_count; s++) {
        const struct spring *spring = &baseline->springs[s];
        longest =
            fmax(longest, vec3d_distance(baseline->x[spring->a], baseline->x[spring->b]) / spring->rest);
    }
    return longest;
}
