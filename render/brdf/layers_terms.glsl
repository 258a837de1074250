// The diffuse reflectance of a material, and the layers over that and its gloss, for GLSL and C (material_lobes.h): fibres,
// over a clear coat.
#ifdef GL_core_profile
#include "facets_terms.glsl"
#include "fuzz_terms.glsl"
#include "lobes_terms.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// ---- The diffuse reflectance ----

// Facets that follow Lambert's law, whose angles have the standard deviation `roughness`, rad: the qualitative form of
// [Oren and Nayar 1994, eq. 30], without light between facets. It gains up to 1.5 % at grazing
// views of slight roughness, and loses elsewhere. Over Lambert's value it is
// A + B max(0, cos phi) sin alpha tan beta, alpha and beta the larger and the smaller of both angles to the normal.
TERM float matt_even(float roughness)
{
    float square = roughness * roughness;
    return 1.0f - 0.5f * square / (square + 0.33f);
}

TERM float matt_towards(float roughness)
{
    float square = roughness * roughness;
    return 0.45f * square / (square + 0.09f);
}

// The factor on Lambert's value, from the cosines to the normal of light and viewer, and between the two: 1 for 0.
TERM float matt_factor(float roughness, float cos_l, float cos_v, float between)
{
    float across = max(between - cos_l * cos_v, 0.0f) / max(max(cos_l, cos_v), 1e-4f);
    return matt_even(roughness) + matt_towards(roughness) * across;
}

// ... on the light of an even hemisphere, in closed form. acos within 7e-5 [Abramowitz and Stegun 1964, 4.4.45].
TERM float matt_albedo(float roughness, float cos_v)
{
    float c = clamp(cos_v, 0.0f, 1.0f), s = sqrt(max(1.0f - c * c, 0.0f));
    float angle = sqrt(1.0f - c) * (1.5707288f + c * (-0.2121144f + c * (0.0742610f - 0.0187293f * c)));
    float below = 0.5f * s * (angle - s * c), above = s * c * (1.0f + s + s * s) / (3.0f * (1.0f + s));
    return matt_even(roughness) + matt_towards(roughness) * 0.636619772f * (below + above);
}

// ... its mean over viewers by their cosine.
TERM float matt_albedo_mean(float roughness)
{
    return matt_even(roughness) + 0.2139593f * matt_towards(roughness);
}

// ---- Layers ----

struct MaterialLayers {
    float base; // the share that they leave of what is below them
    float matt; // roughness of the diffuse reflectance, rad
    float matt_albedo; // its matt_albedo towards the viewer: the factor on the diffuse light of an environment
    float coat; // the reflectance of the coat, below fuzz; 0: no coat
    float coat_exponent;
    vec3 coat_axis; // mirror direction of the smooth surface: a coat levels threads and bumps out
    vec3 fuzz;      // colour; 0: none
    float roughness, follow;
    vec3 fuzz_axis; // along which its fibres stand
};

// `matt`: roughness; `coat`: the share of the surface below it. Directions are unit, the normals on the side of the viewer.
TERM MaterialLayers material_layers(float matt, float coat, float coat_exponent, vec3 fuzz, float roughness, float follow,
                                    vec3 smooth_normal, vec3 shown, vec3 viewer)
{
    MaterialLayers m;
    float share = coat_share(coat, dot(smooth_normal, viewer));
    bool has_fuzz = fuzz_strength(fuzz) > 0.0f;
    m.fuzz_axis = fuzz_axis(follow, smooth_normal, shown);
    float under = has_fuzz ? fuzz_under(fuzz, roughness, dot(m.fuzz_axis, viewer)) : 1.0f;
    m.base = under * (1.0f - share);
    m.matt = matt;
    m.matt_albedo = matt > 0.0f ? matt_albedo(matt, dot(shown, viewer)) : 1.0f;
    m.coat = under * share;
    m.coat_exponent = coat_exponent;
    m.coat_axis = mirror_direction(smooth_normal, viewer);
    m.fuzz = fuzz;
    m.roughness = roughness;
    m.follow = follow;
    return m;
}

// The factor on Lambert's value for light from l; n: the shading normal.
TERM float material_matt(MaterialLayers m, vec3 n, vec3 l, vec3 viewer)
{
    return m.matt > 0.0f ? matt_factor(m.matt, dot(n, l), dot(n, viewer), dot(l, viewer)) : 1.0f;
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
