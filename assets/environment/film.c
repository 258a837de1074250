#include "assets/environment/film.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/base/process.h"
#include "config/colour/srgb.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct tl_film {
    char *path;
    int width, height, count;
    double *times, length; /* s from the first frame: when each is due, and when the film ends */
    pid_t process;         /* 0: none runs */
    FILE *frames;          /* what it writes */
    FILE *log;             /* its errors */
    int next;              /* frame that it writes next */
    float linear[256];
    /* Live: a thread reads what comes and keeps the newest frame. */
    bool is_live, has_ended;
    tl_error refusal; /* of its size */
    int newest;       /* number of the frame in `bytes`; -1: none yet */
    uint8_t *bytes;
    pthread_t reader;
    pthread_mutex_t guard; /* of `newest`, `bytes` and `has_ended` */
    pthread_cond_t first;  /* a first frame has come, or none will */
};

bool tl_film_is_live(const char *path)
{
    return strcmp(path, "-") == 0;
}

bool tl_film_is(const char *path)
{
    static const char *const extensions[] = {"mp4", "mkv", "mov", "webm", "avi", "m4v", "mpg"};
    for (size_t i = 0; i < TL_COUNT(extensions); i++)
        if (tl_path_has_extension(path, extensions[i]))
            return true;
    return tl_film_is_live(path);
}

/* Ends the process, which may not have written all. */
static int stop(tl_film *film)
{
    int status = 0;
    if (film->frames && !film->is_live)
        fclose(film->frames);
    if (film->process) {
        kill(film->process, film->is_live ? SIGKILL : SIGTERM);
        status = tl_process_wait(film->process);
    }
    if (film->frames && film->is_live) { /* what the reader waits for has ended */
        pthread_join(film->reader, NULL);
        fclose(film->frames);
    }
    if (film->log)
        fclose(film->log);
    film->process = 0;
    film->frames = film->log = NULL;
    return status;
}

/* Runs ffmpeg, whose output `film->frames` then reads: `how` follows the choice of the stream. */
static bool start(tl_film *film, const char *const how[], size_t how_count, tl_error *error)
{
    char *source = film->is_live ? tl_copy_string("pipe:0")
                                 : tl_format("file:%s", film->path); /* whatever its name looks like */
    const char *arguments[24] = {"ffmpeg",  "-nostdin", "-hide_banner", "-loglevel", "error",
                                 "-xerror", "-i",       source,         "-map",      "0:v:0"};
    memcpy(arguments + 10, how, how_count * sizeof *how);
    int ends[2] = {-1, -1},
        nothing = film->is_live ? dup(STDIN_FILENO) : open("/dev/null", O_RDONLY | O_CLOEXEC);
    film->log = tmpfile();
    int reason = nothing < 0 || !film->log || pipe2(ends, O_CLOEXEC) != 0 ? errno : 0;
    if (reason == 0)
        reason =
            tl_process_start((char *const *)arguments, nothing, ends[1], fileno(film->log), &film->process);
    if (nothing >= 0)
        close(nothing);
    if (ends[1] >= 0)
        close(ends[1]);
    free(source);
    if (reason == 0) {
        film->frames = fdopen(ends[0], "rb");
        film->next = 0;
        return true;
    }
    if (ends[0] >= 0)
        close(ends[0]);
    film->process = 0;
    stop(film);
    return tl_fail(error, TL_INPUT,
                   "%s: a film needs the command ffmpeg, which cannot be run (%s): install the "
                   "package ffmpeg",
                   film->path, strerror(reason));
}

/* Fails with the first line of ffmpeg's log. */
static bool fail_by_log(tl_film *film, const char *what, tl_error *error)
{
    char line[256] = "";
    rewind(film->log);
    if (!fgets(line, sizeof line, film->log))
        snprintf(line, sizeof line, "it ends there");
    line[strcspn(line, "\r\n")] = '\0';
    stop(film);
    return tl_fail(error, TL_INPUT, "%s: %s: ffmpeg: %s: write it again", film->path, what, line);
}

