#include "app/lab/gallery/gallery.h"

#include "app/lab/experiments/experiments.h"
#include "app/measure/cost.h"
#include "app/report/canvas.h"
#include "app/scene/session.h"
#include "assets/image/image_file.h"
#include "config/colour/srgb.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "config/words.h"
#include "render/metrics/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TIMED_FRAMES 3
#define DIFFERENCE   8.0f  /* brightness of the difference image */
#define NUDGE_RAD    1e-4f /* of the camera between frames, so that nothing is reused */
#define PAPER        0xffffffu
#define INK          0x202428u
#define MARGIN       4

/* One drawn image of an object. */
struct gallery_shot {
    tl_image light; /* F32 RGBA, as tl_renderer_read gives it */
    tl_image shown; /* U8 RGB */
    double time_ms;
};

/* One of the two objects, with the settings that it was last drawn with. */
struct viewpoint {
    struct tl_settings settings;
    tl_session *session;
    tl_renderer *renderer; /* one each, because a revision is unique within one session only */
    struct tl_settings exact_settings;
    struct gallery_shot exact; /* kept: successive pictures of a section often share it */
};

struct gallery_drawing {
    tl_gpu *gpu;
    struct viewpoint viewpoints[TL_PICTURE_OBJECTS];
    int side;
    struct tl_progress progress;
    size_t total; /* pictures */
};

static void release_shot(struct gallery_shot *shot)
{
    tl_image_release(&shot->light);
    tl_image_release(&shot->shown);
}

static void release_entry(struct tl_gallery_entry *entry)
{
    free(entry->setting);
    free(entry->image);
    free(entry->png);
}

static bool set_up(struct viewpoint *viewpoint, const struct tl_settings *settings, tl_error *error)
{
    if (!viewpoint->session)
        viewpoint->session = tl_session_create(settings, error);
    else if (!tl_session_apply(viewpoint->session, settings, error))
        return false;
    viewpoint->settings = *settings;
    return viewpoint->session != NULL;
}

static bool draw_frame(struct viewpoint *viewpoint, float nudge, bool still, tl_error *error)
{
    const struct tl_render_settings settings = tl_settings_render(&viewpoint->settings);
    tl_frame frame = tl_session_frame(viewpoint->session);
    vec3s away = glms_vec3_sub(frame.camera.eye, frame.camera.target);
    frame.camera.eye = glms_vec3_add(frame.camera.target, glms_vec3_rotate(away, nudge, frame.camera.up));
    frame.still = still;
    return tl_renderer_draw(viewpoint->renderer, &frame, &settings, error);
}

/* Draws a first frame, which creates the resources that the settings need, then timed ones, then the picture.
 */
static bool draw_timed(struct viewpoint *viewpoint, bool timed, struct gallery_shot *out, tl_error *error)
{
    double taken[TIMED_FRAMES];
    *out = (struct gallery_shot){.time_ms = NAN};
    for (int i = 0; timed && i <= TIMED_FRAMES; i++) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        if (!draw_frame(viewpoint, (float)(i + 1) * NUDGE_RAD, false, error))
            return false;
        if (i > 0)
            taken[i - 1] = tl_stopwatch_read(&watch).cpu_ms;
    }
    if (timed)
        out->time_ms = tl_median(taken, TIMED_FRAMES);
    if (draw_frame(viewpoint, 0, true, error) && tl_renderer_read(viewpoint->renderer, &out->light, error) &&
        tl_renderer_show_image(viewpoint->renderer, &out->shown, error))
        return true;
    release_shot(out);
    return false;
}

/* |a - b|, exposed like the pictures and then brightened by DIFFERENCE. */
static tl_image difference_of(const struct gallery_shot *tested, const struct gallery_shot *exact,
                              float exposure_ev)
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

static bool frame_picture(struct tl_gallery_entry *entry, const struct gallery_drawing *drawing,
                          const struct gallery_shot tested[], tl_error *error)
{
    int side = drawing->side, top = TL_CANVAS_LETTER + 2 * MARGIN;
    tl_image canvas = tl_canvas_create(2 * side, top + 2 * side, PAPER);
    char *label = tl_format("%s  %s", entry->picture.technique->id, entry->setting);
    tl_canvas_text(&canvas, MARGIN, MARGIN, label, INK);
    free(label);
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++) {
        const struct viewpoint *viewpoint = &drawing->viewpoints[i];
        tl_image differs =
            difference_of(&tested[i], &viewpoint->exact, viewpoint->settings.image.exposure_ev);
        paste(&canvas, &tested[i].shown, i * side, top);
        paste(&canvas, &differs, i * side, top + side);
        tl_image_release(&differs);
    }
    bool made = tl_image_encode_png(entry->image, &canvas, &entry->png, &entry->png_size, error);
    tl_image_release(&canvas);
    return made;
}

static bool draw_settings(struct viewpoint *viewpoint, const struct tl_settings *settings, bool timed,
                          struct gallery_shot *out, tl_error *error)
{
    return set_up(viewpoint, settings, error) && draw_timed(viewpoint, timed, out, error);
}

static bool draw_exact(const struct gallery_drawing *drawing, int object, struct viewpoint *viewpoint,
                       const struct tl_gallery_entry *entry, tl_error *error)
{
    struct tl_settings settings;
    if (!tl_picture_settings(&entry->picture, object, drawing->side, true, &settings, error))
        return false;
    if (viewpoint->exact.light.texels && tl_settings_equal(&settings, &viewpoint->exact_settings))
        return true;
    release_shot(&viewpoint->exact);
    viewpoint->exact_settings = settings;
    return draw_settings(viewpoint, &settings, false, &viewpoint->exact, error);
}

