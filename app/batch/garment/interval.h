/* The interval that friction leaves: a garment comes to rest wherever friction and weight balance, and that
 * depends on where it comes from. It is settled from further starts than its own (lifted, lowered, and
 * twisted either way about the vertical), and each girth, opening and height has a smallest and a largest
 * value over all of them.
 *
 * Errors: TL_USAGE for a garment that does not settle, TL_INTERRUPTED, and those of tl_cloth_settle.
 * Threads: the session's. */
#ifndef TOILE_APP_BATCH_GARMENT_INTERVAL_H
#define TOILE_APP_BATCH_GARMENT_INTERVAL_H

#include "app/fit/measures.h"
#include "app/scene/session.h"

#include <cjson/cJSON.h>

#define TL_INTERVAL_STARTS 5 /* the garment's own is the first */
struct tl_interval {
    struct tl_measures measures[TL_INTERVAL_STARTS]; /* the first are borrowed, the others owned */
    struct tl_residual residuals[TL_INTERVAL_STARTS];
};

/* The session is at frame 0. Takes as long as four drapes; none is kept in the cache. `own`: the measures of
 * the session's garment, which must outlive the interval. On failure `out` is empty. Lifetime: the caller
 * releases `out`. */
bool tl_interval_take(tl_session *session, const struct tl_measures *own, struct tl_interval *out,
                      tl_error *error);
void tl_interval_release(struct tl_interval *interval);

/* Prints a table, in mm. */
void tl_interval_print(const struct tl_interval *interval);

/* The same as an object; the caller deletes it. */
cJSON *tl_interval_json(const struct tl_interval *interval);

#endif
