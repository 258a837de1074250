#include "app/lab/gallery/words.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Errors whose ratio is within this are called equal: the last digits of a picture's error depend on which
 * samples lie on an outline. */
#define EQUAL_RATIO 1.01
/* Errors below this are called equal to the exact picture's and to each other. */
#define NO_ERROR 5e-6

char *tl_words_error(const struct tl_experiment *experiment, double error)
{
    return experiment->by_flip ? tl_format("FLIP %.3g", error) : tl_format("%.3g %%", 100 * error);
}

/* The page has all of the text. */
char *tl_words_head(const struct tl_experiment *experiment)
{
    const char *text = experiment->exact_text;
    return experiment->exact == TL_EXACT_NONE ? tl_copy_string("for comparison")
                                              : tl_format("exact: %.*s", (int)strcspn(text, ";"), text);
}

static bool is_equal(double a, double b)
{
    return fabs(a - b) < NO_ERROR || (a < b ? b < EQUAL_RATIO * a : a < EQUAL_RATIO * b);
}

static const char *object_name(const struct tl_experiment *experiment, enum tl_picture_object object)
{
    return object == TL_PICTURE_SOLID ? experiment->solid : "sheet";
}

struct ranked_entry {
    const struct tl_gallery_entry *entry;
    double error;
};

static int compare_errors(const void *a, const void *b)
{
    const struct ranked_entry *left = a, *right = b;
    return (left->error > right->error) - (left->error < right->error);
}

static void append_error(FILE *out, const struct tl_experiment *experiment, double error)
{
    char *text = tl_words_error(experiment, error);
    fputs(text, out);
    free(text);
}

static void print_order(const struct ranked_entry *order, size_t count, FILE *out)
{
    const struct tl_experiment *experiment = order->entry->picture.experiment;
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%s%s: ", i ? "; " : "", order[i].entry->picture.technique->picture);
        append_error(out, experiment, order[i].error);
    }
    if (is_equal(order[0].error, order[count - 1].error))
        fputs(count == 2 ? ". Both are equally near." : ". All are equally near.", out);
    else if (is_equal(order[0].error, order[1].error))
        fprintf(out, ". \"%s\" and \"%s\" are equally near.", order[0].entry->picture.technique->picture,
                order[1].entry->picture.technique->picture);
    else
        fprintf(out, ". \"%s\" is nearest.", order[0].entry->picture.technique->picture);
}

char *tl_words_order(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                     enum tl_picture_object object, const struct tl_experiment_appearance *appearance)
{
    struct ranked_entry *order = TL_NEW_ARRAY(struct ranked_entry, (size_t)(end - first));
    size_t count = 0;
    for (const struct tl_gallery_entry *entry = first; entry < end; entry++)
        if (entry->picture.appearance == appearance)
            order[count++] = (struct ranked_entry){entry, entry->figures.error[object]};
    qsort(order, count, sizeof *order, compare_errors);
    char *text = NULL;
    if (count > 1) {
        size_t size;
        FILE *out = open_memstream(&text, &size);
        fprintf(out, "On the %s", object_name(first->picture.experiment, object));
        if (appearance)
            fprintf(out, ", %s", appearance->title);
        fputs(": ", out);
        print_order(order, count, out);
        fclose(out);
    }
    free(order);
    return text;
}

static const struct tl_gallery_entry *find(const struct tl_gallery_entry *first,
                                           const struct tl_gallery_entry *end, const char *technique,
                                           const struct tl_experiment_appearance *appearance)
{
    for (const struct tl_gallery_entry *entry = first; entry < end; entry++)
        if (entry->picture.appearance == appearance &&
            strcmp(entry->picture.technique->picture, technique) == 0)
            return entry;
    return NULL;
}

/* One comparison of a claim: "torus 0.8 % against 3.2 %, yes". */
static void print_verdict(FILE *out, const struct tl_gallery_entry *nearer,
                          const struct tl_gallery_entry *farther, enum tl_picture_object object)
{
    const struct tl_experiment *experiment = nearer->picture.experiment;
    double expected = nearer->figures.error[object], other = farther->figures.error[object];
    fputs(object_name(experiment, object), out);
    if (nearer->picture.appearance)
        fprintf(out, " (%s)", nearer->picture.appearance->title);
    fputc(' ', out);
    append_error(out, experiment, expected);
    fputs(" against ", out);
    append_error(out, experiment, other);
    fputs(is_equal(expected, other) ? ", they are equal" : expected < other ? ", it is" : ", it is not", out);
}

char *tl_words_claim(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                     const struct tl_experiment_claim *claim)
{
    char *text = NULL;
    size_t size, verdicts = 0;
    FILE *out = open_memstream(&text, &size);
    fprintf(out, "%s expects \"%s\" to be nearer than \"%s\": ", claim->source, claim->nearer,
            claim->farther);
    for (const struct tl_gallery_entry *entry = first; entry < end; entry++) {
        if (strcmp(entry->picture.technique->picture, claim->nearer) != 0)
            continue;
        const struct tl_gallery_entry *farther = find(first, end, claim->farther, entry->picture.appearance);
        for (int object = 0; farther && object < TL_PICTURE_OBJECTS; object++) {
            fputs(verdicts++ ? "; " : "", out);
            print_verdict(out, entry, farther, object);
        }
    }
    fputc('.', out);
    fclose(out);
    if (verdicts == 0) {
        free(text);
        return NULL;
    }
    return text;
}

char *tl_words_motion(const struct tl_gallery_entry *entry)
{
    const struct tl_experiment *experiment = entry->picture.experiment;
    double step = (double)experiment->motion_step, change = entry->figures.change,
           exact = entry->figures.exact_change;
    char *what = experiment->motion == TL_MOTION_CAMERA ? tl_format("The camera turns by %g degrees", step)
                 : experiment->motion == TL_MOTION_LAMP ? tl_format("The lamp turns by %g degrees", step)
                 : experiment->motion == TL_MOTION_SKY
                     ? tl_format("The environment plays %g frame%s", step, step > 1 ? "s" : "")
                     : tl_format("The sheet falls for %g frames", step);
    char *text = tl_format("%s from picture to picture: pixels change by %.3g levels of 255 in the mean, %s "
                           "the %s picture's, which change by %.3g.",
                           what, change,
                           is_equal(change, exact) ? "as much as"
                           : change > exact        ? "more than"
                                                   : "less than",
                           experiment->exact == TL_EXACT_NONE ? "other" : "exact", exact);
    free(what);
    return text;
}
