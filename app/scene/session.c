#include "app/scene/session.h"

#include "app/display/board.h"
#include "app/scene/drape.h"
#include "app/scene/inset_body.h"
#include "app/scene/session_internal.h"
#include "cloth/mesh/topology.h"
#include "cloth/self_contact/crossings.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/inspect/legend.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void pose_avatar(tl_session *session, double time_s)
{
    tl_model_pose(&session->avatar->model, session->clip, time_s, session->body.positions);
    tl_moving_update(&session->body);
    if (session->collider)
        tl_collider_move(session->collider, session->body.positions);
    if (session->inset)
        tl_inset_body_apply(session->inset, session->body.normals, session->body.positions,
                            session->avatar->model.mesh.vertex_count);
}

/* About the ground, onto which a garment without an avatar is lifted after it was placed. */
static void place_drawn(tl_session *session)
{
    struct tl_placing placing = session->shown_placed;
    struct tl_moving *dress = &session->dress;
    tl_mesh drawn = {.vertex_count = dress->model->mesh.vertex_count,
                     .positions = dress->positions,
                     .normals = dress->normals,
                     .tangents = dress->tangents};
    if (placing.scale == 0)
        return;
    placing.move_m.y += session->standing.lifted_m * (1 - placing.scale);
    tl_placing_apply(&placing, &drawn);
}

static void read_back_cloth(tl_session *session)
{
    tl_cloth_positions(session->cloth, session->dress.positions);
    tl_moving_update(&session->dress);
    place_drawn(session);
}

/* A garment from a file stands as its maker left it; panels with open seams have to be sewn first. */
static bool is_authored(const tl_session *session)
{
    const struct tl_scene_params *scene = &session->settings.scene;
    bool sewn = session->garment->seam_count == 0;
    return scene->drape == TL_DRAPE_AUTHORED ||
           (scene->drape == TL_DRAPE_AUTO && sewn && tl_option_is_file_name(scene->garment));
}

/* Nothing would hold up a garment that nobody wears and no pin holds: it is sewn and left in the air. */
static bool is_only_sewn(const tl_session *session)
{
    const struct tl_settings *settings = &session->settings;
    const tl_garment *garment = session->garment;
    bool pinned = garment->pin_count > 0 || settings->cloth.pin_above_m > 0 ||
                  settings->cloth.pin_colour != TL_PIN_NO_COLOUR;
    return settings->scene.drape == TL_DRAPE_AUTO && !session->avatar && garment->seam_count > 0 && !pinned;
}

/* Starts as authored: the cloth is not settled, and no image shows normals other than the file's before it
 * has moved. */
static void read_back_start(tl_session *session)
{
    if (!session->authored || tl_session_plays_clip(session)) {
        read_back_cloth(session);
        return;
    }
    tl_moving_restart_as_authored(&session->dress);
    place_drawn(session);
}

static bool drape(tl_session *session, tl_error *error)
{
    const struct tl_settings *settings = &session->settings;
    const struct tl_cloth_fabric fabric = tl_settings_fabric(settings);
    session->authored = is_authored(session);
    session->only_sewn = is_only_sewn(session);
    const tl_mesh *body = session->avatar ? &session->avatar->model.mesh : NULL;
    const struct tl_drape_request request = {
        .garment = session->garment,
        .avatar = session->avatar,
        .clip = session->clip,
        .fabric = &fabric,
        .params = &settings->cloth,
        .settles = !session->authored,
        .only_sewn = session->only_sewn,
        .options = tl_settings_hash(settings, (struct tl_option_filter){.any_of = TL_AFFECTS_DRAPE}),
        .inside = &session->standing.inside,
    };
    session->collider = tl_collider_create(body, settings->image.ground, error);
    if (!session->collider)
        return false;
    session->cloth = tl_drape(&request, session->collider, error);
    if (!session->cloth)
        return false;
    if (session->authored && body &&
        !(session->inset = tl_inset_body_find(&session->garment->model.mesh, body, error)))
        return false;
    tl_moving_create(&session->dress, &session->garment->model, tl_cloth_weld(session->cloth));
    read_back_start(session);
    return true;
}

