#include "app/view/review/review_memory.h"

#include "app/view/review/review.h"
#include "app/view/review/review_draw.h"
#include "config/base/log.h"
#include "render/renderer.h"

#include <malloc.h>
#include <stdio.h>
#include <unistd.h>

/* Unused memory that is tolerated. Images in motion free some 80 MB that images at rest allocate again:
 * returning it at once would cost the following images more than it saves. At rest only the next image pays.
 */
#define UNUSED_MAX_IN_MOTION ((size_t)96 << 20)
#define UNUSED_MAX_AT_REST   ((size_t)32 << 20)
#define CHECK_EVERY_S        1.0
#define LOG_EVERY_S          10.0

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

static bool is_busy(const struct tl_review *review)
{
    return tl_review_is_moving(review) || review->load.loader || !tl_review_is_sharp(review) ||
           !tl_review_is_at_rest(review);
}

static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* Resident but not allocated: unused pages, and constant amounts for the program and for what drivers map. */
static size_t unused_bytes(void)
{
    size_t resident = tl_review_resident_bytes(), used = used_bytes();
    return resident > used ? resident - used : 0;
}

static size_t renderers_bytes(const struct tl_review *review)
{
    size_t bytes = tl_renderer_memory(review->renderer).total;
    return review->wipe.renderer ? bytes + tl_renderer_memory(review->wipe.renderer).total : bytes;
}

/* Logs used beside resident memory: a leak makes both grow, fragmentation only the latter. The renderers'
 * buffers are as large as their largest image so far, and are no leak. */
static void log_memory(struct tl_review *review, double now_s)
{
    if (now_s - review->memory.logged_s < LOG_EVERY_S)
        return;
    review->memory.logged_s = now_s;
    tl_debug("view: memory: %zu MB in use, %zu MB resident, %zu MB for images", used_bytes() >> 20,
             tl_review_resident_bytes() >> 20, renderers_bytes(review) >> 20);
}

void tl_review_trim_memory(struct tl_review *review)
{
    struct tl_review_memory *memory = &review->memory;
    double now_s = tl_clock_s();
    if (now_s - memory->checked_s < CHECK_EVERY_S)
        return;
    memory->checked_s = now_s;
    log_memory(review, now_s);
    size_t unused = unused_bytes(), unused_max = is_busy(review) ? UNUSED_MAX_IN_MOTION : UNUSED_MAX_AT_REST;
    if (memory->min_unused == 0 || unused < memory->min_unused)
        memory->min_unused = unused;
    if (unused - memory->min_unused < unused_max)
        return;
    malloc_trim(0);
    memory->min_unused = unused_bytes();
    tl_debug("view: memory: %zu MB of %zu MB unused returned to the system in %.0f ms",
             (unused - memory->min_unused) >> 20, unused >> 20, 1e3 * (tl_clock_s() - now_s));
}
