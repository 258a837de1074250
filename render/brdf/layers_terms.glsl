// Layers over the gloss and the diffuse colour of a material, for GLSL and C (material_lobes.h): fibres, over a clear coat.
#ifdef GL_core_profile
#include "facets_terms.glsl"
#include "fuzz_terms.glsl"
#include "lobes_terms.glsl"
#endif
#ifndef TERM
#define TERM
#endif

struct MaterialLayers {
    float base; // the share that they leave of what is below them
    float coat; // the reflectance of the coat, below fuzz; 0: no coat
    float coat_exponent;
    vec3 coat_axis; // mirror direction of the smooth surface: a coat levels threads and bumps out
    vec3 fuzz;      // colour; 0: none
    float roughness, follow;
    vec3 fuzz_axis; // along which its fibres stand
};

// `coat`: the share of the surface below it. Directions are unit, the normals on the side of the viewer.
TERM MaterialLayers material_layers(float coat, float coat_exponent, vec3 fuzz, float roughness, float follow,
                                    vec3 smooth_normal, vec3 shown, vec3 viewer)
{
    MaterialLayers m;
    float share = coat_share(coat, dot(smooth_normal, viewer));
    bool has_fuzz = fuzz_strength(fuzz) > 0.0f;
    m.fuzz_axis = fuzz_axis(follow, smooth_normal, shown);
    float under = has_fuzz ? fuzz_under(fuzz, roughness, dot(m.fuzz_axis, viewer)) : 1.0f;
    m.base = under * (1.0f - share);
    m.coat = under * share;
    m.coat_exponent = coat_exponent;
    m.coat_axis = mirror_direction(smooth_normal, viewer);
    m.fuzz = fuzz;
    m.roughness = roughness;
    m.follow = follow;
    return m;
}

// f_r cos of the layers over what is below them, `below`, for light from a disc of angular radius `radius`, rad, about l. The
// mean square angle of a disc is half its radius squared.
TERM vec3 material_over(MaterialLayers m, vec3 below, vec3 l, vec3 viewer, float radius)
{
    vec3 sent = vec3_scale(below, m.base);
    if (m.coat > 0.0f) {
        float lobe = lobe_cosine(lobe_broadened_exponent(m.coat_exponent, radius * 0.70710678f), dot(l, m.coat_axis));
        sent = vec3_add(sent, vec3_scale(vec3(1.0f, 1.0f, 1.0f), m.coat * lobe));
    }
    if (fuzz_strength(m.fuzz) > 0.0f)
        sent = vec3_add(sent, vec3_scale(m.fuzz, fuzz_value(m.roughness, m.fuzz_axis, l, viewer)));
    return sent;
}
