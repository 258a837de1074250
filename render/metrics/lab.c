#include "render/metrics/lab.h"

#include <math.h>
#include <stdbool.h>

#define DEG (M_PI / 180)

static double curve(double value)
{
    const double delta = 6.0 / 29;
    return value > delta * delta * delta ? cbrt(value) : value / (3 * delta * delta) + 4.0 / 29;
}

struct tl_lab tl_lab_of(const float rgb[3])
{
    static const double rows[3][3] = {{0.412386563, 0.357591490, 0.180450486},
                                      {0.212636820, 0.715182981, 0.072180194},
                                      {0.019330620, 0.119197164, 0.950372587}};
    double f[3];
    for (int i = 0; i < 3; i++) {
        double value = 0, white = 0;
        for (int c = 0; c < 3; c++) {
            value += rows[i][c] * (double)rgb[c];
            white += rows[i][c];
        }
        f[i] = curve(value / white);
    }
    return (struct tl_lab){116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

/* In degrees, from 0 to 360; 0 for grey. */
static double hue_of(double a, double b)
{
    double hue = a == 0 && b == 0 ? 0 : atan2(b, a) / DEG;
    return hue < 0 ? hue + 360 : hue;
}

static double mean_hue(double p, double q)
{
    double sum = p + q;
    if (fabs(p - q) <= 180)
        return sum / 2;
    return sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2;
}

static double turn_between(double p, double q)
{
    double turn = q - p;
    return turn > 180 ? turn - 360 : turn < -180 ? turn + 360 : turn;
}

/* 0 for grey, towards 1 for saturated colours. */
static double saturation_of(double chroma)
{
    double seventh = pow(chroma, 7);
    return sqrt(seventh / (seventh + pow(25, 7)));
}

/* Equations 2 to 22 of the paper. */
double tl_lab_difference(struct tl_lab p, struct tl_lab q)
{
    double g = 0.5 * (1 - saturation_of((hypot(p.a, p.b) + hypot(q.a, q.b)) / 2));
    double pa = (1 + g) * p.a, qa = (1 + g) * q.a;
    double p_chroma = hypot(pa, p.b), q_chroma = hypot(qa, q.b);
    double p_hue = hue_of(pa, p.b), q_hue = hue_of(qa, q.b);
    bool is_grey = p_chroma * q_chroma == 0;
    double turn = is_grey ? 0 : turn_between(p_hue, q_hue);
    double hue = is_grey ? p_hue + q_hue : mean_hue(p_hue, q_hue);
    double lightness = (p.l + q.l) / 2 - 50, chroma = (p_chroma + q_chroma) / 2;
    double t = 1 - 0.17 * cos((hue - 30) * DEG) + 0.24 * cos(2 * hue * DEG) +
               0.32 * cos((3 * hue + 6) * DEG) - 0.20 * cos((4 * hue - 63) * DEG);
    double rotation = -2 * saturation_of(chroma) * sin(60 * exp(-pow((hue - 275) / 25, 2)) * DEG);
    double l = (q.l - p.l) / (1 + 0.015 * lightness * lightness / sqrt(20 + lightness * lightness));
    double c = (q_chroma - p_chroma) / (1 + 0.045 * chroma);
    double h = 2 * sqrt(p_chroma * q_chroma) * sin(turn / 2 * DEG) / (1 + 0.015 * chroma * t);
    return sqrt(l * l + c * c + h * h + rotation * c * h);
}
