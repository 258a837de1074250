/* Light that surfaces send on to each other, kept at vertices.
 *
 * Rays from a vertex, over its hemisphere, are followed to what they hit. The vertex keeps what arrives by
 * them: its mean, E_b / pi, which is what the diffuse lobe takes; and for glossy lobes where it comes from
 * (bounced.h). What is hit sends on what its own vertices received when they were traced last: light of the
 * environment, suns and lamps, what it emits, and, if all bounces are wanted, bounced light, so that bounces
 * add up from update to update. It reflects as a matt surface of the material's mean colour, gloss included;
 * but where gloss is more than the colour, as of metal, by lobes, towards where the ray comes from.
 *
 *     environment at a hit = E(n, 1) sum of L over rays that meet nothing / sum of L over all rays
 *
 * with a coarse L, and so by a lobe: exact where nothing is hidden (the ratio of render/light/compose.h, of
 * one region a ray). A third of those rays go to the sky's bright parts.
 *
 * Only vertices are traced that the camera sees or that a ray has hit: wanted ones. In motion a share of them
 * is traced in each update, a smaller one of those that are hit only: what sixteen rays meet is a mean, and
 * may lag. Directions are fixed to the surface, so that nothing flickers; at rest what was found in motion is
 * replaced, and further directions are averaged in. Rays pass open cloth as they do in the reference, and a
 * surface that transmits sends on what its other side received. A vertex that parts of different materials
 * share has the material of the last of them.
 *
 * World space, metres; linear radiance, Rec. 709. Errors: none. Lifetime: a plain struct that starts as {0}
 * and owns its arrays. Threads: one call at a time; OpenMP inside; results do not depend on the number of
 * threads. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCE_H
#define TOILE_RENDER_BOUNCE_BOUNCE_H

#include "render/bounce/bounced.h"
#include "render/env/lobes.h"
#include "render/env/sun.h"
#include "render/gbuffer/rings.h"
#include "render/scene/lamp.h"
#include "render/surfaces/ground.h"
#include "render/trace/trace.h"

/* The environment as rays see it (bounce_internal.h). */
struct tl_bounce_sky {
    uint64_t revision;
    tl_cube cube; /* coarse */
    double *sums; /* [texels + 1] of luminance, texel by texel */
};

struct tl_bounce_material; /* bounce_internal.h */

/* The origin of a vertex's light: in motion, or at rest by what vertices sent in motion, both to be replaced;
 * in a first round of rays at rest, or in all. */
enum tl_bounce_state { TL_BOUNCE_UNKNOWN, TL_BOUNCE_OLD, TL_BOUNCE_MIXED, TL_BOUNCE_FIRST, TL_BOUNCE_LAST };

struct tl_bounce {
    size_t surface_count, vertex_count;
    size_t *first_vertex, *first_part;    /* [surface_count + 1] */
    struct tl_bounce_material *materials; /* of the parts of all surfaces */
    uint32_t *parts;                      /* [vertex_count]: the part that a vertex belongs to */
    uint64_t shapes_revision;
    uint32_t update;          /* counts updates, from 1 */
    struct tl_bounced *found; /* [2 vertex_count]: front, back: mean of the vertex's own rays */
    struct tl_bounced *shown; /* ...: mean with its neighbours'; in motion only where it is looked at */
    vec3s *sky_lit;           /* ...: E / pi of the environment */
    vec3s *point_lit;         /* ...: E / pi of suns and lamps */
    vec3s *sent;              /* ...: radiance to all sides, as of the last update */
    uint8_t *states;          /* ...: enum tl_bounce_state */
    uint32_t *wanted;         /* ...: update in which it was last seen or hit; 0: never */
    uint32_t *seen;           /* ...: update in which the camera last saw it; 0: never */
    struct tl_vertex_rings rings;
    struct tl_bounce_sky sky;
    bool is_done; /* at rest, and all wanted vertices have had their rounds */
};

struct tl_bounce_request {
    const tl_trace *trace;
    const struct tl_triangle_ranges *ranges; /* of the traced surfaces, then the ground if there is one */
    uint64_t shapes_revision;                /* changes when vertex numbers or materials do */
    const struct tl_ground *ground;          /* NULL: none */
    const tl_cube *cube;                     /* without the suns */
    uint64_t cube_revision;
    const struct tl_lobes *lobes; /* of the cube; with exponent 1, and those of the materials' lobes */
    const struct tl_suns *suns;
    const struct tl_lamp *lamps; /* [lamp_count] */
    size_t lamp_count;
    float environment_yaw; /* rad */
    const uint32_t *seen;  /* [seen_count]: global triangles and TL_SAMPLE_BACK that the camera sees */
    size_t seen_count;
    const struct tl_samples *samples; /* in place of `seen`, or NULL */
    bool all;                         /* hits send on what bounced to them, too */
    bool moved;                       /* something else than the camera changed since the last update */
    bool at_once;                     /* every wanted vertex is traced, however long that takes */
    int shares; /* in motion every N-th of the vertices that are seen is traced in an update */
};

/* Traces what is due. The first update of new shapes takes several at once, until what rays hit is known
 * itself. */
void tl_bounce_update(struct tl_bounce *bounce, const struct tl_bounce_request *request);
void tl_bounce_release(struct tl_bounce *bounce);
size_t tl_bounce_bytes(const struct tl_bounce *bounce);

/* Light bounced to a sample of the last update, between its triangle's vertices; terms of the sky are 0.
 */
struct tl_bounced tl_bounced_at(const struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges,
                                const tl_sample *sample);

#endif
