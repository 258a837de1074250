#include "app/view/loader/loader.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

struct tl_loader {
    pthread_t thread;
    bool runs; /* the thread must be joined */
    enum tl_load kind;
    struct tl_settings settings;
    struct tl_session_models models;
    struct tl_load_lights lights;
    double began_s;
    int threads;
    void (*wake)(void);
    atomic_bool stops, is_done;
    pthread_mutex_t guard; /* of `progress` */
    struct tl_load_progress progress;

    /* Written by the worker before is_done is set, read by the window's thread after. */
    struct tl_loaded loaded;
    bool has_loaded;
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

static tl_frame frame_of(tl_loader *loader, tl_surface surfaces[2])
{
    struct tl_loaded *loaded = &loader->loaded;
    if (loader->kind == TL_LOAD_SCENE)
        return tl_session_frame(loaded->session);
    tl_frame frame = {.environment = &loaded->light.environment};
    if (loader->kind == TL_LOAD_APPEARANCE)
        frame = tl_session_frame_in(&loader->models, &loaded->appearance, surfaces);
    return frame;
}

static void prepare(tl_loader *loader)
{
    tl_surface surfaces[2];
    const tl_frame frame = frame_of(loader, surfaces);
    for (int i = 0; i < loader->lights.count && !tl_interrupted(); i++) {
        struct tl_prepared_request *request = &loader->lights.of[i];
        if (!request->environment)
            request->environment = frame.environment;
        request->exponents |= tl_prepared_exponents(&frame, &request->settings);
        loader->loaded.prepared[i] = tl_prepared_make(request);
    }
}

static bool load(tl_loader *loader)
{
    const struct tl_settings *settings = &loader->settings;
    struct tl_loaded *loaded = &loader->loaded;
    switch (loader->kind) {
    case TL_LOAD_SCENE:
        loaded->session = tl_session_create(settings, &loader->error);
        return loaded->session != NULL;
    case TL_LOAD_LIGHT:
        return tl_moving_light_open(&loaded->light, settings->scene.environment, 0,
                                    (double)settings->scene.environment_rate, &loader->error);
    case TL_LOAD_APPEARANCE:
        return tl_session_make_appearance(&loader->models, settings, &loaded->appearance, &loader->error);
    }
    return false;
}

static void *run(void *argument)
{
    tl_loader *loader = argument;
    tl_interrupt_by(&loader->stops);
    tl_progress_observe(observe, loader);
    if (loader->threads > 0)
        omp_set_num_threads(loader->threads); /* of this thread's loops only */
    loader->has_loaded = load(loader);
    if (loader->has_loaded)
        prepare(loader);
    atomic_store(&loader->is_done, true);
    loader->wake();
    return NULL;
}

tl_loader *tl_loader_start(enum tl_load kind, const struct tl_settings *settings,
                           const struct tl_session_models *models, const struct tl_load_lights *lights,
                           int threads, void (*wake)(void))
{
    tl_loader *loader = TL_NEW(tl_loader);
    loader->kind = kind;
    loader->settings = *settings;
    if (models)
        loader->models = *models;
    loader->began_s = tl_clock_s();
    loader->lights = *lights;
    loader->threads = threads;
    loader->wake = wake;
    pthread_mutex_init(&loader->guard, NULL);
    loader->runs = pthread_create(&loader->thread, NULL, run, loader) == 0;
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
    progress.seconds = tl_clock_s() - loader->began_s;
    return progress;
}

void tl_loaded_release(struct tl_loaded *loaded)
{
    tl_session_destroy(&loaded->session);
    tl_moving_light_release(&loaded->light);
    tl_appearance_release(&loaded->appearance);
    for (int i = 0; i < TL_LOADER_LIGHTS_MAX; i++)
        tl_prepared_destroy(&loaded->prepared[i]);
}

bool tl_loader_take(tl_loader **handle, struct tl_loaded *out, tl_error *error)
{
    tl_loader *loader = *handle;
    join(loader);
    *out = loader->loaded;
    loader->loaded = (struct tl_loaded){0};
    bool has_loaded = loader->has_loaded;
    if (!has_loaded)
        *error = loader->error;
    tl_loader_cancel(handle);
    return has_loaded;
}

void tl_loader_stop(tl_loader *loader)
{
    atomic_store(&loader->stops, true);
}

bool tl_loader_is_stopped(const tl_loader *loader)
{
    return atomic_load(&loader->stops);
}

void tl_loader_cancel(tl_loader **handle)
{
    tl_loader *loader = *handle;
    if (!loader)
        return;
    tl_loader_stop(loader);
    join(loader);
    tl_loaded_release(&loader->loaded);
    for (int i = 0; i < loader->lights.count; i++)
        tl_prepared_destroy(&loader->lights.of[i].known);
    pthread_mutex_destroy(&loader->guard);
    free(loader);
    *handle = NULL;
}
