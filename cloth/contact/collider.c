#include "cloth/contact/collider.h"

#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/memory.h"

#include <embree3/rtcore.h>

#include <stdlib.h>
#include <string.h>

/* Below this distance the direction to the nearest point is rounding error: the pseudo-normal is used
 * instead. */
#define TOUCHING_M 1e-6

struct tl_collider {
    bool ground;
    size_t vertex_count, triangle_count;
    vec3s *poses[2];     /* render vertices: previous, current; one vertex more, which Embree may read */
    uint32_t *indices;   /* render vertices, three a triangle */
    uint32_t *corners;   /* the same, welded */
    struct tl_fans fans; /* triangles around each welded vertex */
    size_t skin_count;   /* welded vertices */
    double travel;
    bool jumped;
    struct tl_rigid jump;
    uint64_t revision;
    RTCDevice device;
    RTCGeometry geometry;
    RTCScene scene;
};

static vec3d corner_at(const tl_collider *collider, uint32_t vertex, double phase)
{
    return vec3d_mix(vec3d_from(collider->poses[0][vertex]), vec3d_from(collider->poses[1][vertex]), phase);
}

static void triangle_at(const tl_collider *collider, size_t triangle, double phase, vec3d out[3])
{
    for (size_t i = 0; i < 3; i++)
        out[i] = corner_at(collider, collider->indices[3 * triangle + i], phase);
}

/* Twice the area times the normal. */
static vec3d area_vector(const vec3d t[3])
{
    return vec3d_cross(vec3d_sub(t[1], t[0]), vec3d_sub(t[2], t[0]));
}

/* part / whole within 0 and 1: rounding must not leave the edge, and degenerate edges must not divide by 0.
 */
static double clamped_share(double part, double whole)
{
    return whole > 0 ? fmin(fmax(part / whole, 0), 1) : 0;
}

/* Barycentric coordinates of the point of a triangle nearest to p (Ericson, Real-Time Collision
 * Detection, 5.1.5). Six dot products decide which Voronoi region p lies in: of a corner, an edge or the
 * face. Coordinates outside the feature are exactly 0, because pseudo_normal recognises the feature by them.
 */
static void nearest_on_triangle(const vec3d t[3], vec3d p, double b[3])
{
    vec3d side = vec3d_sub(t[1], t[0]), other = vec3d_sub(t[2], t[0]);
    vec3d from0 = vec3d_sub(p, t[0]), from1 = vec3d_sub(p, t[1]), from2 = vec3d_sub(p, t[2]);
    double d1 = vec3d_dot(side, from0), d2 = vec3d_dot(other, from0);
    double d3 = vec3d_dot(side, from1), d4 = vec3d_dot(other, from1);
    double d5 = vec3d_dot(side, from2), d6 = vec3d_dot(other, from2);
    double over2 = d1 * d4 - d3 * d2, over1 = d5 * d2 - d1 * d6, over0 = d3 * d6 - d5 * d4;
    double share;
    b[0] = b[1] = b[2] = 0;
    if (d1 <= 0 && d2 <= 0) {
        b[0] = 1;
    } else if (d3 >= 0 && d4 <= d3) {
        b[1] = 1;
    } else if (d6 >= 0 && d5 <= d6) {
        b[2] = 1;
    } else if (over2 <= 0 && d1 >= 0 && d3 <= 0) {
        share = clamped_share(d1, d1 - d3);
        b[0] = 1 - share;
        b[1] = share;
    } else if (over1 <= 0 && d2 >= 0 && d6 <= 0) {
        share = clamped_share(d2, d2 - d6);
        b[0] = 1 - share;
        b[2] = share;
    } else if (over0 <= 0 && d4 >= d3 && d5 >= d6) {
        share = clamped_share(d4 - d3, d4 - d3 + d5 - d6);
        b[1] = 1 - share;
        b[2] = share;
    } else {
        double whole = over0 + over1 + over2;
        b[1] = clamped_share(over1, whole);
        b[2] = clamped_share(over2, whole);
        b[0] = 1 - b[1] - b[2];
    }
}

static vec3d blend(const vec3d t[3], const double b[3])
{
    vec3d sum = vec3d_scale(t[0], b[0]);
    return vec3d_muladd(vec3d_muladd(sum, t[1], b[1]), t[2], b[2]);
}

static double angle_between(vec3d a, vec3d b)
{
    return atan2(vec3d_norm(vec3d_cross(a, b)), vec3d_dot(a, b));
}

static vec3d face_normal(const tl_collider *collider, size_t triangle, double phase)
{
    vec3d t[3];
    triangle_at(collider, triangle, phase, t);
    return vec3d_unit_or(area_vector(t), (vec3d){0});
}

