#include "app/loader.h"

#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

struct tl_loader {
    pthread_t thread;
    bool runs; /* the thread has to be joined */
    enum tl_load kind;
    struct tl_settings settings;
    int threads;
    void (*wake)(void);
    atomic_bool stops, is_done;
    pthread_mutex_t guard; /* of `progress` */
    struct tl_load_progress progress;

    /* The thread's until is_done. */
    tl_session *session;
    struct tl_moving_light light;
    bool made;
    tl_error error;
};

static void observe(void *user, const char *what, double share)
{
    tl_loader *loader = user;
    pthread_mutex_lock(&loader->guard);
    snprintf(loader->progress.what, sizeof loader->progress.what, "%s", what);
    loader->progress.share = share;
    pthread_mutex_unlock(&loader->guard);
}

static void *make(void *argument)
{
    tl_loader *loader = argument;
    tl_interrupt_by(&loader->stops);
    tl_progress_observe(observe, loader);
    if (loader->threads > 0)
        omp_set_num_threads(loader->threads); /* of this thread's loops only */
    if (loader->kind == TL_LOAD_SCENE) {
        loader->session = tl_session_create(&loader->settings, &loader->error);
        loader->made = loader->session != NULL;
    } else {
        const char *name = loader->settings.scene.environment;
        loader->made = tl_moving_light_open(&loader->light, name, 0, &loader->error);
    }
    atomic_store(&loader->is_done, true);
    loader->wake();
    return NULL;
}

tl_loader *tl_loader_start(enum tl_load kind, const struct tl_settings *settings, int threads,
                           void (*wake)(void))
{
    tl_loader *loader = TL_NEW(tl_loader);
    loader->kind = kind;
    loader->settings = *settings;
    loader->threads = threads;
    loader->wake = wake;
    pthread_mutex_init(&loader->guard, NULL);
    loader->runs = pthread_create(&loader->thread, NULL, make, loader) == 0;
    if (!loader->runs) {
        tl_fail(&loader->error, TL_DEVICE, "no thread can be started to load with: close other programs");
        atomic_store(&loader->is_done, true);
    }
    return loader;
}

static void join(tl_loader *loader)
{
    if (loader->runs)
        pthread_join(loader->thread, NULL);
    loader->runs = false;
}

enum tl_load tl_loader_kind(const tl_loader *loader)
{
    return loader->kind;
}

const struct tl_settings *tl_loader_settings(const tl_loader *loader)
{
    return &loader->settings;
}

bool tl_loader_is_done(const tl_loader *loader)
{
    return atomic_load(&loader->is_done);
}

struct tl_load_progress tl_loader_progress(tl_loader *loader)
{
    pthread_mutex_lock(&loader->guard);
    struct tl_load_progress progress = loader->progress;
    pthread_mutex_unlock(&loader->guard);
    return progress;
}

bool tl_loader_take(tl_loader **handle, tl_session **session, struct tl_moving_light *light, tl_error *error)
{
    tl_loader *loader = *handle;
    join(loader);
    *session = loader->session;
    *light = loader->light;
    loader->session = NULL;
    loader->light = (struct tl_moving_light){0};
    bool made = loader->made;
    if (!made)
        *error = loader->error;
    tl_loader_cancel(handle);
    return made;
}

void tl_loader_cancel(tl_loader **handle)
{
    tl_loader *loader = *handle;
    if (!loader)
        return;
    atomic_store(&loader->stops, true);
    join(loader);
    tl_session_destroy(&loader->session);
    tl_moving_light_release(&loader->light);
    pthread_mutex_destroy(&loader->guard);
    free(loader);
    *handle = NULL;
}
