#include "app/lab/gallery/gallery.h"

#include "app/measure/cost.h"
#include "app/report/canvas.h"
#include "app/scene/session.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "config/words.h"
#include "render/metrics/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TIMED_FRAMES 3
#define DIFFERENCE   8.0f  /* what differs is shown so many times as bright */
#define NUDGE_RAD    1e-4f /* a camera that moves has its frame drawn anew */
#define PAPER        0xffffffu
#define INK          0x202428u
#define MARGIN       4

/* What an object looked like. */
struct sight {
    tl_image light; /* F32 RGBA, as tl_renderer_read gives it */
    tl_image shown; /* U8 RGB */
    double time_ms;
};

/* One of the two objects, with the settings that it was last drawn with. */
struct easel {
    const char *garment, *avatar;
    double height_m, distance_m; /* of the camera's target, and of the camera from it */
    struct tl_settings settings;
    tl_session *session;
    tl_renderer *renderer; /* its own: revisions of one session say nothing about the other's */
    struct tl_settings exact_settings;
    struct sight exact; /* kept, for neighbours on a wall share it */
};

struct drawing {
    tl_gpu *gpu;
    struct easel easels[TL_GALLERY_OBJECTS];
    int side;
};

static void release_sight(struct sight *sight)
{
    tl_image_release(&sight->light);
    tl_image_release(&sight->shown);
}

/* Settings are read anew for every picture: a fabric or preset that an assignment names lies below the
 * others. */
static bool choose(const struct drawing *drawing, const struct easel *easel,
                   const struct tl_gallery_wall *wall, const struct tl_exhibit *exhibit, bool exact,
                   struct tl_settings *out, tl_error *error)
{
    char *own[] = {tl_format("image.width=%d", drawing->side),
                   tl_format("image.height=%d", drawing->side),
                   tl_format("scene.garment=%s", easel->garment),
                   tl_format("scene.avatar=%s", easel->avatar),
                   tl_format("camera.target=[0, %g, 0]", easel->height_m),
                   tl_format("camera.distance_m=%g", easel->distance_m)};
    const char *all[TL_COUNT(own) + (size_t)2 * TL_GALLERY_ASSIGNMENTS];
    size_t count = 0;
    for (; count < TL_COUNT(own); count++)
        all[count] = own[count];
    for (size_t i = 0; i < TL_GALLERY_ASSIGNMENTS && wall->base[i]; i++)
        all[count++] = wall->base[i];
    for (size_t i = 0; i < TL_GALLERY_ASSIGNMENTS && exhibit->chosen[i] && !(exact && wall->one_truth); i++)
        all[count++] = exhibit->chosen[i];
    const struct tl_settings_source source = {
        .scene_file = "gallery", .assignments = all, .assignment_count = count};
    bool chosen = tl_settings_load(out, &source, error);
    if (chosen && exact)
        chosen = tl_settings_assign(out, wall->exact, TL_COUNT(wall->exact), error) &&
                 tl_settings_assign(out, exhibit->exact, TL_COUNT(exhibit->exact), error);
    for (size_t i = 0; i < TL_COUNT(own); i++)
        free(own[i]);
    return chosen;
}

static bool set_up(struct easel *easel, const struct tl_settings *settings, tl_error *error)
{
    if (!easel->session)
        easel->session = tl_session_create(settings, error);
    else if (!tl_session_apply(easel->session, settings, error))
        return false;
    easel->settings = *settings;
    return easel->session != NULL;
}

static bool draw_frame(struct easel *easel, float nudge, bool still, tl_error *error)
{
    const struct tl_render_settings settings = tl_settings_render(&easel->settings);
    tl_frame frame = tl_session_frame(easel->session);
    vec3s away = glms_vec3_sub(frame.camera.eye, frame.camera.target);
    frame.camera.eye = glms_vec3_add(frame.camera.target, glms_vec3_rotate(away, nudge, frame.camera.up));
    frame.still = still;
    return tl_renderer_draw(easel->renderer, &frame, &settings, error);
}

