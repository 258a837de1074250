/* Crossings of a fine mesh that moves with a coarse one: a patch is what lies on one coarse triangle.
 *
 * A patch whose triangles face within a half space does not cross itself, nor a neighbour if both do together
 * ([Volino and Magnenat-Thalmann 1994]; their condition on the outline is left out, but patches can
 * be named for which it may fail). So only sharp folds are tested, those patches, and patches that are not
 * neighbours and whose boxes overlap: smooth cloth needs one pass over its triangles.
 *
 * Metres. Lifetime: a plain struct that owns its arrays. Threads: parallel inside, with the same results at
 * any number of threads. */
#ifndef TOILE_CLOTH_CAGE_PATCHES_H
#define TOILE_CLOTH_CAGE_PATCHES_H

#include "cloth/self_contact/near_tree.h"

struct tl_patch_bounds;

struct tl_patches {
    size_t count;
    uint32_t (*corners)[3];         /* [count] patches with a common corner are neighbours */
    struct tl_fans lists;           /* triangles of each patch */
    struct tl_near_box *boxes;      /* [triangle_count] in the order of the lists */
    vec3s *normals;                 /* the same */
    struct tl_patch_bounds *bounds; /* [count] */
};

/* `patch_of` [triangle_count] of the fine mesh, below `count`. */
struct tl_patches tl_patches_make(const struct tl_topology *topology, const uint32_t *patch_of, size_t count,
                                  const uint32_t (*corners)[3]);
void tl_patches_release(struct tl_patches *patches);

/* [count] each, borrowed; NULL: see there. */
struct tl_patch_marks {
    const bool *changed; /* all that has moved since the last call; NULL: all */
    const bool *bent;    /* tested against themselves and all others, however they face; NULL: none */
};

/* Replaces `out` by the pairs of triangles that cross at `x`, in which a patch takes part that has changed.
 */
void tl_patches_crossings(struct tl_patches *patches, const struct tl_topology *topology, const vec3d *x,
                          const struct tl_patch_marks *marks, struct tl_near_pairs *out);

#endif
