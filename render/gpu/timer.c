#include "render/gpu/timer.h"

#include "config/base/log.h"
#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <assert.h>
#include <stdlib.h>

#define FRAMES_MAX 4 /* that GL may be behind */

struct stamped {
    GLuint queries[TL_TIMER_MARKS_MAX + 1];
    struct tl_timer_times times;
};

struct tl_timer {
    bool waits;       /* the CPU's clock around finished work */
    double started_s; /* ... of the part at hand */
    struct stamped frames[FRAMES_MAX];
    uint64_t begun, taken; /* frames so far; those between them are kept */
};

static struct stamped *frame_at(tl_timer *timer, uint64_t number)
{
    return &timer->frames[number % FRAMES_MAX];
}

tl_timer *tl_timer_create(bool waits)
{
    tl_timer *timer = TL_NEW(tl_timer);
    timer->waits = waits;
    for (int i = 0; i < FRAMES_MAX && !timer->waits; i++)
        glCreateQueries(GL_TIMESTAMP, TL_TIMER_MARKS_MAX + 1, timer->frames[i].queries);
    return timer;
}

void tl_timer_destroy(tl_timer **timer)
{
    if (!*timer)
        return;
    for (int i = 0; i < FRAMES_MAX && !(*timer)->waits; i++)
        glDeleteQueries(TL_TIMER_MARKS_MAX + 1, (*timer)->frames[i].queries);
    free(*timer);
    *timer = NULL;
}

void tl_timer_begin(tl_timer *timer, uint64_t frame)
{
    struct stamped *now = frame_at(timer, timer->begun++);
    if (timer->begun - timer->taken > FRAMES_MAX)
        timer->taken++;
    now->times.frame = frame;
    now->times.count = 0;
    if (timer->waits) {
        glFinish();
        timer->started_s = tl_clock_s();
    } else {
        glQueryCounter(now->queries[0], GL_TIMESTAMP);
    }
}

void tl_timer_mark(tl_timer *timer, int part)
{
    assert(timer->begun > 0);
    struct stamped *now = frame_at(timer, timer->begun - 1);
    const int i = now->times.count++;
    assert(i < TL_TIMER_MARKS_MAX);
    now->times.marks[i].part = part;
    if (timer->waits) {
        glFinish();
        const double ended_s = tl_clock_s();
        now->times.marks[i].ms = 1000 * (ended_s - timer->started_s);
        timer->started_s = ended_s;
    } else {
        glQueryCounter(now->queries[i + 1], GL_TIMESTAMP);
    }
}

static void read_stamps(struct stamped *frame)
{
    GLuint64 before_ns, ns;
    glGetQueryObjectui64v(frame->queries[0], GL_QUERY_RESULT, &before_ns);
    for (int i = 0; i < frame->times.count; i++, before_ns = ns) {
        glGetQueryObjectui64v(frame->queries[i + 1], GL_QUERY_RESULT, &ns);
        frame->times.marks[i].ms = 1e-6 * (double)(ns - before_ns);
    }
}

bool tl_timer_take(tl_timer *timer, struct tl_timer_times *out)
{
    if (timer->taken == timer->begun)
        return false;
    struct stamped *frame = frame_at(timer, timer->taken);
    if (!timer->waits) {
        GLint is_done = GL_FALSE;
        glGetQueryObjectiv(frame->queries[frame->times.count], GL_QUERY_RESULT_AVAILABLE, &is_done);
        if (!is_done)
            return false;
        read_stamps(frame);
    }
    *out = frame->times;
    timer->taken++;
    return true;
}
