#include "render/brdf/lobe_fit.h"

#include <math.h>

/* Standard deviation of two neighbouring lobes, as a fraction of their distance, at which their sum has no
 * dip between them. At 0.35 the L1 error of the mixture is smallest over the models and viewers of
 * test_lobe_fit.c. */
#define OVERLAP 0.35f
/* Towards a grazing viewer lobes become ever narrower across the plane of incidence, and the horizon cuts
 * them along it. Their widths are computed for this cosine at least. */
#define MIN_COSINE (1 / 3.0f)

struct slopes {
    float weft, warp; /* standard deviations along tangent and bitangent */
};

/* A width is Beckmann's m: exp(-tan^2 / m^2) has the variance m^2 / 2 along each axis. */
static struct slopes slopes_of(const struct tl_brdf *brdf)
{
    if (brdf->gloss.model == TL_REFLECT_WARD)
        return (struct slopes){brdf->gloss.width_weft * GLM_SQRT1_2f, brdf->gloss.width_warp * GLM_SQRT1_2f};
    float both = brdf->gloss.width_weft * GLM_SQRT1_2f;
    if (brdf->gloss.model == TL_REFLECT_BLINN_PHONG)
        both = 1 / sqrtf(4 * brdf->exponent + 2);
    return (struct slopes){both, both};
}

static float exponent_of(float variance)
{
    return fmaxf(1 / fmaxf(variance, 1e-7f) - 1, 1);
}

/* The spread of reflected light: variances along its two axes, and one standard deviation along the broad
 * axis as a slope of the facets. */
struct spread {
    float broad, narrow;
    vec2s slope;
};

/* The eigenvalues of J S J^T are those of S^(1/2) J^T J S^(1/2), where J^T J = 4 (v_t v_t^T + c^2 I) with the
 * tangential part v_t and the cosine c of the view direction: a facet turns light by twice its own angle in
 * the plane of incidence, and by 2 c times that angle across it. The eigenvector of the larger eigenvalue,
 * times S^(1/2), is the slope of one standard deviation along the broad axis. */
static struct spread spread_of(const struct slopes *slopes, vec3s local_v)
{
    float c = fmaxf(local_v.z, MIN_COSINE), u = slopes->weft, w = slopes->warp;
    float a = 4 * u * u * (local_v.x * local_v.x + c * c), b = 4 * u * w * local_v.x * local_v.y;
    float d = 4 * w * w * (local_v.y * local_v.y + c * c);
    float mean = (a + d) / 2, off = hypotf((a - d) / 2, b), angle = 0.5f * atan2f(2 * b, a - d);
    return (struct spread){mean + off, fmaxf(mean - off, 0), {{u * cosf(angle), w * sinf(angle)}}};
}

static vec3s local_of(const struct tl_brdf_frame *frame, vec3s d)
{
    return (vec3s){{glms_vec3_dot(d, frame->tangent), glms_vec3_dot(d, frame->bitangent),
                    glms_vec3_dot(d, frame->normal)}};
}

/* The normal of a facet with a slope along tangent and bitangent. */
static vec3s facet_of(const struct tl_brdf_frame *frame, vec2s slope)
{
    vec3s h = glms_vec3_add(frame->normal, glms_vec3_scale(frame->tangent, slope.x));
    return glms_vec3_normalize(glms_vec3_add(h, glms_vec3_scale(frame->bitangent, slope.y)));
}

static vec3s mirrored(vec3s h, vec3s v)
{
    return glms_vec3_normalize(glms_vec3_sub(glms_vec3_scale(h, 2 * glms_vec3_dot(h, v)), v));
}

/* The gloss in the direction in which a facet of this slope reflects, divided by the pdf with which Gaussian
 * slopes reflect light there (the pdf of the slope times the Jacobian of the mirror direction). This is the
 * contribution of the slope. */
static vec3s value_of_slope(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                            const struct slopes *slopes, vec3s v, vec2s slope)
{
    vec3s h = facet_of(frame, slope), l = mirrored(h, v);
    float cosine = glms_vec3_dot(h, frame->normal), towards = glms_vec3_dot(h, v);
    if (!(towards > 0) || !(glms_vec3_dot(l, frame->normal) > 0))
        return (vec3s){{0, 0, 0}};
    float x = slope.x / slopes->weft, y = slope.y / slopes->warp;
    float pdf = expf(-0.5f * (x * x + y * y)) / (2 * GLM_PIf * slopes->weft * slopes->warp);
    pdf /= cosine * cosine * cosine * 4 * towards;
    return glms_vec3_scale(tl_brdf_gloss(brdf, frame, l, v), 1 / pdf);
}

