/* toile trade: error against time along an axis, as CSV and as a report. */
#include "app/commands.h"
#include "app/trade.h"
#include "config/file.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

static bool write_file(const char *folder, const char *name, const struct tl_trade *trade,
                       void (*write)(const struct tl_trade *, FILE *), tl_error *error)
{
    struct tl_writer writer;
    char *path = tl_format("%s/%s", folder, name);
    bool written = tl_writer_begin(&writer, path, error);
    if (written) {
        write(trade, writer.stream);
        written = tl_writer_commit(&writer, error);
    }
    free(path);
    return written;
}

static bool check(const struct tl_arguments *arguments, tl_error *error)
{
    const char *axis = arguments->axis ? arguments->axis : "light";
    if (strcmp(axis, "light") != 0)
        return tl_fail(error, TL_USAGE, "--axis: \"%s\": expected light", axis);
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "trade: no folder named: add -o FOLDER");
    return tl_folder_make(arguments->output, error);
}

bool tl_command_trade(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_arguments scene = *arguments;
    if (scene.positional_count == 0)
        scene.positionals[scene.positional_count++] = "review";
    struct tl_stage stage;
    if (!check(arguments, error) || !tl_stage_create(&stage, &scene, error))
        return false;
    struct tl_trade trade;
    bool done = tl_trade_light(&stage, arguments->quick, &trade, error);
    /* Interrupted, what was measured is worth as much as before. */
    tl_error write_error = {0};
    if (trade.row_count &&
        (!write_file(arguments->output, "trade.csv", &trade, tl_trade_write_csv, &write_error) ||
         !write_file(arguments->output, "report.html", &trade, tl_trade_write_html, &write_error))) {
        *error = write_error;
        done = false;
    }
    tl_trade_release(&trade);
    tl_stage_release(&stage);
    return done;
}