static bool begin_cloth(tl_session *session, tl_error *error)
{
    if (!session->garment->solid)
        return drape(session, error);
    tl_moving_create(&session->dress, &session->garment->model, NULL);
    tl_moving_update(&session->dress);
    return true;
}

static bool play_back(tl_session *session, int number, tl_error *error)
{
    if (!tl_playback_pose(session->playback, &session->settings, number, session->dress.positions, error))
        return false;
    tl_moving_update(&session->dress);
    return true;
}

/* Reports a motion that reaches below the ground: other programs put the floor elsewhere. */
static void report_ground(const tl_session *session)
{
    const float noticed_m = 0.01f;
    float lowest_m = tl_playback_lowest(session->playback);
    if (session->settings.image.ground && lowest_m < -noticed_m)
        tl_info("%s: reaches %.2g m below the ground, which hides it there: image.ground=false leaves it out",
                session->settings.scene.motion, (double)-lowest_m);
}

/* Welds vertices by the motion's first sample: there a garment that was cut as panels has closed its seams.
 */
static bool begin_playback(tl_session *session, tl_error *error)
{
    const tl_model *model = &session->garment->model;
    session->playback = tl_playback_open(&session->settings, model, error);
    if (!session->playback)
        return false;
    vec3s *first = TL_NEW_ARRAY(vec3s, model->mesh.vertex_count);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, model->mesh.vertex_count);
    bool posed = tl_playback_pose(session->playback, &session->settings, 0, first, error);
    if (posed) {
        tl_weld_positions(first, model->mesh.vertex_count, weld);
        tl_moving_create(&session->dress, model, weld);
        posed = play_back(session, 0, error);
    }
    free(weld);
    free(first);
    if (posed)
        report_ground(session);
    return posed;
}

static struct tl_box box_of_moving(const struct tl_moving *moving)
{
    return tl_box_of(moving->positions, moving->model->mesh.vertex_count);
}

/* A body that stands out of its garment by less than this, as a share of the garment's height, is framed with
 * it: a head that is cut off looks like a mistake, the foot of a dress form does not. */
#define FRAMED_WITH_BODY 1.35f

/* A head that stands out of its garment by less than this is framed with it, for the same reason. */
#define FRAMED_WITH_HEAD 0.6f

/* Bounding box of garment and body. */
static struct tl_box box_of_scene(const tl_session *session)
{
    if (!session->garment || !session->avatar)
        return box_of_moving(session->garment ? &session->dress : &session->body);
    return tl_box_of_both(box_of_moving(&session->dress), box_of_moving(&session->body));
}

static void add_framed(struct tl_framing *framed, const struct tl_moving *moving)
{
    tl_framing_add(framed, moving->positions, moving->model->mesh.vertex_count);
}

/* The camera's subject: the garment, which is what is judged; without one, the body. */
static void frame_garment(tl_session *session)
{
    struct tl_box all = box_of_scene(session),
                  garment = session->garment ? box_of_moving(&session->dress) : all;
    bool with_body = !session->garment ||
                     all.upper.y - all.lower.y < FRAMED_WITH_BODY * (garment.upper.y - garment.lower.y);
    session->framed = (struct tl_framing){.share = with_body ? TL_CAMERA_BODY : TL_CAMERA_GARMENT};
    if (session->garment)
        add_framed(&session->framed, &session->dress);
    if (session->avatar && with_body)
        add_framed(&session->framed, &session->body);
    float above = all.upper.y - garment.upper.y, height = garment.upper.y - garment.lower.y;
    if (session->avatar && !with_body && above < FRAMED_WITH_HEAD * height)
        tl_framing_add_head(&session->framed, session->body.positions,
                            session->body.model->mesh.vertex_count);
}

