/* FOLDER/frames.csv: written, and read again for a replay or a comparison. Columns are found by their names,
 * so that a file of another version is read as far as it goes. */
#include "app/lab/flight/fly.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT_CSV_BYTES ((size_t)256 << 20)
#define COLUMNS_MAX     128

/* Columns of one number each, in addition to frame, warm_up, image_hash, level_CONTROL, job_NAME_ms. */
static const struct {
    const char *name;
    size_t offset;
    const char *format;
} numbers[] = {
    {"total_ms", offsetof(struct tl_flight_frame, total_ms), "%.4f"},
    {"cpu_ms", offsetof(struct tl_flight_frame, cpu_ms), "%.4f"},
    {"load", offsetof(struct tl_flight_frame, load), "%.2f"},
    {"cloth_ms", offsetof(struct tl_flight_frame, cloth_ms), "%.4f"},
    {"predicted_ms", offsetof(struct tl_flight_frame, predicted_ms), "%.4f"},
    {"error_estimate", offsetof(struct tl_flight_frame, error), "%.6g"},
    {"garment_flip", offsetof(struct tl_flight_frame, garment_flip), "%.6g"},
    {"garment_flip_worst", offsetof(struct tl_flight_frame, garment_flip_worst), "%.6g"},
    {"covered_flip", offsetof(struct tl_flight_frame, flip_mean), "%.6g"},
    {"relative_rmse", offsetof(struct tl_flight_frame, rel_rmse), "%.6g"},
};

static bool ever_ran(const struct tl_flight *flight, int job)
{
    for (int i = 0; i < flight->count; i++)
        if (flight->frames[i].job_ms[job] > 0)
            return true;
    return false;
}

static void write_heads(const struct tl_flight *flight, FILE *out)
{
    fputs("frame,warm_up", out);
    for (size_t i = 0; i < TL_COUNT(numbers); i++)
        fprintf(out, ",%s", numbers[i].name);
    fputs(",memory_bytes", out);
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        fprintf(out, ",level_%s", tl_control_names[control]);
    for (int job = 0; job < flight->job_count; job++)
        if (ever_ran(flight, job))
            fprintf(out, ",job_%s_ms", flight->job_names[job]);
    fputs(",image_hash\n", out);
}

void tl_flight_write_csv(const struct tl_flight *flight, FILE *out)
{
    write_heads(flight, out);
    for (int i = 0; i < flight->count; i++) {
        const struct tl_flight_frame *frame = &flight->frames[i];
        fprintf(out, "%d,%d", i, i < flight->warm_up);
        for (size_t k = 0; k < TL_COUNT(numbers); k++) {
            double value;
            memcpy(&value, (const char *)frame + numbers[k].offset, sizeof value);
            fputc(',', out);
            if (isfinite(value))
                fprintf(out, numbers[k].format, value);
        }
        fprintf(out, ",%zu", frame->memory_bytes);
        for (int control = 0; control < TL_CONTROL_COUNT; control++)
            fprintf(out, ",%d", frame->levels.of[control]);
        for (int job = 0; job < flight->job_count; job++)
            if (ever_ran(flight, job))
                fprintf(out, ",%.4f", frame->job_ms[job]);
        if (frame->hash)
            fprintf(out, ",%016" PRIx64 "\n", frame->hash);
        else
            fputs(",\n", out);
    }
}

/* -- reading -- */

enum column { UNKNOWN, FRAME, WARM_UP, MEMORY, HASH, NUMBER, LEVEL, JOB };

struct table {
    const char *file;
    int line;
    struct {
        enum column kind;
        int index;
    } columns[COLUMNS_MAX];
    int column_count;
    tl_error *error;
};

static bool fail(const struct table *table, const char *what)
{
    return tl_fail(table->error, TL_INPUT, "%s:%d: %s: this is not what `toile fly` writes", table->file,
                   table->line, what);
}

/* The next line, without its end; NULL after the last. */
static char *next_line(char **rest)
{
    char *line = *rest;
    if (!line || !*line)
        return NULL;
    char *end = strchr(line, '\n');
    *rest = end ? end + 1 : NULL;
    if (end) {
        *end = '\0';
        if (end > line && end[-1] == '\r')
            end[-1] = '\0';
    }
    return line;
}

