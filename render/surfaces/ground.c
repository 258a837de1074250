#include "render/surfaces/ground.h"

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/surfaces/ground.glsl"

#include "render/gpu/terms_end.h"

#include <math.h>
#include <string.h>

#define RADIUS_ORDINARY   0.5f /* metres */
#define RADIUS_PER_FIGURE 3.0f /* the disc's radius over the figure's height */
_Static_assert(TL_GROUND_RINGS == GROUND_RINGS && TL_GROUND_SEGMENTS == GROUND_SEGMENTS, "of ground.glsl");

bool tl_casters_measure(const tl_surface *surfaces, size_t count, struct tl_casters *out, tl_error *error)
{
    struct tl_box box = {{{INFINITY, INFINITY, INFINITY}}, {{-INFINITY, -INFINITY, -INFINITY}}};
    for (size_t s = 0; s < count; s++) {
        for (size_t v = 0; v < surfaces[s].vertex_count; v++) {
            vec3s p = surfaces[s].positions[v];
            if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
                return tl_fail(error, TL_UNSTABLE, "%s: vertex %zu has a position that is not finite",
                               surfaces[s].name, v);
            box.lower = glms_vec3_minv(box.lower, p);
            box.upper = glms_vec3_maxv(box.upper, p);
        }
    }
    if (box.lower.x > box.upper.x)
        box = (struct tl_box){{{0, 0, 0}}, {{0, 0, 0}}};
    out->centre = glms_vec3_scale(glms_vec3_add(box.lower, box.upper), 0.5f);
    float largest = 0;
    for (size_t s = 0; s < count; s++)
        for (size_t v = 0; v < surfaces[s].vertex_count; v++)
            largest = fmaxf(largest, glms_vec3_distance(surfaces[s].positions[v], out->centre));
    out->radius = fmaxf(largest, TL_CASTERS_RADIUS_MIN);
    return true;
}

float tl_casters_scale(const struct tl_casters *casters)
{
    return fminf(casters->radius / RADIUS_ORDINARY, 1);
}

/* One vertex in the middle, then ring by ring outwards, under a figure of 1.8 m 2 to 3 cm apart, at the rim
 * 70 cm. The last ring goes round the disc. */
static void place_vertices(struct tl_ground *ground)
{
    ground->uvs[0] = (vec2s){{0, 0}};
    for (int ring = 1; ring <= TL_GROUND_RINGS; ring++) {
        float share = ground_ring_radius((float)ring);
        if (ring == TL_GROUND_RINGS)
            share /= cosf((float)M_PI / TL_GROUND_SEGMENTS);
        for (int segment = 0; segment < TL_GROUND_SEGMENTS; segment++) {
            float angle = 2 * (float)M_PI * (float)segment / TL_GROUND_SEGMENTS;
            ground->uvs[1 + (ring - 1) * TL_GROUND_SEGMENTS + segment] =
                (vec2s){{share * cosf(angle), share * sinf(angle)}};
        }
    }
    for (int i = 0; i < TL_GROUND_VERTICES; i++) {
        ground->positions[i] = (vec3s){{ground->centre.x + ground->uvs[i].x * ground->radius, 0,
                                        ground->centre.z + ground->uvs[i].y * ground->radius}};
        ground->normals[i] = (vec3s){{0, 1, 0}};
        ground->tangents[i] = (vec4s){{1, 0, 0, 1}};
    }
}

/* Counter-clockwise seen from above, where x is right and z is down. */
static void join_vertices(uint32_t *indices)
{
    for (uint32_t segment = 0; segment < TL_GROUND_SEGMENTS; segment++) {
        uint32_t next = (segment + 1) % TL_GROUND_SEGMENTS;
        memcpy(indices, (uint32_t[3]){0, 1 + next, 1 + segment}, 3 * sizeof *indices);
        indices += 3;
        for (uint32_t ring = 1; ring < TL_GROUND_RINGS; ring++) {
            uint32_t inner = 1 + (ring - 1) * TL_GROUND_SEGMENTS, outer = inner + TL_GROUND_SEGMENTS;
            memcpy(indices,
                   (uint32_t[6]){inner + segment, inner + next, outer + next, inner + segment, outer + next,
                                 outer + segment},
                   6 * sizeof *indices);
            indices += 6;
        }
    }
}

/* A mesh of fixed shape. Where it lies and its size make a motion's revision; its colour, which comes with
 * the rest of its material, a topology's. */
static uint64_t revision_of(const float *parts, int count)
{
    uint64_t mixed = 0;
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &parts[i], sizeof bits);
        mixed = mixed * 1000003 + bits;
    }
    return mixed;
}

