/* toile fly: records a flight around the garment, and reports its results. */
#include "app/budget/back_end.h"
#include "app/cli/json.h"
#include "app/lab/flight/commands.h"
#include "app/lab/flight/fly_account.h"
#include "app/report/folder.h"
#include "app/scene/camera.h"
#include "app/scene/orbit.h"
#include "app/settings/command.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FRAMES_BUILT_IN  600
#define FRAMES_MAX       1000000
#define LIMIT_KEPT_BYTES ((size_t)2 << 30) /* images kept for the reference */

struct flying {
    const struct tl_arguments *arguments;
    struct tl_settings settings; /* as read */
    struct tl_flight_record replay, against;
    struct tl_fly_options options;
    struct tl_flight flight;
};

static bool check_arguments(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "fly: no folder named: add -o FOLDER");
    if (arguments->shards && !arguments->oracle_every)
        return tl_fail(error, TL_USAGE,
                       "--shard: each shard flies all frames, and shares the comparison: add --oracle N");
    if (arguments->shards && arguments->budget_ms > 0)
        return tl_fail(
            error, TL_USAGE,
            "--shard: a budget chooses levels by measured time, in each shard others: fly once, then "
            "--replay that folder");
    if (arguments->replay && (arguments->budget_ms > 0 || arguments->path))
        return tl_fail(error, TL_USAGE, "--replay: takes its levels and its path from %s: leave %s out",
                       arguments->replay, arguments->path ? "--path" : "--budget");
    return true;
}

/* Without a scene the built-in one is flown round in a square image; a scene has its own size. */
static bool read_settings(const struct tl_arguments *arguments, struct tl_settings *out, tl_error *error)
{
    struct tl_arguments sized = *arguments;
    char width[] = "image.width=512", height[] = "image.height=512";
    sized.assignments = TL_NEW_ARRAY(char *, arguments->assignment_count + 2);
    sized.assignment_count = 0;
    if (arguments->positional_count == 0) {
        sized.assignments[sized.assignment_count++] = width;
        sized.assignments[sized.assignment_count++] = height;
    }
    for (size_t i = 0; i < arguments->assignment_count; i++)
        sized.assignments[sized.assignment_count++] = arguments->assignments[i];
    bool read = tl_settings_of_command(&sized, false, out, error);
    free(sized.assignments);
    return read;
}

static bool same_path(const struct tl_path *a, const struct tl_path *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; same && i < a->count; i++)
        same = tl_path_same_key(&a->keys[i], &b->keys[i]);
    return same;
}

/* Checks all that can be checked before the cloth is draped. */
static bool load_records(struct flying *flying, tl_error *error)
{
    const struct tl_arguments *arguments = flying->arguments;
    const struct tl_settings *settings = &flying->settings;
    if (arguments->video && !tl_video_check(arguments->video, error))
        return false;
    if (arguments->path) {
        struct tl_path path = {0};
        bool loaded = tl_path_load(arguments->path, settings, &path, error);
        tl_path_release(&path);
        if (!loaded)
            return false;
    }
    if (arguments->replay &&
        (!tl_headless_may_repeat(settings, "--replay", error) ||
         !tl_flight_record_load(arguments->replay, settings, &flying->replay, error) ||
         !tl_flight_record_suits(&flying->replay, arguments->replay, settings, true, error)))
        return false;
    return !arguments->against ||
           (tl_flight_record_load(arguments->against, settings, &flying->against, error) &&
            tl_flight_record_suits(&flying->against, arguments->against, settings, false, error));
}

/* Gives an automatically framed camera its target and distance, from which a path can continue. */
static void make_camera_explicit(struct tl_headless *headless)
{
    const tl_frame frame = tl_session_frame(headless->session);
    if (!tl_camera_is_placed(&headless->settings.camera))
        tl_orbit_take(&headless->settings.camera, &frame.camera);
}

static bool find_path(const struct flying *flying, const struct tl_settings *settings, struct tl_path *out,
                      tl_error *error)
{
    if (flying->arguments->path)
        return tl_path_load(flying->arguments->path, settings, out, error);
    if (!flying->arguments->replay) {
        *out = tl_path_built_in(settings);
        return true;
    }
    const struct tl_path *recorded = &flying->replay.flight.path;
    *out = (struct tl_path){0};
    for (size_t i = 0; i < recorded->count; i++)
        tl_path_add(out, &recorded->keys[i]);
    return true;
}

