#include "render/gpu/compute.h"

#include "config/base/memory.h"
#include "render/gpu/context.h"

#include <assert.h>

/* ---- Limits ---- */

static int query_limit(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

struct tl_compute_limits tl_compute_limits_query(void)
{
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    return (struct tl_compute_limits){.buffers = query_limit(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
                                      .bindings = query_limit(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS),
                                      .shared_bytes = query_limit(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE),
                                      .group_threads = query_limit(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
                                      .storage_bytes = (size_t)bytes};
}

bool tl_compute_limits_check(const struct tl_compute_limits *limits, tl_error *error)
{
    const struct {
        const char *name;
        int found, needed;
    } rows[] = {
        {"storage buffers of a program", limits->buffers, TL_STORAGE_BUFFERS},
        {"bindings of storage buffers", limits->bindings, TL_STORAGE_BINDINGS},
        {"bytes of shared memory", limits->shared_bytes, TL_GROUP_SHARED_BYTES},
        {"threads of a group", limits->group_threads, TL_GROUP_THREADS},
    };
    for (size_t i = 0; i < TL_COUNT(rows); i++)
        if (rows[i].found < rows[i].needed)
            return tl_fail(error, TL_DEVICE,
                           "OpenGL: %s: compute shaders have %d here and need %d: update the driver",
                           rows[i].name, rows[i].found, rows[i].needed);
    return true;
}

struct tl_compute_limits tl_gpu_compute_limits(const tl_gpu *gpu)
{
    return gpu->compute;
}

/* ---- Buffers ---- */

bool tl_buffer_reserve(tl_buffer *buffer, tl_gpu *gpu, size_t bytes, tl_error *error)
{
    assert(bytes > 0);
    if (buffer->id && bytes <= buffer->bytes)
        return true;
    if (bytes > gpu->compute.storage_bytes)
        return tl_fail(error, TL_DEVICE,
                       "OpenGL: a storage buffer of %zu MiB: the driver allows %zu: give smaller meshes or a "
                       "smaller image",
                       bytes >> 20, gpu->compute.storage_bytes >> 20);
    tl_buffer_destroy(buffer);
    *buffer = (tl_buffer){.gpu = gpu, .bytes = bytes};
    glCreateBuffers(1, &buffer->id);
    glNamedBufferStorage(buffer->id, (GLsizeiptr)bytes, NULL, GL_DYNAMIC_STORAGE_BIT);
    tl_buffer_clear(buffer);
    gpu->bytes += bytes;
    return true;
}

bool tl_buffer_fill(tl_buffer *buffer, tl_gpu *gpu, const void *data, size_t bytes, tl_error *error)
{
    if (!tl_buffer_reserve(buffer, gpu, bytes, error))
        return false;
    tl_buffer_write(buffer, 0, data, bytes);
    return true;
}

void tl_buffer_write(const tl_buffer *buffer, size_t offset, const void *data, size_t bytes)
{
    glNamedBufferSubData(buffer->id, (GLintptr)offset, (GLsizeiptr)bytes, data);
}

void tl_buffer_clear(const tl_buffer *buffer)
{
    glClearNamedBufferData(buffer->id, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, NULL);
}

void tl_buffer_read(const tl_buffer *buffer, size_t offset, void *data, size_t bytes)
{
    glGetNamedBufferSubData(buffer->id, (GLintptr)offset, (GLsizeiptr)bytes, data);
}

void tl_buffer_destroy(tl_buffer *buffer)
{
    if (buffer->id) {
        buffer->gpu->bytes -= buffer->bytes;
        glDeleteBuffers(1, &buffer->id);
    }
    *buffer = (tl_buffer){0};
}

/* ---- Dispatches ---- */

void tl_buffer_bind(const tl_buffer *buffer, unsigned binding)
{
    assert(buffer->id && binding < TL_STORAGE_BINDINGS);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer->id);
}

void tl_gpu_dispatch(unsigned x, unsigned y, unsigned z)
{
    if (x > 0 && y > 0 && z > 0)
        glDispatchCompute(x, y, z);
}

void tl_gpu_dispatch_indirect(const tl_buffer *buffer, size_t offset)
{
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer->id);
    glDispatchComputeIndirect((GLintptr)offset);
}

void tl_gpu_barrier(void)
{
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
}
