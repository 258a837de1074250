#include "assets/motion/point_cache.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct tl_point_cache_writer {
    struct tl_writer file;
    size_t point_count;
    bool big_endian;
};

/* The stream remembers a failure until the commit. */
static void put_word(tl_point_cache_writer *writer, uint32_t word)
{
    uint8_t bytes[4];
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(word >> 8 * (writer->big_endian ? 3 - i : i));
    fwrite(bytes, 1, sizeof bytes, writer->file.stream);
}

static void put_float(tl_point_cache_writer *writer, float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(writer, word);
}

tl_point_cache_writer *tl_point_cache_create(const char *path, size_t point_count, size_t sample_count,
                                             double first_frame, double frame_rate, tl_error *error)
{
    tl_point_cache_writer *writer = TL_NEW(tl_point_cache_writer);
    writer->point_count = point_count;
    writer->big_endian = tl_path_has_extension(path, "mdd");
    if (!tl_writer_begin(&writer->file, path, error)) {
        free(writer);
        return NULL;
    }
    if (writer->big_endian) {
        put_word(writer, (uint32_t)sample_count);
        put_word(writer, (uint32_t)point_count);
        for (size_t i = 0; i < sample_count; i++)
            put_float(writer, (float)((first_frame + (double)i) / frame_rate));
        return writer;
    }
    fwrite("POINTCACHE2", 1, 12, writer->file.stream);
    put_word(writer, 1);
    put_word(writer, (uint32_t)point_count);
    put_float(writer, (float)first_frame);
    put_float(writer, 1); /* a sample a frame */
    put_word(writer, (uint32_t)sample_count);
    return writer;
}

void tl_point_cache_add(tl_point_cache_writer *writer, const vec3s *points)
{
    for (size_t i = 0; i < writer->point_count; i++)
        for (int c = 0; c < 3; c++)
            put_float(writer, points[i].raw[c]);
}

bool tl_point_cache_commit(tl_point_cache_writer **handle, tl_error *error)
{
    bool committed = tl_writer_commit(&(*handle)->file, error);
    free(*handle);
    *handle = NULL;
    return committed;
}

void tl_point_cache_abandon(tl_point_cache_writer **handle)
{
    if (!*handle)
        return;
    tl_writer_abandon(&(*handle)->file);
    free(*handle);
    *handle = NULL;
}
