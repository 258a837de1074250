#include "assets/gltf/rig.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define KEYS_MAX ((size_t)1 << 22)

/* ---- Reading ---- */

static bool read_parents(const gltf_document *document, tl_rig *rig, tl_error *error)
{
    for (size_t i = 0; i < rig->node_count; i++)
        rig->nodes[i].parent = -1;
    for (size_t i = 0; i < rig->node_count; i++) {
        const struct gltf_node *node = &document->nodes[i];
        for (size_t c = 0; c < node->child_count; c++) {
            int child = node->children[c];
            if (child < 0 || (size_t)child >= rig->node_count)
                return tl_fail(error, TL_INPUT,
                               "%s: node %zu has a child %d that does not exist: export the file again",
                               document->path, i, child);
            if (rig->nodes[child].parent >= 0)
                return tl_fail(error, TL_INPUT, "%s: node %d has two parents: export the file again",
                               document->path, child);
            rig->nodes[child].parent = (int)i;
        }
    }
    return true;
}

/* Breadth first from the nodes without a parent; what is never reached goes in circles. */
static bool order_nodes(const gltf_document *document, tl_rig *rig, tl_error *error)
{
    size_t count = 0;
    for (size_t i = 0; i < rig->node_count; i++)
        if (rig->nodes[i].parent < 0)
            rig->order[count++] = (int)i;
    for (size_t next = 0; next < count; next++) {
        const struct gltf_node *node = &document->nodes[rig->order[next]];
        for (size_t c = 0; c < node->child_count; c++)
            rig->order[count++] = node->children[c];
    }
    if (count < rig->node_count)
        return tl_fail(error, TL_INPUT, "%s: its nodes form a ring: export the file again", document->path);
    return true;
}

static bool read_node(const gltf_document *document, size_t index, struct rig_node *out, tl_error *error)
{
    const struct gltf_node *node = &document->nodes[index];
    float sum = 0;
    for (int i = 0; i < 16; i++)
        sum += node->has_matrix ? node->matrix[i] : 0;
    for (int i = 0; i < 3; i++)
        sum += node->translation[i] + node->scale[i];
    for (int i = 0; i < 4; i++)
        sum += node->rotation[i];
    if (!isfinite(sum))
        return tl_fail(error, TL_INPUT, "%s: the transform of node %zu is not finite: export the file again",
                       document->path, index);
    out->has_matrix = node->has_matrix;
    memcpy(&out->matrix, node->matrix, sizeof out->matrix);
    memcpy(&out->rest.translation, node->translation, sizeof out->rest.translation);
    memcpy(&out->rest.scale, node->scale, sizeof out->rest.scale);
    memcpy(&out->rest.rotation, node->rotation, sizeof out->rest.rotation);
    out->rest.rotation = glms_quat_normalize(out->rest.rotation);
    return true;
}

static int components_of(enum gltf_path path)
{
    return path == GLTF_ROTATION ? 4 : 3;
}

static bool read_channel(const gltf_document *document, const struct gltf_channel *from,
                         struct rig_channel *to, tl_error *error)
{
    if (from->node < 0 || (size_t)from->node >= document->node_count)
        return tl_fail(error, TL_INPUT,
                       "%s: an animation moves node %d, which does not exist: export the file again",
                       document->path, from->node);
    size_t value_count;
    *to = (struct rig_channel){.node = from->node, .path = from->path, .interpolation = from->interpolation};
    if (!gltf_read_floats(document, from->times, "animation times", 1, KEYS_MAX, false, &to->times_s,
                          &to->key_count, error) ||
        !gltf_read_floats(document, from->values, "animation values", components_of(from->path), 3 * KEYS_MAX,
                          false, &to->values, &value_count, error))
        return false;
    size_t per_key = from->interpolation == GLTF_CUBIC_SPLINE ? 3 : 1;
    if (to->key_count == 0 || value_count != per_key * to->key_count)
        return tl_fail(error, TL_INPUT,
                       "%s: an animation has %zu times but %zu values: export the file again", document->path,
                       to->key_count, value_count);
    for (size_t i = 1; i < to->key_count; i++)
        if (to->times_s[i] < to->times_s[i - 1])
            return tl_fail(error, TL_INPUT,
                           "%s: the times of an animation do not rise: export the file again",
                           document->path);
    return true;
}

