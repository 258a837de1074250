#include "app/view/memory/journal.h"

#include "app/view/memory/state.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define HEAD        "toile journal 1\n"
#define LIMIT_BYTES ((size_t)64 << 20)
#define TRIED       ".tried"
#define SYNC_S      0.5
#define TRIES       3

struct tl_journal {
    char *path;
    int file;                         /* -1: it cannot be written any more */
    struct tl_settings last, present; /* of the last record: with absolute paths, and as they were given */
    double dirty_s;                   /* time of the first record that is not on the disk; 0: none */
};

static void destroy(tl_journal *journal)
{
    if (journal->file >= 0)
        close(journal->file);
    free(journal->path);
    free(journal);
}

/* Opens and locks a file; -1 when another process holds it, or it cannot be opened. */
static int open_locked(const char *path, int flags)
{
    int file = open(path, O_RDWR | O_APPEND | O_CLOEXEC | flags, 0600);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0) {
        close(file);
        return -1;
    }
    return file;
}

/* ---- Writing ---- */

/* One write a record, so that a process that is killed leaves whole records. */
static void put(tl_journal *journal, const char *text)
{
    size_t size = strlen(text);
    if (journal->file < 0)
        return;
    if (write(journal->file, text, size) != (ssize_t)size) {
        tl_warn("view: %s: %s: changes are not kept from here on", journal->path, strerror(errno));
        close(journal->file);
        journal->file = -1;
        return;
    }
    if (journal->dirty_s <= 0)
        journal->dirty_s = tl_clock_s();
}

/* An empty name has no text that could be read back (config/options.h). */
static bool has_text(const struct tl_option *row, const char *text)
{
    return !(row->type == TL_PATH && row->choices && text[0] == '\0');
}

/* The options of `after` that differ from `before` (NULL: all), one a line. New string. */
static char *lines_of(const struct tl_settings *before, const struct tl_settings *after)
{
    struct tl_binding from[TL_SETTINGS_TABLES], to[TL_SETTINGS_TABLES];
    tl_settings_bind_const(before ? before : after, from);
    tl_settings_bind_const(after, to);
    char *lines = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&lines, &size);
    for (size_t i = 0; i < TL_SETTINGS_TABLES; i++)
        for (size_t j = 0; j < to[i].table->row_count; j++) {
            const struct tl_option *row = &to[i].table->rows[j];
            char *text = tl_options_get_text(&to[i], row), *was = tl_options_get_text(&from[i], row);
            if ((!before || strcmp(text, was) != 0) && has_text(row, text))
                fprintf(out, "%s.%s=%s\n", to[i].table->name, row->name, text);
            free(was);
            free(text);
        }
    fclose(out);
    return lines;
}

static void record(tl_journal *journal, const char *kind, const struct tl_settings *settings, bool whole)
{
    struct tl_settings absolute = *settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&absolute, bindings);
    tl_options_make_paths_absolute(bindings, TL_SETTINGS_TABLES);
    char *lines = lines_of(whole ? NULL : &journal->last, &absolute);
    char *text = tl_format("%s%s\n%s.\n", whole ? HEAD : "", kind, lines);
    put(journal, text);
    free(text);
    free(lines);
    journal->last = absolute;
    journal->present = *settings;
}

tl_journal *tl_journal_begin(const char *folder, uint64_t command, const struct tl_settings *settings)
{
    tl_error error;
    char *place = tl_format("%s/journal", folder);
    bool made = tl_folder_make(place, &error);
    tl_journal *journal = TL_NEW(tl_journal);
    journal->path = tl_format("%s/%016" PRIx64 "-%d", place, command, (int)getpid());
    journal->file = made ? open_locked(journal->path, O_CREAT | O_TRUNC) : -1;
    free(place);
    if (journal->file < 0) {
        tl_warn("view: %s: %s: changes are not kept until the window closes", journal->path,
                made ? strerror(errno) : error.message);
        destroy(journal);
        return NULL;
    }
    record(journal, "begin", settings, true);
    return journal;
}

void tl_journal_note(tl_journal *journal, const struct tl_settings *settings, bool is_edit)
{
    if (journal && (is_edit || !tl_settings_equal(&journal->present, settings)))
        record(journal, is_edit ? "edit" : "view", settings, false);
}

void tl_journal_undo(tl_journal *journal, bool redo, const struct tl_settings *settings)
{
    if (!journal)
        return;
    put(journal, redo ? "redo\n.\n" : "undo\n.\n");
    struct tl_settings absolute = *settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&absolute, bindings);
    tl_options_make_paths_absolute(bindings, TL_SETTINGS_TABLES);
    journal->last = absolute;
    journal->present = *settings;
}

void tl_journal_sync(tl_journal *journal)
{
    if (!journal || journal->dirty_s <= 0 || tl_clock_s() - journal->dirty_s < SYNC_S)
        return;
    if (journal->file >= 0)
        fdatasync(journal->file);
    journal->dirty_s = 0;
}

void tl_journal_close(tl_journal **handle, bool keep)
{
    tl_journal *journal = *handle;
    if (!journal)
        return;
    if (!keep)
        unlink(journal->path);
    destroy(journal);
    *handle = NULL;
}

void tl_journal_park(tl_journal **handle)
{
    if (!*handle)
        return;
    char *name = tl_format("%s" TRIED, (*handle)->path);
    rename((*handle)->path, name);
    free(name);
    tl_journal_close(handle, true);
}

/* ---- Reading ---- */

struct replay {
    struct tl_recovered *to;
    bool begun;
    int tries; /* since it was shown */
};

