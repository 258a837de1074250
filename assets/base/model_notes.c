#include "assets/base/model_build.h"
#include "config/base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A damaged file may have a note for each of its bytes. */
#define MAX_NOTES 200

static void note(char ***list, size_t *count, const char *format, va_list arguments)
{
    if (*count == MAX_NOTES)
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

void model_unread(tl_model *model, const char *file, bool is_absent, const char *reason)
{
    model_ignore(model, "%s", reason);
    for (size_t i = 0; i < model->unread_count; i++)
        if (strcmp(model->unread[i].reason, reason) == 0)
            return;
    if (model->unread_count == MAX_NOTES)
        return;
    model->unread = tl_resize(model->unread, model->unread_count + 1, sizeof *model->unread);
    model->unread[model->unread_count++] =
        (struct tl_unread){tl_copy_string(file), tl_copy_string(reason), is_absent};
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
