#include "app/lab/flight/fly.h"

#include "app/measure/measure.h"
#include "config/base/hash.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WARM_UP_S      1.0
#define PICTURE_PIXELS 256 /* width of a thumbnail, about */

struct recorder {
    struct tl_headless *headless;
    const struct tl_fly_options *options;
    struct tl_flight *flight;
    struct tl_motion motion;
    tl_quality_governor *governor; /* NULL: a replay */
};

/* Adds what began at `began_s` and ends now to the trace, if there is one. */
static void trace_since(const struct recorder *recorder, const char *name, double began_s)
{
    if (recorder->options->trace)
        tl_timeline_add(recorder->options->trace, name, began_s, 1e3 * (tl_clock_s() - began_s));
}

/* The settings of a frame at full quality. */
static void settings_at(const struct tl_headless *headless, const struct tl_flight *flight, int number,
                        struct tl_settings *out)
{
    struct tl_path_key key = tl_path_at(&flight->path, number / flight->frame_rate);
    *out = headless->settings;
    out->camera = key.camera;
    out->scene.environment_yaw_deg = key.environment_yaw_deg;
}

/* The part of them that is drawn, at these levels. */
static struct tl_render_settings drawn_at(const struct tl_quality *levels, const struct tl_settings *settings)
{
    const struct tl_render_settings full = tl_settings_render(settings);
    return tl_quality_at(levels, &full);
}

static bool begin_motion(struct tl_headless *headless, const struct tl_flight *flight,
                         struct tl_motion *motion, tl_error *error)
{
    struct tl_settings settings;
    settings_at(headless, flight, 0, &settings);
    if (!tl_session_apply(headless->session, &settings, error))
        return false;
    tl_motion_begin(motion, headless->session);
    return true;
}

