#include "app/display/moving.h"

#include "cloth/mesh/topology.h"
#include "config/base/memory.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

void tl_moving_create(struct tl_moving *moving, const tl_model *model, const uint32_t *weld)
{
    size_t count = model->mesh.vertex_count;
    *moving = (struct tl_moving){
        .model = model,
        .positions = TL_NEW_ARRAY(vec3s, count),
        .normals = TL_NEW_ARRAY(vec3s, count),
        .tangents = TL_NEW_ARRAY(vec4s, count),
    };
    if (weld) {
        moving->frames = tl_tangent_frames_create(&model->mesh, weld);
    } else {
        uint32_t *by_position = TL_NEW_ARRAY(uint32_t, count);
        tl_weld_positions(model->mesh.positions, count, by_position);
        moving->frames = tl_tangent_frames_create(&model->mesh, by_position);
        free(by_position);
    }
    tl_moving_restart(moving);
}

void tl_moving_find_borders(struct tl_moving *moving, const tl_garment *garment)
{
    const tl_mesh *mesh = &moving->model->mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    for (uint32_t i = 0; garment->welds_seams_only && i < mesh->vertex_count; i++)
        weld[i] = i;
    tl_borders_release(&moving->borders);
    moving->borders = tl_borders_make(mesh, garment->pattern, weld, garment->seams, garment->seam_count);
    free(weld);
}

void tl_moving_restart(struct tl_moving *moving)
{
    const tl_mesh *mesh = &moving->model->mesh;
    memcpy(moving->positions, mesh->positions, mesh->vertex_count * sizeof *moving->positions);
    tl_tangent_frames_reset(moving->frames);
    tl_moving_update(moving);
}

static vec4s orthogonal_to(vec3s normal, vec4s tangent)
{
    vec3s along = {{tangent.x, tangent.y, tangent.z}};
    vec3s projected = glms_vec3_sub(along, glms_vec3_scale(normal, glms_vec3_dot(normal, along)));
    float length = glms_vec3_norm(projected);
    if (!(length > 1e-4f))
        return tangent;
    projected = glms_vec3_scale(projected, 1 / length);
    return (vec4s){{projected.x, projected.y, projected.z, tangent.w}};
}

void tl_moving_restart_as_authored(struct tl_moving *moving)
{
    const tl_mesh *mesh = &moving->model->mesh;
    tl_moving_restart(moving);
    memcpy(moving->normals, mesh->normals, mesh->vertex_count * sizeof *moving->normals);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        moving->tangents[i] =
            mesh->tangents ? mesh->tangents[i] : orthogonal_to(moving->normals[i], moving->tangents[i]);
}

void tl_moving_release(struct tl_moving *moving)
{
    tl_tangent_frames_destroy(&moving->frames);
    free(moving->positions);
    free(moving->normals);
    free(moving->tangents);
    tl_borders_release(&moving->borders);
    *moving = (struct tl_moving){0};
}

void tl_moving_update(struct tl_moving *moving)
{
    tl_tangent_frames_update(moving->frames, moving->positions, moving->normals, moving->tangents);
    moving->motion_revision++;
}

tl_surface tl_moving_surface(const struct tl_moving *moving, const char *name,
                             const struct tl_dressing *dressing)
{
    tl_surface surface = tl_surface_of_mesh(name, &moving->model->mesh, dressing->materials);
    surface.positions = moving->positions;
    surface.normals = moving->normals;
    surface.tangents = moving->tangents;
    surface.parts = dressing->parts;
    surface.motion_revision = moving->motion_revision;
    return surface;
}

/* The intersection of [Moeller and Trumbore 1997]; both sides count. */
static bool hit_triangle(vec3s origin, vec3s direction, const vec3s corners[3], float *distance_m,
                         float weights[3])
{
    vec3s side = glms_vec3_sub(corners[1], corners[0]), other = glms_vec3_sub(corners[2], corners[0]);
    vec3s p = glms_vec3_cross(direction, other);
    float determinant = glms_vec3_dot(side, p);
    if (determinant == 0)
        return false;
    vec3s to_origin = glms_vec3_sub(origin, corners[0]);
    vec3s q = glms_vec3_cross(to_origin, side);
    float u = glms_vec3_dot(to_origin, p) / determinant;
    float v = glms_vec3_dot(direction, q) / determinant;
    *distance_m = glms_vec3_dot(other, q) / determinant;
    weights[0] = 1 - u - v;
    weights[1] = u;
    weights[2] = v;
    return u >= 0 && v >= 0 && u + v <= 1 && *distance_m > 0;
}

bool tl_moving_pick(const struct tl_moving *moving, vec3s origin, vec3s direction, uint32_t *vertex,
                    float *distance_m)
{
    const tl_mesh *mesh = &moving->model->mesh;
    const vec3s *positions = moving->positions;
    float nearest = FLT_MAX;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *index = &mesh->indices[i];
        const vec3s corners[3] = {positions[index[0]], positions[index[1]], positions[index[2]]};
        float distance, weights[3];
        if (!hit_triangle(origin, direction, corners, &distance, weights) || distance >= nearest)
            continue;
        nearest = distance;
        int best = weights[1] > weights[0] ? 1 : 0;
        *vertex = index[weights[2] > weights[best] ? 2 : best];
    }
    *distance_m = nearest;
    return nearest < FLT_MAX;
}