void tl_ground_make(const struct tl_casters *casters, vec3s colour, struct tl_ground *out)
{
    float height = fmaxf(casters->centre.y + casters->radius, casters->radius);
    out->radius = RADIUS_PER_FIGURE * height;
    out->centre = (vec3s){{casters->centre.x, 0, casters->centre.z}};
    out->material = tl_material_default("ground");
    out->material.diffuse = colour;
    out->material.specular = (vec3s){{0, 0, 0}};
    out->part = (struct tl_mesh_part){.index_count = TL_GROUND_INDICES};
    place_vertices(out);
    join_vertices(out->indices);
    out->surface = (tl_surface){.name = "ground",
                                .vertex_count = TL_GROUND_VERTICES,
                                .positions = out->positions,
                                .normals = out->normals,
                                .tangents = out->tangents,
                                .uvs = out->uvs,
                                .index_count = TL_GROUND_INDICES,
                                .indices = out->indices,
                                .part_count = 1,
                                .parts = &out->part,
                                .materials = &out->material,
                                .topology_revision = revision_of(colour.raw, 3),
                                .motion_revision = revision_of(
                                    (float[]){out->centre.x, out->centre.y, out->centre.z, out->radius}, 4)};
}

static vec4s disc_of(const struct tl_ground *ground)
{
    return ground ? (vec4s){{ground->centre.x, ground->centre.y, ground->centre.z, ground->radius}}
                  : (vec4s){{0, 0, 0, 0}};
}

float tl_ground_cover(const struct tl_ground *ground, float x, float z)
{
    return ground_opacity(disc_of(ground), x, z);
}

float tl_ground_distance(const struct tl_ground *ground, vec3s origin, vec3s direction)
{
    const float way = ground ? ground_way(disc_of(ground), origin, direction) : -1;
    return way >= 0 ? way : INFINITY;
}

float tl_ground_visibility(const struct tl_ground *ground, vec3s point, vec3s direction)
{
    return ground_passes(disc_of(ground), point, direction);
}

float tl_ground_visibility_to(const struct tl_ground *ground, vec3s point, vec3s direction, float distance_m)
{
    const float rounding = 1e-6f; /* of light that shines from the ground's plane */
    const bool is_nearer = tl_ground_distance(ground, point, direction) < distance_m * (1 - rounding);
    return is_nearer ? tl_ground_visibility(ground, point, direction) : 1;
}

/* Weights of (x, z) in a triangle, seen from above; what rounding leaves outside, by 1e-4 at most, is put on
 * its edge. */
static bool weigh(const struct tl_ground *ground, uint32_t triangle, float x, float z, float weights[3])
{
    const uint32_t *corners = ground->indices + 3 * (size_t)triangle;
    vec3s a = ground->positions[corners[0]], b = ground->positions[corners[1]],
          c = ground->positions[corners[2]];
    float area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
    weights[1] = ((x - a.x) * (c.z - a.z) - (c.x - a.x) * (z - a.z)) / area;
    weights[2] = ((b.x - a.x) * (z - a.z) - (x - a.x) * (b.z - a.z)) / area;
    weights[0] = 1 - weights[1] - weights[2];
    bool inside = weights[0] > -1e-4f && weights[1] > -1e-4f && weights[2] > -1e-4f;
    float sum = 0;
    for (int i = 0; i < 3; i++)
        sum += weights[i] = fmaxf(weights[i], 0);
    for (int i = 0; i < 3; i++)
        weights[i] /= sum;
    return inside;
}

bool tl_ground_meet(const struct tl_ground *ground, vec3s origin, vec3s direction, vec3s *point,
                    uint32_t *triangle, float weights[3])
{
    float distance = tl_ground_distance(ground, origin, direction);
    if (distance == INFINITY)
        return false;
    *point = glms_vec3_add(origin, glms_vec3_scale(direction, distance));
    point->y = ground->centre.y;
    if (!(tl_ground_cover(ground, point->x, point->z) > 0))
        return false;
    /* The triangles of a segment follow each other from the middle outwards, two a ring. Chords lie inside
     * their circles, so that the next ring may have the point. */
    const vec2s place = ground_place(disc_of(ground), point->x, point->z);
    const uint32_t in_segment = 2 * TL_GROUND_RINGS - 1, ring = (uint32_t)place.x;
    const uint32_t segment = (uint32_t)place.y % TL_GROUND_SEGMENTS;
    for (uint32_t i = ring > 1 ? 2 * ring - 3 : 0; i < in_segment; i++) {
        *triangle = segment * in_segment + i;
        if (weigh(ground, *triangle, point->x, point->z, weights))
            return true;
    }
    return false;
}
