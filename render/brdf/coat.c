#include "render/brdf/coat.h"

#include "render/brdf/brdf.h"

float tl_coat_reflectance(float cosine)
{
    const struct tl_brdf film = {.gloss = {.fresnel = TL_FRESNEL_DIELECTRIC, .index = TL_COAT_INDEX},
                                 .f0 = {{1, 1, 1}}};
    return tl_brdf_fresnel(&film, cosine).x;
}
