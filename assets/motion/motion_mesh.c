#include "assets/motion/motion_mesh.h"

#include "assets/motion/sequence.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static char *first_of_sequence(const char *pattern, tl_error *error)
{
    int *numbers;
    size_t count;
    if (!tl_sequence_list(pattern, &numbers, &count, error))
        return NULL;
    char *path = tl_sequence_path(pattern, numbers[0]);
    free(numbers);
    return path;
}

char *tl_motion_find_mesh(const char *motion, tl_error *error)
{
    static const char *const extensions[] = {"obj", "glb", "gltf"};
    if (tl_sequence_is_pattern(motion))
        return first_of_sequence(motion, error);
    const char *slash = strrchr(motion, '/'), *dot = strrchr(motion, '.');
    int stem = (int)(dot && (!slash || dot > slash) ? dot - motion : (ptrdiff_t)strlen(motion));
    for (size_t i = 0; i < TL_COUNT(extensions); i++) {
        char *path = tl_format("%.*s.%s", stem, motion, extensions[i]);
        if (tl_file_exists(path))
            return path;
        free(path);
    }
    tl_fail(error, TL_INPUT,
            "%s: moves a mesh, and there is no .obj, .glb or .gltf file of its name beside it: open the mesh "
            "and add --motion %s",
            motion, slash ? slash + 1 : motion);
    return NULL;
}