static int compare_times(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

/* Packets come in the order in which they are decoded, with times from anywhere. A last frame without a
 * duration is shown for as long as the others are on average. */
static void order_times(tl_film *film, double last_duration)
{
    qsort(film->times, (size_t)film->count, sizeof *film->times, compare_times);
    double first = film->times[0], last = film->times[film->count - 1] - first;
    for (int i = 0; i < film->count; i++)
        film->times[i] -= first;
    double mean = film->count > 1 && last > 0 ? last / (film->count - 1) : 1;
    film->length = last + (last_duration > 0 ? last_duration : mean);
}

/* Reads sizes and the times of packets, each of which is a frame, from ffmpeg's list of them. */
static bool count_frames(tl_film *film, tl_error *error)
{
    static const char *const how[] = {"-c", "copy", "-f", "framecrc", "-"};
    char line[512];
    double unit = 0, latest = -INFINITY, duration = 0;
    long long time, ticks;
    int parts[2];
    if (!start(film, how, TL_COUNT(how), error))
        return false;
    while (fgets(line, sizeof line, film->frames)) {
        sscanf(line, "#dimensions 0: %dx%d", &film->width, &film->height);
        if (sscanf(line, "#tb 0: %d/%d", &parts[0], &parts[1]) == 2 && parts[1] > 0)
            unit = (double)parts[0] / parts[1];
        if (sscanf(line, "%*d, %*d, %lld, %lld,", &time, &ticks) != 2)
            continue;
        if ((film->count & (film->count - 1)) == 0)
            film->times = tl_resize(film->times, 2 * (size_t)film->count + 1, sizeof *film->times);
        film->times[film->count++] = unit * (double)time;
        duration = unit * (double)time > latest ? unit * (double)ticks : duration;
        latest = fmax(latest, unit * (double)time);
    }
    int status = tl_process_wait(film->process);
    film->process = 0;
    if (status != 0 || film->count == 0 || film->width <= 0)
        return fail_by_log(film, "is no film that can be read", error);
    stop(film);
    order_times(film, duration);
    return tl_image_size_check(film->path, film->width, film->height, error);
}

/* Reads the size that stands before each frame. */
static bool read_header(FILE *frames, int *width, int *height)
{
    return fscanf(frames, "P6 %d %d 255", width, height) == 2 && fgetc(frames) == '\n';
}

static size_t frame_size(const tl_film *film)
{
    return 3 * (size_t)film->width * (size_t)film->height;
}

static void end_live(tl_film *film)
{
    pthread_mutex_lock(&film->guard);
    film->has_ended = true;
    pthread_cond_signal(&film->first);
    pthread_mutex_unlock(&film->guard);
}

/* The reader. Its first frame sets the size of all. */
static void *read_live(void *of)
{
    tl_film *film = of;
    uint8_t *coming = NULL;
    int width, height;
    while (read_header(film->frames, &width, &height)) {
        if (!film->bytes) {
            if (!tl_image_size_check(film->path, width, height, &film->refusal))
                break;
            film->width = width;
            film->height = height;
            film->bytes = TL_NEW_ARRAY(uint8_t, frame_size(film));
            coming = TL_NEW_ARRAY(uint8_t, frame_size(film));
        }
        if (width != film->width || height != film->height ||
            fread(coming, 1, frame_size(film), film->frames) != frame_size(film))
            break;
        pthread_mutex_lock(&film->guard);
        uint8_t *shown = film->bytes;
        film->bytes = coming;
        coming = shown;
        film->newest++;
        pthread_cond_signal(&film->first);
        pthread_mutex_unlock(&film->guard);
    }
    free(coming);
    end_live(film);
    return NULL;
}

static const char *const frames_of[] = {"-vsync", "passthrough", "-f",    "image2pipe", "-c:v",
                                        "ppm",    "-pix_fmt",    "rgb24", "-"};

/* Waits for the first frame. */
static bool start_live(tl_film *film, tl_error *error)
{
    static atomic_flag is_taken = ATOMIC_FLAG_INIT;
    film->count = 1;
    if (isatty(STDIN_FILENO))
        return tl_fail(error, TL_INPUT,
                       "-: stdin is a terminal: pipe a film into the command, ffmpeg ... -f matroska - | "
                       "toile fly --env -");
    if (atomic_flag_test_and_set(&is_taken))
        return tl_fail(error, TL_INPUT,
                       "-: the film on stdin can be opened once, and this command opens its light again: "
                       "save it to a file");
    if (!start(film, frames_of, TL_COUNT(frames_of), error))
        return false;
    int reason = pthread_create(&film->reader, NULL, read_live, film);
    if (reason != 0) {
        fclose(film->frames);
        film->frames = NULL;
        return tl_fail(error, TL_INPUT, "-: no thread can be started (%s): end other programs",
                       strerror(reason));
    }
    pthread_mutex_lock(&film->guard);
    while (film->newest < 0 && !film->has_ended)
        pthread_cond_wait(&film->first, &film->guard);
    bool has_frame = film->newest >= 0;
    pthread_mutex_unlock(&film->guard);
    if (!has_frame && film->refusal.code != TL_OK) {
        *error = film->refusal;
        return false;
    }
    if (!has_frame) {
        tl_process_wait(film->process); /* its log is then whole */
        film->process = 0;
    }
    return has_frame || fail_by_log(film, "stdin is no film that can be read", error);
}

tl_film *tl_film_open(const char *path, tl_error *error)
{
    const bool is_live = tl_film_is_live(path);
    if (!is_live && !tl_file_check(path, error))
        return NULL;
    tl_film *film = TL_NEW(tl_film);
    film->is_live = is_live;
    film->newest = -1;
    pthread_mutex_init(&film->guard, NULL);
    pthread_cond_init(&film->first, NULL);
    film->path = tl_copy_string(path);
    for (int byte = 0; byte < 256; byte++)
        film->linear[byte] = tl_srgb_to_linear((float)byte / 255);
    if (is_live ? !start_live(film, error) : !count_frames(film, error))
        tl_film_close(&film);
    return film;
}

void tl_film_close(tl_film **handle)
{
    tl_film *film = *handle;
    if (!film)
        return;
    stop(film);
    pthread_mutex_destroy(&film->guard);
    pthread_cond_destroy(&film->first);
    free(film->times);
    free(film->bytes);
    free(film->path);
    free(film);
    *handle = NULL;
}

int tl_film_frame_count(const tl_film *film)
{
    return film->count;
}

int tl_film_frame_at(tl_film *film, double seconds)
{
    if (film->is_live) {
        pthread_mutex_lock(&film->guard);
        int newest = film->newest;
        pthread_mutex_unlock(&film->guard);
        return newest;
    }
    const double rounding = 1e-6; /* of quotients that should be a frame's time */
    double time = fmod(seconds + rounding, film->length);
    int first = 0, end = film->count;
    while (end - first > 1) {
        int middle = first + (end - first) / 2;
        *(film->times[middle] <= time ? &first : &end) = middle;
    }
    return first;
}

/* The bytes of the frame at `index`; everything before it is read, too. */
static bool read_bytes(tl_film *film, int index, uint8_t *bytes, size_t size, tl_error *error)
{
    int width, height;
    if (film->process && film->next > index)
        stop(film);
    if (!film->process && !start(film, frames_of, TL_COUNT(frames_of), error))
        return false;
    for (; film->next <= index; film->next++)
        if (!read_header(film->frames, &width, &height) || width != film->width || height != film->height ||
            fread(bytes, 1, size, film->frames) != size) {
            char *what = tl_format("frame %d of %d cannot be read", film->next, film->count);
            fail_by_log(film, what, error);
            free(what);
            return false;
        }
    return true;
}

bool tl_film_read(tl_film *film, int index, tl_image *out, tl_error *error)
{
    size_t size = frame_size(film);
    *out = (tl_image){0};
    if (!tl_memory_request(film->path, size * (1 + sizeof(float)), error))
        return false;
    uint8_t *bytes = TL_NEW_ARRAY(uint8_t, size);
    bool read = film->is_live || read_bytes(film, index, bytes, size, error);
    if (film->is_live) {
        pthread_mutex_lock(&film->guard);
        memcpy(bytes, film->bytes, size);
        pthread_mutex_unlock(&film->guard);
    }
    if (read) {
        *out = tl_image_create(film->width, film->height, 3, TL_IMAGE_F32);
        for (size_t i = 0; i < size; i++)
            tl_image_floats(out)[i] = film->linear[bytes[i]];
    }
    free(bytes);
    return read;
}
