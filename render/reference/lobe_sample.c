#include "render/reference/lobe_sample.h"

#include <math.h>

#define LOBE_END 40.0f /* a lobe counts as zero below exp(-40) of its peak */

/* log1p keeps the digits of narrow lobes near the peak. */
float tl_lobe_value(float exponent, float off)
{
    if (off >= 1 || exponent * off > LOBE_END)
        return 0;
    return (exponent + 1) / (2 * (float)M_PI) * expf(exponent * log1pf(-off));
}

/* The distribution of the cosine is (s + 1) cos^s. */
vec3s tl_lobe_sample(vec3s axis, float exponent, double height, double turn, float *off)
{
    double away = -expm1(log(1 - height) / ((double)exponent + 1));
    double radius = sqrt(fmax(away * (2 - away), 0)), angle = 2 * M_PI * turn;
    vec3s aside = fabsf(axis.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}};
    vec3s a = glms_vec3_normalize(glms_vec3_cross(axis, aside)), b = glms_vec3_cross(axis, a);
    vec3s w = glms_vec3_scale(axis, (float)(1 - away));
    w = glms_vec3_add(w, glms_vec3_scale(a, (float)(radius * cos(angle))));
    w = glms_vec3_add(w, glms_vec3_scale(b, (float)(radius * sin(angle))));
    *off = (float)away;
    return glms_vec3_normalize(w);
}
