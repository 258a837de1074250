#include "assets/swatch/swatch_internal.h"

static bool has_position(const struct tl_swatch_lamp *lamp)
{
    return lamp->position_mm[2] > 0;
}

double tl_swatch_unit(double v[3])
{
    double length = sqrt(tl_swatch_dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length;
}

double tl_swatch_mean_mm(const struct tl_swatch_rig *rig)
{
    double sum = 0, count = 0;
    for (size_t k = 0; k < rig->count; k++) {
        const float *at = rig->lamps[k].position_mm;
        if (!has_position(&rig->lamps[k]))
            continue;
        sum += hypot(hypot((double)at[0], (double)at[1]), (double)at[2]);
        count++;
    }
    return count > 0 ? sum / count : 1;
}

struct tl_swatch_light tl_swatch_light_at(const struct tl_swatch_lamp *lamp, double mean_mm, double x,
                                          double y)
{
    const double degree = 3.14159265358979323846 / 180, azimuth = degree * (double)lamp->azimuth_deg,
                 elevation = degree * (double)lamp->elevation_deg;
    if (!has_position(lamp))
        return (struct tl_swatch_light){
            {cos(azimuth) * cos(elevation), sin(azimuth) * cos(elevation), sin(elevation)},
            (double)lamp->intensity};
    struct tl_swatch_light light = {
        {(double)lamp->position_mm[0] - x, (double)lamp->position_mm[1] - y, (double)lamp->position_mm[2]},
        0};
    double share = mean_mm / tl_swatch_unit(light.direction);
    light.strength = (double)lamp->intensity * share * share;
    return light;
}

void tl_swatch_add(struct tl_swatch_normal_equations *sum, const double row[3], double weight, double value)
{
    for (int i = 0, at = 0; i < 3; i++) {
        for (int j = i; j < 3; j++)
            sum->m[at++] += weight * row[i] * row[j];
        sum->v[i] += weight * value * row[i];
    }
}

/* Uses the adjugate matrix. */
bool tl_swatch_invert(const struct tl_swatch_normal_equations *sum, double out[3], double *spread)
{
    const double *m = sum->m, *v = sum->v, trace = m[0] + m[3] + m[5];
    const double a[6] = {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5], m[1] * m[4] - m[2] * m[3],
                         m[0] * m[5] - m[2] * m[2], m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]};
    double determinant = m[0] * a[0] + m[1] * a[1] + m[2] * a[2];
    if (!(determinant > 1e-9 * trace * trace * trace))
        return false;
    out[0] = (a[0] * v[0] + a[1] * v[1] + a[2] * v[2]) / determinant;
    out[1] = (a[1] * v[0] + a[3] * v[1] + a[4] * v[2]) / determinant;
    out[2] = (a[2] * v[0] + a[4] * v[1] + a[5] * v[2]) / determinant;
    *spread = sqrt((a[0] + a[3] + a[5]) / determinant * trace / 3); /* the trace is the sum of weights */
    return true;
}
