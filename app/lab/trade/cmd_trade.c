/* toile trade: error against time along an axis, as CSV and as a report. */
#include "app/lab/cloth/trade_cloth.h"
#include "app/lab/experiments/experiments.h"
#include "app/lab/trade/commands.h"
#include "app/lab/trade/trade.h"
#include "app/report/folder.h"
#include "config/base/file.h"

#include <stdlib.h>
#include <string.h>

static void write_frames_csv(const void *trade, FILE *out)
{
    tl_trade_write_csv(trade, out);
}

/* Results that were measured before an interruption are valid and are written. */
static bool trade_frames(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                         tl_error *error)
{
    const struct tl_trade_options options = {.quick = arguments->quick};
    struct tl_headless headless;
    if (!tl_trade_headless(experiment, arguments, &options, &headless, error))
        return false;
    struct tl_trade trade;
    tl_error failure = {0};
    const char *folder = arguments->output;
    bool done = tl_trade_measure(experiment, arguments, &options, &headless, &trade, error);
    if (trade.row_count && !(tl_folder_print(folder, "trade.csv", &trade, write_frames_csv, &failure) &&
                             tl_trade_write_report(&trade, folder, &failure))) {
        *error = failure;
        done = false;
    }
    tl_trade_release(&trade);
    tl_headless_release(&headless);
    return done;
}

static void write_cloth_csv(const void *trade, FILE *out)
{
    tl_trade_cloth_write_csv(trade, out);
}

static void write_fit_csv(const void *fit, FILE *out)
{
    tl_trade_fit_write_csv(fit, out);
}

static bool write_cloth(const char *folder, const struct tl_trade_cloth *trade, tl_error *error)
{
    return tl_folder_print(folder, "trade.csv", trade, write_cloth_csv, error) &&
           (!trade->fit.row_count || tl_folder_print(folder, "fit.csv", &trade->fit, write_fit_csv, error)) &&
           tl_trade_cloth_write_report(trade, folder, error);
}

static bool trade_cloth(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_trade_cloth trade;
    tl_error failure = {0};
    bool done = tl_trade_cloth(arguments->quick, &trade, error);
    if (trade.row_count && !write_cloth(arguments->output, &trade, &failure)) {
        *error = failure;
        done = false;
    }
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
