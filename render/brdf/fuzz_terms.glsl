// The sheen of short fibres that stand on a cloth, written once for GLSL and C (fuzz.h): the common subset of both,
// float functions only. The linearly transformed cosine of [Zeltner et al. 2022] with the analytic fit that MaterialX
// publishes (mx_microfacet_sheen.glsl). x: cosine of viewer and normal, y: roughness.
#ifndef TERM
#define TERM
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