/* Nodes and weights of Gauss-Legendre quadrature on [-1, 1]. */
#define POINTS 5
static const float points[POINTS] = {-0.9061798f, -0.5384693f, 0, 0.5384693f, 0.9061798f};
static const float weights[POINTS] = {0.2369269f, 0.4786287f, 0.5688889f, 0.4786287f, 0.2369269f};
/* Integration range in standard deviations; the rest of a normal distribution is less than 0.3 %. */
#define RANGE 3.0f

/* Nodes and weights for the mean over a normal distribution between `from` (at least -RANGE) and RANGE. The
 * weights sum to the probability of that interval. */
static void sample_normal(float from, float at[POINTS], float share[POINTS])
{
    float middle = (RANGE + from) / 2, half = (RANGE - from) / 2, sum = 0;
    for (int i = 0; i < POINTS; i++) {
        at[i] = middle + half * points[i];
        share[i] = weights[i] * expf(-0.5f * at[i] * at[i]);
        sum += share[i];
    }
    float mass = (erff(RANGE * GLM_SQRT1_2f) - erff(from * GLM_SQRT1_2f)) / 2;
    for (int i = 0; i < POINTS; i++)
        share[i] *= mass / sum;
}

/* The albedo towards the viewer: the mean contribution over all slopes. Slopes that turn away from the viewer
 * by more than half of the angle left to a right angle reflect light from below the horizon. That cuts the
 * integrand off sharply along the direction to the viewer, so the quadrature starts at the cut. Across it the
 * integrand is smooth, and two Gauss-Hermite nodes suffice. */
static vec3s albedo_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                       const struct slopes *slopes, vec3s v)
{
    vec3s local = local_of(frame, v), sum = {{0, 0, 0}};
    float flat = hypotf(local.x, local.y), u = slopes->weft, w = slopes->warp;
    vec2s towards = flat > 1e-4f ? (vec2s){{local.x / flat, local.y / flat}} : (vec2s){{1, 0}};
    float deviation = hypotf(towards.x * u, towards.y * w);
    vec2s along = {{towards.x * u * u / deviation, towards.y * w * w / deviation}};
    vec2s across_step = {{-towards.y * u * w / deviation, towards.x * u * w / deviation}};
    float lowest = (1 - flat) / fmaxf(local.z, 1e-6f); /* tan((90 degrees - b) / 2) */
    float at[POINTS], share[POINTS];
    sample_normal(fmaxf(-RANGE, -lowest / deviation), at, share);
    for (int i = 0; i < POINTS; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            vec2s slope =
                glms_vec2_add(glms_vec2_scale(along, at[i]), glms_vec2_scale(across_step, (float)sign));
            vec3s value = value_of_slope(brdf, frame, slopes, v, slope);
            sum = glms_vec3_add(sum, glms_vec3_scale(value, 0.5f * share[i]));
        }
    return sum;
}

/* The fraction of a lobe above the horizon, for the cosine of its axis with the normal. */
static float share_above(float cosine, float exponent)
{
    return 0.5f * (1 + erff(cosine * sqrtf((exponent + 1) / 2)));
}

static void scale_to_albedo(vec3s albedo, const struct tl_brdf_frame *frame, int count,
                            struct tl_fitted_lobe *lobes)
{
    vec3s sum = {{0, 0, 0}};
    for (int k = 0; k < count; k++) {
        float above = share_above(glms_vec3_dot(lobes[k].direction, frame->normal), lobes[k].exponent);
        sum = glms_vec3_add(sum, glms_vec3_scale(lobes[k].weight, above));
    }
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++)
            lobes[k].weight.raw[c] *= sum.raw[c] > 1e-20f ? albedo.raw[c] / sum.raw[c] : 0;
}

/* Distance of neighbouring lobes in standard deviations of the spread. Three, five and seven lobes extend to
 * 1.7, 2.1 and 2.3. */
