#include "app/textures/baked_maps.h"

#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "render/detail/bake.h"

#include <stdlib.h>

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

bool tl_baked_maps_make(const char *coarse_name, const tl_model *coarse, const char *fine_name,
                        const tl_model *fine, const struct tl_transfer_params *params,
                        struct tl_transfer *out, tl_error *error)
{
    tl_surface coarse_surface = tl_surface_of_mesh(coarse_name, &coarse->mesh, coarse->materials);
    tl_surface fine_surface = tl_surface_of_mesh(fine_name, &fine->mesh, fine->materials);
    vec4s *tangents = tangents_of(&coarse->mesh);
    coarse_surface.tangents = tangents;
    bool made = tl_transfer_make(&coarse_surface, &fine_surface, params, out, error);
    free(tangents);
    return made;
}

bool tl_baked_maps_save(const char *path, const struct tl_transfer *maps, tl_error *error)
{
    static const char *const names[] = {"Y"};
    if (tl_path_has_extension(path, "exr"))
        return tl_exr_save(path, &(struct tl_exr_layer){names, &maps->heights}, 1, error);
    tl_image encoded = tl_bake_encoded(&maps->normals);
    bool written = tl_image_save_png(path, &encoded, error);
    tl_image_release(&encoded);
    return written;
}
