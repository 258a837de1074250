#include "assets/base/model_build.h"
#include "config/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void note(char ***list, size_t *count, const char *format, va_list arguments)
{
    const size_t most = 200; /* a damaged file may have a note for each of its bytes */
    if (*count == most)
        return;
    char text[256];
    vsnprintf(text, sizeof text, format, arguments);
    for (size_t i = 0; i < *count; i++)
        if (strcmp((*list)[i], text) == 0)
            return;
    *list = tl_resize(*list, *count + 1, sizeof **list);
    (*list)[(*count)++] = tl_copy_string(text);
}

void model_ignore(tl_model *model, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(&model->ignored, &model->ignored_count, format, arguments);
    va_end(arguments);
}

void model_approximate(tl_model *model, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(&model->approximated, &model->approximated_count, format, arguments);
    va_end(arguments);
}

void model_defect(tl_model *model, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note(&model->defects, &model->defect_count, format, arguments);
    va_end(arguments);
}
