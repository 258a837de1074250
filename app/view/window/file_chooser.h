/* Asks for a file by the desktop's own dialog: the command zenity, which runs beside this program, so that
 * the window goes on. Lifetime: a chooser is owned by the caller. Threads: one. */
#ifndef TOILE_APP_VIEW_WINDOW_FILE_CHOOSER_H
#define TOILE_APP_VIEW_WINDOW_FILE_CHOOSER_H

#include "config/base/error.h"

#include <stdbool.h>

typedef struct tl_file_chooser tl_file_chooser;

/* Errors: NULL, with TL_DEVICE, when the dialog cannot be started; the message names the package. */
tl_file_chooser *tl_file_chooser_open(const char *title, tl_error *error);

/* True once the dialog is closed: `*path` is then the chosen file, which the caller frees, or NULL. The
 * chooser is freed and *handle nulled. */
bool tl_file_chooser_poll(tl_file_chooser **handle, char **path);

/* Closes the dialog. Nulls *handle; null is fine. */
void tl_file_chooser_close(tl_file_chooser **handle);

#endif
