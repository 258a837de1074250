#include "render/brdf/brdf.h"
#include "render/brdf/facets.h"
#include "render/gpu/vectors.h"
#include "render/reference/random.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <complex.h>

#include "render/gpu/terms_begin.h"

#include "render/brdf/sample_terms.glsl"

#include "render/gpu/terms_end.h"

#define PI 3.14159265358979323846

enum { MODELS = TL_REFLECT_BANKS + 1 };
static const char *const names[MODELS] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                          "ward",  "banks"};

/* White: what comes back is the lobe alone. */
static struct tl_brdf white(int model, float glossiness)
{
    tl_material material = tl_material_default("test");
    material.gloss.model = model;
    return tl_brdf_of(&material, (vec3s){{1, 1, 1}}, glossiness);
}

static struct tl_brdf of_widths(int model, float weft, float warp)
{
    struct tl_brdf brdf = white(model, 0.9f);
    brdf.gloss.width_weft = weft;
    brdf.gloss.width_warp = warp;
    return brdf;
}

static struct tl_brdf_frame upright(float rotation)
{
    return tl_brdf_frame_make((vec3s){{0, 0, 1}}, (vec3s){{1, 0, 0}}, 1, rotation);
}

/* Angles in degrees: from the normal, and about it. */
static vec3s polar(double from_normal, double about)
{
    double t = from_normal * PI / 180, p = about * PI / 180;
    return (vec3s){{(float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t)}};
}

typedef double integrand(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v);

static double gloss_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    return (double)tl_brdf_gloss(brdf, frame, l, v).y;
}

static double density_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    return (double)tl_brdf_pdf(brdf, frame, l, v);
}

/* Over the cell [z0, z1] x [p0, p1] of the upper hemisphere by the midpoint rule; z: cosine, p: azimuth. */
static double over_cell(integrand *f, const struct tl_brdf *brdf, vec3s v, const double cell[4], int steps)
{
    struct tl_brdf_frame frame = upright(0);
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        double z = cell[0] + (cell[1] - cell[0]) * (i + 0.5) / steps, r = sqrt(1 - z * z);
        for (int k = 0; k < steps; k++) {
            double p = cell[2] + (cell[3] - cell[2]) * (k + 0.5) / steps;
            vec3s l = {{(float)(r * cos(p)), (float)(r * sin(p)), (float)z}};
            sum += f(brdf, &frame, l, v);
        }
    }
    return sum * (cell[1] - cell[0]) * (cell[3] - cell[2]) / steps / steps;
}

static double over_hemisphere(integrand *f, const struct tl_brdf *brdf, vec3s v)
{
    const double all[4] = {0, 1, 0, 2 * PI};
    return over_cell(f, brdf, v, all, brdf->exponent > 20 ? 800 : 400);
}

/* D cos d over h is pi/4: D(d) 2 pi cos d sin d dd, by Simpson over tan d = w x, narrow or not. */
static double facet_volume(const struct tl_brdf *brdf)
{
    const int steps = 20000;
    double sum = 0, w = (double)brdf->gloss.width_weft;
    for (int i = 0; i < steps; i++) {
        double d = (i + 0.5) / steps * fmin(PI / 2, 8 * w), tangent = tan(d);
        sum += (double)tl_brdf_facets(brdf, (float)(tangent * tangent)) * cos(d) * sin(d);
    }
    return 2 * PI * sum * fmin(PI / 2, 8 * w) / steps;
}

static void facets_are_normalised(void **state)
{
    (void)state;
    const float widths[] = {1e-3f, 0.01f, 0.1f, 0.3f, 0.6f, 0.8f, 1};
    for (size_t i = 0; i < TL_COUNT(widths); i++) {
        for (int facets = TL_FACETS_GAUSSIAN; facets <= TL_FACETS_BECKMANN; facets++) {
            struct tl_brdf brdf = of_widths(TL_REFLECT_TORRANCE_SPARROW, widths[i], widths[i]);
            brdf.gloss.facets = facets;
            /* The Gaussian's volume is a polynomial within 1e-4. */
            assert_near(facet_volume(&brdf) / (PI / 4), 1, facets == TL_FACETS_GAUSSIAN ? 1.5e-4 : 2e-5);
        }
    }
}

