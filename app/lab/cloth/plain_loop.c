#include "app/lab/cloth/plain_loop.h"

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

struct tl_plain_loop {
    size_t side, spring_count;
    struct spring *springs;
    vec3d *x, *v, *forces;
    double mass, h;
};

static void add_springs(tl_plain_loop *loop, size_t across, size_t down, double stiffness)
{
    size_t side = loop->side;
    double cell = 1.0 / (double)(side - 1);
    for (size_t row = 0; row + down < side; row++)
        for (size_t column = 0; column + across < side; column++) {
            uint32_t a = (uint32_t)(row * side + column), b = a + (uint32_t)(down * side + across);
            double rest = cell * hypot((double)across, (double)down);
            loop->springs[loop->spring_count++] = (struct spring){a, b, rest, stiffness};
            if (across == 1 && down == 1) /* the other diagonal */
                loop->springs[loop->spring_count++] = (struct spring){a + 1, b - 1, rest, stiffness};
        }
}

tl_plain_loop *tl_plain_loop_create(int side)
{
    tl_plain_loop *loop = TL_NEW(tl_plain_loop);
    size_t count = (size_t)side * (size_t)side;
    loop->side = (size_t)side;
    loop->springs = TL_NEW_ARRAY(struct spring, 6 * count);
    loop->x = TL_NEW_ARRAY(vec3d, count);
    loop->v = TL_NEW_ARRAY(vec3d, count);
    loop->forces = TL_NEW_ARRAY(vec3d, count);
    loop->mass = DENSITY / (double)count;
    add_springs(loop, 1, 0, STIFFNESS);
    add_springs(loop, 0, 1, STIFFNESS);
    add_springs(loop, 1, 1, STIFFNESS / 2);
    add_springs(loop, 2, 0, STIFFNESS / 10);
    add_springs(loop, 0, 2, STIFFNESS / 10);
    double all = 4 * STIFFNESS + 4 * STIFFNESS / 2 + 4 * STIFFNESS / 10; /* on one particle */
    loop->h = SAFETY * sqrt(2 * loop->mass / all);
    for (size_t i = 0; i < count; i++) {
        size_t column = i % loop->side, row = i / loop->side;
        loop->x[i] = (vec3d){(double)column / (double)(side - 1), -(double)row / (double)(side - 1), 0};
    }
    return loop;
}

void tl_plain_loop_destroy(tl_plain_loop **loop)
{
    if (!*loop)
        return;
    free((*loop)->springs);
    free((*loop)->x);
    free((*loop)->v);
    free((*loop)->forces);
    free(*loop);
    *loop = NULL;
}

static void find_forces(tl_plain_loop *loop)
{
    vec3d *forces = loop->forces;
    for (size_t i = 0; i < loop->side * loop->side; i++)
        forces[i] = (vec3d){0, -loop->mass * GRAVITY, 0};
    for (size_t s = 0; s < loop->spring_count; s++) {
        const struct spring *spring = &loop->springs[s];
        vec3d offset = vec3d_sub(loop->x[spring->b], loop->x[spring->a]);
        double length = vec3d_norm(offset);
        double pull = spring->stiffness * (length - spring->rest) / length;
        forces[spring->a] = vec3d_muladd(forces[spring->a], offset, pull);
        forces[spring->b] = vec3d_muladd(forces[spring->b], offset, -pull);
    }
}

/* The first row is held. */
void tl_plain_loop_step(tl_plain_loop *loop)
{
    find_forces(loop);
    for (size_t i = loop->side; i < loop->side * loop->side; i++) {
        loop->v[i] = vec3d_muladd(loop->v[i], loop->forces[i], loop->h / loop->mass);
        loop->x[i] = vec3d_muladd(loop->x[i], loop->v[i], loop->h);
    }
}

double tl_plain_loop_stretch(const tl_plain_loop *loop)
{
    double longest = 0;
    for (size_t s = 0; s < loop->spring_count; s++) {
        const struct spring *spring = &loop->springs[s];
        longest = fmax(longest, vec3d_distance(loop->x[spring->a], loop->x[spring->b]) / spring->rest);
    }
    return longest;
}
