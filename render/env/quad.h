/* Four floats that the compiler keeps in one vector register: a colour with alpha, a direction with
 * something. */
#ifndef TOILE_RENDER_ENV_QUAD_H
#define TOILE_RENDER_ENV_QUAD_H

#include "config/base/simd.h"

typedef float tl_quad __attribute__((vector_size(4 * sizeof(float)), aligned(4)));

#endif
