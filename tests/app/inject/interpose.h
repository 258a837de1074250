/* What the parts of the preloaded library share: what it reports when the program ends. */
#ifndef TOILE_TESTS_APP_INJECT_INTERPOSE_H
#define TOILE_TESTS_APP_INJECT_INTERPOSE_H

struct inject_account {
    long calls, bad, first_bad;
    const char *problem; /* of the first bad one; NULL: none */
};
extern struct inject_account inject_account;

/* The number in a variable of the environment; -1: it is not set. */
long inject_number(const char *variable);

#endif
