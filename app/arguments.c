#include "app/arguments.h"

#include "config/memory.h"
#include "config/options.h"
#include "config/words.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum flag_kind {
    FLAG_ASSIGN, /* sets the option named in `key` */
    FLAG_SET,
    FLAG_SIZE,
    FLAG_OUTPUT,
    FLAG_FRAME,
    FLAG_FRAMES,
    FLAG_JSON,
    FLAG_LDR,
    FLAG_HDR,
    FLAG_SCREENSHOTS,
    FLAG_MAX_FRAMES,
    FLAG_FRESH,
    FLAG_BUDGET,
    FLAG_AXIS,
    FLAG_QUICK,
    FLAG_CAPTURE,
    FLAG_AOV,
    FLAG_FULL,
    FLAG_LAYOUT,
    FLAG_FROM,
    FLAG_MAP_SIZE,
    FLAG_REPEAT_MM,
    FLAG_HEIGHT_MM,
    FLAG_CLAMP,
    FLAG_GARMENTS,
    FLAG_FABRICS,
    FLAG_COLOURWAYS,
    FLAG_ENVIRONMENTS,
    FLAG_VIEWS,
    FLAG_SAME_DRAPE,
    FLAG_FRAME_COUNT,
    FLAG_EVERY,
    FLAG_FURNACE,
    FLAG_STILL,
    FLAG_KEEP,
    FLAG_PATH,
    FLAG_VIDEO,
    FLAG_AGAINST,
    FLAG_REPLAY,
    FLAG_ORACLE,
    FLAG_HASH,
    FLAG_QUIET,
    FLAG_VERBOSE,
    FLAG_HELP,
};

struct flag {
    const char *name;
    unsigned set; /* 0: every command */
    enum flag_kind kind;
    const char *key;   /* FLAG_ASSIGN */
    const char *value; /* name of the value in help; NULL: takes none */
    const char *help;
};

