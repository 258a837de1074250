#include "app/lab/gallery/shots.h"

#include "app/lab/gallery/integral.h"
#include "app/measure/cost.h"
#include "config/base/memory.h"
#include "render/present/tone_map.h"

#include <math.h>
#include <string.h>

#define TIMED_FRAMES 2
#define NUDGE_RAD    1e-4f /* of the camera between frames, so that nothing is reused */
#define SIDE         512
#define SUPERSAMPLE  2

bool tl_shots_open(struct tl_shots *shots, tl_error *error)
{
    *shots = (struct tl_shots){.gpu = tl_gpu_create_headless(error)};
    bool ready = shots->gpu != NULL;
    for (int i = 0; ready && i < TL_PICTURE_OBJECTS; i++) {
        shots->viewpoints[i].renderer = tl_renderer_create(shots->gpu, error);
        ready = shots->viewpoints[i].renderer != NULL;
    }
    return ready;
}

void tl_shots_close(struct tl_shots *shots)
{
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++) {
        tl_session_destroy(&shots->viewpoints[i].session);
        tl_renderer_destroy(&shots->viewpoints[i].renderer);
        tl_gallery_shot_release(&shots->viewpoints[i].exact);
    }
    tl_gpu_destroy(&shots->gpu);
}

int tl_shots_side(const struct tl_experiment *experiment)
{
    return experiment->side ? experiment->side : SIDE;
}

/* Options of the technique or of the reference that ask for more samples keep them. */
bool tl_shots_settings(const struct tl_experiment_picture *picture, enum tl_picture_object object, int side,
                       bool exact, struct tl_settings *out, tl_error *error)
{
    if (!tl_picture_settings(picture, object, side, exact, out, error))
        return false;
    int wanted = picture->experiment->supersample ? picture->experiment->supersample : SUPERSAMPLE;
    if (out->image.supersample < wanted)
        out->image.supersample = wanted;
    return true;
}

/* A session lets a draped cloth move on when its options change: a picture of another solver or another start
 * needs a sheet that falls from the start. */
static bool set_up(struct tl_viewpoint *viewpoint, const struct tl_settings *settings, tl_error *error)
{
    const struct tl_option_filter drape = {.any_of = TL_AFFECTS_DRAPE};
    if (viewpoint->session && tl_settings_differ(tl_session_settings(viewpoint->session), settings, drape))
        return tl_session_restart(viewpoint->session, settings, error);
    if (viewpoint->session)
        return tl_session_apply(viewpoint->session, settings, error);
    viewpoint->session = tl_session_create(settings, error);
    return viewpoint->session != NULL;
}

static bool draw_frame(struct tl_viewpoint *viewpoint, float nudge, tl_frame *frame, tl_error *error)
{
    const struct tl_render_settings settings = tl_settings_render(tl_session_settings(viewpoint->session));
    vec3s away = glms_vec3_sub(frame->camera.eye, frame->camera.target);
    frame->camera.eye = glms_vec3_add(frame->camera.target, glms_vec3_rotate(away, nudge, frame->camera.up));
    return tl_renderer_draw(viewpoint->renderer, frame, &settings, error);
}

/* Draws a first frame, which creates the resources that the settings need, then timed ones. */
static bool measure_time(struct tl_viewpoint *viewpoint, double *time_ms, tl_error *error)
{
    double taken[TIMED_FRAMES];
    for (int i = 0; i <= TIMED_FRAMES; i++) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        tl_frame frame = tl_session_frame(viewpoint->session);
        if (!draw_frame(viewpoint, (float)(i + 1) * NUDGE_RAD, &frame, error))
            return false;
        if (i > 0)
            taken[i - 1] = tl_stopwatch_read(&watch).cpu_ms;
    }
    *time_ms = tl_median(taken, TIMED_FRAMES);
    return true;
}

