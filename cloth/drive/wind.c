#include "cloth/drive/wind.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Largest share of the relative speed that one step may remove. */
#define MAX_SPEED_LOSS 0.5
/* Between entries of the table of gusts. Linear interpolation is off by at most (2 pi f)^2 / 8 times its
 * square times the amplitude: 2e-5 of the gusts' amplitude in all. */
#define GUST_STEP_S 0.002

/* The gusts' share of the wind's speed, from -1 to 1, at a time in air that moves with the wind. */
static double gust_at(double late_s)
{
    static const double hertz[3] = {0.31, 0.83, 1.9}, shares[3] = {0.5, 0.3, 0.2};
    double wave = 0;
    for (int i = 0; i < 3; i++)
        wave += shares[i] * sin(2 * M_PI * hertz[i] * late_s);
    return wave;
}

/* The delay of gusts over a metre, s/m: the wind's direction over its speed. 0
 * without wind. */
static vec3d lateness(const struct tl_wind *wind)
{
    double squared = vec3d_dot(wind->velocity, wind->velocity);
    return squared > 0 ? vec3d_scale(wind->velocity, 1 / squared) : (vec3d){0};
}

vec3d tl_wind_at(const struct tl_wind *wind, vec3d point)
{
    double late_s = wind->time_s - vec3d_dot(point, lateness(wind));
    return vec3d_scale(wind->velocity, 1 + wind->gust * gust_at(late_s));
}

/* The gusts over all of the cloth. They depend on one number only, so a table of that saves the sines of most
 * triangles; in wind so slow that it would be longer than the cloth has triangles there is none. */
struct gust_table {
    vec3d lateness;
    double first_s;
    size_t count; /* 0: no table */
    double *gusts;
};

static struct gust_table tabulate(const struct tl_wind *wind, size_t triangle_count,
                                  const struct tl_particles *particles)
{
    struct gust_table table = {.lateness = lateness(wind)};
    double minimum = HUGE_VAL, maximum = -HUGE_VAL;
    for (size_t i = 0; i < particles->count; i++) {
        double late_s = wind->time_s - vec3d_dot(particles->x[i], table.lateness);
        minimum = fmin(minimum, late_s);
        maximum = fmax(maximum, late_s);
    }
    double count = ceil((maximum - minimum) / GUST_STEP_S) + 2;
    if (!(count < (double)triangle_count))
        return table;
    table.first_s = minimum;
    table.count = (size_t)count;
    table.gusts = TL_NEW_ARRAY(double, table.count);
    for (size_t i = 0; i < table.count; i++)
        table.gusts[i] = gust_at(minimum + GUST_STEP_S * (double)i);
    return table;
}

static vec3d wind_from(const struct gust_table *table, const struct tl_wind *wind, vec3d point)
{
    double late_s = wind->time_s - vec3d_dot(point, table->lateness), gust;
    if (table->count == 0)
        gust = gust_at(late_s);
    else {
        double at = fmax((late_s - table->first_s) / GUST_STEP_S, 0);
        size_t i = (size_t)fmin(at, (double)(table->count - 2));
        gust = table->gusts[i] + (table->gusts[i + 1] - table->gusts[i]) * (at - (double)i);
    }
    return vec3d_scale(wind->velocity, 1 + wind->gust * gust);
}

void tl_wind_forces(const struct tl_wind *wind, const struct tl_topology *topology, double h,
                    const struct tl_particles *particles, vec3d *forces)
{
    const vec3d *x = particles->x, *v = particles->v;
    double per_speed =
        0.5 * TL_AIR_DENSITY / wind->areal_density; /* 1/m: slowing per speed of a free sheet */
    struct gust_table table = tabulate(wind, topology->triangle_count, particles);
    memset(forces, 0, particles->count * sizeof *forces);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *i = topology->triangles[t];
        vec3d area = vec3d_cross(vec3d_sub(x[i[1]], x[i[0]]), vec3d_sub(x[i[2]], x[i[0]]));
        vec3d middle = vec3d_scale(vec3d_add(vec3d_add(x[i[0]], x[i[1]]), x[i[2]]), 1.0 / 3);
        vec3d speed = vec3d_scale(vec3d_add(vec3d_add(v[i[0]], v[i[1]]), v[i[2]]), 1.0 / 3);
        vec3d normal = vec3d_unit_or(area, (vec3d){0});
        double against = vec3d_dot(normal, vec3d_sub(wind_from(&table, wind, middle), speed));
        double speed_loss = per_speed * fabs(against) * h,
               reduction = speed_loss > MAX_SPEED_LOSS ? MAX_SPEED_LOSS / speed_loss : 1;
        double pressure = 0.5 * TL_AIR_DENSITY * fabs(against) * against * reduction;
        for (int corner = 0; corner < 3;
             corner++) /* half the cross product is the area, a third of it each */
            forces[i[corner]] = vec3d_muladd(forces[i[corner]], area, pressure / 6);
    }
    free(table.gusts);
}
