#include "app/lab/flight/video.h"

#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct tl_video {
    struct tl_writer writer;
    FILE *waiting; /* frames, raw, without a name */
    double frame_rate;
    int width, height, count;
};

static const struct {
    const char *extension, *format;
} containers[] = {{"mp4", "mp4"}, {"mkv", "matroska"}, {"mov", "mov"}};

static const char *container_of(const char *path)
{
    for (size_t i = 0; i < TL_COUNT(containers); i++)
        if (tl_path_has_extension(path, containers[i].extension))
            return containers[i].format;
    return NULL;
}

bool tl_video_check(const char *path, tl_error *error)
{
    if (!container_of(path))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of video: end the name in .mp4, .mkv or .mov",
                       path);
    char *const arguments[] = {"ffmpeg", "-version", NULL};
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    pid_t process = 0;
    int reason = nothing < 0 ? errno : tl_process_start(arguments, nothing, nothing, nothing, &process);
    if (nothing >= 0)
        close(nothing);
    if (reason == 0 && tl_process_wait(process) == 0)
        return true;
    return tl_fail(error, TL_USAGE,
                   "--video: the command ffmpeg cannot be run: install the package ffmpeg, or leave --video "
                   "out");
}

tl_video *tl_video_begin(const char *path, double frame_rate, tl_error *error)
{
    tl_video *video = TL_NEW(tl_video);
    video->frame_rate = frame_rate;
    if (!tl_writer_begin(&video->writer, path, error)) {
        free(video);
        return NULL;
    }
    tl_writer_close_stream(&video->writer);
    char *name = tl_format("%s.frames", video->writer.temporary);
    video->waiting = fopen(name, "w+be");
    if (video->waiting)
        unlink(name);
    else
        tl_fail(error, TL_OUTPUT, "%s: cannot be written: %s", name, strerror(errno));
    free(name);
    if (!video->waiting)
        tl_video_abandon(&video);
    return video;
}

bool tl_video_add(tl_video *video, const tl_image *image, tl_error *error)
{
    if (video->count == 0) {
        video->width = image->width;
        video->height = image->height;
    }
    size_t size = (size_t)image->width * (size_t)image->height * 3;
    if (image->width != video->width || image->height != video->height)
        return tl_fail(
            error, TL_OUTPUT, "%s: frame %d is %d x %d pixels, the first was %d x %d: a video has one size",
            video->writer.path, video->count, image->width, image->height, video->width, video->height);
    if (fwrite(image->texels, 1, size, video->waiting) != size)
        return tl_fail(error, TL_OUTPUT, "%s: frames could not be stored: %s: free some space",
                       video->writer.path, strerror(errno));
    video->count++;
    return true;
}

/* The last line of ffmpeg's output, without its line end. */
static void last_line(FILE *log, char *out, size_t size)
{
    char line[256];
    rewind(log);
    snprintf(out, size, "no message");
    while (fgets(line, sizeof line, log)) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0])
            snprintf(out, size, "%s", line);
    }
}

/* False when ffmpeg has closed its input. */
static bool feed(tl_video *video, int pipe_end)
{
    static char block[1 << 16];
    struct tl_progress progress = tl_progress_begin("encoding the video");
    double total = (double)video->count * video->width * video->height * 3, done = 0;
    bool heard = true;
    rewind(video->waiting);
    for (size_t size; heard && (size = fread(block, 1, sizeof block, video->waiting)) > 0;) {
        for (size_t sent = 0; heard && sent < size;) {
            ssize_t taken = write(pipe_end, block + sent, size - sent);
            if (taken > 0)
                sent += (size_t)taken;
            else
                heard = taken < 0 && errno == EINTR;
        }
        done += (double)size;
        tl_progress_update(&progress, done, total);
    }
    tl_progress_end(&progress);
    return heard && !ferror(video->waiting);
}

static bool encode(tl_video *video, FILE *log, tl_error *error)
{
    char *size = tl_format("%dx%d", video->width, video->height), *rate = tl_format("%g", video->frame_rate);
    char *target = tl_format("file:%s", video->writer.temporary); /* whatever its name looks like */
    /* H.264 wants even sides. */
    char *const arguments[] = {"ffmpeg",
                               "-hide_banner",
                               "-loglevel",
                               "error",
                               "-y",
                               "-f",
                               "rawvideo",
                               "-pix_fmt",
                               "rgb24",
                               "-s",
                               size,
                               "-r",
                               rate,
                               "-i",
                               "-",
                               "-vf",
                               "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709",
                               "-c:v",
                               "libx264",
                               "-preset",
                               "fast",
                               "-crf",
                               "18",
                               "-pix_fmt",
                               "yuv420p",
                               "-colorspace",
                               "bt709",
                               "-color_primaries",
                               "bt709",
                               "-color_trc",
                               "iec61966-2-1",
                               "-f",
                               (char *)container_of(video->writer.path),
                               target,
                               NULL};
    int ends[2] = {-1, -1};
    pid_t process = 0;
    int reason = pipe2(ends, O_CLOEXEC) != 0
                     ? errno
                     : tl_process_start(arguments, ends[0], fileno(log), fileno(log), &process);
    free(size);
    free(rate);
    free(target);
    if (ends[0] >= 0)
        close(ends[0]);
    if (reason != 0) {
        if (ends[1] >= 0)
            close(ends[1]);
        return tl_fail(error, TL_OUTPUT, "%s: ffmpeg could not be started: %s", video->writer.path,
                       strerror(reason));
    }
    /* If ffmpeg has ended, writing to it must not end this program. */
    struct sigaction ignored = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGPIPE, &ignored, &before);
    bool heard = feed(video, ends[1]);
    close(ends[1]);
    sigaction(SIGPIPE, &before, NULL);
    int status = tl_process_wait(process);
    if (heard && status == 0)
        return true;
    char words[256];
    last_line(log, words, sizeof words);
    return tl_fail(error, TL_OUTPUT, "%s: ffmpeg failed with status %d: %s", video->writer.path, status,
                   words);
}

bool tl_video_commit(tl_video **handle, tl_error *error)
{
    tl_video *video = *handle;
    if (!video || video->count == 0) {
        tl_video_abandon(handle);
        return true;
    }
    FILE *log = tmpfile();
    bool done = log ? encode(video, log, error)
                    : tl_fail(error, TL_OUTPUT, "%s: no temporary file could be made: %s", video->writer.path,
                              strerror(errno));
    if (log)
        fclose(log);
    if (done)
        done = tl_writer_commit(&video->writer, error);
    else
        tl_writer_abandon(&video->writer);
    fclose(video->waiting);
    free(video);
    *handle = NULL;
    return done;
}

void tl_video_abandon(tl_video **handle)
{
    tl_video *video = *handle;
    if (!video)
        return;
    if (video->waiting)
        fclose(video->waiting);
    tl_writer_abandon(&video->writer);
    free(video);
    *handle = NULL;
}
