#include "app/scene/inset_body.h"

#include "cloth/contact/collider.h"
#include "cloth/mesh/topology.h"
#include "config/base/memory.h"

#include <math.h>
#include <string.h>

/* `otherwise` for a triangle without an area. */
static vec3s face_normal(const tl_mesh *mesh, uint32_t triangle, vec3s otherwise)
{
    const uint32_t *v = &mesh->indices[3 * (size_t)triangle];
    const vec3s *x = mesh->positions;
    vec3s area = glms_vec3_cross(glms_vec3_sub(x[v[1]], x[v[0]]), glms_vec3_sub(x[v[2]], x[v[0]]));
    float length = glms_vec3_norm(area);
    return length > 0 ? glms_vec3_scale(area, 1 / length) : otherwise;
}

/* The distance by which a vertex moves against its normal. 0 where the garment does not cover it: the nearest
 * point is on an edge of the cloth, beside the vertex; or the cloth faces another way, as a sleeve does to a
 * hip. */
static float depth_of(const tl_collider *cloth, const tl_mesh *garment, vec3s at, vec3s normal)
{
    const float min_facing = 0.3f, min_above = 0.8f;
    const double touching_m = 5e-4; /* nearer, the direction to the nearest point means nothing */
    const double point[3] = {(double)at.x, (double)at.y, (double)at.z};
    struct tl_contact contact;
    if (!tl_collider_query(cloth, point, (double)TL_INSET_BODY_REACH_M, &contact))
        return 0;
    vec3s towards = {{(float)contact.normal[0], (float)contact.normal[1], (float)contact.normal[2]}};
    vec3s face = face_normal(garment, contact.triangle, towards);
    float facing = glms_vec3_dot(face, normal), height_m = (float)contact.distance_m;
    bool is_above = fabs(contact.distance_m) < touching_m || glms_vec3_dot(face, towards) > min_above;
    return is_above && facing > min_facing ? fmaxf((height_m + TL_INSET_BODY_CLEARANCE_M) / facing, 0) : 0;
}

/* A body that reaches this far through this share of the cloth that lies close to it is not the one that the
 * garment was made for. Of MakeHuman's two suits 1 and 5 % do on their own bodies, 50 and 53 % on each
 * other's. */
#define THROUGH_M     0.008f
#define THROUGH_SHARE 0.2

static bool is_made_for(const float *depths, size_t count)
{
    size_t close = 0, through = 0;
    for (size_t i = 0; i < count; i++) {
        close += depths[i] > 0;
        through += depths[i] > THROUGH_M + TL_INSET_BODY_CLEARANCE_M;
    }
    return (double)through <= THROUGH_SHARE * (double)close;
}

/* Depths of neighbours differ by at most so many times their distance: beside a collar that stands off, a
 * vertex that it covers would else be drawn through the neck, and the skin torn. By 1, 1.5, 2 and 3 no
 * triangle of MakeHuman's man turns over; 9, 7, 5 and 4 vertices of the woman still reach through her suit, 2
 * without a limit. */
#define STEEPEST 2.0f

static bool lower(float *depth, float maximum)
{
    bool lowers = *depth > maximum;
    *depth = lowers ? maximum : *depth;
    return lowers;
}

static bool lower_edge(const tl_mesh *body, float *depths, uint32_t a, uint32_t b)
{
    const float rise = STEEPEST * glms_vec3_distance(body->positions[a], body->positions[b]);
    bool any = lower(&depths[a], depths[b] + rise);
    return lower(&depths[b], depths[a] + rise) || any;
}

static void limit_steepness(const tl_mesh *body, float *depths)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, body->vertex_count);
    size_t places = tl_weld_positions(body->positions, body->vertex_count, weld);
    float *minimum = TL_NEW_ARRAY(float, places);
    bool any = true;
    while (any) {
        any = false;
        for (size_t i = 0; i < body->index_count; i += 3)
            for (size_t k = 0; k < 3; k++)
                any = lower_edge(body, depths, body->indices[i + k], body->indices[i + (k + 1) % 3]) || any;
        for (size_t i = 0; i < places; i++)
            minimum[i] = INFINITY;
        for (size_t i = 0; i < body->vertex_count; i++)
            lower(&minimum[weld[i]], depths[i]);
        for (size_t i = 0; i < body->vertex_count; i++)
            any = lower(&depths[i], minimum[weld[i]]) || any;
    }
    free(weld);
    free(minimum);
}

float *tl_inset_body_find(const tl_mesh *garment, const tl_mesh *body, tl_error *error)
{
    tl_collider *cloth = tl_collider_create(garment, false, error);
    if (!cloth)
        return NULL;
    float *depths = TL_NEW_ARRAY(float, body->vertex_count);
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = 0; i < body->vertex_count; i++)
        depths[i] = depth_of(cloth, garment, body->positions[i], body->normals[i]);
    tl_collider_destroy(&cloth);
    if (!is_made_for(depths, body->vertex_count))
        memset(depths, 0, body->vertex_count * sizeof *depths);
    limit_steepness(body, depths);
    return depths;
}

void tl_inset_body_apply(const float *depths, const vec3s *normals, vec3s *positions, size_t count)
{
    for (size_t i = 0; i < count; i++)
        positions[i] = glms_vec3_sub(positions[i], glms_vec3_scale(normals[i], depths[i]));
}
