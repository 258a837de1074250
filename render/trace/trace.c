#include "render/trace/trace.h"

#include "config/base/memory.h"
#include "render/trace/cutout.h"
#include "render/trace/spread.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Measured for a dress of 20,000 triangles and a body of as many: a refit takes 0.7 ms of CPU time, building
 * a Morton tree 1.3 ms and a good tree 4.7 ms, and after a dozen frames of motion they trace 4.2, 3.6 and 4.3
 * million rays per second. The tree of a surface is rebuilt after this many refits, because refitting
 * degrades it as the surface moves away. */
#define REFITS_MAX 64

#define OFFSET_SHARE                                                                                         \
    1e-4f /* a thousand times the rounding error of positions; a tenth of a millimetre for a figure */

/* A surface has up to three geometries, so that opaque parts need no filter function. */
enum kind { OPAQUE, MASKED, OPEN, KINDS };

/* The open triangles that a ray has passed, the last few of them: in packets Embree 3.13 shows the filter
 * some triangles twice. */
#define PASSED_MAX 8
struct passed {
    uint64_t triangles[PASSED_MAX]; /* geometry and primitive */
    unsigned count;                 /* of all */
};

/* Context of a query for the filter function. */
struct query {
    struct RTCIntersectContext context; /* must be first: Embree passes its address */
    float *transmittance;               /* by ray: transmittance of open sheets; NULL: they block rays, too */
    struct passed *passed;              /* by ray, where there is a transmittance */
};

struct piece {
    RTCGeometry geometry; /* NULL: the surface has no such part */
    size_t count;
    uint32_t *triangles; /* indices of these triangles in the surface */
};

struct slot {
    tl_surface surface; /* as of the last update */
    int refits;         /* number of refits since its tree was built */
    RTCBuffer positions;
    struct piece pieces[KINDS];
};

struct tl_trace {
    RTCDevice device;
    RTCScene scene; /* geometry ids: KINDS x slot + kind */
    size_t slot_count;
    struct slot **slots; /* by pointer, because the filters keep their addresses */
    int64_t bytes;
};

static bool count_bytes(void *user, ssize_t bytes, bool post)
{
    (void)post;
    tl_trace *trace = user;
    __atomic_fetch_add(&trace->bytes, (int64_t)bytes, __ATOMIC_RELAXED);
    return true;
}

/* The BVH is built by one thread, so that the tree, and with it the order of equally near triangles, is the
 * same everywhere. */
