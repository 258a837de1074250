#include "app/view/review/review_move.h"

#include "app/scene/camera.h"
#include "app/scene/orbit.h"
#include "app/view/review/review.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

#define GLIDE_S        0.6
#define KEY_INTERVAL_S 2.0 /* between keys that are added by hand */
#define RECORD_EVERY_S 0.2

void tl_review_fix_camera(struct tl_review *review)
{
    struct tl_camera camera = tl_session_frame(review->session).camera;
    if (!tl_camera_is_placed(&review->wanted.camera))
        tl_orbit_take(&review->wanted.camera, &camera);
}

void tl_review_stop_moving(struct tl_review *review)
{
    if (review->path.plays)
        tl_info("view: path stopped");
    review->motion.glides = review->path.plays = false;
}

void tl_review_toggle(struct tl_review *review, bool *turntable, const char *name)
{
    if (!tl_review_moves_itself(review))
        review->motion.moved_s = tl_clock_s();
    *turntable = !*turntable;
    tl_review_report(review, "%s %s", name, *turntable ? "turns" : "stands");
}

void tl_review_go_to_view(struct tl_review *review, int index)
{
    const struct tl_saved_view *view = &review->keep.views.of[index];
    struct tl_review_motion *motion = &review->motion;
    if (!view->saved) {
        tl_review_report(review, "view %d is empty: Shift+%d saves this one", index + 1, index + 1);
        return;
    }
    tl_review_stop_moving(review);
    tl_review_fix_camera(review);
    motion->from = tl_saved_view_take(&review->wanted);
    motion->to = *view;
    motion->glides = true;
    motion->glide_began_s = tl_clock_s();
    tl_review_report(review, "view %d", index + 1);
}

void tl_review_go_to_frame(struct tl_review *review, int frame)
{
    tl_error error;
    review->play.is_on = false;
    if (!tl_session_go_to(review->session, frame, &error))
        tl_review_report_error(review, &error);
    tl_review_mark_old(review);
    tl_review_note_motion(review);
    tl_info("view: frame %d", tl_session_frame_number(review->session));
}

static void glide(struct tl_review *review, double now_s)
{
    struct tl_review_motion *motion = &review->motion;
    float share = (float)fmin((now_s - motion->glide_began_s) / GLIDE_S, 1);
    struct tl_saved_view at = tl_saved_view_between(&motion->from, &motion->to, share);
    tl_saved_view_apply(&at, &review->wanted);
    motion->glides = share < 1;
}

static void follow_path(struct tl_review *review, double now_s)
{
    double time_s = now_s - review->path.began_s;
    struct tl_path_key key = tl_path_at(&review->path.path, time_s);
    review->wanted.camera = key.camera;
    review->wanted.camera.yaw_deg = tl_orbit_wrap_deg(key.camera.yaw_deg);
    review->wanted.scene.environment_yaw_deg = tl_orbit_wrap_deg(key.environment_yaw_deg);
    if (time_s >= tl_path_length_s(&review->path.path)) {
        review->path.plays = false;
        tl_review_report(review, "path played");
    }
}

/* Angles continue from the previous key by the shorter way, so that a path through 180 degrees does not turn
 * back. */
static void add_key(struct tl_review *review, double time_s)
{
    tl_review_fix_camera(review);
    struct tl_path *path = &review->path.path;
    struct tl_path_key key = {.time_s = time_s,
                              .camera = review->wanted.camera,
                              .environment_yaw_deg = review->wanted.scene.environment_yaw_deg};
    if (path->count > 0) {
        const struct tl_path_key *last = &path->keys[path->count - 1];
        float *yaw_deg = &key.camera.yaw_deg, *light_deg = &key.environment_yaw_deg;
        *yaw_deg = last->camera.yaw_deg + tl_orbit_wrap_deg(*yaw_deg - last->camera.yaw_deg);
        *light_deg = last->environment_yaw_deg + tl_orbit_wrap_deg(*light_deg - last->environment_yaw_deg);
    }
    tl_path_add(path, &key);
}

