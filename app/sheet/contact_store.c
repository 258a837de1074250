#include "app/sheet/contact_store.h"

#include "app/report/folder.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>

#include <dirent.h>
#include <fnmatch.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MANIFEST_BYTES ((size_t)16 << 20)

struct tl_contact_store {
    char *folder;
    char *name;      /* of the manifest that this process writes */
    cJSON *manifest; /* {"contact_sheet": {NAME: HASH}}; a hash of "": its picture is being replaced */
    cJSON *cells;
    cJSON *common; /* of a shard: the entries of the manifest that all have; else NULL */
};

static bool fail_manifest(const char *path, tl_error *error)
{
    return tl_fail(error, TL_INPUT,
                   "%s: is not the manifest of a contact sheet: choose another folder, or remove the file",
                   path);
}

static void set_entry(cJSON *cells, const char *name, const char *hash)
{
    cJSON_DeleteItemFromObjectCaseSensitive(cells, name);
    cJSON_AddStringToObject(cells, name, hash);
}

/* Adds the entries of a manifest, if it is there. Where two disagree about a picture, neither is right. */
static bool read_cells(const char *folder, const char *name, cJSON *cells, tl_error *error)
{
    char *path = tl_format("%s/%s", folder, name), *text = NULL;
    size_t size = 0;
    bool there = tl_file_exists(path),
         read = !there || tl_file_read_small(path, MANIFEST_BYTES, &text, &size, error);
    cJSON *manifest = there && read ? cJSON_ParseWithLength(text, size) : NULL;
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(manifest, "contact_sheet"), *cell;
    if (there && read && !cJSON_IsObject(found))
        read = fail_manifest(path, error);
    found = read ? found : NULL;
    cJSON_ArrayForEach(cell, found)
    {
        const char *hash = cJSON_IsString(cell) ? cell->valuestring : "";
        const cJSON *other = cJSON_GetObjectItemCaseSensitive(cells, cell->string);
        set_entry(cells, cell->string, other && strcmp(other->valuestring, hash) != 0 ? "" : hash);
    }
    cJSON_Delete(manifest);
    free(text);
    free(path);
    return read;
}

static void write_manifest(const void *what, FILE *out)
{
    char *text = cJSON_Print(what);
    fprintf(out, "%s\n", text);
    cJSON_free(text);
}

static bool save_manifest(const tl_contact_store *store, tl_error *error)
{
    return tl_folder_print(store->folder, store->name, store->manifest, write_manifest, error);
}

static void remove_file(const char *folder, const char *name)
{
    char *path = tl_format("%s/%s", folder, name);
    unlink(path);
    free(path);
}

static int is_of_shard(const struct dirent *entry)
{
    return fnmatch("manifest.*-*.json", entry->d_name, 0) == 0;
}

/* The manifests of shards become part of the store's own, which is written before they are removed. */
static bool take_shards(tl_contact_store *store, tl_error *error)
{
    struct dirent **found = NULL;
    int count = scandir(store->folder, &found, is_of_shard, alphasort);
    cJSON *cells = cJSON_CreateObject();
    const cJSON *cell;
    bool taken = true;
    for (int i = 0; taken && i < count; i++)
        taken = read_cells(store->folder, found[i]->d_name, cells, error);
    cJSON_ArrayForEach(cell, cells) set_entry(store->cells, cell->string, cell->valuestring);
    taken = taken && (count <= 0 || save_manifest(store, error));
    for (int i = 0; i < count; i++) {
        if (taken)
            remove_file(store->folder, found[i]->d_name);
        free(found[i]);
    }
    free(found);
    cJSON_Delete(cells);
    return taken;
}

tl_contact_store *tl_contact_store_open(const char *folder, int shard, int shards, tl_error *error)
{
    if (!tl_folder_make(folder, error))
        return NULL;
    tl_contact_store *store = TL_NEW(tl_contact_store);
    store->folder = tl_copy_string(folder);
    store->name =
        shards > 0 ? tl_format("manifest.%d-%d.json", shard, shards) : tl_copy_string(TL_CONTACT_MANIFEST);
    store->manifest = cJSON_CreateObject();
    store->cells = cJSON_AddObjectToObject(store->manifest, "contact_sheet");
    store->common = shards > 0 ? cJSON_CreateObject() : NULL;
    bool opened = read_cells(folder, store->name, store->cells, error) &&
                  (shards > 0 ? read_cells(folder, TL_CONTACT_MANIFEST, store->common, error)
                              : take_shards(store, error));
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
    cJSON_Delete(store->common);
    free(store->name);
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
    known = known ? known : cJSON_GetObjectItemCaseSensitive(store->common, name);
    if (!cJSON_IsString(known) || strcmp(known->valuestring, wanted) != 0)
        return false;
    char *path = tl_format("%s/%s", store->folder, name);
    bool there = tl_file_exists(path);
    free(path);
    return there;
}

static bool set_hash(tl_contact_store *store, const char *name, const char *hash, tl_error *error)
{
    set_entry(store->cells, name, hash);
    return save_manifest(store, error);
}

/* The old hash is removed before its picture is replaced. The program may be stopped at any point without
 * leaving a hash in the manifest that belongs to another picture. */
bool tl_contact_store_put(tl_contact_store *store, const char *name, uint64_t hash, const tl_image *picture,
                          tl_error *error)
{
    bool known = cJSON_HasObjectItem(store->cells, name) || cJSON_HasObjectItem(store->common, name);
    if (known && !set_hash(store, name, "", error))
        return false;
    char *path = tl_format("%s/%s", store->folder, name);
    bool saved = tl_image_save_png(path, picture, error);
    free(path);
    if (!saved)
        return false;
    char text[20];
    print_hash(hash, text);
    return set_hash(store, name, text, error);
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
