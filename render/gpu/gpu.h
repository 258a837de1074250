/* The thin GL floor: the only files that create GL contexts and resources. GL 4.5 core through libepoxy.
 *
 * One tl_gpu is current on one thread. Every GL message of an error, of undefined, deprecated or unportable
 * use is logged and counted (tl_gpu_message_count), so a test can demand none; hints about speed are printed
 * by --verbose. */
#ifndef TOILE_RENDER_GPU_GPU_H
#define TOILE_RENDER_GPU_GPU_H

#include "assets/base/image.h"
#include "config/base/error.h"
#include "config/embedded.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tl_gpu tl_gpu;

/* The devices of EGL, in its order; commands number them from 1. Software Mesa is one. */
#define TL_GPU_DEVICES_MAX 16
struct tl_gpu_device {
    char name[256]; /* as tl_gpu_name; or why it cannot be used */
    bool opens;
};
/* Opens each in turn, and leaves no context current. Returns how many there are; -1: error. */
int tl_gpu_devices(struct tl_gpu_device out[TL_GPU_DEVICES_MAX], tl_error *error);
/* The device that headless contexts are created on from now on, from 1; 0: EGL's own choice, else the first
 * that opens. Threads: before the first context. */
void tl_gpu_choose(int device);

/* Needs no display: on EGL's surfaceless platform, or on a device. */
tl_gpu *tl_gpu_create_headless(tl_error *error);
/* Adopts the context that is current on this thread (a window's). */
tl_gpu *tl_gpu_create_current(tl_error *error);
void tl_gpu_destroy(tl_gpu **gpu);

/* Makes a headless context current on this thread, or current on none, so that several contexts, or several
 * threads one after the other, can be used by one program. Nothing happens to a window's. */
bool tl_gpu_bind(tl_gpu *gpu, tl_error *error);
void tl_gpu_unbind(tl_gpu *gpu);

const char *tl_gpu_name(const tl_gpu *gpu);     /* GL_RENDERER and version, for reports */
bool tl_gpu_is_software(const tl_gpu *gpu);     /* Mesa's llvmpipe: it runs on the cores of the CPU */
size_t tl_gpu_message_count(const tl_gpu *gpu); /* faults that GL has reported so far */
/* Memory of all live textures, computed from their formats, and of all live storage buffers (compute.h). */
size_t tl_gpu_bytes(const tl_gpu *gpu);
int tl_gpu_texture_side_max(const tl_gpu *gpu); /* texels */
/* Whether GL had the memory for all that was asked of it since the last check. Where it had not, textures and
 * images that were read are not what they should be. */
bool tl_gpu_check(const tl_gpu *gpu, tl_error *error);
int tl_gpu_subpixel_bits(const tl_gpu *gpu); /* places are rounded to 2^-bits of a sample as they are drawn */

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
size_t tl_texture_bytes(const tl_texture *texture);
/* Levels of a full mip chain down to one texel. */
int tl_texture_full_levels(int width, int height);
/* Fills a layer of a two-dimensional texture of the image's size, all levels: those below the first are the
 * CPU's averages (map_texture.h). `colour`: bytes are sRGB unless the image is marked linear. */
void tl_texture_fill(const tl_texture *texture, int layer, const tl_image *image, bool colour);

/* The target of a pass: up to six 2D colour textures of one size, and a 32-bit float depth texture. */
#define TL_TARGET_COLOURS_MAX 6
typedef struct tl_target {
    unsigned id; /* GL framebuffer */
    int width, height, colour_count;
    tl_texture colours[TL_TARGET_COLOURS_MAX];
    tl_texture depth; /* id 0: none */
} tl_target;
tl_target tl_target_create(tl_gpu *gpu, int width, int height, const unsigned *formats, int colour_count,
                           bool depth);
/* Makes a target without a depth of its own as large as another one, whose depth it then shares. Nothing of
 * its colours is kept when size or formats change. */
void tl_target_fit(tl_target *target, tl_gpu *gpu, const tl_target *like, const unsigned *formats,
                   int colour_count);
void tl_target_destroy(tl_target *target);
size_t tl_target_bytes(const tl_target *target);

/* Programs from shader files: as embedded at build, or, where the folder in TOILE_SHADER_DIR holds them (laid
 * out as render/ is: light/light.frag), from there. `#include "name.glsl"` is expanded, `#line` kept true. A
 * program that does not compile fails with the compiler's first message, file and line. */
typedef struct tl_program {
    unsigned id;
    char name[64];
    const struct tl_embedded *shaders;
    const char *vertex, *fragment; /* file names; must live as long as the program */
    const char *compute;           /* ... in place of these */
    const char *defines;           /* lines that follow #version in all files, or NULL; must live as long */
} tl_program;
bool tl_program_create(tl_gpu *gpu, const struct tl_embedded *shaders, const char *vertex,
                       const char *fragment, tl_program *out, tl_error *error);
/* One of several programs that are made from the same files by what is #defined. */
bool tl_program_create_variant(tl_gpu *gpu, const struct tl_embedded *shaders, const char *vertex,
                               const char *fragment, const char *defines, tl_program *out, tl_error *error);
/* A program of one compute shader. `defines` as above. */
bool tl_program_create_compute(tl_gpu *gpu, const struct tl_embedded *shaders, const char *compute,
                               const char *defines, tl_program *out, tl_error *error);
void tl_program_destroy(tl_program *program);
/* Builds the program again from its files; on failure the old one stays in use. */
bool tl_program_reload(tl_program *program, tl_error *error);
/* Changes when a file of `shaders` in TOILE_SHADER_DIR does; constant when that is not set. */
uint64_t tl_shaders_stamp(const struct tl_embedded *shaders);

/* Resets GL's state to that of a fresh context, so that a pass does not depend on earlier drawing (a window's
 * panel). */
void tl_gpu_reset_state(const tl_gpu *gpu);
/* One triangle that covers the viewport, for programs whose vertex file is fullscreen.vert; at depth 1. */
void tl_gpu_draw_fullscreen(const tl_gpu *gpu);

#endif
