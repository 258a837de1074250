/* `toile COMMAND [TOPIC] [SCENE]`: commands that know more than one subject. */
#ifndef TOILE_APP_CLI_TOPIC_H
#define TOILE_APP_CLI_TOPIC_H

#include "app/cli/arguments.h"

/* Takes the topic off the arguments; `topics` ends with NULL. Without any, *topic is -1 if it may be left
 * out. `out` borrows from `arguments`. */
bool tl_topic_take(const char *command, const struct tl_arguments *arguments, const char *const *topics,
                   bool may_be_left_out, struct tl_arguments *out, int *topic, tl_error *error);

/* The built-in scene called `scene` where none is named. */
void tl_topic_default_scene(struct tl_arguments *arguments, const char *scene);

#endif
