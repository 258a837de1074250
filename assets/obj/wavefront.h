/* Wavefront OBJ and MTL: reading lines of words, and what an OBJ file holds. Private to assets.
 *
 * Read here and not by tinyobjloader (2.0rc10), which was tried: it takes `v 1 abc 2` for (1, 0, 2), a
 * missing coordinate for 0, 1e400 for infinity and the index 4294967299 for 3, and only warns of indices out
 * of range. A garment that is silently wrong is worse than one that is refused. */
#ifndef TOILE_ASSETS_OBJ_WAVEFRONT_H
#define TOILE_ASSETS_OBJ_WAVEFRONT_H

#include "assets/model.h"
#include "config/error.h"

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

bool wave_open(const char *path, struct wave_text *out, tl_error *error);
void wave_close(struct wave_text *text);

/* Moves to the next line that has a word and returns that word; NULL at the end. */
char *wave_line(struct wave_text *text);
/* The line's next word, or NULL. */
char *wave_word(struct wave_text *text);
/* The rest of the line, without blanks at its ends; may be empty. */
char *wave_rest(struct wave_text *text);

/* `count` finite numbers from the line's next words; false, with a message that names the line and `what`,
 * when they are not all there. */
bool wave_numbers(struct wave_text *text, const char *what, int count, float *out, tl_error *error);

#define WAVE_NONE UINT32_MAX

struct wave_corner {
    uint32_t position, uv, normal; /* uv, normal: WAVE_NONE when the file gives none */
};

struct wave_face {
    uint32_t corner_end; /* one past its last corner */
    uint32_t group;      /* rises where the file begins a group or an object */
    uint32_t material;   /* index into `materials` */
};

struct wave_object {
    size_t position_count, uv_count, normal_count, corner_count, face_count, triangle_count, material_count,
        library_count;
    vec3s *positions; /* units of the file */
    vec2s *uvs;       /* v runs up */
    vec3s *normals;   /* not yet unit */
    struct wave_corner *corners;
    struct wave_face *faces;
    char **materials; /* names; the first is "", of faces without one */
    char **libraries; /* names of MTL files, as given */
    size_t ignored_count;
    char **ignored; /* keywords without effect, each once */
};

/* Reads and checks a whole file: every number finite, every index in range. */
bool wave_read(const char *path, struct wave_object *out, tl_error *error);
void wave_release(struct wave_object *object);

/* Materials of the MTL files that `object` names, and a default one after them; images. A file or a picture
 * that cannot be read is noted as ignored (mtl.c). */
void wave_read_materials(const char *path, const struct wave_object *object, tl_model *model);

/* .obj as a model; positions in units of the file (obj.c). */
bool wave_load_model(const char *path, tl_model *out, tl_error *error);

#endif
