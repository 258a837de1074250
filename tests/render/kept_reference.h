/* Ray-traced references that take long to trace, kept as tests/render/references/NAME.exr. A test program
 * that runs with TOILE_MAKE_REFERENCES=1 traces and writes them again before it compares with them: do so
 * when a scene changes, not when a test fails. What traces them is tested elsewhere (tests/render/reference).
 */
#ifndef TOILE_TESTS_RENDER_KEPT_REFERENCE_H
#define TOILE_TESTS_RENDER_KEPT_REFERENCE_H

#include "tests/golden.h"
#include "tests/render/scenes.h"

typedef tl_image kept_reference_tracer(struct test_scene *scene);

/* The image of that name, of the scene's size; the caller releases it. `trace`: NULL where another case of
 * the same program makes the image. */
static inline tl_image kept_reference(const char *name, struct test_scene *scene,
                                      kept_reference_tracer *trace)
{
    char *path = tl_format("%s/tests/render/references/%s.exr", TOILE_SOURCE_DIR, name);
    tl_error error = {0};
    tl_image image = {0};
    enum tl_exr_envmap envmap;
    if (trace && getenv("TOILE_MAKE_REFERENCES")) {
        image = trace(scene);
        golden_write(path, &image);
        tl_image_release(&image);
    }
    assert_ok(tl_exr_load(path, &image, &envmap, &error), error);
    assert_int_equal(image.channels, 4);
    free(path);
    return image;
}

#endif