/* f_r is the same both ways: gloss(l, v) / n.l = gloss(v, l) / n.v. BANKS but for Fresnel's term. */
static void exchanges_light_and_viewer(void **state)
{
    (void)state;
    struct tl_brdf_frame frame = upright(0.4f);
    for (int model = TL_REFLECT_COSINE_LOBE; model < MODELS; model++) {
        for (int variant = 0; variant < 8; variant++) {
            struct tl_brdf brdf = of_widths(model, 0.3f, 0.5f);
            brdf.exponent = 12;
            brdf.gloss.facets = variant >= 6 ? TL_FACETS_GGX : variant & 1;
            brdf.gloss.ward = variant >> 1 & 1;
            brdf.gloss.masking = variant == 7 ? TL_MASKING_SCHLICK : variant >> 1 & 1;
            brdf.gloss.fresnel =
                variant >> 2 && model != TL_REFLECT_BANKS ? TL_FRESNEL_DIELECTRIC : TL_FRESNEL_SCHLICK;
            for (int i = 0; i < 200; i++) {
                vec3s l = polar(i * 0.44, i * 37.0), v = polar(88 - i * 0.31, i * 71.0 + 20);
                double there = gloss_of(&brdf, &frame, l, v) * (double)v.z;
                double back = gloss_of(&brdf, &frame, v, l) * (double)l.z;
                assert_near(there, back, 2e-5 * (there + back) + 1e-9);
            }
        }
    }
}

static void phong_and_blinn_are_not_reciprocal(void **state)
{
    (void)state;
    struct tl_brdf_frame frame = upright(0);
    for (int model = TL_REFLECT_PHONG; model <= TL_REFLECT_BLINN_PHONG; model++) {
        struct tl_brdf brdf = white(model, 0.8f);
        vec3s l = polar(20, 0), v = polar(45, 180);
        double there = gloss_of(&brdf, &frame, l, v) * (double)v.z;
        assert_true(fabs(there / (gloss_of(&brdf, &frame, v, l) * (double)l.z) - 1) > 0.1);
    }
}

/* The weak white furnace [Heitz 2014, eq. 85]: masked towards the viewer alone, facets reflect all light, the
 * part below the horizon included: D G1 / (4 n.v) over the whole sphere of l is 1. By Simpson's rule over h,
 * in t = tan / (w + tan), where the tails end at 1: dl = 4 h.v dh. */
static void ggx_masks_what_its_facets_hide(void **state)
{
    (void)state;
    const float widths[] = {0.05f, 0.2f, 0.5f, 1};
    const double views[] = {0, 30, 60, 80, 88};
    for (size_t i = 0; i < TL_COUNT(widths) * TL_COUNT(views); i++) {
        struct tl_brdf brdf = of_widths(TL_REFLECT_TORRANCE_SPARROW, widths[i / TL_COUNT(views)], 0);
        brdf.gloss.facets = TL_FACETS_GGX;
        const double w = (double)brdf.gloss.width_weft;
        const vec3s v = polar(views[i % TL_COUNT(views)], 0);
        const int rows = 2000, columns = 100;
        double sum = 0;
        for (int row = 0; row < rows; row++) {
            double t = (row + 0.5) / rows, tangent = w * t / (1 - t), rise = 1 + tangent * tangent;
            double area = w / ((1 - t) * (1 - t)) / rise * (tangent / sqrt(rise)) / rows; /* sin d dd */
            double facets = 4 / PI * (double)tl_brdf_facets(&brdf, (float)(tangent * tangent));
            for (int column = 0; column < columns; column++) {
                double about = 2 * PI * (column + 0.5) / columns;
                double towards = ((double)v.z + tangent * cos(about) * (double)v.x) / sqrt(rise);
                sum += fmax(towards, 0) * facets * area * 2 * PI / columns;
            }
        }
        double seen = (double)tl_brdf_smith(&brdf, 1, v.z); /* nothing is hidden from a light above */
        assert_near(sum * seen / (double)v.z, 1, 2e-3);
    }
}

/* The white furnace: an even sky of 1. */
static double energy(const struct tl_brdf *brdf, double view_deg)
{
    return over_hemisphere(gloss_of, brdf, polar(view_deg, 30));
}

/* Whether a ray from p towards d hits the wall that rises from the origin along (cos e, sin e) in x and z, up
 * to the height of 1. The groove runs along y without end. */
static bool is_blocked(const double p[2], vec3s d, double elevation)
{
    double wall[2] = {cos(elevation), sin(elevation)}, x = (double)d.x, z = (double)d.z;
    double across = x * wall[1] - z * wall[0]; /* of d along the wall's normal */
    if (fabs(across) < 1e-12)
        return false;
    double along_ray = -(p[0] * wall[1] - p[1] * wall[0]) / across; /* p + t d lies on the wall's line */
    double height = p[1] + along_ray * z;
    return along_ray > 1e-9 && height > 0 && height < 1;
}

/* Rays in a groove itself: two walls of one slope, of which one has the half vector for its normal. G is the
 * share of that wall from which neither the light nor the viewer is hidden by the other one. */
/* Schlick's approximations as he has them, by a roughness r and a factor k: his Z is 4 D. His G is 1 / (1 +
 * L) in each direction, as Smith's, with an L of its own, k (1 / cos - 1); it masks more than Smith's
 * everywhere. */
