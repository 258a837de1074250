/* Sequences of environments: one file per frame, named by a pattern (assets/motion/sequence.h), whose numbers
 * may start anywhere and have no gaps; or a film (assets/environment/film.h).
 *
 * Errors: a pattern without files, a gap and what is no film are refused when the sequence is opened, a
 * damaged frame when it is loaded. Lifetime: tl_environment_sequence owns its pattern and its film, whose
 * process runs until then. Threads: one at a time for a sequence. */
#ifndef TOILE_ASSETS_ENVIRONMENT_ENVIRONMENT_SEQUENCE_H
#define TOILE_ASSETS_ENVIRONMENT_ENVIRONMENT_SEQUENCE_H

#include "assets/environment/environment.h"
#include "assets/environment/film.h"

typedef struct tl_environment_sequence {
    char *pattern;
    tl_film *film; /* its frames; NULL: files */
    int first;     /* number of frame 0 */
    int count;     /* frames; 0 only in a zeroed struct */
} tl_environment_sequence;

/* Whether `name` is a film's, or a pattern and no file of that very name exists. */
bool tl_environment_is_sequence(const char *name);

/* Lists the files of a pattern, or the frames of a film; none is read yet. */
bool tl_environment_sequence_open(const char *pattern, tl_environment_sequence *out, tl_error *error);
/* Frees and zeroes; a zeroed sequence is accepted. */
void tl_environment_sequence_release(tl_environment_sequence *sequence);

/* The frame that is due, played in a loop at `rate` frames a second; -1: a film's own times, 30 for files. A
 * live film has a rate of its own. 0 in a zeroed sequence. */
int tl_environment_sequence_at(const tl_environment_sequence *sequence, double seconds, double rate);

/* Loads frame `index`, 0 to count - 1, as tl_environment_load does. */
bool tl_environment_sequence_load(const tl_environment_sequence *sequence, int index, tl_environment *out,
                                  tl_error *error);

#endif
