/* The built-in fabrics: each can be read, names a source for its numbers, and lies within the ranges that
 * garment fabrics have in measurements (KES [Kawabata 1980], FAST [De Boos and Tester 1994]), widened to take
 * coatings and swimwear. */
#include "tests/testing.h"

#include "app/settings/settings.h"
#include "config/embedded.h"

#include <string.h>

static struct tl_settings settings;

static void check_between(const char *fabric, const char *what, double value, double minimum, double maximum)
{
    if (!(value >= minimum && value <= maximum)) {
        print_error("%s: %s is %g, not within %g and %g\n", fabric, what, value, minimum, maximum);
        fail();
    }
}

static void check_cloth(const char *name, const struct tl_cloth_fabric *fabric)
{
    const double gravity = 9.81;
    check_between(name, "areal density", fabric->areal_density, 0.03, 0.6);
    check_between(name, "weft stretch", fabric->stretch_weft, 20, 10000);
    check_between(name, "warp stretch", fabric->stretch_warp, fabric->stretch_weft, 10000);
    check_between(name, "shear", fabric->shear, 5, 2000);
    check_between(name, "friction", fabric->friction, 0.1, 0.7);
    const double bends[] = {fabric->bend_weft, fabric->bend_warp};
    for (int i = 0; i < 2; i++) { /* the bending length of fabrics is between 8 and 45 mm */
        double length_mm = 1000 * cbrt(bends[i] / (fabric->areal_density * gravity));
        check_between(name, "bending length", length_mm, 8, 45);
    }
}

/* Yarn pitches are those of garment fabrics; the crimp is below the finer of them. */
static void check_weave(const char *name, const struct tl_weave_params *weave)
{
    if (weave->pattern == TL_WEAVE_NONE || weave->pattern == TL_WEAVE_PILE)
        return;
    if (weave->pattern >=
        TL_WEAVE_JERSEY) { /* loops touch their neighbours and are higher than they are wide */
        check_between(name, "wale spacing", (double)weave->wale_mm, 0.3, 1.5);
        check_between(name, "course spacing", (double)weave->course_mm, 0.6 * (double)weave->wale_mm,
                      (double)weave->wale_mm);
        check_between(name, "yarn", (double)weave->yarn_mm, 0.3 * (double)weave->wale_mm,
                      0.6 * (double)weave->wale_mm);
        return;
    }
    check_between(name, "warp pitch", (double)weave->warp_pitch_mm, 0.1, 1.5);
    check_between(name, "weft pitch", (double)weave->weft_pitch_mm, 0.1, 1.5);
    double finer = fmin((double)weave->warp_pitch_mm, (double)weave->weft_pitch_mm);
    check_between(name, "crimp", (double)weave->crimp_mm, 0.05 * finer, finer);
}

/* Less light is reflected than arrives, in every channel. */
static void check_appearance(const char *name, const struct tl_material_params *material)
{
    for (int i = 0; i < 3; i++)
        check_between(name, "albedo", (double)material->diffuse[i] + (double)material->specular[i], 0.01, 1);
    check_between(name, "specular", (double)material->specular[1], 0.03, 0.15);
}

static void test_fabrics(void **state)
{
    (void)state;
    int measured = 0;
    for (size_t i = 0; tl_embedded_fabrics_names[i]; i++) {
        tl_error error = {0};
        const char *name = tl_embedded_fabrics_names[i], *text = tl_embedded_fabrics[i].data;
        memset(&settings, 0, sizeof settings);
        const struct tl_settings_source source = {NULL, NULL, 0};
        assert_ok(tl_settings_load(&settings, &source, &error), error);
        assert_ok(tl_settings_apply_fabric(&settings, name, &error), error);
        if (strcmp(name, "none") == 0)
            continue;
        check_cloth(name, &settings.fabric);
        check_weave(name, &settings.weave);
        check_appearance(name, &settings.material);
        /* The publication's year, or where the file is. */
        bool sourced = strstr(text, "2011") || strstr(text, "2017") || strstr(text, "github");
        if (!sourced) {
            print_error("%s names no source\n", name);
            fail();
        }
        measured += strstr(text, "Not measured there") == NULL;
    }
    assert_true(measured >= 10); /* stretch, shear, bending and density all from one source's measurements */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fabrics)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
