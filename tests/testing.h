/* Shared by all tests: cmocka, access to real data that may be absent, and a few checks. */
#ifndef TOILE_TESTS_TESTING_H
#define TOILE_TESTS_TESTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Path of a file or folder of the real test data: of the folder that the environment's TOILE_DATA names, or
 * that TOILE_DATA_DIR names, else of tests/data, which has the small ones. Skips the test, with the reason,
 * when all lack it. */
static inline const char *test_data(const char *relative)
{
    static char paths[8][1024]; /* a test may hold a few at once */
    static int next;
    char *path = paths[next++ % 8];
    const char *other = getenv("TOILE_DATA");
    const char *folders[] = {other ? other : TOILE_DATA_DIR, TOILE_SOURCE_DIR "/tests/data"};
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof paths[0], "%s/%s", folders[i], relative);
        if (access(path, R_OK) == 0)
            return path;
    }
    printf("skipped: %s is in neither %s nor tests/data\n", relative, folders[0]);
    skip();
    return path;
}

/* |actual - expected| <= tolerance, and both finite; prints the three when not. */
#define assert_near(actual, expected, tolerance)                                                             \
    do {                                                                                                     \
        double actual_ = (double)(actual), expected_ = (double)(expected), tolerance_ = (double)(tolerance); \
        if (!(fabs(actual_ - expected_) <= tolerance_)) {                                                    \
            print_error("%s = %.9g, expected %.9g within %.3g\n", #actual, actual_, expected_, tolerance_);  \
            fail();                                                                                          \
        }                                                                                                    \
    } while (0)

/* A call that must succeed; prints the error's message when it does not. */
#define assert_ok(call, error)                                                                               \
    do {                                                                                                     \
        if (!(call)) {                                                                                       \
            print_error("%s: %s\n", #call, (error).message);                                                 \
            fail();                                                                                          \
        }                                                                                                    \
    } while (0)

/* How precise graphics cards are where GL does not say: vertices are placed to 1/256 of a pixel
 * (SUBPIXEL_BITS of 8), so that a sample shows what lies up to TEST_PLACE of a pixel beside it along each
 * axis; weights of linear filters have steps of 1/256, so that each errs by up to TEST_WEIGHT of what two
 * texels differ by; and a float may be cut to a half, not rounded. tests/render/hardware draws all but the
 * last in software. */
#define TEST_PLACE  (1.0 / 512)
#define TEST_WEIGHT (1.0 / 512)

#endif
