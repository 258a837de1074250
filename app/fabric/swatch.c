#include "app/fabric/swatch.h"

#include "app/cli/json.h"
#include "app/settings/imported.h"
#include "assets/image/image_file.h"
#include "assets/swatch/swatch.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "render/detail/bake.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define LEAN_MAX_DEG     5.0f
#define RESIDUAL_MAX     0.1f
#define GLOSS_DEFAULT    0.5f
#define SPECULAR_DEFAULT 0.04f

struct session {
    const struct tl_arguments *arguments;
    struct tl_swatch_rig rig;
    tl_image pictures[TL_SWATCH_LAMPS_MAX];
    struct tl_swatch_maps swatch;
};

static bool load_pictures(struct session *session, tl_error *error)
{
    const struct tl_arguments *given = session->arguments;
    if (given->positional_count != session->rig.count)
        return tl_fail(error, TL_USAGE,
                       "%s: has %zu lamps for %zu pictures: give one picture a lamp, in their order",
                       given->lights, session->rig.count, given->positional_count);
    for (size_t k = 0; k < session->rig.count; k++) {
        tl_image *picture = &session->pictures[k], *first = session->pictures;
        uint64_t bytes = (uint64_t)sizeof(float) * 3 * (uint64_t)first->width * (uint64_t)first->height;
        if (k == 1 &&
            !tl_memory_request("the pictures of the swatch", bytes * (session->rig.count + 2), error))
            return false;
        if (!tl_swatch_picture_load(given->positionals[k], picture, error))
            return false;
        if (picture->width != first->width || picture->height != first->height)
            return tl_fail(error, TL_INPUT, "%s: %d x %d texels, but %s has %d x %d: take all from one place",
                           given->positionals[k], picture->width, picture->height, given->positionals[0],
                           first->width, first->height);
    }
    return true;
}

static bool save(const char *folder, const char *name, const tl_image *bytes, tl_error *error)
{
    char *path = tl_format("%s/%s.png", folder, name);
    bool saved = tl_image_save_png(path, bytes, error);
    free(path);
    return saved;
}

/* The albedo as sRGB; `brightest` is its highest value. */
static tl_image colours_of(const tl_image *albedo, float *brightest)
{
    tl_image out = tl_image_create(albedo->width, albedo->height, 3, TL_IMAGE_U8);
    size_t count = 3 * (size_t)albedo->width * (size_t)albedo->height;
    *brightest = 0;
    for (size_t i = 0; i < count; i++) {
        float value = tl_image_floats(albedo)[i];
        *brightest = fmaxf(*brightest, value);
        tl_image_bytes(&out)[i] = (uint8_t)(255 * tl_srgb_from_linear(fminf(value, 1)) + 0.5f);
    }
    return out;
}

static bool save_pictures(const char *folder, const struct tl_swatch_maps *swatch, tl_error *error)
{
    float brightest;
    tl_image normals = tl_bake_encoded(&swatch->normal), colours = colours_of(&swatch->albedo, &brightest);
    if (brightest > 1)
        tl_warn("the swatch sends back up to %.2f times the light: photograph white paper and give "
                "`intensity` its "
                "value",
                (double)brightest);
    bool saved = save(folder, "normal", &normals, error) && save(folder, "colour", &colours, error);
    tl_image_release(&normals);
    tl_image_release(&colours);
    return saved;
}

static bool save_options(const char *folder, const struct tl_swatch_rig *rig,
                         const struct tl_swatch_maps *swatch, tl_error *error)
{
    struct tl_writer writer;
    double width = (double)rig->width_mm,
           specular = (double)(swatch->has_gloss ? fminf(swatch->specular, 1) : SPECULAR_DEFAULT);
    char *path = tl_format("%s/%s", folder, TL_FABRIC_OWN_FILE);
    bool saved = tl_writer_begin(&writer, path, error);
    if (saved) {
        fprintf(writer.stream,
                "# Photographed under %zu lamps by toile fabric; --fabric takes this file.\n"
                "weave:\n"
                "  pattern: none\n"
                "  pictures: . # normal.png, colour.png\n"
                "  picture_mm: %.6g\n"
                "  picture_length_mm: %.6g\n"
                "  picture_mirror: both # what does not repeat does as mirror images\n"
                "material:\n"
                "  use_file: false\n"
                "  diffuse: [1, 1, 1] # times colour.png\n"
                "  specular: [%.4g, %.4g, %.4g] # %s\n"
                "  glossiness: %.4g\n",
                rig->count, width, width * swatch->normal.height / swatch->normal.width, specular, specular,
                specular,
                swatch->has_gloss ? "measured"
                                  : "not measured: the lamps stand too far off the mirror direction",
                (double)(swatch->specular > 0 ? swatch->glossiness : GLOSS_DEFAULT));
        saved = tl_writer_commit(&writer, error);
    }
    free(path);
    return saved;
}

