#include "assets/swatch/swatch_internal.h"
#include "config/options.h"

/* Files of lamps are read each time that they are used. */
#define AFFECTS TL_AFFECTS_NOTHING

typedef struct tl_swatch_rig rig_params;
static const struct tl_option swatch_rows[] = {
    TL_OPTION_FLOAT(rig_params, width_mm, AFFECTS, 0.1, 10000, "mm", "width of the pictures on the swatch"),
    TL_OPTION_FLOAT(rig_params, camera_mm, AFFECTS, 0, 1e6, "mm", "height of the camera; 0: far away"),
    TL_OPTION_BOOL(rig_params, even, AFFECTS, "divide out what darkens towards the corners, as a lens does"),
};
static const struct tl_option_table swatch_table =
    TL_OPTION_TABLE("swatch", "a photographed piece of cloth", swatch_rows, rig_params, .even = true);

typedef struct tl_swatch_lamp lamp_params;
static const struct tl_option lamp_rows[] = {
    TL_OPTION_FLOAT(lamp_params, azimuth_deg, AFFECTS, -360, 360, "degrees",
                    "direction in the pictures: 0 is the right, 90 the top"),
    TL_OPTION_FLOAT(lamp_params, elevation_deg, AFFECTS, 1, 90, "degrees", "above the swatch"),
    TL_OPTION_VECTOR(lamp_params, position_mm, AFFECTS, -1e6, 1e6, "mm",
                     "from the middle, z above the swatch"),
    TL_OPTION_FLOAT(lamp_params, intensity, AFFECTS, 1e-6, 1e6, "",
                    "value of white cloth that faces the lamp"),
};
static const struct tl_option_table lamp_table = TL_OPTION_TABLE(
    "lamps", "a lamp of a photograph", lamp_rows, lamp_params, .elevation_deg = 45, .intensity = 1);

struct reading {
    struct tl_swatch_rig *rig;
    struct tl_swatch_lamp lamp;
};

static bool take(void *context, const char *path, size_t line, tl_error *error)
{
    struct reading *reading = context;
    const float *at = reading->lamp.position_mm;
    if (at[2] < 0 || (at[2] == 0 && (at[0] != 0 || at[1] != 0)))
        return tl_fail(error, TL_USAGE, "%s:%zu: lamps.position_mm: lies in the swatch or below it: z is up",
                       path, line);
    if (reading->rig->count == TL_SWATCH_LAMPS_MAX)
        return tl_fail(error, TL_USAGE, "%s:%zu: lamps: more than %d", path, line, TL_SWATCH_LAMPS_MAX);
    reading->rig->lamps[reading->rig->count++] = reading->lamp;
    return true;
}

/* Whether the lamps' directions at the middle of the swatch span space. */
static bool check_directions(const struct tl_swatch_rig *rig, const char *path, tl_error *error)
{
    struct tl_swatch_normal_equations sum = {0};
    double solution[3], spread = INFINITY;
    for (size_t k = 0; k < rig->count; k++) {
        struct tl_swatch_light light = tl_swatch_light_at(&rig->lamps[k], 1, 0, 0);
        tl_swatch_add(&sum, light.direction, 1, 0);
    }
    if (tl_swatch_invert(&sum, solution, &spread) && spread < TL_SWATCH_SPREAD_MAX)
        return true;
    return tl_fail(
        error, TL_USAGE,
        "%s: lamps: lie in one plane with the swatch, or nearly in one direction: set them all round it, "
        "at 30 to 60 degrees",
        path);
}

bool tl_swatch_rig_load(const char *path, struct tl_swatch_rig *out, tl_error *error)
{
    struct reading reading = {.rig = out};
    const struct tl_binding bindings[] = {{&swatch_table, out}, {&lamp_table, &reading.lamp}};
    const struct tl_option_list list = {&lamp_table, take, &reading};
    *out = (struct tl_swatch_rig){0};
    tl_options_reset(bindings, 1);
    if (!tl_options_read_yaml_list(bindings, 2, &list, path, error))
        return false;
    if (out->count < TL_SWATCH_LAMPS_MIN)
        return tl_fail(error, TL_USAGE, "%s: lamps: %zu given: at least %d are needed, one a picture", path,
                       out->count, TL_SWATCH_LAMPS_MIN);
    if (!(out->width_mm > 0))
        return tl_fail(error, TL_USAGE,
                       "%s: swatch.width_mm: is missing: the width of the pictures on the cloth", path);
    return check_directions(out, path, error);
}
