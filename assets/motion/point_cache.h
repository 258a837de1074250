/* Point caches: where every point of a mesh is at a series of moments, as other programs write their
 * simulations. Three formats are read:
 *
 *     PC2           "POINTCACHE2", little endian; samples at start + i * rate, counted in frames
 *     MDD           big endian; a time in seconds for each sample
 *     OBJ sequence  frame.####.obj: each file's `v`, at the moment that its number tells, in frames
 *
 * Time runs from the first sample, whatever its frame or second is. Between samples points move on straight
 * lines, across missing frames of a sequence too; after the last one they rest. A file's counts are checked
 * against its length before memory is asked for, and every number of a PC2 or MDD when it is opened: samples
 * are then read one by one as they are needed. Positions come out in metres.
 *
 * Threads: one at a time per cache. */
#ifndef TOILE_ASSETS_MOTION_POINT_CACHE_H
#define TOILE_ASSETS_MOTION_POINT_CACHE_H

#include "assets/base/mesh.h"
#include "config/error.h"

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

/* By the extension, or a pattern; `metres` of one unit of the file. NULL on failure. */
tl_point_cache *tl_point_cache_open(const char *name, double metres, tl_error *error);
void tl_point_cache_destroy(tl_point_cache **handle);
bool tl_point_cache_is_file(const char *name); /* by the extension, or a pattern of OBJ files */

const struct tl_point_cache_facts *tl_point_cache_facts(const tl_point_cache *cache);

/* The samples around a moment: `position` 2.25 is a quarter of the way from sample 2 to sample 3.
 * `frame_rate` is the animation's, in which frames are counted when the file says no seconds; `own_rate`
 * above 0 overrides the file: its frames a second (a sample of an MDD is a frame). */
double tl_point_cache_position(const tl_point_cache *cache, double time_s, double frame_rate,
                               double own_rate);

/* Points [point_count] at a position. Fails when the file is no longer what it was, or a frame of a sequence
 * cannot be read. */
bool tl_point_cache_read(tl_point_cache *cache, double position, vec3s *points, tl_error *error);

/* A cache being written, sample by sample; appears whole or not at all. */
typedef struct tl_point_cache_writer tl_point_cache_writer;

/* .pc2 or .mdd; samples are one frame apart. */
tl_point_cache_writer *tl_point_cache_create(const char *path, size_t point_count, size_t sample_count,
                                             double first_frame, double frame_rate, tl_error *error);
/* Points as they are written; as often as sample_count says. */
void tl_point_cache_add(tl_point_cache_writer *writer, const vec3s *points);
/* Both release the writer. */
bool tl_point_cache_commit(tl_point_cache_writer **handle, tl_error *error);
void tl_point_cache_abandon(tl_point_cache_writer **handle);

#endif
