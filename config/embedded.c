#include "config/embedded.h"

#include <string.h>

const struct tl_embedded *tl_embedded_find(const struct tl_embedded *list, const char *name)
{
    for (const struct tl_embedded *entry = list; entry->name; entry++)
        if (strcmp(entry->name, name) == 0)
            return entry;
    return NULL;
}