static float step_of(int count)
{
    return count <= 3 ? 1.7320508f : count <= 5 ? 1.05f : 0.76f;
}

/* An odd number of lobes, so that one lies at the peak: as many as it takes for neighbours to overlap. */
static int count_for(float broad, float narrow, int max_count)
{
    int count = 1;
    while (count + 2 <= max_count && broad > 1.5f * narrow &&
           (count == 1 || OVERLAP * step_of(count) * sqrtf(fmaxf(broad - narrow, 0)) > sqrtf(narrow)))
        count += 2;
    return count;
}

static int fit_facets(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                      struct tl_fitted_lobe *lobes)
{
    struct slopes slopes = slopes_of(brdf);
    struct spread spread = spread_of(&slopes, local_of(frame, v));
    int count = count_for(spread.broad, spread.narrow, max_count);
    float overlap = OVERLAP * step_of(count), square = overlap * overlap;
    float variance = count == 1 ? sqrtf(spread.broad * spread.narrow)
                                : fmaxf(spread.narrow, square / (1 + square) * spread.broad);
    float extent = sqrtf(fmaxf(1 - variance / spread.broad, 0));
    int middle = count / 2;
    for (int k = 0; k < count; k++) {
        float x = (float)(k - middle) * step_of(count);
        vec2s slope = glms_vec2_scale(spread.slope, x * extent);
        vec3s value = value_of_slope(brdf, frame, &slopes, v, slope);
        lobes[k] = (struct tl_fitted_lobe){.direction = mirrored(facet_of(frame, slope), v),
                                           .exponent = exponent_of(variance),
                                           .weight = glms_vec3_scale(value, expf(-0.5f * x * x))};
    }
    scale_to_albedo(albedo_of(brdf, frame, &slopes, v), frame, count, lobes);
    return count;
}

/* The albedo of F (s + 2) / (s + 1) K_s(r, l) cos a: the mean of F cos a over the lobe. Its directions spread
 * by about 1 / sqrt(s + 2) in the plane of incidence, where the horizon cuts them off. The spread across that
 * plane multiplies the cosine by sqrt((s + 1) / (s + 2)). */
static vec3s albedo_of_cosine_lobe(const struct tl_brdf *brdf, float facing)
{
    float spread = 1 / sqrtf(brdf->exponent + 2), across = sqrtf(fmaxf(1 - facing * facing, 0));
    float at[POINTS], share[POINTS];
    vec3s sum = {{0, 0, 0}};
    sample_normal(fmaxf(-RANGE, -asinf(fminf(facing, 1)) / spread), at, share);
    for (int i = 0; i < POINTS; i++) {
        float turn = spread * at[i], cosine = facing * cosf(turn) + across * sinf(turn);
        float from_half = cosf((2 * acosf(fminf(facing, 1)) - turn) / 2);
        vec3s reflectance = tl_brdf_fresnel(brdf, from_half);
        sum = glms_vec3_add(sum, glms_vec3_scale(reflectance, share[i] * fmaxf(cosine, 0)));
    }
    return glms_vec3_scale(sum, sqrtf((brdf->exponent + 2) / (brdf->exponent + 1)));
}

/* (r.l)^s times a cosine is close to one lobe of exponent s + 1 whose axis is tilted slightly towards the
 * normal. */
static int fit_cosine_lobe(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v,
                           struct tl_fitted_lobe *lobes)
{
    float s = brdf->exponent, facing = fmaxf(glms_vec3_dot(frame->normal, v), 0);
    vec3s r = mirrored(frame->normal, v);
    lobes[0] = (struct tl_fitted_lobe){
        .direction = glms_vec3_normalize(glms_vec3_add(glms_vec3_scale(r, s), frame->normal)),
        .exponent = s + 1,
        .weight = {{1, 1, 1}}};
    scale_to_albedo(albedo_of_cosine_lobe(brdf, facing), frame, 1, lobes);
    return 1;
}

/* The variance at which `count` neighbours on a half circle overlap. */
static float thread_variance(const struct tl_brdf *brdf, int count, float sine)
{
    float apart = OVERLAP * GLM_PIf * sine / (float)count;
    return fmaxf(1 / (brdf->exponent + 1), apart * apart);
}

