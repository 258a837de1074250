#include "app/lab/trade/baseline.h"

#include "cloth/mesh/vec3d.h"
#include "config/memory.h"

#include <stdint.h>
#include <stdlib.h>

#define DENSITY   0.2    /* kg/m^2 */
#define STIFFNESS 1000.0 /* N/m, of structural springs */
#define GRAVITY   9.81
/* h_c = min sqrt(2 m / sum k) is a bound from below: CLOTH.md section 2. */
#define SAFETY 0.9

struct spring {
    uint32_t a, b;
    double rest, stiffness;
};

struct tl_ruler {
    size_t side, spring_count;
    struct spring *springs;
    vec3d *x, *v, *forces;
    double mass, h;
};

static void add_springs(tl_ruler *ruler, size_t across, size_t down, double stiffness)
{
    size_t side = ruler->side;
    double cell = 1.0 / (double)(side - 1);
    for (size_t row = 0; row + down < side; row++)
        for (size_t column = 0; column + across < side; column++) {
            uint32_t a = (uint32_t)(row * side + column), b = a + (uint32_t)(down * side + across);
            double rest = cell * hypot((double)across, (double)down);
            ruler->springs[ruler->spring_count++] = (struct spring){a, b, rest, stiffness};
            if (across == 1 && down == 1) /* the other diagonal */
                ruler->springs[ruler->spring_count++] = (struct spring){a + 1, b - 1, rest, stiffness};
        }
}

tl_ruler *tl_ruler_create(int side)
{
    tl_ruler *ruler = TL_NEW(tl_ruler);
    size_t count = (size_t)side * (size_t)side;
    ruler->side = (size_t)side;
    ruler->springs = TL_NEW_ARRAY(struct spring, 6 * count);
    ruler->x = TL_NEW_ARRAY(vec3d, count);
    ruler->v = TL_NEW_ARRAY(vec3d, count);
    ruler->forces = TL_NEW_ARRAY(vec3d, count);
    ruler->mass = DENSITY / (double)count;
    add_springs(ruler, 1, 0, STIFFNESS);
    add_springs(ruler, 0, 1, STIFFNESS);
    add_springs(ruler, 1, 1, STIFFNESS / 2);
    add_springs(ruler, 2, 0, STIFFNESS / 10);
    add_springs(ruler, 0, 2, STIFFNESS / 10);
    double all = 4 * STIFFNESS + 4 * STIFFNESS / 2 + 4 * STIFFNESS / 10; /* on one particle */
    ruler->h = SAFETY * sqrt(2 * ruler->mass / all);
    for (size_t i = 0; i < count; i++) {
        size_t column = i % ruler->side, row = i / ruler->side;
        ruler->x[i] = (vec3d){(double)column / (double)(side - 1), -(double)row / (double)(side - 1), 0};
    }
    return ruler;
}

void tl_ruler_destroy(tl_ruler **ruler)
{
    if (!*ruler)
        return;
    free((*ruler)->springs);
    free((*ruler)->x);
    free((*ruler)->v);
    free((*ruler)->forces);
    free(*ruler);
    *ruler = NULL;
}

static void find_forces(tl_ruler *ruler)
{
    vec3d *forces = ruler->forces;
    for (size_t i = 0; i < ruler->side * ruler->side; i++)
        forces[i] = (vec3d){0, -ruler->mass * GRAVITY, 0};
    for (size_t s = 0; s < ruler->spring_count; s++) {
        const struct spring *spring = &ruler->springs[s];
        vec3d apart = vec3d_sub(ruler->x[spring->b], ruler->x[spring->a]);
        double length = vec3d_norm(apart);
        double pull = spring->stiffness * (length - spring->rest) / length;
        forces[spring->a] = vec3d_muladd(forces[spring->a], apart, pull);
        forces[spring->b] = vec3d_muladd(forces[spring->b], apart, -pull);
    }
}

/* The first row is held. */
void tl_ruler_step(tl_ruler *ruler)
{
    find_forces(ruler);
    for (size_t i = ruler->side; i < ruler->side * ruler->side; i++) {
        ruler->v[i] = vec3d_muladd(ruler->v[i], ruler->forces[i], ruler->h / ruler->mass);
        ruler->x[i] = vec3d_muladd(ruler->x[i], ruler->v[i], ruler->h);
    }
}

double tl_ruler_stretch(const tl_ruler *ruler)
{
    double longest = 0;
    for (size_t s = 0; s < ruler->spring_count; s++) {
        const struct spring *spring = &ruler->springs[s];
        longest = fmax(longest, vec3d_distance(ruler->x[spring->a], ruler->x[spring->b]) / spring->rest);
    }
    return longest;
}
