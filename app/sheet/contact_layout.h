/* Where the cells of a contact sheet go, and its words: a table of rows and columns with labels at both,
 * under a title. A sheet of one column flows instead: its cells follow one another in lines, each with its
 * label below. Pixels from the top left. Pure. */
#ifndef TOILE_APP_SHEET_CONTACT_LAYOUT_H
#define TOILE_APP_SHEET_CONTACT_LAYOUT_H

#include "assets/base/image.h"

struct tl_contact_label {
    const char *group; /* heading of neighbours that share it; "": none is wanted */
    const char *name;  /* "": none is wanted */
};

struct tl_contact_grid {
    const char *title, *note; /* a line each; the note may be "" */
    const struct tl_contact_label *rows, *columns;
    size_t row_count, column_count;
    int cell_width, cell_height;
};

void tl_contact_size(const struct tl_contact_grid *grid, int64_t *width, int64_t *height);
void tl_contact_place(const struct tl_contact_grid *grid, size_t row, size_t column, int *x, int *y);

/* An empty sheet with all words on it. Its size must be within an image's limits. */
tl_image tl_contact_draw(const struct tl_contact_grid *grid);

/* A cell's picture (U8, 3 or 4 channels, of the cell's size) in its place; or a mark that there is none. */
void tl_contact_paste(const struct tl_contact_grid *grid, size_t row, size_t column, const tl_image *picture,
                      tl_image *sheet);
void tl_contact_mark_empty(const struct tl_contact_grid *grid, size_t row, size_t column, tl_image *sheet);

#endif
