#include "render/inspect/legend.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool tl_view_is_strain(int view)
{
    return view >= TL_VIEW_STRAIN_WARP && view <= TL_VIEW_STRAIN_SHEAR;
}

bool tl_view_is_visibility(int view)
{
    return view == TL_VIEW_VISIBILITY || view == TL_VIEW_REGION;
}

int tl_view_strain_axis(int view)
{
    return view - TL_VIEW_STRAIN_WARP;
}

/* OKLab to linear Rec. 709 [Ottosson 2020]. */
static vec3s from_oklab(float lightness, float a, float b)
{
    float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    l = l * l * l, m = m * m * m, s = s * s * s;
    return (vec3s){{4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                    -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
                    -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s}};
}

static vec3s colour_of_oklch(float lightness, float chroma, float hue_deg)
{
    float hue = glm_rad(hue_deg);
    vec3s linear = from_oklab(lightness, chroma * cosf(hue), chroma * sinf(hue));
    for (int c = 0; c < 3; c++)
        linear.raw[c] = tl_srgb_from_linear(fminf(fmaxf(linear.raw[c], 0), 1));
    return linear;
}

vec3s tl_direction_colour(vec3s direction)
{
    vec3s colour;
    for (int c = 0; c < 3; c++)
        colour.raw[c] = fminf(fmaxf(0.5f + 0.5f * direction.raw[c], 0), 1);
    return colour;
}

/* Hue and lightness follow the R2 sequence [Roberts 2018]: any number of its points are well apart, and so
 * are the colours of any number of regions. */
vec3s tl_number_colour(uint32_t number)
{
    const double plastic = 1.32471795724474602596;
    double hue = fmod(number / plastic, 1), level = fmod(number / (plastic * plastic), 1);
    return colour_of_oklch(0.5f + 0.36f * (float)level, 0.125f, 360 * (float)hue);
}

/* Diverging colours for t in [-1, 1]: blue below 0, pale grey at 0, orange to brown above. They differ for
 * people who see no red or no green, and are equally dark at equal distances from 0. */
static vec3s diverging(float t)
{
    const float light = 0.94f, dark = 0.38f, max_chroma = 0.125f, blue_deg = 257, orange_deg = 55;
    float away = fabsf(t);
    float chroma = max_chroma * sinf(0.64f * GLM_PIf * away);
    return colour_of_oklch(light + (dark - light) * away, chroma, t < 0 ? blue_deg : orange_deg);
}

static void set_scale(struct tl_legend *legend, float low, float high, vec3s (*colour)(float t))
{
    legend->low = low;
    legend->high = high;
    legend->stop_count = TL_LEGEND_STOPS;
    for (int i = 0; i < TL_LEGEND_STOPS; i++) {
        float part = (float)i / (TL_LEGEND_STOPS - 1);
        legend->stops[i] =
            (struct tl_legend_stop){.value = low + (high - low) * part, .colour = colour(2 * part - 1)};
    }
}

static vec3s grey(float t)
{
    float level = 0.5f + 0.5f * t;
    return (vec3s){{level, level, level}};
}

static void add_entry(struct tl_legend *legend, vec3s colour, const char *label)
{
    struct tl_legend_entry *entry = &legend->entries[legend->entry_count++];
    entry->colour = colour;
    snprintf(entry->label, sizeof entry->label, "%s", label);
}

static void list_directions(struct tl_legend *legend)
{
    static const char *const labels[3][2] = {{"+X", "-X"}, {"+Y up", "-Y down"}, {"+Z", "-Z"}};
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            vec3s direction = {{0, 0, 0}};
            direction.raw[axis] = side ? -1 : 1;
            add_entry(legend, tl_direction_colour(direction), labels[axis][side]);
        }
}

static void describe_strain(const struct tl_legend_source *source, struct tl_legend *legend)
{
    static const char *const titles[] = {"strain along the warp", "strain along the weft",
                                         "shear of the threads"};
    float percent = 100 * source->range;
    snprintf(legend->title, sizeof legend->title, "%s", titles[tl_view_strain_axis(source->view)]);
    snprintf(legend->unit, sizeof legend->unit, "%%");
    const char *reading = source->view == TL_VIEW_STRAIN_SHEAR ? "cosine of their angle; 0: at right angles"
                                                               : "blue: shorter than at rest; brown: longer";
    snprintf(legend->note, sizeof legend->note, "%s%s", reading,
             source->range_is_given ? "" : "; holds 99 % of the cloth");
    set_scale(legend, -percent, percent, diverging);
    add_entry(legend, tl_legend_unknown, "no strain known");
}

static void describe_visibility(const struct tl_legend_source *source, struct tl_legend *legend)
{
    if (source->region < 0)
        snprintf(legend->title, sizeof legend->title, "visibility of the environment");
    else
        snprintf(legend->title, sizeof legend->title, "visibility of region %d", source->region);
    snprintf(legend->note, sizeof legend->note, "%s",
             source->region < 0 ? "share of the regions' light that reaches a matt surface" : "by rays");
    set_scale(legend, 0, 1, grey);
}

