/* The PEMs on the GPU: one filtered cube map per region [002, section 4], several in each cube map array; or,
 * as the paper proposes, cropped paraboloid maps for the fine levels (paraboloids.h), those of each array in
 * one texture, and cube maps for the coarse ones alone. paraboloids.glsl reads the latter.
 *
 * RGBA16F, as in the paper. A sun beyond the range of half floats is preserved: all values are stored
 * multiplied by one power of two for the whole environment, which costs no precision, and the light pass
 * multiplies by `scale`. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_PEM_PEMS_H
#define TOILE_RENDER_PEM_PEMS_H

#include "render/gpu/gpu.h"
#include "render/pem/paraboloids.h"

#define TL_PEM_TEXEL_BYTES 8
#define TL_PEM_STORED_MAX                                                                                    \
    32768.0f /* half of the largest half float, so that filters do not overflow either */

enum tl_pem_layout { TL_PEM_CUBE, TL_PEM_PARABOLOID };

struct tl_pem_storage {
    int per_array; /* regions an array */
    int layout;    /* enum tl_pem_layout */
};

struct tl_pems {
    int count, per_array, array_count, size;
    float scale;        /* radiance = scale x stored */
    int cube_level;     /* the level of the chain that is level 0 of the cubes: those below are paraboloids */
    tl_texture *arrays; /* cube map arrays, per_array cubes each; the last one fewer */
    tl_texture *maps;   /* one an array: the paraboloid maps of its regions; NULL: there are none */
    struct tl_paraboloid *paraboloids; /* by region */
    unsigned buffer;                   /* GL name: what the shader knows of them */
};

/* Cuts, filters and uploads all regions of `cube`; replaces the contents of `pems`. The chains are built in
 * parallel; the result does not depend on the number of threads. */
void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, struct tl_pem_storage storage);
/* Binds the textures of an array, the cubes to `unit`. */
void tl_pems_bind(const struct tl_pems *pems, int array, unsigned unit);
void tl_pems_release(struct tl_pems *pems);
size_t tl_pems_bytes(const struct tl_pems *pems); /* of the textures */

/* Reads a level of the filtered cube of region `index` back from the GPU, as radiance; for checks. Paraboloid
 * maps are fetched at the centre of every texel. The caller releases the cube. */
tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level);

#endif