static const struct flag flags_known[] = {
    {"--garment", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.garment", "NAME|FILE",
     "dress, skirt, none, or a .glb, .gltf or .obj file"},
    {"--units", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.units", "UNITS",
     "of the garment's file: auto, m, dm, cm, mm or in"},
    {"--motion", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.motion", "FILE",
     "plays a point cache on the garment: .pc2, .mdd, or frame.####.obj"},
    {"--avatar", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.avatar", "NAME|FILE",
     "form, none, or a .glb, .gltf or .obj file"},
    {"--env", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.environment", "NAME|FILE",
     "studio, an .exr or .hdr file, or a sequence of them: sky.####.exr"},
    {"--fabric", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.fabric", "NAME|FILE",
     "a fabric: `toile info fabrics` lists them"},
    {"--colourway", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.colourway", "NAME",
     "fabrics and colours of the scene or of a glTF file: `toile info FILE` lists them"},
    {"--preset", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, "scene.preset", "NAME|FILE",
     "paper, draft, review or final"},
    {"--method", TL_FLAGS_SCENE, FLAG_ASSIGN, "light.method", "METHOD",
     "pem, lights, ao, ao_colour, unshadowed, reference or maps"},
    {"--size", TL_FLAGS_SCENE, FLAG_SIZE, NULL, "WxH", "size of the image in pixels"},
    {"--set", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_SET, NULL, "TABLE.KEY=VALUE",
     "any option: `toile help options` lists them"},
    {"-o", TL_FLAGS_OUTPUT, FLAG_OUTPUT, NULL, "FILE", "where the result goes"},
    {"--frame", TL_FLAGS_FRAME | TL_FLAGS_CAPTURE, FLAG_FRAME, NULL, "N",
     "still image of the animation's frame N; 0 is the settled start"},
    {"--frames", TL_FLAGS_FRAMES, FLAG_FRAMES, NULL, "A:B",
     "all frames from A to B; of pictures OUT.png becomes OUT.0001.png ..."},
    {"--aov", TL_FLAGS_AOV, FLAG_AOV, NULL, NULL,
     ".exr files get layers: N, P, uv, albedo, visibility, strain"},
    {"--json", TL_FLAGS_JSON, FLAG_JSON, NULL, NULL, "print one JSON object and nothing else"},
    {"--ldr", TL_FLAGS_METRIC, FLAG_LDR, NULL, NULL, "compare as display images, clamped to [0, 1]"},
    {"--hdr", TL_FLAGS_METRIC, FLAG_HDR, NULL, NULL, "compare over all exposures that the reference holds"},
    {"--screenshots", TL_FLAGS_WINDOW, FLAG_SCREENSHOTS, NULL, "FOLDER", "where screenshots go"},
    {"--max-frames", TL_FLAGS_WINDOW, FLAG_MAX_FRAMES, NULL, "N", "close after N frames"},
    {"--axis", TL_FLAGS_AXIS, FLAG_AXIS, NULL, "NAME",
     "what is varied: overall, light, resolution, detail, shading or cloth"},
    {"--fresh", TL_FLAGS_WINDOW, FLAG_FRESH, NULL, NULL,
     "as if it were the first time: nothing is remembered, before or after"},
    {"--quick", TL_FLAGS_QUICK, FLAG_QUICK, NULL, NULL, "a few choices and frames only"},
    {"--full", TL_FLAGS_FULL, FLAG_FULL, NULL, NULL, "what takes minutes too"},
    {"--layout", TL_FLAGS_LAYOUT, FLAG_LAYOUT, NULL, "NAME",
     "layout of the result: cube, sphere, paraboloid, latlong or octahedral"},
    {"--from", TL_FLAGS_LAYOUT, FLAG_FROM, NULL, "NAME", "layout of the input; else guessed from its shape"},
    {"--size", TL_FLAGS_LAYOUT, FLAG_MAP_SIZE, NULL, "N",
     "height of the result in texels, or the side of a cube's face"},
    {"--capture", TL_FLAGS_CAPTURE, FLAG_CAPTURE, NULL, NULL,
     "instead of a file: what the middle of a scene sees, the scene itself included"},
    {"--repeat-mm", TL_FLAGS_FABRIC, FLAG_REPEAT_MM, NULL, "MM",
     "width of the height map on the cloth; else 10"},
    {"--height-mm", TL_FLAGS_FABRIC, FLAG_HEIGHT_MM, NULL, "MM",
     "height that a value of 1 (white) stands for; else 0.5"},
    {"--clamp", TL_FLAGS_FABRIC, FLAG_CLAMP, NULL, NULL, "the map does not repeat"},
    {"--garments", TL_FLAGS_SHEET, FLAG_GARMENTS, NULL, "A,B", "names or files, as --garment takes them"},
    {"--fabrics", TL_FLAGS_SHEET, FLAG_FABRICS, NULL, "A,B",
     "names or files, or all; each drapes anew, as the fabric decides how it falls"},
    {"--colourways", TL_FLAGS_SHEET, FLAG_COLOURWAYS, NULL, "A,B", "names, or all that a garment has"},
    {"--envs", TL_FLAGS_SHEET, FLAG_ENVIRONMENTS, NULL, "A,B", "names or files, as --env takes them"},
    {"--views", TL_FLAGS_SHEET, FLAG_VIEWS, NULL, "A,B",
     "front, 3/4, side, left, back-3/4, back, right, scene, degrees (30 or 30:10), or a camera path's .yaml"},
    {"--same-drape", TL_FLAGS_SHEET, FLAG_SAME_DRAPE, NULL, NULL,
     "all fabrics of a garment fall as its first: they only look different"},
    {"--frames", TL_FLAGS_CHECK, FLAG_FRAME_COUNT, NULL, "N", "how many frames; else 300"},
    {"--every", TL_FLAGS_CHECK, FLAG_EVERY, NULL, "K",
     "what takes long is checked in every K-th frame: the oracle, a fresh renderer, sums of light; else 10"},
    {"--furnace", TL_FLAGS_CHECK, FLAG_FURNACE, NULL, NULL, "those frames in white light too"},
    {"--still", TL_FLAGS_CHECK, FLAG_STILL, NULL, NULL, "no hand swings the hem"},
    {"--keep", TL_FLAGS_CHECK, FLAG_KEEP, NULL, "FOLDER",
     "keeps the first frame that breaks, ready to be opened"},
    {"--budget", TL_FLAGS_BUDGET, FLAG_BUDGET, NULL, "MS",
     "time for a frame, in milliseconds; else every frame is drawn in full"},
    {"--frames", TL_FLAGS_FLY, FLAG_FRAME_COUNT, NULL, "N", "so many frames; else 600, or all of the path's"},
    {"--path", TL_FLAGS_FLY, FLAG_PATH, NULL, "FILE.yaml", "camera path; else one round the scene"},
    {"--video", TL_FLAGS_FLY, FLAG_VIDEO, NULL, "FILE.mp4", "what was seen; .mp4, .mkv or .mov, by ffmpeg"},
    {"--against", TL_FLAGS_FLY, FLAG_AGAINST, NULL, "FOLDER", "compare with an earlier flight, job by job"},
    {"--replay", TL_FLAGS_FLY, FLAG_REPLAY, NULL, "FOLDER",
     "fly an earlier flight's path at its levels: the images are the same to the bit"},
    {"--oracle", TL_FLAGS_FLY, FLAG_ORACLE, NULL, "N", "measure every Nth frame against the ray-traced one"},
    {"--hash", TL_FLAGS_FLY, FLAG_HASH, NULL, NULL, "record every image's hash, for a replay to compare"},
    {"--quiet", 0, FLAG_QUIET, NULL, NULL, "say nothing but errors"},
    {"--verbose", 0, FLAG_VERBOSE, NULL, NULL, "say more"},
    {"--help", 0, FLAG_HELP, NULL, NULL, "what the command does and takes"},
};

