#include "app/measure/motion.h"

#include "app/measure/cost.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The swing of the hand. Chosen so that the built-in dress moves by about 2 mm a frame on average; and what
 * is small, a swatch of some centimetres, swings by a part of its size. */
#define SWING_M     0.16f
#define SWING_SHARE 0.25f
#define SWING_HZ    0.8
#define LIFT_SHARE  0.375 /* of the swing */

static const tl_surface *find_surface(const tl_frame *frame, const char *name)
{
    for (size_t i = 0; i < frame->surface_count; i++)
        if (strcmp(frame->surfaces[i].name, name) == 0)
            return &frame->surfaces[i];
    return NULL;
}

/* The hem's vertex nearest to the eye: the lowest ones within 2 cm are the hem. */
static uint32_t hem_vertex(const vec3s *positions, size_t count, vec3s eye)
{
    const float hem_m = 0.02f;
    float lowest = INFINITY, nearest = INFINITY;
    uint32_t best = 0;
    for (size_t i = 0; i < count; i++)
        lowest = fminf(lowest, positions[i].y);
    for (size_t i = 0; i < count; i++) {
        float distance = glms_vec3_distance(positions[i], eye);
        if (positions[i].y < lowest + hem_m && distance < nearest) {
            nearest = distance;
            best = (uint32_t)i;
        }
    }
    return best;
}

/* The longest side of its bounding box. */
static float size_of(const vec3s *positions, size_t count)
{
    vec3s box[2] = {positions[0], positions[0]};
    for (size_t i = 1; i < count; i++) {
        box[0] = glms_vec3_minv(box[0], positions[i]);
        box[1] = glms_vec3_maxv(box[1], positions[i]);
    }
    return glms_vec3_max(glms_vec3_sub(box[1], box[0]));
}

void tl_motion_begin(struct tl_motion *motion, tl_session *session)
{
    const tl_model *garment = tl_session_models(session).garment;
    *motion = (struct tl_motion){.session = session};
    motion->pulls = garment && tl_session_cloth(session) && !tl_session_plays_clip(session);
    if (!motion->pulls)
        return;
    const struct tl_camera camera = tl_session_frame(session).camera;
    size_t count = garment->mesh.vertex_count;
    vec3s *positions = TL_NEW_ARRAY(vec3s, count); /* of the cloth; it may be drawn smoother */
    tl_cloth_positions(tl_session_cloth(session), positions);
    motion->vertex = hem_vertex(positions, count, camera.eye);
    motion->swing_m = fminf(SWING_M, SWING_SHARE * size_of(positions, count));
    motion->home = positions[motion->vertex];
    free(positions);
    vec3s towards = glms_vec3_sub(camera.target, camera.eye);
    motion->across = glms_vec3_normalize((vec3s){{-towards.z, 0, towards.x}});
}

/* A swing to both sides, raised at the ends. */
static vec3s hand_at(const struct tl_motion *motion, double time_s)
{
    double phase = 2 * M_PI * SWING_HZ * time_s;
    vec3s hand = glms_vec3_muladds(motion->across, motion->swing_m * (float)sin(phase), motion->home);
    hand.y += motion->swing_m * (float)(LIFT_SHARE * 0.5 * (1 - cos(2 * phase)));
    return hand;
}

bool tl_motion_advance(struct tl_motion *motion, int number, tl_error *error)
{
    double frame_rate = tl_session_settings(motion->session)->cloth.frame_rate;
    if (motion->pulls)
        tl_cloth_grab(tl_session_cloth(motion->session), motion->vertex,
                      hand_at(motion, number / frame_rate));
    return tl_session_advance(motion->session, error);
}

struct tl_camera tl_motion_camera(const struct tl_camera *camera, int number, double frame_rate)
{
    float angle = glm_rad((float)(TL_MOTION_ORBIT_DEG_PER_S * number / frame_rate));
    const vec3s vertical = {{0, 1, 0}};
    struct tl_camera turned = *camera;
    vec3s back = glms_vec3_sub(camera->eye, camera->target);
    turned.eye = glms_vec3_add(camera->target, glms_vec3_rotate(back, angle, vertical));
    turned.up = glms_vec3_rotate(camera->up, angle, vertical);
    return turned;
}

/* A surface's own arrays at one frame. */
struct shot {
    vec3s *positions, *normals;
    vec4s *tangents;
    uint64_t motion_revision;
};