static void schlick_approximates(void **state)
{
    (void)state;
    for (int step = 0; step < 6; step++) {
        const float width = 0.05f + 0.1f * (float)step;
        struct tl_brdf brdf = of_widths(TL_REFLECT_TORRANCE_SPARROW, width, width);
        const double r = (double)width * (double)width, k = sqrt(2 * r / PI);
        brdf.gloss.facets = TL_FACETS_GGX;
        brdf.gloss.masking = TL_MASKING_SCHLICK;
        for (int i = 1; i < 90; i++) {
            const double t = cos(i * PI / 180), tangent = tan(i * PI / 180),
                         z = r / pow(1 + r * t * t - t * t, 2);
            assert_near(4 * (double)tl_brdf_facets(&brdf, (float)(tangent * tangent)), z, 1e-4 * z);
            const double b = cos((90 - i) * PI / 180);
            const double g = 1 / ((1 + k * (1 / t - 1)) * (1 + k * (1 / b - 1)));
            assert_near(tl_brdf_masking(&brdf, (float)t, (float)b, 1, 1), g, 1e-5);
            brdf.gloss.facets = TL_FACETS_BECKMANN;
            assert_true(g < (double)tl_brdf_smith(&brdf, (float)t, (float)b));
            brdf.gloss.facets = TL_FACETS_GGX;
        }
    }
}

static void v_grooves_hide_what_their_walls_hide(void **state)
{
    (void)state;
    enum { PLACES = 2000 };
    struct tl_random random = tl_random_begin(20, 0);
    int partly = 0, open = 0;
    double worst = 0;
    for (int i = 0; i < 2000; i++) {
        double tilt = (5 + 75 * tl_random_unit(&random)) * PI / 180;
        vec3s h = polar(tilt * 180 / PI, 0);
        vec3s l = polar(89 * tl_random_unit(&random), 360 * tl_random_unit(&random));
        float cos_t = glms_vec3_dot(l, h);
        vec3s v = glms_vec3_sub(glms_vec3_scale(h, 2 * cos_t), l);
        if (cos_t <= 0.02f || v.z <= 0.02f)
            continue;
        int seen = 0;
        for (int k = 0; k < PLACES; k++) {
            double height = (k + 0.5) / PLACES; /* of a wall that rises by 1 */
            const double place[2] = {-height / tan(tilt), height};
            seen += !is_blocked(place, l, tilt) && !is_blocked(place, v, tilt);
        }
        double expected = (double)seen / PLACES, g = (double)tl_brdf_v_grooves(l.z, v.z, cos_t, h.z);
        worst = fmax(worst, fabs(g - expected));
        partly += expected < 0.99;
        open += expected > 0.99;
    }
    print_message("V-grooves: %d partly hidden and %d open, G off by %.1e of rays\n", partly, open, worst);
    assert_true(partly > 200 && open > 200);
    assert_true(worst < 1.0 / PLACES + 1e-4);
}

static void energy_is_not_created(void **state)
{
    (void)state;
    const float glossiness[] = {0, 0.5f, 0.8f, 0.9f, 0.98f};
    const double views[] = {0, 30, 60, 75, 85, 89};
    for (int model = 0; model < MODELS; model++) {
        double worst = 0, worst_steep = 0;
        for (int variant = 0; variant < (model == TL_REFLECT_TORRANCE_SPARROW ? 6 : 1); variant++) {
            for (size_t i = 0; i < TL_COUNT(glossiness) * TL_COUNT(views); i++) {
                struct tl_brdf brdf = white(model, glossiness[i / TL_COUNT(views)]);
                double view = views[i % TL_COUNT(views)];
                brdf.gloss.facets = variant >= 4 ? TL_FACETS_GGX : variant & 1;
                brdf.gloss.masking = variant == 5   ? TL_MASKING_SCHLICK
                                     : variant == 4 ? TL_MASKING_SMITH
                                                    : variant >> 1;
                double sent = energy(&brdf, view);
                worst = fmax(worst, sent);
                if (view <= 60)
                    worst_steep = fmax(worst_steep, sent);
                bool mismatched = model == TL_REFLECT_TORRANCE_SPARROW && variant == 0;
                if (model != TL_REFLECT_WARD)
                    assert_true(
                        sent <=
                        (mismatched && view > 80 ? 1.05 : 1.0005)); /* the midpoint rule's own error */
            }
        }
        printf("%s: sends back up to %.4f, %.4f for viewers up to 60 degrees\n", names[model], worst,
               worst_steep);
    }
}

/* Ward's facets to the last tenth of a degree: as published they send back more than arrives, in the bounded
 * form they do not; narrow facets that are seen from the front send back the same. */
