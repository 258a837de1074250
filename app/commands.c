#include "app/commands.h"

#include "app/batch/commands.h"
#include "app/fabric/commands.h"
#include "app/lab/check/commands.h"
#include "app/lab/commands.h"
#include "app/lab/flight/commands.h"
#include "app/lab/gallery/commands.h"
#include "app/lab/trade/commands.h"
#include "app/manual/manual.h"
#include "app/settings/settings.h"
#include "app/sheet/commands.h"
#include "app/view/commands.h"
#include "config/base/memory.h"
#include "config/base/words.h"

#include <stdio.h>
#include <string.h>

/* Commands in the order of `toile help`. */
static const struct tl_command commands[] = {
    {"view", "view [SCENE] [OPTIONS]",
     "Opens the review window: orbit, play, pull on the cloth, change fabric and light.",
     TL_FLAGS_SCENE | TL_FLAGS_WINDOW | TL_FLAGS_BUDGET, tl_command_view},
    {"render", "render [SCENE] -o OUT.exr|OUT.png [OPTIONS]",
     "Renders frames without a screen: .exr holds linear radiance and coverage, .png the picture as "
     "displayed.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_FRAME | TL_FLAGS_FRAMES | TL_FLAGS_AOV | TL_FLAGS_SHARD,
     tl_command_render},
    {"fly", "fly [SCENE] -o FOLDER [--budget MS] [--path FILE.yaml] [--frames N] [OPTIONS]",
     "Flies round the moving garment and records every frame: FOLDER/frames.csv, summary.json, report.html.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_JSON | TL_FLAGS_FLY | TL_FLAGS_BUDGET | TL_FLAGS_SHARD,
     tl_command_fly},
    {"plan", "plan [SCENE] [--json] [OPTIONS]",
     "Prints what would run for a frame, why, at what cost and in how much memory.",
     TL_FLAGS_SCENE | TL_FLAGS_FRAME | TL_FLAGS_JSON | TL_FLAGS_BUDGET | TL_FLAGS_PLAN, tl_command_plan},
    {"bench", "bench light|cloth|shading [--json] [--quick|--full] [SCENE] [OPTIONS]",
     "Compares methods in one run. light: CPU time and error of the presets in motion and at rest, frame by "
     "frame in turn; shading: those of the ways to shade under a lamp; cloth: steps per second of the "
     "solvers and of a plain loop, normals and tangents, a dress that comes to rest.",
     TL_FLAGS_SCENE | TL_FLAGS_JSON | TL_FLAGS_QUICK | TL_FLAGS_FULL, tl_command_bench},
    {"check", "check [SCENE] [--frames N] [--budget MS] [--keep FOLDER] [--json] [OPTIONS]",
     "Plays a scene and checks every frame against a table of invariants: geometry, pixels, shadow maps, "
     "visibility, regions, cloth, and sampled pixels against the ray-traced reference. Prints the largest "
     "deviation of each invariant and its place; fails if one exceeds its bound.",
     TL_FLAGS_SCENE | TL_FLAGS_JSON | TL_FLAGS_CHECK | TL_FLAGS_BUDGET, tl_command_check},
    {"trade",
     "trade [SCENE] -o FOLDER [--axis overall|light|resolution|detail|shading|levels|cloth] [--quick] "
     "[OPTIONS]",
     "Measures error against time over many choices of settings: FOLDER/trade.csv and report.html.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_AXIS | TL_FLAGS_QUICK, tl_command_trade},
    {"stability", "stability [light|cloth|detail|shading] [--json] [--quick] [OPTIONS]",
     "Runs extreme inputs and settings, measures the error of each, and checks that it is exact, bounded by "
     "25 %, coarse with a remedy, or refused with a clear message.",
     TL_FLAGS_SCENE | TL_FLAGS_JSON | TL_FLAGS_QUICK, tl_command_stability},
    {"gallery", "gallery [SECTION] -o FOLDER [--quick]",
     "Renders every technique and setting next to its exact evaluation, with its error and its time: "
     "pictures, FOLDER/gallery.html and gallery.csv. After an interruption the same command continues.",
     TL_FLAGS_OUTPUT | TL_FLAGS_QUICK, tl_command_gallery},
    {"sheet", "sheet [SCENE] -o OUT.png|FOLDER [OPTIONS]",
     "Draws a contact sheet: garments x fabrics or colourways down, environments x views across, as one "
     "image or as a folder with a page. After an interruption the same command continues.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_FRAME | TL_FLAGS_SHEET | TL_FLAGS_SHARD, tl_command_sheet},
    {"compare", "compare TESTED REFERENCE [--mask FILE] [--json] [--ldr|--hdr]",
     "Prints how much two images differ: relative RMSE, mean FLIP, largest difference.",
     TL_FLAGS_JSON | TL_FLAGS_METRIC, tl_command_compare},
    {"export", "export [SCENE] -o OUT.glb|OUT.obj|OUT.pc2|OUT.mdd [OPTIONS]",
     "Writes a frame: the garment and its avatar as .glb, the garment as .obj; or with --frames the "
     "garment's motion as .pc2 or .mdd.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_FRAME | TL_FLAGS_FRAMES, tl_command_export},
    {"bake", "bake COARSE FINE -o OUT.png|OUT.exr [--size N] [--reach-mm MM]",
     "Bakes a finer mesh of a garment into a map over the texture coordinates of a coarser one: its normals "
     "as .png, for "
     "detail.normals, or its heights in metres as .exr, for detail.heights.",
     TL_FLAGS_OUTPUT | TL_FLAGS_BAKE, tl_command_bake},
    {"measure", "measure [SCENE] [-o OUT.csv] [--frame N] [--interval] [--json] [OPTIONS]",
     "Measures a garment as it is worn: strain (warp, weft, shear) and area of each panel, its openings, and "
     "its girths beside its body's; -o writes the same as CSV.",
     TL_FLAGS_SCENE | TL_FLAGS_OUTPUT | TL_FLAGS_FRAME | TL_FLAGS_JSON | TL_FLAGS_MEASURE,
     tl_command_measure},
    {"env",
     "env IN -o OUT.exr --layout cube|sphere|paraboloid|latlong|octahedral [--from LAYOUT] [--size N]\n"
     "       toile env [SCENE] --capture -o OUT.exr --layout LAYOUT [--size N] [OPTIONS]",
     "Converts an environment map between layouts, keeping its light; or captures one from a scene.",
     TL_FLAGS_OUTPUT | TL_FLAGS_LAYOUT | TL_FLAGS_CAPTURE, tl_command_env},
    {"fabric",
     "fabric NAME|FILE|FOLDER [-o FOLDER|FILE.yaml] [--json] [--set TABLE.KEY=VALUE]\n"
     "       toile fabric NAME|FILE|FOLDER --card FILE.png|FILE.pdf|FILE.json\n"
     "       toile fabric IN.png|IN.exr -o FOLDER [--repeat-mm MM] [--height-mm MM] [--clamp]\n"
     "       toile fabric PICTURE PICTURE PICTURE PICTURE... --lights FILE.yaml -o FOLDER [--json]",
     "Lists what a fabric's file holds and what each field is used for, writes the fabric in toile's own "
     "form, or makes its card (swatch to scale, close-up, drape, colour, physical figures): a "
     "name, .yaml, U3M (.u3m, .u3ma), measurements (.json), a folder or .zip of texture maps. Of a height "
     "map it "
     "bakes normal, offset, horizon and gloss maps, and prints their size and scale. Of photographs of a "
     "flat "
     "swatch under known lamps it makes a fabric: normals, colours and gloss.",
     TL_FLAGS_OUTPUT | TL_FLAGS_FABRIC | TL_FLAGS_JSON, tl_command_fabric},
    {"cache", "cache [--clear] [--json]",
     "Lists the results that are kept for reuse (drapes, thumbnails, filtered environments), or removes "
     "them.",
     TL_FLAGS_JSON | TL_FLAGS_CLEAR, tl_command_cache},
    {"info", "info FILE|fabrics|presets|garments|findings [--strict] [--json]",
     "Prints what a file holds, how it will be read, and what is wrong with it; or lists what is built in. "
     "findings: the codes of what can be wrong.",
     TL_FLAGS_JSON | TL_FLAGS_STRICT, tl_command_info},
    {"help",
     "help [COMMAND|options|reference]\n       toile help man [COMMAND]\n       toile help complete LINE",
     "Lists the commands, explains one, or prints every option (reference: as a Markdown page; man: as a "
     "page "
     "of the manual). complete: what can stand at the end of a command line, for the shell.",
     0, tl_command_help},
};

const struct tl_command *tl_command_find(const char *name, tl_error *error)
{
    const char *names[TL_COUNT(commands)];
    for (size_t i = 0; i < TL_COUNT(commands); i++) {
        if (strcmp(commands[i].name, name) == 0)
            return &commands[i];
        names[i] = commands[i].name;
    }
    const char *near = tl_nearest_word(name, names, TL_COUNT(commands));
    if (near)
        tl_fail(error, TL_USAGE, "%s: no such command: did you mean `toile %s`?", name, near);
    else
        tl_fail(error, TL_USAGE, "%s: no such command: `toile help` lists them", name);
    return NULL;
}

static bool print_command_help(const char *name, tl_error *error)
{
    const struct tl_command *command = tl_command_find(name, error);
    if (!command)
        return false;
    printf("usage: toile %s\n\n%s\n\n", command->usage, command->help);
    tl_arguments_print_flags(command->flags);
    return true;
}

static bool print_manual(const struct tl_manual *manual, const char *name, tl_error *error)
{
    const struct tl_command *command = name ? tl_command_find(name, error) : NULL;
    if (name && !command)
        return false;
    if (command)
        tl_manual_print_command(manual, command, stdout);
    else
        tl_manual_print(manual, stdout);
    return true;
}

bool tl_command_help(const struct tl_arguments *arguments, tl_error *error)
{
    const char *topic = arguments->positional_count ? arguments->positionals[0] : NULL;
    const char *subject = arguments->positional_count > 1 ? arguments->positionals[1] : NULL;
    struct tl_settings settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&settings, bindings);
    tl_options_reset(bindings, TL_SETTINGS_TABLES);
    if (topic && strcmp(topic, "options") == 0) {
        tl_options_print_help(bindings, TL_SETTINGS_TABLES, stdout);
        return true;
    }
    if (topic && strcmp(topic, "reference") == 0) {
        tl_options_print_reference(bindings, TL_SETTINGS_TABLES, stdout);
        return true;
    }
    const struct tl_manual manual = {TOILE_VERSION, commands, TL_COUNT(commands), bindings,
                                     TL_SETTINGS_TABLES};
    if (topic && strcmp(topic, "man") == 0)
        return print_manual(&manual, subject, error);
    if (topic && strcmp(topic, "complete") == 0) {
        tl_complete_print(&manual, subject ? subject : "", stdout);
        return true;
    }
    if (topic)
        return print_command_help(topic, error);
    printf(
        "toile %s: garment review. usage: toile COMMAND [SCENE] [OPTIONS]\n\n"
        "SCENE is a YAML file, a .glb, .gltf or .obj model, a sewing pattern (.json), a point cache (.pc2, "
        ".mdd) beside its mesh, or nothing: the built-in scene.\n\n",
        TOILE_VERSION);
    for (size_t i = 0; i < TL_COUNT(commands); i++)
        printf("  %-9s %s\n", commands[i].name, commands[i].help);
    printf("\n`toile COMMAND --help` explains a command, `toile help options` lists every option.\n");
    return true;
}
