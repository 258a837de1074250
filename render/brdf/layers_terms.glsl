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
TERM float rough_even(float roughness)
{
    float square = roughness * roughness;
    return 1.0f - 0.5f * square / (square + 0.33f);
}

TERM float rough_towards(float roughness)
{
    float square = roughness * roughness;
    return 0.45f * square / (square + 0.09f);
}

// The factor on Lambert's value, from the cosines to the normal of light and viewer, and between the two: 1 for 0.
TERM float rough_factor(float roughness, float cos_l, float cos_v, float between)
{
    float across = max(between - cos_l * cos_v, 0.0f) / max(max(cos_l, cos_v), 1e-4f);
    return rough_even(roughness) + rough_towards(roughness) * across;
}

// ... on the light of an even hemisphere, in closed form. acos within 7e-5 [Abramowitz and Stegun 1964, 4.4.45].
TERM float rough_albedo(float roughness, float cos_v)
{
    float c = clamp(cos_v, 0.0f, 1.0f), s = sqrt(max(1.0f - c * c, 0.0f));
    float angle = sqrt(1.0f - c) * (1.5707288f + c * (-0.2121144f + c * (0.0742610f - 0.0187293f * c)));
    float below = 0.5f * s * (angle - s * c), above = s * c * (1.0f + s + s * s) / (3.0f * (1.0f + s));
    return rough_even(roughness) + rough_towards(roughness) * 0.636619772f * (below + above);
}

// ... its mean over viewers by their cosine.
TERM float rough_albedo_mean(float roughness)
{
    return rough_even(roughness) + 0.2139593f * rough_towards(roughness);
}

// Threads along t: n'.l of [Heidrich and Seidel 1999, eq. 4], the sine of their angle to the light. An even hemisphere gets its
// mean by n.l, 8 / 3 pi.
TERM float thread_factor(float along)
{
    return sqrt(max(1.0f - along * along, 0.0f));
}

// A material's law of diffuse reflectance is numbers that tl_material_law fills, all paths hand on, and these functions alone
// read; all of them 0: Lambert's. x: roughness of its facets, rad; y: 1 where it is threads.

// The factor on Lambert's value for light from l, from the cosines n.l, n.v, l.v and t.l; t: along the threads.
TERM float matt_factor(vec4 law, float cos_l, float cos_v, float between, float along)
{
    float facets = law.x > 0.0f ? rough_factor(law.x, cos_l, cos_v, between) : 1.0f;
    return law.y > 0.0f ? facets * thread_factor(along) : facets;
}

TERM float matt_under(vec4 law, vec3 n, vec3 t, vec3 l, vec3 viewer)
{
    return matt_factor(law, dot(n, l), dot(n, viewer), dot(l, viewer), dot(t, l));
}

// ... on the light of an even hemisphere, which all light of an environment and of other surfaces gets.
TERM float matt_albedo(vec4 law, float cos_v)
{
    float facets = law.x > 0.0f ? rough_albedo(law.x, cos_v) : 1.0f;
    return law.y > 0.0f ? facets * 0.848826363f : facets;
}

// ... its mean over viewers by their cosine.
TERM float matt_albedo_mean(vec4 law)
{
    return rough_albedo_mean(law.x) * (law.y > 0.0f ? 0.848826363f : 1.0f);
}

// ---- Layers ----

struct MaterialLayers {
    float base; // the share that they leave of what is below them
    vec4 law; // of the diffuse reflectance
    vec3 shown, thread, viewer;
    float matt_albedo; // of the law towards the viewer: the factor on the diffuse light of an environment
    float coat; // the reflectance of the coat, below fuzz; 0: no coat
    float coat_exponent;
    vec3 coat_axis; // mirror direction of the smooth surface: a coat levels threads and bumps out
    vec3 fuzz;      // colour; 0: none
    float roughness, follow;
    vec3 fuzz_axis; // along which its fibres stand
};

// `coat`: the share of the surface below it. Directions are unit, the normals on the side of the viewer; `thread`: zero where
// the material has none.
TERM MaterialLayers material_layers(vec4 law, float coat, float coat_exponent, vec3 fuzz, float roughness, float follow,
                                    vec3 smooth_normal, vec3 shown, vec3 thread, vec3 viewer)
{
    MaterialLayers m;
    float share = coat_share(coat, dot(smooth_normal, viewer));
    bool has_fuzz = fuzz_strength(fuzz) > 0.0f;
    m.fuzz_axis = fuzz_axis(follow, smooth_normal, shown);
    float under = has_fuzz ? fuzz_under(fuzz, roughness, dot(m.fuzz_axis, viewer)) : 1.0f;
    m.base = under * (1.0f - share);
    m.law = law;
    m.shown = shown;
    m.thread = thread;
    m.viewer = viewer;
    m.matt_albedo = matt_albedo(law, dot(shown, viewer));
    m.coat = under * share;
    m.coat_exponent = coat_exponent;
    m.coat_axis = mirror_direction(smooth_normal, viewer);
    m.fuzz = fuzz;
    m.roughness = roughness;
    m.follow = follow;
    return m;
}

// The factor on Lambert's value for light from l.
TERM float material_matt(MaterialLayers m, vec3 l)
{
    return matt_under(m.law, m.shown, m.thread, l, m.viewer);
}

// f_r cos of the layers over what is below them, `below`, for light from a disc of angular radius `radius`, rad, about l. The
// mean square angle of a disc is half its radius squared.
TERM vec3 material_over(MaterialLayers m, vec3 below, vec3 l, float radius)
{
    vec3 sent = vec3_scale(below, m.base);
    if (m.coat > 0.0f) {
        float lobe = lobe_cosine(lobe_broadened_exponent(m.coat_exponent, radius * 0.70710678f), dot(l, m.coat_axis));
        sent = vec3_add(sent, vec3_scale(vec3(1.0f, 1.0f, 1.0f), m.coat * lobe));
    }
    if (fuzz_strength(m.fuzz) > 0.0f)
        sent = vec3_add(sent, vec3_scale(m.fuzz, fuzz_value(m.roughness, m.fuzz_axis, l, m.viewer)));
    return sent;
}
