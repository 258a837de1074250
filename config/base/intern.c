#include "config/base/intern.h"

#include "config/base/hash.h"
#include "config/base/memory.h"

#include <pthread.h>
#include <stdlib.h>

struct interned {
    struct interned *next;
    char text[];
};

#define CHAINS 1024 /* a program reads some hundred names and paths */

const char *tl_intern(const char *text)
{
    static pthread_mutex_t guard = PTHREAD_MUTEX_INITIALIZER;
    static struct interned *chains[CHAINS];
    const size_t size = strlen(text) + 1;
    struct interned **chain = &chains[tl_hash(TL_HASH_START, text, size) % CHAINS], *entry;
    pthread_mutex_lock(&guard);
    for (entry = *chain; entry && strcmp(entry->text, text) != 0;)
        entry = entry->next;
    if (!entry) {
        entry = tl_alloc(1, sizeof *entry + size);
        memcpy(entry->text, text, size);
        entry->next = *chain;
        *chain = entry;
    }
    pthread_mutex_unlock(&guard);
    return entry->text;
}