/* Pseudo-normal of the feature that the nearest point lies on [Baerentzen and Aanaes 2005]: the normal of a
 * face; for an edge the sum of both faces' normals; for a vertex the sum of its faces' normals, weighted by
 * their angles at it. Its dot product with the offset gives the side for every closed mesh. The normal of the
 * nearest face alone gives the wrong side for points beyond sharp edges. */
static vec3d pseudo_normal(const tl_collider *collider, uint32_t triangle, const double b[3], double phase)
{
    const uint32_t *corners = &collider->corners[3 * (size_t)triangle];
    int used = (b[0] > 0) + (b[1] > 0) + (b[2] > 0);
    if (used == 3)
        return face_normal(collider, triangle, phase);
    int lead = b[0] > 0 ? 0 : b[1] > 0 ? 1 : 2;
    int second = b[2] > 0 ? 2 : 1;
    vec3d sum = {0};
    for (uint32_t i = collider->fans.first[corners[lead]]; i < collider->fans.first[corners[lead] + 1]; i++) {
        uint32_t item = collider->fans.items[i], face = item / 3, at = item % 3;
        const uint32_t *around = &collider->corners[3 * (size_t)face];
        if (used == 2) {
            if (around[0] == corners[second] || around[1] == corners[second] || around[2] == corners[second])
                sum = vec3d_add(sum, face_normal(collider, face, phase));
            continue;
        }
        vec3d t[3];
        triangle_at(collider, face, phase, t);
        double angle = angle_between(vec3d_sub(t[(at + 1) % 3], t[at]), vec3d_sub(t[(at + 2) % 3], t[at]));
        sum = vec3d_muladd(sum, vec3d_unit_or(area_vector(t), (vec3d){0}), angle);
    }
    return vec3d_unit_or(sum, (vec3d){0});
}

struct nearest {
    const tl_collider *collider;
    vec3d point;
    double phase, distance;
    uint32_t triangle;
    double barycentric[3];
};

/* Embree calls this for each candidate triangle. Distances are computed in double, and of equal ones the
 * lowest triangle wins: the result does not depend on the order of the traversal. Returns whether the radius
 * was reduced. */
static bool visit_triangle(struct RTCPointQueryFunctionArguments *arguments)
{
    struct nearest *nearest = arguments->userPtr;
    vec3d t[3];
    double b[3];
    triangle_at(nearest->collider, arguments->primID, nearest->phase, t);
    vec3d area = area_vector(t);
    if (!(vec3d_dot(area, area) > 0))
        return false; /* no area, so no normal; its neighbours contain its points */
    nearest_on_triangle(t, nearest->point, b);
    double distance = vec3d_distance(nearest->point, blend(t, b));
    bool first = nearest->triangle == TL_NONE;
    bool nearer = distance < nearest->distance ||
                  (distance == nearest->distance && (first || arguments->primID < nearest->triangle));
    if (!nearer)
        return false;
    nearest->distance = distance;
    nearest->triangle = arguments->primID;
    memcpy(nearest->barycentric, b, sizeof b);
    /* Embree culls in float: the margin covers the rounding of the coordinates and of the radius. */
    float radius = (float)(distance * 1.0001 + 1e-6);
    if (radius >= arguments->query->radius)
        return false;
    arguments->query->radius = radius;
    return true;
}

bool tl_collider_query_at(const tl_collider *collider, const double point[3], double phase, double reach_m,
                          struct tl_contact *out)
{
    vec3d p = {point[0], point[1], point[2]};
    if (!collider->scene || !vec3d_finite(p))
        return false;
    struct nearest nearest = {collider, p, phase, reach_m, TL_NONE, {0}};
    struct RTCPointQuery query = {(float)p.x, (float)p.y, (float)p.z, (float)phase,
                                  (float)(reach_m * 1.0001 + 1e-6)};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(collider->scene, &query, &context, visit_triangle, &nearest);
    if (nearest.triangle == TL_NONE)
        return false;
    vec3d t[3];
    triangle_at(collider, nearest.triangle, phase, t);
    vec3d away = vec3d_sub(p, blend(t, nearest.barycentric));
    vec3d pseudo = pseudo_normal(collider, nearest.triangle, nearest.barycentric, phase);
    double side = vec3d_dot(away, pseudo) < 0 ? -1 : 1;
    vec3d normal = nearest.distance > TOUCHING_M ? vec3d_scale(away, side / nearest.distance) : pseudo;
    *out = (struct tl_contact){.distance_m = side * nearest.distance,
                               .normal = {normal.x, normal.y, normal.z},
                               .triangle = nearest.triangle};
    memcpy(out->barycentric, nearest.barycentric, sizeof out->barycentric);
    return true;
}