static void bounded_ward_creates_no_energy(void **state)
{
    (void)state;
    const float widths[][2] = {{0.1f, 0.1f}, {0.3f, 0.1f}, {0.1f, 0.3f}, {0.6f, 0.2f}, {1, 1}};
    const double views[] = {0, 30, 60, 75, 85, 88, 89.5, 89.9};
    double maximum[2] = {0}, front = 0;
    for (size_t i = 0; i < TL_COUNT(widths) * TL_COUNT(views); i++) {
        const float *width = widths[i / TL_COUNT(views)];
        double view = views[i % TL_COUNT(views)], sent[2];
        for (int ward = 0; ward < 2; ward++) {
            struct tl_brdf brdf = of_widths(TL_REFLECT_WARD, width[0], width[1]);
            brdf.gloss.ward = ward;
            brdf.exponent = 100; /* the quadrature's steps */
            sent[ward] = energy(&brdf, view);
            maximum[ward] = fmax(maximum[ward], sent[ward]);
        }
        if (view <= 0 && i / TL_COUNT(views) == 0)
            front = fabs(sent[1] / sent[0] - 1);
    }
    printf("ward: sends back up to %.4f as published, %.4f bounded; from the front they differ by %.4f\n",
           maximum[0], maximum[1], front);
    assert_true(maximum[0] > 1.1);
    assert_true(maximum[1] < 1.0005);
    assert_true(front < 0.02);
}

/* Seen from the front, a narrow lobe keeps all energy. */
static void narrow_lobes_keep_all_energy(void **state)
{
    (void)state;
    for (int model = 0; model < MODELS; model++) {
        struct tl_brdf brdf = white(model, 0.995f);
        brdf.gloss.width_warp = brdf.gloss.width_weft;
        assert_near(energy(&brdf, 0), 1, 0.015); /* a lobe of 200 is 0.07 rad wide: cosines of it are lost */
    }
}

static void ward_of_equal_widths_is_isotropic(void **state)
{
    (void)state;
    struct tl_brdf brdf = of_widths(TL_REFLECT_WARD, 0.2f, 0.2f);
    for (int i = 0; i < 100; i++) {
        vec3s l = polar(i * 0.8, i * 13.0), v = polar(80 - i * 0.7, i * 29.0);
        struct tl_brdf_frame frame = upright(0), turned = upright((float)i * 0.1f);
        double expected = gloss_of(&brdf, &frame, l, v);
        assert_near(gloss_of(&brdf, &turned, l, v), expected, 2e-5 * expected + 1e-9);
    }
}

/* Turning the tangent is turning light and viewer the other way; and a quarter turn exchanges the widths. */
static void anisotropy_turns_with_the_tangent(void **state)
{
    (void)state;
    for (int model = TL_REFLECT_WARD; model <= TL_REFLECT_BANKS; model++) {
        struct tl_brdf brdf = of_widths(model, 0.1f, 0.4f), crossed = of_widths(model, 0.4f, 0.1f);
        struct tl_brdf_frame frame = upright(0), quarter = upright((float)(PI / 2));
        double spread = 0;
        for (int i = 0; i < 100; i++) {
            double turn = i * 3.6, a = 10 + i * 0.3, b = 12 + i * 0.4;
            struct tl_brdf_frame turned = upright((float)(turn * PI / 180));
            double expected = gloss_of(&brdf, &frame, polar(a, 20), polar(b, 190));
            double here = gloss_of(&brdf, &turned, polar(a, 20 + turn), polar(b, 190 + turn));
            assert_near(here, expected, 1e-4 * expected + 1e-7);
            if (model == TL_REFLECT_WARD) {
                double swapped = gloss_of(&crossed, &quarter, polar(a, 20), polar(b, 190));
                assert_near(swapped, expected, 1e-4 * expected + 1e-7);
            }
            double unturned = gloss_of(&brdf, &frame, polar(a, 20 + turn), polar(b, 190 + turn));
            spread = fmax(spread, fabs(unturned - expected));
        }
        assert_true(spread > 0.1);
    }
}

/* The facets' slopes are wide along the weft: so is the highlight. */
static void ward_stretches_along_the_wider_slopes(void **state)
{
    (void)state;
    struct tl_brdf brdf = of_widths(TL_REFLECT_WARD, 0.4f, 0.1f);
    struct tl_brdf_frame frame = upright(0);
    vec3s v = polar(0, 0);
    assert_true(gloss_of(&brdf, &frame, polar(25, 0), v) > 10 * gloss_of(&brdf, &frame, polar(25, 90), v));
    vec3s along = frame.tangent; /* and handedness turns the bitangent, not the highlight */
    struct tl_brdf_frame mirrored = tl_brdf_frame_make(frame.normal, along, -1, 0);
    assert_near(glms_vec3_dot(mirrored.bitangent, frame.bitangent), -1, 1e-6);
    assert_near(gloss_of(&brdf, &mirrored, polar(25, 40), v), gloss_of(&brdf, &frame, polar(25, 40), v),
                1e-6);
}

