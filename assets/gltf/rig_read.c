#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <string.h>

#define KEYS_MAX ((size_t)1 << 22)

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

/* Orders nodes breadth first from those without a parent. Nodes that are never reached form a cycle. */
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

static bool read_channel(const gltf_document *document, const struct gltf_channel *from, const tl_rig *rig,
                         struct rig_channel *to, tl_error *error)
{
    size_t value_count;
    bool morphs = from->path == RIG_WEIGHTS; /* then the accessor has one number an element */
    *to = (struct rig_channel){.node = from->node, .path = from->path, .interpolation = from->interpolation};
    to->components = from->path == RIG_ROTATION ? 4 : morphs ? rig->nodes[from->node].weight_count : 3;
    if (!gltf_read_floats(document, from->times, "animation times", 1, KEYS_MAX, false, &to->times_s,
                          &to->key_count, error) ||
        !gltf_read_floats(document, from->values, "animation values", morphs ? 1 : (int)to->components,
                          3 * KEYS_MAX, false, &to->values, &value_count, error))
        return false;
    size_t per_key = (from->interpolation == RIG_CUBIC_SPLINE ? 3 : 1) * (morphs ? to->components : 1);
    if (to->key_count == 0 || value_count != per_key * to->key_count)
        return tl_fail(error, TL_INPUT,
                       "%s: an animation has %zu times but %zu values, %zu each: export the file again",
                       document->path, to->key_count, value_count, per_key);
    for (size_t i = 1; i < to->key_count; i++)
        if (to->times_s[i] < to->times_s[i - 1])
            return tl_fail(error, TL_INPUT,
                           "%s: the times of an animation do not rise: export the file again",
                           document->path);
    return true;
}

/* Channels of extensions have no node; weights have no effect on a node without morph targets. */
static bool moves_something(const gltf_document *document, const struct gltf_channel *from, const tl_rig *rig)
{
    if (from->path == RIG_OTHER_PATH || from->node < 0)
        return false;
    return from->path != RIG_WEIGHTS || (size_t)from->node >= document->node_count ||
           rig->nodes[from->node].weight_count > 0;
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
            if (!moves_something(document, from, rig))
                continue;
            if ((size_t)from->node >= document->node_count)
                return tl_fail(error, TL_INPUT,
                               "%s: an animation moves node %d, which does not exist: export the file again",
                               document->path, from->node);
            struct rig_channel *channel = &rig->channels[rig->channel_count++];
            if (!read_channel(document, from, rig, channel, error))
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
           rig_read_weights(document, rig, error) && read_clips(document, rig, error);
}
