#include "app/cli/arguments.h"

#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "config/cache/cache.h"
#include "config/options.h"

#include <ctype.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum flag_kind {
    FLAG_SWITCH, /* takes no value */
    FLAG_TEXT,
    FLAG_WHOLE, /* from 1 */
    FLAG_MM,
    FLAG_MS,
    FLAG_BYTES,
    FLAG_ASSIGN, /* sets the option named in `key` */
    FLAG_SET,
    FLAG_SIZE,
    FLAG_FRAME,
    FLAG_FRAMES,
    FLAG_SHARD,
    FLAG_LDR,
    FLAG_HDR,
};

struct flag {
    const char *name;
    unsigned set; /* 0: every command */
    enum flag_kind kind;
    size_t offset;     /* of the field in tl_arguments; 0: take_flag sets another one by kind */
    const char *key;   /* FLAG_ASSIGN */
    const char *value; /* name of the value in help; NULL: takes none */
    const char *help;
};

#define AT(field) offsetof(struct tl_arguments, field)

static const struct flag flags_known[] = {
    {"--garment", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.garment", "NAME|FILE",
     "dress, skirt, trousers, shirt, none, a .glb, .gltf, .obj, .ply, .stl or .off file, or a pattern, "
     ".json"},
    {"--units", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.units", "UNITS",
     "of the garment's file: auto, m, dm, cm, mm or in"},
    {"--up", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.up", "AXIS",
     "of the garment's file: auto, y or z"},
    {"--turn", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.turn_deg", "DEGREES",
     "turns the garment's file about the vertical"},
    {"--scale", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.scale", "FACTOR",
     "sizes the garment's file about its origin"},
    {"--move", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.move_m", "X,Y,Z",
     "moves the garment's file, in metres"},
    {"--motion", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.motion", "FILE",
     "moves the garment: a point cache, .pc2, .mdd or frame.####.obj, or a .glb file with a clip"},
    {"--avatar", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.avatar", "NAME|FILE",
     "form, figure, none, or a .glb, .gltf, .obj, .ply, .stl or .off file"},
    {"--env", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.environment", "NAME|FILE",
     "studio, an .exr or .hdr file, a sequence of them: sky.####.exr, or a film: sky.mp4, - for one on stdin"},
    {"--fabric", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.fabric", "NAME|FILE",
     "a fabric: `toile info fabrics` lists them"},
    {"--colourway", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.colourway", "NAME",
     "fabrics and colours of the scene or of a glTF file: `toile info FILE` lists them"},
    {"--preset", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_ASSIGN, 0, "scene.preset", "NAME|FILE",
     "paper, draft or review"},
    {"--method", TL_FLAGS_SCENE, FLAG_ASSIGN, 0, "light.method", "METHOD",
     "pem, lights, ao, ao_colour, unshadowed, reference or maps"},
    {"--size", TL_FLAGS_SCENE, FLAG_SIZE, 0, NULL, "WxH", "size of the image in pixels"},
    {"--set", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE | TL_FLAGS_FABRIC, FLAG_SET, 0, NULL, "TABLE.KEY=VALUE",
     "any option: `toile help options` lists them"},
    {"--no-cache", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_SWITCH, AT(no_cache), NULL, NULL,
     "drape and filter again, and keep no results: `toile cache` lists those that are kept"},
    {"-o", TL_FLAGS_OUTPUT, FLAG_TEXT, AT(output), NULL, "FILE", "file or folder for the result"},
    {"--frame", TL_FLAGS_FRAME | TL_FLAGS_CAPTURE, FLAG_FRAME, 0, NULL, "N",
     "still image of the animation's frame N; 0 is the start, settled or as authored"},
    {"--frames", TL_FLAGS_FRAMES, FLAG_FRAMES, 0, NULL, "A:B",
     "all frames from A to B; of pictures OUT.png becomes OUT.0001.png ..."},
    {"--aov", TL_FLAGS_AOV, FLAG_SWITCH, AT(aovs), NULL, NULL,
     ".exr files get layers: N, P, uv, albedo, visibility, strain, garment"},
    {"--json", TL_FLAGS_JSON, FLAG_SWITCH, AT(json), NULL, NULL, "print one JSON object and nothing else"},
    {"--mask", TL_FLAGS_METRIC, FLAG_TEXT, AT(mask), NULL, "FILE",
     "the garment's pixels: white in this image; else the reference's layer that `render --aov` writes"},
    {"--ldr", TL_FLAGS_METRIC, FLAG_LDR, 0, NULL, NULL, "compare as display images, clamped to [0, 1]"},
    {"--hdr", TL_FLAGS_METRIC, FLAG_HDR, 0, NULL, NULL,
     "compare over all exposures that the reference holds"},
    {"--screenshots", TL_FLAGS_WINDOW, FLAG_TEXT, AT(screenshots), NULL, "FOLDER", "folder for screenshots"},
    {"--max-frames", TL_FLAGS_WINDOW, FLAG_WHOLE, AT(max_frames), NULL, "N", "close after N frames"},
    {"--axis", TL_FLAGS_AXIS, FLAG_TEXT, AT(axis), NULL, "NAME",
     "the settings to vary: overall, light, resolution, detail, shading, levels or cloth"},
    {"--fresh", TL_FLAGS_WINDOW, FLAG_SWITCH, AT(fresh), NULL, NULL,
     "ignore saved window state and do not save it"},
    {"--quick", TL_FLAGS_QUICK, FLAG_SWITCH, AT(quick), NULL, NULL, "a few choices and frames only"},
    {"--full", TL_FLAGS_FULL, FLAG_SWITCH, AT(full), NULL, NULL, "also the measurements that take minutes"},
    {"--layout", TL_FLAGS_LAYOUT, FLAG_TEXT, AT(layout), NULL, "NAME",
     "layout of the result: cube, sphere, paraboloid, latlong or octahedral"},
    {"--from", TL_FLAGS_LAYOUT, FLAG_TEXT, AT(from), NULL, "NAME",
     "layout of the input; else guessed from its shape"},
    {"--size", TL_FLAGS_LAYOUT, FLAG_WHOLE, AT(map_size), NULL, "N",
     "height of the result in texels, or the side of a cube's face"},
    {"--size", TL_FLAGS_BAKE, FLAG_WHOLE, AT(map_size), NULL, "N", "side of the map in texels; else 1024"},
    {"--reach-mm", TL_FLAGS_BAKE, FLAG_MM, AT(reach_mm), NULL, "MM",
     "how far the finer mesh may lie from the coarser one, to either side; else 20"},
    {"--capture", TL_FLAGS_CAPTURE, FLAG_SWITCH, AT(capture), NULL, NULL,
     "capture the environment from the middle of a scene, the scene included, instead of reading a file"},
    {"--repeat-mm", TL_FLAGS_FABRIC, FLAG_MM, AT(repeat_mm), NULL, "MM",
     "width of the height map on the cloth; else 10"},
    {"--height-mm", TL_FLAGS_FABRIC, FLAG_MM, AT(height_mm), NULL, "MM",
     "height that a value of 1 (white) stands for; else 0.5"},
    {"--card", TL_FLAGS_FABRIC, FLAG_TEXT, AT(card), NULL, "FILE",
     "write a fabric card: .png, .pdf (to scale on A4) or .json"},
    {"--lights", TL_FLAGS_FABRIC, FLAG_TEXT, AT(lights), NULL, "FILE.yaml",
     "the lamps of photographs of a flat swatch, one a picture, in their order"},
    {"--clamp", TL_FLAGS_FABRIC, FLAG_SWITCH, AT(clamp), NULL, NULL, "the map does not repeat"},
    {"--garments", TL_FLAGS_SHEET, FLAG_TEXT, AT(sheet.garments), NULL, "A,B",
     "names or files, as --garment takes them"},
    {"--fabrics", TL_FLAGS_SHEET, FLAG_TEXT, AT(sheet.fabrics), NULL, "A,B",
     "names or files, or all; the garment is draped again for each, as the fabric decides how it falls"},
    {"--colourways", TL_FLAGS_SHEET, FLAG_TEXT, AT(sheet.colourways), NULL, "A,B",
     "names, or all that a garment has"},
    {"--envs", TL_FLAGS_SHEET, FLAG_TEXT, AT(sheet.environments), NULL, "A,B",
     "names or files, as --env takes them"},
    {"--views", TL_FLAGS_SHEET, FLAG_TEXT, AT(sheet.views), NULL, "A,B",
     "front, 3/4, side, left, back-3/4, back, right, scene, degrees (30 or 30:10), or a camera path's .yaml"},
    {"--same-drape", TL_FLAGS_SHEET, FLAG_SWITCH, AT(same_drape), NULL, NULL,
     "use the drape of the first fabric for all fabrics of a garment: only their appearance differs"},
    {"--frames", TL_FLAGS_CHECK, FLAG_WHOLE, AT(frame_count), NULL, "N", "how many frames; else 300"},
    {"--every", TL_FLAGS_CHECK, FLAG_WHOLE, AT(every), NULL, "K",
     "run the slow checks (reference, new renderer, sums of light) in every Kth frame only; else 10"},
    {"--furnace", TL_FLAGS_CHECK, FLAG_SWITCH, AT(furnace), NULL, NULL,
     "also check those frames in white light"},
    {"--still", TL_FLAGS_CHECK, FLAG_SWITCH, AT(still), NULL, NULL, "no hand swings the hem"},
    {"--keep", TL_FLAGS_CHECK, FLAG_TEXT, AT(keep), NULL, "FOLDER",
     "save the first frame that breaks an invariant, ready to be opened"},
    {"--baseline", TL_FLAGS_CHECK, FLAG_TEXT, AT(baseline), NULL, "FILE",
     "what `toile check --json` printed of a clean run of this scene: bounds become one and a half times "
     "what it found"},
    {"--budget", TL_FLAGS_BUDGET, FLAG_MS, AT(budget_ms), NULL, "MS",
     "time for a frame, in milliseconds; else every frame is drawn in full"},
    {"--calibrate", TL_FLAGS_PLAN, FLAG_SWITCH, AT(calibrate), NULL, NULL,
     "time both rays and shadow maps for light.visibility auto, also where GL runs on the CPU; needs "
     "--budget"},
    {"--frames", TL_FLAGS_FLY, FLAG_WHOLE, AT(frame_count), NULL, "N",
     "number of frames; else 600, or all of the path's"},
    {"--path", TL_FLAGS_FLY, FLAG_TEXT, AT(path), NULL, "FILE.yaml", "camera path; else one round the scene"},
    {"--video", TL_FLAGS_FLY, FLAG_TEXT, AT(video), NULL, "FILE.mp4",
     "write a video of the flight; .mp4, .mkv or .mov, by ffmpeg"},
    {"--trace", TL_FLAGS_FLY, FLAG_TEXT, AT(trace), NULL, "FILE.json",
     "write a timeline of jobs and busy threads, for ui.perfetto.dev"},
    {"--against", TL_FLAGS_FLY, FLAG_TEXT, AT(against), NULL, "FOLDER",
     "compare with an earlier flight, job by job; without a verdict where the wall and the CPU time of the "
     "frame disagree, as on a machine that was busier in one of them"},
    {"--replay", TL_FLAGS_FLY, FLAG_TEXT, AT(replay), NULL, "FOLDER",
     "fly an earlier flight's path at its levels: the images are the same to the bit"},
    {"--oracle", TL_FLAGS_FLY, FLAG_WHOLE, AT(oracle_every), NULL, "N",
     "measure every Nth frame against the ray-traced one: FLIP of the garment and of its worst 5 %"},
    {"--hash", TL_FLAGS_FLY, FLAG_SWITCH, AT(hash), NULL, NULL,
     "record every image's hash, for a replay to compare"},
    {"--shard", TL_FLAGS_SHARD, FLAG_SHARD, 0, NULL, "I/N",
     "do part I of N, from 0: N runs, on as many machines as there are, make what one makes (docs/farm.md)"},
    {"--interval", TL_FLAGS_MEASURE, FLAG_SWITCH, AT(interval), NULL, NULL,
     "also settle from four other starts (lifted, lowered, twisted either way), and print the smallest "
     "and the largest of each girth, opening and height: the interval that friction leaves"},
    {"--clear", TL_FLAGS_CLEAR, FLAG_SWITCH, AT(clear), NULL, NULL, "remove all of them"},
    {"--strict", TL_FLAGS_STRICT, FLAG_SWITCH, AT(strict), NULL, NULL,
     "exit with 1 if a finding is an error; warnings alone exit with 0"},
    {"--allow-outside", 0, FLAG_SWITCH, AT(allow_outside), NULL, NULL,
     "also read pictures and buffers that a model names outside its own folder"},
    {"--device", TL_FLAGS_SCENE | TL_FLAGS_CAPTURE, FLAG_WHOLE, AT(device), NULL, "N",
     "the graphics device that draws: `toile info devices` lists them; view draws on the screen's"},
    {"--force", TL_FLAGS_OUTPUT, FLAG_SWITCH, AT(force), NULL, NULL, "let -o replace a file that is read"},
    {"--memory", 0, FLAG_BYTES, AT(memory_bytes), NULL, "SIZE",
     "how much memory may be taken, as in 500M or 8G; else nearly all that the machine or the container has"},
    {"--quiet", 0, FLAG_SWITCH, AT(quiet), NULL, NULL, "print errors only"},
    {"--verbose", 0, FLAG_SWITCH, AT(verbose), NULL, NULL, "print more"},
    {"--help", 0, FLAG_SWITCH, AT(help), NULL, NULL, "explain the command and list its options"},
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

static bool read_number(const char *flag, const char *text, const char *unit, double lowest, double highest,
                        double *out, tl_error *error)
{
    char *stop;
    *out = strtod(text, &stop);
    return (stop != text && !*stop && *out >= lowest && *out <= highest) ||
           tl_fail(error, TL_USAGE, "%s: \"%s\": expected %s, from %.10g to %.10g", flag, text, unit, lowest,
                   highest);
}

/* A number of binary units: K, M, G or T. */
static bool read_bytes(const char *flag, const char *text, uint64_t *out, tl_error *error)
{
    static const char units[] = "KMGT";
    char *stop;
    double value = strtod(text, &stop);
    const char *unit = *stop ? strchr(units, toupper((unsigned char)*stop)) : NULL;
    if (stop == text || !unit || stop[1] != '\0' || !(value > 0) || value >= 1e6)
        return tl_fail(error, TL_USAGE, "%s: \"%s\": expected a number and K, M, G or T, as in 500M or 8G",
                       flag, text);
    *out = (uint64_t)(value * (double)((uint64_t)1 << (10 * (unit - units + 1))));
    return true;
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

static bool read_shard(const char *text, struct tl_arguments *out, tl_error *error)
{
    const char *rest = "";
    if (!read_whole("--shard", text, &rest, 0, &out->shard, NULL) || *rest != '/' ||
        !read_whole("--shard", rest + 1, NULL, out->shard + 1, &out->shards, NULL))
        return tl_fail(error, TL_USAGE, "--shard: \"%s\": expected I/N with I from 0 to N - 1, as in 0/7",
                       text);
    return true;
}

static bool take_flag(const struct flag *flag, const char *value, struct tl_arguments *out, tl_error *error)
{
    void *field = (char *)out + flag->offset;
    switch (flag->kind) {
    case FLAG_SWITCH:
        *(bool *)field = true;
        return true;
    case FLAG_TEXT:
        *(const char **)field = value;
        return true;
    case FLAG_WHOLE:
        return read_whole(flag->name, value, NULL, 1, field, error);
    case FLAG_MM:
        return read_number(flag->name, value, "millimetres", 1e-3, 1e4, field, error);
    case FLAG_MS:
        return read_number(flag->name, value, "milliseconds", 0.1, 1e6, field, error);
    case FLAG_BYTES:
        return read_bytes(flag->name, value, field, error);
    case FLAG_ASSIGN:
        assign(out, tl_format("%s=%s", flag->key, value));
        return true;
    case FLAG_SET:
        assign(out, tl_copy_string(value));
        return true;
    case FLAG_SIZE:
        return read_size(value, out, error);
    case FLAG_FRAME:
        out->frames_given = false;
        if (!read_whole(flag->name, value, NULL, 0, &out->first_frame, error))
            return false;
        out->last_frame = out->first_frame;
        return true;
    case FLAG_FRAMES:
        return read_frames(value, out, error);
    case FLAG_SHARD:
        return read_shard(value, out, error);
    case FLAG_LDR:
        out->hdr = 0;
        return true;
    case FLAG_HDR:
        out->hdr = 1;
        return true;
    }
    return true;
}

/* --flag VALUE and --flag=VALUE: moves `at` to the last word that it takes. */
static bool read_flag(int argc, char **argv, int *at, unsigned flags, struct tl_arguments *out,
                      tl_error *error)
{
    const char *word = argv[*at];
    const char *equals = word[1] == '-' ? strchr(word, '=') : NULL;
    char *name = equals ? tl_format("%.*s", (int)(equals - word), word) : tl_copy_string(word);
    const struct flag *flag = find_flag(name, flags, error);
    free(name);
    if (!flag)
        return false;
    if (!flag->value && equals)
        return tl_fail(error, TL_USAGE, "%s: takes no value: write it alone", flag->name);
    if (!flag->value)
        return take_flag(flag, "", out, error);
    if (!equals && *at + 1 == argc)
        return tl_fail(error, TL_USAGE, "%s: needs a value: %s %s", flag->name, flag->name, flag->value);
    return take_flag(flag, equals ? equals + 1 : argv[++*at], out, error);
}

/* The output must not be one of the files that the command names as inputs. */
static bool check_output(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output || arguments->force)
        return true;
    for (size_t i = 0; i < arguments->positional_count + arguments->assignment_count; i++) {
        const char *input = i < arguments->positional_count
                                ? arguments->positionals[i]
                                : strchr(arguments->assignments[i - arguments->positional_count], '=');
        input = input && i >= arguments->positional_count ? input + 1 : input;
        if (input && tl_file_is_same(arguments->output, input))
            return tl_fail(error, TL_USAGE,
                           "-o: %s is read by this command: name another file, or replace it with --force",
                           arguments->output);
    }
    return true;
}

bool tl_arguments_parse(int argc, char **argv, unsigned flags, struct tl_arguments *out, tl_error *error)
{
    *out = (struct tl_arguments){.hdr = -1};
    for (int i = 0; i < argc; i++) {
        bool is_flag = argv[i][0] == '-' && argv[i][1] != '\0';
        if (is_flag && !read_flag(argc, argv, &i, flags, out, error))
            return false;
        if (is_flag)
            continue;
        if (out->positional_count == TL_POSITIONALS_MAX)
            return tl_fail(error, TL_USAGE, "%s: too many arguments: at most %d", argv[i],
                           TL_POSITIONALS_MAX);
        out->positionals[out->positional_count++] = argv[i];
    }
    return check_output(out, error);
}

void tl_arguments_release(struct tl_arguments *arguments)
{
    for (size_t i = 0; i < arguments->assignment_count; i++)
        free(arguments->assignments[i]);
    free(arguments->assignments);
    *arguments = (struct tl_arguments){0};
}

void tl_arguments_apply(const struct tl_arguments *arguments)
{
    if (arguments->quiet)
        tl_log_set_level(TL_LOG_QUIET);
    else if (arguments->verbose)
        tl_log_set_level(TL_LOG_DEBUG);
    tl_memory_allow(arguments->memory_bytes);
    if (arguments->allow_outside)
        tl_path_allow_outside();
    char *folder = arguments->no_cache ? NULL : tl_cache_folder();
    tl_cache_use(folder, TL_CACHE_LIMIT_BYTES);
    free(folder);
}

bool tl_arguments_flag(unsigned flags, size_t index, struct tl_flag_text *out)
{
    for (size_t i = 0; i < TL_COUNT(flags_known); i++) {
        const struct flag *flag = &flags_known[i];
        if (!belongs(flag, flags) || index-- > 0)
            continue;
        *out = (struct tl_flag_text){flag->name, flag->value, flag->key, flag->help};
        return true;
    }
    return false;
}

void tl_arguments_print_flags(unsigned flags)
{
    struct tl_flag_text flag;
    for (size_t i = 0; tl_arguments_flag(flags, i, &flag); i++) {
        char left[64];
        snprintf(left, sizeof left, "%s %s", flag.name, flag.value ? flag.value : "");
        printf("  %-26s %s\n", left, flag.help);
    }
}
