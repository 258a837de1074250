/* The inputs of a frame that options of the renderer affect, one bit each. The hash of such an input
 * covers the options whose rows have its bit (render/frame/inputs.c), and a job runs again when the
 * hash of an input that it reads has changed. Threads: constants. */
#ifndef TOILE_RENDER_PLAN_AFFECTS_H
#define TOILE_RENDER_PLAN_AFFECTS_H

#include "config/options.h"

#define TL_AFFECTS_RENDER_BIT(i) TL_AFFECTS_BIT(TL_AFFECTS_RENDER + (i))

#define TL_AFFECTS_SIZE        TL_AFFECTS_RENDER_BIT(0) /* image size and samples per pixel */
#define TL_AFFECTS_GROUND      TL_AFFECTS_RENDER_BIT(1)
#define TL_AFFECTS_PEM_SIZE    TL_AFFECTS_RENDER_BIT(2)
#define TL_AFFECTS_FILTER      TL_AFFECTS_RENDER_BIT(3) /* how PEMs are filtered */
#define TL_AFFECTS_SUN         TL_AFFECTS_RENDER_BIT(4)
#define TL_AFFECTS_REGIONS     TL_AFFECTS_RENDER_BIT(5)  /* how the environment is cut */
#define TL_AFFECTS_PASSES      TL_AFFECTS_RENDER_BIT(6)  /* how PEMs are stored */
#define TL_AFFECTS_SHADOW_MAPS TL_AFFECTS_RENDER_BIT(7)  /* size and blur of the shadow maps */
#define TL_AFFECTS_RAYS        TL_AFFECTS_RENDER_BIT(8)  /* how rays are spent */
#define TL_AFFECTS_LIGHT       TL_AFFECTS_RENDER_BIT(9)  /* how light is put together */
#define TL_AFFECTS_LAMPS       TL_AFFECTS_RENDER_BIT(10) /* shading under lamps */
#define TL_AFFECTS_REFERENCE   TL_AFFECTS_RENDER_BIT(11)
#define TL_AFFECTS_DETAIL      TL_AFFECTS_RENDER_BIT(12) /* how detail maps are read */
#define TL_AFFECTS_DETAIL_MAPS                                                                               \
    TL_AFFECTS_RENDER_BIT(13)                        /* which detail maps there are, and their content       \
                                                      */
#define TL_AFFECTS_SHOW    TL_AFFECTS_RENDER_BIT(14) /* from linear radiance to the screen */
#define TL_AFFECTS_ENVMAP  TL_AFFECTS_RENDER_BIT(15) /* environment maps: size */
#define TL_AFFECTS_LAYOUT  TL_AFFECTS_RENDER_BIT(16) /* ... layout */
#define TL_AFFECTS_LOOK_UP TL_AFFECTS_RENDER_BIT(17) /* ... how they are looked up */
#define TL_AFFECTS_CAPTURE TL_AFFECTS_RENDER_BIT(18) /* ... what a capture of the scene shows */
#define TL_AFFECTS_VIEW    TL_AFFECTS_RENDER_BIT(19) /* which view is shown in place of light */
#define TL_AFFECTS_VIEW_SCALE                                                                                \
    TL_AFFECTS_RENDER_BIT(20) /* how such a view is drawn; nothing while light is shown */
#define TL_AFFECTS_RATIO TL_AFFECTS_RENDER_BIT(21) /* where the ratio of seen to exact light is computed */

#endif
