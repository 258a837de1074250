/* Writes the broken frame, and the scene files that open it again. */
#include "app/lab/check/check_keep.h"
#include "app/report/canvas.h"
#include "app/report/folder.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/model_export.h"
#include "assets/motion/point_cache.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/scene/view.h"
#include "render/surfaces/ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const tl_surface *find_surface(const tl_frame *frame, const char *name)
{
    for (size_t i = 0; i < frame->surface_count; i++)
        if (strcmp(frame->surfaces[i].name, name) == 0)
            return &frame->surfaces[i];
    return NULL;
}

static void print_settings(const void *what, FILE *out)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind_const(what, bindings);
    tl_options_print_yaml(bindings, TL_SETTINGS_TABLES, out);
}

/* Makes paths absolute, so that the folder can be opened from anywhere. */
static void root(struct tl_settings *settings)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(settings, bindings);
    tl_options_make_paths_absolute(bindings, TL_SETTINGS_TABLES);
}

/* The orbit whose camera equals the frame's. */
static void set_camera(const struct tl_camera *camera, struct tl_camera_params *out)
{
    vec3s back = glms_vec3_sub(camera->eye, camera->target);
    out->distance_m = glms_vec3_norm(back);
    out->yaw_deg = glm_deg(atan2f(back.x, back.z));
    out->pitch_deg = glm_deg(asinf(back.y / out->distance_m));
    memcpy(out->target, camera->target.raw, sizeof out->target);
}

/* Makes the scene still: everything that it shows is read from files, and nothing moves. */
static void make_still(const tl_frame *frame, struct tl_settings *still)
{
    bool garment = find_surface(frame, "garment"), avatar = find_surface(frame, "avatar");
    still->scene.garment = garment ? "garment.glb" : "none";
    still->scene.motion = garment ? "garment.pc2" : "none";
    still->scene.avatar = avatar ? "avatar.glb" : "none";
    still->scene.environment = "environment.exr";
    if (glms_vec3_eqv(frame->environment->ground, glms_vec3_zero()) && !(still->image.ground_grey > 0))
        still->image.ground_grey =
            TL_GROUND_GREY.r; /* the file of a built-in environment shows another one */
    still->scene.clip = "none";
    still->scene.units = still->scene.avatar_units = TL_UNITS_M;
    set_camera(&frame->camera, &still->camera);
}

/* The pixel of a finding; false if it is not on the image. */
static bool find_mark(const struct tl_checked *checked, const struct tl_finding *finding, int *x, int *y)
{
    const struct tl_image_params *image = &checked->settings->image;
    if (finding->x >= 0) {
        *x = finding->x;
        *y = finding->y;
        return true;
    }
    if (finding->surface < 0)
        return false;
    vec3s point = checked->frame->surfaces[finding->surface].positions[finding->vertex];
    struct tl_view view = tl_view_make(&checked->frame->camera, image->width, image->height);
    vec4s seen = glms_mat4_mulv(view.view_projection, (vec4s){{point.x, point.y, point.z, 1}});
    if (!(seen.w > 0 && fabsf(seen.x) <= seen.w && fabsf(seen.y) <= seen.w))
        return false;
    *x = (int)((0.5f + 0.5f * seen.x / seen.w) * (float)image->width);
    *y = (int)((0.5f - 0.5f * seen.y / seen.w) * (float)image->height);
    return true;
}

/* Draws a square frame around the pixel. */
static void draw_mark(tl_image *image, int x, int y)
{
    const int half = 8, width = 2;
    const uint32_t red = 0xff2020;
    int left = x - half, top = y - half, side = 2 * half + 1;
    tl_canvas_box(image, left, top, side, width, red);
    tl_canvas_box(image, left, top + side - width, side, width, red);
    tl_canvas_box(image, left, top, width, side, red);
    tl_canvas_box(image, left + side - width, top, width, side, red);
}

static bool keep_picture(const char *folder, struct tl_headless *headless, const struct tl_checked *checked,
                         const struct tl_finding *finding, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B", "A"};
    if (!checked->image)
        return true;
    char *exr = tl_format("%s/image.exr", folder), *png = tl_format("%s/image.png", folder);
    tl_image shown = {0};
    int x, y;
    const struct tl_exr_layer layer = {.channel_names = channels, .image = checked->image};
    bool kept =
        tl_exr_save(exr, &layer, 1, error) && tl_renderer_show_image(headless->renderer, &shown, error);
    if (kept && find_mark(checked, finding, &x, &y))
        draw_mark(&shown, x, y);
    kept = kept && tl_image_save_png(png, &shown, error);
    tl_image_release(&shown);
    free(exr);
    free(png);
    return kept;
}

/* Writes the positions as a motion of one frame, so that they are shown instead of simulated. */
static bool keep_positions(const char *folder, const tl_surface *garment, double frame_rate, tl_error *error)
{
    char *path = tl_format("%s/garment.pc2", folder);
    tl_point_cache_writer *writer =
        tl_point_cache_create(path, garment->vertex_count, 1, 0, frame_rate, error);
    free(path);
    if (!writer)
        return false;
    tl_point_cache_add(writer, garment->positions);
    return tl_point_cache_commit(&writer, error);
}

static bool keep_surface(const char *folder, const tl_frame *frame, const char *name, tl_error *error)
{
    const tl_surface *surface = find_surface(frame, name);
    char *path = tl_format("%s/%s.glb", folder, name);
    bool kept = !surface || tl_model_export_glb(path, surface, 1, error);
    free(path);
    return kept;
}

static bool keep_environment(const char *folder, const tl_environment *environment, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B"};
    char *path = tl_format("%s/environment.exr", folder);
    bool kept = tl_exr_save(path, &(struct tl_exr_layer){channels, &environment->image}, 1, error);
    free(path);
    return kept;
}

bool tl_check_keep(const char *folder, struct tl_headless *headless, const struct tl_checked *checked,
                   const struct tl_finding *broken, tl_error *error)
{
    const tl_surface *garment = find_surface(checked->frame, "garment");
    struct tl_settings run = headless->settings;
    root(&run);
    struct tl_settings still = run;
    make_still(checked->frame, &still);
    if (!tl_folder_make(folder, error) || !tl_folder_print(folder, "run.yaml", &run, print_settings, error) ||
        !tl_folder_print(folder, "scene.yaml", &still, print_settings, error) ||
        !keep_environment(folder, checked->frame->environment, error) ||
        !keep_picture(folder, headless, checked, broken, error))
        return false;
    /* Files with NaN positions are refused; the others are kept. */
    tl_error refused = {0};
    if (!keep_surface(folder, checked->frame, "garment", &refused) ||
        !keep_surface(folder, checked->frame, "avatar", &refused) ||
        (garment && !keep_positions(folder, garment, headless->settings.cloth.frame_rate, &refused)))
        tl_warn("%s", refused.message);
    return true;
}
