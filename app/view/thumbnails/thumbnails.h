/* Thumbnails of the names in a list of the panel, made on a worker thread, one at a time, while the list is
 * open; when it closes, the one in the making is given up. Those that are made are kept until the window
 * closes: 9 kB a fabric, 18 kB an environment.
 *
 * The worker makes no GL call and uses one core. Errors: what cannot be drawn has an empty image, with a line
 * in the log. Lifetime: from tl_thumbnails_create until tl_thumbnails_destroy. Threads: the window's. */
#ifndef TOILE_APP_VIEW_THUMBNAILS_THUMBNAILS_H
#define TOILE_APP_VIEW_THUMBNAILS_THUMBNAILS_H

#include "assets/base/image.h"
#include "config/options.h"

typedef struct tl_thumbnails tl_thumbnails;

/* `wake` is called on the worker's thread when a thumbnail is made. */
tl_thumbnails *tl_thumbnails_create(void (*wake)(void));
void tl_thumbnails_destroy(tl_thumbnails **thumbnails); /* stops and nulls; null is fine */

/* The option whose list is open: its thumbnails are made from now on; NULL: none is. Lists of fabrics and
 * environments have thumbnails. True when there are more of them than at the last call. */
bool tl_thumbnails_follow(tl_thumbnails *thumbnails, const struct tl_option *listed);

/* The images of the followed option's choices, and how many of these are made: the first ones. They stay as
 * they are. NULL: no list with thumbnails is open. */
const tl_image *tl_thumbnails_images(const tl_thumbnails *thumbnails, size_t *count);

#endif
