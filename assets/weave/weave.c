#include "assets/weave/weave.h"

#include "assets/weave/knit.h"
#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const char *const pattern_names[] = {"none", "plain",     "twill", "satin", "jersey",
                                            "rib",  "interlock", "purl",  "pile",  NULL};
static const char *const mirror_names[] = {"none", "weft", "warp", "both", NULL};
static const char *const section_names[] = {"round", "flat", NULL};

#define AFFECTS (TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE)

static const struct tl_option rows[] = {
    TL_OPTION_ENUM(struct tl_weave_params, pattern, AFFECTS, pattern_names,
                   "interlacing of the yarns, or loops of a knit, or fibres alone (pile); none: only the "
                   "material's own maps"),
    TL_OPTION_ENUM(
        struct tl_weave_params, section, AFFECTS, section_names,
        "section of the yarns; round: twisted fibres; flat: filaments side by side, as of silk and satin"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_pitch_mm, AFFECTS, 0.05, 20, "mm",
                    "distance between warp yarns"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_pitch_mm, AFFECTS, 0.05, 20, "mm",
                    "distance between weft yarns"),
    TL_OPTION_FLOAT(struct tl_weave_params, crimp_mm, AFFECTS, 0, 5, "mm",
                    "height of a yarn's crest above the middle plane; larger: rougher"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_gloss, AFFECTS, -1, 1, "",
                    "added to the glossiness on warp yarns"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_gloss, AFFECTS, -1, 1, "",
                    "added to the glossiness on weft yarns"),
    TL_OPTION_COLOUR(struct tl_weave_params, warp_tint, AFFECTS, 0, 1,
                     "factor on the diffuse colour of warp yarns"),
    TL_OPTION_COLOUR(struct tl_weave_params, weft_tint, AFFECTS, 0, 1,
                     "factor on the diffuse colour of weft yarns"),
    TL_OPTION_INT(struct tl_weave_params, texels_per_yarn, AFFECTS, 16, 64, "texels",
                  "resolution of the maps; of a wale in knits"),
    TL_OPTION_FLOAT(struct tl_weave_params, wale_mm, AFFECTS, 0.1, 20, "mm", "knits: distance between wales"),
    TL_OPTION_FLOAT(struct tl_weave_params, course_mm, AFFECTS, 0.1, 20, "mm",
                    "knits: distance between courses"),
    TL_OPTION_FLOAT(struct tl_weave_params, yarn_mm, AFFECTS, 0.05, 10, "mm", "knits: diameter of the yarn"),
    TL_OPTION_INT(struct tl_weave_params, rib, AFFECTS, 1, 8, "wales", "rib: wales of a rib and of a gap"),
    TL_OPTION_FLOAT(struct tl_weave_params, slub, AFFECTS, 0, 0.5, "",
                    "weaves: how much yarns vary in width and colour; larger: more rustic; 0: all are alike"),
    TL_OPTION_FLOAT(
        struct tl_weave_params, nap, AFFECTS, 0, 8, "",
        "area of the fibres that lie on the surface, as a multiple of the surface's; larger: more felted; "
        "0: none"),
    TL_OPTION_FLOAT(struct tl_weave_params, nap_mm, AFFECTS, 0.05, 20, "mm", "mean length of these fibres"),
    TL_OPTION_FLOAT(struct tl_weave_params, fibre_mm, AFFECTS, 0.01, 1, "mm", "diameter of these fibres"),
    TL_OPTION_FLOAT(struct tl_weave_params, curl, AFFECTS, 0, 0.5, "rad",
                    "turn of these fibres in a length of half their diameter; larger: curlier"),
    TL_OPTION_FLOAT(struct tl_weave_params, clump_mm, AFFECTS, 0.7, 10, "mm",
                    "pile: size of its clumps, whose height is crimp_mm"),
    TL_OPTION_FLOAT(
        struct tl_weave_params, lean, AFFECTS, 0, 1, "",
        "pile: how much its fibres lean one way in patches, as a hand leaves them; 0: they do not"),
    TL_OPTION_FLOAT(struct tl_weave_params, melange, AFFECTS, 0, 0.8, "",
                    "how much fibres differ in colour; larger: more heathered"),
    TL_OPTION_FLOAT(
        struct tl_weave_params, cavity, AFFECTS, 0, 1, "",
        "knits, slub and nap: how much valleys darken; 0 with detail.shadow horizon, which shows it itself"),
    TL_OPTION_FLOAT(
        struct tl_weave_params, streaks, AFFECTS, 0, 0.5, "",
        "weaves and knits: how much yarns differ in brightness along all of the cloth, in streaks that do "
        "not repeat; 0: they are alike"),
    TL_OPTION_PATH(struct tl_weave_params, picture, AFFECTS,
                   "image of heights in place of yarns, a repeating .png or .exr; empty: none"),
    TL_OPTION_PATH(
        struct tl_weave_params, pictures, AFFECTS,
        "pictures of the surface in place of yarns: a folder or .zip of texture maps, a .u3m or .u3ma "
        "file; empty: none"),
    TL_OPTION_FLOAT(struct tl_weave_params, picture_mm, AFFECTS, 0, 10000, "mm",
                    "width of picture or pictures on the cloth; 0: 100 mm, assumed"),
    TL_OPTION_FLOAT(struct tl_weave_params, picture_length_mm, AFFECTS, 0, 10000, "mm",
                    "length of pictures on the cloth, along the warp; 0: their texels are square"),
    TL_OPTION_ENUM(
        struct tl_weave_params, picture_mirror, AFFECTS, mirror_names,
        "directions in which every other repeat of pictures is mirrored, for pictures that do not tile"),
    TL_OPTION_FLOAT(
        struct tl_weave_params, depth_mm, AFFECTS, 0, 10000, "mm",
        "height difference between the lowest and the highest value of picture or pictures; larger: rougher"),
};
const struct tl_option_table tl_weave_options =
    TL_OPTION_TABLE("weave", "woven detail: normals, gloss and yarn colours at millimetre scale", rows,
                    struct tl_weave_params, TL_WEAVE_DEFAULTS);

