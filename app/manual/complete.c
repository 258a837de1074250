#include "app/manual/manual.h"

#include "config/base/memory.h"
#include "config/colour/names.h"
#include "config/embedded.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

struct completion {
    const struct tl_manual *manual;
    const char *begun; /* the word at the cursor */
    FILE *out;
};

static void offer(const struct completion *completion, const char *word, const char *help)
{
    if (strncmp(word, completion->begun, strlen(completion->begun)) == 0)
        fprintf(completion->out, "%s\t%s\n", word, help);
}

static void offer_files(const struct completion *completion)
{
    fputs("+files\n", completion->out);
}

/* An option by "table.key". */
static const struct tl_option *find_option(const struct tl_manual *manual, const char *key)
{
    for (size_t i = 0; i < manual->binding_count; i++) {
        const struct tl_option_table *table = manual->bindings[i].table;
        size_t length = strlen(table->name);
        if (strncmp(key, table->name, length) != 0 || key[length] != '.')
            continue;
        for (size_t j = 0; j < table->row_count; j++)
            if (strcmp(table->rows[j].name, key + length + 1) == 0)
                return &table->rows[j];
    }
    return NULL;
}

/* `prefix` is what stands before the value in the same word: "table.key=", or nothing. */
static void offer_values(const struct completion *completion, const struct tl_option *row, const char *prefix)
{
    static const char *const truths[] = {"true", "false", NULL};
    const char *const *choices = row->type == TL_BOOL     ? truths
                                 : row->type == TL_COLOUR ? tl_colour_names
                                                          : row->choices;
    if (row->type == TL_PATH)
        offer_files(completion);
    for (size_t i = 0; choices && choices[i]; i++) {
        char *word = tl_format("%s%s", prefix, choices[i]);
        offer(completion, word, "");
        free(word);
    }
}

/* --set: names of options up to the equals sign, then the option's values. */
static void offer_assignments(const struct completion *completion)
{
    const char *equals = strchr(completion->begun, '=');
    if (equals) {
        char *key = strndup(completion->begun, (size_t)(equals - completion->begun));
        char *prefix = tl_format("%s=", key);
        const struct tl_option *row = find_option(completion->manual, key);
        if (row)
            offer_values(completion, row, prefix);
        free(prefix);
        free(key);
        return;
    }
    for (size_t i = 0; i < completion->manual->binding_count; i++) {
        const struct tl_option_table *table = completion->manual->bindings[i].table;
        for (size_t j = 0; j < table->row_count; j++) {
            char *word = tl_format("%s.%s=", table->name, table->rows[j].name);
            offer(completion, word, table->rows[j].help);
            free(word);
        }
    }
}

/* Offers the words of a usage text, "[light|cloth|detail]" or "FILE|fabrics": those in small letters stand
 * for themselves, those in capitals for a file, a scene or a command. */
static void offer_usage(const struct completion *completion, const char *usage)
{
    const char *end = usage + strcspn(usage, " \n");
    bool files = false;
    while (usage < end) {
        usage += strspn(usage, "[|]");
        size_t length = strcspn(usage, "[|] \n");
        char *word = strndup(usage, length);
        if (islower((unsigned char)word[0]))
            offer(completion, word, "");
        else if (strcmp(word, "COMMAND") == 0)
            for (size_t i = 0; i < completion->manual->command_count; i++)
                offer(completion, completion->manual->commands[i].name, "");
        else if (strcmp(word, "SCENE") == 0)
            for (size_t i = 0; tl_embedded_scenes_names[i]; i++)
                offer(completion, tl_embedded_scenes_names[i], "built-in scene");
        files = files || (isupper((unsigned char)word[0]) && strcmp(word, "COMMAND") != 0);
        free(word);
        usage += length + strspn(usage + length, "]");
    }
    if (files)
        offer_files(completion);
}

/* A flag whose values no option lists: the command's usage may list them after its name. */
static void offer_flag_values(const struct completion *completion, const struct tl_command *command,
                              const struct tl_flag_text *flag)
{
    const struct tl_option *row = flag->key ? find_option(completion->manual, flag->key) : NULL;
    char *named = tl_format("%s ", flag->name);
    const char *usage = strstr(command->usage, named);
    if (row)
        offer_values(completion, row, "");
    else if (strcmp(flag->name, "--set") == 0)
        offer_assignments(completion);
    else if (strstr(flag->value, "FILE") || strstr(flag->value, "FOLDER"))
        offer_files(completion);
    else if (usage && islower((unsigned char)usage[strlen(named)]))
        offer_usage(completion, usage + strlen(named));
    free(named);
}

static void complete_argument(const struct completion *completion, const struct tl_command *command,
                              const char *previous)
{
    struct tl_flag_text flag;
    for (size_t i = 0; tl_arguments_flag(command->flags, i, &flag); i++)
        if (flag.value && strcmp(flag.name, previous) == 0) {
            offer_flag_values(completion, command, &flag);
            return;
        }
    if (completion->begun[0] == '-') {
        for (size_t i = 0; tl_arguments_flag(command->flags, i, &flag); i++)
            offer(completion, flag.name, flag.help);
        return;
    }
    const char *usage = command->usage + strlen(command->name);
    offer_usage(completion, usage + strspn(usage, " "));
}

/* The next word of *line, as a new string, and moves *line behind it and the blank that ends it. */
static char *take_word(const char **line)
{
    size_t length = strcspn(*line, " ");
    char *word = strndup(*line, length);
    *line += length;
    *line += strspn(*line, " ");
    return word;
}

void tl_complete_print(const struct tl_manual *manual, const char *line, FILE *out)
{
    const char *last = strrchr(line, ' ');
    struct completion completion = {manual, last ? last + 1 : line, out};
    free(take_word(&line)); /* the program */
    char *name = take_word(&line), *previous = tl_copy_string("");
    const struct tl_command *command = NULL;
    for (size_t i = 0; i < manual->command_count; i++)
        if (strcmp(manual->commands[i].name, name) == 0 && line <= completion.begun)
            command = &manual->commands[i];
    while (line < completion.begun) {
        free(previous);
        previous = take_word(&line);
    }
    if (command)
        complete_argument(&completion, command, previous);
    else
        for (size_t i = 0; i < manual->command_count; i++)
            offer(&completion, manual->commands[i].name, manual->commands[i].help);
    free(previous);
    free(name);
}
