// The layers over a material (render/brdf/material_lobes.h), and the sheen of its fibres.
#include "layers_terms.glsl"

// The unshadowed light of the environment.
vec3 exact_fibres(MaterialLayers m, vec3 viewer)
{
    float weights[FUZZ_POWERS];
    fuzz_lobes(m.roughness, dot(m.fuzz_axis, viewer), weights);
    vec2 place = octahedral_place(into_environment(m.fuzz_axis));
    vec3 light = vec3(0.0);
    for (int k = 0; k < FUZZ_POWERS; k++)
        light += weights[k] * fetch_map(lobe_atlas, 3 * k, place); // TL_FUZZ_INDEX
    return max(light, 0.0);
}
