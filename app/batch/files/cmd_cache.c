/* toile cache: lists the results that are kept for reuse, or removes them. */
#include "app/batch/commands.h"
#include "app/cli/json.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Local time, as a person compares it with a clock. */
static void format_time(const struct timespec *time, char *out, size_t size)
{
    struct tm local;
    if (!localtime_r(&time->tv_sec, &local) || strftime(out, size, "%Y-%m-%d %H:%M:%S", &local) == 0)
        snprintf(out, size, "?");
}

static void print_json(const char *folder, const struct tl_cache_entry *entries, size_t count, size_t removed)
{
    double bytes = 0;
    cJSON *object = cJSON_CreateObject(), *rows = cJSON_CreateArray();
    for (size_t i = 0; i < count; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", entries[i].name);
        tl_json_add_number(row, "bytes", (double)entries[i].bytes);
        tl_json_add_number(row, "used_unix_s", (double)entries[i].used.tv_sec);
        cJSON_AddItemToArray(rows, row);
        bytes += (double)entries[i].bytes;
    }
    cJSON_AddStringToObject(object, "folder", folder);
    tl_json_add_number(object, "limit_bytes", (double)TL_CACHE_LIMIT_BYTES);
    tl_json_add_number(object, "bytes", bytes);
    tl_json_add_number(object, "removed", (double)removed);
    cJSON_AddItemToObject(object, "drapes", rows);
    tl_json_print(object);
}

static void print_table(const char *folder, const struct tl_cache_entry *entries, size_t count)
{
    double bytes = 0;
    for (size_t i = 0; i < count; i++) {
        char used[32];
        format_time(&entries[i].used, used, sizeof used);
        printf("%-40s %8.2f MB   last used %s\n", entries[i].name, (double)entries[i].bytes / 1e6, used);
        bytes += (double)entries[i].bytes;
    }
    printf("%zu results, %.2f MB of at most %.0f MB, in %s\n", count, bytes / 1e6,
           (double)TL_CACHE_LIMIT_BYTES / 1e6, folder);
}

bool tl_command_cache(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count > 0)
        return tl_fail(error, TL_USAGE, "cache: takes no name: toile cache [--clear]");
    char *folder = tl_cache_folder();
    if (!folder)
        return tl_fail(error, TL_USAGE,
                       "cache: neither XDG_CACHE_HOME nor HOME is set to a folder: set one of them");
    size_t count, removed = arguments->clear ? tl_cache_clear(folder) : 0;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    if (arguments->json)
        print_json(folder, entries, count, removed);
    else if (arguments->clear)
        printf("%zu results removed from %s\n", removed, folder);
    else
        print_table(folder, entries, count);
    free(entries);
    free(folder);
    return true;
}
