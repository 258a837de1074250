/* toile render: renders frames to EXR or PNG files, without a window. */
#include "app/batch/commands.h"
#include "app/report/legend.h"
#include "app/scene/headless.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/file.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/inspect/aovs.h"
#include "render/inspect/inspect.h"

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

static void draw_legend(const struct tl_headless *headless, tl_image *image)
{
    struct tl_legend legend;
    tl_renderer_legend(headless->renderer, &legend);
    if (!tl_legend_draw(&legend, image))
        tl_info("%s: the picture is too small for its legend", legend.title);
}

/* Saves the image, and as further layers the AOVs that were asked for. */
static bool save_layers(const struct tl_headless *headless, const char *path, const tl_image *image,
                        tl_error *error)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    struct tl_exr_layer written[1 + TL_AOVS_MAX] = {{.channel_names = names, .image = image}};
    struct tl_aovs aovs = {0};
    if (headless->aovs && !tl_renderer_read_aovs(headless->renderer, &aovs, error))
        return false;
    for (int i = 0; i < aovs.count; i++)
        written[1 + i] =
            (struct tl_exr_layer){.channel_names = aovs.items[i].channels, .image = &aovs.items[i].image};
    bool saved = tl_exr_save(path, written, 1 + (size_t)aovs.count, error);
    tl_aovs_release(&aovs);
    return saved;
}

static bool save_frame(struct tl_headless *headless, const char *path, tl_error *error)
{
    tl_image image = {0};
    bool saved;
    if (tl_path_has_extension(path, "exr")) {
        saved =
            tl_renderer_read(headless->renderer, &image, error) && save_layers(headless, path, &image, error);
    } else {
        saved = tl_renderer_show_image(headless->renderer, &image, error);
        if (saved && headless->settings.image.legend)
            draw_legend(headless, &image);
        saved = saved && tl_image_save_png(path, &image, error);
    }
    tl_image_release(&image);
    return saved;
}

static bool render_frames(struct tl_headless *headless, const struct tl_arguments *arguments, tl_error *error)
{
    int first = arguments->first_frame, last = arguments->last_frame;
    struct tl_progress progress =
        tl_progress_begin(first == 0 && last == 0 ? "rendering" : "simulating and rendering");
    bool done = true;
    /* Frames before the first are simulated but not drawn: the cloth's state follows from all steps before
     * it. */
    for (int frame = 0; done && frame <= last; frame++) {
        if (frame > 0)
            done = tl_session_advance(headless->session, error);
        if (done && frame >= first) {
            char *path = frame_path(arguments, frame);
            done = (arguments->frames_given ? tl_headless_draw(headless, error)
                                            : tl_headless_draw_still(headless, error)) &&
                   save_frame(headless, path, error);
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
