/* Places the cells of a contact sheet and draws its text: a table of rows and columns with labels at both,
 * under a title. The cells of a sheet with one column follow one another in lines, each with its label below.
 *
 * Lengths are pixels, x to the right and y down from the sheet's upper left corner. Errors: none. Lifetime: a
 * grid borrows its texts. Threads: any, each with pictures of its own. */
#ifndef TOILE_APP_SHEET_CONTACT_LAYOUT_H
#define TOILE_APP_SHEET_CONTACT_LAYOUT_H

#include "assets/base/image.h"

/* UTF-8. */
struct tl_contact_label {
    const char *group; /* heading above neighbours that share it; "": none */
    const char *name;  /* "": none */
};

struct tl_contact_grid {
    const char *title, *note; /* a line each; the note may be "" */
    const struct tl_contact_label *rows, *columns;
    size_t row_count, column_count;
    int cell_width, cell_height;
};

/* Computes the size of the whole sheet, which may be beyond an image's limits (tl_image_size_check). */
void tl_contact_size(const struct tl_contact_grid *grid, int64_t *width, int64_t *height);

/* Computes the upper left corner of a cell. */
void tl_contact_place(const struct tl_contact_grid *grid, size_t row, size_t column, int *x, int *y);

/* Draws the sheet with all its text and no cells: U8, 3 channels; release it with tl_image_release. Its size
 * must be within an image's limits. */
tl_image tl_contact_draw(const struct tl_contact_grid *grid);

/* Copies a picture (U8, 3 or 4 channels, of the cell's size) into its cell. */
void tl_contact_paste(const struct tl_contact_grid *grid, size_t row, size_t column, const tl_image *picture,
                      tl_image *sheet);

/* Marks a cell as one that could not be rendered. */
void tl_contact_mark_empty(const struct tl_contact_grid *grid, size_t row, size_t column, tl_image *sheet);

#endif