static bool count_frames(const struct flying *flying, const struct tl_path *path, int *out, tl_error *error)
{
    const struct tl_arguments *arguments = flying->arguments;
    const struct tl_flight *recorded = &flying->replay.flight;
    double whole = tl_path_length_s(path) * flying->settings.cloth.frame_rate + 1;
    *out = arguments->replay ? recorded->count
           : arguments->path ? (int)(whole < FRAMES_MAX ? whole : FRAMES_MAX)
                             : FRAMES_BUILT_IN;
    if (arguments->replay && arguments->frame_count > recorded->count)
        return tl_fail(error, TL_USAGE, "--frames: %d: %s has only %d", arguments->frame_count,
                       arguments->replay, recorded->count);
    if (arguments->frame_count > FRAMES_MAX)
        return tl_fail(error, TL_USAGE, "--frames: %d: at most %d", arguments->frame_count, FRAMES_MAX);
    if (arguments->frame_count)
        *out = arguments->frame_count;
    return true;
}

static bool check_kept(const struct flying *flying, tl_error *error)
{
    const struct tl_image_params *image = &flying->settings.image;
    int every = flying->options.oracle_every;
    size_t compared = every ? ((size_t)flying->options.frames - 1) / (size_t)every : 0;
    size_t kept = (compared + (size_t)flying->options.shards - 1) / (size_t)flying->options.shards;
    const size_t pixel_bytes = 4 * sizeof(float) + 3; /* linear RGBA, and as shown */
    size_t bytes = kept * (size_t)image->width * (size_t)image->height * pixel_bytes;
    return bytes <= LIMIT_KEPT_BYTES ||
           tl_fail(error, TL_USAGE,
                   "--oracle: %d: %zu images of %d x %d pixels would wait in %zu MB: take fewer", every, kept,
                   image->width, image->height, bytes >> 20);
}

static bool prepare(struct flying *flying, struct tl_headless *headless, struct tl_path *path,
                    tl_error *error)
{
    const struct tl_arguments *arguments = flying->arguments;
    struct tl_fly_options *options = &flying->options;
    make_camera_explicit(headless);
    if (!find_path(flying, &headless->settings, path, error) ||
        !count_frames(flying, path, &options->frames, error))
        return false;
    if (arguments->against && !same_path(path, &flying->against.flight.path))
        return tl_fail(error, TL_USAGE,
                       "%s: was recorded along another path: times of different work cannot be compared",
                       arguments->against);
    options->budget_ms = arguments->replay ? flying->replay.flight.budget_ms : arguments->budget_ms;
    options->hash = arguments->hash || arguments->replay;
    options->oracle_every = arguments->oracle_every;
    options->shard = arguments->shard;
    options->shards = arguments->shards ? arguments->shards : 1;
    options->replay = arguments->replay ? &flying->replay.flight : NULL;
    return check_kept(flying, error);
}

/* -- results -- */

static void compare_images(const struct tl_flight *here, const struct tl_flight *there,
                           struct tl_flight_account *out)
{
    out->first_different = -1;
    for (int i = 0; i < here->count && i < there->count; i++) {
        uint64_t a = here->frames[i].hash, b = there->frames[i].hash;
        if (!a || !b)
            continue;
        out->compared++;
        out->different += a != b;
        if (a != b && out->first_different < 0)
            out->first_different = i;
    }
}

static struct tl_flight_account account_of(const struct flying *flying, const struct tl_headless *headless,
                                           const char *stopped)
{
    const struct tl_arguments *arguments = flying->arguments;
    struct tl_flight_account account = {
        .flight = &flying->flight,
        .figures = tl_flight_measure(&flying->flight),
        .settings = &flying->settings,
        .scene = arguments->positional_count ? arguments->positionals[0] : "built-in",
        .path = arguments->path ? arguments->path : "built-in",
        .gl = tl_gpu_name(headless->gpu),
        .cores = (int)sysconf(_SC_NPROCESSORS_ONLN),
        .stopped = stopped,
        .replay = arguments->replay,
        .against = arguments->against,
        .first_different = -1,
    };
    if (arguments->replay)
        compare_images(&flying->flight, &flying->replay.flight, &account);
    if (arguments->against)
        account.ratio_count = tl_flight_compare(&flying->flight, &flying->against.flight, account.ratios);
    return account;
}