static bool draw_tested(const struct gallery_drawing *drawing, int object, struct viewpoint *viewpoint,
                        const struct tl_gallery_entry *entry, struct gallery_shot *out, tl_error *error)
{
    struct tl_settings settings;
    return tl_picture_settings(&entry->picture, object, drawing->side, false, &settings, error) &&
           draw_settings(viewpoint, &settings, true, out, error);
}

static bool draw_entry(struct gallery_drawing *drawing, struct tl_gallery_entry *entry, tl_error *error)
{
    struct gallery_shot tested[TL_PICTURE_OBJECTS] = {0};
    bool done = true;
    for (int i = 0; done && i < TL_PICTURE_OBJECTS; i++) {
        struct viewpoint *viewpoint = &drawing->viewpoints[i];
        struct tl_comparison result = {0};
        done = draw_exact(drawing, i, viewpoint, entry, error) &&
               draw_tested(drawing, i, viewpoint, entry, &tested[i], error) &&
               tl_image_compare(&tested[i].light, &viewpoint->exact.light,
                                entry->picture.experiment->by_flip ? -1 : 0, 0, &result, error);
        entry->error[i] = entry->picture.experiment->by_flip ? result.flip_mean : result.rel_rmse;
        entry->time_ms[i] = tested[i].time_ms;
    }
    if (done)
        done = frame_picture(entry, drawing, tested, error);
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++)
        release_shot(&tested[i]);
    return done;
}

/* Section `index` of those that are drawn (all, or the one called `only`); NULL past the last one. */
static const struct tl_experiment *section_at(const char *only, size_t index)
{
    if (!only)
        return tl_experiment_at(TL_OUTPUT_PICTURES, index);
    return index == 0 ? tl_experiment_find(TL_OUTPUT_PICTURES, only) : NULL;
}

static size_t count_pictures(bool quick, const char *only)
{
    const struct tl_experiment *section;
    size_t count = 0;
    for (size_t i = 0; (section = section_at(only, i)); i++)
        count += quick ? 1 : tl_picture_count(section, TL_OUTPUT_PICTURES);
    return count;
}

bool tl_gallery_has(const char *name, tl_error *error)
{
    size_t count = 0;
    if (section_at(name, 0))
        return true;
    while (section_at(NULL, count))
        count++;
    const char **names = TL_NEW_ARRAY(const char *, count);
    for (size_t i = 0; i < count; i++)
        names[i] = section_at(NULL, i)->name;
    const char *near = tl_nearest_word(name, names, count), *first = names[0];
    free(names);
    return tl_fail(error, TL_USAGE, "gallery: \"%s\": no such section: expected %s%s%s", name, first,
                   near ? ": did you mean " : " or another row of the technique set", near ? near : "");
}

static bool draw_section(struct gallery_drawing *drawing, const struct tl_experiment *section, bool quick,
                         struct tl_gallery *out, tl_error *error)
{
    struct tl_experiment_picture picture = {.experiment = section};
    bool done = true;
    for (size_t number = 1; done && !(quick && number > 1) && tl_picture_next(&picture, TL_OUTPUT_PICTURES);
         number++) {
        struct tl_gallery_entry *entry = &out->entries[out->count++];
        *entry = (struct tl_gallery_entry){.picture = picture,
                                           .setting = tl_picture_name(&picture, TL_OUTPUT_PICTURES),
                                           .image = tl_format("%s-%02zu.png", section->name, number)};
        done = draw_entry(drawing, entry, error);
        if (!done)
            release_entry(&out->entries[--out->count]);
        tl_progress_update(&drawing->progress, (int)out->count, (int)drawing->total);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stopped after %zu of %zu pictures", out->count,
                           drawing->total);
    }
    return done;
}

static bool draw_sections(struct gallery_drawing *drawing, bool quick, const char *only,
                          struct tl_gallery *out, tl_error *error)
{
    const struct tl_experiment *section;
    drawing->total = count_pictures(quick, only);
    drawing->progress = tl_progress_begin("drawing the gallery");
    out->entries = TL_NEW_ARRAY(struct tl_gallery_entry, drawing->total);
    bool done = true;
    for (size_t i = 0; done && (section = section_at(only, i)); i++)
        done = draw_section(drawing, section, quick, out, error);
    tl_progress_end(&drawing->progress);
    return done;
}

bool tl_gallery_draw(bool quick, const char *only, struct tl_gallery *out, tl_error *error)
{
    struct gallery_drawing drawing = {.side = 240};
    *out = (struct tl_gallery){.side = drawing.side};
    drawing.gpu = tl_gpu_create_headless(error);
    bool ready = drawing.gpu != NULL;
    for (int i = 0; ready && i < TL_PICTURE_OBJECTS; i++) {
        drawing.viewpoints[i].renderer = tl_renderer_create(drawing.gpu, error);
        ready = drawing.viewpoints[i].renderer != NULL;
    }
    out->complete = ready && draw_sections(&drawing, quick, only, out, error);
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++) {
        tl_session_destroy(&drawing.viewpoints[i].session);
        tl_renderer_destroy(&drawing.viewpoints[i].renderer);
        release_shot(&drawing.viewpoints[i].exact);
    }
    tl_gpu_destroy(&drawing.gpu);
    return out->complete;
}

void tl_gallery_release(struct tl_gallery *gallery)
{
    for (size_t i = 0; i < gallery->count; i++)
        release_entry(&gallery->entries[i]);
    free(gallery->entries);
    *gallery = (struct tl_gallery){0};
}
