/* The members of a tl_gpu, shared by the files of render/gpu. */
#ifndef TOILE_RENDER_GPU_CONTEXT_H
#define TOILE_RENDER_GPU_CONTEXT_H

#include "render/gpu/compute.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

struct tl_gpu {
    EGLDisplay display; /* EGL_NO_DISPLAY for an adopted context */
    EGLContext context;
    GLuint empty_vertices; /* vertex array without attributes, for the full-screen triangle */
    GLint texture_side_max, subpixel_bits;
    struct tl_compute_limits compute;
    size_t message_count;
    size_t bytes; /* of textures and storage buffers */
    char name[256];
};

#endif
