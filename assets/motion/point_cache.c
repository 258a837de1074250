#include "assets/motion/point_cache_internal.h"

#include "assets/motion/sequence.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool tl_point_cache_is_file(const char *name)
{
    return tl_path_has_extension(name, "pc2") || tl_path_has_extension(name, "mdd") ||
           (tl_path_has_extension(name, "obj") && tl_sequence_is_pattern(name));
}

static bool open_format(tl_point_cache *cache, tl_error *error)
{
    if (tl_path_has_extension(cache->name, "pc2"))
        return point_cache_open_pc2(cache, error);
    if (tl_path_has_extension(cache->name, "mdd"))
        return point_cache_open_mdd(cache, error);
    if (tl_path_has_extension(cache->name, "obj"))
        return point_cache_open_sequence(cache, error);
    return tl_fail(error, TL_INPUT, "%s: is no motion: expected .pc2, .mdd or OBJ files as frame.####.obj",
                   cache->name);
}

/* The interval between samples when it is constant, else 0. */
static double even_step(const double *moments, size_t count)
{
    double step = count > 1 ? moments[count - 1] / (double)(count - 1) : 0;
    for (size_t i = 0; i < count; i++)
        if (fabs(moments[i] - (double)i * step) > 1e-3 * step)
            return 0;
    return step;
}

/* Reads a sample in metres; refuses points that are not finite or more than 100 km away. */
static bool fetch(tl_point_cache *cache, size_t index, vec3s *points, tl_error *error)
{
    const float farthest_m = 1e5f; /* as for models */
    if (!(cache->numbers ? point_cache_read_frame : point_cache_read_file)(cache, index, points, error))
        return false;
    for (size_t i = 0; i < cache->facts.point_count; i++) {
        points[i] = glms_vec3_scale(points[i], cache->metres);
        if (!(glms_vec3_norm(points[i]) <= farthest_m))
            return tl_fail(error, TL_INPUT,
                           "%s: sample %zu: point %zu lies more than 100 km away or is not finite: write it "
                           "again, or check its units",
                           cache->name, index, i);
    }
    return true;
}

/* Reads every sample once, so that damage is found when the file is opened, and for the box. One sample is in
 * memory at a time. */
static bool scan(tl_point_cache *cache, tl_error *error)
{
    size_t count = cache->facts.point_count;
    vec3s *points = TL_NEW_ARRAY(vec3s, count);
    struct tl_box *box = &cache->facts.box;
    *box = (struct tl_box){{{FLT_MAX, FLT_MAX, FLT_MAX}}, {{-FLT_MAX, -FLT_MAX, -FLT_MAX}}};
    bool good = true;
    for (size_t i = 0; good && i < cache->facts.sample_count; i++) {
        good = fetch(cache, i, points, error);
        struct tl_box sample = tl_box_of(points, count);
        box->lower = glms_vec3_minv(box->lower, sample.lower);
        box->upper = glms_vec3_maxv(box->upper, sample.upper);
    }
    free(points);
    return good;
}

tl_point_cache *tl_point_cache_open(const char *name, double metres, tl_error *error)
{
    tl_point_cache *cache = TL_NEW(tl_point_cache);
    cache->name = tl_copy_string(name);
    cache->metres = (float)metres;
    cache->held[0] = cache->held[1] = SIZE_MAX;
    /* The frames of an OBJ sequence are checked one by one as they are read. */
    if (!open_format(cache, error) || (cache->stream && !scan(cache, error))) {
        tl_point_cache_destroy(&cache);
        return NULL;
    }
    cache->facts.step = even_step(cache->moments, cache->facts.sample_count);
    return cache;
}

void tl_point_cache_destroy(tl_point_cache **handle)
{
    tl_point_cache *cache = *handle;
    if (!cache)
        return;
    if (cache->stream)
        fclose(cache->stream);
    free(cache->points[0]);
    free(cache->points[1]);
    free(cache->numbers);
    free(cache->moments);
    free(cache->name);
    free(cache);
    *handle = NULL;
}

const struct tl_point_cache_facts *tl_point_cache_facts(const tl_point_cache *cache)
{
    return &cache->facts;
}

/* Frame times come from inexact products: rounds 59.9999999 to 60. */
static double tidy(double position)
{
    double whole = nearbyint(position);
    return fabs(position - whole) < 1e-6 ? whole : position;
}

double tl_point_cache_position(const tl_point_cache *cache, double time_s, double frame_rate, double own_rate)
{
    size_t count = cache->facts.sample_count;
    double last = (double)(count - 1);
    bool in_seconds = cache->facts.in_seconds;
    if (in_seconds && own_rate > 0)
        return tidy(fmin(fmax(time_s * own_rate, 0), last));
    double moment = in_seconds ? time_s : time_s * (own_rate > 0 ? own_rate : frame_rate);
    if (!(moment > 0))
        return 0;
    if (moment >= cache->moments[count - 1])
        return last;
    size_t low = 0, high = count - 1; /* moments[low] <= moment < moments[high] */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(cache->moments[middle] <= moment ? &low : &high) = middle;
    }
    double span = cache->moments[high] - cache->moments[low];
    return tidy((double)low + (moment - cache->moments[low]) / span);
}

/* Returns a sample from the two that are cached, reading it if needed; `keep` is not evicted. In playback
 * each sample is read once. */
static const vec3s *hold(tl_point_cache *cache, size_t index, size_t keep, tl_error *error)
{
    for (int i = 0; i < 2; i++)
        if (cache->held[i] == index)
            return cache->points[i];
    int slot = cache->held[0] == keep ? 1 : 0;
    if (!cache->points[slot])
        cache->points[slot] = TL_NEW_ARRAY(vec3s, cache->facts.point_count);
    cache->held[slot] = SIZE_MAX;
    if (!fetch(cache, index, cache->points[slot], error))
        return NULL;
    cache->held[slot] = index;
    return cache->points[slot];
}

bool tl_point_cache_read(tl_point_cache *cache, double position, vec3s *points, tl_error *error)
{
    size_t index = (size_t)position, count = cache->facts.point_count;
    float part = (float)(position - (double)index);
    const vec3s *from = hold(cache, index, index + 1, error);
    if (!from)
        return false;
    if (part == 0) {
        memcpy(points, from, count * sizeof *points);
        return true;
    }
    const vec3s *to = hold(cache, index + 1, index, error);
    if (!to)
        return false;
    for (size_t i = 0; i < count; i++)
        points[i] = glms_vec3_lerp(from[i], to[i], part);
    return true;
}
