/* What the papers expect of the gallery's techniques, measured on small pictures of the solids: the one that
 * a claim calls nearer to the exact picture is, everywhere but where the claim's row states that it is not.
 * The walls are those whose figures do not depend on how many pixels a thread has. */
#include "tests/testing.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/gallery/gallery.h"
#include "app/lab/gallery/shots.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 64

static const char *const walls[] = {"a2", "a6", "a7", "a8", "a9", "a10", "b1", "d9"};

struct measured {
    struct tl_experiment_picture picture;
    double error;
};

static bool is_claimed(const struct tl_experiment *section, const char *name)
{
    for (int i = 0; i < TL_EXPERIMENT_CLAIMS && section->claims[i].nearer; i++)
        if (strcmp(section->claims[i].nearer, name) == 0 || strcmp(section->claims[i].farther, name) == 0)
            return true;
    return false;
}

static void measure(struct tl_shots *shots, struct measured *out)
{
    struct tl_gallery_shot tested;
    tl_error error = {0};
    const struct tl_gallery_shot *exact = tl_shots_exact(shots, &out->picture, TL_PICTURE_SOLID, &error);
    assert_ok(exact && tl_shots_draw(shots, &out->picture, TL_PICTURE_SOLID, &tested, &error), error);
    assert_ok(tl_gallery_measure_error(out->picture.experiment, &tested, exact, &out->error, &error), error);
    tl_gallery_shot_release(&tested);
}

static bool is_of(const struct measured *measured, const char *name)
{
    return strcmp(measured->picture.technique->picture, name) == 0;
}

/* "torus (edges of 4 cm)", as on the page; a new string. */
static char *place_of(const struct measured *measured)
{
    const struct tl_experiment_picture *picture = &measured->picture;
    const char *name = picture->experiment->solid;
    return picture->appearance ? tl_format("%s (%s)", name, picture->appearance->title)
                               : tl_copy_string(name);
}

static int check(const struct tl_experiment_claim *claim, const struct measured *nearer,
                 const struct measured *farther)
{
    char *place = place_of(nearer);
    const bool expected = !claim->but || !strstr(claim->but, place);
    const bool found = nearer->error < farther->error;
    if (found != expected)
        print_error("%s: %s: \"%s\" errs by %.4g, \"%s\" by %.4g on the %s: the claim is %s\n",
                    nearer->picture.experiment->name, claim->source, claim->nearer, nearer->error,
                    claim->farther, farther->error, place,
                    found ? "true there, and its row has it wrong" : "wrong");
    free(place);
    return found != expected;
}

static int check_section(struct tl_shots *shots, const struct tl_experiment *section)
{
    struct tl_experiment small = *section;
    struct tl_experiment_picture picture = {.experiment = &small};
    struct measured *all = TL_NEW_ARRAY(struct measured, tl_picture_count(section, TL_OUTPUT_PICTURES));
    size_t count = 0;
    int wrong = 0;
    small.side = SIDE;
    while (tl_picture_next(&picture, TL_OUTPUT_PICTURES))
        if (is_claimed(section, picture.technique->picture)) {
            all[count].picture = picture;
            measure(shots, &all[count++]);
        }
    for (int c = 0; c < TL_EXPERIMENT_CLAIMS && section->claims[c].nearer; c++)
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < count; k++)
                if (is_of(&all[i], section->claims[c].nearer) && is_of(&all[k], section->claims[c].farther) &&
                    all[i].picture.appearance == all[k].picture.appearance)
                    wrong += check(&section->claims[c], &all[i], &all[k]);
    free(all);
    return wrong;
}

static void claims_agree_with_figures(void **state)
{
    (void)state;
    struct tl_shots shots;
    tl_error error = {0};
    int wrong = 0;
    assert_ok(tl_shots_open(&shots, &error), error);
    for (size_t i = 0; i < TL_COUNT(walls); i++)
        wrong += check_section(&shots, tl_experiment_find(TL_OUTPUT_PICTURES, walls[i]));
    tl_shots_close(&shots);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(claims_agree_with_figures)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