/* A regular weave: warp end i passes under weft pick j when j = i * step (mod repeat). */
struct weave_drawing {
    int repeat, step;
};
static const struct weave_drawing drawings[] = {
    [TL_WEAVE_PLAIN] = {2, 1}, [TL_WEAVE_TWILL] = {4, 1}, [TL_WEAVE_SATIN] = {5, 2}};

/* Half a yarn's width over its pitch: neighbours overlap a little, which keeps the slopes between them
 * finite.
 */
#define HALF_WIDTH 0.56

/* All yarns of one system (the warp or the weft), as seen along `across` and `along` their direction, metres.
 */
struct yarns {
    double pitch;       /* across */
    double other_pitch; /* along: distance of the crossings */
    double amplitude;   /* of the centre line */
    double thickness;   /* half the height of the section */
    bool is_warp, is_flat;
    double slub, melange; /* how much they vary over `count` yarns that cross `other_count` */
    int count, other_count;
};

struct sample {
    double height, slope_across, slope_along;
    double shade; /* of its colour */
};

static bool warp_is_over(const struct weave_drawing *drawing, int end, int pick)
{
    int n = drawing->repeat;
    return ((pick - end * drawing->step) % n + n) % n != 0;
}

/* +1 where the yarn runs over its crossing, -1 where under. */
static double level(const struct yarns *yarns, const struct weave_drawing *drawing, int yarn, int crossing)
{
    bool over =
        yarns->is_warp ? warp_is_over(drawing, yarn, crossing) : !warp_is_over(drawing, crossing, yarn);
    return over ? 1 : -1;
}

/* A yarn's surface: its centre line goes from crossing to crossing by half cosines, level over floats; its
 * section is an ellipse or a parabola, sheared along the height. */
