/* The journal of a review window: its settings when it opened and every change since, so that they come back
 * after the process was killed. One file a window, in the state's folder (app/view/memory/state.h), under
 * journal/: records of "table.key=value" lines, each ended by a line with a point. A window holds a lock on
 * its file; a file without a lock is of a window that did not close.
 *
 * A record is written as soon as the change is made, which outlives the process, and is brought to the disk
 * within a second, which outlives the machine. Paths are absolute. A null journal is accepted everywhere:
 * nothing is kept then. Errors: warnings; a journal that cannot be written any more ends. Threads: the
 * window's. */
#ifndef TOILE_APP_VIEW_MEMORY_JOURNAL_H
#define TOILE_APP_VIEW_MEMORY_JOURNAL_H

#include "app/settings/settings.h"
#include "app/view/memory/history.h"

typedef struct tl_journal tl_journal;

/* Begins a journal in FOLDER/journal. `command` stands for the command line: only the same one brings the
 * review back. NULL, with a warning, when it cannot be written. The caller closes it. */
tl_journal *tl_journal_begin(const char *folder, uint64_t command, const struct tl_settings *settings);

struct tl_recovered {
    struct tl_settings settings;
    tl_history *history; /* of these steps; the caller's */
    size_t steps;        /* that can be undone */
};

/* Takes over the latest journal of this command whose window did not close: NULL when there is none. One that
 * was taken over three times without tl_journal_resume ends the program, as it seems, and is set aside. An
 * incomplete last record, from a window that was killed while it wrote, is cut off. */
tl_journal *tl_journal_recover(const char *folder, uint64_t command, struct tl_recovered *out);
/* The recovered review is shown: its journal goes on. */
void tl_journal_resume(tl_journal *journal);

/* The recovered review cannot be shown: its file gets the end .tried and stays. Frees as tl_journal_close. */
void tl_journal_park(tl_journal **handle);

/* Records what differs from the last record: as an edit (tl_history_note), or as a change of the view. */
void tl_journal_note(tl_journal *journal, const struct tl_settings *settings, bool is_edit);
/* Records that a step was undone or redone, which led to `settings`. */
void tl_journal_undo(tl_journal *journal, bool redo, const struct tl_settings *settings);

/* Brings records to the disk that have waited for half a second; call it twice a second. */
void tl_journal_sync(tl_journal *journal);

/* Frees it and sets the handle to NULL. The file stays with `keep`, else it is removed. */
void tl_journal_close(tl_journal **handle, bool keep);

#endif
