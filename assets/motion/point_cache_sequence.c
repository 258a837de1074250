/* OBJ sequences as point caches: the vertices of each file, at the frame given by its number. */
#include "assets/motion/point_cache_internal.h"

#include "assets/motion/sequence.h"
#include "assets/obj/wavefront.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static bool read_object(const tl_point_cache *cache, size_t index, struct wave_object *out, tl_error *error)
{
    char *path = tl_sequence_path(cache->name, cache->numbers[index]);
    bool read = wave_read(path, out, error);
    size_t count = cache->facts.point_count;
    if (read && out->position_count == 0)
        read = tl_fail(error, TL_INPUT, "%s: holds no vertices: write it again", path);
    else if (read && count > 0 && out->position_count != count)
        read = tl_fail(error, TL_INPUT, "%s: has %zu vertices, the first of its sequence %zu: write it again",
                       path, out->position_count, count);
    if (!read)
        wave_release(out);
    free(path);
    return read;
}

bool point_cache_open_sequence(tl_point_cache *cache, tl_error *error)
{
    size_t count;
    if (!tl_sequence_list(cache->name, &cache->numbers, &count, error))
        return false;
    struct wave_object first;
    if (!read_object(cache, 0, &first, error))
        return false;
    cache->moments = TL_NEW_ARRAY(double, count);
    for (size_t i = 0; i < count; i++)
        cache->moments[i] = cache->numbers[i] - cache->numbers[0];
    cache->facts = (struct tl_point_cache_facts){.format = "OBJ sequence",
                                                 .point_count = first.position_count,
                                                 .sample_count = count,
                                                 .first = cache->numbers[0],
                                                 .last = cache->numbers[count - 1],
                                                 .box = tl_box_of(first.positions, first.position_count)};
    cache->facts.box.lower = glms_vec3_scale(cache->facts.box.lower, cache->metres);
    cache->facts.box.upper = glms_vec3_scale(cache->facts.box.upper, cache->metres);
    wave_release(&first);
    return true;
}

bool point_cache_read_frame(tl_point_cache *cache, size_t index, vec3s *points, tl_error *error)
{
    struct wave_object object;
    if (!read_object(cache, index, &object, error))
        return false;
    memcpy(points, object.positions, cache->facts.point_count * sizeof *points);
    wave_release(&object);
    return true;
}
