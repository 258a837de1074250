#include "app/report/folder.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdlib.h>

bool tl_folder_print(const char *folder, const char *name, const void *what,
                     void (*write)(const void *what, FILE *out), tl_error *error)
{
    struct tl_writer writer;
    char *path = tl_format("%s/%s", folder, name);
    bool written = tl_writer_begin(&writer, path, error);
    if (written) {
        write(what, writer.stream);
        written = tl_writer_commit(&writer, error);
    }
    free(path);
    return written;
}

struct bytes {
    const void *data;
    size_t size;
};

static void write_bytes(const void *what, FILE *out)
{
    const struct bytes *bytes = what;
    fwrite(bytes->data, 1, bytes->size, out);
}

bool tl_folder_put(const char *folder, const char *name, const void *bytes, size_t size, tl_error *error)
{
    return tl_folder_print(folder, name, &(const struct bytes){bytes, size}, write_bytes, error);
}
