#include "assets/base/rig.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void rig_destroy(tl_rig **handle)
{
    tl_rig *rig = *handle;
    if (!rig)
        return;
    for (size_t i = 0; i < rig->channel_count; i++) {
        free(rig->channels[i].times_s);
        free(rig->channels[i].values);
    }
    free(rig->nodes);
    free(rig->order);
    free(rig->slots);
    free(rig->local);
    free(rig->influences);
    free(rig->channels);
    free(rig->clips);
    free(rig);
    *handle = NULL;
}

/* ---- Posing ---- */

/* Spherical interpolation along the shorter arc. */
static void slerp(const float *a, const float *b, float part, float *out)
{
    versors from = {{a[0], a[1], a[2], a[3]}}, to = {{b[0], b[1], b[2], b[3]}};
    versors between = glms_quat_slerp(glms_quat_normalize(from), glms_quat_normalize(to), part);
    memcpy(out, between.raw, sizeof between.raw);
}

/* glTF 2.0, appendix C: Hermite spline; key = in-tangent, value, out-tangent. */
static void hermite(const float *key, const float *next, float part, float span_s, int components, float *out)
{
    float t2 = part * part, t3 = t2 * part;
    for (int i = 0; i < components; i++) {
        float value = key[components + i], leaving = span_s * key[2 * components + i];
        float next_value = next[components + i], arriving = span_s * next[i];
        out[i] = (2 * t3 - 3 * t2 + 1) * value + (t3 - 2 * t2 + part) * leaving +
                 (-2 * t3 + 3 * t2) * next_value + (t3 - t2) * arriving;
    }
}

static void evaluate(const struct rig_channel *channel, float time_s, float out[4])
{
    int components = rig_components(channel->path);
    bool cubic = channel->interpolation == RIG_CUBIC_SPLINE;
    size_t stride = (size_t)components * (cubic ? 3 : 1), key = 0;
    while (key + 1 < channel->key_count && channel->times_s[key + 1] <= time_s)
        key++;
    const float *here = channel->values + key * stride, *next = here + stride;
    bool held = key + 1 == channel->key_count || time_s <= channel->times_s[key] ||
                channel->interpolation == RIG_STEP;
    float span_s = held ? 0 : channel->times_s[key + 1] - channel->times_s[key];
    float part = held ? 0 : (time_s - channel->times_s[key]) / span_s;
    if (held)
        memcpy(out, here + (cubic ? components : 0), (size_t)components * sizeof *out);
    else if (cubic)
        hermite(here, next, part, span_s, components, out);
    else if (channel->path == RIG_ROTATION)
        slerp(here, next, part, out);
    else
        for (int i = 0; i < components; i++)
            out[i] = here[i] + part * (next[i] - here[i]);
}

static void apply_channel(const struct rig_channel *channel, float time_s, struct rig_transform *transform)
{
    float value[4];
    evaluate(channel, time_s, value);
    if (channel->path == RIG_ROTATION)
        transform->rotation = glms_quat_normalize((versors){{value[0], value[1], value[2], value[3]}});
    else if (channel->path == RIG_TRANSLATION)
        memcpy(&transform->translation, value, sizeof transform->translation);
    else
        memcpy(&transform->scale, value, sizeof transform->scale);
}

static mat4s matrix_of(const struct rig_transform *transform)
{
    mat4s rotation = glms_quat_mat4(transform->rotation);
    return glms_mat4_mul(glms_translate_make(transform->translation),
                         glms_mat4_mul(rotation, glms_scale_make(transform->scale)));
}

void rig_world(const tl_rig *rig, int clip, double time_s, mat4s *world)
{
    struct rig_transform *locals = TL_NEW_ARRAY(struct rig_transform, rig->node_count);
    for (size_t i = 0; i < rig->node_count; i++)
        locals[i] = rig->nodes[i].rest;
    if (clip >= 0 && (size_t)clip < rig->clip_count) {
        const struct rig_clip *moving = &rig->clips[clip];
        double looped_s = moving->duration_s > 0 ? fmod(time_s, moving->duration_s) : 0;
        looped_s += looped_s < 0 ? moving->duration_s : 0;
        for (size_t i = 0; i < moving->channel_count; i++) {
            const struct rig_channel *channel = &rig->channels[moving->first_channel + i];
            apply_channel(channel, (float)looped_s, &locals[channel->node]);
        }
    }
    for (size_t i = 0; i < rig->node_count; i++) {
        int index = rig->order[i];
        const struct rig_node *node = &rig->nodes[index];
        mat4s local = node->has_matrix ? node->matrix : matrix_of(&locals[index]);
        world[index] = node->parent < 0 ? local : glms_mat4_mul(world[node->parent], local);
    }
    free(locals);
}

void rig_place(const tl_rig *rig, const mat4s *world, vec3s *positions)
{
    mat4s *palette = TL_NEW_ARRAY(mat4s, rig->slot_count);
    for (size_t i = 0; i < rig->slot_count; i++)
        palette[i] = glms_mat4_mul(world[rig->slots[i].node], rig->slots[i].bind);
#pragma omp parallel for schedule(static) if (rig->vertex_count > 1024)
    for (size_t v = 0; v < rig->vertex_count; v++) {
        const struct rig_influence *influence = &rig->influences[v];
        vec3s sum = {{0, 0, 0}};
        for (int i = 0; i < 4; i++)
            if (influence->weights[i] > 0) {
                vec3s moved = glms_mat4_mulv3(palette[influence->slots[i]], rig->local[v], 1);
                sum = glms_vec3_muladds(moved, influence->weights[i], sum);
            }
        positions[v] = sum;
    }
    free(palette);
}