/* The mirror cone of a thread: every l with the same angle to it, on the other side, is as bright as can be
 * but for cos a. */
static void banks_shines_along_the_cone(void **state)
{
    (void)state;
    struct tl_brdf brdf = white(TL_REFLECT_BANKS, 0.98f);
    struct tl_brdf_frame frame = upright(0);
    vec3s v = glms_vec3_normalize((vec3s){{0.4f, 0.3f, 0.6f}});
    double peak = (double)tl_brdf_lobe_scale(&brdf);
    for (int i = 1; i < 30; i++) {
        double p = PI * i / 30, r = sqrt(1 - (double)(v.x * v.x));
        vec3s l = {{-v.x, (float)(r * cos(p)), (float)(r * sin(p))}};
        assert_near(gloss_of(&brdf, &frame, l, v), peak * (double)l.z, 1e-4 * peak);
    }
}

/* The disc of the paper's figure 3: threads run in circles about its centre; light and viewer are far away.
 * At azimuths 0 and 180 degrees a thread is perpendicular to both directions and reflects one into the other.
 * The brightness falls with the distance of the azimuth from there, is constant along a radius and equal on
 * both sides. */
static void banks_on_a_disc_is_a_bow_tie(void **state)
{
    (void)state;
    struct tl_brdf brdf = white(TL_REFLECT_BANKS, 0.95f);
    vec3s l = polar(50, 0), v = polar(20, 0);
    double before = INFINITY;
    for (int azimuth = 0; azimuth <= 90; azimuth += 10) {
        double shown[4];
        for (int i = 0; i < 4; i++) {
            double at = (i & 1 ? -azimuth : azimuth) + (i & 2 ? 180 : 0);
            vec3s around = polar(90, at + 90);
            struct tl_brdf_frame frame = tl_brdf_frame_make((vec3s){{0, 0, 1}}, around, 1, 0);
            shown[i] = gloss_of(&brdf, &frame, l, v);
            assert_near(shown[i], shown[0], 1e-4 * shown[0]);
        }
        assert_true(shown[0] < before);
        before = shown[0];
    }
    struct tl_brdf_frame across = tl_brdf_frame_make((vec3s){{0, 0, 1}}, (vec3s){{0, 1, 0}}, 1, 0);
    double peak = (double)(tl_brdf_lobe_scale(&brdf) * l.z);
    assert_near(gloss_of(&brdf, &across, l, v), peak, 1e-4 * peak);
}

/* c(s) by its gamma functions. */
static void scales_are_the_formulas(void **state)
{
    (void)state;
    for (int i = 0; i < 13; i++) {
        float s = powf(3, (float)i); /* 1 to 531,441 */
        struct tl_brdf brdf = white(TL_REFLECT_BANKS, 0);
        brdf.exponent = s;
        double expected = exp(lgamma((double)s / 2 + 2) - lgamma((double)s / 2 + 1.5)) / (2 * sqrt(PI));
        assert_near(tl_brdf_lobe_scale(&brdf) / (float)expected, 1, 5e-4);
        brdf.gloss.model = TL_REFLECT_BLINN_PHONG;
        assert_near(tl_brdf_lobe_scale(&brdf), (4 * s + 2) / (float)(8 * PI), 1e-5 * (double)s);
    }
}

