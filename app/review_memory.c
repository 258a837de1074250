/* How much memory the review window holds. What frames free stays in the heap for those to come (main.c), but
 * the heap falls into ever more pieces between which little fits, above all when scenes, levels and
 * comparisons come and go. Its free pages go back to the system when much has gathered and nobody waits for
 * an image. */
#include "app/review.h"
#include "config/log.h"

#include <malloc.h>
#include <stdio.h>
#include <unistd.h>

/* How much may gather. Images in motion throw some 80 MB about, and to give that back at once would cost the
 * next ones more than it frees; where nobody waits, the first image to come is all that pays. */
#define GATHERED_IN_MOTION ((size_t)128 << 20)
#define GATHERED_AT_REST   ((size_t)32 << 20)
#define LOOK_EVERY_S       1.0

size_t tl_review_resident_bytes(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%*u %lu", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
}

static bool is_awaited(const struct tl_review *review)
{
    return tl_review_is_moving(review) || review->loader || !tl_review_is_sharp(review) ||
           !tl_review_is_at_rest(review);
}

void tl_review_give_back(struct tl_review *review)
{
    struct tl_review_memory *memory = &review->memory;
    double now_s = tl_clock_s();
    if (now_s - memory->looked_s < LOOK_EVERY_S)
        return;
    memory->looked_s = now_s;
    size_t free_bytes = mallinfo2().fordblks;
    memory->least_free = free_bytes < memory->least_free ? free_bytes : memory->least_free;
    if (free_bytes - memory->least_free < (is_awaited(review) ? GATHERED_IN_MOTION : GATHERED_AT_REST))
        return;
    size_t before = tl_review_resident_bytes();
    malloc_trim(0);
    memory->least_free = free_bytes; /* still free, but not here any more */
    tl_debug("view: memory: %zu MB, %zu MB after what is free was given back in %.0f ms", before >> 20,
             tl_review_resident_bytes() >> 20, 1e3 * (tl_clock_s() - now_s));
}
