/* Point caches: the positions of a mesh's points at a series of times, as simulation programs write them.
 * Three formats are read:
 *
 *     PC2           "POINTCACHE2", little endian; samples at start + i * rate, counted in frames
 *     MDD           big endian; a time in seconds for each sample
 *     OBJ sequence  frame.####.obj: each file's `v`; the file's number is the frame
 *
 * Time starts at the first sample, whatever its frame or second. Between samples, also across missing frames
 * of a sequence, positions are interpolated linearly; after the last one they stay. A file's counts are
 * checked against its length before memory is allocated, and every number of a PC2 or MDD when it is opened.
 * Samples are then read one by one when they are needed. Positions are returned in metres.
 *
 * Errors: false or NULL with one message (TL_INPUT, TL_OUTPUT). Lifetime: a cache keeps its file open until
 * it is destroyed. Threads: one at a time per cache. */
#ifndef TOILE_ASSETS_MOTION_POINT_CACHE_H
#define TOILE_ASSETS_MOTION_POINT_CACHE_H

#include "assets/base/mesh.h"
#include "config/base/error.h"

#include <stdbool.h>

typedef struct tl_point_cache tl_point_cache;

struct tl_point_cache_facts {
    const char *format; /* "PC2", "MDD", "OBJ sequence" */
    size_t point_count, sample_count;
    bool in_seconds;    /* MDD; else the next three count frames */
    double first, last; /* of the samples, as the file counts them */
    double step;        /* from sample to sample; 0: differs, or there is one only */
    struct tl_box box;  /* metres: all samples of a PC2 or MDD, the first of a sequence */
};

/* Opens a cache, its format chosen by the extension, or a pattern of OBJ files. `metres`: of one unit of the
 * file. NULL on failure. */
tl_point_cache *tl_point_cache_open(const char *name, double metres, tl_error *error);
void tl_point_cache_destroy(tl_point_cache **handle);
/* Whether `name` is a point cache, by its extension or as a pattern of OBJ files. */
bool tl_point_cache_is_file(const char *name);

/* Valid as long as the cache. */
const struct tl_point_cache_facts *tl_point_cache_facts(const tl_point_cache *cache);

/* The position of a time among the samples: 2.25 is a quarter of the way from sample 2 to sample 3.
 * `frame_rate`: frames per second of the animation, for files that count frames. `own_rate` above 0 overrides
 * the file with its own frames per second (a sample of an MDD counts as a frame). */
double tl_point_cache_position(const tl_point_cache *cache, double time_s, double frame_rate,
                               double own_rate);

/* Interpolates points [point_count] at a position. Fails when the file has changed since it was opened, or a
 * frame of a sequence cannot be read. */
bool tl_point_cache_read(tl_point_cache *cache, double position, vec3s *points, tl_error *error);

/* Writes a cache sample by sample; the file appears whole or not at all. */
typedef struct tl_point_cache_writer tl_point_cache_writer;

/* Starts a .pc2 or .mdd file whose samples are one frame apart. NULL on failure. */
tl_point_cache_writer *tl_point_cache_create(const char *path, size_t point_count, size_t sample_count,
                                             double first_frame, double frame_rate, tl_error *error);
/* Appends a sample, in units of the file; to be called sample_count times. */
void tl_point_cache_add(tl_point_cache_writer *writer, const vec3s *points);
/* Finishes the file, or drops it. Both release the writer. */
bool tl_point_cache_commit(tl_point_cache_writer **handle, tl_error *error);
void tl_point_cache_abandon(tl_point_cache_writer **handle);

#endif
