#include "app/report/report.h"

#include "config/embedded.h"

#include <stdint.h>

extern const struct tl_embedded tl_embedded_report[]; /* report.css */

void tl_report_begin(FILE *out, const char *title, const char *subtitle)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>",
          out);
    tl_html_print(out, title);
    fprintf(out, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<h1>", tl_embedded_report[0].data);
    tl_html_print(out, title);
    fputs("</h1>\n<p class=\"subtitle\">", out);
    tl_html_print(out, subtitle);
    fputs("</p>\n", out);
}

void tl_report_end(FILE *out)
{
    fputs("</body>\n</html>\n", out);
}

static void print_element(FILE *out, const char *element, const char *text)
{
    fprintf(out, "<%s>", element);
    tl_html_print(out, text);
    fprintf(out, "</%s>\n", element);
}

void tl_report_heading(FILE *out, const char *text)
{
    print_element(out, "h2", text);
}

void tl_report_paragraph(FILE *out, const char *text)
{
    print_element(out, "p", text);
}

void tl_report_table(FILE *out, const char *const *cells, size_t rows, size_t columns)
{
    fputs("<div class=\"scroll\"><table>\n<thead>\n", out);
    for (size_t row = 0; row < rows; row++) {
        fputs("<tr>", out);
        for (size_t column = 0; column < columns; column++)
            print_element(out, row == 0 || column == 0 ? "th" : "td", cells[row * columns + column]);
        fputs(row == 0 ? "</tr>\n</thead>\n<tbody>\n" : "</tr>\n", out);
    }
    fputs(rows ? "</tbody>\n</table></div>\n" : "</thead>\n</table></div>\n", out);
}

void tl_report_tiles(FILE *out, const char *const *cells, size_t count)
{
    fputs("<ul class=\"tiles\">\n", out);
    for (size_t i = 0; i < count; i++) {
        fputs("<li>", out);
        print_element(out, "b", cells[2 * i]);
        tl_html_print(out, cells[2 * i + 1]);
        fputs("</li>\n", out);
    }
    fputs("</ul>\n", out);
}

void tl_report_fold_begin(FILE *out, const char *title)
{
    fputs("<details>", out);
    print_element(out, "summary", title);
}

void tl_report_fold_end(FILE *out)
{
    fputs("</details>\n", out);
}

void tl_report_plot_with(FILE *out, const struct tl_plot *plot, const struct tl_plot_options *options,
                         const char *caption)
{
    fputs("<figure>\n", out);
    tl_plot_print(out, plot, options);
    print_element(out, "figcaption", caption);
    fputs("</figure>\n", out);
}

void tl_report_plot(FILE *out, const struct tl_plot *plot, const char *caption)
{
    tl_report_plot_with(out, plot, &(const struct tl_plot_options){0}, caption);
}

static void print_base64(FILE *out, const uint8_t *bytes, size_t size)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i < 3 ? size - i : 3;
        unsigned bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (k < left ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            fputc(k <= left ? letters[bits >> (18 - 6 * k) & 63] : '=', out);
    }
}

void tl_report_pictures_begin(FILE *out)
{
    fputs("<div class=\"pictures\">\n", out);
}

static void begin_picture(FILE *out, const char *name)
{
    fputs("<figure><img alt=\"", out);
    tl_html_print(out, name);
    fputs("\" src=\"", out);
}

static void end_picture(FILE *out, const char *name, const char *caption)
{
    fputs("\"/><figcaption><b>", out);
    tl_html_print(out, name);
    fputs("</b>", out);
    tl_html_print(out, caption);
    fputs("</figcaption></figure>\n", out);
}

void tl_report_picture(FILE *out, const void *png, size_t size, const char *name, const char *caption)
{
    begin_picture(out, name);
    fputs("data:image/png;base64,", out);
    print_base64(out, png, size);
    end_picture(out, name, caption);
}

void tl_report_picture_file(FILE *out, const char *file, const char *name, const char *caption)
{
    begin_picture(out, name);
    tl_html_print(out, file);
    end_picture(out, name, caption);
}

void tl_report_pictures_end(FILE *out)
{
    fputs("</div>\n", out);
}

void tl_report_wide_picture(FILE *out, const struct tl_report_file *file, const char *name,
                            const char *caption)
{
    fputs("<figure class=\"wide\"><a href=\"", out);
    tl_html_print(out, file->name);
    fprintf(out, "\"><img loading=\"lazy\" width=\"%d\" height=\"%d\" alt=\"", file->width, file->height);
    tl_html_print(out, name);
    fputs("\" src=\"", out);
    tl_html_print(out, file->name);
    fputs("\"/></a><figcaption><b>", out);
    tl_html_print(out, name);
    fputs("</b>", out);
    tl_html_print(out, caption);
    fputs("</figcaption></figure>\n", out);
}