static bool read_clips(const gltf_document *document, tl_rig *rig, tl_error *error)
{
    rig->clips = TL_NEW_ARRAY(struct rig_clip, document->animation_count);
    rig->channels = TL_NEW_ARRAY(struct rig_channel, document->channel_count);
    for (size_t a = 0; a < document->animation_count; a++) {
        const struct gltf_animation *animation = &document->animations[a];
        struct rig_clip *clip = &rig->clips[rig->clip_count++];
        clip->first_channel = rig->channel_count;
        for (size_t c = 0; c < animation->channel_count; c++) {
            const struct gltf_channel *from = &document->channels[animation->first_channel + c];
            if (from->path == GLTF_OTHER_PATH || from->node < 0)
                continue; /* morph weights, and targets that only an extension knows */
            struct rig_channel *channel = &rig->channels[rig->channel_count++];
            if (!read_channel(document, from, channel, error))
                return false;
            clip->duration_s = fmax(clip->duration_s, (double)channel->times_s[channel->key_count - 1]);
        }
        clip->channel_count = rig->channel_count - clip->first_channel;
    }
    return true;
}

bool rig_read(const gltf_document *document, tl_rig *rig, tl_error *error)
{
    rig->node_count = document->node_count;
    rig->nodes = TL_NEW_ARRAY(struct rig_node, rig->node_count);
    rig->order = TL_NEW_ARRAY(int, rig->node_count);
    for (size_t i = 0; i < rig->node_count; i++)
        if (!read_node(document, i, &rig->nodes[i], error))
            return false;
    return read_parents(document, rig, error) && order_nodes(document, rig, error) &&
           read_clips(document, rig, error);
}

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

/* Spherical interpolation by the shorter way; both unit. */
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
    int components = components_of(channel->path);
    bool cubic = channel->interpolation == GLTF_CUBIC_SPLINE;
    size_t stride = (size_t)components * (cubic ? 3 : 1), key = 0;
    while (key + 1 < channel->key_count && channel->times_s[key + 1] <= time_s)
        key++;
    const float *here = channel->values + key * stride, *next = here + stride;
    bool held = key + 1 == channel->key_count || time_s <= channel->times_s[key] ||
                channel->interpolation == GLTF_STEP;
    float span_s = held ? 0 : channel->times_s[key + 1] - channel->times_s[key];
    float part = held ? 0 : (time_s - channel->times_s[key]) / span_s;
    if (held)
        memcpy(out, here + (cubic ? components : 0), (size_t)components * sizeof *out);
    else if (cubic)
        hermite(here, next, part, span_s, components, out);
    else if (channel->path == GLTF_ROTATION)
        slerp(here, next, part, out);
    else
        for (int i = 0; i < components; i++)
            out[i] = here[i] + part * (next[i] - here[i]);
}

static void apply_channel(const struct rig_channel *channel, float time_s, struct rig_transform *transform)
{
    float value[4];
    evaluate(channel, time_s, value);
    if (channel->path == GLTF_ROTATION)
        transform->rotation = glms_quat_normalize((versors){{value[0], value[1], value[2], value[3]}});
    else if (channel->path == GLTF_TRANSLATION)
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

void tl_model_pose(const tl_model *model, int clip, double time_s, vec3s *positions)
{
    if (!model->rig || clip < 0) {
        memcpy(positions, model->mesh.positions, model->mesh.vertex_count * sizeof *positions);
        return;
    }
    mat4s *world = TL_NEW_ARRAY(mat4s, model->rig->node_count);
    rig_world(model->rig, clip, time_s, world);
    rig_place(model->rig, world, positions);
    float metres = (float)tl_units_metres(model->units.units);
    for (size_t i = 0; i < model->mesh.vertex_count; i++)
        positions[i] = glms_vec3_scale(positions[i], metres);
    free(world);
}

int tl_model_find_clip(const tl_model *model, const char *name)
{
    if (name[0] == '\0')
        return model->clip_count ? 0 : -1;
    for (size_t i = 0; i < model->clip_count; i++)
        if (strcmp(model->clips[i].name, name) == 0)
            return (int)i;
    return -1;
}
