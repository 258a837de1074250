// The sheen of short fibres that stand on a cloth, written once for GLSL and C (fuzz.h). The linearly transformed cosine of [Zeltner et al. 2022] with the analytic fit that MaterialX
// publishes (mx_microfacet_sheen.glsl). x: cosine of viewer and normal, y: roughness.
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif
#ifndef TERM_TABLE
#define TERM_TABLE const
#endif

// Albedo R towards the viewer, of white fibres.
TERM float fuzz_albedo(float x, float y)
{
    float width = y * (0.0206607f + 1.58491f * y) / (0.0379424f + y * (1.32227f + y));
    float middle = y * (-0.193854f + y * (-1.14885f + y * (1.7932f - 0.95943f * y * y))) / (0.046391f + y);
    float over = y * (0.000654023f + (-0.0207818f + 0.119681f * y) * y) / (1.26264f + y * (-1.92021f + y));
    float from = (x - middle) / width;
    return exp(-0.5f * from * from) / (width * 2.50662827f) + over;
}

// The two entries of the inverse transform that are not 0 or 1: w = (a l_x + b l_z, a l_y, l_z), l_x towards the
// viewer.
TERM float fuzz_stretch(float x, float y)
{
    return (2.58126f * x + 0.813703f * y) * y / (1.0f + 0.310327f * x * x + 2.60994f * x * y);
}

TERM float fuzz_slant(float x, float y)
{
    float below = 0.0000254053f + 1.71228f * x - 1.71506f * x * y + 1.34174f * y * y;
    return sqrt(max(1.0f - x, 0.0f)) * (y - 1.0f) * y * y * y / below;
}

// f_r cos of light / R for light of cosine z, whose horizontal part is `towards` long along the viewer's. Its integral
// over the hemisphere is 1.
TERM float fuzz_lobe(float z, float towards, float x, float y)
{
    float a = fuzz_stretch(x, y), along = a * towards + fuzz_slant(x, y) * z;
    float across2 = max(1.0f - z * z - towards * towards, 0.0f);
    float shape = a / max(along * along + a * a * across2 + z * z, 1e-8f);
    return 0.318309886f * max(z, 0.0f) * shape * shape;
}

// The mean of fuzz_lobe over the azimuth of the light, from the two entries a and b: of 1 / (p + q cos)^2.
TERM float fuzz_ring(float z, float a, float b)
{
    float sine2 = max(1.0f - z * z, 0.0f);
    float p = a * a * sine2 + (b * b + 1.0f) * z * z, q2 = 4.0f * a * a * b * b * sine2 * z * z;
    float rest = max(p * p - q2, 1e-12f);
    return 0.318309886f * max(z, 0.0f) * a * a * p / (rest * sqrt(rest));
}

// f_r cos of light, of white fibres that stand along n, for light from l; all unit.
TERM float fuzz_value(float roughness, vec3 n, vec3 l, vec3 v)
{
    float facing = dot(n, v), x = min(max(facing, 0.0f), 1.0f);
    vec3 level = direction_or(vec3_subtract(v, vec3_scale(n, facing)), vec3(0.0f, 0.0f, 0.0f));
    return fuzz_albedo(x, roughness) * fuzz_lobe(dot(n, l), dot(level, l), x, roughness);
}

// The largest channel of their colour.
TERM float fuzz_strength(vec3 colour)
{
    return max(max(colour.x, colour.y), colour.z);
}

// The share that fibres of this colour leave to the rest of the material.
TERM float fuzz_under(vec3 colour, float roughness, float facing)
{
    return 1.0f - fuzz_albedo(min(max(facing, 0.0f), 1.0f), roughness) * fuzz_strength(colour);
}

// The direction in which the fibres stand: the smooth normal, or for those that follow the bumps towards the shading
// normal `shown`; all unit.
TERM vec3 fuzz_axis(float follow, vec3 smooth_normal, vec3 shown)
{
    vec3 axis = vec3_add(vec3_scale(smooth_normal, 1.0f - follow), vec3_scale(shown, follow));
    vec3 unit = dot(axis, axis) > 1e-6f ? direction_or(axis, smooth_normal) : smooth_normal;
    return follow > 0.0f ? unit : smooth_normal;
}

// The lobes towards one viewer that stand for fuzz in an environment (fuzz.h): R w_k of K_1, K_2, K_4 and K_8 about the
// axis. Returns R.
#define FUZZ_POWERS 4
#define FUZZ_NODES 6 // of Gauss and Legendre over the cosine
TERM_TABLE float fuzz_nodes[FUZZ_NODES] = {0.03376524f, 0.1693953f, 0.3806904f, 0.6193096f, 0.8306047f, 0.9662348f};
// With phi_k = (s_k + 1) z^s_k, G their Gram matrix and u = G^-1 1: w = constant + (G^-1 - u u^T / sum u) b, where b_k are
// the integrals of phi_k times the ring.
TERM_TABLE float fuzz_shares[FUZZ_POWERS * FUZZ_NODES] = {
    0.4182107f, 2.48853f, 0.49924f, -2.986402f, 0.1732791f, -0.5928578f, -0.8351584f, -4.785745f, -0.08393909f, 6.302224f,
    -1.702497f, 1.105116f, 0.5469839f, 2.96177f, -0.7703559f, -4.243433f, 2.497196f, -0.9921611f, -0.1300362f, -0.6645553f,
    0.355055f, 0.927612f, -0.9679779f, 0.4799024f};
TERM_TABLE float fuzz_constants[FUZZ_POWERS] = {4.305398f, -5.371781f, 2.57113f, -0.5047464f};
TERM float fuzz_lobes(float roughness, float facing, out float weights[FUZZ_POWERS])
{
    float x = min(max(facing, 0.0f), 1.0f);
    float a = fuzz_stretch(x, roughness), b = fuzz_slant(x, roughness), albedo = fuzz_albedo(x, roughness);
    float rings[FUZZ_NODES];
    for (int i = 0; i < FUZZ_NODES; i++)
        rings[i] = 6.28318531f * fuzz_ring(fuzz_nodes[i], a, b);
    for (int k = 0; k < FUZZ_POWERS; k++) {
        float weight = fuzz_constants[k];
        for (int i = 0; i < FUZZ_NODES; i++)
            weight += fuzz_shares[k * FUZZ_NODES + i] * rings[i];
        weights[k] = albedo * weight;
    }
    return albedo;
}

// Their sum for light from a small region, of this mean cosine above the horizon; never below 0.
TERM float fuzz_lobes_at(in float weights[FUZZ_POWERS], float cosine)
{
    float z = max(cosine, 0.0f), z2 = z * z, z4 = z2 * z2;
    float sum = 2.0f * weights[0] * z + 3.0f * weights[1] * z2 + 5.0f * weights[2] * z4 + 9.0f * weights[3] * z4 * z4;
    return 0.159154943f * max(sum, 0.0f);
}
