#include "assets/model.h"

#include "assets/gltf/gltf_model.h"
#include "assets/obj/wavefront.h"
#include "assets/scan/scan.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <string.h>

bool tl_model_load(const char *path, tl_model *out, tl_error *error)
{
    return tl_model_load_in(path, TL_UNITS_AUTO, out, error);
}

bool tl_model_load_in(const char *path, enum tl_units wanted, tl_model *out, tl_error *error)
{
    const char *slash = strrchr(path, '/');
    *out = (tl_model){.name = tl_copy_string(slash ? slash + 1 : path)};
    bool loaded = tl_path_has_extension(path, "obj") ? wave_load_model(path, wanted, out, error)
                  : scan_is_file(path)               ? scan_load_model(path, wanted, out, error)
                                                     : gltf_load_model(path, wanted, out, error);
    if (!loaded)
        tl_model_release(out);
    return loaded;
}

bool tl_model_is_file(const char *path)
{
    return tl_path_has_extension(path, "glb") || tl_path_has_extension(path, "gltf") ||
           tl_path_has_extension(path, "obj") || scan_is_file(path);
}
