/* PC2 and MDD files: a header, followed by samples of three floats per point. */
#include "assets/motion/point_cache_internal.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define PC2_HEADER_BYTES 32
#define MDD_HEADER_BYTES 8
#define POINT_BYTES      12

static uint32_t word_at(const uint8_t *bytes, bool big_endian)
{
    uint32_t word = 0;
    for (int i = 0; i < 4; i++)
        word |= (uint32_t)bytes[i] << 8 * (big_endian ? 3 - i : i);
    return word;
}

static float float_at(const uint8_t *bytes, bool big_endian)
{
    uint32_t word = word_at(bytes, big_endian);
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* Opens the file and reads its header; `size` is the file's. */
static bool open_file(tl_point_cache *cache, uint8_t *header, size_t header_bytes, uint64_t *size,
                      tl_error *error)
{
    struct stat status;
    if (!tl_file_check(cache->name, error))
        return false;
    cache->stream = fopen(cache->name, "rb");
    if (!cache->stream || fstat(fileno(cache->stream), &status) != 0)
        return tl_fail(error, TL_INPUT, "%s: %s: make it readable", cache->name, strerror(errno));
    *size = (uint64_t)status.st_size;
    if (fread(header, 1, header_bytes, cache->stream) != header_bytes)
        return tl_fail(error, TL_INPUT, "%s: is cut short: its header has %zu bytes: write it again",
                       cache->name, header_bytes);
    return true;
}

/* Checks the header's counts against the file's length, before anything is allocated. */
static bool check_counts(tl_point_cache *cache, uint32_t points, uint32_t samples, uint64_t bytes_a_sample,
                         uint64_t size, tl_error *error)
{
    if (points == 0 || points > TL_LIMIT_MESH_VERTICES || samples == 0 || samples > INT32_MAX)
        return tl_fail(error, TL_INPUT,
                       "%s: claims %d points and %d samples: at least 1 of each and at most %zu points can "
                       "be read: write it again",
                       cache->name, (int)points, (int)samples, TL_LIMIT_MESH_VERTICES);
    uint64_t wanted = cache->data_offset + samples * bytes_a_sample; /* below 2^60 */
    if (wanted != size)
        return tl_fail(error, TL_INPUT,
                       "%s: claims %u samples of %u points, %llu bytes, but has %llu: it is cut short or "
                       "damaged, write it again",
                       cache->name, samples, points, (unsigned long long)wanted, (unsigned long long)size);
    cache->facts.point_count = points;
    cache->facts.sample_count = samples;
    cache->moments = TL_NEW_ARRAY(double, samples);
    return true;
}

/* Offsets: 0 magic, 12 version, 16 points, 20 start, 24 rate (frames between samples), 28 samples. */
bool point_cache_open_pc2(tl_point_cache *cache, tl_error *error)
{
    uint8_t header[PC2_HEADER_BYTES];
    uint64_t size = 0;
    cache->data_offset = PC2_HEADER_BYTES;
    if (!open_file(cache, header, sizeof header, &size, error))
        return false;
    if (memcmp(header, "POINTCACHE2", 12) != 0 || word_at(header + 12, false) != 1)
        return tl_fail(error, TL_INPUT, "%s: is no PC2 of version 1: write it again", cache->name);
    uint32_t points = word_at(header + 16, false), samples = word_at(header + 28, false);
    double start = (double)float_at(header + 20, false), rate = (double)float_at(header + 24, false);
    if (!isfinite(start) || !isfinite(rate) || rate <= 0)
        return tl_fail(error, TL_INPUT,
                       "%s: starts at frame %g with %g frames from sample to sample: expected numbers, the "
                       "latter above 0: write it again",
                       cache->name, start, rate);
    if (!check_counts(cache, points, samples, (uint64_t)points * POINT_BYTES, size, error))
        return false;
    for (size_t i = 0; i < samples; i++)
        cache->moments[i] = (double)i * rate;
    cache->facts.format = "PC2";
    cache->facts.first = start;
    cache->facts.last = start + cache->moments[samples - 1];
    return true;
}

static bool read_times(tl_point_cache *cache, size_t count, tl_error *error)
{
    double first = 0, before = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        uint8_t bytes[4];
        if (fread(bytes, 1, sizeof bytes, cache->stream) != sizeof bytes)
            return tl_fail(error, TL_INPUT, "%s: its times cannot be read: check the disk", cache->name);
        double time_s = (double)float_at(bytes, true);
        if (!isfinite(time_s) || !(time_s > before))
            return tl_fail(error, TL_INPUT,
                           "%s: sample %zu is at %g s, after one at %g s: times must rise: write it again",
                           cache->name, i, time_s, before);
        first = i == 0 ? time_s : first;
        cache->moments[i] = time_s - first;
        before = time_s;
    }
    cache->facts.first = first;
    cache->facts.last = before;
    return true;
}

/* Offsets: 0 samples, 4 points, 8 times. There is no magic number: only its length identifies an MDD. */
bool point_cache_open_mdd(tl_point_cache *cache, tl_error *error)
{
    uint8_t header[MDD_HEADER_BYTES];
    uint64_t size = 0;
    if (!open_file(cache, header, sizeof header, &size, error))
        return false;
    uint32_t samples = word_at(header, true), points = word_at(header + 4, true);
    cache->big_endian = true;
    cache->facts.format = "MDD";
    cache->facts.in_seconds = true;
    cache->data_offset = MDD_HEADER_BYTES;
    if (!check_counts(cache, points, samples, 4 + (uint64_t)points * POINT_BYTES, size, error) ||
        !read_times(cache, samples, error))
        return false;
    cache->data_offset += 4 * (uint64_t)samples;
    return true;
}

bool point_cache_read_file(tl_point_cache *cache, size_t index, vec3s *points, tl_error *error)
{
    size_t count = cache->facts.point_count;
    uint64_t offset = cache->data_offset + (uint64_t)index * count * POINT_BYTES;
    /* Converted in place: each word replaces its own bytes. */
    uint8_t *bytes = (uint8_t *)points;
    if (fseeko(cache->stream, (off_t)offset, SEEK_SET) != 0 ||
        fread(bytes, POINT_BYTES, count, cache->stream) != count)
        return tl_fail(error, TL_INPUT, "%s: sample %zu cannot be read: the file has changed: open it again",
                       cache->name, index);
    for (size_t i = 0; i < 3 * count; i++) {
        uint32_t word = word_at(bytes + 4 * i, cache->big_endian);
        memcpy(bytes + 4 * i, &word, sizeof word);
    }
    return true;
}