/* Never 0. */
static uint64_t hash_of(const tl_image *image)
{
    size_t size = (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof(float);
    uint64_t hash = tl_hash(TL_HASH_START, image->texels, size);
    return hash ? hash : 1;
}

/* Means of squares of pixels, in linear light. */
static tl_image thumbnail_of(const tl_image *image)
{
    int side = image->width / PICTURE_PIXELS;
    if (side < 1)
        side = 1;
    if (image->height < side)
        side = image->height;
    tl_image small = tl_image_create(image->width / side, image->height / side, 3, TL_IMAGE_U8);
    const uint8_t *from = tl_image_bytes(image);
    for (int y = 0; y < small.height; y++)
        for (int x = 0; x < 3 * small.width; x++) {
            float sum = 0;
            for (int i = 0; i < side * side; i++) {
                int column = x / 3 * side + i % side, row = y * side + i / side;
                sum += tl_srgb_to_linear((float)from[3 * (row * image->width + column) + x % 3] / 255);
            }
            float mean = tl_srgb_from_linear(sum / (float)(side * side));
            tl_image_bytes(&small)[y * 3 * small.width + x] = (uint8_t)lrintf(255 * mean);
        }
    return small;
}

/* The slowest frames' pictures are kept in order as the flight goes on. */
static void keep_worst(struct tl_flight *flight, int number, const tl_image *shown)
{
    double total_ms = flight->frames[number].total_ms;
    int place = flight->worst_count;
    while (place > 0 && flight->frames[flight->worst[place - 1].frame].total_ms < total_ms)
        place--;
    if (place == TL_FLIGHT_WORST)
        return;
    if (flight->worst_count == TL_FLIGHT_WORST)
        tl_image_release(&flight->worst[--flight->worst_count].image);
    memmove(&flight->worst[place + 1], &flight->worst[place],
            (size_t)(flight->worst_count - place) * sizeof *flight->worst);
    flight->worst[place] = (struct tl_flight_picture){number, thumbnail_of(shown)};
    flight->worst_count++;
}

static bool is_stop(const struct tl_flight *flight, int number)
{
    int next = flight->stop_count; /* in the middle of its part of the way */
    return next < TL_FLIGHT_STOPS && number >= (2 * next + 1) * flight->planned / (2 * TL_FLIGHT_STOPS);
}

static bool is_among_worst(const struct tl_flight *flight, int number)
{
    if (number < flight->warm_up)
        return false;
    return flight->worst_count < TL_FLIGHT_WORST ||
           flight->frames[number].total_ms >
               flight->frames[flight->worst[TL_FLIGHT_WORST - 1].frame].total_ms;
}

static bool keep_shown(struct recorder *recorder, int number, tl_error *error)
{
    struct tl_flight *flight = recorder->flight;
    bool stop = is_stop(flight, number), worst = is_among_worst(flight, number);
    if (!stop && !worst && !recorder->options->video)
        return true;
    tl_image shown = {0};
    bool kept = tl_renderer_show_image(recorder->headless->renderer, &shown, error);
    if (kept && stop)
        flight->stops[flight->stop_count++] = (struct tl_flight_picture){number, thumbnail_of(&shown)};
    if (kept && worst)
        keep_worst(flight, number, &shown);
    if (kept && recorder->options->video)
        kept = tl_video_add(recorder->options->video, &shown, error);
    tl_image_release(&shown);
    return kept;
}

/* Hashes the image, and keeps it where it is to be judged. */
static bool keep_images(struct recorder *recorder, int number, tl_error *error)
{
    const struct tl_fly_options *options = recorder->options;
    struct tl_flight *flight = recorder->flight;
    bool judged =
        options->oracle_every > 0 && number > 0 && number % options->oracle_every == 0 &&
        (options->shards <= 1 || (number / options->oracle_every - 1) % options->shards == options->shard);
    tl_image image = {0}, shown = {0};
    if (!options->hash && !judged)
        return true;
    bool read = tl_renderer_read(recorder->headless->renderer, &image, error) &&
                (!judged || tl_renderer_show_image(recorder->headless->renderer, &shown, error));
    if (read && options->hash)
        flight->frames[number].hash = hash_of(&image);
    if (read && judged) {
        flight->kept = tl_resize(flight->kept, (size_t)flight->kept_count + 1, sizeof *flight->kept);
        flight->kept[flight->kept_count++] = (struct tl_flight_kept){number, image, shown};
    } else {
        tl_image_release(&image);
    }
    return read;
}

static void record_jobs(struct tl_flight *flight, const tl_plan *plan, struct tl_flight_frame *frame)
{
    flight->job_count = plan->count;
    for (int i = 0; i < plan->count; i++) {
        snprintf(flight->job_names[i], sizeof flight->job_names[i], "%s", plan->rows[i].name);
        frame->job_ms[i] = plan->rows[i].took_ms;
    }
}

/* The camera goes first, so that the choice is made for where it will be. */
static bool choose(struct recorder *recorder, const struct tl_settings *wanted, int number,
                   struct tl_quality_choice *out, tl_error *error)
{
    struct tl_headless *headless = recorder->headless;
    if (!tl_session_apply(headless->session, wanted, error))
        return false;
    const tl_frame coming = tl_session_frame(headless->session);
    if (recorder->options->replay) {
        const struct tl_flight_frame *recorded = &recorder->options->replay->frames[number];
        *out = (struct tl_quality_choice){
            .levels = recorded->levels, .predicted_ms = NAN, .error = recorded->error};
    } else {
        *out = tl_quality_governor_choose(recorder->governor, headless->renderer, &coming, wanted);
    }
    return true;
}

/* Draws a frame; the measured time includes the choice of levels, the cloth and the image. */
static bool draw_timed(struct recorder *recorder, int number, struct tl_flight_frame *frame, tl_error *error)
{
    struct tl_headless *headless = recorder->headless;
    struct tl_quality_choice choice;
    struct tl_settings wanted;
    settings_at(headless, recorder->flight, number, &wanted);
    const double began_s = tl_clock_s();
    struct tl_stopwatch watch = tl_stopwatch_start();
    if (!choose(recorder, &wanted, number, &choice, error))
        return false;
    const double cloth_began_s = tl_clock_s();
    struct tl_stopwatch cloth_watch = tl_stopwatch_start();
    if (number > 0 && !tl_motion_advance(&recorder->motion, number, error))
        return false;
    frame->cloth_ms = tl_stopwatch_read(&cloth_watch).wall_ms;
    trace_since(recorder, "cloth", cloth_began_s);
    const tl_frame shown = tl_session_frame(headless->session);
    const struct tl_render_settings render = drawn_at(&choice.levels, &wanted);
    if (!tl_renderer_draw(headless->renderer, &shown, &render, error))
        return false;
    const struct tl_taken taken = tl_stopwatch_read(&watch); /* every job ends with a glFinish */
    trace_since(recorder, "frame", began_s);
    frame->total_ms = taken.wall_ms;
    frame->cpu_ms = taken.cpu_ms;
    if (getloadavg(&frame->load, 1) != 1)
        frame->load = NAN;
    frame->levels = choice.levels;
    frame->predicted_ms = choice.predicted_ms;
    frame->error = choice.error;
    return true;
}

/* Prepares the regions of all levels, as the window does while it loads: no frame of the motion has to. */
static void prepare_levels(struct recorder *recorder)
{
    struct tl_settings wanted;
    settings_at(recorder->headless, recorder->flight, 0, &wanted);
    const tl_frame shown = tl_session_frame(recorder->headless->session);
    while (tl_quality_governor_prepare(recorder->governor, recorder->headless->renderer, &shown, &wanted)) {
    }
}

static bool record_frame(struct recorder *recorder, int number, tl_error *error)
{
    struct tl_flight *flight = recorder->flight;
    struct tl_flight_frame frame = TL_FLIGHT_FRAME_EMPTY;
    if (!draw_timed(recorder, number, &frame, error))
        return false;
    const tl_plan *plan = tl_renderer_last_plan(recorder->headless->renderer);
    if (recorder->governor)
        tl_quality_governor_learn(recorder->governor, plan, frame.cloth_ms, frame.total_ms);
    if (recorder->governor && number == 0)
        prepare_levels(recorder);
    record_jobs(flight, plan, &frame);
    if (recorder->options->trace)
        tl_timeline_add_plan(recorder->options->trace, plan);
    frame.memory_bytes = tl_renderer_memory(recorder->headless->renderer).total;
    flight->frames[number] = frame;
    flight->count = number + 1;
    return keep_images(recorder, number, error) && keep_shown(recorder, number, error);
}

static int warm_up_frames(int planned, double frame_rate)
{
    int second = (int)lrint(WARM_UP_S * frame_rate);
    return second < planned / 2 ? second : planned / 2;
}

bool tl_fly(struct tl_headless *headless, const struct tl_fly_options *options, struct tl_path *path,
            struct tl_flight *out, tl_error *error)
{
    double frame_rate = headless->settings.cloth.frame_rate;
    *out = (struct tl_flight){.budget_ms = options->budget_ms,
                              .frame_rate = frame_rate,
                              .planned = options->frames,
                              .warm_up = warm_up_frames(options->frames, frame_rate),
                              .frames = TL_NEW_ARRAY(struct tl_flight_frame, (size_t)options->frames),
                              .path = *path};
    *path = (struct tl_path){0};
    struct recorder recorder = {.headless = headless, .options = options, .flight = out};
    if (!options->replay)
        recorder.governor = tl_quality_governor_create(options->budget_ms);
    struct tl_progress progress = tl_progress_begin("flying");
    bool done = begin_motion(headless, out, &recorder.motion, error);
    for (int number = 0; done && number < options->frames; number++) {
        done = record_frame(&recorder, number, error);
        if (tl_interrupted())
            done =
                tl_fail(error, TL_INTERRUPTED, "fly: stopped at frame %d: frames before it are kept", number);
        tl_progress_update(&progress, number + 1, options->frames);
    }
    tl_progress_end(&progress);
    tl_quality_governor_destroy(&recorder.governor);
    return done;
}

static void release_pictures(struct tl_flight_picture *pictures, int count)
{
    for (int i = 0; i < count; i++)
        tl_image_release(&pictures[i].image);
}

void tl_flight_release(struct tl_flight *flight)
{
    release_pictures(flight->worst, flight->worst_count);
    release_pictures(flight->stops, flight->stop_count);
    for (int i = 0; i < flight->kept_count; i++) {
        tl_image_release(&flight->kept[i].image);
        tl_image_release(&flight->kept[i].shown);
    }
    free(flight->kept);
    free(flight->frames);
    tl_path_release(&flight->path);
    *flight = (struct tl_flight){0};
}

static bool judge(struct tl_variant_run *reference, tl_session *session, const struct tl_flight_kept *kept,
                  struct tl_flight_frame *frame, tl_error *error)
{
    struct tl_reference_frame frame_reference = {0};
    struct tl_measured_error measured;
    tl_frame shown = tl_session_frame(session);
    shown.aovs = true;
    bool judged = tl_reference_frame_draw(reference, &shown, &frame_reference, error) &&
                  tl_reference_frame_compare(&kept->image, &kept->shown, &frame_reference, &measured, error);
    if (judged) {
        frame->garment_flip = measured.garment.flip_mean;
        frame->garment_flip_worst = measured.garment.flip_worst;
        frame->flip_mean = measured.flip_mean;
        frame->rel_rmse = measured.rel_rmse;
    }
    tl_reference_frame_release(&frame_reference);
    return judged;
}

bool tl_fly_judge(struct tl_headless *headless, struct tl_flight *flight, tl_error *error)
{
    struct tl_motion motion;
    struct tl_variant_run reference = {0};
    bool done =
        tl_session_restart(headless->session, &headless->settings, error) &&
        begin_motion(headless, flight, &motion, error) &&
        tl_variant_run_create(&reference, headless->gpu, &tl_setup_reference, &headless->settings, error);
    struct tl_progress progress = tl_progress_begin("ray tracing what was flown");
    int judged = 0;
    for (int number = 0; done && judged < flight->kept_count; number++) {
        struct tl_flight_frame *frame = &flight->frames[number];
        struct tl_settings wanted;
        settings_at(headless, flight, number, &wanted);
        done = tl_session_apply(headless->session, &wanted, error) &&
               (number == 0 || tl_motion_advance(&motion, number, error));
        if (done && flight->kept[judged].frame == number)
            done = judge(&reference, headless->session, &flight->kept[judged++], frame, error);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "fly: stopped while frame %d was ray traced", number);
        tl_progress_update(&progress, judged, flight->kept_count);
    }
    tl_progress_end(&progress);
    tl_variant_run_release(&reference);
    return done;
}
