/* What the commands of the review window do. */
#include "app/orbit.h"
#include "app/review.h"
#include "assets/exr.h"
#include "assets/point_cache.h"
#include "config/embedded.h"
#include "config/file.h"
#include "config/log.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

#define ENVIRONMENT_STEP_DEG 15.0f

static void play(struct tl_review *review)
{
    review->playing = !review->playing;
    review->next_step_s = tl_clock_s();
    tl_info("view: %s at frame %d", review->playing ? "plays" : "paused",
            tl_session_frame_number(review->session));
}

static void step(struct tl_review *review)
{
    tl_error error;
    review->playing = false;
    if (!tl_session_advance(review->session, &error))
        tl_review_complain(review, &error);
    review->image_is_old = true;
    tl_info("view: frame %d", tl_session_frame_number(review->session));
}

static void reset(struct tl_review *review)
{
    tl_error error;
    if (!tl_session_reset(review->session, &error))
        tl_review_complain(review, &error);
    review->image_is_old = true;
    tl_info("view: reset");
}

static void pin(struct tl_review *review)
{
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (!cloth)
        return;
    if (review->drag == TL_DRAG_CLOTH) {
        tl_cloth_release(cloth);
        tl_cloth_pin(cloth, review->grab_vertex);
        review->drag = TL_DRAG_NONE;
        tl_review_say(review, "pinned: P takes the pins out again");
    } else {
        tl_review_say(review, "%zu pins taken out", tl_cloth_unpin(cloth));
    }
}

void tl_review_know_environment(struct tl_review *review, const char *name)
{
    for (size_t i = 0; i < review->environment_count; i++)
        if (strcmp(review->environments[i], name) == 0)
            return;
    size_t count = review->environment_count + 1;
    review->environments = tl_resize(review->environments, count, sizeof *review->environments);
    review->environments[review->environment_count++] = tl_copy_string(name);
}

/* Sets one option as if it had been typed. */
static bool set_option(struct tl_review *review, const char *key, const char *text)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&review->wanted, bindings);
    tl_error error;
    if (!tl_options_set(bindings, TL_SETTINGS_TABLES, key, text, "view", NULL, &error)) {
        tl_review_complain(review, &error);
        return false;
    }
    review->changed = true;
    return true;
}

static void next_environment(struct tl_review *review)
{
    size_t next = 0;
    for (size_t i = 0; i < review->environment_count; i++)
        if (strcmp(review->environments[i], review->wanted.scene.environment) == 0)
            next = (i + 1) % review->environment_count;
    if (review->environment_count < 2)
        tl_review_say(review, "there is one environment only: drop an .exr or .hdr file here to add one");
    else
        set_option(review, "scene.environment", review->environments[next]);
}

static void turn_environment(struct tl_review *review, float by_deg)
{
    float *yaw_deg = &review->wanted.scene.environment_yaw_deg;
    *yaw_deg = tl_orbit_wrap_deg(*yaw_deg + by_deg);
    review->changed = true;
    tl_info("view: environment at %g degrees", (double)*yaw_deg);
}

/* The first name in the folder that is not taken. New string. */
static char *free_name(const struct tl_review *review, const char *extension)
{
    for (int number = 1;; number++) {
        char *path = tl_format("%s/toile-%04d.%s", review->screenshot_folder, number, extension);
        if (!tl_file_exists(path))
            return path;
        free(path);
    }
}

static bool save_linear(struct tl_review *review, const char *path, tl_image *image, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B", "A"};
    return tl_renderer_read(review->renderer, image, error) &&
           tl_exr_save(path, &(struct tl_exr_layer){.channel_names = channels, .image = image}, 1, error);
}

static bool save_shown(struct tl_review *review, const char *path, tl_image *image, tl_error *error)
{
    return tl_renderer_show_image(review->renderer, image, error) && tl_image_save_png(path, image, error);
}

static void screenshot(struct tl_review *review, bool linear)
{
    tl_error error;
    tl_image image = {0};
    char *path = free_name(review, linear ? "exr" : "png");
    bool saved = tl_folder_make(review->screenshot_folder, &error) && tl_review_draw_sharp(review, &error) &&
                 (linear ? save_linear : save_shown)(review, path, &image, &error);
    if (saved)
        tl_review_say(review, "screenshot saved: %s", path);
    else
        tl_review_complain(review, &error);
    tl_image_release(&image);
    free(path);
}

static void forget_dropped(struct tl_review *review)
{
    free(review->dropped);
    review->dropped = NULL;
}

static void back(struct tl_review *review)
{
    if (review->dropped)
        forget_dropped(review);
    else if (review->help_shown)
        review->help_shown = false;
    else
        review->closing = true;
}