bool tl_fabric_swatch_save(const char *folder, const struct tl_swatch_rig *rig,
                           const struct tl_swatch_maps *swatch, tl_error *error)
{
    return save_pictures(folder, swatch, error) && save_options(folder, rig, swatch, error);
}

static size_t worst_lamp(const struct session *session)
{
    size_t worst = 0;
    for (size_t k = 1; k < session->rig.count; k++)
        worst = session->swatch.lamps[k].residual > session->swatch.lamps[worst].residual ? k : worst;
    return worst;
}

static void warn(const struct session *session)
{
    const struct tl_swatch_maps *swatch = &session->swatch;
    size_t worst = worst_lamp(session);
    if (swatch->residual > RESIDUAL_MAX)
        tl_warn("the lamps leave %.0f %% unexplained, the most in %s: check its direction and `intensity`",
                100 * (double)swatch->residual, session->arguments->positionals[worst]);
    if (swatch->lean_deg > LEAN_MAX_DEG)
        tl_warn("the swatch leaned by %.1f degrees and was levelled: check the directions of the lamps",
                (double)swatch->lean_deg);
    if (!swatch->has_gloss)
        tl_warn(
            "no lamp stands near the mirror direction, as at 70 degrees: gloss is the default, not measured");
}

static void print_table(const struct session *session)
{
    const struct tl_swatch_maps *swatch = &session->swatch;
    printf("%-28s %9s %9s %9s\n", "picture", "residual", "brighter", "used");
    for (size_t k = 0; k < session->rig.count; k++)
        printf("%-28s %8.2f%% %8.2f%% %8.1f%%\n", session->arguments->positionals[k],
               100 * (double)swatch->lamps[k].residual, 100 * (double)swatch->lamps[k].bias,
               100 * (double)swatch->lamps[k].used);
    printf("residual %.2f %%, lean %.2f degrees, corners %.1f %% darker, unknown %.2f %% of the texels\n",
           100 * (double)swatch->residual, (double)swatch->lean_deg, 100 * (1 - (double)swatch->corner),
           100 * (double)swatch->unknown);
    if (swatch->has_gloss)
        printf("glossiness %.3f, specular %.4f\n", (double)swatch->glossiness, (double)swatch->specular);
}

static void print_json(const struct session *session)
{
    const struct tl_swatch_maps *swatch = &session->swatch;
    cJSON *object = cJSON_CreateObject(), *lamps = cJSON_AddArrayToObject(object, "lamps");
    for (size_t k = 0; k < session->rig.count; k++) {
        cJSON *lamp = cJSON_CreateObject();
        cJSON_AddStringToObject(lamp, "picture", session->arguments->positionals[k]);
        cJSON_AddNumberToObject(lamp, "residual", (double)swatch->lamps[k].residual);
        cJSON_AddNumberToObject(lamp, "bias", (double)swatch->lamps[k].bias);
        cJSON_AddNumberToObject(lamp, "used", (double)swatch->lamps[k].used);
        cJSON_AddItemToArray(lamps, lamp);
    }
    cJSON_AddNumberToObject(object, "residual", (double)swatch->residual);
    cJSON_AddNumberToObject(object, "lean_deg", (double)swatch->lean_deg);
    cJSON_AddNumberToObject(object, "corner", (double)swatch->corner);
    cJSON_AddNumberToObject(object, "unknown", (double)swatch->unknown);
    cJSON_AddBoolToObject(object, "has_gloss", swatch->has_gloss);
    cJSON_AddNumberToObject(object, "glossiness", (double)swatch->glossiness);
    cJSON_AddNumberToObject(object, "specular", (double)swatch->specular);
    tl_json_print(object);
}

bool tl_fabric_swatch(const struct tl_arguments *arguments, tl_error *error)
{
    struct session session = {.arguments = arguments};
    if (!arguments->output || arguments->card)
        return tl_fail(error, TL_USAGE, "--lights: writes a fabric: add -o FOLDER%s",
                       arguments->card ? ", and make the card of that folder" : "");
    bool done = tl_swatch_rig_load(arguments->lights, &session.rig, error) &&
                load_pictures(&session, error) &&
                tl_swatch_solve(&session.rig, session.pictures, &session.swatch, error) &&
                tl_folder_make(arguments->output, error) &&
                tl_fabric_swatch_save(arguments->output, &session.rig, &session.swatch, error);
    if (done) {
        tl_info("%s/%s: use it with --fabric %s/", arguments->output, TL_FABRIC_OWN_FILE, arguments->output);
        warn(&session);
        (arguments->json ? print_json : print_table)(&session);
    }
    for (size_t k = 0; k < TL_SWATCH_LAMPS_MAX; k++)
        tl_image_release(&session.pictures[k]);
    tl_swatch_release(&session.swatch);
    return done;
}
