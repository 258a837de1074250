/* The process's memory. Frames leave freed memory in the heap for those to come (main.c); the heap fragments
 * while scenes, levels and comparisons come and go, so that ever more of it is resident but unused. Its free
 * pages are returned to the system when there are many of them. Owns `memory`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_MEMORY_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_MEMORY_H

#include <stddef.h>

struct tl_review;

struct tl_review_memory {
    size_t min_unused; /* bytes: the minimum since memory was last returned to the system */
    double checked_s, logged_s;
};

size_t tl_review_resident_bytes(void); /* of this process */
/* Returns unused pages to the system when there are many; called every frame, checks once a second. */
void tl_review_trim_memory(struct tl_review *review);

#endif
