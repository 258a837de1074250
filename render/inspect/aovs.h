/* The layers of an image beside its light (AOVs), for files of several layers. */
#ifndef TOILE_RENDER_INSPECT_AOVS_H
#define TOILE_RENDER_INSPECT_AOVS_H

#include "render/renderer.h"

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

/* Of the image drawn last, whose frame must have asked for layers and still be there. Each pixel has the
 * values of the one sample nearest to its middle: normals and places of different surfaces have no mean.
 * `out` is to be released. */
bool tl_renderer_read_aovs(const tl_renderer *renderer, struct tl_aovs *out, tl_error *error);
void tl_aovs_release(struct tl_aovs *aovs);

#endif
