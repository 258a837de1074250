#include "app/lab/gallery/gallery_figures.h"

#include "app/report/report.h"
#include "config/memory.h"

#include "tests/testing.h"

#include <string.h>

static size_t count_of(const char *text, const char *what)
{
    size_t count = 0;
    for (const char *at = strstr(text, what); at; at = strstr(at + 1, what))
        count++;
    return count;
}

/* Every figure is a plot or more, of finite numbers, and says what it shows. The page stays for a look. */
static void figures_are_plots(void **state)
{
    (void)state;
    static const struct {
        void (*write)(FILE *out);
        size_t plots;
        const char *says;
    } figures[] = {
        {tl_gallery_table_figures, 2, "Tables in float"},
        {tl_gallery_grazing_figures, 1, "divided by its greatest value"},
        {tl_gallery_normalise_figures, 1, "beats the cube map of 8 bits up to 38 degrees"},
        {tl_gallery_power_figures, 3, "it has 6 levels"},
        {tl_gallery_fresnel_figures, 1, "index 200"},
        {tl_gallery_memory_figures, 0, "18.000"}}; /* a table: 24 x 6 x 128^2 x 8 bytes are 18 MiB */
    FILE *page = fopen(TOILE_SCRATCH_DIR "/gallery_figures.html", "w");
    assert_non_null(page);
    tl_report_begin(page, "Figures", "of a test");
    for (size_t i = 0; i < TL_COUNT(figures); i++) {
        char *text;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        figures[i].write(out);
        fclose(out);
        assert_int_equal(count_of(text, "<figure>"), figures[i].plots);
        assert_non_null(strstr(text, figures[i].says));
        assert_int_equal(count_of(text, "nan") + count_of(text, "inf\""), 0);
        fputs(text, page);
        free(text);
    }
    tl_report_end(page);
    fclose(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(figures_are_plots)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