bool tl_collider_query(const tl_collider *collider, const double point[3], double reach_m,
                       struct tl_contact *out)
{
    return tl_collider_query_at(collider, point, 1, reach_m, out);
}

/* Solid angle of the triangle a, b, c seen from the origin [Van Oosterom and Strackee 1983]:
 * tan(angle / 2) = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|). */
static double solid_angle(vec3d a, vec3d b, vec3d c)
{
    double la = vec3d_norm(a), lb = vec3d_norm(b), lc = vec3d_norm(c);
    return 2 * atan2(vec3d_dot(a, vec3d_cross(b, c)),
                     la * lb * lc + vec3d_dot(a, b) * lc + vec3d_dot(b, c) * la + vec3d_dot(c, a) * lb);
}

double tl_collider_winding(const tl_collider *collider, const double point[3])
{
    const vec3d p = {point[0], point[1], point[2]};
    double sum = 0;
    for (size_t i = 0; i < collider->triangle_count; i++) {
        vec3d t[3];
        triangle_at(collider, i, 1, t);
        sum += solid_angle(vec3d_sub(t[0], p), vec3d_sub(t[1], p), vec3d_sub(t[2], p));
    }
    return sum / (4 * M_PI);
}

void tl_collider_path(const tl_collider *collider, uint32_t triangle, const double barycentric[3],
                      double previous[3], double current[3])
{
    vec3d t[3];
    triangle_at(collider, triangle, 0, t);
    vec3d point = blend(t, barycentric);
    memcpy(previous, &point, sizeof point);
    triangle_at(collider, triangle, 1, t);
    point = blend(t, barycentric);
    memcpy(current, &point, sizeof point);
}

size_t tl_collider_skin_count(const tl_collider *collider)
{
    return collider->skin_count;
}

/* Each neighbour is met once by every triangle around the vertex on one side of it, and so equally often. */
void tl_collider_skin(const tl_collider *collider, double phase, struct tl_skin_vertex *out)
{
    vec3d *sums = TL_NEW_ARRAY(vec3d, collider->skin_count + 1);
    double *lengths = TL_NEW_ARRAY(double, collider->skin_count + 1);
    for (size_t i = 0; i < collider->skin_count; i++)
        out[i] = (struct tl_skin_vertex){0};
    for (size_t i = 0; i < collider->triangle_count; i++) {
        vec3d t[3];
        triangle_at(collider, i, phase, t);
        const vec3d area = area_vector(t);
        for (size_t k = 0; k < 3; k++) {
            const size_t at = collider->corners[3 * i + k];
            const vec3d side = vec3d_sub(t[(k + 1) % 3], t[k]);
            out[at].x = t[k];
            out[at].normal = vec3d_add(out[at].normal, area);
            sums[at] = vec3d_add(sums[at], side);
            lengths[at] += vec3d_norm(side);
        }
    }
    for (size_t i = 0; i < collider->skin_count; i++) {
        out[i].normal = vec3d_unit_or(out[i].normal, (vec3d){0});
        out[i].point = lengths[i] > 0 ? -vec3d_dot(sums[i], out[i].normal) / lengths[i] : 0;
    }
    free(sums);
    free(lengths);
}

bool tl_collider_has_ground(const tl_collider *collider)
{
    return collider->ground;
}

double tl_collider_travel(const tl_collider *collider)
{
    return collider->travel;
}

uint64_t tl_collider_revision(const tl_collider *collider)
{
    return collider->revision;
}

static void copy_mesh(tl_collider *collider, const tl_mesh *mesh)
{
    collider->vertex_count = mesh->vertex_count;
    collider->triangle_count = mesh->index_count / 3;
    for (int pose = 0; pose < 2; pose++) {
        collider->poses[pose] = TL_NEW_ARRAY(vec3s, mesh->vertex_count + 1);
        memcpy(collider->poses[pose], mesh->positions, mesh->vertex_count * sizeof(vec3s));
    }
    size_t corner_count = 3 * collider->triangle_count;
    collider->indices = TL_NEW_ARRAY(uint32_t, corner_count);
    memcpy(collider->indices, mesh->indices, corner_count * sizeof(uint32_t));
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    collider->skin_count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    collider->corners = TL_NEW_ARRAY(uint32_t, corner_count);
    for (size_t i = 0; i < corner_count; i++)
        collider->corners[i] = weld[collider->indices[i]];
    collider->fans = tl_fans_build(collider->corners, corner_count, collider->skin_count);
    free(weld);
}

/* Builds Embree's BVH over both poses, as two time steps. One thread, so that the tree is the same on every
 * machine. */