tl_trace *tl_trace_create(tl_error *error)
{
    tl_trace *trace = TL_NEW(tl_trace);
    trace->device = rtcNewDevice("threads=1");
    if (!trace->device) {
        tl_fail(
            error, TL_DEVICE,
            "Embree cannot start (error %d; 4: too little memory): free some memory, or reinstall libembree3",
            (int)rtcGetDeviceError(NULL));
        free(trace);
        return NULL;
    }
    rtcSetDeviceMemoryMonitorFunction(trace->device, count_bytes, trace);
    trace->scene = rtcNewScene(trace->device);
    /* A dynamic scene of low quality keeps one tree per geometry below a tree that joins them, so that
     * surfaces at rest are not rebuilt. The quality of those trees is set per geometry. */
    rtcSetSceneFlags(trace->scene, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(trace->scene, RTC_BUILD_QUALITY_LOW);
    rtcCommitScene(trace->scene);
    return trace;
}

static unsigned geometry_id(size_t slot, enum kind kind)
{
    return (unsigned)(KINDS * slot) + (unsigned)kind;
}

static void empty_slot(tl_trace *trace, size_t index)
{
    struct slot *slot = trace->slots[index];
    for (enum kind kind = 0; kind < KINDS; kind++) {
        struct piece *piece = &slot->pieces[kind];
        if (piece->geometry) {
            rtcDetachGeometry(trace->scene, geometry_id(index, kind));
            rtcReleaseGeometry(piece->geometry);
        }
        free(piece->triangles);
        *piece = (struct piece){0};
    }
    if (slot->positions)
        rtcReleaseBuffer(slot->positions);
    *slot = (struct slot){0};
}

static void resize(tl_trace *trace, size_t count)
{
    for (size_t i = count; i < trace->slot_count; i++) {
        empty_slot(trace, i);
        free(trace->slots[i]);
    }
    trace->slots = tl_resize(trace->slots, count, sizeof(struct slot *));
    for (size_t i = trace->slot_count; i < count; i++)
        trace->slots[i] = TL_NEW(struct slot);
    trace->slot_count = count;
}

void tl_trace_destroy(tl_trace **trace)
{
    if (!*trace)
        return;
    resize(*trace, 0);
    free((*trace)->slots);
    rtcReleaseScene((*trace)->scene);
    rtcReleaseDevice((*trace)->device);
    free(*trace);
    *trace = NULL;
}

static const tl_material *material_of(const tl_surface *surface, uint32_t triangle)
{
    for (size_t p = 0; p < surface->part_count; p++)
        if (3 * triangle - surface->parts[p].first_index < surface->parts[p].index_count)
            return &surface->materials[surface->parts[p].material];
    return NULL;
}

static bool in_hole(const tl_surface *surface, uint32_t triangle, float u, float v)
{
    if (!surface->uvs)
        return false;
    const uint32_t *corners = surface->indices + 3 * (size_t)triangle;
    vec2s uv = glms_vec2_scale(surface->uvs[corners[0]], 1 - u - v);
    uv = glms_vec2_add(uv, glms_vec2_scale(surface->uvs[corners[1]], u));
    uv = glms_vec2_add(uv, glms_vec2_scale(surface->uvs[corners[2]], v));
    return tl_cutout_at(material_of(surface, triangle), uv);
}

/* Notes that a ray passes a triangle. Returns false if it has passed it already. */
static bool pass(struct passed *passed, unsigned geometry, unsigned primitive)
{
    const uint64_t triangle = (uint64_t)geometry << 32 | primitive;
    for (unsigned i = 0; i < PASSED_MAX && i < passed->count; i++)
        if (passed->triangles[i] == triangle)
            return false;
    passed->triangles[passed->count++ % PASSED_MAX] = triangle;
    return true;
}

/* The filter function: skips holes and accumulates the transmittance of open sheets. Rays and hits of N lanes
 * are arrays of N numbers: the eleventh of a ray is its id; those of a hit are three of the normal, u, v,
 * primitive, geometry (the accessors of rtcore_ray.h are C++ only). */
static void skip_holes(const struct RTCFilterFunctionNArguments *arguments)
{
    unsigned count = arguments->N;
    const float *numbers = (const float *)arguments->hit;
    const uint32_t *primitives = (const uint32_t *)arguments->hit + 5 * (size_t)count;
    const uint32_t *geometries = (const uint32_t *)arguments->hit + 6 * (size_t)count;
    const uint32_t *ids = (const uint32_t *)arguments->ray + 10 * (size_t)count;
    const struct slot *slot = arguments->geometryUserPtr;
    const struct query *query = (const struct query *)arguments->context;
    float *transmittance = query->transmittance;
    for (unsigned i = 0; i < count; i++) {
        if (!arguments->valid[i])
            continue;
        enum kind kind = (enum kind)(geometries[i] % KINDS);
        uint32_t triangle = slot->pieces[kind].triangles[primitives[i]];
        bool hole = in_hole(&slot->surface, triangle, numbers[3 * count + i], numbers[4 * count + i]);
        if (!hole && kind == OPEN && transmittance &&
            pass(&query->passed[ids[i]], geometries[i], primitives[i]))
            transmittance[ids[i]] *= material_of(&slot->surface, triangle)->openness;
        if (hole || (kind == OPEN && transmittance))
            arguments->valid[i] = 0;
    }
}

static enum kind kind_of(const tl_surface *surface, const struct tl_mesh_part *part)
{
    const tl_material *material = &surface->materials[part->material];
    if (material->openness > 0)
        return OPEN;
    return material->alpha_cutoff > 0 && surface->uvs ? MASKED : OPAQUE;
}

static const uint32_t *collect_triangles(const tl_surface *surface, enum kind kind, struct piece *piece)
{
    piece->triangles = TL_NEW_ARRAY(uint32_t, surface->index_count / 3);
    for (size_t p = 0; p < surface->part_count; p++) {
        const struct tl_mesh_part *part = &surface->parts[p];
        if (kind_of(surface, part) == kind)
            for (uint32_t i = 0; i < part->index_count / 3; i++)
                piece->triangles[piece->count++] = part->first_index / 3 + i;
    }
    return piece->triangles;
}

static void build_piece(tl_trace *trace, size_t index, enum kind kind)
{
    struct slot *slot = trace->slots[index];
    const tl_surface *surface = &slot->surface;
    struct piece *piece = &slot->pieces[kind];
    const uint32_t *triangles = collect_triangles(surface, kind, piece);
    if (piece->count == 0)
        return;
    piece->geometry = rtcNewGeometry(trace->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuffer(piece->geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, slot->positions, 0,
                         sizeof(vec3s), surface->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(piece->geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), piece->count);
    if (!indices) /* out of memory: tl_trace_update reports the error of the device */
        return;
    for (size_t i = 0; i < piece->count; i++)
        memcpy(indices + 3 * i, surface->indices + 3 * (size_t)triangles[i], 3 * sizeof(uint32_t));
    if (kind != OPAQUE) {
        rtcSetGeometryUserData(piece->geometry, slot);
        rtcSetGeometryIntersectFilterFunction(piece->geometry, skip_holes);
        rtcSetGeometryOccludedFilterFunction(piece->geometry, skip_holes);
    }
    rtcSetGeometryBuildQuality(piece->geometry, RTC_BUILD_QUALITY_REFIT);
    rtcCommitGeometry(piece->geometry);
    rtcAttachGeometryByID(trace->scene, piece->geometry, geometry_id(index, kind));
}

static void copy_positions(const struct slot *slot)
{
    memcpy(rtcGetBufferData(slot->positions), slot->surface.positions,
           slot->surface.vertex_count * sizeof(vec3s));
}

/* Rebuilds all geometries of a slot. Embree reads 16 bytes at every vertex, so the buffer is a longer
 * copy. */
static void build_slot(tl_trace *trace, size_t index, const tl_surface *surface)
{
    empty_slot(trace, index);
    struct slot *slot = trace->slots[index];
    slot->surface = *surface;
    slot->positions = rtcNewBuffer(trace->device, (surface->vertex_count + 2) * sizeof(vec3s));
    if (!slot->positions)
        return;
    copy_positions(slot);
    for (enum kind kind = 0; kind < KINDS; kind++)
        build_piece(trace, index, kind);
}

/* Refits: keeps the topology of the trees and updates their boxes. */
static void refit_slot(struct slot *slot)
{
    slot->refits++;
    copy_positions(slot);
    for (enum kind kind = 0; kind < KINDS; kind++) {
        RTCGeometry geometry = slot->pieces[kind].geometry;
        if (!geometry)
            continue;
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
    }
}

static bool update_slot(tl_trace *trace, size_t index, const tl_surface *surface)
{
    struct slot *slot = trace->slots[index];
    const tl_surface *old = &slot->surface;
    bool fresh = !slot->positions || old->topology_revision != surface->topology_revision ||
                 old->vertex_count != surface->vertex_count || old->index_count != surface->index_count;
    bool moved = old->motion_revision != surface->motion_revision;
    if (fresh || (moved && slot->refits == REFITS_MAX)) {
        build_slot(trace, index, surface);
        return true;
    }
    slot->surface = *surface;
    if (moved)
        refit_slot(slot);
    return moved;
}

bool tl_trace_update(tl_trace *trace, const tl_surface *surfaces, size_t count, tl_error *error)
{
    bool changed = trace->slot_count != count;
    resize(trace, count);
    for (size_t i = 0; i < count; i++)
        changed |= update_slot(trace, i, &surfaces[i]);
    if (changed)
        rtcCommitScene(trace->scene);
    if (rtcGetDeviceError(trace->device) != RTC_ERROR_NONE)
        return tl_fail(error, TL_DEVICE, "Embree cannot build the surfaces' tree: give smaller meshes");
    return true;
}

static bool is_finite(vec3s v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static struct RTCRay make_ray(vec3s origin, vec3s direction, float from_m, float to_m)
{
    return (struct RTCRay){.org_x = origin.x,
                           .org_y = origin.y,
                           .org_z = origin.z,
                           .tnear = from_m,
                           .dir_x = direction.x,
                           .dir_y = direction.y,
                           .dir_z = direction.z,
                           .tfar = to_m,
                           .mask = (unsigned)-1};
}

struct tl_trace_hit tl_trace_nearest(const tl_trace *trace, vec3s origin, vec3s direction, float from_m,
                                     float to_m)
{
    struct tl_trace_hit none = {.surface = TL_TRACE_NONE};
    if (!is_finite(origin) || !is_finite(direction))
        return none;
    struct query query = {.transmittance = NULL};
    rtcInitIntersectContext(&query.context);
    struct RTCRayHit ray = {.ray = make_ray(origin, direction, from_m, to_m),
                            .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(trace->scene, &query.context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return none;
    const struct piece *piece = &trace->slots[ray.hit.geomID / KINDS]->pieces[ray.hit.geomID % KINDS];
    vec3s normal = {{ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}};
    return (struct tl_trace_hit){.surface = ray.hit.geomID / KINDS,
                                 .triangle = piece->triangles[ray.hit.primID],
                                 .u = ray.hit.u,
                                 .v = ray.hit.v,
                                 .distance_m = ray.ray.tfar,
                                 .back = glms_vec3_dot(normal, direction) > 0};
}

bool tl_trace_occluded(const tl_trace *trace, vec3s origin, vec3s direction, float from_m, float to_m)
{
    if (!is_finite(origin) || !is_finite(direction))
        return false;
    struct query query = {.transmittance = NULL};
    rtcInitIntersectContext(&query.context);
    struct RTCRay ray = make_ray(origin, direction, from_m, to_m);
    rtcOccluded1(trace->scene, &query.context, &ray);
    return ray.tfar < 0;
}

/* Traces a packet. Returns the bit mask of the blocked rays. */
static uint32_t trace_packet(const tl_trace *trace, const struct tl_ray_packet *packet, float *transmittance)
{
    struct passed passed[16];
    for (int i = 0; i < 16; i++)
        passed[i].count = 0;
    struct query query = {.transmittance = transmittance, .passed = passed};
    rtcInitIntersectContext(&query.context);
    query.context.flags =
        packet->coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_NONE;
    struct RTCRay16 rays = {0};
    memcpy(rays.org_x, packet->origin_x, sizeof rays.org_x);
    memcpy(rays.org_y, packet->origin_y, sizeof rays.org_y);
    memcpy(rays.org_z, packet->origin_z, sizeof rays.org_z);
    memcpy(rays.dir_x, packet->direction_x, sizeof rays.dir_x);
    memcpy(rays.dir_y, packet->direction_y, sizeof rays.dir_y);
    memcpy(rays.dir_z, packet->direction_z, sizeof rays.dir_z);
    _Alignas(64) int valid[16];
    for (int i = 0; i < 16; i++) {
        rays.tnear[i] = packet->from_m;
        rays.tfar[i] = packet->to_m;
        rays.mask[i] = (unsigned)-1;
        rays.id[i] = (unsigned)i;
        /* The sum is finite only if all six numbers are, or nearly overflow; such rays hit nothing either. */
        float sum =
            rays.org_x[i] + rays.org_y[i] + rays.org_z[i] + rays.dir_x[i] + rays.dir_y[i] + rays.dir_z[i];
        valid[i] = i < packet->count && isfinite(sum) ? -1 : 0;
        if (!valid[i]) {
            /* On processors without vectors of 16 floats, Embree 3.13 traces the packet as a stream, which
             * ignores `valid`. There a ray is inactive if it ends before it begins, and its numbers must be
             * finite: Embree asserts it. */
            rays.org_x[i] = rays.org_y[i] = rays.org_z[i] = 0;
            rays.dir_x[i] = rays.dir_y[i] = rays.dir_z[i] = 1;
            rays.tfar[i] = -INFINITY;
        }
    }
    rtcOccluded16(valid, trace->scene, &query.context, &rays);
    uint32_t blocked = 0;
    for (int i = 0; i < 16; i++)
        blocked |= (uint32_t)(valid[i] && rays.tfar[i] < 0) << i;
    return blocked;
}

uint32_t tl_trace_occluded_packet(const tl_trace *trace, const struct tl_ray_packet *packet)
{
    return trace_packet(trace, packet, NULL);
}

void tl_trace_transmittance_packet(const tl_trace *trace, const struct tl_ray_packet *packet,
                                   float transmittance[16])
{
    for (int i = 0; i < 16; i++)
        transmittance[i] = 1;
    uint32_t blocked = trace_packet(trace, packet, transmittance);
    for (int i = 0; i < 16; i++)
        transmittance[i] = blocked >> i & 1 ? 0 : transmittance[i];
}

vec3s tl_smooth_point(vec3s point, const vec3s corners[3], const vec3s normals[3], const float weights[3])
{
    vec3s moved = point;
    for (int i = 0; i < 3; i++)
        moved = glms_vec3_add(moved, smooth_shift(point, corners[i], normals[i], weights[i]));
    return moved;
}

float tl_trace_offset_in(vec3s low, vec3s high)
{
    float diagonal = glms_vec3_distance(low, high);
    return low.x <= high.x && isfinite(diagonal) ? OFFSET_SHARE * 0.5f * diagonal : OFFSET_SHARE;
}

float tl_trace_offset(const tl_trace *trace)
{
    struct RTCBounds box;
    rtcGetSceneBounds(trace->scene, &box);
    vec3s lower = {{box.lower_x, box.lower_y, box.lower_z}},
          upper = {{box.upper_x, box.upper_y, box.upper_z}};
    return tl_trace_offset_in(lower, upper);
}

size_t tl_trace_bytes(const tl_trace *trace)
{
    return (size_t)__atomic_load_n(&trace->bytes, __ATOMIC_RELAXED);
}
