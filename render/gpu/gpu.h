/* The thin GL floor: the only files that create GL contexts and resources. GL 4.5 core through libepoxy.
 *
 * One tl_gpu is current on one thread. In debug builds of the context every GL message of severity medium or
 * worse is logged and counted (tl_gpu_message_count), so a test can demand none. */
#ifndef TOILE_RENDER_GPU_GPU_H
#define TOILE_RENDER_GPU_GPU_H

#include "config/embedded.h"
#include "config/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct tl_gpu tl_gpu;

/* Surfaceless EGL: needs no display. Software Mesa is fine. */
tl_gpu *tl_gpu_create_headless(tl_error *error);
/* Adopts the context that is current on this thread (a window's). */
tl_gpu *tl_gpu_create_current(tl_error *error);
void tl_gpu_destroy(tl_gpu **gpu);

const char *tl_gpu_name(const tl_gpu *gpu);     /* GL_RENDERER and version, for reports */
size_t tl_gpu_message_count(const tl_gpu *gpu); /* GL debug messages so far */
size_t tl_gpu_texture_bytes(const tl_gpu *gpu); /* memory of all live textures, computed from their formats */

typedef struct tl_texture {
    tl_gpu *gpu;
    unsigned id, target; /* GL names */
    unsigned format;     /* sized internal format */
    int width, height, layers, levels;
} tl_texture;

/* Immutable storage: target GL_TEXTURE_2D, _2D_ARRAY, _CUBE_MAP or _CUBE_MAP_ARRAY (layers counts faces: 6 a
 * cube). */
tl_texture tl_texture_create(tl_gpu *gpu, unsigned target, unsigned format, int width, int height, int layers,
                             int levels);
void tl_texture_destroy(tl_texture *texture);

/* Programs from shader files: embedded at build, or from the folder in TOILE_SHADER_DIR when it is set (then
 * reloaded when a file changes). `#include "name.glsl"` is expanded, `#line` kept true. A program that does
 * not compile fails with the compiler's first message, file and line. */
typedef struct tl_program {
    unsigned id;
    char name[64];
} tl_program;
bool tl_program_create(tl_gpu *gpu, const struct tl_embedded *shaders, const char *vertex,
                       const char *fragment, tl_program *out, tl_error *error);
void tl_program_destroy(tl_program *program);

#endif
