/* The cosine lobe K_s of a glossiness. Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_EXPONENT_H
#define TOILE_RENDER_ENV_EXPONENT_H

/* Exponent s = 1 / (1 - g) of glossiness g, clamped to [1, 1e6]. */
float tl_lobe_exponent(float glossiness);

/* K_s(d, w) = (s + 1) / 2pi * max(0, d . w)^s for the cosine d . w. Its integral over the sphere is 1. */
float tl_lobe_cosine(float exponent, float cosine);

#endif