static void begin_path(struct tl_review *review)
{
    tl_review_path_release(&review->path);
    for (int number = 1; !review->path.file; number++) {
        char *name = tl_format("%s/toile-path-%04d.yaml", review->keep.output_folder, number);
        if (tl_file_exists(name))
            free(name);
        else
            review->path.file = name;
    }
}

static bool save_path(struct tl_review *review)
{
    tl_error error;
    bool saved = tl_folder_make(review->keep.output_folder, &error) &&
                 tl_path_save(review->path.file, &review->path.path, &error);
    if (!saved)
        tl_review_report_error(review, &error);
    return saved;
}

void tl_review_path_add(struct tl_review *review)
{
    struct tl_review_path *recorded = &review->path;
    tl_review_stop_moving(review);
    if (recorded->records) {
        tl_review_report(review, "keys are added automatically while a path is recorded: Shift+K ends it");
        return;
    }
    if (!recorded->file)
        begin_path(review);
    double time_s = recorded->path.count > 0 ? tl_path_length_s(&recorded->path) + KEY_INTERVAL_S : 0;
    add_key(review, time_s);
    if (save_path(review))
        tl_review_report(review, "key %zu, at %g s, of %s", recorded->path.count, time_s, recorded->file);
}

static void record(struct tl_review *review, double now_s)
{
    if (now_s < review->path.key_due_s)
        return;
    add_key(review, now_s - review->path.began_s);
    review->path.key_due_s = now_s + RECORD_EVERY_S;
}

void tl_review_path_record(struct tl_review *review)
{
    struct tl_review_path *recorded = &review->path;
    double now_s = tl_clock_s();
    if (!recorded->records) {
        begin_path(review);
        recorded->records = true;
        recorded->began_s = now_s;
        recorded->key_due_s = now_s + RECORD_EVERY_S;
        add_key(review, 0);
        tl_review_report(review, "records the camera path: Shift+K ends and saves it");
        return;
    }
    recorded->records = false;
    if (now_s - recorded->began_s > tl_path_length_s(&recorded->path))
        add_key(review, now_s - recorded->began_s);
    if (save_path(review))
        tl_review_report(review, "path of %.1f s saved: %s; L plays it", tl_path_length_s(&recorded->path),
                         recorded->file);
}

void tl_review_path_play(struct tl_review *review)
{
    struct tl_review_path *path = &review->path;
    if (path->plays) {
        tl_review_stop_moving(review);
    } else if (path->records || path->path.count < 2) {
        tl_review_report(review, path->records ? "end the recording first: Shift+K"
                                               : "there is no path yet: K adds a key, Shift+K records");
    } else {
        tl_review_stop_moving(review);
        path->plays = true;
        path->began_s = tl_clock_s();
        tl_review_report(review, "plays the path, %.1f s", tl_path_length_s(&path->path));
    }
}

void tl_review_path_release(struct tl_review_path *path)
{
    tl_path_release(&path->path);
    free(path->file);
    *path = (struct tl_review_path){0};
}

/* Seconds since the last step, limited: a window that was hidden for an hour does not catch up. */
static float step_length_s(struct tl_review_motion *motion, double now_s)
{
    const double max_s = 0.5;
    double passed = fmin(now_s - motion->moved_s, max_s);
    motion->moved_s = now_s;
    return (float)passed;
}

void tl_review_move(struct tl_review *review)
{
    struct tl_review_motion *motion = &review->motion;
    double now_s = tl_clock_s();
    if (tl_review_moves_itself(review)) {
        float step_s = step_length_s(motion, now_s);
        float *camera_deg = &review->wanted.camera.yaw_deg,
              *environment_deg = &review->wanted.scene.environment_yaw_deg;
        if (motion->glides)
            glide(review, now_s);
        if (review->path.plays)
            follow_path(review, now_s);
        if (motion->turntable)
            *camera_deg = tl_orbit_wrap_deg(*camera_deg + step_s * review->screen.params.turntable_deg_s);
        if (motion->environment)
            *environment_deg =
                tl_orbit_wrap_deg(*environment_deg + step_s * review->screen.params.environment_turn_deg_s);
        tl_review_mark_changed(review);
    }
    if (review->path.records)
        record(review, now_s);
}