static bool draw_still(struct tl_viewpoint *viewpoint, struct tl_gallery_shot *out, tl_error *error)
{
    tl_frame frame = tl_session_frame(viewpoint->session);
    frame.still = true;
    if (!draw_frame(viewpoint, 0, &frame, error) ||
        !tl_renderer_read(viewpoint->renderer, &out->light, error) ||
        !tl_renderer_show_image(viewpoint->renderer, &out->shown, error))
        return false;
    bool traced = tl_session_settings(viewpoint->session)->light.method == TL_METHOD_REFERENCE;
    out->noise = traced ? tl_renderer_standard_error(viewpoint->renderer) : 0;
    return true;
}

/* ---- Integrals ---- */

/* The picture of an image that the renderer did not draw: on grey, as the gallery's scene has it. */
static tl_image show(const tl_image *light, float exposure_ev)
{
    const float factor = exp2f(exposure_ev);
    tl_image mapped = tl_tone_map_image(light, (vec3s){{factor, factor, factor}});
    const size_t pixels = (size_t)light->width * (size_t)light->height;
    tl_image shown = tl_image_create(light->width, light->height, 3, TL_IMAGE_U8);
    for (size_t i = 0; i < pixels; i++)
        memcpy(tl_image_bytes(&shown) + 3 * i, tl_image_bytes(&mapped) + 4 * i, 3);
    tl_image_release(&mapped);
    return shown;
}

const tl_image *tl_shots_layer(const struct tl_aovs *aovs, const char *channel)
{
    for (int i = 0; i < aovs->count; i++)
        if (strcmp(aovs->items[i].channels[0], channel) == 0)
            return &aovs->items[i].image;
    return NULL;
}

static bool draw_layers(struct tl_viewpoint *viewpoint, tl_image *light, struct tl_aovs *aovs,
                        tl_error *error)
{
    tl_frame frame = tl_session_frame(viewpoint->session);
    frame.aovs = true;
    frame.still = true;
    return draw_frame(viewpoint, 0, &frame, error) && tl_renderer_read(viewpoint->renderer, light, error) &&
           tl_renderer_read_aovs(viewpoint->renderer, aovs, error);
}

bool tl_shots_layers(struct tl_shots *shots, const struct tl_settings *settings, tl_image *light,
                     struct tl_aovs *layers, tl_error *error)
{
    struct tl_viewpoint *viewpoint = &shots->viewpoints[TL_PICTURE_SOLID];
    return set_up(viewpoint, settings, error) && draw_layers(viewpoint, light, layers, error);
}

/* Draws the samples of a picture twice its size, one a pixel, and sums the environment at each. */
static bool draw_integral(struct tl_viewpoint *viewpoint, struct tl_gallery_shot *out, tl_error *error)
{
    struct tl_aovs aovs = {0};
    tl_image covered = {0};
    bool drawn = draw_layers(viewpoint, &covered, &aovs, error);
    if (drawn) {
        const tl_frame frame = tl_session_frame(viewpoint->session);
        const struct tl_settings *settings = tl_session_settings(viewpoint->session);
        out->light =
            tl_integral_make(&(const struct tl_integral_request){.environment = frame.environment,
                                                                 .environment_yaw = frame.environment_yaw,
                                                                 .eye = frame.camera.eye,
                                                                 .settings = settings,
                                                                 .normals = tl_shots_layer(&aovs, "N.x"),
                                                                 .points = tl_shots_layer(&aovs, "P.x"),
                                                                 .diffuse = tl_shots_layer(&aovs, "albedo.R"),
                                                                 .covered = &covered});
        out->shown = show(&out->light, settings->image.exposure_ev);
    }
    tl_aovs_release(&aovs);
    tl_image_release(&covered);
    return drawn;
}

/* ---- Pictures ---- */

static bool draw_settings(struct tl_viewpoint *viewpoint, const struct tl_settings *settings,
                          enum tl_exact kind, struct tl_gallery_shot *out, tl_error *error)
{
    struct tl_settings samples = *settings;
    if (kind != TL_EXACT_INTEGRAL)
        return set_up(viewpoint, settings, error) && draw_still(viewpoint, out, error);
    samples.image.width *= 2;
    samples.image.height *= 2;
    samples.image.supersample = 1;
    return set_up(viewpoint, &samples, error) && draw_integral(viewpoint, out, error);
}

