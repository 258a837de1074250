/* toile trade: error against time along an axis, as CSV and as a report. */
#include "app/lab/experiments/experiments.h"
#include "app/lab/trade/commands.h"
#include "app/lab/trade/trade.h"
#include "app/lab/trade/trade_cloth.h"
#include "app/report/folder.h"
#include "config/file.h"

#include <stdlib.h>
#include <string.h>

/* Results that were measured before an interruption are valid and are written; `done` says whether there are
 * all. */
static bool write_both(const char *folder, const void *trade, void (*write_csv)(const void *, FILE *),
                       void (*write_html)(const void *, FILE *), bool done, tl_error *error)
{
    tl_error failure = {0};
    if (tl_folder_print(folder, "trade.csv", trade, write_csv, &failure) &&
        tl_folder_print(folder, "report.html", trade, write_html, &failure))
        return done;
    *error = failure;
    return false;
}

static void write_frames_csv(const void *trade, FILE *out)
{
    tl_trade_write_csv(trade, out);
}

static void write_frames_html(const void *trade, FILE *out)
{
    tl_trade_write_html(trade, out);
}

static bool trade_frames(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                         tl_error *error)
{
    struct tl_headless headless;
    if (!tl_trade_headless(experiment, arguments, &headless, error))
        return false;
    struct tl_trade trade;
    bool done = tl_trade_measure(experiment, arguments, &headless, &trade, error);
    if (trade.row_count)
        done = write_both(arguments->output, &trade, write_frames_csv, write_frames_html, done, error);
    tl_trade_release(&trade);
    tl_headless_release(&headless);
    return done;
}

static void write_cloth_csv(const void *trade, FILE *out)
{
    tl_trade_cloth_write_csv(trade, out);
}

static void write_cloth_html(const void *trade, FILE *out)
{
    tl_trade_cloth_write_html(trade, out);
}

static void write_fit_csv(const void *fit, FILE *out)
{
    tl_trade_fit_write_csv(fit, out);
}

static bool trade_cloth(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_trade_cloth trade;
    bool done = tl_trade_cloth(arguments->quick, &trade, error);
    if (trade.row_count)
        done = write_both(arguments->output, &trade, write_cloth_csv, write_cloth_html, done, error);
    if (trade.fit.row_count && done)
        done = tl_folder_print(arguments->output, "fit.csv", &trade.fit, write_fit_csv, error);
    tl_trade_cloth_release(&trade);
    return done;
}

bool tl_command_trade(const struct tl_arguments *arguments, tl_error *error)
{
    const char *name = arguments->axis ? arguments->axis : "overall";
    bool cloth = strcmp(name, "cloth") == 0;
    const struct tl_experiment *experiment = tl_experiment_find(TL_OUTPUT_PAGE, name);
    if (!experiment && !cloth)
        return tl_fail(
            error, TL_USAGE,
            "--axis: \"%s\": expected overall, light, resolution, detail, shading, levels or cloth", name);
    if (cloth && arguments->positional_count)
        return tl_fail(error, TL_USAGE, "trade: %s: the axis cloth measures sheets of its own: name no scene",
                       arguments->positionals[0]);
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "trade: no folder named: add -o FOLDER");
    return tl_folder_make(arguments->output, error) &&
           (cloth ? trade_cloth(arguments, error) : trade_frames(experiment, arguments, error));
}
