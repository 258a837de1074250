/* Switches faults on in toile_faults, the program with every fault of faults.txt in it. Threads: any. */
#ifndef TOILE_TESTS_APP_FAULTS_FAULT_H
#define TOILE_TESTS_APP_FAULTS_FAULT_H

#include <stdlib.h>
#include <string.h>

static inline int tl_fault_is(const char *name)
{
    const char *wanted = getenv("TOILE_FAULT");
    return wanted && strcmp(wanted, name) == 0;
}

/* Whether the environment's TOILE_FAULT is `name`, a constant. Asked once a place: some are in loops over
 * pixels. */
#define TL_FAULT(name)                                                                                       \
    ({                                                                                                       \
        static int fault_is_on = -1;                                                                         \
        int fault_on = __atomic_load_n(&fault_is_on, __ATOMIC_RELAXED);                                      \
        if (fault_on < 0) {                                                                                  \
            fault_on = tl_fault_is(name);                                                                    \
            __atomic_store_n(&fault_is_on, fault_on, __ATOMIC_RELAXED);                                      \
        }                                                                                                    \
        fault_on;                                                                                            \
    })

/* The text of a shader file with the fault in it that is switched on; takes `text` over. */
char *tl_fault_in_shader(const char *file, char *text);

#endif
