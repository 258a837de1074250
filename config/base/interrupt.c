#include "config/base/interrupt.h"

#include <limits.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define GUARDS 16

static atomic_llong first_ns; /* when the first signal came; 0: none has */
static _Thread_local const atomic_bool *thread_flag;
/* Fixed storage, so that the handler needs nothing but unlink and _exit, which are async-signal-safe. */
static char guarded[GUARDS][PATH_MAX];

void tl_interrupt_remove_guarded(void)
{
    for (int i = 0; i < GUARDS; i++)
        if (guarded[i][0])
            unlink(guarded[i]);
}

static void on_signal(int number)
{
    (void)number;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    long long now_ns = now.tv_sec * 1000000000LL + now.tv_nsec, seen_ns = 0;
    if (atomic_compare_exchange_strong(&first_ns, &seen_ns, now_ns) ||
        now_ns - seen_ns < TL_INTERRUPT_TWICE_MS * 1000000LL)
        return;
    tl_interrupt_remove_guarded();
    _exit(130);
}

void tl_interrupt_install(void)
{
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction hang_up;
    if (sigaction(SIGHUP, NULL, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) /* nohup ignores it */
        sigaction(SIGHUP, &action, NULL);
}

bool tl_interrupted(void)
{
    return atomic_load(&first_ns) != 0 || (thread_flag && atomic_load(thread_flag));
}

void tl_interrupt_by(const atomic_bool *flag)
{
    thread_flag = flag;
}

void tl_interrupt_guard(const char *temporary)
{
    for (int i = 0; i < GUARDS; i++)
        if (!guarded[i][0] && strlen(temporary) < PATH_MAX) {
            strcpy(guarded[i], temporary);
            return;
        }
}

void tl_interrupt_unguard(const char *temporary)
{
    for (int i = 0; i < GUARDS; i++)
        if (strcmp(guarded[i], temporary) == 0)
            guarded[i][0] = '\0';
}
