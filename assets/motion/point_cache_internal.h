/* The fields of a tl_point_cache, and the readers of its formats. */
#ifndef TOILE_ASSETS_MOTION_POINT_CACHE_INTERNAL_H
#define TOILE_ASSETS_MOTION_POINT_CACHE_INTERNAL_H

#include "assets/motion/point_cache.h"

#include <stdint.h>
#include <stdio.h>

struct tl_point_cache {
    char *name;
    float metres; /* of one unit of the file */
    struct tl_point_cache_facts facts;
    double *moments; /* [sample_count] since the first, in seconds or frames; rising */
    /* PC2, MDD */
    FILE *stream;
    uint64_t data_offset;
    bool big_endian;
    /* OBJ */
    int *numbers; /* [sample_count] */
    /* The two samples read last, in metres; SIZE_MAX: none. */
    size_t held[2];
    vec3s *points[2]; /* [point_count] */
};

/* Read the header of a PC2 or MDD and fill the fields above. On failure the caller destroys the cache.
 * (point_cache_file.c) */
bool point_cache_open_pc2(tl_point_cache *cache, tl_error *error);
bool point_cache_open_mdd(tl_point_cache *cache, tl_error *error);
/* Reads sample `index`, in units of the file. */
bool point_cache_read_file(tl_point_cache *cache, size_t index, vec3s *points, tl_error *error);

/* The same for an OBJ sequence. (point_cache_sequence.c) */
bool point_cache_open_sequence(tl_point_cache *cache, tl_error *error);
bool point_cache_read_frame(tl_point_cache *cache, size_t index, vec3s *points, tl_error *error);

#endif