struct tl_session_models tl_session_models(const tl_session *session)
{
    return (struct tl_session_models){
        .garment = session->garment ? &session->garment->model : NULL,
        .avatar = session->avatar ? &session->avatar->model : NULL,
    };
}

bool tl_session_make_appearance(const struct tl_session_models *models, const struct tl_settings *settings,
                                struct tl_appearance *out, tl_error *error)
{
    return tl_appearance_make(settings, models->garment, models->avatar, out, error);
}

/* Checks the files before anything is made: the built-in form alone takes half a second. */
static bool check_files(const struct tl_scene_params *scene, tl_error *error)
{
    const char *names[] = {scene->garment, scene->avatar};
    for (size_t i = 0; i < TL_COUNT(names); i++)
        if (tl_option_is_file_name(names[i]) && !tl_file_check(names[i], error))
            return false;
    return true;
}

static bool load_models(tl_session *session, tl_error *error)
{
    struct tl_settings *settings = &session->settings;
    tl_model loaded;
    const bool done = tl_scene_decide(&settings->scene, &loaded, error) &&
                      tl_scene_load_avatar(settings, &loaded, &session->avatar, &session->clip, error) &&
                      tl_scene_load_garment(settings, &loaded, session->avatar, &session->garment,
                                            &session->standing, error);
    tl_model_release(&loaded);
    return done;
}

static bool load_all(tl_session *session, tl_error *error)
{
    const struct tl_settings *settings = &session->settings;
    if (!check_files(&settings->scene, error) ||
        !tl_moving_light_open(&session->light, settings->scene.environment, 0,
                              (double)settings->scene.environment_rate, error) ||
        !load_models(session, error))
        return false;
    if (!session->avatar && !session->garment)
        return tl_fail(error, TL_USAGE, "scene: neither a garment nor an avatar: name at least one");
    const struct tl_session_models models = tl_session_models(session);
    if (!tl_session_make_appearance(&models, settings, &session->appearance, error))
        return false;
    session->appearance_revision = ++session->appearances_made;
    if (session->avatar)
        tl_moving_create(&session->body, &session->avatar->model, NULL);
    if (session->garment) {
        if (tl_scene_plays_motion(&session->settings) ? !begin_playback(session, error)
                                                      : !begin_cloth(session, error))
            return false;
        if (!session->garment->solid)
            tl_moving_find_borders(&session->dress, session->garment);
    } else if (tl_scene_plays_motion(&session->settings)) {
        return tl_fail(error, TL_USAGE,
                       "scene.motion: there is no garment that could move: add --garment FILE");
    }
    if (tl_interrupted())
        return tl_fail(error, TL_INTERRUPTED, "stopped while the scene was made ready");
    if (session->avatar)
        pose_avatar(session, 0);
    frame_garment(session);
    return true;
}

tl_session *tl_session_create(const struct tl_settings *settings, tl_error *error)
{
    tl_session *session = TL_NEW(tl_session);
    session->settings = *settings;
    if (!load_all(session, error))
        tl_session_destroy(&session);
    return session;
}

void tl_session_destroy(tl_session **handle)
{
    tl_session *session = *handle;
    if (!session)
        return;
    if (session->ahead)
        tl_ahead_take(&session->ahead, NULL);
    tl_smoothed_release(&session->smoothed);
    tl_moving_release(&session->dress);
    tl_moving_release(&session->board);
    tl_moving_release(&session->body);
    tl_cloth_destroy(&session->cloth);
    tl_collider_destroy(&session->collider);
    tl_playback_close(&session->playback);
    if (session->garment)
        tl_garment_release(session->garment);
    if (session->avatar)
        tl_avatar_release(session->avatar);
    free(session->garment);
    free(session->avatar);
    tl_moving_light_release(&session->light);
    tl_strains_destroy(&session->strain.rest);
    free(session->strain.of_vertices);
    free(session->inset);
    free(session->crossed.triangles);
    tl_light_mesh_release(&session->cage.light_mesh);
    free(session->standing.size);
    free(session->standing.inside);
    tl_appearance_release(&session->appearance);
    for (size_t i = 0; i < TL_COUNT(session->spares); i++)
        tl_appearance_release(&session->spares[i].appearance);
    free(session);
    *handle = NULL;
}

