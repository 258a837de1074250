/* Calibration of the rest strains of `preview`: see xpbd.h. */
#include "cloth/solvers/xpbd.h"

#include <string.h>

#define NO_LENGTH 1e-12

/* Strains of weft, warp and shear at positions `x`. */
TL_INLINE void measure(const struct tl_preview_membrane *m, int lane, const vec3d *x, double strains[3])
{
    vec3d corners[3], u = {0}, v = {0};
    for (int i = 0; i < 3; i++)
        corners[i] = x[m->from[i][lane] / 4];
    for (int i = 1; i < 3; i++) {
        vec3d side = vec3d_sub(corners[i], corners[0]);
        u = vec3d_muladd(u, side, m->c[i - 1][lane]);
        v = vec3d_muladd(v, side, m->d[i - 1][lane]);
    }
    double length_u = fmax(vec3d_norm(u), NO_LENGTH), length_v = fmax(vec3d_norm(v), NO_LENGTH);
    strains[0] = length_u - 1;
    strains[1] = length_v - 1;
    strains[2] = vec3d_dot(u, v) / (length_u * length_v);
}

void tl_xpbd_shift_rest(struct tl_energy *energy, const vec3d *x, const double (*applied)[3][TL_BATCH],
                        double gain, double max)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        for (int lane = 0; lane < TL_BATCH; lane++) {
            struct tl_preview_membrane *m = &energy->previewed[i];
            double strains[3];
            measure(m, lane, x, strains);
            for (int row = 0; row < 3; row++) {
                double shifted = m->rest_strain[row][lane] + gain * (applied[i][row][lane] - strains[row]);
                m->rest_strain[row][lane] = fmax(fmin(shifted, max), -max);
            }
        }
}

void tl_xpbd_reset_rest(struct tl_energy *energy)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        memset(energy->previewed[i].rest_strain, 0, sizeof energy->previewed[i].rest_strain);
}