static void write_csv(const void *account, FILE *out)
{
    tl_flight_write_csv(((const struct tl_flight_account *)account)->flight, out);
}

static void write_summary(const void *account, FILE *out)
{
    tl_flight_write_summary(account, out);
}

static bool write_files(const char *folder, const struct tl_flight_account *account, tl_error *error)
{
    char *path = tl_format("%s/path.yaml", folder);
    bool written = tl_path_save(path, &account->flight->path, error) &&
                   tl_folder_print(folder, "frames.csv", account, write_csv, error) &&
                   tl_folder_print(folder, "summary.json", account, write_summary, error) &&
                   tl_flight_write_report(account, folder, error);
    free(path);
    return written;
}

static bool check_replay(const struct tl_flight_account *account, tl_error *error)
{
    if (!account->different)
        return true;
    return tl_fail(
        error, TL_UNSTABLE,
        "%s: frame %d and %d more differ from what was recorded: another driver or version drew them",
        account->replay, account->first_different, account->different - 1);
}

/* Writes and prints what was recorded, even if the flight ended early. */
static bool report(const struct flying *flying, const struct tl_headless *headless, const char *stopped,
                   tl_error *error)
{
    const struct tl_flight_account account = account_of(flying, headless, stopped);
    if (!write_files(flying->arguments->output, &account, error))
        return false;
    if (flying->arguments->json)
        tl_json_print(tl_flight_summary(&account));
    else
        tl_flight_print(&account, stdout);
    return check_replay(&account, error);
}

/* A replay draws with what its settings name, whatever this machine would choose. */
static bool calibrate(struct flying *flying, struct tl_headless *headless, tl_error *error)
{
    const tl_frame first = tl_session_frame(headless->session);
    const struct tl_back_end_start start = {.renderer = headless->renderer,
                                            .frame = &first,
                                            .budget_ms = flying->options.budget_ms,
                                            .is_software = tl_gpu_is_software(headless->gpu)};
    struct tl_back_end chosen;
    bool done = flying->options.replay || tl_back_end_calibrate(&start, &headless->settings, &chosen, error);
    flying->settings.light.visibility = headless->settings.light.visibility;
    return done;
}

static bool fly(struct flying *flying, struct tl_headless *headless, tl_error *error)
{
    struct tl_path path = {0};
    if (!prepare(flying, headless, &path, error) || !calibrate(flying, headless, error)) {
        tl_path_release(&path);
        return false;
    }
    tl_error failure = {0};
    bool done = tl_fly(headless, &flying->options, &path, &flying->flight, error) &&
                tl_timeline_commit(&flying->options.trace, error) &&
                tl_fly_judge(headless, &flying->flight, error);
    if (flying->flight.count == 0)
        return done;
    bool reported = report(flying, headless, done ? NULL : error->message, &failure) &&
                    tl_timeline_commit(&flying->options.trace, &failure) &&
                    tl_video_commit(&flying->options.video, &failure);
    if (done && !reported)
        *error = failure;
    return done && reported;
}

bool tl_command_fly(const struct tl_arguments *arguments, tl_error *error)
{
    struct flying *flying = TL_NEW(struct flying);
    struct tl_headless headless = {0};
    flying->arguments = arguments;
    bool done = check_arguments(arguments, error) && read_settings(arguments, &flying->settings, error) &&
                load_records(flying, error) && tl_folder_make(arguments->output, error);
    if (done && arguments->video) {
        flying->options.video = tl_video_begin(arguments->video, flying->settings.cloth.frame_rate, error);
        done = flying->options.video != NULL;
    }
    if (done && arguments->trace) {
        flying->options.trace = tl_timeline_begin(arguments->trace, error);
        done = flying->options.trace != NULL;
    }
    done = done && tl_headless_open(&headless, &flying->settings, error) && fly(flying, &headless, error);
    tl_timeline_abandon(&flying->options.trace);
    tl_video_abandon(&flying->options.video);
    tl_flight_release(&flying->flight);
    tl_flight_record_release(&flying->replay);
    tl_flight_record_release(&flying->against);
    tl_headless_release(&headless);
    free(flying);
    return done;
}