static uint32_t hash(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* Draws in 6 x 12 cells of the upper hemisphere against the density's integral over each; what fell below
 * against what is missing to 1. A square root of counts is one sigma; 5 are allowed. */
enum { RINGS = 6, SECTORS = 12, DRAWS = 40000 };
static void check_draws(const struct tl_brdf *brdf, vec3s v)
{
    int counts[RINGS * SECTORS] = {0}, lost = 0;
    struct tl_brdf_frame frame = upright(0);
    for (uint32_t i = 0; i < DRAWS; i++) {
        float u1 = (float)(hash(2 * i + 1) >> 8) / 0x1p24f, u2 = (float)(hash(2 * i + 2) >> 8) / 0x1p24f,
              density;
        vec3s l = tl_brdf_sample(brdf, &frame, v, u1, u2, &density);
        assert_near(glms_vec3_norm(l), 1, 1e-5);
        assert_near(density, tl_brdf_pdf(brdf, &frame, l, v), 0);
        double about = atan2((double)l.y, (double)l.x) / (2 * PI);
        int ring = (int)fmin((double)l.z * RINGS, RINGS - 1), sector = (int)((about + 1) * SECTORS) % SECTORS;
        if (density > 0)
            counts[ring * SECTORS + sector]++;
        else
            lost++;
    }
    double total = 0;
    for (int i = 0; i < RINGS * SECTORS; i++) {
        int ring = i / SECTORS, sector = i % SECTORS;
        const double cell[4] = {(double)ring / RINGS, (ring + 1.0) / RINGS, sector * 2 * PI / SECTORS,
                                (sector + 1) * 2 * PI / SECTORS};
        double expected = DRAWS * over_cell(density_of, brdf, v, cell, 30);
        assert_near(counts[i], expected, 5 * sqrt(expected) + 0.004 * expected + 5);
        total += expected;
    }
    assert_near(lost, DRAWS - total, 5 * sqrt(fabs(DRAWS - total)) + 0.002 * DRAWS);
}

/* Slopes whose axes lie across weft and warp: their moments are half the squared widths and product, and the
 * pdf of their normals adds up to 1. */
static void slopes_follow_their_squares(void **state)
{
    (void)state;
    enum { SIDE = 512 };
    const vec3s squares = {{0.3f, 0.1f, 0.12f}};
    double xx = 0, yy = 0, xy = 0, sum = 0, by_pdf = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float a = ((float)(i % SIDE) + 0.5f) / SIDE, b = ((float)(i / SIDE % SIDE) + 0.5f) / SIDE;
        const vec2s slope = facet_slope(squares, a, b);
        const float angle = 2 * (float)PI * b, sine = sqrtf(1 - a * a);
        xx += (double)(slope.x * slope.x) / (SIDE * SIDE);
        yy += (double)(slope.y * slope.y) / (SIDE * SIDE);
        xy += (double)(slope.x * slope.y) / (SIDE * SIDE);
        const vec3s h = {{sine * cosf(angle), sine * sinf(angle), a}};
        const double share = 2 * PI / (SIDE * SIDE) * (double)facet_slope_pdf(squares, h);
        sum += share;
        by_pdf += share * (double)(h.x * h.y / (h.z * h.z));
    }
    assert_near(xx, 0.15, 1e-3); /* the last of SIDE strata holds a tail */
    assert_near(yy, 0.05, 1e-3);
    assert_near(xy, 0.06, 1e-3);
    assert_near(sum, 1, 1e-4);
    assert_near(by_pdf, 0.06, 1e-3);
}

static void samples_follow_their_pdf(void **state)
{
    (void)state;
    const double views[] = {0, 50, 80};
    for (int model = 0; model < MODELS; model++) {
        for (int facets = 0; facets < (model == TL_REFLECT_TORRANCE_SPARROW ? 3 : 1); facets++) {
            for (size_t i = 0; i < TL_COUNT(views); i++) {
                struct tl_brdf brdf = white(model, 0.8f);
                brdf.gloss.facets = facets;
                brdf.gloss.width_weft = 0.5f;
                brdf.gloss.width_warp = 0.25f;
                check_draws(&brdf, polar(views[i], 30));
            }
        }
    }
}

/* The mean of gloss / density over even numbers is the energy: also for lobes that no grid would find. And
 * no draw weighs much more than the others. */
static void samples_estimate_the_energy(void **state)
{
    (void)state;
    const float glossiness[] = {0.5f, 0.9f, 0.99f, 1};
    for (int model = 0; model < MODELS; model++) {
        double heaviest = 0;
        for (size_t i = 0; i < TL_COUNT(glossiness); i++) {
            struct tl_brdf brdf = white(model, glossiness[i]);
            struct tl_brdf_frame frame = upright(0);
            vec3s v = polar(40, 70);
            double sum = 0;
            for (int k = 0; k < 128 * 128; k++) {
                int row = k / 128, column = k % 128;
                float density, u1 = ((float)column + 0.5f) / 128, u2 = ((float)row + 0.5f) / 128;
                vec3s l = tl_brdf_sample(&brdf, &frame, v, u1, u2, &density);
                double weight = density > 0 ? gloss_of(&brdf, &frame, l, v) / (double)density : 0;
                sum += weight / (128 * 128);
                heaviest = fmax(heaviest, weight);
            }
            if (glossiness[i] < 0.95f)
                assert_near(sum, over_hemisphere(gloss_of, &brdf, v), 0.01);
            else
                assert_true(sum < 1.01 && sum > 0.5);
        }
        printf("%s: the heaviest draw weighs %.2f\n", names[model], heaviest);
        assert_true(heaviest < 4);
    }
}