/* A strip leaves its last frame; pictures are of the first one. */
static bool rewind_session(struct tl_viewpoint *viewpoint, tl_error *error)
{
    return !viewpoint->session || tl_session_go_to(viewpoint->session, 0, error);
}

bool tl_shots_draw(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                   enum tl_picture_object object, struct tl_gallery_shot *out, tl_error *error)
{
    struct tl_viewpoint *viewpoint = &shots->viewpoints[object];
    struct tl_settings settings;
    *out = (struct tl_gallery_shot){0};
    return tl_shots_settings(picture, object, tl_shots_side(picture->experiment), false, &settings, error) &&
           rewind_session(viewpoint, error) && set_up(viewpoint, &settings, error) &&
           measure_time(viewpoint, &out->time_ms, error) && draw_still(viewpoint, out, error);
}

const struct tl_gallery_shot *tl_shots_exact(struct tl_shots *shots,
                                             const struct tl_experiment_picture *picture,
                                             enum tl_picture_object object, tl_error *error)
{
    struct tl_viewpoint *viewpoint = &shots->viewpoints[object];
    enum tl_exact kind = picture->experiment->exact;
    struct tl_settings settings;
    if (!tl_shots_settings(picture, object, tl_shots_side(picture->experiment), true, &settings, error))
        return NULL;
    if (viewpoint->exact.light.texels && viewpoint->exact_kind == kind &&
        tl_settings_equal(&settings, &viewpoint->exact_settings))
        return &viewpoint->exact;
    tl_gallery_shot_release(&viewpoint->exact);
    viewpoint->exact_settings = settings;
    viewpoint->exact_kind = kind;
    bool drawn = rewind_session(viewpoint, error) &&
                 draw_settings(viewpoint, &settings, kind, &viewpoint->exact, error);
    return drawn ? &viewpoint->exact : NULL;
}

/* ---- Strips ---- */

static void move(const struct tl_experiment *experiment, int frame, struct tl_settings *settings)
{
    float step = experiment->motion_step * (float)frame;
    if (experiment->motion == TL_MOTION_CAMERA)
        settings->camera.yaw_deg += step;
    else if (experiment->motion == TL_MOTION_LAMP)
        settings->lamp.yaw_deg += step;
    else if (experiment->motion == TL_MOTION_CLOTH)
        settings->cloth.settle_s = 0;
}

static bool draw_moved(struct tl_shots *shots, const struct tl_experiment_picture *picture, int frame,
                       bool exact, struct tl_gallery_shot *out, tl_error *error)
{
    const struct tl_experiment *experiment = picture->experiment;
    enum tl_picture_object object =
        experiment->motion == TL_MOTION_CLOTH ? TL_PICTURE_SHEET : TL_PICTURE_SOLID;
    struct tl_viewpoint *viewpoint = &shots->viewpoints[object];
    struct tl_settings settings;
    if (!tl_shots_settings(picture, object, TL_STRIP_SIDE, exact, &settings, error))
        return false;
    move(experiment, frame, &settings);
    bool plays = experiment->motion == TL_MOTION_CLOTH || experiment->motion == TL_MOTION_SKY;
    int number = plays ? (int)(experiment->motion_step * (float)frame) : 0;
    return set_up(viewpoint, &settings, error) && tl_session_go_to(viewpoint->session, number, error) &&
           draw_settings(viewpoint, &settings, exact ? experiment->exact : TL_EXACT_DRAWN, out, error);
}

bool tl_shots_strip(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                    struct tl_gallery_shot exact[TL_STRIP_FRAMES],
                    struct tl_gallery_shot tested[TL_STRIP_FRAMES], tl_error *error)
{
    bool drawn = true;
    memset(exact, 0, TL_STRIP_FRAMES * sizeof *exact);
    memset(tested, 0, TL_STRIP_FRAMES * sizeof *tested);
    for (int i = 0; drawn && i < TL_STRIP_FRAMES; i++)
        drawn = draw_moved(shots, picture, i, true, &exact[i], error) &&
                draw_moved(shots, picture, i, false, &tested[i], error);
    return drawn;
}