/* The first frame makes what the settings need; the following ones are timed; the last is the picture. */
static bool look(struct easel *easel, bool timed, struct sight *out, tl_error *error)
{
    double taken[TIMED_FRAMES];
    *out = (struct sight){.time_ms = NAN};
    for (int i = 0; timed && i <= TIMED_FRAMES; i++) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        if (!draw_frame(easel, (float)(i + 1) * NUDGE_RAD, false, error))
            return false;
        if (i > 0)
            taken[i - 1] = tl_stopwatch_read(&watch).cpu_ms;
    }
    if (timed)
        out->time_ms = tl_median(taken, TIMED_FRAMES);
    if (draw_frame(easel, 0, true, error) && tl_renderer_read(easel->renderer, &out->light, error) &&
        tl_renderer_show_image(easel->renderer, &out->shown, error))
        return true;
    release_sight(out);
    return false;
}

/* |a - b|, exposed as the pictures are but brighter. */
static tl_image difference_of(const struct sight *tested, const struct sight *exact, float exposure_ev)
{
    tl_image image = tl_image_create(tested->light.width, tested->light.height, 3, TL_IMAGE_U8);
    const float *a = tl_image_floats(&tested->light), *b = tl_image_floats(&exact->light);
    size_t pixels = (size_t)image.width * (size_t)image.height;
    float gain = DIFFERENCE * exp2f(exposure_ev);
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++) {
            float value = tl_srgb_from_linear(fminf(gain * fabsf(a[4 * i + c] - b[4 * i + c]), 1));
            tl_image_bytes(&image)[3 * i + c] = (uint8_t)lrintf(255 * value);
        }
    return image;
}

static void paste(tl_image *onto, const tl_image *picture, int x, int y)
{
    for (int row = 0; row < picture->height; row++)
        memcpy(tl_image_bytes(onto) + 3 * ((size_t)(y + row) * (size_t)onto->width + (size_t)x),
               tl_image_bytes(picture) + 3 * (size_t)row * (size_t)picture->width,
               3 * (size_t)picture->width);
}

static bool frame_picture(struct tl_hung *hung, const struct drawing *drawing, const struct sight tested[],
                          tl_error *error)
{
    int side = drawing->side, top = TL_CANVAS_LETTER + 2 * MARGIN;
    tl_image canvas = tl_canvas_create(2 * side, top + 2 * side, PAPER);
    char *label = tl_format("%s  %s", hung->exhibit->id, hung->exhibit->setting);
    tl_canvas_text(&canvas, MARGIN, MARGIN, label, INK);
    free(label);
    for (int i = 0; i < TL_GALLERY_OBJECTS; i++) {
        const struct easel *easel = &drawing->easels[i];
        tl_image differs = difference_of(&tested[i], &easel->exact, easel->settings.image.exposure_ev);
        paste(&canvas, &tested[i].shown, i * side, top);
        paste(&canvas, &differs, i * side, top + side);
        tl_image_release(&differs);
    }
    bool made = tl_image_encode_png(hung->image, &canvas, &hung->png, &hung->png_size, error);
    tl_image_release(&canvas);
    return made;
}

static bool see(struct easel *easel, const struct tl_settings *settings, bool timed, struct sight *out,
                tl_error *error)
{
    return set_up(easel, settings, error) && look(easel, timed, out, error);
}

static bool see_exact(const struct drawing *drawing, struct easel *easel, const struct tl_hung *hung,
                      tl_error *error)
{
    struct tl_settings settings;
    if (!choose(drawing, easel, hung->wall, hung->exhibit, true, &settings, error))
        return false;
    if (easel->exact.light.texels && tl_settings_equal(&settings, &easel->exact_settings))
        return true;
    release_sight(&easel->exact);
    easel->exact_settings = settings;
    return see(easel, &settings, false, &easel->exact, error);
}

static bool see_tested(const struct drawing *drawing, struct easel *easel, const struct tl_hung *hung,
                       struct sight *out, tl_error *error)
{
    struct tl_settings settings;
    return choose(drawing, easel, hung->wall, hung->exhibit, false, &settings, error) &&
           see(easel, &settings, true, out, error);
}

static bool hang(struct drawing *drawing, struct tl_hung *hung, tl_error *error)
{
    struct sight tested[TL_GALLERY_OBJECTS] = {0};
    bool done = true;
    drawing->easels[TL_GALLERY_SOLID].garment = hung->wall->solid;
    for (int i = 0; done && i < TL_GALLERY_OBJECTS; i++) {
        struct easel *easel = &drawing->easels[i];
        struct tl_comparison result = {0};
        done = see_exact(drawing, easel, hung, error) &&
               see_tested(drawing, easel, hung, &tested[i], error) &&
               tl_image_compare(&tested[i].light, &easel->exact.light, hung->wall->by_flip ? -1 : 0, 0,
                                &result, error);
        hung->error[i] = hung->wall->by_flip ? result.flip_mean : result.rel_rmse;
        hung->time_ms[i] = tested[i].time_ms;
    }
    if (done)
        done = frame_picture(hung, drawing, tested, error);
    for (int i = 0; i < TL_GALLERY_OBJECTS; i++)
        release_sight(&tested[i]);
    return done;
}