/* Takes over what a name or file stands for: tl_settings_apply_fabric or _preset. */
static void apply_named(struct tl_review *review,
                        bool (*apply)(struct tl_settings *settings, const char *name, tl_error *error),
                        const char *name)
{
    tl_error error;
    char *copy = tl_copy_string(name); /* the name may lie within the settings that it changes */
    if (apply(&review->wanted, copy, &error)) {
        review->changed = true;
    } else {
        tl_review_complain(review, &error);
        review->wanted = review->good;
    }
    free(copy);
}

void tl_review_layer(struct tl_review *review)
{
    if (strcmp(review->wanted.scene.fabric, review->good.scene.fabric) != 0)
        apply_named(review, tl_settings_apply_fabric, review->wanted.scene.fabric);
    if (strcmp(review->wanted.scene.preset, review->good.scene.preset) != 0)
        apply_named(review, tl_settings_apply_preset, review->wanted.scene.preset);
}

static void choose_fabric(struct tl_review *review, int index)
{
    for (int i = 0; tl_embedded_fabrics_names[i]; i++)
        if (i == index)
            apply_named(review, tl_settings_apply_fabric, tl_embedded_fabrics_names[i]);
}

static void use_scene(struct tl_review *review, const char *path)
{
    tl_error error;
    struct tl_settings loaded;
    if (!tl_settings_load(&loaded, &(struct tl_settings_source){.scene_file = path}, &error)) {
        tl_review_complain(review, &error);
        return;
    }
    review->wanted = loaded;
    review->changed = true;
}

/* The answer to what the dropped file is. */
static void use_dropped(struct tl_review *review, int command)
{
    char *path = review->dropped;
    review->dropped = NULL;
    if (!path)
        return;
    switch (command) {
    case TL_REVIEW_USE_GARMENT:
        set_option(review, "scene.garment", path);
        break;
    case TL_REVIEW_USE_AVATAR:
        set_option(review, "scene.avatar", path);
        break;
    case TL_REVIEW_USE_SCENE:
        use_scene(review, path);
        break;
    case TL_REVIEW_USE_FABRIC:
        apply_named(review, tl_settings_apply_fabric, path);
        break;
    case TL_REVIEW_USE_PRESET:
        apply_named(review, tl_settings_apply_preset, path);
        break;
    default:
        break;
    }
    free(path);
}

void tl_review_drop(struct tl_review *review, const char *path)
{
    forget_dropped(review);
    if (tl_path_has_extension(path, "exr") || tl_path_has_extension(path, "hdr")) {
        set_option(review, "scene.environment", path);
    } else if (tl_point_cache_is_file(path)) {
        set_option(review, "scene.motion", path);
    } else if (tl_model_is_file(path) || tl_path_has_extension(path, "yaml") ||
               tl_path_has_extension(path, "yml")) {
        review->dropped = tl_copy_string(path);
    } else {
        tl_error error;
        tl_fail(&error, TL_INPUT,
                "%s: cannot be used here: drop a .glb, .gltf, .obj, .pc2, .mdd, .exr, .hdr or .yaml file",
                path);
        tl_review_complain(review, &error);
    }
}

void tl_review_act(struct tl_review *review, int command)
{
    switch (command) {
    case TL_REVIEW_PLAY:
        play(review);
        break;
    case TL_REVIEW_STEP:
        step(review);
        break;
    case TL_REVIEW_RESET:
        reset(review);
        break;
    case TL_REVIEW_FRAME_ALL:
        review->wanted.camera.distance_m = 0;
        review->changed = true;
        break;
    case TL_REVIEW_NEXT_ENVIRONMENT:
        next_environment(review);
        break;
    case TL_REVIEW_TURN_LEFT:
        turn_environment(review, ENVIRONMENT_STEP_DEG);
        break;
    case TL_REVIEW_TURN_RIGHT:
        turn_environment(review, -ENVIRONMENT_STEP_DEG);
        break;
    case TL_REVIEW_SCREENSHOT:
        screenshot(review, false);
        break;
    case TL_REVIEW_SCREENSHOT_LINEAR:
        screenshot(review, true);
        break;
    case TL_REVIEW_PIN:
        pin(review);
        break;
    case TL_REVIEW_PANEL:
        review->panel_hidden = !review->panel_hidden;
        review->changed = true; /* the picture's size */
        break;
    case TL_REVIEW_HELP:
        review->help_shown = !review->help_shown;
        break;
    case TL_REVIEW_BACK:
        back(review);
        break;
    case TL_REVIEW_QUIT:
        review->closing = true;
        break;
    default:
        if (command >= TL_REVIEW_FABRIC)
            choose_fabric(review, command - TL_REVIEW_FABRIC);
        else
            use_dropped(review, command);
        break;
    }
}
