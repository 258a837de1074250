/* What the commands of the review window do. */
#include "app/orbit.h"
#include "app/view.h"
#include "assets/exr.h"
#include "config/embedded.h"
#include "config/file.h"
#include "config/log.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

#define ENVIRONMENT_STEP_DEG 15.0f

static void play(struct tl_view *view)
{
    view->playing = !view->playing;
    view->next_step_s = tl_clock_s();
    tl_info("view: %s at frame %d", view->playing ? "plays" : "paused",
            tl_session_frame_number(view->session));
}

static void step(struct tl_view *view)
{
    tl_error error;
    view->playing = false;
    if (!tl_session_advance(view->session, &error))
        tl_view_complain(view, &error);
    view->image_is_old = true;
    tl_info("view: frame %d", tl_session_frame_number(view->session));
}

static void reset(struct tl_view *view)
{
    tl_error error;
    if (!tl_session_reset(view->session, &error))
        tl_view_complain(view, &error);
    view->image_is_old = true;
    tl_info("view: reset");
}

void tl_view_know_environment(struct tl_view *view, const char *name)
{
    for (size_t i = 0; i < view->environment_count; i++)
        if (strcmp(view->environments[i], name) == 0)
            return;
    size_t count = view->environment_count + 1;
    view->environments = tl_resize(view->environments, count, sizeof *view->environments);
    view->environments[view->environment_count++] = tl_copy_string(name);
}

/* Sets one option as if it had been typed. */
static bool set_option(struct tl_view *view, const char *key, const char *text)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&view->wanted, bindings);
    tl_error error;
    if (!tl_options_set(bindings, TL_SETTINGS_TABLES, key, text, "view", NULL, &error)) {
        tl_view_complain(view, &error);
        return false;
    }
    view->changed = true;
    return true;
}

static void next_environment(struct tl_view *view)
{
    size_t next = 0;
    for (size_t i = 0; i < view->environment_count; i++)
        if (strcmp(view->environments[i], view->wanted.scene.environment) == 0)
            next = (i + 1) % view->environment_count;
    if (view->environment_count < 2)
        tl_view_say(view, "there is one environment only: drop an .exr or .hdr file here to add one");
    else
        set_option(view, "scene.environment", view->environments[next]);
}

static void turn_environment(struct tl_view *view, float by_deg)
{
    float *yaw_deg = &view->wanted.scene.environment_yaw_deg;
    *yaw_deg = tl_orbit_wrap_deg(*yaw_deg + by_deg);
    view->changed = true;
    tl_info("view: environment at %g degrees", (double)*yaw_deg);
}

/* The first name in the folder that is not taken. New string. */
static char *free_name(const struct tl_view *view, const char *extension)
{
    for (int number = 1;; number++) {
        char *path = tl_format("%s/toile-%04d.%s", view->screenshot_folder, number, extension);
        if (!tl_file_exists(path))
            return path;
        free(path);
    }
}

static bool save_linear(struct tl_view *view, const char *path, tl_image *image, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B", "A"};
    return tl_renderer_read(view->renderer, image, error) &&
           tl_exr_save(path, &(struct tl_exr_layer){.channel_names = channels, .image = image}, 1, error);
}

static bool save_shown(struct tl_view *view, const char *path, tl_image *image, tl_error *error)
{
    return tl_renderer_show_image(view->renderer, image, error) && tl_image_save_png(path, image, error);
}

static void screenshot(struct tl_view *view, bool linear)
{
    tl_error error;
    tl_image image = {0};
    char *path = free_name(view, linear ? "exr" : "png");
    bool saved = tl_folder_make(view->screenshot_folder, &error) && tl_view_draw_sharp(view, &error) &&
                 (linear ? save_linear : save_shown)(view, path, &image, &error);
    if (saved)
        tl_view_say(view, "screenshot saved: %s", path);
    else
        tl_view_complain(view, &error);
    tl_image_release(&image);
    free(path);
}

static void forget_dropped(struct tl_view *view)
{
    free(view->dropped);
    view->dropped = NULL;
}

static void back(struct tl_view *view)
{
    if (view->dropped)
        forget_dropped(view);
    else if (view->help_shown)
        view->help_shown = false;
    else
        view->closing = true;
}