static struct sample yarn_surface(const struct yarns *yarns, const struct weave_drawing *drawing, int yarn,
                                  double across, double along)
{
    double wide = 1, shade = 1;
    const int own_number = yarns->count > 0 ? (yarn + yarns->count) % yarns->count : 0;
    const uint32_t seed = (yarns->is_warp ? 101u : 5101u) + 2 * (uint32_t)own_number;
    if (yarns->slub > 0) { /* every yarn has its own width, which swells and shrinks along it */
        const double own = 2 * tl_tile_random(seed, 1, 1) - 1;
        wide += yarns->slub * (0.5 * own + tl_tile_noise(seed, 0.25 * along / yarns->other_pitch,
                                                         (yarns->other_count + 3) / 4));
        shade +=
            0.7 * yarns->slub *
            (own + tl_tile_noise(seed + 1, 0.5 * along / yarns->other_pitch, (yarns->other_count + 1) / 2));
    }
    double x = (across - (yarn + 0.5) * yarns->pitch) / (HALF_WIDTH * yarns->pitch * wide);
    if (fabs(x) >= 1)
        return (struct sample){-INFINITY, 0, 0, 1};
    double place = along / yarns->other_pitch - 0.5, t = place - floor(place);
    double from = level(yarns, drawing, yarn, (int)floor(place));
    double to = level(yarns, drawing, yarn, (int)floor(place) + 1);
    double middle = 0.5 * (from + to), swing = 0.5 * (from - to);
    double rise = yarns->is_flat ? 1 - x * x : sqrt(1 - x * x);
    double fall = yarns->is_flat ? 2 * x : x / rise;
    return (struct sample){
        .height = yarns->amplitude * (middle + swing * cos(M_PI * t)) + yarns->thickness * rise,
        .slope_across = -yarns->thickness * fall / (HALF_WIDTH * yarns->pitch),
        .slope_along = -yarns->amplitude * swing * M_PI * sin(M_PI * t) / yarns->other_pitch,
        .shade = shade * tl_tile_fibres(seed, x, along, 4 * yarns->pitch, yarns->melange),
    };
}

/* The highest yarn at a point. */
static struct sample system_surface(const struct yarns *yarns, const struct weave_drawing *drawing,
                                    double across, double along)
{
    int nearest = (int)floor(across / yarns->pitch);
    struct sample top = yarn_surface(yarns, drawing, nearest, across, along);
    for (int side = -1; side <= 1; side += 2) {
        struct sample other = yarn_surface(yarns, drawing, nearest + side, across, along);
        if (other.height > top.height)
            top = other;
    }
    return top;
}

struct weaving {
    const struct tl_weave_params *params;
    const struct weave_drawing *drawing;
    struct yarns warp, weft;
};

static uint8_t encode(double component)
{
    return (uint8_t)lround(255 * (0.5 + 0.5 * component));
}

struct topmost {
    struct sample yarn;
    bool is_warp;
};

static struct topmost topmost_at(const struct weaving *weaving, double x, double y)
{
    struct sample warp = system_surface(&weaving->warp, weaving->drawing, x, y);
    struct sample weft = system_surface(&weaving->weft, weaving->drawing, y, x);
    bool is_warp = warp.height >= weft.height;
    return (struct topmost){is_warp ? warp : weft, is_warp};
}

static void fill_texel(const struct weaving *weaving, tl_weave *out, int column, int row)
{
    int width = out->height.width, height = out->height.height;
    double x = (column + 0.5) / width * (double)out->size_m[0];
    double y = (height - row - 0.5) / height * (double)out->size_m[1]; /* rows run down, the warp up */
    const struct topmost found = topmost_at(weaving, x, y);
    const struct sample top = found.yarn;
    const bool warp_on_top = found.is_warp;
    double slope_x = warp_on_top ? top.slope_across : top.slope_along;
    double slope_y = warp_on_top ? top.slope_along : top.slope_across;
    double scale = 1 / sqrt(1 + slope_x * slope_x + slope_y * slope_y);

    size_t texel = (size_t)row * (size_t)width + (size_t)column;
    const struct tl_weave_params *params = weaving->params;
    const float *tint = warp_on_top ? params->warp_tint : params->weft_tint;
    uint8_t *normal = tl_image_bytes(&out->normal) + 3 * texel;
    normal[0] = encode(-slope_x * scale);
    normal[1] = encode(-slope_y * scale);
    normal[2] = encode(scale);
    tl_image_floats(&out->height)[texel] = (float)top.height;
    tl_image_floats(&out->gloss)[texel] = warp_on_top ? params->warp_gloss : params->weft_gloss;
    for (size_t c = 0; c < 3; c++)
        tl_image_floats(&out->tint)[3 * texel + c] = tint[c];
}