static void fresnel_is_the_closed_form(void **state)
{
    (void)state;
    const float indices[] = {1.2f, 1.33f, 1.5f, 2.4f, 200};
    for (size_t i = 0; i < TL_COUNT(indices); i++) {
        double n = (double)indices[i], normal = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
        assert_near(fresnel_dielectric(indices[i], 1), normal, 1e-6);
        assert_near(fresnel_dielectric(indices[i], 0), 1, 0);
        assert_near(fresnel_dielectric(indices[i], 1e-6f), 1, 1e-3 * n);
        /* At Brewster's angle, tan = n, only light across the plane comes back: half of ((n^2 - 1)/(n^2 +
         * 1))^2. */
        double across = (n * n - 1) / (n * n + 1);
        assert_near(fresnel_dielectric(indices[i], (float)(1 / sqrt(1 + n * n))), across * across / 2, 3e-5);
        for (int k = 0; k <= 100; k++) {
            float c = (float)k / 100, dielectric = fresnel_dielectric(indices[i], c);
            assert_near(fresnel_conductor(indices[i], 0, c), dielectric, 0);
            assert_near(fresnel_conductor(indices[i], 1e-6f, c), dielectric, 1e-5);
            assert_true(dielectric >= 0 && dielectric <= 1);
        }
    }
    /* Total reflection beyond asin(1/1.5), where the cosine is 0.7454. */
    assert_near(fresnel_dielectric(1 / 1.5f, 0.745f), 1, 0);
    assert_true(fresnel_dielectric(1 / 1.5f, 0.80f) < 0.5f);
}

/* ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2): aluminium, gold, silver at 550 to 600 nm [Palik]. And against
 * Fresnel's own form in complex numbers. */
static void conductors_are_the_complex_form(void **state)
{
    (void)state;
    const float metals[][2] = {{0.96f, 6.69f}, {0.27f, 2.95f}, {0.13f, 3.65f}, {200, 1}};
    for (size_t i = 0; i < TL_COUNT(metals); i++) {
        double n = (double)metals[i][0], k = (double)metals[i][1];
        double normal = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
        assert_near(fresnel_conductor(metals[i][0], metals[i][1], 1), normal, 1e-6);
        assert_near(fresnel_conductor(metals[i][0], metals[i][1], 0), 1, 0);
        for (int j = 1; j < 100; j++) {
            double c = j / 100.0;
            _Complex double index = CMPLX(n, k), square = index * index;
            _Complex double inside = square - (1 - c * c), root = csqrt(inside);
            double across = cabs((c - root) / (c + root)),
                   along = cabs((square * c - root) / (square * c + root));
            assert_near(fresnel_conductor(metals[i][0], metals[i][1], (float)c),
                        (across * across + along * along) / 2, 1e-6);
        }
    }
}

/* F(n.v) for the models that take it at n.v. */
static void gloss_takes_fresnel_at_the_right_angle(void **state)
{
    (void)state;
    struct tl_brdf_frame frame = upright(0);
    vec3s l = polar(50, 0), v = polar(62, 180), h = glms_vec3_normalize(glms_vec3_add(l, v));
    for (int model = 0; model < MODELS; model++) {
        struct tl_brdf plain = white(model, 0.5f), brdf = white(model, 0.5f);
        brdf.gloss.fresnel = TL_FRESNEL_DIELECTRIC;
        bool by_view = model == TL_REFLECT_PHONG || model == TL_REFLECT_BANKS;
        float expected = fresnel_dielectric(1.5f, by_view ? v.z : glms_vec3_dot(h, l));
        assert_near(gloss_of(&brdf, &frame, l, v) / gloss_of(&plain, &frame, l, v), expected, 1e-5);
    }
    assert_near(schlick_reflectance(0.04f, schlick_share(1)), 0.04, 1e-7);
    assert_near(schlick_reflectance(0.04f, schlick_share(0)), 1, 1e-6);
    assert_near(schlick_reflectance(0.01f, schlick_share(0)), 0.5,
                1e-6); /* f90 = 50 f0: nothing that dark is a dielectric */
    assert_near(tl_brdf_fresnel(&(struct tl_brdf){.f0.x = 0.04f}, NAN).x, 1, 1e-6);
}

/* Directions that cause divisions by zero: grazing, below, equal, opposite; all widths and exponents. */
static void results_are_always_finite(void **state)
{
    (void)state;
    const vec3s directions[] = {polar(0, 0),         polar(90, 0),     polar(90, 180), polar(89.9999, 10),
                                polar(89.9999, 190), polar(180, 0),    polar(135, 45), polar(45, 45),
                                polar(45, 225),      {{1, 0, 0}},      {{-1, 0, 0}},   {{1, 0, 1e-20f}},
                                {{-1, 0, 1e-20f}},   {{0, 1, 1e-38f}}, {{0, 0, 0}},    {{1e-30f, 0, 1}}};
    const float widths[] = {1e-3f, 0.03f, 1}, exponents[] = {0, 0.5f, 0.999f, 1};
    const size_t count = TL_COUNT(directions);
    for (size_t i = 0; i < count * count * MODELS * 12 * 12; i++) {
        size_t pair = i % (count * count), rest = i / (count * count), variant = rest / MODELS;
        struct tl_brdf brdf = white((int)(rest % MODELS), exponents[variant % 4]);
        brdf.gloss.width_weft = widths[variant / 4 % 3];
        brdf.gloss.width_warp = widths[variant / 12 % 3];
        brdf.gloss.facets = (int)(variant / 36 % 2);
        brdf.gloss.masking = (int)(variant / 48);
        brdf.gloss.fresnel = (int)(i % 3);
        brdf.gloss.extinction = 3;
        struct tl_brdf_frame frame = upright((float)(i % 7));
        vec3s l = directions[pair / count], v = directions[pair % count];
        vec3s gloss = tl_brdf_gloss(&brdf, &frame, l, v);
        assert_true(isfinite(gloss.x) && isfinite(gloss.y) && isfinite(gloss.z) && gloss.x >= 0);
        if (l.z <= 0 || v.z <= 0)
            assert_true(gloss.x == 0);
        float density = tl_brdf_pdf(&brdf, &frame, l, v);
        assert_true(isfinite(density) && density >= 0);
        const float numbers[] = {0, 0.5f, 0.99999994f};
        for (int k = 0; k < 9; k++) {
            vec3s drawn = tl_brdf_sample(&brdf, &frame, v, numbers[k % 3], numbers[k / 3], &density);
            assert_true(isfinite(drawn.x) && isfinite(drawn.y) && isfinite(drawn.z));
            assert_true(isfinite(density) && density >= 0);
        }
    }
}

