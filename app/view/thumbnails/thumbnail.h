/* One small picture of what a name stands for: a fabric on a sphere in the studio, drawn by the reference
 * renderer on the CPU and kept in the cache of drapes (config/cache/cache.h), or an environment's map,
 * tone-mapped as the view's background.
 *
 * No GL. Errors: those of tl_session_create and tl_reference_draw; of tl_moving_light_open. Lifetime: the
 * caller releases `out`, U8 x4, sRGB. Threads: any, one at a time; OpenMP inside; it stops with the thread's
 * interrupt (config/base/interrupt.h). */
#ifndef TOILE_APP_VIEW_THUMBNAILS_THUMBNAIL_H
#define TOILE_APP_VIEW_THUMBNAILS_THUMBNAIL_H

#include "assets/base/image.h"

#define TL_THUMBNAIL_HEIGHT 48 /* pixels; a fabric's is as wide, an environment's twice that */

bool tl_thumbnail_of_fabric(const char *name, tl_image *out, tl_error *error);
bool tl_thumbnail_of_environment(const char *name, tl_image *out, tl_error *error);

#endif
