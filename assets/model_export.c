#include "assets/model_export.h"

#include "assets/gltf/gltf_model.h"
#include "assets/obj/wavefront.h"
#include "config/base/file.h"

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
    fwrite(data, 1, size, writer.stream); /* the stream remembers a failure until the commit */
    free(data);
    return tl_writer_commit(&writer, error);
}

bool tl_model_export_obj(const char *path, const tl_model *model, const tl_surface *surface, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    wave_write(writer.stream, model, surface);
    return tl_writer_commit(&writer, error);
}
