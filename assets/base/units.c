#include "assets/base/units.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

const char *const tl_units_names[] = {"auto", "m", "dm", "cm", "mm", "in", NULL};

const char *const tl_units_plurals[] = {"metres",      "metres",      "decimetres",
                                        "centimetres", "millimetres", "inches"};

#define SHORTEST_M 0.25f
#define LONGEST_M  2.5f
#define ABSURD_M   25 /* a format's metres are trusted below this size */

double tl_units_metres(enum tl_units units)
{
    static const double metres[] = {1, 1, 0.1, 0.01, 0.001, 0.0254};
    return metres[units];
}

static void guess(struct tl_units_reading *reading)
{
    const float inch = (float)tl_units_metres(TL_UNITS_IN), decade = LONGEST_M / SHORTEST_M;
    float length = reading->longest;
    bool inches = length >= SHORTEST_M / inch && length < LONGEST_M / inch;
    reading->guessed = true;
    reading->fits = length >= SHORTEST_M && length < LONGEST_M * 1000;
    if (length < LONGEST_M)
        reading->units = TL_UNITS_M;
    else if (length < LONGEST_M * decade)
        reading->units = inches ? TL_UNITS_IN : TL_UNITS_DM;
    else
        reading->units = length < LONGEST_M * decade * decade ? TL_UNITS_CM : TL_UNITS_MM;
    if (inches)
        reading->other = reading->units == TL_UNITS_IN ? TL_UNITS_DM : TL_UNITS_IN;
}

/* Far longer along Z than along Y, and about Y = 0: a body's depth. Then either longest along Z, or standing
 * on Z = 0. A wide skirt with Y up is as long along X, and centred along Z. */
static bool is_shaped_z_up(struct tl_box box)
{
    vec3s size = glms_vec3_sub(box.upper, box.lower), middle = glms_vec3_lerp(box.lower, box.upper, 0.5f);
    bool shallow = size.z > 1.5f * size.y && fabsf(middle.y) < 0.25f * size.y;
    return shallow && (size.z > 1.1f * size.x || box.lower.z > -0.05f * size.z);
}

static bool hangs_on_a_body(double top, enum tl_units units)
{
    double top_m = top * tl_units_metres(units);
    return top_m >= 0.7 && top_m <= 2;
}

/* The distance of the area from a square metre, as the logarithm of their ratio. */
static double area_error(double area, enum tl_units units)
{
    return fabs(log(area * tl_units_metres(units) * tl_units_metres(units)));
}

void tl_units_weigh(struct tl_units_reading *reading, struct tl_box box, double area)
{
    const double above = 0.25; /* of its length: above the ground, rather than cut off by it */
    if (!reading->guessed || reading->other == TL_UNITS_AUTO)
        return;
    double low = (double)(reading->z_up ? box.lower.z : box.lower.y);
    double top = (double)(reading->z_up ? box.upper.z : box.upper.y);
    bool is_other = false;
    bool hangs = hangs_on_a_body(top, reading->units), other_hangs = hangs_on_a_body(top, reading->other);
    if (low > above * (double)reading->longest && hangs != other_hangs)
        is_other = other_hangs;
    else if (area > 0 && reading->units != TL_UNITS_CM && reading->other != TL_UNITS_CM)
        is_other = area_error(area, reading->other) < area_error(area, reading->units);
    if (is_other) {
        enum tl_units units = reading->units;
        reading->units = reading->other;
        reading->other = units;
    }
}

/* The share of the first box that is within the second; the sides of flat ones count as a millimetre. */
static float share_within(struct tl_box box, struct tl_box other)
{
    const float flat_m = 0.001f;
    float share = 1;
    for (int k = 0; k < 3; k++) {
        float size = fmaxf(box.upper.raw[k] - box.lower.raw[k], flat_m);
        float common =
            fminf(box.upper.raw[k], other.upper.raw[k]) - fmaxf(box.lower.raw[k], other.lower.raw[k]);
        share *= fminf(fmaxf(common, 0) / size, 1);
    }
    return share;
}

#define LIES_WITHIN 0.5f /* a share of a garment's box that is not there by chance */

bool tl_units_lies_y_up(struct tl_box garment, struct tl_box body)
{
    return share_within(garment, body) > LIES_WITHIN;
}

bool tl_units_lies_z_up(struct tl_box garment, struct tl_box body)
{
    const struct tl_box turned = {{{garment.lower.x, garment.lower.z, -garment.upper.y}},
                                  {{garment.upper.x, garment.upper.z, -garment.lower.y}}};
    return share_within(garment, body) == 0 && share_within(turned, body) > LIES_WITHIN;
}

struct tl_units_reading tl_units_read(struct tl_box box, enum tl_units wanted, bool is_metric)
{
    vec3s size = glms_vec3_sub(box.upper, box.lower);
    struct tl_units_reading reading = {
        .units = wanted, .longest = glms_vec3_max(size), .fits = true, .metric = is_metric};
    reading.z_up = !is_metric && is_shaped_z_up(box);
    reading.deep = !is_metric && size.z > size.y;
    if (wanted != TL_UNITS_AUTO)
        return reading;
    if (is_metric && !(reading.longest >= ABSURD_M))
        reading.units = TL_UNITS_M;
    else
        guess(&reading);
    reading.absurd = is_metric && reading.guessed;
    return reading;
}

unsigned tl_units_doubts(const struct tl_units_reading *reading)
{
    bool units = reading->guessed && (reading->other != TL_UNITS_AUTO || !reading->fits || reading->absurd);
    bool up = reading->z_up || reading->deep;
    return (units ? TL_DOUBT_UNITS : 0u) | (up ? TL_DOUBT_UP : 0u);
}

char *tl_units_describe(const char *name, const struct tl_units_reading *reading, const char *option)
{
    if (!reading->guessed)
        return NULL;
    double length = (double)reading->longest;
    const char *why = reading->absurd ? "absurd as metres: " : reading->fits ? "" : "no unit fits: ";
    char *other = reading->other ? tl_format(", though %s are possible", tl_units_plurals[reading->other])
                                 : tl_copy_string("");
    char *line = tl_format("%s: %.4g units at its longest: %staken as %s (%.3g m)%s; %s overrides this", name,
                           length, why, tl_units_plurals[reading->units],
                           length * tl_units_metres(reading->units), other, option);
    free(other);
    return line;
}

char *tl_units_describe_up(const char *name, const struct tl_units_reading *reading, const char *option)
{
    if (reading->z_up)
        return tl_format("%s: stands along Z: turned upright; %s y leaves it as it is", name, option);
    return reading->deep
               ? tl_format("%s: deeper than high: left as it is; %s z turns it upright", name, option)
               : NULL;
}
