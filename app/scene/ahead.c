#include "app/scene/ahead_internal.h"

#include "config/base/memory.h"

#include <pthread.h>
#include <stdlib.h>

struct tl_ahead {
    pthread_t thread;
    tl_cloth *cloth;
    const tl_collider *collider;
    bool runs; /* until joined */
    bool done; /* the thread's until then, as the error */
    tl_error error;
};

static void *step(void *argument)
{
    struct tl_ahead *ahead = argument;
    ahead->done = tl_cloth_step(ahead->cloth, ahead->collider, &ahead->error);
    return NULL;
}

struct tl_ahead *tl_ahead_begin(tl_cloth *cloth, const tl_collider *collider)
{
    struct tl_ahead *ahead = TL_NEW(struct tl_ahead);
    ahead->cloth = cloth;
    ahead->collider = collider;
    ahead->runs = pthread_create(&ahead->thread, NULL, step, ahead) == 0;
    if (ahead->runs)
        return ahead;
    free(ahead);
    return NULL;
}

void tl_ahead_wait(struct tl_ahead *ahead)
{
    if (!ahead || !ahead->runs)
        return;
    pthread_join(ahead->thread, NULL);
    ahead->runs = false;
}

bool tl_ahead_take(struct tl_ahead **handle, tl_error *error)
{
    struct tl_ahead *ahead = *handle;
    tl_ahead_wait(ahead);
    const bool done = ahead->done;
    if (!done && error)
        *error = ahead->error;
    free(ahead);
    *handle = NULL;
    return done;
}