static bool build_scene(tl_collider *collider, tl_error *error)
{
    collider->device = rtcNewDevice("threads=1");
    if (!collider->device)
        return tl_fail(
            error, TL_DEVICE,
            "Embree cannot start (error %d; 4: too little memory): free some memory, or reinstall libembree3",
            (int)rtcGetDeviceError(NULL));
    collider->geometry = rtcNewGeometry(collider->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(collider->geometry, 2);
    for (unsigned pose = 0; pose < 2; pose++)
        rtcSetSharedGeometryBuffer(collider->geometry, RTC_BUFFER_TYPE_VERTEX, pose, RTC_FORMAT_FLOAT3,
                                   collider->poses[pose], 0, sizeof(vec3s), collider->vertex_count);
    rtcSetSharedGeometryBuffer(collider->geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               collider->indices, 0, 3 * sizeof(uint32_t), collider->triangle_count);
    rtcCommitGeometry(collider->geometry);
    collider->scene = rtcNewScene(collider->device);
    rtcAttachGeometry(collider->scene, collider->geometry);
    rtcCommitScene(collider->scene);
    if (rtcGetDeviceError(collider->device) != RTC_ERROR_NONE)
        return tl_fail(error, TL_DEVICE, "Embree cannot build the avatar's tree: give a smaller avatar");
    return true;
}

tl_collider *tl_collider_create(const tl_mesh *mesh, bool ground, tl_error *error)
{
    tl_collider *collider = TL_NEW(tl_collider);
    collider->ground = ground;
    if (!mesh || mesh->index_count < 3)
        return collider;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (!vec3d_finite(vec3d_from(mesh->positions[i]))) {
            tl_fail(error, TL_INPUT, "avatar: vertex %zu is not finite: repair the mesh", i);
            tl_collider_destroy(&collider);
            return NULL;
        }
    copy_mesh(collider, mesh);
    if (!build_scene(collider, error))
        tl_collider_destroy(&collider);
    return collider;
}

void tl_collider_destroy(tl_collider **collider)
{
    tl_collider *c = *collider;
    if (!c)
        return;
    if (c->scene)
        rtcReleaseScene(c->scene);
    if (c->geometry)
        rtcReleaseGeometry(c->geometry);
    if (c->device)
        rtcReleaseDevice(c->device);
    for (int pose = 0; pose < 2; pose++)
        free(c->poses[pose]);
    free(c->indices);
    free(c->corners);
    tl_fans_release(&c->fans);
    free(c);
    *collider = NULL;
}

/* Updates travel, revision and BVH after the poses have changed. A refit keeps the tree's topology, which
 * suits a mesh that deforms little; a rebuild takes longer. */
static void refit(tl_collider *collider)
{
    collider->travel = 0;
    for (size_t i = 0; i < collider->vertex_count; i++)
        collider->travel = fmax(collider->travel, vec3d_distance(vec3d_from(collider->poses[0][i]),
                                                                 vec3d_from(collider->poses[1][i])));
    collider->revision++;
    rtcSetGeometryBuildQuality(collider->geometry, RTC_BUILD_QUALITY_REFIT);
    for (unsigned pose = 0; pose < 2; pose++)
        rtcUpdateGeometryBuffer(collider->geometry, RTC_BUFFER_TYPE_VERTEX, pose);
    rtcCommitGeometry(collider->geometry);
    rtcCommitScene(collider->scene);
}

/* Applies the best rigid fit of the jump to the previous pose, so that only the rest remains as motion. */
static void remove_jump(tl_collider *collider)
{
    struct tl_rigid *jump = &collider->jump;
    *jump = tl_rigid_fit(collider->poses[0], collider->poses[1], collider->vertex_count);
    for (size_t i = 0; i < collider->vertex_count; i++)
        collider->poses[0][i] = vec3d_to_float(tl_rigid_point(jump, vec3d_from(collider->poses[0][i])));
    refit(collider);
}

void tl_collider_move(tl_collider *collider, const vec3s *positions)
{
    size_t bytes = collider->vertex_count * sizeof(vec3s);
    if (!collider->scene)
        return;
    bool at_rest = memcmp(collider->poses[0], collider->poses[1], bytes) == 0;
    if (at_rest && memcmp(collider->poses[1], positions, bytes) == 0)
        return;
    memcpy(collider->poses[0], collider->poses[1], bytes);
    memcpy(collider->poses[1], positions, bytes);
    refit(collider);
    collider->jumped = collider->travel > TL_COLLIDER_JUMP_M;
    if (collider->jumped)
        remove_jump(collider);
}

bool tl_collider_jump(const tl_collider *collider, struct tl_rigid *out)
{
    *out = collider->jump;
    return collider->jumped;
}