/* Invalid values of a file are clamped or replaced. */
static void materials_are_kept_in_range(void **state)
{
    (void)state;
    tl_material material = tl_material_default("test");
    material.gloss.width_weft = NAN;
    material.gloss.width_warp = 1e-9f;
    material.gloss.index = -3;
    material.gloss.extinction = INFINITY;
    struct tl_brdf brdf = tl_brdf_of(&material, (vec3s){{-1, NAN, 7}}, 0.75f);
    assert_near(brdf.exponent, 4, 1e-6);
    assert_near(brdf.gloss.width_weft, sqrt(2.0 / 18), 1e-6); /* Blinn-Phong of 4 s: sqrt(2 / (4 s + 2)) */
    assert_near(brdf.gloss.width_warp, 1e-3, 1e-9);
    assert_near(brdf.gloss.index, 1, 0);
    assert_near(brdf.gloss.extinction, 0, 0);
    assert_true(brdf.f0.x == 0 && brdf.f0.y == 0 && brdf.f0.z == 1);
    assert_near(tl_brdf_of(&material, brdf.f0, 1).exponent, 1e6, 1);
}

/* Frames of any tangent: unit, at right angles, and right-handed by the sign. */
static void frames_are_orthonormal(void **state)
{
    (void)state;
    for (int i = 0; i < 60; i++) {
        vec3s n = polar(i * 3.0, i * 47.0),
              t = i % 3 ? polar(i * 11.0, i * 5.0) : glms_vec3_scale(n, (float)(i % 2));
        float sign = i % 2 ? 1.0f : -1.0f;
        struct tl_brdf_frame frame = tl_brdf_frame_make(n, t, sign, (float)i);
        assert_near(glms_vec3_norm(frame.tangent), 1, 1e-5);
        assert_near(glms_vec3_dot(frame.tangent, n), 0, 2e-6);
        vec3s expected = glms_vec3_scale(glms_vec3_cross(n, frame.tangent), sign);
        assert_near(glms_vec3_distance(frame.bitangent, expected), 0, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_are_normalised),
        cmocka_unit_test(exchanges_light_and_viewer),
        cmocka_unit_test(phong_and_blinn_are_not_reciprocal),
        cmocka_unit_test(ggx_masks_what_its_facets_hide),
        cmocka_unit_test(schlick_approximates),
        cmocka_unit_test(v_grooves_hide_what_their_walls_hide),
        cmocka_unit_test(energy_is_not_created),
        cmocka_unit_test(bounded_ward_creates_no_energy),
        cmocka_unit_test(narrow_lobes_keep_all_energy),
        cmocka_unit_test(ward_of_equal_widths_is_isotropic),
        cmocka_unit_test(anisotropy_turns_with_the_tangent),
        cmocka_unit_test(ward_stretches_along_the_wider_slopes),
        cmocka_unit_test(banks_shines_along_the_cone),
        cmocka_unit_test(banks_on_a_disc_is_a_bow_tie),
        cmocka_unit_test(scales_are_the_formulas),
        cmocka_unit_test(slopes_follow_their_squares),
        cmocka_unit_test(samples_follow_their_pdf),
        cmocka_unit_test(samples_estimate_the_energy),
        cmocka_unit_test(fresnel_is_the_closed_form),
        cmocka_unit_test(conductors_are_the_complex_form),
        cmocka_unit_test(gloss_takes_fresnel_at_the_right_angle),
        cmocka_unit_test(results_are_always_finite),
        cmocka_unit_test(materials_are_kept_in_range),
        cmocka_unit_test(frames_are_orthonormal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
