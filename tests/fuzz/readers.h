/* The readers of files as functions of bytes: what `./dev fuzz` feeds with damaged input, and what
 * test_corpus replays the kept corpus through.
 *
 * An input is written into a scratch folder under a name with the reader's extension, and read from there as
 * the program reads it, with what follows on reading: posing, sewing, cutting, the audit. Files that it may
 * name are there too: itself (an OBJ file is its own library of materials) and a picture, dot.png.
 *
 * Errors: an input that a reader refuses without one line that says why, or whose result breaks what the
 * reader's header promises, ends the process with abort(). Threads: one. */
#ifndef TOILE_TESTS_FUZZ_READERS_H
#define TOILE_TESTS_FUZZ_READERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct fuzz_reader {
    const char *name;      /* of its folder in tests/fuzz/corpus */
    const char *extension; /* of the file that it reads */
    bool (*read)(const char *path);
};

/* The last has no name. */
extern const struct fuzz_reader fuzz_readers[];

/* NULL: there is none of that name. */
const struct fuzz_reader *fuzz_reader_named(const char *name);

/* Makes the scratch folder, an empty one of this process, and moves into it. */
void fuzz_begin(void);
/* Whether the reader accepts the bytes. */
bool fuzz_read(const struct fuzz_reader *reader, const void *bytes, size_t size);
/* Removes the scratch folder. */
void fuzz_end(void);

#endif
