/* How the solvers' loops are divided among threads. Every element is computed by one thread, with the same
 * operations whichever thread it is, so that results do not depend on the number of threads. */
#ifndef TOILE_CLOTH_MESH_THREADS_H
#define TOILE_CLOTH_MESH_THREADS_H

#include <omp.h>
#include <stddef.h>

/* Cloth with fewer vertices is simulated by one thread: a substep of 10,000 vertices takes 0.3 ms, and a
 * barrier after each colour and pass would cost more than further threads save. */
#define TL_PARALLEL_VERTICES 30000

struct tl_range {
    size_t from, to;
};

/* The calling thread's range of `count` elements, in whole multiples of `unit`. */
static inline struct tl_range tl_thread_range(size_t count, size_t unit)
{
    size_t units = (count + unit - 1) / unit;
    size_t thread = (size_t)omp_get_thread_num(), threads = (size_t)omp_get_num_threads();
    size_t from = thread * units / threads * unit, to = (thread + 1) * units / threads * unit;
    return (struct tl_range){from < count ? from : count, to < count ? to : count};
}

#endif
