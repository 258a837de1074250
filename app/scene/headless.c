#include "app/scene/headless.h"

#include "config/interrupt.h"
#include "config/log.h"

bool tl_stage_settings(const struct tl_arguments *arguments, struct tl_settings *out, tl_error *error)
{
    if (arguments->positional_count > 1)
        return tl_fail(error, TL_USAGE,
                       "%s: one scene at a time: name a YAML, .glb, .gltf or .obj file, or none",
                       arguments->positionals[1]);
    const struct tl_settings_source source = {
        .scene_file = arguments->positional_count ? arguments->positionals[0] : NULL,
        .assignments = (const char *const *)arguments->assignments,
        .assignment_count = arguments->assignment_count,
    };
    return tl_settings_load(out, &source, error);
}

bool tl_stage_open(struct tl_stage *stage, const struct tl_settings *settings, tl_error *error)
{
    *stage = (struct tl_stage){.settings = *settings};
    stage->gpu = tl_gpu_create_headless(error);
    stage->renderer = stage->gpu ? tl_renderer_create(stage->gpu, error) : NULL;
    stage->session = stage->renderer ? tl_session_create(&stage->settings, error) : NULL;
    if (stage->session) {
        tl_debug("rendering with %s", tl_gpu_name(stage->gpu));
        return true;
    }
    tl_stage_release(stage);
    return false;
}

bool tl_stage_create(struct tl_stage *stage, const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_settings settings;
    *stage = (struct tl_stage){0};
    return tl_stage_settings(arguments, &settings, error) && tl_stage_open(stage, &settings, error);
}

void tl_stage_release(struct tl_stage *stage)
{
    tl_renderer_destroy(&stage->renderer);
    tl_gpu_destroy(&stage->gpu);
    tl_session_destroy(&stage->session);
}

static bool draw(struct tl_stage *stage, bool still, tl_error *error)
{
    tl_frame frame = tl_session_frame(stage->session);
    frame.still = still;
    frame.aovs = stage->aovs;
    const struct tl_render_settings settings = tl_settings_render(&stage->settings);
    return tl_renderer_draw(stage->renderer, &frame, &settings, error);
}

bool tl_stage_draw(struct tl_stage *stage, tl_error *error)
{
    return draw(stage, false, error);
}

bool tl_stage_draw_still(struct tl_stage *stage, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("averaging");
    bool drawn = draw(stage, true, error);
    for (int round = 1; drawn && !tl_renderer_is_at_rest(stage->renderer) && !tl_interrupted(); round++) {
        drawn = draw(stage, true, error);
        tl_progress_update(&progress, round + 1, stage->settings.light.rounds);
    }
    tl_progress_end(&progress);
    return drawn;
}