/* A thread reflects light into a cone about itself. Across the cone the gloss is a power of a cosine; along
 * it the gloss follows the cosine to the normal, and every lobe gets an equal part of its integral. */
static int fit_threads(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                       struct tl_fitted_lobe *lobes)
{
    float s = brdf->exponent, along = -glms_vec3_dot(frame->tangent, v);
    float sine = sqrtf(fmaxf(1 - along * along, 0)), facing = fmaxf(glms_vec3_dot(frame->normal, v), 0);
    /* The albedo: the integral of cos^s, close to sqrt(2 pi / (s + 1/2)), times the mean of sin^2 weighted by
     * it, times the integral of the cosine along the cone. */
    float across = sine * sine + (along * along - sine * sine) / (s + 2);
    float all = tl_brdf_lobe_scale(brdf) * sqrtf(2 * GLM_PIf / (s + 0.5f)) * across * 2;
    vec3s albedo = glms_vec3_scale(tl_brdf_fresnel(brdf, facing), facing > 0 ? all : 0);
    for (int k = 0; k < max_count; k++) {
        float aside = (2 * (float)k + 1) / (float)max_count - 1, ahead = sqrtf(1 - aside * aside);
        vec3s d = glms_vec3_scale(frame->tangent, along);
        d = glms_vec3_add(d, glms_vec3_scale(frame->normal, sine * ahead));
        d = glms_vec3_add(d, glms_vec3_scale(frame->bitangent, sine * aside));
        lobes[k] = (struct tl_fitted_lobe){.direction = glms_vec3_normalize(d),
                                           .exponent = exponent_of(thread_variance(brdf, max_count, sine)),
                                           .weight = {{1, 1, 1}}};
    }
    scale_to_albedo(albedo, frame, max_count, lobes);
    return max_count;
}

int tl_lobe_fit_make(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                     struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX])
{
    if (!(glms_vec3_dot(frame->normal, v) > 0))
        return 0;
    switch (brdf->gloss.model) {
    case TL_REFLECT_PHONG:
        lobes[0] = (struct tl_fitted_lobe){mirrored(frame->normal, v), brdf->exponent,
                                           tl_brdf_fresnel(brdf, glms_vec3_dot(frame->normal, v))};
        return 1;
    case TL_REFLECT_COSINE_LOBE:
        return fit_cosine_lobe(brdf, frame, v, lobes);
    case TL_REFLECT_BANKS:
        return fit_threads(brdf, frame, v, max_count, lobes);
    default:
        return fit_facets(brdf, frame, v, max_count, lobes);
    }
}

void tl_lobe_fit_exponents(const struct tl_brdf *brdf, float *min, float *max)
{
    struct slopes slopes = slopes_of(brdf);
    float wide = fmaxf(slopes.weft, slopes.warp), thin = fminf(slopes.weft, slopes.warp);
    switch (brdf->gloss.model) {
    case TL_REFLECT_PHONG:
    case TL_REFLECT_COSINE_LOBE:
        *min = brdf->exponent;
        *max = brdf->exponent + 1;
        break;
    case TL_REFLECT_BANKS:
        *min = exponent_of(thread_variance(brdf, 1, 1));
        *max = brdf->exponent;
        break;
    default:
        *min = exponent_of(4 * wide * wide);
        *max = exponent_of(4 * thin * thin * MIN_COSINE * MIN_COSINE);
    }
}

vec3s tl_brdf_gloss_under_disc(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l,
                               vec3s v, float radius)
{
    /* The variance of a disc is radius^2 / 4 along each axis. A facet turns light by twice its own turn, so
     * the disc adds a sixteenth of radius^2 to the variance of the facets' slopes, which is m^2 / 2: an
     * eighth to m^2. To the variance 1 / (s + 1) of a lobe it adds a quarter. */
    struct tl_brdf wide = *brdf;
    float square = radius * radius / 8;
    wide.gloss.width_weft = sqrtf(wide.gloss.width_weft * wide.gloss.width_weft + square);
    wide.gloss.width_warp = sqrtf(wide.gloss.width_warp * wide.gloss.width_warp + square);
    wide.exponent = fmaxf((brdf->exponent + 1) / (1 + (brdf->exponent + 1) * radius * radius / 4) - 1, 0.25f);
    return tl_brdf_gloss(&wide, frame, l, v);
}
