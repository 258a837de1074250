/* Maps of a coarser garment, baked of a finer mesh of it, as files for detail.normals and detail.heights.
 * Errors: TL_INPUT as of render/detail/transfer.h, TL_OUTPUT. Threads: any. */
#ifndef TOILE_APP_TEXTURES_BAKED_MAPS_H
#define TOILE_APP_TEXTURES_BAKED_MAPS_H

#include "assets/model.h"
#include "render/detail/transfer.h"

/* Normals and heights of `fine` over the UVs of `coarse`, in the tangent frames that pictures of it have.
 * Names are those of messages. Release `out` with tl_transfer_release. */
bool tl_baked_maps_make(const char *coarse_name, const tl_model *coarse, const char *fine_name,
                        const tl_model *fine, const struct tl_transfer_params *params,
                        struct tl_transfer *out, tl_error *error);

/* Writes the normals, or into a .exr the heights in metres. */
bool tl_baked_maps_save(const char *path, const struct tl_transfer *maps, tl_error *error);

#endif
