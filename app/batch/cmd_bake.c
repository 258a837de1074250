/* toile bake: writes normals or heights of a finer mesh as a map of a coarser one. */
#include "app/batch/commands.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/model.h"
#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "config/file.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/detail/bake.h"
#include "render/transfer/transfer.h"

#include <stdlib.h>

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

/* The tangents that pictures of the mesh have. The caller frees them. */
static vec4s *tangents_of(const tl_mesh *mesh)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    vec3s *normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    vec4s *tangents = TL_NEW_ARRAY(vec4s, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, weld);
    tl_tangent_frames_update(frames, mesh->positions, normals, tangents);
    tl_tangent_frames_destroy(&frames);
    free(weld);
    free(normals);
    return tangents;
}

static bool write_map(const char *path, const struct tl_transfer *maps, tl_error *error)
{
    static const char *const names[] = {"Y"};
    if (tl_path_has_extension(path, "exr"))
        return tl_exr_save(path, &(struct tl_exr_layer){names, &maps->heights}, 1, error);
    tl_image encoded = tl_bake_encoded(&maps->normals);
    bool written = tl_image_save_png(path, &encoded, error);
    tl_image_release(&encoded);
    return written;
}

static bool bake(const struct tl_arguments *arguments, const tl_model *coarse, const tl_model *fine,
                 tl_error *error)
{
    const int side = arguments->map_size > 0 ? arguments->map_size : SIDE;
    const double reach_mm = arguments->reach_mm > 0 ? arguments->reach_mm : REACH_MM;
    const struct tl_transfer_params params = {side, side, (float)(reach_mm / 1000)};
    tl_surface coarse_surface =
        tl_surface_of_mesh(arguments->positionals[0], &coarse->mesh, coarse->materials);
    tl_surface fine_surface = tl_surface_of_mesh(arguments->positionals[1], &fine->mesh, fine->materials);
    vec4s *tangents = tangents_of(&coarse->mesh);
    struct tl_transfer maps;
    coarse_surface.tangents = tangents;
    bool made = tl_transfer_make(&coarse_surface, &fine_surface, &params, &maps, error);
    free(tangents);
    if (!made)
        return false;
    tl_info("%s: %zu texels in its charts, %zu of them without the finer mesh within %g mm",
            arguments->positionals[0], maps.covered, maps.missed, reach_mm);
    if (maps.shared > 0)
        tl_warn("%s: %zu texels belong to several triangles: its charts overlap, and one of them decides",
                arguments->positionals[0], maps.shared);
    bool written = write_map(arguments->output, &maps, error);
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
