#include "app/scene/playback.h"

#include "assets/motion/point_cache.h"
#include "config/log.h"
#include "config/memory.h"

#include <stdlib.h>

struct tl_playback {
    const tl_model *model;
    tl_point_cache *cache;
    vec3s *points; /* [point_count] */
};

static bool check_count(const tl_playback *playback, const char *name, tl_error *error)
{
    size_t wanted = tl_model_point_count(playback->model);
    size_t found = tl_point_cache_facts(playback->cache)->point_count;
    if (found == wanted)
        return true;
    return tl_fail(error, TL_INPUT,
                   "%s: moves %zu points, but %s has %zu: choose the garment that it was made with", name,
                   found, playback->model->name, wanted);
}

static void log_missing_frames(const tl_playback *playback, const char *name)
{
    const struct tl_point_cache_facts *facts = tl_point_cache_facts(playback->cache);
    if (!facts->in_seconds && facts->step == 0 && facts->sample_count > 1)
        tl_info("%s: only %zu of the frames %g to %g exist: those between them are interpolated", name,
                facts->sample_count, facts->first, facts->last);
}

tl_playback *tl_playback_open(const struct tl_settings *settings, const tl_model *model, tl_error *error)
{
    const char *name = settings->scene.motion;
    tl_playback *playback = TL_NEW(tl_playback);
    playback->model = model;
    playback->cache = tl_point_cache_open(name, tl_units_metres(model->units.units), error);
    if (!playback->cache || !check_count(playback, name, error)) {
        tl_playback_close(&playback);
        return NULL;
    }
    playback->points = TL_NEW_ARRAY(vec3s, tl_model_point_count(model));
    log_missing_frames(playback, name);
    return playback;
}

void tl_playback_close(tl_playback **handle)
{
    tl_playback *playback = *handle;
    if (!playback)
        return;
    tl_point_cache_destroy(&playback->cache);
    free(playback->points);
    free(playback);
    *handle = NULL;
}

float tl_playback_lowest(const tl_playback *playback)
{
    return tl_point_cache_facts(playback->cache)->box.lower.y;
}

bool tl_playback_pose(tl_playback *playback, const struct tl_settings *settings, int number, vec3s *positions,
                      tl_error *error)
{
    double frame_rate = settings->cloth.frame_rate;
    double position = tl_point_cache_position(playback->cache, number / frame_rate, frame_rate,
                                              (double)settings->scene.motion_rate);
    if (!tl_point_cache_read(playback->cache, position, playback->points, error))
        return false;
    const tl_model *model = playback->model;
    for (size_t i = 0; i < model->mesh.vertex_count; i++)
        positions[i] = playback->points[model->points ? model->points[i] : i];
    return true;
}
