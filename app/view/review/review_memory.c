#include "app/view/review/review_memory.h"

#include "app/view/review/review_draw.h"
#include "config/log.h"

#include <malloc.h>
#include <stdio.h>
#include <unistd.h>

/* How much may lie idle. Images in motion free some 80 MB that those at rest take again, and to give that
 * back at once would cost the next ones more than it frees; where nobody waits, the first image to come is
 * all that pays. */
#define IDLE_IN_MOTION ((size_t)96 << 20)
#define IDLE_AT_REST   ((size_t)32 << 20)
#define CHECK_EVERY_S  1.0
#define LOG_EVERY_S    10.0

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

static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* Resident, but not in use: idle pages, beside the program itself and what drivers map. */
static size_t unused_bytes(void)
{
    size_t resident = tl_review_resident_bytes(), used = used_bytes();
    return resident > used ? resident - used : 0;
}

/* What is in use tells a leak from pages that lie idle. */
static void tell(struct tl_review_memory *memory, double now_s)
{
    if (now_s - memory->logged_s < LOG_EVERY_S)
        return;
    memory->logged_s = now_s;
    tl_debug("view: memory: %zu MB in use, %zu MB resident", used_bytes() >> 20,
             tl_review_resident_bytes() >> 20);
}

void tl_review_trim_memory(struct tl_review *review)
{
    struct tl_review_memory *memory = &review->memory;
    double now_s = tl_clock_s();
    if (now_s - memory->checked_s < CHECK_EVERY_S)
        return;
    memory->checked_s = now_s;
    tell(memory, now_s);
    size_t unused = unused_bytes(), idle_max = is_awaited(review) ? IDLE_IN_MOTION : IDLE_AT_REST;
    if (memory->min_unused == 0 || unused < memory->min_unused)
        memory->min_unused = unused;
    if (unused - memory->min_unused < idle_max)
        return;
    malloc_trim(0);
    memory->min_unused = unused_bytes();
    tl_debug("view: memory: %zu MB of %zu MB unused given back in %.0f ms",
             (unused - memory->min_unused) >> 20, unused >> 20, 1e3 * (tl_clock_s() - now_s));
}
