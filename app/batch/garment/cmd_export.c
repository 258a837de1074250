/* toile export: writes a frame as GLB or OBJ, or the garment's motion as a PC2 or MDD point cache. */
#include "app/batch/commands.h"
#include "app/scene/session.h"
#include "app/scene/whole_body.h"
#include "app/settings/command.h"
#include "assets/model_export.h"
#include "assets/motion/point_cache.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

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

/* The garment's positions where its file has it, without a lift onto the ground. The caller frees them. */
static vec3s *positions_in_file(const tl_session *session, const tl_surface *garment)
{
    vec3s *positions = TL_NEW_ARRAY(vec3s, garment->vertex_count);
    for (size_t i = 0; i < garment->vertex_count; i++) {
        positions[i] = garment->positions[i];
        positions[i].y -= tl_session_lifted_m(session);
    }
    return positions;
}

static bool export_frame(tl_session *session, const struct tl_arguments *arguments, tl_error *error)
{
    if (!tl_session_go_to(session, arguments->first_frame, error))
        return false;
    tl_frame frame = tl_session_frame(session);
    tl_surface surfaces[TL_SESSION_SURFACES];
    vec3s *positions = NULL;
    memcpy(surfaces, frame.surfaces, frame.surface_count * sizeof *surfaces);
    frame.surfaces = surfaces;
    tl_surface *garment = (tl_surface *)find_garment(&frame);
    if (garment)
        garment->positions = positions = positions_in_file(session, garment);
    bool is_glb = tl_path_has_extension(arguments->output, "glb");
    struct tl_whole_body body;
    if (!tl_whole_body_load(session, &body, is_glb ? surfaces : NULL, error)) {
        free(positions);
        return false;
    }
    bool written = is_glb
                       ? tl_model_export_glb(arguments->output, surfaces, frame.surface_count, error)
                       : tl_model_export_obj(arguments->output, tl_session_garment(session), garment, error);
    tl_whole_body_release(&body);
    free(positions);
    return written;
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
        vec3s *positions = positions_in_file(session, find_garment(&frame));
        tl_model_points(model, positions, points);
        free(positions);
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
    if (!check_output(arguments, error))
        return false;
    bool is_glb = tl_path_has_extension(arguments->output, "glb"); /* which also holds a body alone */
    if (!tl_settings_of_command(arguments, !is_glb, &settings, error))
        return false;
    settings.scene.pattern = false; /* a picture of the garment, no part of it */
    settings.scene.smooth = false;
    tl_session *session = tl_session_create(&settings, error);
    bool done = session != NULL;
    if (done && !tl_session_garment(session) && !is_glb)
        done = tl_fail(error, TL_USAGE, "%s: holds a garment, and the scene has none: add --garment FILE",
                       arguments->output);
    if (done)
        done = (is_cache(arguments->output) ? export_motion : export_frame)(session, arguments, error);
    tl_session_destroy(&session);
    return done;
}
