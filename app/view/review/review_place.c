#include "app/view/review/review_place.h"

#include "app/scene/orbit.h"
#include "app/view/review/review.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_reading.h"
#include "assets/base/placing.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- The options ---- */

static struct tl_placing placing_of(const struct tl_scene_params *scene)
{
    return (struct tl_placing){.scale = scene->scale,
                               .turn_deg = scene->turn_deg,
                               .move_m = {{scene->move_m[0], scene->move_m[1], scene->move_m[2]}}};
}

/* In steps that are smaller than a pixel, so that the options stay short; + 0 makes a 0 of -0, which would
 * print its sign. */
static float in_steps(float value, float steps_per_unit)
{
    return roundf(value * steps_per_unit) / steps_per_unit + 0.0f;
}

static void set_placing(struct tl_review *review, const struct tl_placing *placing)
{
    struct tl_scene_params *scene = &review->wanted.scene;
    scene->scale = glm_clamp(placing->scale, 0.001f, 1000);
    scene->turn_deg = tl_orbit_wrap_deg(placing->turn_deg);
    for (int i = 0; i < 3; i++)
        scene->move_m[i] = glm_clamp(in_steps(placing->move_m.raw[i], 1e4f), -1000, 1000);
    tl_review_mark_changed(review);
    tl_review_note_motion(review);
}

static const char *reason_against(const struct tl_review *review)
{
    if (!tl_review_has_units(review, TL_READING_GARMENT))
        return "only a garment from a file can be moved: others are cut to their body";
    if (strcmp(review->wanted.scene.motion, "none") != 0)
        return "a motion plays where it was recorded: the garment cannot be moved";
    return NULL;
}

static struct tl_box box_of_garment(const struct tl_review *review)
{
    const tl_mesh *mesh = &tl_session_garment(review->session)->mesh;
    return tl_box_of(mesh->positions, mesh->vertex_count);
}

/* The intended middle of the garment, while the session may still have it elsewhere. */
static vec3s wanted_middle(const struct tl_review *review)
{
    struct tl_box box = box_of_garment(review);
    vec3s middle = glms_vec3_lerp(box.lower, box.upper, 0.5f);
    middle.y -= tl_session_lifted_m(review->session);
    const struct tl_placing shown = placing_of(&tl_session_settings(review->session)->scene);
    const struct tl_placing wanted = placing_of(&review->wanted.scene);
    return tl_placing_point(&wanted, tl_placing_origin(&shown, middle));
}

void tl_review_follow_place(struct tl_review *review)
{
    const struct tl_scene_params *shown = &tl_session_settings(review->session)->scene;
    const struct tl_scene_params *wanted = &review->wanted.scene;
    const struct tl_placing from = placing_of(shown), to = placing_of(wanted);
    bool is_same = strcmp(shown->garment, wanted->garment) == 0 && !reason_against(review);
    const struct tl_placing between = tl_placing_between(&from, is_same ? &to : &from);
    if (tl_session_show_placed(review->session, &between))
        tl_review_mark_old(review);
}

/* ---- The handles ---- */

static struct tl_gizmo gizmo_of(const struct tl_review *review)
{
    struct tl_gizmo gizmo = {.camera = tl_session_frame(review->session).camera,
                             .scale = tl_window_scale(review->screen.window),
                             .pivot = wanted_middle(review),
                             .stretch = 1};
    gizmo.pivot.y += tl_session_lifted_m(review->session);
    tl_review_size(review, &gizmo.width, &gizmo.height);
    return gizmo;
}

static bool has_handles(const struct tl_review *review)
{
    return review->placing.shown && !reason_against(review);
}

void tl_review_place_toggle(struct tl_review *review)
{
    struct tl_review_placing *placing = &review->placing;
    const char *reason = reason_against(review);
    if (reason && !placing->shown) {
        tl_review_report(review, "%s", reason);
        return;
    }
    placing->shown = !placing->shown;
    tl_review_place_hover(review, review->input.x, review->input.y);
    tl_review_report(review, placing->shown ? "arrows move the garment, the ring turns it, the box sizes it; "
                                              "Shift: fine, Ctrl: in steps, Esc: back"
                                            : "hides the handles");
}

bool tl_review_place_hide(struct tl_review *review)
{
    bool was_shown = review->placing.shown;
    if (was_shown)
        tl_review_place_toggle(review);
    return was_shown;
}

void tl_review_place_hover(struct tl_review *review, float x, float y)
{
    review->placing.under = TL_GIZMO_NONE;
    if (has_handles(review) && !tl_panel_wants_pointer(review->screen.panel, x, y)) {
        const struct tl_gizmo gizmo = gizmo_of(review);
        review->placing.under = tl_gizmo_under(&gizmo, (vec2s){{x, y}});
    }
}

static void begin(struct tl_review *review, enum tl_gizmo_handle handle, float x, float y)
{
    struct tl_review_placing *placing = &review->placing;
    tl_review_fix_camera(review); /* which follows a scene that it frames */
    tl_review_set_drag(review, TL_DRAG_PLACE);
    placing->held = handle;
    placing->gizmo = gizmo_of(review);
    placing->before = placing_of(&review->wanted.scene);
    placing->from = placing->to = (vec2s){{x, y}};
    placing->change = (struct tl_gizmo_change){.factor = 1};
    if (review->play.is_on)
        tl_review_set_playing(review, false);
}

