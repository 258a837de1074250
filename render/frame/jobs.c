#include "render/frame/jobs.h"

#include "render/frame/job_io.h"

/* The bits of a job's list (job_io.h) that it reads, and those that it writes. */
#define EMIT_READ(field, member, read, written)    (read) |
#define EMIT_WRITTEN(field, member, read, written) (written) |
#define READ(kind, ...)                            TL_IO_##kind(EMIT_READ, __VA_ARGS__)
#define WRITTEN(kind, ...)                         TL_IO_##kind(EMIT_WRITTEN, __VA_ARGS__)

/* The wiring: what the job's fields point to. */
#define WIRE_CONST(member)   .member = tl_resource_##member(all),
#define WIRE_MUTABLE(member) WIRE_CONST(member)
#define WIRE_NONE(bit)
#define EMIT_WIRE(field, member, read, written) WIRE_##field(member)
#define WIRE(kind, ...)                         TL_IO_##kind(EMIT_WIRE, __VA_ARGS__)

#define RUN(name, facts, what)                                                                               \
    static bool run_##name(void *context, int level, tl_error *error)                                        \
    {                                                                                                        \
        struct tl_resources *all = context;                                                                  \
        const struct tl_##name##_job job = {TL_JOB_##name(WIRE)};                                            \
        (void)level;                                                                                         \
        return tl_run_##name(&job, error);                                                                   \
    }
TL_JOBS(RUN)

#define ROW(job, facts, text)                                                                                \
    {.name = #job,                                                                                           \
     .what = (text),                                                                                         \
     .reads = TL_JOB_##job(READ) 0,                                                                          \
     .writes = TL_JOB_##job(WRITTEN) 0,                                                                      \
     .requires_scene = (facts),                                                                              \
     .levels = {"only"},                                                                                     \
     .run = run_##job},
const tl_job tl_frame_jobs[] = {TL_JOBS(ROW)};
const int tl_frame_job_count = TL_JOB_COUNT;
