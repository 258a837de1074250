#include "assets/base/rig.h"

#include "config/base/memory.h"

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
    for (size_t i = 0; i < rig->morph_count; i++) {
        free(rig->morphs[i].vertices);
        free(rig->morphs[i].offsets);
    }
    free(rig->morphs);
    free(rig->weights);
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
static void hermite(const float *key, const float *next, float part, float span_s, size_t components,
                    float *out)
{
    float t2 = part * part, t3 = t2 * part;
    for (size_t i = 0; i < components; i++) {
        float value = key[components + i], leaving = span_s * key[2 * components + i];
        float next_value = next[components + i], arriving = span_s * next[i];
        out[i] = (2 * t3 - 3 * t2 + 1) * value + (t3 - 2 * t2 + part) * leaving +
                 (-2 * t3 + 3 * t2) * next_value + (t3 - t2) * arriving;
    }
}

/* out [channel->components]. */
static void evaluate(const struct rig_channel *channel, float time_s, float *out)
{
    size_t components = channel->components;
    bool cubic = channel->interpolation == RIG_CUBIC_SPLINE;
    size_t stride = components * (cubic ? 3 : 1), key = 0;
    while (key + 1 < channel->key_count && channel->times_s[key + 1] <= time_s)
        key++;
    const float *here = channel->values + key * stride, *next = here + stride;
    bool held = key + 1 == channel->key_count || time_s <= channel->times_s[key] ||
                channel->interpolation == RIG_STEP;
    float span_s = held ? 0 : channel->times_s[key + 1] - channel->times_s[key];
    float part = held ? 0 : (time_s - channel->times_s[key]) / span_s;
    if (held)
        memcpy(out, here + (cubic ? components : 0), components * sizeof *out);
    else if (cubic)
        hermite(here, next, part, span_s, components, out);
    else if (channel->path == RIG_ROTATION)
        slerp(here, next, part, out);
    else
        for (size_t i = 0; i < components; i++)
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

/* Applies a clip's channels at a time within it. */
static void apply_clip(const tl_rig *rig, const struct rig_clip *clip, float time_s,
                       struct rig_transform *locals, float *weights)
{
    for (size_t i = 0; i < clip->channel_count; i++) {
        const struct rig_channel *channel = &rig->channels[clip->first_channel + i];
        if (channel->path == RIG_WEIGHTS)
            evaluate(channel, time_s, &weights[rig->nodes[channel->node].first_weight]);
        else
            apply_channel(channel, time_s, &locals[channel->node]);
    }
}

struct rig_pose rig_pose_at(const tl_rig *rig, int clip, double time_s)
{
    struct rig_pose pose = {TL_NEW_ARRAY(mat4s, rig->node_count), TL_NEW_ARRAY(float, rig->weight_count)};
    struct rig_transform *locals = TL_NEW_ARRAY(struct rig_transform, rig->node_count);
    for (size_t i = 0; i < rig->node_count; i++)
        locals[i] = rig->nodes[i].rest;
    for (size_t i = 0; i < rig->weight_count; i++)
        pose.weights[i] = rig->weights[i];
    if (clip >= 0 && (size_t)clip < rig->clip_count) {
        const struct rig_clip *moving = &rig->clips[clip];
        double looped_s = moving->duration_s > 0 ? fmod(time_s, moving->duration_s) : 0;
        looped_s += looped_s < 0 ? moving->duration_s : 0;
        apply_clip(rig, moving, (float)looped_s, locals, pose.weights);
    }
    for (size_t i = 0; i < rig->node_count; i++) {
        int index = rig->order[i];
        const struct rig_node *node = &rig->nodes[index];
        mat4s local = node->has_matrix ? node->matrix : matrix_of(&locals[index]);
        pose.world[index] = node->parent < 0 ? local : glms_mat4_mul(pose.world[node->parent], local);
    }
    free(locals);
    return pose;
}

void rig_pose_release(struct rig_pose *pose)
{
    free(pose->world);
    free(pose->weights);
    *pose = (struct rig_pose){0};
}

/* The vertices before skinning: rig->local where nothing is morphed, else a new array in *own. */
static const vec3s *morphed(const tl_rig *rig, const float *weights, vec3s **own)
{
    *own = NULL;
    if (rig->morph_count == 0)
        return rig->local;
    *own = TL_NEW_ARRAY(vec3s, rig->vertex_count);
    memcpy(*own, rig->local, rig->vertex_count * sizeof **own);
    for (size_t m = 0; m < rig->morph_count; m++) {
        const struct rig_morph *morph = &rig->morphs[m];
        float weight = weights[morph->weight];
        for (size_t i = 0; weight != 0 && i < morph->offset_count; i++) {
            vec3s *moved = &(*own)[morph->vertices[i]];
            *moved = glms_vec3_muladds(morph->offsets[i], weight, *moved);
        }
    }
    return *own;
}

void rig_place(const tl_rig *rig, const struct rig_pose *pose, vec3s *positions)
{
    vec3s *own;
    const vec3s *local = morphed(rig, pose->weights, &own);
    mat4s *palette = TL_NEW_ARRAY(mat4s, rig->slot_count);
    for (size_t i = 0; i < rig->slot_count; i++)
        palette[i] = glms_mat4_mul(pose->world[rig->slots[i].node], rig->slots[i].bind);
#pragma omp parallel for schedule(static) if (rig->vertex_count > 1024)
    for (size_t v = 0; v < rig->vertex_count; v++) {
        const struct rig_influence *influence = &rig->influences[v];
        vec3s sum = {{0, 0, 0}};
        for (int i = 0; i < 4; i++)
            if (influence->weights[i] > 0) {
                vec3s moved = glms_mat4_mulv3(palette[influence->slots[i]], local[v], 1);
                sum = glms_vec3_muladds(moved, influence->weights[i], sum);
            }
        positions[v] = sum;
    }
    free(palette);
    free(own);
}
