/* toile export: writes a frame as GLB or OBJ, or the garment's motion as a PC2 or MDD point cache. */
#include "app/batch/commands.h"
#include "app/scene/headless.h"
#include "app/scene/session.h"
#include "assets/model_export.h"
#include "assets/motion/point_cache.h"
#include "config/file.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

static bool is_cache(const char *path)
{
    return tl_path_has_extension(path, "pc2") || tl_path_has_extension(path, "mdd");
}

static bool check_output(const struct tl_arguments *arguments, tl_error *error)
{
    const char *output = arguments->output;
    if (!output ||
        (!tl_path_has_extension(output, "glb") && !tl_path_has_extension(output, "obj") && !is_cache(output)))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of file: add -o FILE.glb, .obj, .pc2 or .mdd",
                       output ? output : "export");
    if (arguments->frames_given && !is_cache(output))
        return tl_fail(error, TL_USAGE, "%s: holds one frame: --frames is for .pc2 and .mdd, use --frame N",
                       output);
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, output, error))
        return false;
    tl_writer_abandon(
        &writer); /* this only checked that the file can be written; the exporter opens its own writer */
    return true;
}

static const tl_surface *find_garment(const tl_frame *frame)
{
    for (size_t i = 0; i < frame->surface_count; i++)
        if (strcmp(frame->surfaces[i].name, "garment") == 0)
            return &frame->surfaces[i];
    return NULL;
}

static bool export_frame(tl_session *session, const struct tl_arguments *arguments, tl_error *error)
{
    if (!tl_session_go_to(session, arguments->first_frame, error))
        return false;
    tl_frame frame = tl_session_frame(session);
    if (tl_path_has_extension(arguments->output, "glb"))
        return tl_model_export_glb(arguments->output, frame.surfaces, frame.surface_count, error);
    return tl_model_export_obj(arguments->output, tl_session_garment(session), find_garment(&frame), error);
}

static bool export_frames(tl_session *session, const struct tl_arguments *arguments,
                          tl_point_cache_writer *writer, tl_error *error)
{
    const tl_model *model = tl_session_garment(session);
    vec3s *points = TL_NEW_ARRAY(vec3s, tl_model_point_count(model));
    int first = arguments->first_frame, last = arguments->last_frame;
    struct tl_progress progress = tl_progress_begin("exporting");
    bool done = true;
    for (int number = first; done && number <= last; number++) {
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "export: stopped at frame %d: no file was written", number);
        else
            done = tl_session_go_to(session, number, error);
        if (!done)
            break;
        tl_frame frame = tl_session_frame(session);
        tl_model_points(model, find_garment(&frame)->positions, points);
        tl_point_cache_add(writer, points);
        tl_progress_update(&progress, number - first + 1, last - first + 1);
    }
    tl_progress_end(&progress);
    free(points);
    return done;
}

static bool export_motion(tl_session *session, const struct tl_arguments *arguments, tl_error *error)
{
    size_t sample_count = (size_t)(arguments->last_frame - arguments->first_frame) + 1;
    tl_point_cache_writer *writer = tl_point_cache_create(
        arguments->output, tl_model_point_count(tl_session_garment(session)), sample_count,
        arguments->first_frame, tl_session_settings(session)->cloth.frame_rate, error);
    if (!writer)
        return false;
    if (export_frames(session, arguments, writer, error))
        return tl_point_cache_commit(&writer, error);
    tl_point_cache_abandon(&writer);
    return false;
}

bool tl_command_export(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_settings settings;
    if (!check_output(arguments, error) || !tl_headless_settings(arguments, &settings, error))
        return false;
    tl_session *session = tl_session_create(&settings, error);
    bool done = session != NULL;
    if (done && !tl_session_garment(session) && !tl_path_has_extension(arguments->output, "glb"))
        done = tl_fail(error, TL_USAGE, "%s: holds a garment, and the scene has none: add --garment FILE",
                       arguments->output);
    if (done)
        done = (is_cache(arguments->output) ? export_motion : export_frame)(session, arguments, error);
    tl_session_destroy(&session);
    return done;
}
