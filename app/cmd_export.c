/* toile export: the draped garment as a GLB file. */
#include "app/commands.h"
#include "app/session.h"
#include "app/stage.h"
#include "config/file.h"

bool tl_command_export(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->output || !tl_path_has_extension(arguments->output, "glb"))
        return tl_fail(error, TL_USAGE, "%s: export writes GLB: add -o FILE.glb",
                       arguments->output ? arguments->output : "export");
    struct tl_settings settings;
    struct tl_writer writer;
    if (!tl_stage_settings(arguments, &settings, error) ||
        !tl_writer_begin(&writer, arguments->output, error))
        return false;
    tl_writer_abandon(&writer); /* it could be written; the exporter makes its own */
    tl_session *session = tl_session_create(&settings, error);
    bool done = session && tl_session_go_to(session, arguments->first_frame, error);
    if (done) {
        tl_frame frame = tl_session_frame(session);
        done = tl_model_export_glb(arguments->output, frame.surfaces, frame.surface_count, error);
    }
    tl_session_destroy(&session);
    return done;
}
