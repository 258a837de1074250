#include "assets/model_export.h"

#include "assets/model.h"
#include "config/file.h"

#include <stdlib.h>

bool tl_model_export_glb(const char *path, const tl_surface *surfaces, size_t surface_count, tl_error *error)
{
    struct tl_writer writer;
    char *data;
    size_t size;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    if (!gltf_write_glb(path, surfaces, surface_count, &data, &size, error)) {
        tl_writer_abandon(&writer);
        return false;
    }
    fwrite(data, 1, size, writer.stream); /* a failure is kept by the stream and seen by the commit */
    free(data);
    return tl_writer_commit(&writer, error);
}
