#include "app/textures/measured_files.h"

#include "config/base/log.h"
#include "config/base/memory.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct kept_file {
    char *path;
    struct stat found; /* size and time identify the file */
    struct tl_measured made;
    int users;
    uint64_t used; /* rises with each use */
};

static struct {
    pthread_mutex_t guard;
    struct kept_file **entries;
    size_t count;
    uint64_t uses;
} kept = {.guard = PTHREAD_MUTEX_INITIALIZER};

/* ---- With the guard locked ---- */

static struct kept_file *find(const char *path, const struct stat *found)
{
    for (size_t i = 0; i < kept.count; i++) {
        const struct stat *other = &kept.entries[i]->found;
        if (strcmp(kept.entries[i]->path, path) == 0 && other->st_size == found->st_size &&
            other->st_mtim.tv_sec == found->st_mtim.tv_sec &&
            other->st_mtim.tv_nsec == found->st_mtim.tv_nsec)
            return kept.entries[i];
    }
    return NULL;
}

static void drop(size_t index)
{
    tl_measured_release(&kept.entries[index]->made);
    free(kept.entries[index]->path);
    free(kept.entries[index]);
    kept.entries[index] = kept.entries[--kept.count];
}

static void drop_oldest(void)
{
    for (;;) {
        size_t oldest = kept.count, unused = 0;
        for (size_t i = 0; i < kept.count; i++) {
            if (kept.entries[i]->users > 0)
                continue;
            unused++;
            if (oldest == kept.count || kept.entries[i]->used < kept.entries[oldest]->used)
                oldest = i;
        }
        if (unused <= TL_MEASURED_KEPT)
            return;
        drop(oldest);
    }
}

static const struct tl_measured *use(struct kept_file *entry)
{
    entry->users++;
    entry->used = ++kept.uses;
    return &entry->made;
}

/* ---- Taking and giving ---- */

static const struct tl_measured *take_kept(const char *path, const struct stat *found)
{
    pthread_mutex_lock(&kept.guard);
    struct kept_file *entry = find(path, found);
    const struct tl_measured *taken = entry ? use(entry) : NULL;
    pthread_mutex_unlock(&kept.guard);
    return taken;
}

/* Another thread may have made the same meanwhile: then that one is taken. */
static const struct tl_measured *take_made(const char *path, const struct stat *found,
                                           struct tl_measured *made)
{
    pthread_mutex_lock(&kept.guard);
    struct kept_file *entry = find(path, found);
    if (entry) {
        tl_measured_release(made);
    } else {
        entry = TL_NEW(struct kept_file);
        *entry = (struct kept_file){.path = tl_copy_string(path), .found = *found, .made = *made};
        kept.entries = tl_resize(kept.entries, kept.count + 1, sizeof(struct kept_file *));
        kept.entries[kept.count++] = entry;
    }
    const struct tl_measured *taken = use(entry);
    pthread_mutex_unlock(&kept.guard);
    return taken;
}

static void report(const char *path, size_t count, const struct tl_measured *made)
{
    tl_info("%s: %zu samples in tables of %d x %d texels, relative RMSE %.1f %%; for light that no lamp "
            "sends, in "
            "a material of lobes, %.1f %%",
            path, count, made->tables.tables[TL_MEASURED_HALF].width,
            made->tables.tables[TL_MEASURED_HALF].height, 100 * made->rel_rmse, 100 * made->lobes.rel_rmse);
    if (made->lobes.rel_rmse > TL_MEASURED_LOBES_GOOD)
        tl_warn(
            "%s: no material of lobes reflects as the samples do; under an environment the cloth is drawn "
            "otherwise; judge it under lamps (lamp.kind), whose light the tables reflect",
            path);
    if (made->bridged > 0.3)
        tl_warn("%s: no sample lies in %.0f %% of the directions, which are filled from those around them",
                path, 100 * made->bridged);
}

static bool take(const char *path, const struct tl_measured **out, tl_error *error)
{
    struct tl_reflectance_samples samples;
    struct stat found = {0};
    if (stat(path, &found) == 0 && (*out = take_kept(path, &found)) != NULL)
        return true;
    if (!tl_reflectance_samples_load(path, &samples, error))
        return false;
    struct tl_measured made = tl_measured_make(&samples);
    report(path, samples.count, &made);
    tl_reflectance_samples_release(&samples);
    *out = take_made(path, &found, &made);
    return true;
}

bool tl_measured_take(const char *path, tl_material *material, tl_error *error)
{
    if (!take(path, &material->measured, error))
        return false;
    tl_measured_lobes_set(&material->measured->lobes, material);
    return true;
}

void tl_measured_give(const struct tl_measured *measured)
{
    if (!measured)
        return;
    pthread_mutex_lock(&kept.guard);
    for (size_t i = 0; i < kept.count; i++)
        if (&kept.entries[i]->made == measured)
            kept.entries[i]->users--;
    drop_oldest();
    pthread_mutex_unlock(&kept.guard);
}
