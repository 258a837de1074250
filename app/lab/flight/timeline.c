#include "app/lab/flight/timeline.h"

#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>

#include <dirent.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define THREADS_MAX  512
#define INTERVAL_S   0.001
#define SEARCH_EVERY 16 /* intervals between two searches for new threads */
#define BUSY_SHARE   0.5
#define JOBS_ROW     1 /* no thread has this number but the system's first */

struct traced_thread {
    long thread;
    double cpu_s;  /* of its clock, when last read */
    double busy_s; /* since when it is busy; 0: it is not */
};

struct tl_timeline {
    struct tl_writer writer;
    pthread_mutex_t writing;
    bool has_event;
    double began_s;

    pthread_t reader;
    pthread_mutex_t ending;
    pthread_cond_t ended;
    bool ends;
    struct traced_thread watched[THREADS_MAX]; /* the reader's */
    size_t count;
};

/* -- the file -- */

static void write_event(tl_timeline *trace, cJSON *event)
{
    char *text = cJSON_PrintUnformatted(event);
    pthread_mutex_lock(&trace->writing);
    fprintf(trace->writer.stream, "%s\n%s", trace->has_event ? "," : "", text);
    trace->has_event = true;
    pthread_mutex_unlock(&trace->writing);
    cJSON_free(text);
    cJSON_Delete(event);
}

static cJSON *new_event(const char *name, const char *kind, long row)
{
    cJSON *event = cJSON_CreateObject();
    cJSON_AddStringToObject(event, "name", name);
    cJSON_AddStringToObject(event, "ph", kind);
    cJSON_AddNumberToObject(event, "pid", (double)getpid());
    cJSON_AddNumberToObject(event, "tid", (double)row);
    return event;
}

static void name_row(tl_timeline *trace, long row, const char *name)
{
    cJSON *event = new_event("thread_name", "M", row);
    cJSON_AddStringToObject(cJSON_AddObjectToObject(event, "args"), "name", name);
    write_event(trace, event);
}

static void add_to_row(tl_timeline *trace, long row, const char *name, double began_s, double ms)
{
    cJSON *event = new_event(name, "X", row);
    cJSON_AddNumberToObject(event, "ts", 1e6 * (began_s - trace->began_s));
    cJSON_AddNumberToObject(event, "dur", 1e3 * ms);
    write_event(trace, event);
}

/* -- the threads' clocks -- */

/* Returns false when the thread has ended. The clock's number is Linux's for the time of one thread, which
 * pthread_getcpuclockid makes of it, too, for threads that one has a handle of. */
static bool read_clock(long thread, double *seconds)
{
    struct timespec used;
    if (clock_gettime((clockid_t)(~(unsigned)thread << 3 | 6), &used))
        return false;
    *seconds = (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
    return true;
}

static void name_thread(tl_timeline *trace, long thread)
{
    char *path = tl_format("/proc/self/task/%ld/comm", thread);
    char name[32] = "";
    FILE *file = fopen(path, "r");
    if (!file || !fgets(name, sizeof name, file))
        name[0] = '\0';
    if (file)
        fclose(file);
    name[strcspn(name, "\n")] = '\0';
    name_row(trace, thread, thread == (long)getpid() ? "main thread" : name);
    free(path);
}

static bool is_watched(const tl_timeline *trace, long thread)
{
    for (size_t i = 0; i < trace->count; i++)
        if (trace->watched[i].thread == thread)
            return true;
    return false;
}

static void find_threads(tl_timeline *trace)
{
    DIR *folder = opendir("/proc/self/task");
    for (struct dirent *entry; folder && (entry = readdir(folder)) != NULL;) {
        struct traced_thread found = {.thread = strtol(entry->d_name, NULL, 10)};
        if (found.thread <= 0 || found.thread == syscall(SYS_gettid) || trace->count == THREADS_MAX ||
            is_watched(trace, found.thread) || !read_clock(found.thread, &found.cpu_s))
            continue;
        name_thread(trace, found.thread);
        trace->watched[trace->count++] = found;
    }
    if (folder)
        closedir(folder);
}

static void end_busy(tl_timeline *trace, struct traced_thread *watched, double now_s)
{
    if (watched->busy_s > 0)
        add_to_row(trace, watched->thread, "busy", watched->busy_s, 1e3 * (now_s - watched->busy_s));
    watched->busy_s = 0;
}

static void read_clocks(tl_timeline *trace, double before_s, double now_s)
{
    for (size_t i = 0; i < trace->count;) {
        struct traced_thread *watched = &trace->watched[i];
        double cpu_s;
        if (!read_clock(watched->thread, &cpu_s)) {
            end_busy(trace, watched, before_s);
            *watched = trace->watched[--trace->count];
            continue;
        }
        if (cpu_s - watched->cpu_s < BUSY_SHARE * (now_s - before_s))
            end_busy(trace, watched, before_s);
        else if (!(watched->busy_s > 0))
            watched->busy_s = before_s;
        watched->cpu_s = cpu_s;
        i++;
    }
}

/* Waits for an interval; false when the trace ends. */
static bool wait_interval(tl_timeline *trace)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)(1e9 * INTERVAL_S);
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_mutex_lock(&trace->ending);
    if (!trace->ends)
        pthread_cond_timedwait(&trace->ended, &trace->ending, &until);
    bool goes_on = !trace->ends;
    pthread_mutex_unlock(&trace->ending);
    return goes_on;
}

