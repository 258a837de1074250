#include "app/lab/gallery/store.h"

#include "app/report/folder.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define STORE_NAME  "gallery.json"
#define STORE_BYTES ((size_t)16 << 20)

struct tl_gallery_store {
    char *folder;
    cJSON *root;     /* {"gallery": {IMAGE: {"hash": "...", "error": [2], "time_ms": [2], ...}}} */
    cJSON *pictures; /* within it */
};

tl_gallery_store *tl_gallery_store_open(const char *folder, tl_error *error)
{
    char *path = tl_format("%s/%s", folder, STORE_NAME), *text = NULL;
    size_t size = 0;
    tl_gallery_store *store = TL_NEW(tl_gallery_store);
    store->folder = tl_copy_string(folder);
    bool is_there = tl_file_exists(path);
    bool read = !is_there || tl_file_read_small(path, STORE_BYTES, &text, &size, error);
    store->root = text ? cJSON_ParseWithLength(text, size) : cJSON_CreateObject();
    store->pictures = cJSON_GetObjectItemCaseSensitive(store->root, "gallery");
    if (!is_there)
        store->pictures = cJSON_AddObjectToObject(store->root, "gallery");
    if (read && !cJSON_IsObject(store->pictures))
        read = tl_fail(error, TL_INPUT,
                       "%s: is not the record of a gallery: choose another folder, or remove the file", path);
    free(text);
    free(path);
    if (!read)
        tl_gallery_store_close(&store);
    return store;
}

void tl_gallery_store_close(tl_gallery_store **handle)
{
    if (!*handle)
        return;
    cJSON_Delete((*handle)->root);
    free((*handle)->folder);
    free(*handle);
    *handle = NULL;
}

static void print_root(const void *root, FILE *out)
{
    char *text = cJSON_Print(root);
    fprintf(out, "%s\n", text);
    cJSON_free(text);
}

static bool save(const tl_gallery_store *store, tl_error *error)
{
    return tl_folder_print(store->folder, STORE_NAME, store->root, print_root, error);
}

static void print_hash(uint64_t hash, char text[20])
{
    snprintf(text, 20, "%016" PRIx64, hash);
}

static bool file_is_there(const tl_gallery_store *store, const char *name)
{
    char *path = tl_format("%s/%s", store->folder, name);
    bool is_there = tl_file_exists(path);
    free(path);
    return is_there;
}

static bool read_number(const cJSON *item, double *value)
{
    if (!cJSON_IsNumber(item))
        return false;
    *value = item->valuedouble;
    return true;
}

static bool read_pair(const cJSON *object, const char *name, double values[TL_PICTURE_OBJECTS])
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(object, name);
    for (int i = 0; i < TL_PICTURE_OBJECTS; i++)
        if (!read_number(cJSON_GetArrayItem(array, i), &values[i]))
            return false;
    return true;
}

bool tl_gallery_store_find(const tl_gallery_store *store, uint64_t hash, struct tl_gallery_entry *entry)
{
    char wanted[20];
    print_hash(hash, wanted);
    const cJSON *known = cJSON_GetObjectItemCaseSensitive(store->pictures, entry->image);
    const cJSON *text = cJSON_GetObjectItemCaseSensitive(known, "hash");
    struct tl_gallery_figures figures;
    bool found =
        cJSON_IsString(text) && strcmp(text->valuestring, wanted) == 0 &&
        file_is_there(store, entry->image) && (!entry->strip || file_is_there(store, entry->strip)) &&
        read_pair(known, "error", figures.error) && read_pair(known, "time_ms", figures.time_ms) &&
        read_number(cJSON_GetObjectItemCaseSensitive(known, "change"), &figures.change) &&
        read_number(cJSON_GetObjectItemCaseSensitive(known, "exact_change"), &figures.exact_change) &&
        read_number(cJSON_GetObjectItemCaseSensitive(known, "difference_end"), &figures.difference_end);
    if (found)
        entry->figures = figures;
    return found;
}

bool tl_gallery_store_forget(tl_gallery_store *store, const struct tl_gallery_entry *entry, tl_error *error)
{
    if (!cJSON_HasObjectItem(store->pictures, entry->image))
        return true;
    cJSON_DeleteItemFromObjectCaseSensitive(store->pictures, entry->image);
    return save(store, error);
}

bool tl_gallery_store_put(tl_gallery_store *store, uint64_t hash, const struct tl_gallery_entry *entry,
                          tl_error *error)
{
    const struct tl_gallery_figures *figures = &entry->figures;
    char text[20];
    print_hash(hash, text);
    cJSON *known = cJSON_AddObjectToObject(store->pictures, entry->image);
    cJSON_AddStringToObject(known, "hash", text);
    cJSON_AddItemToObject(known, "error", cJSON_CreateDoubleArray(figures->error, TL_PICTURE_OBJECTS));
    cJSON_AddItemToObject(known, "time_ms", cJSON_CreateDoubleArray(figures->time_ms, TL_PICTURE_OBJECTS));
    cJSON_AddNumberToObject(known, "change", figures->change);
    cJSON_AddNumberToObject(known, "exact_change", figures->exact_change);
    cJSON_AddNumberToObject(known, "difference_end", figures->difference_end);
    return save(store, error);
}