bool tl_review_place_catch(struct tl_review *review, float x, float y)
{
    tl_review_place_hover(review, x, y);
    enum tl_gizmo_handle handle = review->placing.under;
    if (handle != TL_GIZMO_NONE)
        begin(review, handle, x, y);
    review->placing.is_anywhere = false;
    return handle != TL_GIZMO_NONE;
}

bool tl_review_place_begin(struct tl_review *review, float x, float y, bool turns)
{
    const char *reason = reason_against(review);
    if (reason)
        tl_review_report(review, "%s", reason);
    else
        begin(review, turns ? TL_GIZMO_NONE : TL_GIZMO_VIEW, x, y);
    review->placing.is_anywhere = true;
    return !reason;
}

void tl_review_place_drag(struct tl_review *review, float dx, float dy, int modifiers)
{
    struct tl_review_placing *placing = &review->placing;
    const float steps_per_degree = 10, steps_of_size = 1000;
    bool is_fine = !placing->is_anywhere && (modifiers & GLFW_MOD_SHIFT);
    bool snaps = !placing->is_anywhere && (modifiers & GLFW_MOD_CONTROL);
    placing->to = glms_vec2_muladds((vec2s){{dx, dy}}, is_fine ? 0.1f : 1, placing->to);
    struct tl_gizmo_change change = tl_gizmo_drag(&placing->gizmo, placing->held, placing->from, placing->to);
    change.turn_deg = in_steps(change.turn_deg, steps_per_degree);
    change.factor = in_steps(change.factor, steps_of_size);
    placing->change = snaps ? tl_gizmo_snap(&change) : change;
    vec3s middle = placing->gizmo.pivot;
    middle.y -= tl_session_lifted_m(review->session);
    struct tl_placing wanted =
        tl_placing_about(&placing->before, middle, placing->change.turn_deg, placing->change.factor);
    wanted.move_m = glms_vec3_add(wanted.move_m, placing->change.move_m);
    set_placing(review, &wanted);
}

void tl_review_place_turn(struct tl_review *review, float dx)
{
    const float degrees_per_height = 180;
    const struct tl_placing placing = placing_of(&review->wanted.scene);
    const struct tl_placing turned =
        tl_placing_about(&placing, wanted_middle(review), roundf(dx * degrees_per_height * 10) / 10, 1);
    set_placing(review, &turned);
}

void tl_review_place_scale(struct tl_review *review, float factor)
{
    const struct tl_placing placing = placing_of(&review->wanted.scene);
    const struct tl_placing sized = tl_placing_about(&placing, wanted_middle(review), 0, factor);
    set_placing(review, &sized);
}

void tl_review_place_end(struct tl_review *review)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    if (review->input.drag != TL_DRAG_PLACE)
        return;
    tl_review_set_drag(review, TL_DRAG_NONE);
    review->placing.held = TL_GIZMO_NONE;
    tl_review_mark_changed(review);
    tl_review_report(review, "--move %g,%g,%g --turn %g --scale %g", (double)scene->move_m[0],
                     (double)scene->move_m[1], (double)scene->move_m[2], (double)scene->turn_deg,
                     (double)scene->scale);
}

bool tl_review_place_cancel(struct tl_review *review)
{
    if (review->input.drag != TL_DRAG_PLACE)
        return false;
    set_placing(review, &review->placing.before);
    tl_review_set_drag(review, TL_DRAG_NONE);
    review->placing.held = TL_GIZMO_NONE;
    tl_review_report(review, "the garment stays where it was");
    return true;
}

/* ---- Display ---- */

void tl_review_place_shapes(const struct tl_review *review, struct tl_gizmo_shapes *out)
{
    const struct tl_review_placing *placing = &review->placing;
    bool is_held = placing->held != TL_GIZMO_NONE;
    out->count = 0;
    if (!has_handles(review))
        return;
    struct tl_gizmo gizmo = gizmo_of(review);
    gizmo.stretch = is_held ? placing->change.factor : 1;
    tl_gizmo_list_shapes(&gizmo, is_held ? placing->held : placing->under, is_held, out);
}

void tl_review_place_amount(const struct tl_review *review, char *text, size_t size)
{
    const struct tl_review_placing *placing = &review->placing;
    const struct tl_gizmo_change *change = &placing->change;
    const double mm = 1000;
    text[0] = '\0';
    switch (placing->held) {
    case TL_GIZMO_X:
    case TL_GIZMO_Y:
    case TL_GIZMO_Z:
        snprintf(text, size, "%c %+.1f mm", "XYZ"[placing->held - TL_GIZMO_X],
                 mm * (double)change -> move_m.raw[placing->held - TL_GIZMO_X]);
        break;
    case TL_GIZMO_VIEW:
        snprintf(text, size, "X %+.1f, Y %+.1f, Z %+.1f mm", mm * (double)change->move_m.x,
                 mm * (double)change->move_m.y, mm * (double)change->move_m.z);
        break;
    case TL_GIZMO_TURN:
        snprintf(text, size, "%+.1f\u00b0", (double)change->turn_deg);
        break;
    case TL_GIZMO_SIZE: {
        struct tl_box box = box_of_garment(review);
        float shown_scale = tl_session_settings(review->session)->scene.scale;
        snprintf(text, size, "\u00d7 %.3f: %.3f m high", (double)change->factor,
                 (double)((box.upper.y - box.lower.y) / shown_scale * review->wanted.scene.scale));
        break;
    }
    case TL_GIZMO_NONE:
    case TL_GIZMO_COUNT:
        break;
    }
}
