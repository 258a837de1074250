/* Surfaces and a GL context for the tests of the renderer. */
#ifndef TOILE_TESTS_RENDER_SHAPES_H
#define TOILE_TESTS_RENDER_SHAPES_H

#include "render/renderer.h"

/* A surface that owns its arrays. */
struct test_shape {
    tl_surface surface; /* points into this struct's arrays */
    tl_mesh mesh;
    tl_material material;
};
void test_shape_release(struct test_shape *shape);
/* Call after `mesh` or `material` was edited in place, or the struct was moved. */
void test_shape_refresh(struct test_shape *shape);

/* Unit-free builders, metres; normals analytic, tangents along u, B along minus v. */
struct test_shape test_sphere(vec3s centre, float radius, int segments);
/* (2 half)^2 square with normal `normal` about `centre`, `cells` x `cells` quads; u along `right`. */
struct test_shape test_square(vec3s centre, vec3s right, vec3s normal, float half, int cells);
/* A draped sheet: y = height + amplitude sin(k x) cos(k z) over a square. */
struct test_shape test_sheet(float height, float half, float amplitude, float waves, int cells);

/* A lat-long environment from a function of direction. */
tl_environment test_environment(int width, int height, vec3s (*radiance)(vec3s direction));

/* Paper settings with small sizes; no ground. */
struct tl_render_settings test_settings(int width, int height);
/* Looks from `eye` at `target`. */
tl_frame test_frame(vec3s eye, vec3s target, float fov_deg, const tl_surface *surfaces, size_t count,
                    const tl_environment *environment);

/* Draws and reads; fails the test when either does. */
tl_image test_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings);
const float *test_pixel(const tl_image *image, int x, int y);

/* cmocka group setup and teardown: one headless context and renderer; teardown fails when GL complained. */
struct test_device {
    tl_gpu *gpu;
    tl_renderer *renderer;
};
int test_device_open(void **state);
int test_device_close(void **state);

#endif