/* Poses all that follows the clock alone. */
static bool pose_at(tl_session *session, int number, tl_error *error)
{
    const struct tl_settings *settings = &session->settings;
    if (!tl_moving_light_follow(&session->light, number / settings->cloth.frame_rate,
                                (double)settings->scene.environment_rate, error))
        return false;
    /* Without a clip the avatar stands still: its normals and the collider need no update. */
    if (session->clip >= 0)
        pose_avatar(session, number / session->settings.cloth.frame_rate);
    return !session->playback || play_back(session, number, error);
}

bool tl_session_steps_beside(const tl_session *session, bool card_draws)
{
    return card_draws && session->cloth && session->clip < 0 && sysconf(_SC_NPROCESSORS_ONLN) > 1;
}

bool tl_session_begin_step(tl_session *session)
{
    if (!session->cloth || session->clip >= 0 || session->ahead)
        return false;
    session->ahead = tl_ahead_begin(session->cloth, session->collider);
    return session->ahead != NULL;
}

void tl_session_end_step(tl_session *session)
{
    tl_ahead_wait(session->ahead);
}

static bool step_cloth(tl_session *session, tl_error *error)
{
    return session->ahead ? tl_ahead_take(&session->ahead, error)
                          : tl_cloth_step(session->cloth, session->collider, error);
}

bool tl_session_advance(tl_session *session, tl_error *error)
{
    if (!pose_at(session, session->frame + 1, error))
        return false;
    if (session->cloth) {
        if (!step_cloth(session, error))
            return false;
        read_back_cloth(session);
    }
    session->frame++;
    return true;
}

bool tl_session_take_step(tl_session *session, tl_error *error)
{
    return !session->ahead || tl_session_advance(session, error);
}

bool tl_session_reset(tl_session *session, tl_error *error)
{
    if (session->ahead)
        tl_ahead_take(&session->ahead, NULL);
    if (!tl_moving_light_follow(&session->light, 0, (double)session->settings.scene.environment_rate, error))
        return false;
    if (session->garment)
        tl_moving_restart(&session->dress);
    if (session->playback && !play_back(session, 0, error))
        return false;
    session->frame = 0;
    if (session->avatar) {
        pose_avatar(session, 0);
        tl_moving_restart(&session->body);
        pose_avatar(session, 0); /* twice: the collider then has no velocity */
    }
    if (session->cloth) {
        tl_cloth_reset(session->cloth);
        read_back_start(session);
    }
    return true;
}

/* Nothing depends on the frames before. */
static bool seek(tl_session *session, int number, tl_error *error)
{
    if (number == session->frame)
        return true;
    if (number == 0)
        return tl_session_reset(session, error);
    if (!pose_at(session, number, error))
        return false;
    session->frame = number;
    return true;
}

bool tl_session_go_to(tl_session *session, int number, tl_error *error)
{
    if (!session->cloth)
        return seek(session, number, error);
    if (number < session->frame && !tl_session_reset(session, error))
        return false;
    struct tl_progress progress = tl_progress_begin("simulating");
    int first = session->frame;
    bool done = true;
    while (done && session->frame < number) {
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stopped at frame %d", session->frame);
        else
            done = tl_session_advance(session, error);
        tl_progress_update(&progress, session->frame - first, number - first);
    }
    tl_progress_end(&progress);
    return done;
}

int tl_session_last_frame(const tl_session *session)
{
    double length_s = 0;
    if (session->cloth)
        return 0;
    if (session->clip >= 0)
        length_s = session->avatar->model.clips[session->clip].duration_s;
    if (session->playback)
        length_s = fmax(length_s, tl_playback_length_s(session->playback, &session->settings));
    double frames = length_s * session->settings.cloth.frame_rate;
    return (int)fmin(ceil(frames - 1e-6), INT_MAX);
}