/* Warp and weft share the height: where one is over and the other under they touch, so amplitude and half
 * thickness are both half the crest's height. */
static struct yarns make_yarns(float pitch_mm, float other_pitch_mm, float crimp_mm, int section,
                               bool is_warp)
{
    double half_crimp = 0.5e-3 * (double)crimp_mm;
    return (struct yarns){.pitch = 1e-3 * (double)pitch_mm,
                          .other_pitch = 1e-3 * (double)other_pitch_mm,
                          .amplitude = half_crimp,
                          .thickness = half_crimp,
                          .is_warp = is_warp,
                          .is_flat = section == TL_YARN_FLAT};
}

/* ---- Larger pieces: fibres, and yarns that vary ---- */

#define PIECE_MM   16.0f
#define PIECE_SIDE 1024 /* texels at most */

static int repeats_of(float pitch_mm, int repeat)
{
    int count = (int)ceilf(PIECE_MM / (pitch_mm * (float)repeat));
    return count > 1 ? count : 1;
}

/* A piece of about PIECE_MM of a weave. */
static struct tl_tile weave_piece(const struct tl_weave_params *params, struct weaving *weaving)
{
    const int repeat = weaving->drawing->repeat;
    const int ends = repeat * repeats_of(params->warp_pitch_mm, repeat);
    const int picks = repeat * repeats_of(params->weft_pitch_mm, repeat);
    const int width = ends * params->texels_per_yarn, height = picks * params->texels_per_yarn;
    weaving->warp.slub = weaving->weft.slub = (double)params->slub;
    weaving->warp.melange = weaving->weft.melange = (double)params->melange;
    weaving->warp.count = weaving->weft.other_count = ends;
    weaving->weft.count = weaving->warp.other_count = picks;
    struct tl_tile tile =
        tl_tile_make(width < PIECE_SIDE ? width : PIECE_SIDE, height < PIECE_SIDE ? height : PIECE_SIDE,
                     ends * weaving->warp.pitch, picks * weaving->weft.pitch, 0);
#pragma omp parallel for schedule(static)
    for (int row = 0; row < tile.height; row++)
        for (int column = 0; column < tile.width; column++) {
            const size_t texel = (size_t)row * (size_t)tile.width + (size_t)column;
            const struct topmost top = topmost_at(weaving, (column + 0.5) / tile.width * tile.size_m[0],
                                                  (tile.height - row - 0.5) / tile.height * tile.size_m[1]);
            const float *tint = top.is_warp ? params->warp_tint : params->weft_tint;
            tile.heights[texel] = (float)fmax(top.yarn.height, -2 * weaving->warp.amplitude);
            for (size_t c = 0; c < 3; c++)
                tile.tints[3 * texel + c] = tint[c] * (float)top.yarn.shade;
        }
    return tile;
}

static struct tl_tile piece_of(const struct tl_weave_params *params, struct weaving *weaving)
{
    if (params->pattern == TL_WEAVE_PILE)
        return tl_pile_make(params);
    return params->pattern >= TL_WEAVE_JERSEY ? tl_knit_lay(params) : weave_piece(params, weaving);
}

static void make_piece(const struct tl_weave_params *params, struct weaving *weaving, tl_weave *out)
{
    struct tl_tile tile = piece_of(params, weaving);
    float tint[3] = {1, 1, 1};
    for (int c = 0; c < 3 && params->pattern < TL_WEAVE_JERSEY; c++)
        tint[c] = 0.5f * (params->warp_tint[c] + params->weft_tint[c]);
    if (params->nap > 0)
        tl_nap_lay(params, tint, &tile);
    tl_tile_shade(&tile, params->cavity);
    tl_tile_even_tints(&tile);
    *out = tl_tile_weave(&tile);
    tl_tile_release(&tile);
}

/* ---- Yarns that differ along all of the cloth ---- */

