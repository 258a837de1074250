/* A team of threads for the solvers' loops. Every element is computed by one thread, with the same operations
 * whichever thread it is, so that results do not depend on the number of threads.
 *
 * Why not OpenMP: a substep of 3000 vertices takes 0.15 ms and has many barriers. OpenMP's either sleep,
 * and waking takes longer than the work between two of them, or spin, and then two processes that share the
 * cores wait for each other's turns: a dress that settles in 2 s alone settled in 27 s beside another. These
 * spin for a moment and then yield the core: alone they cost what spinning costs, and beside another process
 * hardly more than their share of the cores. Where that is not enough, as beside a process that does not
 * yield, the caller works alone for a while. Between works, threads of the team sleep.
 *
 * Threads: one caller has the team at a time; another one that comes meanwhile does its work alone, and so
 * does one that is itself at work in a team or in a parallel region of OpenMP. Errors: none; where a thread
 * cannot be made, the team is smaller. */
#ifndef TOILE_CLOTH_MESH_TEAM_H
#define TOILE_CLOTH_MESH_TEAM_H

#include <stddef.h>

struct tl_range {
    size_t from, to;
};

/* The team has one thread for so many vertices, and at most as many as OpenMP would have (OMP_NUM_THREADS):
 * with fewer vertices each, barriers cost more than a further thread saves. */
#define TL_VERTICES_PER_THREAD 500

/* Calls work(context) on all threads of the team at once, the caller's included, with denormals off; returns
 * when all have returned. The context is borrowed until then. */
void tl_team_run(size_t vertex_count, void (*work)(void *context), void *context);

/* Within work: waits until all threads of the team have come here. */
void tl_team_barrier(void);

/* Within work: the calling thread's number in the team, from 0; 0 outside. */
size_t tl_team_thread(void);

/* Within work: the calling thread's range of `count` elements, in whole multiples of `unit`; outside: all. */
struct tl_range tl_team_range(size_t count, size_t unit);

/* The number of threads that tl_team_run may take for so many vertices. */
size_t tl_team_size(size_t vertex_count);

#endif
