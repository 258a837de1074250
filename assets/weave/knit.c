#include "assets/weave/knit.h"

#include <math.h>

#define TILE_MM    16.0
#define LEAN       0.26 /* of the legs, sideways, in wales [LOOK: by eye] */
#define MARL       0.3  /* how much a yarn differs along itself, of how much its fibres do */
#define MARL_WALES 3    /* ... over so many loops */
#define LOOP_STEPS 56   /* of an axis in a loop: fewer than a tenth of the diameter apart */

/* One bed of loops. */
struct bed {
    double lower_m;          /* how far below the middle plane */
    double shift_x, shift_y; /* in wales and courses */
    uint32_t seed;
};

struct knitting {
    const struct tl_weave_params *params;
    double wale, course, diameter; /* m */
    int wales, courses;            /* of the tile */
};

/* Whether the loops of a wale and a course show their purl side. */
static bool is_purl(const struct knitting *knitting, int wale, int course)
{
    int rib = knitting->params->rib;
    switch (knitting->params->pattern) {
    case TL_WEAVE_RIB:
        return wale / rib % 2 == 1;
    case TL_WEAVE_PURL:
        return course % 2 == 1;
    default:
        return false;
    }
}

/* Ribs bulge: the middle of a group of face wales stands out. */
static double bulge(const struct knitting *knitting, double wale)
{
    if (knitting->params->pattern != TL_WEAVE_RIB)
        return 0;
    double period = 2 * knitting->params->rib, at = fmod(wale, period) / period;
    return 0.45 * knitting->diameter * sin(2 * M_PI * at);
}

/* Waves of a marl along the tile. */
static int marl_waves(const struct knitting *knitting)
{
    return knitting->wales > MARL_WALES ? knitting->wales / MARL_WALES : 1;
}

static struct tl_strand strand_at(const struct knitting *knitting, const struct bed *bed, int wale,
                                  int course, double t)
{
    const double turn = t / (2 * M_PI), along = wale + turn;
    const uint32_t seed = bed->seed + 3 * (uint32_t)course;
    const bool purl = is_purl(knitting, wale, course);
    const double wild_x = 0.035 * tl_tile_noise(seed, along, knitting->wales);
    const double wild_y = 0.04 * tl_tile_noise(seed + 1, along, knitting->wales);
    const double thick = 1 + 0.11 * tl_tile_noise(seed + 2, 2 * along, 2 * knitting->wales);
    const double d = knitting->diameter;
    double z = -0.5 * d * cos(2 * t);
    z = (purl ? -z - 0.55 * d : z) + bulge(knitting, along) - bed->lower_m;
    const double marl = 0.05 + MARL * (double)knitting->params->melange;
    const float shade =
        1 + (float)(marl * tl_tile_noise(seed + 1, along * marl_waves(knitting) / knitting->wales + 0.3,
                                         marl_waves(knitting)));
    double step_x = knitting->wale * (1 / (2 * M_PI) + 2 * LEAN * cos(2 * t));
    double step_y = knitting->course * 0.85 * sin(t), length = hypot(step_x, step_y);
    return (struct tl_strand){.x = knitting->wale * (along + LEAN * sin(2 * t) + wild_x + bed->shift_x),
                              .y = knitting->course * (course + 0.5 - 0.85 * cos(t) + wild_y + bed->shift_y),
                              .z = z,
                              .radius = 0.5 * d * thick,
                              .along_x = length > 0 ? step_x / length : 1,
                              .along_y = length > 0 ? step_y / length : 0,
                              .ply_m = 2.6 * d,
                              .melange = (double)knitting->params->melange,
                              .tint = {shade, shade, shade},
                              .seed = seed};
}

static void lay_course(const struct knitting *knitting, const struct bed *bed, int course,
                       struct tl_tile *tile)
{
    double run = 0, before[2] = {0};
    for (int wale = 0; wale < knitting->wales; wale++)
        for (int k = 0; k < LOOP_STEPS; k++) {
            struct tl_strand strand = strand_at(knitting, bed, wale, course, 2 * M_PI * k / LOOP_STEPS);
            if (wale + k > 0)
                run += hypot(strand.x - before[0], strand.y - before[1]);
            before[0] = strand.x, before[1] = strand.y;
            strand.run = run;
            tl_tile_lay(tile, &strand);
        }
}

/* The number of spacings near to TILE_MM that is a multiple of the repeat. */
static int count_of(double spacing_mm, int repeat)
{
    int count = (int)lround(TILE_MM / spacing_mm / repeat) * repeat;
    return count < repeat ? repeat : count;
}

static int texels_of(double count)
{
    return (int)lround(fmin(fmax(count, TL_TILE_SIDE_MIN), TL_TILE_SIDE_MAX));
}

struct tl_tile tl_knit_lay(const struct tl_weave_params *params)
{
    const bool has_ribs = params->pattern == TL_WEAVE_RIB;
    struct knitting knitting = {.params = params,
                                .wale = 1e-3 * (double)params->wale_mm,
                                .course = 1e-3 * (double)params->course_mm,
                                .diameter = 1e-3 * (double)params->yarn_mm,
                                .wales = count_of((double)params->wale_mm, has_ribs ? 2 * params->rib : 1),
                                .courses = count_of((double)params->course_mm, 2)};
    const int texels = params->texels_per_yarn; /* of a wale */
    const double side = (double)knitting.wales * texels;
    const double tile_x = knitting.wales * knitting.wale, tile_y = knitting.courses * knitting.course;
    struct tl_tile tile = tl_tile_make(texels_of(side), texels_of(side * tile_y / tile_x), tile_x, tile_y,
                                       (float)(-1.6 * knitting.diameter));
    const struct bed front = {.seed = 11}, back = {0.95 * knitting.diameter, 0.5, 0.5, 5011};
    for (int course = 0; course < knitting.courses; course++) {
        lay_course(&knitting, &front, course, &tile);
        if (params->pattern ==
            TL_WEAVE_INTERLOCK) /* two ribs locked into each other: face wales on both sides */
            lay_course(&knitting, &back, course, &tile);
    }
    return tile;
}
