#include "tests/app/faults/shader_faults.h"

#include "tests/app/faults/fault.h"

char *tl_fault_in_shader(const char *file, char *text)
{
    for (const struct shader_fault *fault = shader_faults; text && fault->name; fault++) {
        if (strcmp(fault->file, file) != 0 || !tl_fault_is(fault->name))
            continue;
        char *place = strstr(text, fault->from);
        size_t from = strlen(fault->from), to = strlen(fault->to), size = strlen(text);
        char *faulty = place ? malloc(size - from + to + 1) : NULL;
        if (!faulty)
            abort();
        size_t before = (size_t)(place - text);
        memcpy(faulty, text, before);
        memcpy(faulty + before, fault->to, to);
        memcpy(faulty + before + to, place + from, size - before - from + 1);
        free(text);
        text = faulty;
    }
    return text;
}