/* Takes over what a name or file stands for: tl_settings_apply_fabric or _preset. */
static void apply_named(struct tl_view *view,
                        bool (*apply)(struct tl_settings *settings, const char *name, tl_error *error),
                        const char *name)
{
    tl_error error;
    char *copy = tl_copy_string(name); /* the name may lie within the settings that it changes */
    if (apply(&view->wanted, copy, &error)) {
        view->changed = true;
    } else {
        tl_view_complain(view, &error);
        view->wanted = view->good;
    }
    free(copy);
}

void tl_view_layer(struct tl_view *view)
{
    if (strcmp(view->wanted.scene.fabric, view->good.scene.fabric) != 0)
        apply_named(view, tl_settings_apply_fabric, view->wanted.scene.fabric);
    if (strcmp(view->wanted.scene.preset, view->good.scene.preset) != 0)
        apply_named(view, tl_settings_apply_preset, view->wanted.scene.preset);
}

static void choose_fabric(struct tl_view *view, int index)
{
    for (int i = 0; tl_embedded_fabrics_names[i]; i++)
        if (i == index)
            apply_named(view, tl_settings_apply_fabric, tl_embedded_fabrics_names[i]);
}

static void use_scene(struct tl_view *view, const char *path)
{
    tl_error error;
    struct tl_settings loaded;
    if (!tl_settings_load(&loaded, &(struct tl_settings_source){.scene_file = path}, &error)) {
        tl_view_complain(view, &error);
        return;
    }
    view->wanted = loaded;
    view->changed = true;
}

/* The answer to what the dropped file is. */
static void use_dropped(struct tl_view *view, int command)
{
    char *path = view->dropped;
    view->dropped = NULL;
    if (!path)
        return;
    switch (command) {
    case TL_VIEW_USE_GARMENT:
        set_option(view, "scene.garment", path);
        break;
    case TL_VIEW_USE_AVATAR:
        set_option(view, "scene.avatar", path);
        break;
    case TL_VIEW_USE_SCENE:
        use_scene(view, path);
        break;
    case TL_VIEW_USE_FABRIC:
        apply_named(view, tl_settings_apply_fabric, path);
        break;
    case TL_VIEW_USE_PRESET:
        apply_named(view, tl_settings_apply_preset, path);
        break;
    default:
        break;
    }
    free(path);
}

void tl_view_drop(struct tl_view *view, const char *path)
{
    forget_dropped(view);
    if (tl_path_has_extension(path, "exr") || tl_path_has_extension(path, "hdr")) {
        set_option(view, "scene.environment", path);
    } else if (tl_path_has_extension(path, "glb") || tl_path_has_extension(path, "gltf") ||
               tl_path_has_extension(path, "yaml") || tl_path_has_extension(path, "yml")) {
        view->dropped = tl_copy_string(path);
    } else {
        tl_error error;
        tl_fail(&error, TL_INPUT, "%s: cannot be used here: drop a .glb, .gltf, .exr, .hdr or .yaml file",
                path);
        tl_view_complain(view, &error);
    }
}

void tl_view_act(struct tl_view *view, int command)
{
    switch (command) {
    case TL_VIEW_PLAY:
        play(view);
        break;
    case TL_VIEW_STEP:
        step(view);
        break;
    case TL_VIEW_RESET:
        reset(view);
        break;
    case TL_VIEW_FRAME_ALL:
        view->wanted.camera.distance_m = 0;
        view->changed = true;
        break;
    case TL_VIEW_NEXT_ENVIRONMENT:
        next_environment(view);
        break;
    case TL_VIEW_TURN_LEFT:
        turn_environment(view, ENVIRONMENT_STEP_DEG);
        break;
    case TL_VIEW_TURN_RIGHT:
        turn_environment(view, -ENVIRONMENT_STEP_DEG);
        break;
    case TL_VIEW_SCREENSHOT:
        screenshot(view, false);
        break;
    case TL_VIEW_SCREENSHOT_LINEAR:
        screenshot(view, true);
        break;
    case TL_VIEW_PANEL:
        view->panel_hidden = !view->panel_hidden;
        view->changed = true; /* the picture's size */
        break;
    case TL_VIEW_HELP:
        view->help_shown = !view->help_shown;
        break;
    case TL_VIEW_BACK:
        back(view);
        break;
    case TL_VIEW_QUIT:
        view->closing = true;
        break;
    default:
        if (command >= TL_VIEW_FABRIC)
            choose_fabric(view, command - TL_VIEW_FABRIC);
        else
            use_dropped(view, command);
        break;
    }
}
