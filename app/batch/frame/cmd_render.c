/* toile render: renders frames to EXR or PNG files, without a window. */
#include "app/batch/commands.h"
#include "app/batch/frame/save_frame.h"
#include "app/scene/headless.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The file of a frame, as a new string: OUT.png, or OUT.0012.png where a range of frames is rendered. */
static char *frame_path(const struct tl_arguments *arguments, int frame)
{
    const char *output = arguments->output;
    if (!arguments->frames_given)
        return tl_copy_string(output);
    const char *dot = strrchr(output, '.');
    return tl_format("%.*s.%04d%s", (int)(dot - output), output, frame, dot);
}

/* Checks the output's kind, and that it can be written, before minutes of work are spent. */
static bool check_output(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "render: no output named: add -o FILE.exr or -o FILE.png");
    if (!tl_path_has_extension(arguments->output, "exr") && !tl_path_has_extension(arguments->output, "png"))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of image: end the name in .exr or .png",
                       arguments->output);
    if (arguments->shards && !arguments->frames_given)
        return tl_fail(error, TL_USAGE, "--shard: shares out the frames of a range: add --frames A:B");
    if (arguments->aovs && !tl_path_has_extension(arguments->output, "exr"))
        return tl_fail(error, TL_USAGE, "%s: --aov needs a file that holds layers: end the name in .exr",
                       arguments->output);
    char *path = frame_path(arguments, arguments->first_frame);
    struct tl_writer writer;
    bool writable = tl_writer_begin(&writer, path, error);
    if (writable)
        tl_writer_abandon(&writer);
    free(path);
    return writable;
}

static bool render_frames(struct tl_headless *headless, const struct tl_arguments *arguments, tl_error *error)
{
    int first = arguments->first_frame + arguments->shard, last = arguments->last_frame;
    int step = arguments->shards ? arguments->shards : 1;
    if (first <= last)
        last -= (last - first) % step; /* the shard's own last frame */
    struct tl_progress progress =
        tl_progress_begin(first == 0 && last == 0 ? "rendering" : "simulating and rendering");
    bool done = true;
    /* Frames before the first are simulated but not drawn: the cloth's state follows from all steps before
     * it. */
    for (int frame = 0; done && first <= last && frame <= last; frame++) {
        if (frame > 0)
            done = tl_session_advance(headless->session, error);
        if (done && frame >= first && (frame - first) % step == 0) {
            char *path = frame_path(arguments, frame);
            tl_renderer_forget(headless->renderer); /* a frame does not depend on those drawn before it */
            done = (arguments->frames_given ? tl_headless_draw(headless, error)
                                            : tl_headless_draw_still(headless, error)) &&
                   tl_save_frame(headless, path, error);
            free(path);
        }
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED,
                           "render: stopped at frame %d: the frames drawn so far are kept", frame);
        tl_progress_update(&progress, frame + 1, last + 1);
    }
    tl_progress_end(&progress);
    return done;
}

bool tl_command_render(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_headless headless;
    if (!check_output(arguments, error) || !tl_headless_create(&headless, arguments, error))
        return false;
    headless.aovs = arguments->aovs;
    tl_session_want_strains(headless.session, arguments->aovs);
    bool done = render_frames(&headless, arguments, error);
    tl_headless_release(&headless);
    return done;
}
