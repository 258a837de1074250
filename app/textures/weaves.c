#include "app/textures/weaves.h"

#include "app/textures/height_picture.h"
#include "assets/fabric/fabric_file.h"
#include "config/base/hash.h"
#include "config/base/memory.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct kept_weave {
    struct tl_weave_params params;
    uint64_t files; /* hash of names, sizes and times of what was read */
    struct tl_fabric_pictures made;
    size_t bytes;
    int users;
    uint64_t used; /* rises with each use */
};

static struct {
    pthread_mutex_t guard;
    struct kept_weave **entries;
    size_t count;
    uint64_t uses;
} kept = {.guard = PTHREAD_MUTEX_INITIALIZER};

/* ---- The files behind options ---- */

static uint64_t hash_file(uint64_t hash, const char *path)
{
    struct stat found;
    hash = tl_hash(hash, path, strlen(path) + 1);
    if (stat(path, &found) != 0)
        return hash;
    hash = tl_hash(hash, &found.st_size, sizeof found.st_size);
    return tl_hash(hash, &found.st_mtim, sizeof found.st_mtim);
}

static bool hash_pictures(const char *path, uint64_t *hash, tl_error *error)
{
    tl_fabric_file file;
    if (!tl_fabric_file_open(path, &file, error))
        return false;
    *hash = hash_file(*hash, path);
    for (int use = 0; use < TL_PICTURE_USES; use++) {
        const char *name = file.pictures[use].file;
        char *place = name ? tl_store_place(&file.store, name) : NULL;
        if (place) /* in an archive there is no such file, but its own time decides */
            *hash = hash_file(*hash, place);
        free(place);
    }
    tl_fabric_file_release(&file);
    return true;
}

static bool hash_files(const struct tl_weave_params *params, uint64_t *out, tl_error *error)
{
    *out = TL_HASH_START;
    if (tl_text_is_given(params->pictures))
        return hash_pictures(params->pictures, out, error);
    if (tl_text_is_given(params->picture))
        *out = hash_file(*out, params->picture);
    return true;
}

/* ---- Making ---- */

static size_t bytes_of(const tl_image *image)
{
    size_t texel = (size_t)image->channels * (image->type == TL_IMAGE_F32 ? sizeof(float) : 1);
    return texel * (size_t)image->width * (size_t)image->height;
}

/* False without a change of *error where the options have no weave. */
static bool make(const struct tl_weave_params *params, struct tl_fabric_pictures *out, bool *failed,
                 tl_error *error)
{
    *out = (struct tl_fabric_pictures){0};
    bool pictured = tl_text_is_given(params->pictures) || tl_text_is_given(params->picture);
    bool made = tl_text_is_given(params->pictures)  ? tl_fabric_pictures_make(params, out, error)
                : tl_text_is_given(params->picture) ? tl_height_picture_weave(params, &out->weave, error)
                                                    : tl_weave_create(params, &out->weave);
    *failed = !made && pictured;
    return made;
}

/* ---- The weaves that are kept; the guard is locked ---- */

static struct kept_weave *find(const struct tl_weave_params *params, uint64_t files)
{
    for (size_t i = 0; i < kept.count; i++)
        if (kept.entries[i]->files == files &&
            tl_options_equal(&tl_weave_options, &kept.entries[i]->params, params))
            return kept.entries[i];
    return NULL;
}

static void drop(size_t index)
{
    tl_fabric_pictures_release(&kept.entries[index]->made);
    free(kept.entries[index]);
    kept.entries[index] = kept.entries[--kept.count];
}

static size_t unused_bytes(void)
{
    size_t bytes = 0;
    for (size_t i = 0; i < kept.count; i++)
        bytes += kept.entries[i]->users > 0 ? 0 : kept.entries[i]->bytes;
    return bytes;
}

static void drop_oldest(void)
{
    while (unused_bytes() > TL_WEAVES_KEPT_BYTES) {
        size_t oldest = kept.count;
        for (size_t i = 0; i < kept.count; i++)
            if (kept.entries[i]->users == 0 &&
                (oldest == kept.count || kept.entries[i]->used < kept.entries[oldest]->used))
                oldest = i;
        drop(oldest);
    }
}

static struct kept_weave *add(const struct tl_weave_params *params, uint64_t files,
                              const struct tl_fabric_pictures *made)
{
    const tl_image *images[] = {&made->weave.normal, &made->weave.height, &made->weave.gloss,
                                &made->weave.tint,   &made->cover,        &made->specular};
    struct kept_weave *entry = TL_NEW(struct kept_weave);
    *entry = (struct kept_weave){.params = *params, .files = files, .made = *made};
    for (size_t i = 0; i < TL_COUNT(images); i++)
        entry->bytes += bytes_of(images[i]);
    kept.entries = tl_resize(kept.entries, kept.count + 1, sizeof(struct kept_weave *));
    kept.entries[kept.count++] = entry;
    return entry;
}

static const struct tl_fabric_pictures *use(struct kept_weave *entry)
{
    entry->users++;
    entry->used = ++kept.uses;
    return &entry->made;
}

static const struct tl_fabric_pictures *take_kept(const struct tl_weave_params *params, uint64_t files)
{
    pthread_mutex_lock(&kept.guard);
    struct kept_weave *entry = find(params, files);
    const struct tl_fabric_pictures *found = entry ? use(entry) : NULL;
    pthread_mutex_unlock(&kept.guard);
    return found;
}

/* Another thread may have made the same meanwhile: then that one is taken. */
static const struct tl_fabric_pictures *take_made(const struct tl_weave_params *params, uint64_t files,
                                                  struct tl_fabric_pictures *made)
{
    pthread_mutex_lock(&kept.guard);
    struct kept_weave *entry = find(params, files);
    if (entry)
        tl_fabric_pictures_release(made);
    const struct tl_fabric_pictures *taken = use(entry ? entry : add(params, files, made));
    pthread_mutex_unlock(&kept.guard);
    return taken;
}

bool tl_weaves_take(const struct tl_weave_params *params, const struct tl_fabric_pictures **out,
                    tl_error *error)
{
    struct tl_fabric_pictures made;
    uint64_t files;
    bool failed;
    *out = NULL;
    if (!hash_files(params, &files, error))
        return false;
    *out = take_kept(params, files);
    if (*out)
        return true;
    if (!make(params, &made, &failed, error))
        return !failed;
    *out = take_made(params, files, &made);
    return true;
}

void tl_weaves_give(const struct tl_fabric_pictures *weave)
{
    if (!weave)
        return;
    pthread_mutex_lock(&kept.guard);
    for (size_t i = 0; i < kept.count; i++)
        if (&kept.entries[i]->made == weave)
            kept.entries[i]->users--;
    drop_oldest();
    pthread_mutex_unlock(&kept.guard);
}

size_t tl_weaves_unused_bytes(void)
{
    pthread_mutex_lock(&kept.guard);
    size_t bytes = unused_bytes();
    pthread_mutex_unlock(&kept.guard);
    return bytes;
}
