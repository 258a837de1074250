/* The light of a session: an environment that stands still, or a sequence that plays in a loop. A frame
 * is read when it is due: one of 512 x 256 texels takes less than 10 ms. */
#ifndef TOILE_APP_SCENE_MOVING_LIGHT_H
#define TOILE_APP_SCENE_MOVING_LIGHT_H

#include "assets/environment/environment_sequence.h"
#include "render/env/layout.h"

/* Owns what it holds; may be moved in memory. */
struct tl_moving_light {
    tl_environment environment;
    uint64_t revision;                /* rises with every change of the environment */
    tl_environment_sequence sequence; /* count 0: none */
    int shown;                        /* frame of the sequence that `environment` is */
};

/* `name`: "studio", "white" (1 from everywhere: the furnace), "none" (black), a file or a pattern.
 * `seconds`: from the start of the sequence; `rate`: as tl_environment_sequence_at has it. Maps of other
 * layouts than cube and lat-long are converted to lat-long. Replaces what the light held; on failure it is as
 * it was. */
bool tl_moving_light_open(struct tl_moving_light *light, const char *name, double seconds, double rate,
                          tl_error *error);
/* Shows the frame that is due; does nothing where that is shown already. */
bool tl_moving_light_follow(struct tl_moving_light *light, double seconds, double rate, tl_error *error);
/* The layout of a file's map, for render/env. */
enum tl_layout tl_environment_layout(const tl_environment *environment);
/* Warns when the reader of an environment had to replace values. */
void tl_environment_warn_of_cleaning(const tl_environment *environment);
void tl_moving_light_release(struct tl_moving_light *light);

#endif
