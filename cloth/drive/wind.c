#include "cloth/drive/wind.h"

#include <string.h>

/* Largest share of the relative speed that one step may remove. */
#define MAX_SPEED_LOSS 0.5

vec3d tl_wind_at(const struct tl_wind *wind, vec3d point)
{
    static const double hertz[3] = {0.31, 0.83, 1.9}, shares[3] = {0.5, 0.3, 0.2};
    double speed = vec3d_norm(wind->velocity), wave = 0;
    if (!(speed > 0))
        return wind->velocity;
    double late_s = wind->time_s - vec3d_dot(point, wind->velocity) / (speed * speed);
    for (int i = 0; i < 3; i++)
        wave += shares[i] * sin(2 * M_PI * hertz[i] * late_s);
    return vec3d_scale(wind->velocity, 1 + wind->gust * wave);
}

void tl_wind_forces(const struct tl_wind *wind, const struct tl_topology *topology, double h,
                    const struct tl_particles *particles, vec3d *forces)
{
    const vec3d *x = particles->x, *v = particles->v;
    double per_speed =
        0.5 * TL_AIR_DENSITY / wind->areal_density; /* 1/m: slowing per speed of a free sheet */
    memset(forces, 0, particles->count * sizeof *forces);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *i = topology->triangles[t];
        vec3d area = vec3d_cross(vec3d_sub(x[i[1]], x[i[0]]), vec3d_sub(x[i[2]], x[i[0]]));
        vec3d middle = vec3d_scale(vec3d_add(vec3d_add(x[i[0]], x[i[1]]), x[i[2]]), 1.0 / 3);
        vec3d speed = vec3d_scale(vec3d_add(vec3d_add(v[i[0]], v[i[1]]), v[i[2]]), 1.0 / 3);
        vec3d normal = vec3d_unit_or(area, (vec3d){0});
        double against = vec3d_dot(normal, vec3d_sub(tl_wind_at(wind, middle), speed));
        double speed_loss = per_speed * fabs(against) * h,
               reduction = speed_loss > MAX_SPEED_LOSS ? MAX_SPEED_LOSS / speed_loss : 1;
        double pressure = 0.5 * TL_AIR_DENSITY * fabs(against) * against * reduction;
        for (int corner = 0; corner < 3;
             corner++) /* half the cross product is the area, a third of it each */
            forces[i[corner]] = vec3d_muladd(forces[i[corner]], area, pressure / 6);
    }
}
