/* The C face of terms.glsl: the light's scalar terms, one text for both languages. Pure. */
#ifndef TOILE_RENDER_LIGHT_TERMS_H
#define TOILE_RENDER_LIGHT_TERMS_H

#include "render/env/exponent.h"

#include "render/gpu/terms_begin.h"

#include "render/light/terms.glsl"

#include "render/gpu/terms_end.h"

#endif
