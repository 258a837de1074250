#include "config/base/error.h"

#include "config/base/interrupt.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void tl_clean_line(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c; c++) {
        size_t more = *c < 0x80 ? 0 : *c >= 0xf0 && *c < 0xf8 ? 3 : *c >= 0xe0 ? 2 : 1, found = 0;
        while (found < more && (c[found + 1] & 0xc0) == 0x80)
            found++;
        bool sequence = *c >= 0xc2 && *c < 0xf8 && found == more;
        bool second_set = *c == 0xc2 && c[1] < 0xa0;
        if (*c < ' ' || *c == 0x7f || (*c >= 0x80 && (!sequence || second_set)))
            *c = '?';
        else
            c += more;
    }
}

bool tl_fail(tl_error *error, enum tl_code code, const char *format, ...)
{
    if (!error)
        return false;
    error->code = code;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    tl_clean_line(error->message); /* names inside broken files may hold anything */
    return false;
}

int tl_exit_status(enum tl_code code)
{
    switch (code) {
    case TL_OK:
        return 0;
    case TL_UNSTABLE:
        return 1;
    case TL_INTERRUPTED:
        return 130;
    case TL_USAGE:
    case TL_INPUT:
    case TL_OUTPUT:
    case TL_DEVICE:
        break;
    }
    return 2;
}

void tl_end_program(const char *format, ...)
{
    char text[160] = "toile: ";
    size_t start = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + start, sizeof text - start - 1, format, arguments);
    va_end(arguments);
    strcat(text, "\n");
    (void)!write(STDERR_FILENO, text, strlen(text)); /* stdio might allocate */
    tl_interrupt_remove_guarded();
    _exit(tl_exit_status(TL_DEVICE));
}
