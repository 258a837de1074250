/* The back-ends of visibility, and the options of rays (from table "light", light/options.h). */
#ifndef TOILE_RENDER_VISIBILITY_OPTIONS_H
#define TOILE_RENDER_VISIBILITY_OPTIONS_H

#include <stdbool.h>

/* auto: the program chooses between rays and maps at start (app/budget/back_end.h); the renderer gets one. */
enum tl_visibility { TL_VISIBILITY_VSM, TL_VISIBILITY_DEPTH, TL_VISIBILITY_RAYS, TL_VISIBILITY_AUTO };
/* The numbers in which variance maps keep moments: RG32F, or RG16F [as Knuth et al. 2014, figure 8]. */
enum tl_moments { TL_MOMENTS_FLOAT, TL_MOMENTS_HALF };

struct tl_ray_params {
    int rays;          /* directions a region and refresh, at least 1 */
    int refresh;       /* regions traced again for each point and moving frame; 0: all */
    int rounds;        /* at rest, so many jittered frames are averaged */
    float repair;      /* share of the samples, the least certain, that get rays of their own */
    float repair_rest; /* ... once nothing moves, when it is more */
    bool
        weighs_solid_angle; /* regions matter by their solid angle (ambient occlusion), else by their power */
};

#endif
