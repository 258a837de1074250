/* The Pareto front against its definition, and a plot that is whole whatever it is given. */
#include "testing.h"

#include "app/plot.h"
#include "config/memory.h"

#include <string.h>

static void front_is_what_nothing_beats(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    struct tl_plot_point points[COUNT];
    uint32_t seed = 7;
    for (int i = 0; i < COUNT; i++) {
        seed = seed * 1664525u + 1013904223u;
        points[i] = (struct tl_plot_point){.x = seed >> 26, .y = seed >> 20 & 63, .name = "point"};
    }
    points[3].y = NAN;
    size_t front[COUNT], count = tl_pareto_front(points, COUNT, front);
    assert_true(count > 1);
    for (int i = 0; i < COUNT; i++) {
        bool on_front = false, beaten = !isfinite(points[i].y);
        for (size_t k = 0; k < count; k++)
            on_front |= front[k] == (size_t)i;
        for (int j = 0; j < COUNT; j++)
            beaten |= isfinite(points[j].y) && points[j].x <= points[i].x && points[j].y <= points[i].y &&
                      (points[j].x < points[i].x || points[j].y < points[i].y);
        assert_false(on_front && beaten);
        bool twin = false; /* of equal points one stands for all */
        for (size_t k = 0; k < count; k++)
            twin |= points[front[k]].x == points[i].x && points[front[k]].y == points[i].y;
        assert_true(on_front || beaten || twin);
    }
    for (size_t k = 1; k < count; k++)
        assert_true(points[front[k]].x > points[front[k - 1]].x);
}

/* The plot as text; free() it. */
static char *plotted(const struct tl_plot *plot)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    tl_plot_print(out, plot);
    fclose(out);
    return text;
}

static void awkward_values_are_left_out(void **state)
{
    (void)state;
    const struct tl_plot_point points[] = {{NAN, 1, "a", true},
                                           {0, 1, "b", true},
                                           {-3, 2, "c", true},
                                           {5, INFINITY, "d", true},
                                           {7, 9, "<e & \"f\">", true}};
    const struct tl_plot_series series[] = {{"all", points, TL_COUNT(points), true, false}};
    const struct tl_plot_series none[] = {{"none", points, 0, true, false}};
    const struct tl_plot plots[] = {{"x", "y", true, true, series, 1},
                                    {"x", "y", false, false, series, 1},
                                    {"x", "y", true, false, none, 1}};
    const size_t marks[] = {1, 3, 0}; /* b and c have places on a linear axis */
    for (size_t p = 0; p < TL_COUNT(plots); p++) {
        char *text = plotted(&plots[p]);
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        size_t count = 0;
        for (const char *at = text; (at = strstr(at, "<title>")); at++)
            count++;
        assert_int_equal(count, marks[p]);
        if (marks[p])
            assert_non_null(strstr(text, "&lt;e &amp; &quot;f&quot;&gt;"));
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_is_what_nothing_beats),
        cmocka_unit_test(awkward_values_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