struct tl_recording {
    tl_session *session;
    int count;
    size_t surface_count;
    struct shot (*shots)[TL_SESSION_SURFACES]; /* [count] */
    tl_surface surfaces[TL_SESSION_SURFACES];  /* what the last frame asked for shows */
    double *cloth_cpu_ms;                      /* [count] */
};

static void *copy_array(const void *from, size_t count, size_t size)
{
    void *to = tl_alloc(count, size);
    memcpy(to, from, count * size);
    return to;
}

static void take_shot(tl_recording *recording, int number)
{
    tl_frame frame = tl_session_frame(recording->session);
    recording->surface_count = frame.surface_count;
    for (size_t s = 0; s < frame.surface_count; s++) {
        const tl_surface *surface = &frame.surfaces[s];
        recording->shots[number][s] = (struct shot){
            .positions = copy_array(surface->positions, surface->vertex_count, sizeof(vec3s)),
            .normals = copy_array(surface->normals, surface->vertex_count, sizeof(vec3s)),
            .tangents = copy_array(surface->tangents, surface->vertex_count, sizeof(vec4s)),
            .motion_revision = surface->motion_revision,
        };
    }
    recording->count = number + 1;
}

tl_recording *tl_motion_record(tl_session *session, int count, tl_error *error)
{
    tl_recording *recording = TL_NEW(tl_recording);
    recording->session = session;
    recording->shots = tl_alloc((size_t)count, sizeof *recording->shots);
    recording->cloth_cpu_ms = TL_NEW_ARRAY(double, (size_t)count);
    struct tl_progress progress = tl_progress_begin("recording the motion");
    struct tl_motion motion;
    tl_motion_begin(&motion, session);
    take_shot(recording, 0);
    bool done = true;
    for (int number = 1; done && number < count; number++) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        done = tl_motion_advance(&motion, number, error);
        recording->cloth_cpu_ms[number] = tl_stopwatch_read(&watch).cpu_ms;
        if (done)
            take_shot(recording, number);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stopped while the motion was recorded");
        tl_progress_update(&progress, number, count);
    }
    tl_progress_end(&progress);
    if (!done)
        tl_recording_destroy(&recording);
    return recording;
}

void tl_recording_destroy(tl_recording **handle)
{
    tl_recording *recording = *handle;
    if (!recording)
        return;
    for (int i = 0; i < recording->count; i++)
        for (size_t s = 0; s < recording->surface_count; s++) {
            free(recording->shots[i][s].positions);
            free(recording->shots[i][s].normals);
            free(recording->shots[i][s].tangents);
        }
    free(recording->shots);
    free(recording->cloth_cpu_ms);
    free(recording);
    *handle = NULL;
}

tl_frame tl_recording_frame(tl_recording *recording, int number)
{
    double frame_rate = tl_session_settings(recording->session)->cloth.frame_rate;
    tl_frame frame = tl_session_frame(recording->session);
    for (size_t s = 0; s < recording->surface_count; s++) {
        const struct shot *shot = &recording->shots[number][s];
        recording->surfaces[s] = frame.surfaces[s];
        recording->surfaces[s].positions = shot->positions;
        recording->surfaces[s].normals = shot->normals;
        recording->surfaces[s].tangents = shot->tangents;
        recording->surfaces[s].motion_revision = shot->motion_revision;
    }
    frame.surfaces = recording->surfaces;
    frame.camera = tl_motion_camera(&frame.camera, number, frame_rate);
    frame.time_s = number / frame_rate;
    return frame;
}

struct tl_recording_report tl_recording_report(const tl_recording *recording)
{
    struct tl_recording_report report = {.frames = recording->count};
    tl_frame frame = tl_session_frame(recording->session);
    report.cloth_cpu_ms =
        recording->count > 1 ? tl_median(recording->cloth_cpu_ms + 1, (size_t)recording->count - 1) : 0;
    const tl_surface *garment = find_surface(&frame, TL_SURFACE_GARMENT);
    if (!garment)
        return report;
    size_t s = (size_t)(garment - frame.surfaces);
    report.garment_triangles = garment->index_count / 3;
    double sum_m = 0;
    for (int i = 1; i < recording->count; i++)
        for (size_t v = 0; v < garment->vertex_count; v++)
            sum_m += (double)glms_vec3_distance(recording->shots[i][s].positions[v],
                                                recording->shots[i - 1][s].positions[v]);
    if (recording->count > 1)
        report.mean_step_m = sum_m / ((double)garment->vertex_count * (recording->count - 1));
    return report;
}
