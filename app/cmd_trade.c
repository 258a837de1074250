/* toile trade: error against time along an axis, as CSV and as a report. */
#include "app/commands.h"
#include "app/folder.h"
#include "app/topic.h"
#include "app/trade_cloth.h"
#include "app/trade_light.h"
#include "config/file.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Interrupted, what was measured is worth as much as before: `done` says whether all was. */
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

static void write_light_csv(const void *trade, FILE *out)
{
    tl_trade_write_csv(trade, out);
}

static void write_light_html(const void *trade, FILE *out)
{
    tl_trade_write_html(trade, out);
}

static bool trade_light(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_arguments scene = *arguments;
    tl_topic_default_scene(&scene, "review");
    struct tl_stage stage;
    if (!tl_stage_create(&stage, &scene, error))
        return false;
    struct tl_trade trade;
    bool done = tl_trade_light(&stage, arguments->quick, &trade, error);
    if (trade.row_count)
        done = write_both(arguments->output, &trade, write_light_csv, write_light_html, done, error);
    tl_trade_release(&trade);
    tl_stage_release(&stage);
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

static bool trade_cloth(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count)
        return tl_fail(error, TL_USAGE, "trade: %s: the axis cloth measures sheets of its own: name no scene",
                       arguments->positionals[0]);
    struct tl_trade_cloth trade;
    bool done = tl_trade_cloth(arguments->quick, &trade, error);
    if (trade.row_count)
        done = write_both(arguments->output, &trade, write_cloth_csv, write_cloth_html, done, error);
    tl_trade_cloth_release(&trade);
    return done;
}

bool tl_command_trade(const struct tl_arguments *arguments, tl_error *error)
{
    const char *axis = arguments->axis ? arguments->axis : "light";
    bool light = strcmp(axis, "light") == 0;
    if (!light && strcmp(axis, "cloth") != 0)
        return tl_fail(error, TL_USAGE, "--axis: \"%s\": expected light or cloth", axis);
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "trade: no folder named: add -o FOLDER");
    return tl_folder_make(arguments->output, error) &&
           (light ? trade_light(arguments, error) : trade_cloth(arguments, error));
}