static bool belongs(const struct flag *flag, unsigned flags)
{
    return flag->set == 0 || (flag->set & flags) != 0;
}

static const struct flag *find_flag(const char *word, unsigned flags, tl_error *error)
{
    if (strcmp(word, "--output") == 0)
        word = "-o";
    const char *names[TL_COUNT(flags_known)];
    size_t count = 0;
    for (size_t i = 0; i < TL_COUNT(flags_known); i++) {
        if (!belongs(&flags_known[i], flags))
            continue;
        if (strcmp(flags_known[i].name, word) == 0)
            return &flags_known[i];
        names[count++] = flags_known[i].name;
    }
    const char *near = tl_nearest_word(word, names, count);
    if (near)
        tl_fail(error, TL_USAGE, "%s: no such option of this command: did you mean %s?", word, near);
    else
        tl_fail(error, TL_USAGE, "%s: no such option of this command: --help lists those that are", word);
    return NULL;
}

/* A whole number from `lowest`, the whole text. */
static bool read_whole(const char *flag, const char *text, const char **end, int lowest, int *out,
                       tl_error *error)
{
    char *stop;
    long value = strtol(text, &stop, 10);
    if (stop == text || value < lowest || value > INT_MAX || (!end && *stop))
        return tl_fail(error, TL_USAGE, "%s: \"%s\": expected a whole number from %d", flag, text, lowest);
    if (end)
        *end = stop;
    *out = (int)value;
    return true;
}

/* Millimetres: from a micrometre to ten metres, the whole text. */
static bool read_length(const char *flag, const char *text, double *out, tl_error *error)
{
    char *stop;
    *out = strtod(text, &stop);
    return (stop != text && !*stop && *out >= 1e-3 && *out <= 1e4) ||
           tl_fail(error, TL_USAGE, "%s: \"%s\": expected millimetres, from 0.001 to 10000", flag, text);
}

