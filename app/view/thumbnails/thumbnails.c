#include "app/view/thumbnails/thumbnails.h"

#include "app/view/thumbnails/thumbnail.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/base/words.h"

#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* The thumbnails of one option's choices. */
struct thumbnail_list {
    const char *option;
    bool (*make)(const char *name, tl_image *out, tl_error *error);
    const char *const *names; /* NULL: the list was not opened yet */
    tl_image *images;         /* [number of names]: the first `count` are made, and immutable */
    atomic_size_t count;
};

enum { LISTS = 2 };

struct tl_thumbnails {
    struct thumbnail_list lists[LISTS];
    struct thumbnail_list *followed; /* NULL: none */
    size_t seen;                     /* of the followed list */
    void (*wake)(void);

    pthread_t thread;
    bool runs; /* the thread must be joined */
    atomic_bool stops, is_done;
    struct thumbnail_list *worked; /* that the thread makes */
};

/* Progress of what nobody waits for is not shown. */
static void ignore(void *user, const char *what, double share)
{
    (void)user;
    (void)what;
    (void)share;
}

static void *work(void *argument)
{
    tl_thumbnails *thumbnails = argument;
    struct thumbnail_list *list = thumbnails->worked;
    const size_t total = tl_count_words(list->names);
    tl_interrupt_by(&thumbnails->stops);
    tl_progress_observe(ignore, NULL);
    omp_set_num_threads(1); /* of this thread's loops only */
    for (size_t i = atomic_load(&list->count); i < total && !tl_interrupted(); i++) {
        const double began_s = tl_clock_s();
        tl_error error = {0};
        const bool is_made = list->make(list->names[i], &list->images[i], &error);
        if (tl_interrupted()) {
            tl_image_release(&list->images[i]); /* it may be incomplete */
            break;
        }
        if (is_made)
            tl_debug("view: thumbnail of %s: %.0f ms", list->names[i], 1000 * (tl_clock_s() - began_s));
        else
            tl_info("view: thumbnail of %s: %s", list->names[i], error.message);
        atomic_store(&list->count, i + 1);
        thumbnails->wake();
    }
    atomic_store(&thumbnails->is_done, true);
    thumbnails->wake();
    return NULL;
}

static void join(tl_thumbnails *thumbnails)
{
    if (thumbnails->runs)
        pthread_join(thumbnails->thread, NULL);
    thumbnails->runs = false;
}

tl_thumbnails *tl_thumbnails_create(void (*wake)(void))
{
    tl_thumbnails *thumbnails = TL_NEW(tl_thumbnails);
    const struct thumbnail_list lists[LISTS] = {
        {.option = "fabric", .make = tl_thumbnail_of_fabric},
        {.option = "environment", .make = tl_thumbnail_of_environment},
    };
    for (int i = 0; i < LISTS; i++) {
        thumbnails->lists[i].option = lists[i].option;
        thumbnails->lists[i].make = lists[i].make;
    }
    thumbnails->wake = wake;
    return thumbnails;
}

void tl_thumbnails_destroy(tl_thumbnails **handle)
{
    tl_thumbnails *thumbnails = *handle;
    if (!thumbnails)
        return;
    atomic_store(&thumbnails->stops, true);
    join(thumbnails);
    for (int i = 0; i < LISTS; i++) {
        for (size_t k = 0; k < atomic_load(&thumbnails->lists[i].count); k++)
            tl_image_release(&thumbnails->lists[i].images[k]);
        free(thumbnails->lists[i].images);
    }
    free(thumbnails);
    *handle = NULL;
}

static struct thumbnail_list *list_of(tl_thumbnails *thumbnails, const struct tl_option *option)
{
    for (int i = 0; option && i < LISTS; i++) {
        struct thumbnail_list *list = &thumbnails->lists[i];
        if (strcmp(list->option, option->name) != 0)
            continue;
        if (!list->names) {
            list->names = option->choices;
            list->images = TL_NEW_ARRAY(tl_image, tl_count_words(list->names));
        }
        return list;
    }
    return NULL;
}

/* A thread that was stopped ends its current step first: the next one starts once it is done. */
static void manage_thread(tl_thumbnails *thumbnails)
{
    struct thumbnail_list *list = thumbnails->followed;
    if (thumbnails->runs && thumbnails->worked != list)
        atomic_store(&thumbnails->stops, true);
    if (thumbnails->runs && atomic_load(&thumbnails->is_done))
        join(thumbnails);
    if (thumbnails->runs || !list || atomic_load(&list->count) == tl_count_words(list->names))
        return;
    atomic_store(&thumbnails->stops, false);
    atomic_store(&thumbnails->is_done, false);
    thumbnails->worked = list;
    thumbnails->runs = pthread_create(&thumbnails->thread, NULL, work, thumbnails) == 0;
}

bool tl_thumbnails_follow(tl_thumbnails *thumbnails, const struct tl_option *listed)
{
    struct thumbnail_list *list = list_of(thumbnails, listed);
    const size_t seen = list == thumbnails->followed ? thumbnails->seen : 0;
    thumbnails->followed = list;
    manage_thread(thumbnails);
    thumbnails->seen = list ? atomic_load(&list->count) : 0;
    return thumbnails->seen > seen;
}

const tl_image *tl_thumbnails_images(const tl_thumbnails *thumbnails, size_t *count)
{
    const struct thumbnail_list *list = thumbnails->followed;
    *count = list ? atomic_load(&list->count) : 0;
    return list ? list->images : NULL;
}
