#include "render/brdf/fuzz.h"

float tl_fuzz_under(const tl_material *material, float facing)
{
    if (!tl_material_has_fuzz(material))
        return 1;
    float x = fminf(fmaxf(facing, 0), 1);
    return 1 - fuzz_albedo(x, material->fuzz.roughness) * glms_vec3_max(material->fuzz.colour);
}

float tl_fuzz_value(const struct tl_fuzz *fuzz, vec3s n, vec3s l, vec3s v)
{
    float x = fminf(fmaxf(glms_vec3_dot(n, v), 0), 1), z = glms_vec3_dot(n, l);
    vec3s flat = glms_vec3_sub(v, glms_vec3_scale(n, glms_vec3_dot(n, v)));
    float length = glms_vec3_norm(flat), towards = length > 1e-6f ? glms_vec3_dot(flat, l) / length : 0;
    return fuzz_albedo(x, fuzz->roughness) * fuzz_lobe(z, towards, x, fuzz->roughness);
}
