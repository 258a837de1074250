/* What `toile check` finds in a frame, for its tests. */
#ifndef TOILE_TESTS_APP_LAB_VERDICTS_H
#define TOILE_TESTS_APP_LAB_VERDICTS_H

#include "tests/testing.h"

#include "app/lab/check/check.h"

#include <string.h>

static inline size_t row_of(const char *name)
{
    for (size_t i = 0; i < tl_invariant_count; i++)
        if (strcmp(tl_invariants[i].name, name) == 0)
            return i;
    fail_msg("%s: no such invariant", name);
    return 0;
}

static inline struct tl_verdict verdict_on(const struct tl_checked *checked, const char *name)
{
    struct tl_verdicts verdicts = {0};
    tl_check_frame(checked, &verdicts, NULL);
    return verdicts.items[row_of(name)];
}

/* Named, and where. */
static inline void assert_breaks(const struct tl_checked *checked, const char *name, const char *place)
{
    struct tl_verdict verdict = verdict_on(checked, name);
    if (!verdict.finding.is_measured || verdict.ok || !strstr(verdict.finding.place, place)) {
        print_error("%s: %s, worst %g of %g at \"%s\", expected to break at \"%s\"\n", name,
                    verdict.finding.is_measured ? "measured" : "not measured", verdict.finding.worst,
                    verdict.finding.bound, verdict.finding.place, place);
        fail();
    }
    assert_int_equal(verdict.frame, checked->number);
}

static inline void assert_clean(const struct tl_checked *checked)
{
    struct tl_verdicts verdicts = {0};
    struct tl_finding broken = {0};
    int first = tl_check_frame(checked, &verdicts, &broken);
    if (first >= 0) {
        print_error("%s: worst %g of %g at \"%s\"\n", tl_invariants[first].name, broken.worst, broken.bound,
                    broken.place);
        fail();
    }
    assert_int_equal(tl_verdicts_failed(&verdicts), 0);
}

#endif