static bool read_budget(const char *text, double *out, tl_error *error)
{
    char *stop;
    *out = strtod(text, &stop);
    return (stop != text && !*stop && *out >= 0.1 && *out <= 1e6) ||
           tl_fail(error, TL_USAGE, "--budget: \"%s\": expected milliseconds, from 0.1 to 1000000", text);
}

static void assign(struct tl_arguments *out, char *assignment)
{
    out->assignments = tl_resize(out->assignments, out->assignment_count + 1, sizeof(char *));
    out->assignments[out->assignment_count++] = assignment;
}

static bool read_size(const char *text, struct tl_arguments *out, tl_error *error)
{
    int width = 0, height = 0;
    const char *rest = "";
    if (!read_whole("--size", text, &rest, 1, &width, NULL) || (*rest != 'x' && *rest != 'X') ||
        !read_whole("--size", rest + 1, NULL, 1, &height, NULL))
        return tl_fail(error, TL_USAGE, "--size: \"%s\": expected WIDTHxHEIGHT, as in 960x540", text);
    assign(out, tl_format("image.width=%d", width));
    assign(out, tl_format("image.height=%d", height));
    return true;
}

static bool read_frames(const char *text, struct tl_arguments *out, tl_error *error)
{
    const char *rest = "";
    if (!read_whole("--frames", text, &rest, 0, &out->first_frame, NULL) || *rest != ':' ||
        !read_whole("--frames", rest + 1, NULL, out->first_frame, &out->last_frame, NULL))
        return tl_fail(error, TL_USAGE, "--frames: \"%s\": expected FIRST:LAST, as in 0:59", text);
    out->frames_given = true;
    return true;
}

static bool take_flag(const struct flag *flag, const char *value, struct tl_arguments *out, tl_error *error)
{
    switch (flag->kind) {
    case FLAG_ASSIGN:
        assign(out, tl_format("%s=%s", flag->key, value));
        return true;
    case FLAG_SET:
        assign(out, tl_copy_string(value));
        return true;
    case FLAG_SIZE:
        return read_size(value, out, error);
    case FLAG_OUTPUT:
        out->output = value;
        return true;
    case FLAG_FRAME:
        out->frames_given = false;
        if (!read_whole("--frame", value, NULL, 0, &out->first_frame, error))
            return false;
        out->last_frame = out->first_frame;
        return true;
    case FLAG_FRAMES:
        return read_frames(value, out, error);
    case FLAG_JSON:
        out->json = true;
        return true;
    case FLAG_LDR:
        out->hdr = 0;
        return true;
    case FLAG_HDR:
        out->hdr = 1;
        return true;
    case FLAG_SCREENSHOTS:
        out->screenshots = value;
        return true;
    case FLAG_MAX_FRAMES:
        return read_whole("--max-frames", value, NULL, 1, &out->max_frames, error);
    case FLAG_FRESH:
        out->fresh = true;
        return true;
    case FLAG_BUDGET:
        return read_budget(value, &out->budget_ms, error);
    case FLAG_AXIS:
        out->axis = value;
        return true;
    case FLAG_AOV:
        out->aovs = true;
        return true;
    case FLAG_CAPTURE:
        out->capture = true;
        return true;
    case FLAG_QUICK:
        out->quick = true;
        return true;
    case FLAG_FULL:
        out->full = true;
        return true;
    case FLAG_LAYOUT:
        out->layout = value;
        return true;
    case FLAG_FROM:
        out->from = value;
        return true;
    case FLAG_MAP_SIZE:
        return read_whole("--size", value, NULL, 1, &out->map_size, error);
    case FLAG_REPEAT_MM:
        return read_length("--repeat-mm", value, &out->repeat_mm, error);
    case FLAG_HEIGHT_MM:
        return read_length("--height-mm", value, &out->height_mm, error);
    case FLAG_CLAMP:
        out->clamp = true;
        return true;
    case FLAG_GARMENTS:
        out->sheet.garments = value;
        return true;
    case FLAG_FABRICS:
        out->sheet.fabrics = value;
        return true;
    case FLAG_COLOURWAYS:
        out->sheet.colourways = value;
        return true;
    case FLAG_ENVIRONMENTS:
        out->sheet.environments = value;
        return true;
    case FLAG_VIEWS:
        out->sheet.views = value;
        return true;
    case FLAG_SAME_DRAPE:
        out->same_drape = true;
        return true;
    case FLAG_FRAME_COUNT:
        return read_whole("--frames", value, NULL, 1, &out->frame_count, error);
    case FLAG_EVERY:
        return read_whole("--every", value, NULL, 1, &out->every, error);
    case FLAG_FURNACE:
        out->furnace = true;
        return true;
    case FLAG_STILL:
        out->still = true;
        return true;
    case FLAG_KEEP:
        out->keep = value;
        return true;
    case FLAG_PATH:
        out->path = value;
        return true;
    case FLAG_VIDEO:
        out->video = value;
        return true;
    case FLAG_AGAINST:
        out->against = value;
        return true;
    case FLAG_REPLAY:
        out->replay = value;
        return true;
    case FLAG_ORACLE:
        return read_whole("--oracle", value, NULL, 1, &out->oracle_every, error);
    case FLAG_HASH:
        out->hash = true;
        return true;
    case FLAG_QUIET:
        out->quiet = true;
        return true;
    case FLAG_VERBOSE:
        out->verbose = true;
        return true;
    case FLAG_HELP:
        out->help = true;
        return true;
    }
    return true;
}

