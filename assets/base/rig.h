/* The animation of a model: its node tree, the binding of each vertex to it, and clips of keyframes. For the
 * floor assets alone.
 *
 * Every vertex is bound to up to four slots. A slot is a node and the matrix that takes a vertex to the
 * node's space: an inverse bind matrix for a skin, the identity for a rigid mesh. Morph targets move a vertex
 * before that. Pose: x = sum of weight * world(node) * bind * (x_local + sum of morph weight * offset). */
#ifndef TOILE_ASSETS_BASE_RIG_H
#define TOILE_ASSETS_BASE_RIG_H

#include "assets/base/model.h"

struct rig_transform {
    vec3s translation;
    versors rotation; /* unit, x y z w */
    vec3s scale;
};

struct rig_node {
    int parent; /* -1: none; always earlier in `order` */
    struct rig_transform rest;
    bool has_matrix; /* then `matrix` replaces `rest`, and no clip moves the node */
    mat4s matrix;
    size_t first_weight, weight_count; /* its mesh's morph targets, in rig.weights */
};

/* One target of the vertices that a node draws. */
struct rig_morph {
    size_t weight; /* in rig.weights */
    size_t offset_count;
    uint32_t *vertices; /* [offset_count] that it moves, rising */
    vec3s *offsets;     /* [offset_count] units of the file */
};

struct rig_slot {
    int node;
    mat4s bind;
};

struct rig_influence {
    uint32_t slots[4];
    float weights[4]; /* sum to 1 */
};

enum rig_path { RIG_TRANSLATION, RIG_ROTATION, RIG_SCALE, RIG_WEIGHTS, RIG_OTHER_PATH };
enum rig_interpolation { RIG_LINEAR, RIG_STEP, RIG_CUBIC_SPLINE };

struct rig_channel {
    int node;
    enum rig_path path;
    enum rig_interpolation interpolation;
    size_t components; /* of a value: 4 for a quaternion, 3 for a vector, or one for each morph target */
    size_t key_count;
    float *times_s; /* [key_count], rising */
    float *values; /* [key_count][components]; with tangents, for cubic splines, [key_count][3][components] */
};

struct rig_clip {
    size_t first_channel, channel_count;
    double duration_s;
};

struct tl_rig {
    size_t node_count, slot_count, vertex_count, channel_count, clip_count, weight_count, morph_count;
    struct rig_node *nodes;
    int *order; /* [node_count] parents before children */
    struct rig_slot *slots;
    vec3s *local;                     /* [vertex_count] before any transform */
    struct rig_influence *influences; /* [vertex_count] */
    float *weights;                   /* [weight_count] at rest */
    struct rig_morph *morphs;
    struct rig_channel *channels;
    struct rig_clip *clips;
};

void rig_destroy(tl_rig **handle);

/* A moment of a clip. */
struct rig_pose {
    mat4s *world;   /* [node_count] matrices to the world */
    float *weights; /* [weight_count] of morph targets */
};

/* The pose at a time of a clip, looped; clip -1: the rest pose. */
struct rig_pose rig_pose_at(const tl_rig *rig, int clip, double time_s);
void rig_pose_release(struct rig_pose *pose);

/* Morphs and skins the vertices: positions [vertex_count], units of the file. */
void rig_place(const tl_rig *rig, const struct rig_pose *pose, vec3s *positions);

#endif
