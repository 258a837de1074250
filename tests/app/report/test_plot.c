/* The Pareto front against its definition, and a plot that is whole whatever it is given. */
#include "tests/testing.h"

#include "app/report/plot.h"
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
    tl_plot_print(out, plot, &(const struct tl_plot_options){0});
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

static size_t count_of(const char *text, const char *what)
{
    size_t count = 0;
    for (; (text = strstr(text, what)); text++)
        count++;
    return count;
}

/* Optional parts of a plot are drawn. The drawing's frame is from 66 to 740. */
static void manners_are_drawn(void **state)
{
    (void)state;
    const struct tl_plot_point points[] = {{0, 1, "a", false}, {1, 2, "b", false}, {2, 1, "c", false}};
    const struct tl_plot_series series[] = {{"one", points, 3, true, false}, {"two", points, 3, true, false}};
    const struct tl_plot plot = {"x", "y", false, false, series, 2};
    const struct tl_plot_guide guide = {4, "budget <4>"};
    struct tl_plot_options manner = {
        .guides = &guide, .guide_count = 1, .shaded_to = 1, .height = 300, .x_tight = true};

    char *lines = NULL;
    for (manner.kind = TL_PLOT_LINES; manner.kind <= TL_PLOT_BARS; manner.kind++) {
        char *text = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&text, &size);
        manner.bar_width = 0.5;
        tl_plot_print(out, &plot, &manner);
        fclose(out);
        assert_int_equal(count_of(text, "class=\"shade\""), 1);
        assert_int_equal(count_of(text, "class=\"guide\""), 1);
        assert_int_equal(count_of(text, "budget &lt;4&gt;"), 1); /* in view, above all points */
        assert_int_equal(count_of(text, "class=\"line s"), manner.kind <= TL_PLOT_STEPS ? 2 : 0);
        assert_int_equal(count_of(text, "class=\"area s"), manner.kind == TL_PLOT_AREAS ? 2 : 0);
        assert_int_equal(count_of(text, "<rect class=\"mark s"), manner.kind == TL_PLOT_BARS ? 6 : 0);
        assert_null(strstr(text, "nan"));
        if (manner.kind == TL_PLOT_AREAS) /* the last lies at the back */
            assert_true(strstr(text, "area s1") < strstr(text, "area s0"));
        if (manner.kind == TL_PLOT_LINES)
            lines = text;
        else
            free(text);
    }
    /* A tight axis: the shade, up to 1 of 2, is half of it. */
    assert_non_null(lines);
    assert_non_null(strstr(lines, "class=\"shade\" x=\"66.0\" y=\"14.0\" width=\"337.0\""));
    free(lines);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_is_what_nothing_beats),
        cmocka_unit_test(awkward_values_are_left_out),
        cmocka_unit_test(manners_are_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
