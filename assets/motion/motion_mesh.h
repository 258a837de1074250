/* The mesh that a recorded motion moves, found by its name. Threads: any. */
#ifndef TOILE_ASSETS_MOTION_MOTION_MESH_H
#define TOILE_ASSETS_MOTION_MOTION_MESH_H

#include "config/base/error.h"

/* The mesh file of a point cache that is opened alone: for a .pc2 or .mdd the .obj, .glb or .gltf of the same
 * name beside it, for a sequence of OBJ files its first file. New string; NULL, with a message, when there is
 * none. */
char *tl_motion_find_mesh(const char *motion, tl_error *error);

#endif
