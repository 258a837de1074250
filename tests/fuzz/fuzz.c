/* The harness of `./dev fuzz`: libFuzzer's entry points (LLVM, "libFuzzer: a library for coverage-guided fuzz
 * testing"). The environment variable TOILE_FUZZ_READER names the reader. */
#include "tests/fuzz/readers.h"

#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static const struct fuzz_reader *reader;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    const char *name = getenv("TOILE_FUZZ_READER");
    reader = fuzz_reader_named(name ? name : "");
    if (!reader) {
        fprintf(stderr, "TOILE_FUZZ_READER: expected the name of a reader (tests/fuzz/readers.c)\n");
        exit(2);
    }
    fuzz_begin();
    atexit(fuzz_end);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_read(reader, bytes, size);
    return 0;
}
