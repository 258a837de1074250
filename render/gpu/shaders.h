/* The shader files of every technique, embedded at build (render/CMakeLists.txt). */
#ifndef TOILE_RENDER_GPU_SHADERS_H
#define TOILE_RENDER_GPU_SHADERS_H

#include "config/embedded.h"

extern const struct tl_embedded tl_embedded_shaders[];

#endif
