/* The figures of a fabric card: mechanics with their sources, and the colour that the fabric states. */
#include "app/fabric/card_internal.h"
#include "app/fabric/fields.h"
#include "app/settings/imported.h"
#include "app/settings/layers.h"
#include "app/textures/weaves.h"
#include "assets/base/image.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GRAVITY             9.81 /* m/s^2 */
#define MICRO_NEWTON_METRES "\u00b5N\u00b7m"

struct tl_card_colour tl_card_colour_of(const float rgb[3])
{
    struct tl_card_colour colour = {.lab = tl_lab_of(rgb), .hex = tl_hex_of(rgb)};
    memcpy(colour.rgb, rgb, sizeof colour.rgb);
    return colour;
}

/* ---- The source of a figure ---- */

/* The value that the fabric's source itself states; NaN: none. */
struct stated {
    struct tl_cloth_fabric mechanics;
    struct tl_construction_params construction;
};

/* A fabric's file over values that are no numbers: those that remain are not stated. */
static bool find_stated(const struct tl_fabric *fabric, struct stated *out, tl_error *error)
{
    struct tl_weave_params weave;
    struct tl_material_params material;
    const struct tl_binding bindings[TL_FABRIC_TABLES] = {{&tl_cloth_fabric_options, &out->mechanics},
                                                          {&tl_weave_options, &weave},
                                                          {&tl_material_options, &material},
                                                          {&tl_construction_options, &out->construction}};
    tl_options_reset(bindings, TL_FABRIC_TABLES);
    out->construction.thickness_mm = NAN;
    out->mechanics = (struct tl_cloth_fabric){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    return fabric->is_foreign
               ? tl_imported_apply_file(fabric->source, &fabric->file, bindings, TL_FABRIC_TABLES, error)
               : tl_option_layer_apply(&tl_option_layer_fabric, fabric->source, bindings, TL_FABRIC_TABLES,
                                       NULL, error);
}

static void add(struct tl_card *card, const char *name, double value, const char *unit, const char *source)
{
    struct tl_card_figure *figure = &card->figures[card->figure_count++];
    *figure = (struct tl_card_figure){.name = name, .unit = unit, .value = value};
    snprintf(figure->source, sizeof figure->source, "%s", source);
}

/* One option in its stages: as the file states it (NaN: it does not), as the fabric is read, as it is used.
 */
struct staged {
    double stated, read, used;
};

/* Adds an option with its source: --set, the file, or the default. */
static void add_option(struct tl_card *card, const char *name, const char *option, struct staged value,
                       double scale, const char *unit)
{
    const struct tl_fabric_field *field = tl_fabric_field_of(&card->fabric.file, option);
    char source[128];
    if (value.used != value.read)
        snprintf(source, sizeof source, "set: %s", option);
    else if (isnan(value.stated))
        snprintf(source, sizeof source, "not stated: toile's default");
    else if (field)
        snprintf(source, sizeof source, "%s", field->name);
    else
        snprintf(source, sizeof source, "%s: %s", tl_fabric_name(&card->fabric), option);
    add(card, name, scale * value.used, unit, source);
}

/* The length of a strip that bends under its own weight to 41.5 degrees is twice this [Peirce 1930; BS 3356,
 * ISO 9073-7], mm. */
static double bending_length_mm(double rigidity, double areal_density)
{
    return 1e3 * cbrt(rigidity / (areal_density * GRAVITY));
}

static void add_mechanics(struct tl_card *card, const struct stated *stated)
{
    const struct tl_cloth_fabric *own = &stated->mechanics, *read = &card->fabric.mechanics;
    const struct tl_cloth_fabric *now = &card->settings.fabric;
    const struct staged thickness = {(double)stated->construction.thickness_mm,
                                     (double)card->fabric.construction.thickness_mm,
                                     (double)card->settings.construction.thickness_mm};
#define STAGED(field) (struct staged){own->field, read->field, now->field}
    add_option(card, "Weight", "fabric.areal_density", STAGED(areal_density), 1e3, "g/m\u00b2");
    add_option(card, "Thickness", "construction.thickness_mm", thickness, 1, "mm");
    add_option(card, "Stretch stiffness, weft", "fabric.stretch_weft", STAGED(stretch_weft), 1, "N/m");
    add_option(card, "Stretch stiffness, warp", "fabric.stretch_warp", STAGED(stretch_warp), 1, "N/m");
    add_option(card, "Shear stiffness", "fabric.shear", STAGED(shear), 1, "N/m");
    add_option(card, "Bending rigidity, weft", "fabric.bend_weft", STAGED(bend_weft), 1e6,
               MICRO_NEWTON_METRES);
    add_option(card, "Bending rigidity, warp", "fabric.bend_warp", STAGED(bend_warp), 1e6,
               MICRO_NEWTON_METRES);
#undef STAGED
    const char *peirce = "from rigidity and weight [Peirce 1930]";
    add(card, "Bending length, weft", bending_length_mm(now->bend_weft, now->areal_density), "mm", peirce);
    add(card, "Bending length, warp", bending_length_mm(now->bend_warp, now->areal_density), "mm", peirce);
    add(card, "Drape coefficient", 100 * card->drape, "%",
        card->is_at_rest ? "simulated: Cusick, ISO 9073-9" : "simulated: Cusick; not yet at rest");
    add(card, "Shimmer from 1 m", 100 * card->shimmer, "%",
        "drawn: five steps of parts of a pixel, against 8 x 8 finer");
    const struct tl_weave_params *weave = &card->settings.weave;
    if (tl_text_is_given(weave->pictures))
        add(card, "Width of a repeat", (double)tl_weave_picture_mm(weave), "mm",
            weave->picture_mm > 0 ? "weave.picture_mm" : "not stated: assumed; set weave.picture_mm");
}

/* ---- The base colour ---- */

/* The mean factor of a weave's or of pictures' colours; 1 without. */
static bool find_mean_tint(const struct tl_weave_params *weave, double mean[3], tl_error *error)
{
    const struct tl_fabric_pictures *made;
    if (!tl_weaves_take(weave, &made, error))
        return false;
    const tl_image none = {0}, *tint = made ? &made->weave.tint : &none;
    size_t count = 3 * (size_t)tint->width * (size_t)tint->height;
    for (int c = 0; c < 3; c++)
        mean[c] = tint->texels ? 0 : 1;
    for (size_t i = 0; i < count; i++)
        mean[i % 3] += 3 * (double)tl_image_floats(tint)[i] / (double)count;
    tl_weaves_give(made);
    return true;
}

/* material.diffuse times that mean: what a path tracer calls the base colour, without gloss. */
static bool fill_base(struct tl_card *card, tl_error *error)
{
    const struct tl_material_params *material = &card->settings.material;
    double mean[3];
    float rgb[3];
    if (!find_mean_tint(&card->settings.weave, mean, error))
        return false;
    for (int c = 0; c < 3; c++)
        rgb[c] = material->diffuse[c] * (float)mean[c];
    card->has_colour = !material->use_file;
    card->base = tl_card_colour_of(rgb);
    card->difference = tl_lab_difference(card->base.lab, card->measured.lab);
    return true;
}

bool tl_card_fill_figures(struct tl_card *card, tl_error *error)
{
    struct stated stated;
    if (!find_stated(&card->fabric, &stated, error) || !fill_base(card, error))
        return false;
    add_mechanics(card, &stated);
    return true;
}
