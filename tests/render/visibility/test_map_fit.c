/* Views fitted to the casters: nothing lies outside, and what lies outermost touches the margin. */
#include "render/visibility/fit.h"

#include "tests/testing.h"

#define MAP_SIZE 128
#define MARGIN   (2.0 / MAP_SIZE)

static void check_fit(const vec3s *positions, size_t count, bool flat)
{
    tl_surface surface = {.vertex_count = count, .positions = positions};
    struct tl_caster_cloud cloud = {0};
    tl_caster_cloud_fill(&cloud, &surface, 1);
    for (int i = 0; i < 50; i++) {
        float y = 1 - ((float)i + 0.5f) / 25, angle = 2.399963f * (float)i, r = sqrtf(1 - y * y);
        vec3s direction = {{r * cosf(angle), y, r * sinf(angle)}};
        struct tl_region_view view = tl_region_view_fit(direction, &cloud, MAP_SIZE);
        double low[3] = {1, 1, 1}, high[3] = {0, 0, 0};
        for (size_t k = 0; k < count; k++)
            for (int row = 0; row < 3; row++) {
                vec4s point = {{positions[k].x, positions[k].y, positions[k].z, 1}};
                double place = (double)glms_vec4_dot(view.map_rows[row], point);
                low[row] = fmin(low[row], place);
                high[row] = fmax(high[row], place);
            }
        for (int row = 0; row < 3; row++) {
            double margin = row < 2 ? MARGIN : 1e-3;
            assert_true(low[row] > margin - 1e-4 && high[row] < 1 - margin + 1e-4);
            if (!flat) {
                assert_near(low[row], margin, 1e-4);
                assert_near(high[row], 1 - margin, 1e-4);
            }
        }
        /* Depth grows away from the light. */
        vec3s along = {{view.map_rows[2].x, view.map_rows[2].y, view.map_rows[2].z}};
        assert_true(glms_vec3_dot(along, direction) < 0);
    }
    tl_caster_cloud_release(&cloud);
}

static void test_figure(void **state)
{
    (void)state;
    vec3s positions[37]; /* no multiple of the lanes */
    for (int i = 0; i < 37; i++) {
        float height = (float)i / 36, angle = 2.399963f * (float)i;
        positions[i] = (vec3s){{0.2f * cosf(angle), 1.5f * height, 0.3f * sinf(angle)}};
    }
    check_fit(positions, 37, false);
}

/* A point, and nothing at all, have no extent. */
static void test_degenerate(void **state)
{
    (void)state;
    const vec3s point = {{1, 2, 3}};
    check_fit(&point, 1, true);
    struct tl_caster_cloud cloud = {0};
    tl_caster_cloud_fill(&cloud, NULL, 0);
    struct tl_region_view view = tl_region_view_fit((vec3s){{0, 1, 0}}, &cloud, 4);
    for (int row = 0; row < 3; row++)
        assert_true(isfinite(view.map_rows[row].x) && isfinite(view.map_rows[row].w));
    tl_caster_cloud_release(&cloud);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_figure),
        cmocka_unit_test(test_degenerate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