int tl_session_frame_number(const tl_session *session)
{
    return session->frame;
}

const struct tl_settings *tl_session_settings(const tl_session *session)
{
    return &session->settings;
}

/* The strains of simulated cloth, while they are wanted or shown; else NULL. */
static const vec3s *strains_of_garment(tl_session *session)
{
    bool shown = session->strain.wanted || tl_view_is_strain(session->settings.image.view);
    if (!shown || session->garment->solid)
        return NULL;
    if (!session->strain.rest) {
        session->strain.rest = tl_strains_create(session->garment);
        session->strain.of_vertices = TL_NEW_ARRAY(vec3s, session->garment->model.mesh.vertex_count);
    }
    if (session->strain.revision != session->dress.motion_revision)
        tl_strains_update(session->strain.rest, session->dress.positions, session->strain.of_vertices);
    session->strain.revision = session->dress.motion_revision;
    return session->strain.of_vertices;
}

/* Marks the triangles [index_count / 3] that cross others. */
static void mark_crossed(const tl_mesh *mesh, const vec3s *positions, bool *crossed)
{
    struct tl_near_pairs pairs = {0};
    tl_crossings_of_mesh(mesh, positions, &pairs);
    memset(crossed, 0, mesh->index_count / 3 * sizeof *crossed);
    for (size_t i = 0; i < pairs.count; i++)
        crossed[pairs.pairs[i][0]] = crossed[pairs.pairs[i][1]] = true;
    tl_near_pairs_release(&pairs);
}

/* The garment's triangles that cross others, while the image shows them; else NULL. */
static const bool *crossed_of_garment(tl_session *session)
{
    const tl_mesh *mesh = &session->garment->model.mesh;
    if (session->settings.image.view != TL_VIEW_CROSSING)
        return NULL;
    if (!session->crossed.triangles)
        session->crossed.triangles = TL_NEW_ARRAY(bool, mesh->index_count / 3);
    if (session->crossed.revision != session->dress.motion_revision)
        mark_crossed(mesh, session->dress.positions, session->crossed.triangles);
    session->crossed.revision = session->dress.motion_revision;
    return session->crossed.triangles;
}

void tl_session_want_strains(tl_session *session, bool wanted)
{
    session->strain.wanted = wanted;
}

size_t tl_session_colourways(const tl_session *session, const char *const **names)
{
    *names = (const char *const *)session->appearance.names;
    return session->appearance.name_count;
}

/* NULL where nothing is sewn to scale. */
static const tl_borders *borders_of_garment(const tl_session *session)
{
    const tl_borders *borders = &session->dress.borders;
    bool is_shown = session->settings.construction.show == TL_CONSTRUCTION_ALWAYS || borders->is_to_scale;
    return is_shown && borders->border_count > 0 ? borders : NULL;
}

bool tl_session_has_pattern(const tl_session *session)
{
    return session->garment && session->garment->pattern && !session->garment->solid;
}

/* Whether frames have the pattern board, which is made first. */
static bool shows_board(tl_session *session)
{
    if (!session->settings.scene.pattern || !tl_session_has_pattern(session))
        return false;
    if (!session->board.model)
        tl_board_make(session->garment, box_of_scene(session), &session->board);
    return session->board.model != NULL;
}

static struct tl_framing framing_with_board(tl_session *session)
{
    if (!shows_board(session))
        return session->framed;
    return tl_framing_of_box(tl_box_of_both(box_of_moving(&session->board), session->framed.box),
                             TL_CAMERA_BODY);
}

/* The garment as it is drawn. What is played back, is no cloth or has not moved yet is drawn as its file has
 * it. */
static tl_surface smoothed(tl_session *session, const tl_surface *garment)
{
    struct tl_smoothed *smooth = &session->smoothed;
    if (!session->settings.scene.smooth || !session->cloth || garment->has_own_normals)
        return *garment;
    const struct tl_smoothed_cloth worn = {session->cloth, session->collider};
    if (!tl_smoothed_fits(smooth, worn.cloth)) {
        tl_smoothed_release(smooth);
        tl_smoothed_make(session->garment, &worn, &session->dress.borders, smooth);
    }
    return tl_smoothed_surface(smooth, &worn, garment);
}

