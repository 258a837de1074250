/* Sequences of environments: one file a frame, named by a pattern (assets/motion/sequence.h). The numbers may
 * begin anywhere but have no gaps.
 *
 * Ownership: tl_environment_sequence owns its pattern. Threads: pure, but for reading files. Failure: a
 * pattern without files and a gap are refused when it is opened; a damaged frame when it is loaded. */
#ifndef TOILE_ASSETS_ENVIRONMENT_SEQUENCE_H
#define TOILE_ASSETS_ENVIRONMENT_SEQUENCE_H

#include "assets/environment.h"

typedef struct tl_environment_sequence {
    char *pattern;
    int first; /* number of frame 0 */
    int count; /* frames; 0 only in a zeroed struct */
} tl_environment_sequence;

/* True for a pattern. */
bool tl_environment_is_sequence(const char *name);

bool tl_environment_sequence_open(const char *pattern, tl_environment_sequence *out, tl_error *error);
void tl_environment_sequence_release(tl_environment_sequence *sequence);

/* Frame `index`, 0 to count - 1. */
bool tl_environment_sequence_load(const tl_environment_sequence *sequence, int index, tl_environment *out,
                                  tl_error *error);

#endif
