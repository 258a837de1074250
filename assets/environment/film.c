#include "assets/environment/film.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/base/process.h"
#include "config/colour/srgb.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct tl_film {
    char *path;
    int width, height, count;
    pid_t process; /* 0: none runs */
    FILE *frames;  /* what it writes */
    FILE *log;     /* its errors */
    int next;      /* frame that it writes next */
    float linear[256];
};

bool tl_film_is(const char *path)
{
    static const char *const extensions[] = {"mp4", "mkv", "mov", "webm", "avi", "m4v", "mpg"};
    for (size_t i = 0; i < TL_COUNT(extensions); i++)
        if (tl_path_has_extension(path, extensions[i]))
            return true;
    return false;
}

/* Ends the process, which may not have written all. */
static int stop(tl_film *film)
{
    int status = 0;
    if (film->frames)
        fclose(film->frames);
    if (film->process) {
        kill(film->process, SIGTERM);
        status = tl_process_wait(film->process);
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
    char *source = tl_format("file:%s", film->path); /* whatever its name looks like */
    const char *arguments[24] = {"ffmpeg",  "-nostdin", "-hide_banner", "-loglevel", "error",
                                 "-xerror", "-i",       source,         "-map",      "0:v:0"};
    memcpy(arguments + 10, how, how_count * sizeof *how);
    int ends[2] = {-1, -1}, nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
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

/* Reads sizes and the number of packets, each of which is a frame, from ffmpeg's list of them. */
static bool count_frames(tl_film *film, tl_error *error)
{
    static const char *const how[] = {"-c", "copy", "-f", "framecrc", "-"};
    char line[512];
    if (!start(film, how, TL_COUNT(how), error))
        return false;
    while (fgets(line, sizeof line, film->frames)) {
        sscanf(line, "#dimensions 0: %dx%d", &film->width, &film->height);
        film->count += line[0] != '#';
    }
    int status = tl_process_wait(film->process);
    film->process = 0;
    if (status != 0 || film->count == 0 || film->width <= 0)
        return fail_by_log(film, "is no film that can be read", error);
    stop(film);
    return tl_image_size_check(film->path, film->width, film->height, error);
}

tl_film *tl_film_open(const char *path, tl_error *error)
{
    if (!tl_file_check(path, error))
        return NULL;
    tl_film *film = TL_NEW(tl_film);
    film->path = tl_copy_string(path);
    for (int byte = 0; byte < 256; byte++)
        film->linear[byte] = tl_srgb_to_linear((float)byte / 255);
    if (!count_frames(film, error))
        tl_film_close(&film);
    return film;
}

void tl_film_close(tl_film **handle)
{
    tl_film *film = *handle;
    if (!film)
        return;
    stop(film);
    free(film->path);
    free(film);
    *handle = NULL;
}

int tl_film_frame_count(const tl_film *film)
{
    return film->count;
}

/* The bytes of the frame at `index`; everything before it is read, too. */
static bool read_bytes(tl_film *film, int index, uint8_t *bytes, size_t size, tl_error *error)
{
    static const char *const how[] = {"-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"};
    if (film->process && film->next > index)
        stop(film);
    if (!film->process && !start(film, how, TL_COUNT(how), error))
        return false;
    for (; film->next <= index; film->next++)
        if (fread(bytes, 1, size, film->frames) != size) {
            char *what = tl_format("frame %d of %d cannot be read", film->next, film->count);
            fail_by_log(film, what, error);
            free(what);
            return false;
        }
    return true;
}

bool tl_film_read(tl_film *film, int index, tl_image *out, tl_error *error)
{
    size_t size = 3 * (size_t)film->width * (size_t)film->height;
    *out = (tl_image){0};
    if (!tl_memory_request(film->path, size * (1 + sizeof(float)), error))
        return false;
    uint8_t *bytes = TL_NEW_ARRAY(uint8_t, size);
    bool read = read_bytes(film, index, bytes, size, error);
    if (read) {
        *out = tl_image_create(film->width, film->height, 3, TL_IMAGE_F32);
        for (size_t i = 0; i < size; i++)
            tl_image_floats(out)[i] = film->linear[bytes[i]];
    }
    free(bytes);
    return read;
}
