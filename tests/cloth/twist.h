/* A body that moves as no skeleton does: the shoulders turn against the feet and the body sways sideways, so
 * that every triangle moves and most deform. Its period is 60 frames. */
#ifndef TOILE_TESTS_CLOTH_TWIST_H
#define TOILE_TESTS_CLOTH_TWIST_H

#include "assets/base/mesh.h"
#include "cloth/mesh/vec3d.h"

#include <math.h>

/* Writes the positions of the mesh's vertices in a frame. */
static inline void twist_pose(const tl_mesh *mesh, int frame, vec3s *pose)
{
    double swing = sin(2 * M_PI * frame / 60);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3d p = vec3d_from(mesh->positions[i]);
        double angle = 0.35 * p.y * swing, sway = 0.05 * p.y * p.y * swing;
        pose[i] = vec3d_to_float(
            (vec3d){cos(angle) * p.x + sin(angle) * p.z + sway, p.y, cos(angle) * p.z - sin(angle) * p.x});
    }
}

#endif
