/* OBJ and MTL files as lines of words, and the materials of MTL files. */
#ifndef TOILE_ASSETS_OBJ_WAVEFRONT_INTERNAL_H
#define TOILE_ASSETS_OBJ_WAVEFRONT_INTERNAL_H

#include "assets/obj/wavefront.h"

#include <locale.h>

/* A text being read. Lines end in \n, \r\n or \r; a backslash before the end joins the next line. */
struct wave_text {
    const char *path; /* for messages; borrowed */
    char *data;
    char *next, *end; /* what follows the current line */
    char *word;       /* what follows the current word, within the line */
    size_t line;      /* number, from 1 */
    locale_t plain;   /* numbers are read in the C locale */
};

/* Reads a file; wave_close releases it, also after a failure. */
bool wave_open(const char *path, struct wave_text *out, tl_error *error);
void wave_close(struct wave_text *text);

/* Moves to the next line that has a word and returns that word; NULL at the end. */
char *wave_line(struct wave_text *text);
/* The line's next word, or NULL. */
char *wave_word(struct wave_text *text);
/* The rest of the line, without blanks at its ends; may be empty. */
char *wave_rest(struct wave_text *text);

/* Reads `count` finite numbers from the line's next words. False, with a message that names the line and
 * `what`, when one is missing or is no number. */
bool wave_numbers(struct wave_text *text, const char *what, int count, float *out, tl_error *error);

/* Fills the model's materials and images from the MTL files that `object` names. A file or an image that
 * cannot be read is noted as ignored. (wavefront_materials.c) */
void wave_read_materials(const char *path, const struct wave_object *object, tl_model *model);

#endif
