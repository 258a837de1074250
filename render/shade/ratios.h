/* The ratio of seen to exact light at the vertices of the triangles that are seen (render/light/compose.h).
 * It is smooth where the exact light, the albedo, the weave and the edges are not: a pixel interpolates the
 * ratio and evaluates everything else itself.
 *
 * A ratio belongs to a vertex seen from one side, and depends on the viewer where the surface is glossy.
 * World space, metres. Lifetime: owns its arrays. Threads: one call at a time; results do not depend on their
 * number. */
#ifndef TOILE_RENDER_SHADE_RATIOS_H
#define TOILE_RENDER_SHADE_RATIOS_H

#include "render/gbuffer/ids.h"
#include "render/gbuffer/rings.h"
#include "render/light/compose.h"
#include "render/shade/materials.h"

/* Diffuse by channel and 0; glossy by channel, and 1 where something lies close above the vertex. */
struct tl_vertex_ratio {
    float diffuse[4], glossy[4];
};

struct tl_vertex_ratios {
    size_t surface_count, vertex_count;
    size_t *first_vertex;          /* [surface_count + 1] */
    struct tl_vertex_ratio *items; /* [2 vertex_count]: front, back */
    struct tl_vertex_ratio *found; /* ...: as made; in motion `items` are means with those of neighbours */
    float (*fuzz)[4];              /* ...: of fibres by channel, and 0; NULL: no part has any */
    uint32_t *stamps;              /* ...: update in which it was last seen; 0: never */
    uint32_t update;
    uint64_t light_revision, shapes_revision;
    struct tl_vertex_rings rings; /* made when something first moves */
    size_t count, capacity;       /* of those made in the last update */
    struct tl_samples samples;
    struct tl_taps *taps;
    uint32_t *places; /* [count]: index into `items` */
    struct tl_light_ratio *made;
};

struct tl_ratios_request {
    const struct tl_id_buffer *ids;
    const struct tl_triangle_ranges *ranges;
    const struct tl_shade_materials *materials;
    const tl_points *points; /* updated for the triangles of `ids` */
    const struct tl_region_lights *lights;
    int region_count;
    const struct tl_lobes *lobes;
    const struct tl_bounce *bounce; /* updated for the triangles of `ids`; NULL: none */
    float environment_yaw;          /* rad */
    vec3s eye;
    const struct tl_light_params *params;
    uint64_t light_revision;  /* changes with the environment, its yaw, the surfaces' materials and the
                                 options of light */
    uint64_t shapes_revision; /* changes when vertex numbers or materials do */
};

/* Makes the ratios of half of the vertices that are seen, the other half in the next update, and of all that
 * were not seen in the last one; of all when the light has changed. While something moves the values of the
 * points are single rays, and a region that is the most of a gloss is seen from one vertex and hidden from
 * the next: then what is shown are means over neighbours, the more so the fewer the regions. */
void tl_ratios_make(struct tl_vertex_ratios *ratios, const struct tl_ratios_request *request);
void tl_ratios_release(struct tl_vertex_ratios *ratios);
size_t tl_ratios_bytes(const struct tl_vertex_ratios *ratios);

/* The ratio of a corner of a triangle that is seen. */
static inline const struct tl_vertex_ratio *tl_ratio_at(const struct tl_vertex_ratios *ratios, size_t surface,
                                                        uint32_t vertex, bool back)
{
    return &ratios->items[2 * (ratios->first_vertex[surface] + vertex) + back];
}

/* ... of the fibres there; some part must have fuzz. */
static inline const float *tl_fuzz_ratio_at(const struct tl_vertex_ratios *ratios, size_t surface,
                                            uint32_t vertex, bool back)
{
    return ratios->fuzz[2 * (ratios->first_vertex[surface] + vertex) + back];
}

#endif
