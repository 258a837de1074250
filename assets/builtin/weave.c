#include "assets/builtin/weave.h"

#include "config/memory.h"

#include <assert.h>
#include <math.h>

static const char *const pattern_names[] = {"none", "plain", "twill", "satin", NULL};
static const char *const section_names[] = {"round", "flat", NULL};

#define AFFECTS (TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE)

static const struct tl_option rows[] = {
    TL_OPTION_ENUM(struct tl_weave_params, pattern, AFFECTS, pattern_names,
                   "interlacing of the yarns; none: only the material's own maps"),
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
                  "resolution of the maps"),
    TL_OPTION_PATH(struct tl_weave_params, picture, AFFECTS,
                   "image of heights in place of yarns, a repeating .png or .exr; empty: none"),
    TL_OPTION_FLOAT(struct tl_weave_params, picture_mm, AFFECTS, 0.001, 10000, "mm",
                    "width of the picture on the cloth"),
    TL_OPTION_FLOAT(struct tl_weave_params, depth_mm, AFFECTS, 0, 10000, "mm",
                    "height difference between the picture's lowest and highest value; larger: rougher"),
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
};

struct sample {
    double height, slope_across, slope_along;
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
    double x = (across - (yarn + 0.5) * yarns->pitch) / (HALF_WIDTH * yarns->pitch);
    if (fabs(x) >= 1)
        return (struct sample){-INFINITY, 0, 0};
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

static void fill_texel(const struct weaving *weaving, tl_weave *out, int column, int row)
{
    int width = out->height.width, height = out->height.height;
    double x = (column + 0.5) / width * (double)out->size_m[0];
    double y = (height - row - 0.5) / height * (double)out->size_m[1]; /* rows run down, the warp up */
    struct sample warp = system_surface(&weaving->warp, weaving->drawing, x, y);
    struct sample weft = system_surface(&weaving->weft, weaving->drawing, y, x);
    bool warp_on_top = warp.height >= weft.height;
    struct sample top = warp_on_top ? warp : weft;
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

bool tl_weave_create(const struct tl_weave_params *params, tl_weave *out)
{
    *out = (tl_weave){0};
    if (params->pattern == TL_WEAVE_NONE)
        return false;
    assert(params->pattern > TL_WEAVE_NONE && (size_t)params->pattern < TL_COUNT(drawings));
    float warp_pitch = params->warp_pitch_mm, weft_pitch = params->weft_pitch_mm, crimp = params->crimp_mm;
    const struct weaving weaving = {.params = params,
                                    .drawing = &drawings[params->pattern],
                                    .warp = make_yarns(warp_pitch, weft_pitch, crimp, params->section, true),
                                    .weft =
                                        make_yarns(weft_pitch, warp_pitch, crimp, params->section, false)};
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
    return true;
}

void tl_weave_release(tl_weave *weave)
{
    tl_image_release(&weave->normal);
    tl_image_release(&weave->height);
    tl_image_release(&weave->gloss);
    tl_image_release(&weave->tint);
    *weave = (tl_weave){0};
}
