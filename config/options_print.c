#include "config/base/memory.h"
#include "config/options.h"
#include "config/options_value.h"

#include <stdlib.h>
#include <string.h>

/* Value for a shell: quoted when it would otherwise be several words or none. */
static void print_assignment(const struct tl_binding *binding, const struct tl_option *row, FILE *out)
{
    char *value = tl_options_get_text(binding, row);
    char *quoted =
        value[0] == '\0' || strpbrk(value, " [];'\"") ? tl_format("'%s'", value) : tl_copy_string(value);
    char *assignment = tl_format("%s.%s=%s", binding->table->name, row->name, quoted);
    char *expected = tl_option_expectation(row);
    fprintf(out, "  %-36s %s (%s)\n", assignment, row->help, expected);
    free(expected);
    free(assignment);
    free(quoted);
    free(value);
}

void tl_options_print_help(const struct tl_binding *bindings, size_t count, FILE *out)
{
    for (size_t i = 0; i < count; i++) {
        const struct tl_option_table *table = bindings[i].table;
        fprintf(out, "%s%s: %s\n", i ? "\n" : "", table->name, table->help);
        for (size_t j = 0; j < table->row_count; j++)
            print_assignment(&bindings[i], &table->rows[j], out);
    }
}

/* A cell of a Markdown table: a bar would end it. */
static void print_cell(const char *text, FILE *out)
{
    fputc(' ', out);
    for (; *text; text++) {
        if (*text == '|')
            fputc('\\', out);
        fputc(*text, out);
    }
    fputs(" |", out);
}

void tl_options_print_reference(const struct tl_binding *bindings, size_t count, FILE *out)
{
    fputs(
        "# Options\n\nEvery option can stand in a scene file, under its table, and on the command line as\n"
        "`--set table.option=value`. This page is printed from the tables that the program itself reads.\n\n"
        "A colour is `[r, g, b]` in linear Rec. 709 (reflectances); `\"#a1b2c3\"` or `\"#abc\"`, which is "
        "sRGB "
        "and in a file\nneeds its quotation marks; `lab(L, a, b)` or `Lab L a b`, which is CIELAB under D65; "
        "or a name of CSS, `navy`. A\nCIELAB colour that is too saturated for Rec. 709 keeps its lightness "
        "and hue; a warning states what is drawn.\n",
        out);
    for (size_t i = 0; i < count; i++) {
        const struct tl_option_table *table = bindings[i].table;
        struct tl_binding defaults = {table, tl_alloc(1, table->params_size)};
        tl_options_reset(&defaults, 1);
        fprintf(out, "\n## %s\n\n%s\n\n| option | default | accepts | what it does |\n|---|---|---|---|\n",
                table->name, table->help);
        for (size_t j = 0; j < table->row_count; j++) {
            char *value = tl_options_get_text(&defaults, &table->rows[j]);
            char *expected = tl_option_expectation(&table->rows[j]);
            fprintf(out, "| `%s.%s` |", table->name, table->rows[j].name);
            print_cell(value, out);
            print_cell(expected, out);
            print_cell(table->rows[j].help, out);
            fputc('\n', out);
            free(expected);
            free(value);
        }
        free(defaults.params);
    }
}

/* Text is quoted always, so that `none`, `12` or `a: b` stay text; it holds nothing that needs another escape
 * (config/options.h: printable UTF-8). */
static void print_quoted(const char *text, FILE *out)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            fputc('\\', out);
        fputc(*text, out);
    }
    fputc('"', out);
}

/* A name that was left out: no text stands for it, but not to write it does. */
static bool is_left_out(const struct tl_option *row, const char *value)
{
    return row->type == TL_PATH && row->choices && value[0] == '\0';
}

void tl_options_print_yaml(const struct tl_binding *bindings, size_t count, FILE *out)
{
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%s:\n", bindings[i].table->name);
        for (size_t j = 0; j < bindings[i].table->row_count; j++) {
            const struct tl_option *row = &bindings[i].table->rows[j];
            char *value = tl_options_get_text(&bindings[i], row);
            if (is_left_out(row, value)) {
                free(value);
                continue;
            }
            fprintf(out, "  %s: ", row->name);
            if (row->type == TL_STRING || row->type == TL_PATH)
                print_quoted(value, out);
            else
                fputs(value, out);
            fputc('\n', out);
            free(value);
        }
    }
}
