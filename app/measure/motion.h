/* The motion that measurements use: the camera orbits while a hand swings the garment's hem, or while the
 * avatar's own clip plays. Its frames are recorded once and then drawn by every method.
 *
 * Metres, seconds. Ownership: a recording keeps positions, normals and tangents; all else (indices,
 * materials, the environment) it borrows from the session at the moment a frame is asked for. Threads: one at
 * a time. */
#ifndef TOILE_APP_MEASURE_MOTION_H
#define TOILE_APP_MEASURE_MOTION_H

#include "app/scene/session.h"

#define TL_MOTION_ORBIT_DEG_PER_S 15.0

/* The hand of one motion. */
struct tl_motion {
    tl_session *session; /* borrowed */
    bool pulls;          /* there is cloth, and no clip that moves it */
    uint32_t vertex;     /* render vertex of the garment, at its hem */
    vec3s home, across;  /* where it was; the unit direction of the swing */
    float swing_m;       /* how far to either side */
};

/* Begins the motion: the session's current state is frame 0. */
void tl_motion_begin(struct tl_motion *motion, tl_session *session);
/* Advances to frame `number`, which must be the next one. */
bool tl_motion_advance(struct tl_motion *motion, int number, tl_error *error);

/* `camera` as it stands at a frame of the motion: turned about the vertical through its target. Pure. */
struct tl_camera tl_motion_camera(const struct tl_camera *camera, int number, double frame_rate);

typedef struct tl_recording tl_recording;

/* Records frames 0 to count - 1; shows progress. */
tl_recording *tl_motion_record(tl_session *session, int count, tl_error *error);
void tl_recording_destroy(tl_recording **handle);

/* Frame `number`, valid until the next call for this recording or one that changes its session. */
tl_frame tl_recording_frame(tl_recording *recording, int number);

struct tl_recording_report {
    int frames;
    size_t garment_triangles;
    double mean_step_m;  /* mean over the garment's vertices and the frames after the first */
    double cloth_cpu_ms; /* median of a frame's simulation, process CPU time */
};
struct tl_recording_report tl_recording_report(const tl_recording *recording);

#endif
