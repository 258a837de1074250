/* A report's page is its parts, whole, whatever the data holds: the data is read back from the file as it was
 * given. Figures against what they are made of; pictures against RFC 4648. */
#include "tests/testing.h"

#include "app/report/report.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <string.h>

static size_t count_of(const char *text, const char *what)
{
    size_t count = 0;
    for (; (text = strstr(text, what)); text++)
        count++;
    return count;
}

static const char script[] = "begin(data.title);";
static const char awkward[] = "</script><script>alert(\"1\")</script><!-- {{data}} \\u003c & \xc3\xa9\n";

static void data_stays_data(void **state)
{
    (void)state;
    tl_error error = {0};
    char *page = NULL;
    size_t size = 0;
    cJSON *data = cJSON_CreateObject(), *names = cJSON_AddArrayToObject(data, awkward);
    cJSON_AddItemToArray(names, cJSON_CreateString(awkward));
    cJSON *kept = cJSON_Duplicate(data, true);
    assert_ok(tl_report_write(TOILE_SCRATCH_DIR, "report.html", script, data, &error), error);
    assert_ok(tl_file_read_small(TOILE_SCRATCH_DIR "/report.html", 1 << 20, &page, &size, &error), error);
    assert_int_equal(count_of(page, "<script"), 2);
    assert_int_equal(count_of(page, "</script>"), 2);
    assert_int_equal(count_of(page, "<!--"), 0);
    assert_int_equal(count_of(page, "--paper:"),
                     2); /* the style sheet has its colours twice: in the light and in the dark */
    assert_true(strstr(page, "function plot(") <
                strstr(page, script)); /* the parts before the report's own script */
    static const char start[] = "id=\"data\">\n";
    const char *json = strstr(page, start) + strlen(start);
    cJSON *found = cJSON_ParseWithOpts(json, &json, false);
    assert_true(cJSON_Compare(found, kept, true));
    assert_memory_equal(json, "\n</script>", 10);
    cJSON_Delete(found);
    cJSON_Delete(kept);
    free(page);
}

static void a_folder_that_is_not_there_is_named(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_false(tl_report_write(TOILE_SCRATCH_DIR "/nowhere", "report.html", "sheet.js",
                                 cJSON_CreateObject(), &error));
    assert_non_null(strstr(error.message, "nowhere/report.html"));
}

/* The test vectors of RFC 4648, section 10. */
static void pictures_are_base64(void **state)
{
    (void)state;
    static const char *const vectors[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t i = 0; i < TL_COUNT(vectors); i++) {
        cJSON *string = tl_report_png("foobar", i);
        char *wanted = tl_format("data:image/png;base64,%s", vectors[i]);
        assert_string_equal(string->valuestring, wanted);
        free(wanted);
        cJSON_Delete(string);
    }
}

static void no_texts_are_an_empty_array(void **state)
{
    (void)state;
    cJSON *object = cJSON_CreateObject();
    char one[] = "one", *texts[] = {one};
    tl_report_add_texts(object, "none", NULL, 0);
    tl_report_add_texts(object, "some", texts, 1);
    char *text = cJSON_PrintUnformatted(object);
    assert_string_equal(text, "{\"none\":[],\"some\":[\"one\"]}");
    cJSON_free(text);
    cJSON_Delete(object);
}

static void figures_are_what_was_added(void **state)
{
    (void)state;
    cJSON *figures = cJSON_CreateArray();
    cJSON *series =
        tl_report_add_plot(figures, &(const struct tl_report_plot){"x", "y", true, false, "caption"});
    cJSON *points = tl_report_add_series(series, "one", false);
    tl_report_add_point(points, 1, 0.5);
    tl_report_add_point(points, 2, NAN);
    tl_report_add_series(series, "best", true);
    static const struct tl_report_column columns[] = {{"size", 0}, {"MiB", 2}};
    cJSON *rows = tl_report_add_table(figures, columns, TL_COUNT(columns));
    tl_report_add_row(rows, "16", (const double[]){1.25}, 1);
    char *text = cJSON_PrintUnformatted(figures);
    assert_string_equal(
        text, "[{\"x_label\":\"x\",\"y_label\":\"y\",\"x_log\":true,\"y_log\":false,\"caption\":\"caption\","
              "\"series\":[{\"name\":\"one\",\"line\":true,\"front\":false,\"points\":[[1,0.5],[2,null]]},"
              "{\"name\":\"best\",\"line\":false,\"front\":true,\"points\":[]}]},"
              "{\"columns\":[{\"head\":\"size\",\"digits\":0},{\"head\":\"MiB\",\"digits\":2}],"
              "\"rows\":[[\"16\",1.25]]}]");
    cJSON_free(text);
    cJSON_Delete(figures);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(data_stays_data),
        cmocka_unit_test(a_folder_that_is_not_there_is_named),
        cmocka_unit_test(pictures_are_base64),
        cmocka_unit_test(no_texts_are_an_empty_array),
        cmocka_unit_test(figures_are_what_was_added),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
