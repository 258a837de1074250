/* Shimmer: how much the pixels of a fabric change when it moves by less than a pixel, beyond what they
 * should.
 *
 * The flat middle of the specimen "disc" is seen from 1 m at 55 degrees, its pixels as wide as those of a
 * picture of 1080 rows under 30 degrees. It moves by five steps of parts of a pixel. Each frame is compared
 * with its truth, the mean of 8 x 8 finer pixels in place of each: the standard deviation of the difference
 * over the steps, root mean square over the pixels, over the mean luminance. A constant error does not count.
 * Light is unshadowed, so that the fabric's maps and lobes alone vary.
 *
 * Errors: of a session and a renderer; TL_DEVICE without GL. Threads: the main thread. */
#ifndef TOILE_APP_FABRIC_SHIMMER_H
#define TOILE_APP_FABRIC_SHIMMER_H

#include "app/scene/headless.h"

/* Measures with the settings of `headless`, whose session shows the specimen; they are restored. */
bool tl_shimmer_measure(struct tl_headless *headless, double *out, tl_error *error);

#endif
