/* Films as sequences of pictures, decoded by the program ffmpeg as they are asked for: one process runs at
 * the frame that was read last, and starts again where an earlier one is due. One frame is in memory. Of a
 * file the first stream of pictures is read, at its own size, each frame with its own time; values are taken
 * for sRGB. "-" is live: whatever ffmpeg reads from stdin, as fast as it comes, of which the newest frame is
 * kept; at its end the last one stays.
 *
 * Errors: false with one line (TL_INPUT) when ffmpeg is missing or refuses the file, or a frame cannot be
 * read; so when stdin is a terminal or was opened before. Lifetime: tl_film_close ends the process.
 * Threads: one at a time for a film. */
#ifndef TOILE_ASSETS_ENVIRONMENT_FILM_H
#define TOILE_ASSETS_ENVIRONMENT_FILM_H

#include "assets/base/image.h"

typedef struct tl_film tl_film;

/* Whether a name is "-". Pure. */
bool tl_film_is_live(const char *path);
/* Whether a name is that or ends as films do. Pure. */
bool tl_film_is(const char *path);

/* Reads the times of the frames; none is decoded. Live: waits for the first one. NULL on failure. */
tl_film *tl_film_open(const char *path, tl_error *error);
void tl_film_close(tl_film **handle); /* accepts null */

int tl_film_frame_count(const tl_film *film); /* 1 of a live one */
/* The frame that is shown at a time, 0 or more, of the film played in a loop. Live: the newest one's number.
 */
int tl_film_frame_at(tl_film *film, double seconds);

/* Reads frame `index`, from 0, as linear values: F32 x3. Decodes all between it and the one read before.
 * Live: the newest one. */
bool tl_film_read(tl_film *film, int index, tl_image *out, tl_error *error);

#endif
