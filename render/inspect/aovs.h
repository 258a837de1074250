/* The auxiliary layers of an image (AOVs), for files of several layers. */
#ifndef TOILE_RENDER_INSPECT_AOVS_H
#define TOILE_RENDER_INSPECT_AOVS_H

#include "render/inspect/inspect.h"

#define TL_AOVS_MAX 7

/* The one channel of the layer that is 1 where the garment (TL_SURFACE_GARMENT) is nearest, else 0. */
#define TL_AOV_GARMENT "garment.Y"

struct tl_aov {
    const char *const *channels; /* "N.x", "N.y", "N.z" ...: as many as the image has */
    tl_image image;              /* F32, of the image's size; 0 where nothing is */
};

/* N and P: world, metres; uv: as the mesh has them; albedo: kd, linear; visibility: as struct tl_inspection
 * has it, in [0, 1], only where rays keep it; strain: shares of 1, only where a surface knows its strains;
 * garment: 1 or 0. */
struct tl_aovs {
    int count;
    struct tl_aov items[TL_AOVS_MAX];
};

/* `request->image` is the whole image's; visibility is there when its points are, strain when `has_strains`.
 * `out` is to be released. Each pixel has the values of the one sample nearest to its middle: normals and
 * places of different surfaces have no mean. */
void tl_aovs_make(const struct tl_inspect_request *request, bool has_strains, struct tl_aovs *out);
void tl_aovs_release(struct tl_aovs *aovs);
/* The garment's layer alone, one channel: the pixels over which render/metrics/compare.h measures the
 * garment. To be released. */
tl_image tl_aovs_make_garment(const struct tl_inspect_request *request);

#endif
