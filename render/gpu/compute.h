/* Compute shaders' resources: storage buffers, dispatches and what GL allows of them [OpenGL 4.5, 7.8, 19].
 * A compute program is a tl_program (gpu.h). One thread: that of the context. */
#ifndef TOILE_RENDER_GPU_COMPUTE_H
#define TOILE_RENDER_GPU_COMPUTE_H

#include "render/gpu/gpu.h"

/* Every program of the renderer keeps to these limits. */
#define TL_STORAGE_BUFFERS    16    /* of one program */
#define TL_STORAGE_BINDINGS   48    /* of all that are bound at a time */
#define TL_GROUP_SHARED_BYTES 32768 /* shared memory of a group */
#define TL_GROUP_THREADS      256

struct tl_compute_limits {
    int buffers;          /* storage buffers of a compute shader */
    int bindings;         /* ... that can be bound */
    int shared_bytes;     /* of a group */
    int group_threads;    /* of a group */
    size_t storage_bytes; /* of a buffer, as a shader sees it */
};
/* Asks the context that is current. */
struct tl_compute_limits tl_compute_limits_query(void);
/* Errors: TL_DEVICE, which names the first limit that is below what the renderer's programs need. */
bool tl_compute_limits_check(const struct tl_compute_limits *limits, tl_error *error);
struct tl_compute_limits tl_gpu_compute_limits(const tl_gpu *gpu);

/* A buffer that shaders read and write as an array. All zeros: none. */
typedef struct tl_buffer {
    tl_gpu *gpu;
    unsigned id; /* GL name; 0: none */
    size_t bytes;
} tl_buffer;

/* Makes a buffer hold at least `bytes`, which must not be 0. It keeps its content where it is large enough,
 * and holds zeros where it grows. Errors: TL_DEVICE if GL allows no buffer of that size. */
bool tl_buffer_reserve(tl_buffer *buffer, tl_gpu *gpu, size_t bytes, tl_error *error);
/* Reserves, and writes from the start. */
bool tl_buffer_fill(tl_buffer *buffer, tl_gpu *gpu, const void *data, size_t bytes, tl_error *error);
void tl_buffer_write(const tl_buffer *buffer, size_t offset, const void *data, size_t bytes);
void tl_buffer_clear(const tl_buffer *buffer); /* to zeros */
/* Waits for all work that was begun: for tests, and for what is asked for once. */
void tl_buffer_read(const tl_buffer *buffer, size_t offset, void *data, size_t bytes);
void tl_buffer_destroy(tl_buffer *buffer);

/* `binding`: as the shader declares it, below TL_STORAGE_BINDINGS. */
void tl_buffer_bind(const tl_buffer *buffer, unsigned binding);

/* Runs the program in use in so many groups; if one of the numbers is 0, not at all. */
void tl_gpu_dispatch(unsigned x, unsigned y, unsigned z);
/* ... with the three numbers that stand at `offset` (bytes, a multiple of 4) of a buffer. */
void tl_gpu_dispatch_indirect(const tl_buffer *buffer, size_t offset);
/* The groups of `size` threads that so many threads need. */
static inline unsigned tl_gpu_groups(size_t threads, size_t size)
{
    return (unsigned)((threads + size - 1) / size);
}
/* Work that is begun afterwards sees all that shaders have written before. */
void tl_gpu_barrier(void);

#endif
