/* The layers of an image beside its light (AOVs), for files of several layers. */
#ifndef TOILE_RENDER_INSPECT_AOVS_H
#define TOILE_RENDER_INSPECT_AOVS_H

#include "assets/base/image.h"

#define TL_AOVS_MAX 6

struct tl_aov {
    const char *const *channels; /* "N.x", "N.y", "N.z" ...: as many as the image has */
    tl_image image;              /* F32, of the image's size; 0 where nothing is */
};

/* N and P: world, metres; uv: as the mesh has them; albedo: kd, linear; visibility: as struct tl_inspection
 * has it, in [0, 1], only where rays keep it; strain: shares of 1, only where a surface knows its strains. */
struct tl_aovs {
    int count;
    struct tl_aov items[TL_AOVS_MAX];
};

void tl_aovs_release(struct tl_aovs *aovs);

#endif