/* Most of what a yarn deviates by is its own, the rest it shares with some neighbours, as those of one
 * cone or of one day do. */
static void sum_deviations(uint32_t seed, int count, double amount, float *sums)
{
    double deviations[TL_WARP_YARNS], mean = 0, sum = 0;
    for (int i = 0; i < count; i++) {
        const double own = 2 * tl_tile_random(seed, i, 0) - 1;
        deviations[i] =
            amount * (own + 0.35 * tl_tile_noise(seed + 1, i * floor(count / 9.0) / count, count / 9));
        mean += deviations[i] / count;
    }
    for (int i = 0; i < count; i++) {
        sums[i] = (float)sum;
        sum += deviations[i] - mean;
    }
    sums[count] = 0;
}

/* The top layer counts: the warp in twill and satin, both in plain weaves, and loops across and along. */
static struct tl_yarns *make_streaks(const struct tl_weave_params *params)
{
    static const double shares[] = {[TL_WEAVE_PLAIN] = 0.5, [TL_WEAVE_TWILL] = 0.9, [TL_WEAVE_SATIN] = 0.8};
    const bool is_woven = params->pattern < TL_WEAVE_JERSEY;
    const double warp = is_woven ? shares[params->pattern] : 0.3;
    struct tl_yarns *yarns = TL_NEW(struct tl_yarns);
    yarns->pitch_m[0] = 1e-3f * (is_woven ? params->warp_pitch_mm : params->wale_mm);
    yarns->pitch_m[1] = 1e-3f * (is_woven ? params->weft_pitch_mm : params->course_mm);
    sum_deviations(301, TL_WARP_YARNS, warp * (double)params->streaks, yarns->sums);
    sum_deviations(401, TL_WEFT_YARNS, (1 - warp) * (double)params->streaks, yarns->sums + TL_WARP_YARNS + 1);
    return yarns;
}

static void weave_repeat(const struct tl_weave_params *params, tl_weave *out)
{
    const bool is_woven = params->pattern < TL_WEAVE_JERSEY;
    assert(params->pattern > TL_WEAVE_NONE && params->pattern <= TL_WEAVE_PILE);
    float warp_pitch = params->warp_pitch_mm, weft_pitch = params->weft_pitch_mm, crimp = params->crimp_mm;
    struct weaving weaving = {.params = params,
                              .drawing = &drawings[is_woven ? params->pattern : TL_WEAVE_PLAIN],
                              .warp = make_yarns(warp_pitch, weft_pitch, crimp, params->section, true),
                              .weft = make_yarns(weft_pitch, warp_pitch, crimp, params->section, false)};
    if (!is_woven || params->nap > 0 || params->slub > 0 || params->melange > 0) {
        make_piece(params, &weaving, out);
        return;
    }
    int repeat = weaving.drawing->repeat, side = repeat * params->texels_per_yarn;
    *out = (tl_weave){.size_m = {1e-3f * warp_pitch * (float)repeat, 1e-3f * weft_pitch * (float)repeat},
                      .normal = tl_image_create(side, side, 3, TL_IMAGE_U8),
                      .height = tl_image_create(side, side, 1, TL_IMAGE_F32),
                      .gloss = tl_image_create(side, side, 1, TL_IMAGE_F32),
                      .tint = tl_image_create(side, side, 3, TL_IMAGE_F32)};
    out->normal.linear = true;
    for (int row = 0; row < side; row++) {
        for (int column = 0; column < side; column++)
            fill_texel(&weaving, out, column, row);
    }
}

bool tl_weave_create(const struct tl_weave_params *params, tl_weave *out)
{
    *out = (tl_weave){0};
    if (params->pattern == TL_WEAVE_NONE)
        return false;
    weave_repeat(params, out);
    if (params->streaks > 0 && params->pattern != TL_WEAVE_PILE)
        out->yarns = make_streaks(params);
    return true;
}

void tl_weave_release(tl_weave *weave)
{
    tl_image_release(&weave->normal);
    tl_image_release(&weave->height);
    tl_image_release(&weave->gloss);
    tl_image_release(&weave->tint);
    free(weave->yarns);
    *weave = (tl_weave){0};
}