static bool apply_lines(char *lines, struct tl_settings *settings, tl_error *error)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(settings, bindings);
    bool names_changed = false;
    for (char *line; (line = strsep(&lines, "\n"));) {
        if (line[0] && !tl_options_set_assignment(bindings, TL_SETTINGS_TABLES, line, error))
            return false;
        names_changed = names_changed || strncmp(line, "scene.", 6) == 0;
    }
    return !names_changed || tl_settings_apply_colourway(settings, settings->scene.colourway, error);
}

static bool step_back(struct tl_recovered *to, bool redo)
{
    const struct tl_settings *edit = redo ? tl_history_redo(to->history) : tl_history_undo(to->history);
    if (!edit)
        return false;
    tl_history_restore(edit, &to->settings);
    to->steps += redo ? 1 : (size_t)-1;
    return true;
}

/* `kind` is the record's first line, `lines` the others. */
static bool apply(struct replay *replay, const char *kind, char *lines, tl_error *error)
{
    struct tl_recovered *to = replay->to;
    if (strcmp(kind, "tried") == 0 || strcmp(kind, "shown") == 0) {
        replay->tries = kind[0] == 't' ? replay->tries + 1 : 0;
        return true;
    }
    bool is_first = strcmp(kind, "begin") == 0, is_undo = strcmp(kind, "undo") == 0;
    if (is_undo || strcmp(kind, "redo") == 0)
        return (replay->begun && step_back(to, !is_undo)) ||
               tl_fail(error, TL_INPUT, "there is nothing to %s", kind);
    if (is_first == replay->begun)
        return tl_fail(error, TL_INPUT, "the record \"%.20s\" has no place", kind);
    if (!apply_lines(lines, &to->settings, error))
        return false;
    if (is_first)
        to->history = tl_history_create(&to->settings);
    else if (strcmp(kind, "edit") == 0 && tl_history_note(to->history, &to->settings))
        to->steps += to->steps < TL_HISTORY_EDITS;
    replay->begun = true;
    return true;
}

/* Applies the whole records of a text, and sets *whole to the bytes that they take. */
static bool replay_text(char *text, struct replay *replay, size_t *whole, tl_error *error)
{
    if (strncmp(text, HEAD, strlen(HEAD)) != 0)
        return tl_fail(error, TL_INPUT, "it is no journal of this version");
    char *at = text + strlen(HEAD), *end;
    while ((end = strstr(at, "\n.\n"))) {
        *end = '\0';
        char *lines = strchr(at, '\n');
        if (lines)
            *lines++ = '\0';
        if (!apply(replay, at, lines, error))
            return false;
        at = end + strlen("\n.\n");
    }
    *whole = (size_t)(at - text);
    return replay->begun || tl_fail(error, TL_INPUT, "it has no beginning");
}

static bool read_all(tl_journal *journal, struct tl_recovered *out, tl_error *error)
{
    struct replay replay = {.to = out};
    char *text;
    size_t size, whole = 0;
    *out = (struct tl_recovered){0};
    tl_settings_reset(&out->settings);
    if (!tl_file_read_small(journal->path, LIMIT_BYTES, &text, &size, error))
        return false;
    bool read = replay_text(text, &replay, &whole, error);
    free(text);
    if (read && replay.tries >= TRIES)
        read = tl_fail(error, TL_INPUT, "the program ended %d times while it was loaded", TRIES);
    if (read && whole < size && ftruncate(journal->file, (off_t)whole) != 0)
        read = tl_fail(error, TL_OUTPUT, "%s", strerror(errno));
    if (!read)
        tl_history_destroy(&out->history);
    journal->last = journal->present = out->settings;
    return read;
}

/* The latest file of this command that no window holds. Files that nobody has asked for in a month go. */
static tl_journal *find(const char *place, uint64_t command)
{
    const double month_s = 30 * 86400.0;
    char prefix[20];
    struct timespec latest = {0}, now;
    tl_journal *found = NULL;
    DIR *folder = opendir(place);
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(prefix, sizeof prefix, "%016" PRIx64 "-", command);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat about;
        char *path = tl_format("%s/%s", place, entry->d_name);
        bool is_file = stat(path, &about) == 0 && S_ISREG(about.st_mode);
        bool fits = is_file && strncmp(entry->d_name, prefix, strlen(prefix)) == 0 && !strstr(path, TRIED);
        bool is_old = is_file && (double)(now.tv_sec - about.st_mtim.tv_sec) > month_s;
        bool is_later = about.st_mtim.tv_sec > latest.tv_sec ||
                        (about.st_mtim.tv_sec == latest.tv_sec && about.st_mtim.tv_nsec > latest.tv_nsec);
        int file = is_old || (fits && is_later) ? open_locked(path, 0) : -1;
        if (file >= 0 && is_old) {
            unlink(path);
            close(file);
        } else if (file >= 0) {
            if (found)
                destroy(found);
            latest = about.st_mtim;
            found = TL_NEW(tl_journal);
            found->path = path;
            found->file = file;
            path = NULL;
        }
        free(path);
    }
    if (folder)
        closedir(folder);
    return found;
}

tl_journal *tl_journal_recover(const char *folder, uint64_t command, struct tl_recovered *out)
{
    tl_error error;
    char *place = tl_format("%s/journal", folder);
    tl_journal *journal = find(place, command);
    free(place);
    if (!journal)
        return NULL;
    if (read_all(journal, out, &error)) {
        put(journal, "tried\n.\n");
        return journal;
    }
    tl_warn("view: %s" TRIED ": the last review cannot be recovered: %s", journal->path, error.message);
    tl_journal_park(&journal);
    return NULL;
}

void tl_journal_resume(tl_journal *journal)
{
    if (journal)
        put(journal, "shown\n.\n");
}
