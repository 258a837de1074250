#include "app/scene/playback.h"

#include "assets/motion/point_cache.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>

struct tl_playback {
    const tl_model *model;
    tl_point_cache *cache; /* NULL: a clip of `moving` plays */
    vec3s *points;         /* [point_count] */
    tl_model moving;
    int clip;
};

static bool check_count(const tl_playback *playback, const char *name, tl_error *error)
{
    size_t wanted =
        playback->cache ? tl_model_point_count(playback->model) : playback->model->mesh.vertex_count;
    size_t found = playback->cache ? tl_point_cache_facts(playback->cache)->point_count
                                   : playback->moving.mesh.vertex_count;
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

static bool plays_clips(const char *name)
{
    return tl_path_has_extension(name, "glb") || tl_path_has_extension(name, "gltf");
}

static bool open_clip(const struct tl_settings *settings, tl_playback *playback, tl_error *error)
{
    const struct tl_scene_params *scene = &settings->scene;
    if (!tl_model_load_in(scene->motion, (enum tl_units)scene->units, &playback->moving, error))
        return false;
    int named = tl_model_find_clip(&playback->moving, scene->clip);
    playback->clip = named >= 0 ? named : 0;
    return playback->moving.clip_count > 0 ||
           tl_fail(error, TL_INPUT,
                   "%s: has no animation that could move the garment: leave scene.motion out", scene->motion);
}

static bool open_cache(const struct tl_settings *settings, tl_playback *playback, tl_error *error)
{
    const char *name = settings->scene.motion;
    playback->cache = tl_point_cache_open(name, tl_units_metres(playback->model->units.units), error);
    if (!playback->cache)
        return false;
    playback->points = TL_NEW_ARRAY(vec3s, tl_point_cache_facts(playback->cache)->point_count);
    log_missing_frames(playback, name);
    return true;
}

tl_playback *tl_playback_open(const struct tl_settings *settings, const tl_model *model, tl_error *error)
{
    const char *name = settings->scene.motion;
    tl_playback *playback = TL_NEW(tl_playback);
    playback->model = model;
    bool opened =
        plays_clips(name) ? open_clip(settings, playback, error) : open_cache(settings, playback, error);
    if (!opened || !check_count(playback, name, error))
        tl_playback_close(&playback);
    return playback;
}

void tl_playback_close(tl_playback **handle)
{
    tl_playback *playback = *handle;
    if (!playback)
        return;
    tl_point_cache_destroy(&playback->cache);
    tl_model_release(&playback->moving);
    free(playback->points);
    free(playback);
    *handle = NULL;
}

double tl_playback_length_s(const tl_playback *playback, const struct tl_settings *settings)
{
    if (!playback->cache)
        return playback->moving.clips[playback->clip].duration_s;
    const struct tl_point_cache_facts *facts = tl_point_cache_facts(playback->cache);
    double own_rate = (double)settings->scene.motion_rate;
    if (facts->in_seconds)
        return own_rate > 0 ? (double)(facts->sample_count - 1) / own_rate : facts->last - facts->first;
    return (facts->last - facts->first) / (own_rate > 0 ? own_rate : settings->cloth.frame_rate);
}

float tl_playback_lowest(const tl_playback *playback)
{
    if (playback->cache)
        return tl_point_cache_facts(playback->cache)->box.lower.y;
    size_t count = playback->moving.mesh.vertex_count;
    vec3s *start = TL_NEW_ARRAY(vec3s, count);
    tl_model_pose(&playback->moving, playback->clip, 0, start);
    float lowest = tl_box_of(start, count).lower.y;
    free(start);
    return lowest;
}

bool tl_playback_pose(tl_playback *playback, const struct tl_settings *settings, int number, vec3s *positions,
                      tl_error *error)
{
    double frame_rate = settings->cloth.frame_rate;
    if (!playback->cache) {
        tl_model_pose(&playback->moving, playback->clip, number / frame_rate, positions);
        return true;
    }
    double position = tl_point_cache_position(playback->cache, number / frame_rate, frame_rate,
                                              (double)settings->scene.motion_rate);
    if (!tl_point_cache_read(playback->cache, position, playback->points, error))
        return false;
    const tl_model *model = playback->model;
    for (size_t i = 0; i < model->mesh.vertex_count; i++)
        positions[i] = playback->points[model->points ? model->points[i] : i];
    return true;
}