bool tl_arguments_parse(int argc, char **argv, unsigned flags, struct tl_arguments *out, tl_error *error)
{
    *out = (struct tl_arguments){.hdr = -1};
    for (int i = 0; i < argc; i++) {
        const char *word = argv[i];
        if (word[0] != '-' || word[1] == '\0') {
            if (out->positional_count == TL_POSITIONALS_MAX)
                return tl_fail(error, TL_USAGE, "%s: too many arguments: at most %d", word,
                               TL_POSITIONALS_MAX);
            out->positionals[out->positional_count++] = word;
            continue;
        }
        /* --flag=value is taken as --flag value. */
        const char *equals = word[1] == '-' ? strchr(word, '=') : NULL;
        char *name = equals ? tl_format("%.*s", (int)(equals - word), word) : tl_copy_string(word);
        const struct flag *flag = find_flag(name, flags, error);
        free(name);
        if (!flag)
            return false;
        const char *value = equals ? equals + 1 : "";
        if (!flag->value && equals)
            return tl_fail(error, TL_USAGE, "%s: takes no value: write it alone", flag->name);
        if (flag->value && !equals) {
            if (i + 1 == argc)
                return tl_fail(error, TL_USAGE, "%s: needs a value: %s %s", flag->name, flag->name,
                               flag->value);
            value = argv[++i];
        }
        if (!take_flag(flag, value, out, error))
            return false;
    }
    return true;
}

void tl_arguments_release(struct tl_arguments *arguments)
{
    for (size_t i = 0; i < arguments->assignment_count; i++)
        free(arguments->assignments[i]);
    free(arguments->assignments);
    *arguments = (struct tl_arguments){0};
}

void tl_arguments_print_flags(unsigned flags)
{
    for (size_t i = 0; i < TL_COUNT(flags_known); i++) {
        if (!belongs(&flags_known[i], flags))
            continue;
        char left[64];
        snprintf(left, sizeof left, "%s %s", flags_known[i].name,
                 flags_known[i].value ? flags_known[i].value : "");
        printf("  %-26s %s\n", left, flags_known[i].help);
    }
}
