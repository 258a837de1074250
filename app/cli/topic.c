#include "app/cli/topic.h"

#include "config/base/words.h"

#include <stdlib.h>
#include <string.h>

static bool fail_topic(const char *command, const char *const *topics, tl_error *error)
{
    char *list = tl_join_words(topics, tl_count_words(topics), "|", "|");
    tl_fail(error, TL_USAGE, "%s: expected a topic: toile %s %s", command, command, list);
    free(list);
    return false;
}

bool tl_topic_take(const char *command, const struct tl_arguments *arguments, const char *const *topics,
                   bool may_be_left_out, struct tl_arguments *out, int *topic, tl_error *error)
{
    *out = *arguments;
    *topic = -1;
    if (arguments->positional_count == 0)
        return may_be_left_out || fail_topic(command, topics, error);
    for (int i = 0; topics[i]; i++)
        if (strcmp(topics[i], arguments->positionals[0]) == 0)
            *topic = i;
    if (*topic < 0)
        return fail_topic(command, topics, error);
    out->positional_count--;
    memmove(&out->positionals[0], &out->positionals[1], out->positional_count * sizeof out->positionals[0]);
    return true;
}

void tl_topic_default_scene(struct tl_arguments *arguments, const char *scene)
{
    if (arguments->positional_count == 0)
        arguments->positionals[arguments->positional_count++] = scene;
}
