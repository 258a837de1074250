#include "config/colour/lab.h"

#include <math.h>
#include <stdbool.h>

#define DEG (M_PI / 180)

/* XYZ of linear Rec. 709, and the inverse. White, 1, 1, 1, is the sum of a row. */
static const double xyz_rows[3][3] = {{0.412386563, 0.357591490, 0.180450486},
                                      {0.212636820, 0.715182981, 0.072180194},
                                      {0.019330620, 0.119197164, 0.950372587}};
static const double rgb_rows[3][3] = {{3.241003226, -1.537398966, -0.498615867},
                                      {-0.969224243, 1.875929981, 0.041554225},
                                      {0.055639420, -0.204011207, 1.057148977}};

static double white_of(int i)
{
    return xyz_rows[i][0] + xyz_rows[i][1] + xyz_rows[i][2];
}

#define DELTA (6.0 / 29) /* of the curve: below it, it is a line */

static double curve(double value)
{
    return value > DELTA * DELTA * DELTA ? cbrt(value) : value / (3 * DELTA * DELTA) + 4.0 / 29;
}

static double inverse_curve(double value)
{
    return value > DELTA ? value * value * value : 3 * DELTA * DELTA * (value - 4.0 / 29);
}

struct tl_lab tl_lab_of(const float rgb[3])
{
    double f[3];
    for (int i = 0; i < 3; i++) {
        double value = 0;
        for (int c = 0; c < 3; c++)
            value += xyz_rows[i][c] * (double)rgb[c];
        f[i] = curve(value / white_of(i));
    }
    return (struct tl_lab){116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

/* The channels of a colour whose a and b are scaled; they may lie outside of [0, 1]. */
static void scaled_rgb(struct tl_lab lab, double scale, double rgb[3])
{
    const double y = (lab.l + 16) / 116, f[3] = {y + scale * lab.a / 500, y, y - scale * lab.b / 200};
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0;
        for (int i = 0; i < 3; i++)
            rgb[c] += rgb_rows[c][i] * white_of(i) * inverse_curve(f[i]);
    }
}

/* More than the constants' last digits make of white and of the primaries, and less than is seen. */
#define GAMUT_SLACK 1e-6

static bool is_shown(struct tl_lab lab, double scale)
{
    double rgb[3];
    scaled_rgb(lab, scale, rgb);
    for (int c = 0; c < 3; c++)
        if (rgb[c] < -GAMUT_SLACK || rgb[c] > 1 + GAMUT_SLACK)
            return false;
    return true;
}

double tl_lab_to_rgb(struct tl_lab lab, float rgb[3])
{
    const int halvings = 40;
    double shown = is_shown(lab, 1) ? 1 : 0, beyond = 1;
    for (int i = 0; shown < 1 && i < halvings; i++) {
        const double middle = (shown + beyond) / 2;
        if (is_shown(lab, middle))
            shown = middle;
        else
            beyond = middle;
    }
    double channels[3];
    scaled_rgb(lab, shown, channels);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)fmin(fmax(channels[c], 0), 1);
    return shown;
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
