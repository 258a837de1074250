/* The PEMs on the GPU: one filtered cube map per region [Knuth et al. 2014, 4], several in each cube map
 * array; or, as the paper proposes, cropped paraboloid maps (paraboloids.h), those of several regions in one
 * texture.
 *
 * RGBA16F, as in the paper. A sun beyond the range of half floats is preserved: all values are stored
 * multiplied by one power of two for the whole environment, which costs no precision, and the light pass
 * multiplies by `scale`. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_PEM_PEMS_H
#define TOILE_RENDER_PEM_PEMS_H

#include "render/gpu/gpu.h"
#include "render/pem/paraboloids.h"
#include "render/pem/regions.h"

#define TL_PEM_TEXEL_BYTES 8
#define TL_PEM_STORED_MAX                                                                                    \
    32768.0f /* half of the largest half float, so that filters do not overflow either */

enum tl_pem_layout { TL_PEM_CUBE, TL_PEM_PARABOLOID };

struct tl_pem_storage {
    int per_array; /* regions an array */
    int layout;    /* enum tl_pem_layout */
};

struct tl_pems {
    int count, per_array, array_count;
    int size;           /* texels a face of the cube */
    float scale;        /* radiance = scale x stored */
    tl_texture *arrays; /* cube map arrays, per_array cubes each, the last one fewer; or the textures that
                           hold as many regions' paraboloid maps */
    struct tl_paraboloid *paraboloids; /* by region; NULL: these are cubes */
    unsigned buffer;                   /* GL name: what the shader knows of them */
};

/* Cuts, filters and uploads all regions of `cube`; replaces the contents of `pems`. The chains are built in
 * parallel; the result does not depend on the number of threads. */
void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, struct tl_pem_storage storage);
/* Binds an array: cubes to `unit`, paraboloid maps to that of paraboloids.glsl, with their buffer. */
void tl_pems_bind(const struct tl_pems *pems, int array, unsigned unit);
void tl_pems_release(struct tl_pems *pems);
size_t tl_pems_bytes(const struct tl_pems *pems); /* of the textures */

/* Reads a level of the filtered cube of region `index` back from the GPU, as radiance; for checks. Paraboloid
 * maps are fetched at the centre of every texel. The caller releases the cube. */
tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level);

#endif
