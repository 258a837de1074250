#include "config/error.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>

bool tl_fail(tl_error *error, enum tl_code code, const char *format, ...)
{
    if (!error)
        return false;
    error->code = code;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    /* Names inside broken files may hold anything; a message stays one printable line. */
    for (char *c = error->message; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
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
