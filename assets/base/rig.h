/* The animation of a model: its node tree, the binding of each vertex to it, and clips of keyframes. For the
 * floor assets alone.
 *
 * Every vertex is bound to up to four slots. A slot is a node and the matrix that takes a vertex to the
 * node's space: an inverse bind matrix for a skin, the identity for a rigid mesh. Pose: x = sum of weight *
 * world(node) * bind * x_local. */
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
};

struct rig_slot {
    int node;
    mat4s bind;
};

struct rig_influence {
    uint32_t slots[4];
    float weights[4]; /* sum to 1 */
};

enum rig_path { RIG_TRANSLATION, RIG_ROTATION, RIG_SCALE, RIG_OTHER_PATH };
enum rig_interpolation { RIG_LINEAR, RIG_STEP, RIG_CUBIC_SPLINE };

/* Number of floats of a keyframe's value: 4 for a quaternion, 3 for a vector. */
static inline int rig_components(enum rig_path path)
{
    return path == RIG_ROTATION ? 4 : 3;
}

struct rig_channel {
    int node;
    enum rig_path path;
    enum rig_interpolation interpolation;
    size_t key_count;
    float *times_s; /* [key_count], rising */
    float *values;  /* [key_count][3 or 4], or [key_count][3][3 or 4] with tangents for cubic splines */
};

struct rig_clip {
    size_t first_channel, channel_count;
    double duration_s;
};

struct tl_rig {
    size_t node_count, slot_count, vertex_count, channel_count, clip_count;
    struct rig_node *nodes;
    int *order; /* [node_count] parents before children */
    struct rig_slot *slots;
    vec3s *local;                     /* [vertex_count] before any transform */
    struct rig_influence *influences; /* [vertex_count] */
    struct rig_channel *channels;
    struct rig_clip *clips;
};

void rig_destroy(tl_rig **handle);

/* World matrices [node_count] at a time of a clip, looped; clip -1: the rest pose. */
void rig_world(const tl_rig *rig, int clip, double time_s, mat4s *world);

/* Skins the vertices: positions [vertex_count], units of the file, from world matrices. */
void rig_place(const tl_rig *rig, const mat4s *world, vec3s *positions);

#endif
