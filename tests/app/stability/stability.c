/* toile-stability [TOPIC] [--quick] [--json]: the extremes, cell by cell, each exact, bounded, coarse or
 * refused; anything else is a failure. `toile stability` runs it, and so does test cli_stability. */
#include "tests/app/stability/stability.h"

#include "app/cli/json.h"
#include "app/cli/topic.h"
#include "config/base/interrupt.h"

#include <stdio.h>

#define FLAGS (TL_FLAGS_SCENE | TL_FLAGS_JSON | TL_FLAGS_QUICK)

static bool (*const topics[])(const struct tl_arguments *arguments, struct tl_stability *out,
                              tl_error *error) = {tl_stability_cloth, tl_stability_light, tl_stability_detail,
                                                  tl_stability_shading};
enum { TOPICS = sizeof topics / sizeof *topics };
static const char *const topic_names[] = {"cloth", "light", "detail", "shading", NULL};

static void print_json(struct tl_stability *stability)
{
    static const char *const keys[TL_OUTCOME_COUNT] = {"exact",   "bounded", "coarse",
                                                       "refused", "silent",  "nan"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "cells", tl_stability_cells(stability));
    for (int i = 0; i < TL_OUTCOME_COUNT; i++)
        cJSON_AddNumberToObject(object, keys[i], stability->counts[i]);
    cJSON_AddItemToObject(object, "rows", stability->rows);
    stability->rows = NULL;
    tl_json_print(object);
}

/* A line: the axis, the outcome, the error, then the row's further members. */
static void print_row(const cJSON *row)
{
    const cJSON *outcome = row->child->next, *share = outcome->next, *own = share->next, *unit = own->next;
    printf("%-8s%-8s", row->child->valuestring, outcome->valuestring);
    if (cJSON_IsNumber(share))
        printf(" %8.3g%% %8.3g %-5s", share->valuedouble, own->valuedouble, unit->valuestring);
    else
        printf(" %9s %14s", "", "");
    for (const cJSON *member = unit->next; member; member = member->next) {
        if (cJSON_IsNumber(member))
            printf("  %s: %.4g", member->string, member->valuedouble);
        else if (cJSON_IsString(member) && member->valuestring[0])
            printf("  %s: %s", member->string, member->valuestring);
    }
    putchar('\n');
}

static void print_table(const struct tl_stability *stability)
{
    const int *counts = stability->counts;
    const cJSON *row;
    cJSON_ArrayForEach(row, stability->rows) print_row(row);
    printf("\n%d cells: %d exact, %d bounded by %.0f %%, %d coarse, %d refused, %d silent, %d with NaN\n",
           tl_stability_cells(stability), counts[TL_OUTCOME_EXACT], counts[TL_OUTCOME_BOUNDED],
           100 * TL_STATED_SHARE, counts[TL_OUTCOME_COARSE], counts[TL_OUTCOME_REFUSED],
           counts[TL_OUTCOME_SILENT], counts[TL_OUTCOME_NAN]);
}

static bool run(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_arguments scene;
    int topic;
    if (!tl_topic_take("stability", arguments, topic_names, true, &scene, &topic, error))
        return false;
    struct tl_stability stability = {.rows = cJSON_CreateArray()};
    bool done = true;
    for (int i = 0; done && i < TOPICS; i++)
        done = (topic >= 0 && topic != i) || topics[i](&scene, &stability, error);
    if (done && arguments->json)
        print_json(&stability);
    else if (done)
        print_table(&stability);
    cJSON_Delete(stability.rows);
    int silent = stability.counts[TL_OUTCOME_SILENT], nan = stability.counts[TL_OUTCOME_NAN];
    if (done && silent + nan > 0)
        done = tl_fail(error, TL_UNSTABLE, "stability: %d cells silently out of their bounds, %d with NaN",
                       silent, nan);
    return done;
}

int main(int argc, char **argv)
{
    struct tl_arguments arguments;
    tl_error error = {0};
    tl_interrupt_install();
    bool done = tl_arguments_parse(argc - 1, argv + 1, FLAGS, &arguments, &error);
    if (done) {
        tl_arguments_apply(&arguments);
        done = run(&arguments, &error);
    }
    if (fflush(stdout) != 0 && done)
        done = tl_fail(&error, TL_OUTPUT,
                       "standard output: could not be written: free some space or check the pipe");
    if (!done)
        fprintf(stderr, "toile: %s\n", error.message);
    tl_arguments_release(&arguments);
    return done ? 0 : tl_exit_status(error.code);
}
