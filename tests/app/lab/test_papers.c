/* docs/papers.md: each technique names options, commands, walls and tests that exist, and every wall of a
 * source has its technique. */
#include "tests/testing.h"

#include "app/lab/experiments/experiments.h"
#include "app/settings/settings.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <glob.h>
#include <string.h>

enum { WHERE, TECHNIQUE, OPTION, WALL, TESTS, CELLS };
#define ROWS_AT_LEAST 60

static void check_file(const char *pattern_a, const char *pattern_b, const char *name)
{
    const char *const patterns[] = {pattern_a, pattern_b};
    bool is_there = false;
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        glob_t found = {0};
        char *path = tl_format(patterns[i], TOILE_SOURCE_DIR, name);
        is_there = is_there || glob(path, 0, NULL, &found) == 0;
        globfree(&found);
        free(path);
    }
    if (!is_there)
        fail_msg("%s: no such command or test", name);
}

static void check_option(const char *text)
{
    struct tl_settings settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_error error = {0};
    tl_settings_reset(&settings);
    tl_settings_bind(&settings, bindings);
    if (strchr(text, '=')) {
        assert_ok(tl_options_set_assignment(bindings, TL_SETTINGS_TABLES, text, &error), error);
        return;
    }
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++) {
        const struct tl_option_table *table = bindings[t].table;
        const size_t length = strlen(table->name);
        if (strncmp(text, table->name, length) != 0 || text[length] != '.')
            continue;
        for (size_t i = 0; i < table->row_count; i++)
            if (strcmp(table->rows[i].name, text + length + 1) == 0)
                return;
    }
    fail_msg("%s: no such option", text);
}

static void check_name(int cell, const char *name)
{
    static const char command[] = "toile ";
    if (cell == OPTION && strncmp(name, command, sizeof command - 1) == 0)
        check_file("%s/app/*/cmd_%s.c", "%s/app/*/*/cmd_%s.c", name + sizeof command - 1);
    else if (cell == OPTION)
        check_option(name);
    else if (cell == WALL && !tl_experiment_find(TL_OUTPUT_PICTURES, name))
        fail_msg("%s: no such wall", name);
    else if (cell == TESTS)
        check_file("%s/tests/*/*/test_%s.c", "%s/tests/*/test_%s.c", name);
}

/* Checks the names in backquotes; returns their number. Changes the text. */
static int check_cell(int cell, char *text)
{
    int count = 0;
    for (char *at = text; (at = strchr(at, '`')); count++) {
        char *end = strchr(++at, '`');
        assert_non_null(end);
        *end = 0;
        check_name(cell, at);
        at = end + 1;
    }
    return count;
}

static void check_row(char *line)
{
    char *cells[CELLS], *rest = line + 1;
    for (int i = 0; i < CELLS; i++) {
        cells[i] = strsep(&rest, "|");
        assert_non_null(rest);
    }
    for (int i = OPTION; i < CELLS; i++)
        if (check_cell(i, cells[i]) == 0)
            fail_msg("%s: a technique without option, wall or test", cells[TECHNIQUE]);
}

static char *read_document(void)
{
    char *path = tl_format("%s/docs/papers.md", TOILE_SOURCE_DIR), *text;
    size_t size;
    tl_error error = {0};
    assert_ok(tl_file_read(path, &text, &size, &error), error);
    free(path);
    return text;
}

static void test_names_exist(void **state)
{
    (void)state;
    char *text = read_document(), *rest = text;
    int rows = 0;
    for (char *line; (line = strsep(&rest, "\n"));)
        if (strncmp(line, "| ", 2) == 0 && strncmp(line, "| where", 7) != 0) {
            check_row(line);
            rows++;
        }
    assert_true(rows >= ROWS_AT_LEAST);
    free(text);
}

static bool is_of_the_sources(const char *source)
{
    static const char *const keys[] = {"[Heidrich and Seidel 1999", "[Schroecker 2002", "[Wimmer n.d.",
                                       "[Knuth et al. 2014"};
    for (size_t i = 0; source && i < TL_COUNT(keys); i++)
        if (strstr(source, keys[i]))
            return true;
    return false;
}

static void test_walls_have_a_technique(void **state)
{
    (void)state;
    char *text = read_document();
    const struct tl_experiment *section;
    for (size_t i = 0; (section = tl_experiment_at(TL_OUTPUT_PICTURES, i)); i++) {
        char *name = tl_format("`%s`", section->name);
        if (is_of_the_sources(section->source) && !strstr(text, name))
            fail_msg("%s: a wall of a source that docs/papers.md does not name", section->name);
        free(name);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_names_exist),
                                       cmocka_unit_test(test_walls_have_a_technique)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