static void know_column(struct table *table, const char *name, struct tl_flight *flight)
{
    static const struct {
        const char *name;
        enum column kind;
    } plain[] = {{"frame", FRAME}, {"warm_up", WARM_UP}, {"memory_bytes", MEMORY}, {"image_hash", HASH}};
    enum column kind = UNKNOWN;
    int index = 0;
    size_t length = strlen(name);
    for (size_t i = 0; i < TL_COUNT(plain); i++)
        if (strcmp(name, plain[i].name) == 0)
            kind = plain[i].kind;
    for (size_t i = 0; i < TL_COUNT(numbers); i++)
        if (strcmp(name, numbers[i].name) == 0)
            kind = NUMBER, index = (int)i;
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        if (strncmp(name, "level_", 6) == 0 && strcmp(name + 6, tl_control_names[control]) == 0)
            kind = LEVEL, index = control;
    bool is_job = strncmp(name, "job_", 4) == 0 && length > 7 && strcmp(name + length - 3, "_ms") == 0;
    if (is_job && flight->job_count < TL_JOBS_MAX) {
        kind = JOB, index = flight->job_count++;
        snprintf(flight->job_names[index], TL_JOB_NAME_BYTES, "%.*s", (int)(length - 7), name + 4);
    }
    table->columns[table->column_count].kind = kind;
    table->columns[table->column_count++].index = index;
}

static bool has_column(const struct table *table, enum column kind, int index)
{
    for (int i = 0; i < table->column_count; i++)
        if (table->columns[i].kind == kind && table->columns[i].index == index)
            return true;
    return false;
}

static bool read_heads(struct table *table, char *line, struct tl_flight *flight)
{
    for (char *cell; (cell = strsep(&line, ","));) {
        if (table->column_count == COLUMNS_MAX)
            return fail(table, "has too many columns");
        know_column(table, cell, flight);
    }
    if (!has_column(table, FRAME, 0) || !has_column(table, NUMBER, 0))
        return fail(table, "has no columns frame and total_ms");
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        if (!has_column(table, LEVEL, control))
            return fail(table, "lacks a column of levels");
    return true;
}

static bool read_cell(struct table *table, int column, const char *cell, struct tl_flight *flight,
                      struct tl_flight_frame *frame)
{
    enum column kind = table->columns[column].kind;
    int index = table->columns[column].index;
    char *end = NULL;
    double value = cell[0] ? strtod(cell, &end) : (double)NAN;
    if (kind == HASH) {
        frame->hash = cell[0] ? strtoull(cell, &end, 16) : 0;
        return !cell[0] || !*end || fail(table, "image_hash is no hexadecimal number");
    }
    if (kind == UNKNOWN)
        return true;
    bool empty = !cell[0], whole = kind != NUMBER && kind != JOB;
    if (empty ? kind != NUMBER : *end || !isfinite(value) || value < 0)
        return fail(table, "a cell is no number from 0");
    if (whole && value > (kind == LEVEL ? UINT8_MAX : 9e15))
        return fail(table, "a cell is too large");
    if (kind == FRAME && value != flight->count)
        return fail(table, "frames do not follow each other");
    if (kind == WARM_UP && value > 0)
        flight->warm_up = flight->count + 1;
    if (kind == MEMORY)
        frame->memory_bytes = (size_t)value;
    if (kind == NUMBER)
        memcpy((char *)frame + numbers[index].offset, &value, sizeof value);
    if (kind == LEVEL)
        frame->levels.of[index] = (uint8_t)value;
    if (kind == JOB)
        frame->job_ms[index] = value;
    return true;
}

static bool read_frame(struct table *table, char *line, struct tl_flight *flight)
{
    flight->frames = tl_resize(flight->frames, (size_t)flight->count + 1, sizeof *flight->frames);
    struct tl_flight_frame *frame = &flight->frames[flight->count];
    *frame = (struct tl_flight_frame)TL_FLIGHT_FRAME_EMPTY;
    int column = 0;
    for (char *cell; (cell = strsep(&line, ",")); column++)
        if (column == table->column_count || !read_cell(table, column, cell, flight, frame))
            return column < table->column_count ? false : fail(table, "has more cells than heads");
    if (column < table->column_count)
        return fail(table, "has fewer cells than heads");
    if (!tl_quality_is_valid(&frame->levels))
        return fail(table, "there is no such level");
    flight->count++;
    return true;
}

bool tl_flight_read_csv(const char *file, struct tl_flight *out, tl_error *error)
{
    struct tl_flight flight = {0};
    struct table table = {.file = file, .line = 1, .error = error};
    char *data = NULL;
    size_t size = 0;
    if (!tl_file_read_small(file, LIMIT_CSV_BYTES, &data, &size, error))
        return false;
    bool read = strlen(data) == size || fail(&table, "holds a zero byte");
    char *rest = data, *line = next_line(&rest);
    read = read && (line ? read_heads(&table, line, &flight) : fail(&table, "has no heads"));
    while (read && (line = next_line(&rest))) {
        table.line++;
        read = read_frame(&table, line, &flight);
    }
    if (read && flight.count == 0)
        read = fail(&table, "holds no frame");
    free(data);
    flight.planned = flight.count;
    if (read)
        *out = flight;
    else
        tl_flight_release(&flight);
    return read;
}
