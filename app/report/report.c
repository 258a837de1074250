#include "app/report/report.h"

#include "app/report/folder.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern const struct tl_embedded tl_embedded_report[]; /* page.html and what it encloses */

struct page {
    const char *script;
    const cJSON *data;
};

/* "</script>" and "<!--" would end the element or change how it is read: no "<" is left in the text. */
static void print_data(const cJSON *data, FILE *out)
{
    char *text = cJSON_PrintUnformatted(data);
    for (const char *at = text; *at; at++)
        if (*at == '<')
            fputs("\\u003c", out);
        else
            fputc(*at, out);
    cJSON_free(text);
}

static void print_part(const struct page *page, const char *name, FILE *out)
{
    if (strcmp(name, "data") == 0)
        print_data(page->data, out);
    else if (strcmp(name, "report") == 0)
        fputs(page->script, out);
    else
        fputs(tl_embedded_find(tl_embedded_report, name)->data, out);
}

/* Prints page.html with each {{NAME}} replaced: by the data, the report's script, or the file of that name.
 */
static void print_page(const void *what, FILE *out)
{
    const char *at = tl_embedded_find(tl_embedded_report, "page.html")->data, *mark;
    while ((mark = strstr(at, "{{"))) {
        const char *end = strstr(mark, "}}");
        char *name = tl_format("%.*s", (int)(end - mark - 2), mark + 2);
        fprintf(out, "%.*s", (int)(mark - at), at);
        print_part(what, name, out);
        free(name);
        at = end + 2;
    }
    fputs(at, out);
}

bool tl_report_write(const char *folder, const char *file, const char *script, cJSON *data, tl_error *error)
{
    const struct page page = {script, data};
    bool written = tl_folder_print(folder, file, &page, print_page, error);
    cJSON_Delete(data);
    return written;
}

void tl_report_add_text(cJSON *object, const char *key, const void *what,
                        void (*write)(const void *what, FILE *out))
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    write(what, out);
    fclose(out);
    cJSON_AddStringToObject(object, key, text);
    free(text);
}

void tl_report_add_texts(cJSON *object, const char *key, char *const *texts, size_t count)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (size_t i = 0; i < count; i++)
        cJSON_AddItemToArray(array, cJSON_CreateString(texts[i]));
}

cJSON *tl_report_png(const void *png, size_t size)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static const char start[] = "data:image/png;base64,";
    const uint8_t *bytes = png;
    char *text = tl_alloc(sizeof start + 4 * (size / 3 + 1), 1), *to = text + strlen(start);
    memcpy(text, start, sizeof start);
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i < 3 ? size - i : 3;
        unsigned bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (k < left ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            *to++ = k <= left ? letters[bits >> (18 - 6 * k) & 63] : '=';
    }
    *to = 0;
    cJSON *string = cJSON_CreateString(text);
    free(text);
    return string;
}

/* ---- Figures ---- */

cJSON *tl_report_add_plot(cJSON *figures, const struct tl_report_plot *plot)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "x_label", plot->x_label);
    cJSON_AddStringToObject(object, "y_label", plot->y_label);
    cJSON_AddBoolToObject(object, "x_log", plot->x_log);
    cJSON_AddBoolToObject(object, "y_log", plot->y_log);
    cJSON_AddStringToObject(object, "caption", plot->caption);
    cJSON_AddItemToArray(figures, object);
    return cJSON_AddArrayToObject(object, "series");
}

cJSON *tl_report_add_series(cJSON *series, const char *name, bool is_front)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", name);
    cJSON_AddBoolToObject(object, "line", !is_front);
    cJSON_AddBoolToObject(object, "front", is_front);
    cJSON_AddItemToArray(series, object);
    return cJSON_AddArrayToObject(object, "points");
}

void tl_report_add_point(cJSON *points, double x, double y)
{
    cJSON_AddItemToArray(points, cJSON_CreateDoubleArray((const double[]){x, y}, 2));
}

cJSON *tl_report_add_table(cJSON *figures, const struct tl_report_column *columns, int count)
{
    cJSON *object = cJSON_CreateObject(), *heads = cJSON_AddArrayToObject(object, "columns");
    for (int i = 0; i < count; i++) {
        cJSON *column = cJSON_CreateObject();
        cJSON_AddStringToObject(column, "head", columns[i].head);
        cJSON_AddNumberToObject(column, "digits", columns[i].digits);
        cJSON_AddItemToArray(heads, column);
    }
    cJSON_AddItemToArray(figures, object);
    return cJSON_AddArrayToObject(object, "rows");
}

void tl_report_add_row(cJSON *rows, const char *name, const double *values, int count)
{
    cJSON *row = cJSON_CreateArray();
    cJSON_AddItemToArray(row, cJSON_CreateString(name));
    for (int i = 0; i < count; i++)
        cJSON_AddItemToArray(row, cJSON_CreateNumber(values[i]));
    cJSON_AddItemToArray(rows, row);
}
