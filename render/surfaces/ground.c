#include "render/surfaces/ground.h"

#include <math.h>
#include <string.h>

#define RADIUS_PER_FIGURE 3.0f /* the disc's radius over the figure's height */

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

void tl_ground_make(const struct tl_casters *casters, struct tl_ground *out)
{
    static const uint32_t indices[6] = {0, 2, 1, 0, 3, 2}; /* counter-clockwise seen from above */
    static const float corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    float height = fmaxf(casters->centre.y + casters->radius, casters->radius);
    *out = (struct tl_ground){.radius = RADIUS_PER_FIGURE * height,
                              .centre = {{casters->centre.x, 0, casters->centre.z}},
                              .material = tl_material_default("ground"),
                              .part = {.index_count = 6}};
    out->material.diffuse = (vec3s){{0.4f, 0.4f, 0.4f}};
    out->material.specular = (vec3s){{0, 0, 0}};
    memcpy(out->indices, indices, sizeof indices);
    for (int i = 0; i < 4; i++) {
        out->positions[i] = (vec3s){
            {out->centre.x + corners[i][0] * out->radius, 0, out->centre.z + corners[i][1] * out->radius}};
        out->normals[i] = (vec3s){{0, 1, 0}};
        out->tangents[i] = (vec4s){{1, 0, 0, 1}};
        out->uvs[i] = (vec2s){{corners[i][0], corners[i][1]}};
    }
    /* A quad of fixed shape: only where it lies differs, so its position is its revision. */
    uint32_t revision[4];
    memcpy(revision, &(float[4]){out->centre.x, out->centre.y, out->centre.z, out->radius}, sizeof revision);
    uint64_t mixed = 0;
    for (int i = 0; i < 4; i++)
        mixed = mixed * 1000003 + revision[i];
    out->surface = (tl_surface){.name = "ground",
                                .vertex_count = 4,
                                .positions = out->positions,
                                .normals = out->normals,
                                .tangents = out->tangents,
                                .uvs = out->uvs,
                                .index_count = 6,
                                .indices = out->indices,
                                .part_count = 1,
                                .parts = &out->part,
                                .materials = &out->material,
                                .motion_revision = mixed};
}