struct ranked_region {
    float importance;
    int number;
};

/* Orders regions by falling importance; equal ones by their number. */
static int compare_ranks(const void *a, const void *b)
{
    const struct ranked_region *left = a, *right = b;
    if (left->importance != right->importance)
        return left->importance < right->importance ? 1 : -1;
    return left->number - right->number;
}

static void list_regions(const struct tl_regions *regions, struct tl_legend *legend)
{
    struct ranked_region order[TL_REGIONS_MAX] = {{0}};
    double all = 0;
    for (int i = 0; i < regions->count; i++) {
        order[i] = (struct ranked_region){regions->items[i].importance, i};
        all += (double)regions->items[i].importance;
    }
    qsort(order, (size_t)regions->count, sizeof order[0], compare_ranks);
    for (int i = 0; i < regions->count && i < TL_LEGEND_ENTRIES && order[i].importance > 0; i++) {
        char label[40];
        snprintf(label, sizeof label, "%d: %.2g %%", order[i].number,
                 100 * (double)order[i].importance / all);
        add_entry(legend, tl_number_colour((uint32_t)order[i].number), label);
    }
}

static void describe_regions(const struct tl_legend_source *source, struct tl_legend *legend)
{
    snprintf(legend->title, sizeof legend->title, "brightest region");
    if (!source->regions)
        return;
    snprintf(
        legend->note, sizeof legend->note,
        "the region of %d that lights a point most; listed: the strongest, with their share of all light",
        source->regions->count);
    list_regions(source->regions, legend);
}

static void describe_uv(struct tl_legend *legend)
{
    snprintf(legend->title, sizeof legend->title, "texture coordinates");
    snprintf(legend->note, sizeof legend->note, "squares of %d mm of cloth, in blocks of %d mm",
             TL_CHECKER_SQUARE_MM, TL_CHECKER_BLOCK_MM);
    add_entry(legend, tl_checker_colour(0, 1), "even blocks");
    add_entry(legend, tl_checker_colour(1, 1), "odd blocks");
    add_entry(legend, tl_legend_unknown, "no scale known");
}

void tl_legend_make(const struct tl_legend_source *source, struct tl_legend *out)
{
    *out = (struct tl_legend){0};
    switch (source->view) {
    case TL_VIEW_NORMAL:
    case TL_VIEW_SMOOTH:
        snprintf(out->title, sizeof out->title,
                 source->view == TL_VIEW_NORMAL ? "normal, with bumps" : "normal, without bumps");
        snprintf(out->note, sizeof out->note, "world axes, for the side towards the camera");
        list_directions(out);
        break;
    case TL_VIEW_TANGENT:
        snprintf(out->title, sizeof out->title, "tangent: direction of the weft");
        snprintf(out->note, sizeof out->note, "world axes; lines run along the warp, every %d mm",
                 TL_HATCH_MM);
        list_directions(out);
        break;
    case TL_VIEW_UV:
        describe_uv(out);
        break;
    case TL_VIEW_ALBEDO:
        snprintf(out->title, sizeof out->title, "diffuse colour");
        snprintf(out->note, sizeof out->note, "share of the light that is scattered");
        break;
    case TL_VIEW_GLOSS:
        snprintf(out->title, sizeof out->title, "glossiness");
        snprintf(out->note, sizeof out->note, "0: matt; 1: a mirror");
        set_scale(out, 0, 1, grey);
        break;
    case TL_VIEW_VISIBILITY:
        describe_visibility(source, out);
        break;
    case TL_VIEW_REGION:
        describe_regions(source, out);
        break;
    case TL_VIEW_STRAIN_WARP:
    case TL_VIEW_STRAIN_WEFT:
    case TL_VIEW_STRAIN_SHEAR:
        describe_strain(source, out);
        break;
    case TL_VIEW_CROSSING:
        snprintf(out->title, sizeof out->title, "cloth that passes through itself");
        add_entry(out, tl_legend_crossing, "triangles that cross");
        break;
    case TL_VIEW_LIGHT:
    case TL_VIEW_COUNT:
        break;
    }
}

vec3s tl_legend_colour(const struct tl_legend *legend, float value)
{
    int last = legend->stop_count - 1;
    float place = (float)last * (value - legend->low) / (legend->high - legend->low);
    if (!(place > 0))
        return legend->stops[0].colour;
    if (place >= (float)last)
        return legend->stops[last].colour;
    int before = (int)place;
    return glms_vec3_lerp(legend->stops[before].colour, legend->stops[before + 1].colour,
                          place - (float)before);
}

const vec3s tl_legend_crossing = {{0.85f, 0.2f, 0.1f}};
const vec3s tl_legend_unknown = {{0.36f, 0.36f, 0.36f}};

vec3s tl_checker_colour(int block, int square)
{
    return colour_of_oklch(square ? 0.82f : 0.55f, 0.09f, block ? 55 : 257);
}
