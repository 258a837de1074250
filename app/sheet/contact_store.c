#include "app/sheet/contact_store.h"

#include "app/report/folder.h"
#include "assets/image/image_file.h"
#include "config/file.h"
#include "config/memory.h"

#include <cjson/cJSON.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MANIFEST_BYTES ((size_t)16 << 20)

struct tl_contact_store {
    char *folder;
    cJSON *manifest; /* {"contact_sheet": {NAME: HASH}} */
    cJSON *cells;
};

static bool fail_manifest(const char *path, tl_error *error)
{
    return tl_fail(error, TL_INPUT,
                   "%s: is not the manifest of a contact sheet: choose another folder, or remove the file",
                   path);
}

static bool read_manifest(const char *path, tl_contact_store *store, tl_error *error)
{
    char *text;
    size_t size;
    if (!tl_file_read_small(path, MANIFEST_BYTES, &text, &size, error))
        return false;
    store->manifest = cJSON_ParseWithLength(text, size);
    free(text);
    store->cells = cJSON_GetObjectItemCaseSensitive(store->manifest, "contact_sheet");
    return cJSON_IsObject(store->cells) || fail_manifest(path, error);
}

tl_contact_store *tl_contact_store_open(const char *folder, tl_error *error)
{
    if (!tl_folder_make(folder, error))
        return NULL;
    tl_contact_store *store = TL_NEW(tl_contact_store);
    store->folder = tl_copy_string(folder);
    char *path = tl_format("%s/" TL_CONTACT_MANIFEST, folder);
    bool opened = true;
    if (tl_file_exists(path)) {
        opened = read_manifest(path, store, error);
    } else {
        store->manifest = cJSON_CreateObject();
        store->cells = cJSON_AddObjectToObject(store->manifest, "contact_sheet");
    }
    free(path);
    if (!opened)
        tl_contact_store_close(&store);
    return store;
}

void tl_contact_store_close(tl_contact_store **handle)
{
    tl_contact_store *store = *handle;
    if (!store)
        return;
    cJSON_Delete(store->manifest);
    free(store->folder);
    free(store);
    *handle = NULL;
}

static void print_hash(uint64_t hash, char text[20])
{
    snprintf(text, 20, "%016" PRIx64, hash);
}

bool tl_contact_store_has(const tl_contact_store *store, const char *name, uint64_t hash)
{
    char wanted[20];
    print_hash(hash, wanted);
    const cJSON *known = cJSON_GetObjectItemCaseSensitive(store->cells, name);
    if (!cJSON_IsString(known) || strcmp(known->valuestring, wanted) != 0)
        return false;
    char *path = tl_format("%s/%s", store->folder, name);
    bool there = tl_file_exists(path);
    free(path);
    return there;
}

static void write_manifest(const void *what, FILE *out)
{
    char *text = cJSON_Print(what);
    fprintf(out, "%s\n", text);
    cJSON_free(text);
}

static bool save_manifest(const tl_contact_store *store, tl_error *error)
{
    return tl_folder_print(store->folder, TL_CONTACT_MANIFEST, store->manifest, write_manifest, error);
}

/* The old entry is removed before its picture is replaced. The program may be stopped at any point without
 * leaving a hash in the manifest that belongs to another picture. */
bool tl_contact_store_put(tl_contact_store *store, const char *name, uint64_t hash, const tl_image *picture,
                          tl_error *error)
{
    if (cJSON_HasObjectItem(store->cells, name)) {
        cJSON_DeleteItemFromObjectCaseSensitive(store->cells, name);
        if (!save_manifest(store, error))
            return false;
    }
    char *path = tl_format("%s/%s", store->folder, name);
    bool saved = tl_image_save_png(path, picture, error);
    free(path);
    if (!saved)
        return false;
    char text[20];
    print_hash(hash, text);
    cJSON_AddStringToObject(store->cells, name, text);
    return save_manifest(store, error);
}

static void remove_file(const char *folder, const char *name)
{
    char *path = tl_format("%s/%s", folder, name);
    unlink(path);
    free(path);
}

void tl_contact_store_remove(tl_contact_store **store)
{
    const cJSON *cell;
    cJSON_ArrayForEach(cell, (*store)->cells) if (!strchr(cell->string, '/'))
        remove_file((*store)->folder, cell->string);
    remove_file((*store)->folder, TL_CONTACT_MANIFEST);
    rmdir((*store)->folder);
    tl_contact_store_close(store);
}