/* A heavy garment is moved by a cage: light is computed where its corners are. */
static const struct tl_light_mesh *light_mesh_of_garment(tl_session *session)
{
    const uint64_t revision = session->cloth ? tl_cloth_cage(session->cloth, NULL) : 0;
    const tl_mesh *mesh = &session->garment->model.mesh;
    if (revision != session->cage.revision) {
        struct tl_light_mesh *light_mesh = &session->cage.light_mesh;
        tl_light_mesh_release(light_mesh);
        if (revision > 0) {
            *light_mesh = tl_light_mesh_make(mesh->vertex_count);
            tl_cloth_cage(session->cloth, &(struct tl_cage_places){light_mesh->from, light_mesh->shares});
            tl_light_mesh_number(light_mesh, mesh->indices, mesh->index_count);
        }
        session->appearance_revision = ++session->appearances_made;
    }
    session->cage.revision = revision;
    return revision > 0 ? &session->cage.light_mesh : NULL;
}

/* The garment comes last. */
static void add_garment(tl_session *session)
{
    tl_surface garment = tl_moving_surface(&session->dress, TL_SURFACE_GARMENT, &session->appearance.garment);
    garment.strains = strains_of_garment(session);
    garment.crossed = crossed_of_garment(session);
    garment.has_own_normals = tl_session_garment_state(session) == TL_GARMENT_AUTHORED;
    garment.borders = borders_of_garment(session);
    garment.light_mesh = light_mesh_of_garment(session);
    if (shows_board(session))
        session->surfaces[session->surface_count++] = tl_board_surface(&session->board, &garment);
    session->surfaces[session->surface_count++] = smoothed(session, &garment);
}

tl_frame tl_session_frame(tl_session *session)
{
    session->surface_count = 0;
    if (session->avatar) {
        tl_surface *body = &session->surfaces[session->surface_count++];
        *body = tl_moving_surface(&session->body, "avatar", &session->appearance.avatar);
        body->has_own_normals = session->inset != NULL;
    }
    if (session->garment)
        add_garment(session);
    for (size_t i = 0; i < session->surface_count; i++)
        session->surfaces[i].topology_revision = session->appearance_revision;
    const struct tl_image_params *image = &session->settings.image;
    const struct tl_framing framing = framing_with_board(session);
    struct tl_camera camera =
        tl_camera_frame(&session->settings.camera, &framing, (float)image->width / (float)image->height);
    session->lamps[0] = tl_lamp_make(&session->settings.lamp, camera.target);
    session->lamps[1] = tl_lamp_make(&session->settings.fill, camera.target);
    return (tl_frame){
        .camera = camera,
        .surfaces = session->surfaces,
        .surface_count = session->surface_count,
        .environment = &session->light.environment,
        .environment_revision = session->light.revision,
        .environment_yaw = glm_rad(session->settings.scene.environment_yaw_deg),
        .lamps = session->lamps,
        .lamp_count = TL_COUNT(session->lamps),
        .time_s = session->frame / session->settings.cloth.frame_rate,
    };
}

static tl_surface surface_at_rest(const tl_model *model, const char *name, const struct tl_dressing *dressing)
{
    tl_surface surface = tl_surface_of_mesh(name, &model->mesh, dressing->materials);
    surface.parts = dressing->parts;
    return surface;
}

tl_frame tl_session_frame_in(const struct tl_session_models *models, const struct tl_appearance *appearance,
                             tl_surface surfaces[2])
{
    size_t count = 0;
    if (models->avatar)
        surfaces[count++] = surface_at_rest(models->avatar, "avatar", &appearance->avatar);
    if (models->garment)
        surfaces[count++] = surface_at_rest(models->garment, TL_SURFACE_GARMENT, &appearance->garment);
    return (tl_frame){.surfaces = surfaces, .surface_count = count};
}

