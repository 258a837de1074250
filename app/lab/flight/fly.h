/* A recorded flight: the camera follows a path while the cloth moves, under a frame budget or without one,
 * and every frame is recorded.
 *
 * A frame's time is wall time: from the choice of its levels over cloth and drawing to the finished linear
 * image. Later work on the image (thumbnails, hashes, video) is not counted. The first second is warm-up: it
 * is recorded, but left out of the figures. Levels recorded and applied again (a replay) give the same images
 * bit by bit. Milliseconds, bytes. Threads: the one that the GL context is current on. */
#ifndef TOILE_APP_LAB_FLIGHT_FLY_H
#define TOILE_APP_LAB_FLIGHT_FLY_H

#include "app/budget/governor.h"
#include "app/lab/flight/timeline.h"
#include "app/lab/flight/video.h"
#include "app/scene/headless.h"
#include "app/scene/path.h"

#include <math.h>

#define TL_FLIGHT_WORST   6 /* frames that are shown as pictures: those that took longest ... */
#define TL_FLIGHT_STOPS   8 /* ... and some at equal intervals of the path */
#define TL_JOB_NAME_BYTES 24

struct tl_flight_frame {
    double total_ms, cloth_ms;
    double cpu_ms; /* of all threads of the process, in total_ms; NaN: an older version did not record it */
    double load;   /* of the machine, averaged over the minute before; NaN: as above */
    double predicted_ms; /* NaN: nothing was known yet */
    double error;        /* estimated, of the reduced levels; NaN: unknown */
    double job_ms[TL_JOBS_MAX];
    struct tl_quality levels;
    size_t memory_bytes; /* the renderer's */
    uint64_t hash;       /* of the linear image; 0: none */
    /* Against the reference; NaN: not measured. The garment's error is FLIP of the picture as shown, over the
     * pixels of the garment (tl_image_compare_object), and NaN also where none of it is in sight; the other
     * two are over all covered pixels, of which most are the ground. */
    double garment_flip, garment_flip_worst; /* mean; mean of the largest 5 % */
    double flip_mean, rel_rmse;
};
/* A frame of which nothing is measured yet. */
#define TL_FLIGHT_FRAME_EMPTY                                                                                \
    {                                                                                                        \
        .cpu_ms = NAN, .load = NAN, .garment_flip = NAN, .garment_flip_worst = NAN, .flip_mean = NAN,        \
        .rel_rmse = NAN                                                                                      \
    }

struct tl_flight_picture {
    int frame;
    tl_image image; /* as a person would see it */
};

/* A frame that is kept for its comparison with the reference. */
struct tl_flight_kept {
    int frame;
    tl_image image; /* linear */
    tl_image shown; /* as a person would see it, full size */
};

struct tl_flight {
    double budget_ms; /* 0: none */
    double frame_rate;
    int planned; /* frames of the path */
    int warm_up; /* frames at the start that no figure counts */
    struct tl_flight_frame *frames;
    int count; /* frames recorded */
    int job_count;
    char job_names[TL_JOBS_MAX][TL_JOB_NAME_BYTES]; /* in the order of the frame's table */
    struct tl_path path;

    /* Only of a flight that was recorded by this process. */
    struct tl_flight_picture worst[TL_FLIGHT_WORST], stops[TL_FLIGHT_STOPS]; /* slowest first; in order */
    int worst_count, stop_count;
    struct tl_flight_kept *kept; /* images to compare with the reference */
    int kept_count;
};

struct tl_fly_options {
    double budget_ms; /* 0: none */
    int frames;
    bool hash;                      /* of every image */
    int oracle_every;               /* frames N, 2 N ...; 0: never. The first frame is none of them: it has
                                       not moved, and is at full quality whatever the budget */
    int shard, shards;              /* of the frames to compare every shards-th, from shard; 0, 1: all */
    const struct tl_flight *replay; /* levels are taken from here; NULL: chosen */
    tl_video *video;                /* gets every image; NULL: none */
    tl_timeline *trace;             /* gets every frame's jobs; NULL: none */
};

/* Records a flight along `path`, which it takes ownership of, from the session's frame 0. After a failure or
 * Ctrl-C `out` holds the frames until then. Release `out` in any case. */
bool tl_fly(struct tl_headless *headless, const struct tl_fly_options *options, struct tl_path *path,
            struct tl_flight *out, tl_error *error);
void tl_flight_release(struct tl_flight *flight);

/* Compares the kept images with the ray-traced reference, which is drawn in a second run of the same motion.
 */
bool tl_fly_judge(struct tl_headless *headless, struct tl_flight *flight, tl_error *error);

/* FOLDER/frames.csv. A flight that is read has frames, job names and the warm-up, but no images. */
void tl_flight_write_csv(const struct tl_flight *flight, FILE *out);
bool tl_flight_read_csv(const char *file, struct tl_flight *out, tl_error *error);

#endif
