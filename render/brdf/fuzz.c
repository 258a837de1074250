#include "render/brdf/fuzz.h"

float tl_fuzz_under(const tl_material *material, float facing)
{
    if (!tl_material_has_fuzz(material))
        return 1;
    float x = fminf(fmaxf(facing, 0), 1);
    return 1 - fuzz_albedo(x, material->fuzz.roughness) * glms_vec3_max(material->fuzz.colour);
}
