#include "app/manual/manual.h"

#include "config/base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Text for troff: a point or a quote would begin a request at the start of a line, a plain hyphen could not
 * be copied and pasted. */
static void print_text(const char *text, FILE *out)
{
    if (*text == '.' || *text == '\'')
        fputs("\\&", out);
    for (; *text; text++) {
        if (*text == '\\')
            fputs("\\e", out);
        else if (*text == '-')
            fputs("\\-", out);
        else if (*text == '\n')
            fputs("\n.br\n", out);
        else
            fputc(*text, out);
    }
}

static void print_paragraph(const char *request, const char *text, FILE *out)
{
    fprintf(out, "%s\n", request);
    print_text(text, out);
    fputc('\n', out);
}

/* A name in bold, its value in italics, and under them the help. */
static void print_item(const char *name, const char *value, const char *help, FILE *out)
{
    fputs(".TP\n\\fB", out);
    print_text(name, out);
    fputs("\\fR \\fI", out);
    print_text(value ? value : "", out);
    fputs("\\fR\n", out);
    print_text(help, out);
    fputc('\n', out);
}

static void print_head(const struct tl_manual *manual, const char *page, const char *subject, FILE *out)
{
    fputs(".\\\" Printed by `toile help man`: change the tables of commands and options instead.\n.TH ", out);
    for (const char *c = page; *c; c++)
        fputc(toupper((unsigned char)*c), out);
    fprintf(out, " 1 \"\" \"toile %s\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\n%s \\- ", manual->version,
            page);
    print_text(subject, out);
    fputs("\n.SH SYNOPSIS\n", out);
}

static void print_flags(unsigned flags, FILE *out)
{
    struct tl_flag_text flag;
    for (size_t i = 0; tl_arguments_flag(flags, i, &flag); i++)
        print_item(flag.name, flag.value, flag.help, out);
}

static void print_options(const struct tl_manual *manual, FILE *out)
{
    print_paragraph(".SH OPTIONS OF A SCENE",
                    "Each option can stand in a scene file under its table, and on the command line as --set "
                    "TABLE.KEY=VALUE. Values are the defaults.",
                    out);
    for (size_t i = 0; i < manual->binding_count; i++) {
        const struct tl_binding *binding = &manual->bindings[i];
        fprintf(out, ".SS %s\n", binding->table->name);
        print_text(binding->table->help, out);
        fputc('\n', out);
        for (size_t j = 0; j < binding->table->row_count; j++) {
            const struct tl_option *row = &binding->table->rows[j];
            char *name = tl_format("%s.%s", binding->table->name, row->name);
            char *value = tl_options_get_text(binding, row);
            char *help = tl_format("%s (%s)", row->help, row->unit[0] ? row->unit : "no unit");
            print_item(name, value, row->unit[0] ? help : row->help, out);
            free(help);
            free(value);
            free(name);
        }
    }
}

static void print_status(FILE *out)
{
    fputs(".SH EXIT STATUS\n", out);
    print_item("0", "", "done", out);
    print_item("1", "", "a check failed", out);
    print_item("2", "", "an error of usage, of a file or of the device: one line on standard error", out);
    print_item("130", "", "interrupted", out);
}

void tl_manual_print(const struct tl_manual *manual, FILE *out)
{
    print_head(manual, "toile", "garment review: draping, light with shadows, and checks", out);
    fputs("\\fBtoile\\fR \\fICOMMAND\\fR [\\fISCENE\\fR] [\\fIOPTIONS\\fR]\n", out);
    print_paragraph(
        ".SH DESCRIPTION",
        "SCENE is a YAML file, a model (.glb, .gltf, .obj), a sewing pattern (.json), a point cache (.pc2, "
        ".mdd) beside its mesh, or nothing: the built-in scene. Results go to standard output, messages to "
        "standard error.",
        out);
    fputs(".SH COMMANDS\nEach has a page of its own: \\fBman toile\\-render\\fR.\n", out);
    for (size_t i = 0; i < manual->command_count; i++)
        print_item(manual->commands[i].name, "", manual->commands[i].help, out);
    print_options(manual, out);
    print_status(out);
    fputs(".SH FILES\n", out);
    print_item("~/.cache/toile", "", "results that are kept for reuse ($XDG_CACHE_HOME/toile)", out);
    print_item("~/.local/state/toile", "", "the window's state and its journal ($XDG_STATE_HOME/toile)", out);
}

/* The first sentence of a command's help, for the line that apropos lists. */
static char *subject_of(const struct tl_command *command)
{
    char *subject = tl_copy_string(command->help);
    subject[strcspn(subject, ".:(")] = '\0';
    subject[0] = (char)tolower((unsigned char)subject[0]);
    return subject;
}

void tl_manual_print_command(const struct tl_manual *manual, const struct tl_command *command, FILE *out)
{
    char *page = tl_format("toile-%s", command->name), *subject = subject_of(command);
    print_head(manual, page, subject, out);
    fputs("toile ", out);
    print_text(command->usage, out);
    print_paragraph("\n.SH DESCRIPTION", command->help, out);
    fputs(".SH OPTIONS\n", out);
    print_flags(command->flags, out);
    print_status(out);
    fputs(".SH SEE ALSO\n\\fBtoile\\fR(1)\n", out);
    free(subject);
    free(page);
}
