/* Turns samples into pixels on the CPU: the box filter of a whole number of samples a pixel side, as
 * resolve.frag has it; else resample.h. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_PRESENT_RESOLVE_H
#define TOILE_RENDER_PRESENT_RESOLVE_H

#include "render/present/resample.h"

/* All four channels alike: light that is premultiplied by the coverage in alpha, and coverage. */
void tl_resolve(const struct tl_resample *resolve);

#endif