bool tl_session_light_plays(const tl_session *session)
{
    return session->light.sequence.count > 0;
}

bool tl_session_pick(const tl_session *session, vec3s origin, vec3s direction, uint32_t *vertex,
                     float *distance_m)
{
    return session->garment && tl_moving_pick(&session->dress, origin, direction, vertex, distance_m);
}

const char *const tl_garment_state_names[] = {"",        "as authored",           "sewn, not draped",
                                              "at rest", "still, not in balance", "moved, not at rest"};

enum tl_garment_state tl_session_garment_state(const tl_session *session)
{
    if (!session->cloth)
        return TL_GARMENT_IS_NOT_CLOTH;
    if (session->frame == 0 && session->authored && session->clip < 0)
        return TL_GARMENT_AUTHORED;
    if (session->frame == 0 && session->only_sewn)
        return TL_GARMENT_SEWN;
    const bool balances = !session->authored && tl_cloth_is_settled(session->cloth);
    if (session->frame > 0 && !tl_cloth_is_still(session->cloth))
        return TL_GARMENT_MOVED;
    if (balances)
        return TL_GARMENT_AT_REST;
    return session->frame > 0 ? TL_GARMENT_STILL : TL_GARMENT_MOVED;
}

void tl_session_describe_state(const tl_session *session, char *out, size_t size)
{
    const bool settled = session->cloth && session->frame == 0 && !tl_session_is_undraped(session);
    const struct tl_balance balance = settled ? tl_cloth_balance(session->cloth) : (struct tl_balance){0};
    const char *state = tl_garment_state_names[tl_session_garment_state(session)];
    if (balance.residual.bounded_rms > 0)
        snprintf(out, size, "%s, out of balance by %.2g of its weight", state, balance.residual.bounded_rms);
    else
        snprintf(out, size, "%s", state);
}

bool tl_session_show_placed(tl_session *session, const struct tl_placing *placing)
{
    const struct tl_placing *shown = &session->shown_placed;
    const struct tl_placing present = shown->scale != 0 ? *shown : (struct tl_placing){.scale = 1};
    if (!session->cloth || (present.scale == placing->scale && present.turn_deg == placing->turn_deg &&
                            glms_vec3_eqv(present.move_m, placing->move_m)))
        return false;
    session->shown_placed = *placing;
    if (session->frame == 0)
        read_back_start(session);
    else
        read_back_cloth(session);
    return true;
}

float tl_session_lifted_m(const tl_session *session)
{
    return session->standing.lifted_m;
}

const char *tl_session_size_note(const tl_session *session)
{
    return session->standing.size ? session->standing.size : session->standing.inside;
}

bool tl_session_is_authored(const tl_session *session)
{
    return session->cloth && session->authored;
}

bool tl_session_is_undraped(const tl_session *session)
{
    return session->cloth && (session->authored || session->only_sewn);
}

bool tl_session_plays_clip(const tl_session *session)
{
    return session->clip >= 0;
}

const tl_model *tl_session_garment(const tl_session *session)
{
    return session->garment ? &session->garment->model : NULL;
}

const tl_garment *tl_session_cut(const tl_session *session)
{
    return session->garment;
}

tl_cloth *tl_session_cloth(tl_session *session)
{
    return session->cloth;
}

struct tl_cloth_report tl_session_report(const tl_session *session)
{
    if (!session->cloth)
        return (struct tl_cloth_report){0};
    return tl_cloth_measure(session->cloth, session->collider);
}

struct tl_balance tl_session_balance(const tl_session *session)
{
    if (!session->cloth || session->frame > 0)
        return (struct tl_balance){0};
    if (tl_session_garment_state(session) == TL_GARMENT_AUTHORED)
        return (struct tl_balance){.residual = tl_cloth_residual(session->cloth, session->collider)};
    return tl_cloth_balance(session->cloth);
}