static void *watch_threads(void *argument)
{
    tl_timeline *trace = argument;
    double before_s = tl_clock_s();
    find_threads(trace);
    for (unsigned i = 1; wait_interval(trace); i++) {
        const double now_s = tl_clock_s();
        read_clocks(trace, before_s, now_s);
        if (i % SEARCH_EVERY == 0)
            find_threads(trace);
        before_s = now_s;
    }
    for (size_t i = 0; i < trace->count; i++)
        end_busy(trace, &trace->watched[i], before_s);
    return NULL;
}

/* Starts the reader with all signals blocked: Ctrl-C is the main thread's. */
static bool start_reader(tl_timeline *trace)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    bool started = pthread_create(&trace->reader, NULL, watch_threads, trace) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

/* -- the trace -- */

tl_timeline *tl_timeline_begin(const char *path, tl_error *error)
{
    tl_timeline *trace = TL_NEW(tl_timeline);
    if (!tl_writer_begin(&trace->writer, path, error)) {
        free(trace);
        return NULL;
    }
    trace->began_s = tl_clock_s();
    pthread_mutex_init(&trace->writing, NULL);
    pthread_mutex_init(&trace->ending, NULL);
    pthread_cond_init(&trace->ended, NULL);
    fputs("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[", trace->writer.stream);
    name_row(trace, JOBS_ROW, "frames and their jobs");
    if (start_reader(trace))
        return trace;
    tl_writer_abandon(&trace->writer);
    free(trace);
    tl_fail(error, TL_OUTPUT, "%s: no thread can be started that reads the clocks: end other programs", path);
    return NULL;
}

void tl_timeline_add(tl_timeline *trace, const char *name, double began_s, double ms)
{
    add_to_row(trace, JOBS_ROW, name, began_s, ms);
}

void tl_timeline_add_plan(tl_timeline *trace, const tl_plan *plan)
{
    for (int i = 0; i < plan->count; i++)
        if (plan->rows[i].action == TL_JOB_RUN)
            tl_timeline_add(trace, plan->rows[i].name, plan->rows[i].began_s, plan->rows[i].took_ms);
}

static void join_reader(tl_timeline *trace)
{
    pthread_mutex_lock(&trace->ending);
    trace->ends = true;
    pthread_cond_signal(&trace->ended);
    pthread_mutex_unlock(&trace->ending);
    pthread_join(trace->reader, NULL);
    pthread_cond_destroy(&trace->ended);
    pthread_mutex_destroy(&trace->ending);
    pthread_mutex_destroy(&trace->writing);
}

bool tl_timeline_commit(tl_timeline **handle, tl_error *error)
{
    tl_timeline *trace = *handle;
    if (!trace)
        return true;
    join_reader(trace);
    fputs("\n]}\n", trace->writer.stream);
    bool written = tl_writer_commit(&trace->writer, error);
    free(trace);
    *handle = NULL;
    return written;
}

void tl_timeline_abandon(tl_timeline **handle)
{
    if (!*handle)
        return;
    join_reader(*handle);
    tl_writer_abandon(&(*handle)->writer);
    free(*handle);
    *handle = NULL;
}