static bool is_wanted(const struct tl_gallery_wall *wall, const char *only)
{
    return !only || strcmp(wall->name, only) == 0;
}

static size_t count_exhibits(bool quick, const char *only)
{
    size_t count = 0;
    for (size_t w = 0; w < tl_gallery_wall_count; w++)
        if (is_wanted(&tl_gallery_walls[w], only))
            count += quick ? 1 : tl_gallery_walls[w].exhibit_count;
    return count;
}

bool tl_gallery_has(const char *name, tl_error *error)
{
    if (count_exhibits(true, name))
        return true;
    const char **names = TL_NEW_ARRAY(const char *, tl_gallery_wall_count);
    for (size_t w = 0; w < tl_gallery_wall_count; w++)
        names[w] = tl_gallery_walls[w].name;
    const char *near = tl_nearest_word(name, names, tl_gallery_wall_count);
    free(names);
    return tl_fail(error, TL_USAGE, "gallery: \"%s\": no such wall: expected %s%s%s", name,
                   tl_gallery_walls[0].name,
                   near ? ": did you mean " : " or another row of the technique set", near ? near : "");
}

static bool hang_all(struct drawing *drawing, bool quick, const char *only, struct tl_gallery *out,
                     tl_error *error)
{
    size_t total = count_exhibits(quick, only);
    out->items = TL_NEW_ARRAY(struct tl_hung, total);
    struct tl_progress progress = tl_progress_begin("hanging");
    bool done = true;
    for (size_t w = 0; done && w < tl_gallery_wall_count; w++) {
        const struct tl_gallery_wall *wall = &tl_gallery_walls[w];
        size_t count = !is_wanted(wall, only) ? 0 : quick ? 1 : wall->exhibit_count;
        for (size_t e = 0; done && e < count; e++) {
            struct tl_hung *hung = &out->items[out->count];
            *hung = (struct tl_hung){.wall = wall,
                                     .exhibit = &wall->exhibits[e],
                                     .image = tl_format("%s-%02zu.png", wall->name, e + 1)};
            done = hang(drawing, hung, error);
            out->count += done;
            if (!done)
                free(hung->image);
            if (tl_interrupted())
                done = tl_fail(error, TL_INTERRUPTED, "stopped after %zu of %zu pictures", out->count, total);
            tl_progress_update(&progress, (int)out->count, (int)total);
        }
    }
    tl_progress_end(&progress);
    return done;
}

bool tl_gallery_draw(bool quick, const char *only, struct tl_gallery *out, tl_error *error)
{
    struct drawing drawing = {
        .side = 240,
        .easels = {
            [TL_GALLERY_SOLID] = {.garment = "torus", .avatar = "none", .height_m = 0.2, .distance_m = 0.9},
            [TL_GALLERY_SHEET] = {
                .garment = "sheet", .avatar = "ball", .height_m = 0.27, .distance_m = 1.15}}};
    *out = (struct tl_gallery){.side = drawing.side};
    drawing.gpu = tl_gpu_create_headless(error);
    bool ready = drawing.gpu != NULL;
    for (int i = 0; ready && i < TL_GALLERY_OBJECTS; i++) {
        drawing.easels[i].renderer = tl_renderer_create(drawing.gpu, error);
        ready = drawing.easels[i].renderer != NULL;
    }
    out->complete = ready && hang_all(&drawing, quick, only, out, error);
    for (int i = 0; i < TL_GALLERY_OBJECTS; i++) {
        tl_session_destroy(&drawing.easels[i].session);
        tl_renderer_destroy(&drawing.easels[i].renderer);
        release_sight(&drawing.easels[i].exact);
    }
    tl_gpu_destroy(&drawing.gpu);
    return out->complete;
}

void tl_gallery_release(struct tl_gallery *gallery)
{
    for (size_t i = 0; i < gallery->count; i++) {
        free(gallery->items[i].image);
        free(gallery->items[i].png);
    }
    free(gallery->items);
    *gallery = (struct tl_gallery){0};
}
