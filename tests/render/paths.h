/* The paths that evaluate a gloss, and what each shows of a scene's first shape: for tests that compare cloth
 * far away with the same from near. */
#ifndef TOILE_TESTS_RENDER_PATHS_H
#define TOILE_TESTS_RENDER_PATHS_H

#include "tests/render/scenes.h"

enum test_path { AT_SAMPLES, AT_VERTICES, BY_REFERENCE, BY_LAMP, BY_LAMP_EXACTLY, TEST_PATHS };
extern const char *const test_path_names[TEST_PATHS];

/* Sets the scene to one path, with a lamp where the path wants one. */
void test_path_set(struct test_scene *scene, enum test_path path, vec3s towards_lamp);

/* The mean, in green, of a view of `side_m` at the origin, by size x size pixels, from `direction` (unit). */
double test_path_see(struct test_scene *scene, tl_renderer *renderer, enum test_path path, vec3s direction,
                     float distance_m, float side_m, int size);

#endif
