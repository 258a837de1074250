/* toile bake: writes normals or heights of a finer mesh as a map of a coarser one. */
#include "app/batch/commands.h"
#include "app/textures/baked_maps.h"
#include "config/base/file.h"
#include "config/base/log.h"

#define SIDE     1024
#define REACH_MM 20

static bool check_arguments(const struct tl_arguments *arguments, tl_error *error)
{
    const char *output = arguments->output;
    if (arguments->positional_count != 2)
        return tl_fail(error, TL_USAGE, "bake: two meshes are needed: toile bake COARSE FINE -o OUT.png");
    if (!output || (!tl_path_has_extension(output, "png") && !tl_path_has_extension(output, "exr")))
        return tl_fail(error, TL_USAGE,
                       "%s: unknown kind of file: add -o FILE.png for normals, .exr for heights",
                       output ? output : "bake");
    if (arguments->map_size > TL_TRANSFER_SIDE_MAX)
        return tl_fail(error, TL_USAGE, "--size: %d: expected at most %d", arguments->map_size,
                       TL_TRANSFER_SIDE_MAX);
    return true;
}

static bool bake(const struct tl_arguments *arguments, const tl_model *coarse, const tl_model *fine,
                 tl_error *error)
{
    const int side = arguments->map_size > 0 ? arguments->map_size : SIDE;
    const double reach_mm = arguments->reach_mm > 0 ? arguments->reach_mm : REACH_MM;
    const struct tl_transfer_params params = {side, side, (float)(reach_mm / 1000)};
    struct tl_transfer maps;
    if (!tl_baked_maps_make(arguments->positionals[0], coarse, arguments->positionals[1], fine, &params,
                            &maps, error))
        return false;
    tl_info("%s: %zu texels in its charts, %zu of them without the finer mesh within %g mm",
            arguments->positionals[0], maps.covered, maps.missed, reach_mm);
    if (maps.shared > 0)
        tl_warn("%s: %zu texels belong to several triangles: its charts overlap, and one of them decides",
                arguments->positionals[0], maps.shared);
    bool written = tl_baked_maps_save(arguments->output, &maps, error);
    tl_transfer_release(&maps);
    return written;
}

bool tl_command_bake(const struct tl_arguments *arguments, tl_error *error)
{
    tl_model coarse, fine;
    if (!check_arguments(arguments, error) || !tl_model_load(arguments->positionals[0], &coarse, error))
        return false;
    bool baked = tl_model_load(arguments->positionals[1], &fine, error);
    if (baked) {
        baked = bake(arguments, &coarse, &fine, error);
        tl_model_release(&fine);
    }
    tl_model_release(&coarse);
    return baked;
}
