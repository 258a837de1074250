/* Light in sixteen terms through lobes, against integrals over the sphere: even light, light from below, and
 * a sky of which a part is seen. */
#include "render/bounce/bounced.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"

#include "tests/testing.h"

#define RINGS   180
#define SECTORS 360

/* Calls a function for the middles of parts of the sphere. */
static void over_sphere(void (*add)(vec3s direction, float angle, void *context), void *context)
{
    for (int ring = 0; ring < RINGS; ring++)
        for (int sector = 0; sector < SECTORS; sector++) {
            const float height = 1 - (2 * (float)ring + 1) / RINGS, radius = sqrtf(1 - height * height);
            const float turn = 2 * (float)M_PI * ((float)sector + 0.5f) / SECTORS;
            add((vec3s){{radius * cosf(turn), height, radius * sinf(turn)}},
                4 * (float)M_PI / (RINGS * SECTORS), context);
        }
}

static void add_products(vec3s direction, float angle, void *context)
{
    double(*sums)[TL_BOUNCED_TERMS] = context;
    float basis[TL_BOUNCED_TERMS];
    bounced_basis(direction, basis);
    for (int i = 0; i < TL_BOUNCED_TERMS; i++)
        for (int j = 0; j < TL_BOUNCED_TERMS; j++)
            sums[i][j] += (double)(angle * basis[i] * basis[j]);
}

static void test_orthonormal(void **state)
{
    (void)state;
    double sums[TL_BOUNCED_TERMS][TL_BOUNCED_TERMS] = {{0}};
    over_sphere(add_products, sums);
    for (int i = 0; i < TL_BOUNCED_TERMS; i++)
        for (int j = 0; j < TL_BOUNCED_TERMS; j++)
            assert_near(sums[i][j], i == j, 5e-4);
}

/* A place whose light comes from between two heights above its own horizon. */
struct lit {
    vec3s normal, lobe;
    float exponent;
    float above_y, below_y; /* of directions with light */
    struct tl_bounced terms;
    double through, seen, all; /* by the lobe: light; the sky that is not behind it, and all */
};

static void add_light(vec3s direction, float angle, void *context)
{
    struct lit *lit = context;
    if (!(glms_vec3_dot(lit->normal, direction) > 0))
        return;
    const bool is_lit = direction.y > lit->above_y && direction.y < lit->below_y;
    const float share = angle * tl_lobe_cosine(lit->exponent, glms_vec3_dot(lit->lobe, direction));
    const float sky = 1 + direction.x; /* uneven */
    float basis[TL_BOUNCED_TERMS];
    bounced_basis(direction, basis);
    for (int i = 0; i < TL_BOUNCED_TERMS; i++) {
        lit->terms.terms[0][i] += is_lit ? angle * basis[i] : 0;
        lit->terms.terms[TL_BOUNCED_OPEN_SKY][i] += is_lit ? 0 : angle * sky * basis[i];
        lit->terms.terms[TL_BOUNCED_ALL_SKY][i] += angle * sky * basis[i];
    }
    lit->through += is_lit ? (double)share : 0;
    lit->seen += is_lit ? 0 : (double)(share * sky);
    lit->all += (double)(share * sky);
}

/* An upright surface, and a lobe that points `degrees` above its horizon to the right and so much upwards. */
static struct lit light_of(float exponent, float degrees, float upwards, float above_y, float below_y)
{
    const float a = degrees * (float)M_PI / 180, b = upwards * (float)M_PI / 180;
    struct lit lit = {.normal = {{0, 0, 1}},
                      .lobe = {{cosf(b) * cosf(a), sinf(b), cosf(b) * sinf(a)}},
                      .exponent = exponent,
                      .above_y = above_y,
                      .below_y = below_y};
    over_sphere(add_light, &lit);
    return lit;
}

static const float exponents[] = {1, 4, 15, 60, 300};

static void test_even(void **state)
{
    (void)state;
    double worst = 0, worst_share = 0;
    for (size_t e = 0; e < TL_COUNT(exponents); e++)
        for (int step = 0; step <= 12; step++) {
            const struct lit lit = light_of(exponents[e], 7.5f * (float)step, 0, -2, 2);
            const struct tl_bounced_lobe lobe = tl_bounced_lobe_of(lit.normal, lit.lobe, lit.exponent);
            const double share = (double)share_above(lit.lobe.z, lit.exponent);
            const double light = (double)tl_bounced_through(&lit.terms, &lobe).x;
            worst_share = fmax(worst_share, fabs(share - lit.through));
            worst = fmax(worst, fabs(light - (double)lobe.shares.above));
        }
    printf("even light: at most %.4f off; shares above the horizon %.3f\n", worst, worst_share);
    assert_true(worst < 2e-3);
    assert_true(worst_share < 0.015);
}

/* Light of a half of what is above the surface, as of a floor below a wall. */
static void test_from_below(void **state)
{
    (void)state;
    for (size_t e = 0; e < TL_COUNT(exponents); e++) {
        double squares = 0, shares = 0;
        int count = 0;
        for (int degrees = 15; degrees <= 90; degrees += 15)
            for (int upwards = -75; upwards <= 75; upwards += 15, count++) {
                const struct lit lit = light_of(exponents[e], (float)degrees, (float)upwards, -2, 0);
                const struct tl_bounced_lobe lobe = tl_bounced_lobe_of(lit.normal, lit.lobe, lit.exponent);
                const double through = (double)tl_bounced_through(&lit.terms, &lobe).x;
                const double open = (double)tl_bounced_open_share(&lit.terms, &lobe),
                             exact = lit.seen / (lit.all > 1e-6 ? lit.all : 1);
                squares += (through - lit.through) * (through - lit.through);
                shares +=
                    (open - exact * (double)lobe.shares.above) * (open - exact * (double)lobe.shares.above);
            }
        printf("light from below, exponent %3.0f: rms %.3f, the share of the sky %.3f\n",
               (double)exponents[e], sqrt(squares / count), sqrt(shares / count));
        assert_true(sqrt(squares / count) < 0.17);
        assert_true(sqrt(shares / count) < 0.1);
    }
}

static void test_dark(void **state)
{
    (void)state;
    const struct tl_bounced dark = {0};
    const struct tl_bounced_lobe lobe = tl_bounced_lobe_of((vec3s){{0, 0, 1}}, (vec3s){{0, 0, 1}}, 8);
    assert_true(tl_bounced_through(&dark, &lobe).x == 0);
}

/* A sky of one bright spot on the left, which is hidden or seen, and a lobe across it, where its terms ring
 * below 0. */
static void test_spot(void **state)
{
    (void)state;
    const vec3s normal = {{0, 0, 1}}, left = {{-0.96f, 0, 0.28f}};
    const struct tl_bounced_lobe lobe = tl_bounced_lobe_of(normal, (vec3s){{0.28f, 0, 0.96f}}, 20);
    for (int seen = 0; seen < 2; seen++) {
        struct tl_bounced spot = {0};
        bounced_basis(left, spot.terms[TL_BOUNCED_ALL_SKY]);
        if (seen)
            bounced_basis(left, spot.terms[TL_BOUNCED_OPEN_SKY]);
        assert_true(tl_bounced_sum(spot.terms[TL_BOUNCED_ALL_SKY], &lobe) == 0);
        assert_near((double)tl_bounced_open_share(&spot, &lobe), seen * (double)lobe.shares.above, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_orthonormal), cmocka_unit_test(test_even),
                                       cmocka_unit_test(test_from_below), cmocka_unit_test(test_dark),
                                       cmocka_unit_test(test_spot)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
