/* Visibility by rays at the vertices that a picture shows, on the graphics card: the counterpart of points.h
 * in motion. From an image of IDs it lists the probes that are seen, a vertex and a side each, places their
 * rays' origins, and traces every region from each. Nothing is read back.
 *
 * Probes lie in the order of the CPU's clusters (cache_probes.h), so that neighbours are traced together.
 * Unlike there, vertices at one place stay apart, and every vertex has values of its own.
 *
 * Owns the buffers of the mesh, its tree and its GL objects; needs the context of its tl_gpu, on whose thread
 * it is used. World space, metres. */
#ifndef TOILE_RENDER_VISIBILITY_CARD_POINTS_H
#define TOILE_RENDER_VISIBILITY_CARD_POINTS_H

#include "render/gbuffer/samples.h"
#include "render/surfaces/ground.h"
#include "render/trace/tree_buffers.h"

enum {
    TL_CARD_MARK,   /* sides of triangles from IDs */
    TL_CARD_SEEN,   /* probes from sides */
    TL_CARD_GATHER, /* a list of probes */
    TL_CARD_PLACE,  /* origins of rays */
    TL_CARD_TRACE,  /* visibility */
    TL_CARD_POINTS_PROGRAMS
};

/* All zeros: nothing has been sent. Sizes in brackets are of 32-bit words where nothing else is said. */
struct tl_card_points {
    tl_gpu *gpu;
    uint64_t shapes_revision;
    bool has_shapes;
    size_t vertex_count, triangle_count, probe_count;
    uint32_t frame;               /* counts lists, from 1 */
    float offset_m;               /* where rays start above their surface: as tl_trace_offset */
    struct tl_cache_probe *items; /* [probe_count] */
    struct tl_card_scratch {      /* of all vertices and triangles, one surface behind the other */
        vec3s *positions, *normals;
        uint32_t *corners;
        float *openness;
    } scratch;

    tl_buffer positions, normals; /* [vertex_count][3] floats */
    tl_buffer corners;            /* [triangle_count][3] */
    tl_buffer triangle_facts;     /* [triangle_count]: surface, TL_CARD_TRANSMITS */
    tl_buffer probes;             /* [probe_count][2]: vertex and its back << 31, surface */
    tl_buffer triangle_probes;    /* [triangle_count][front, back][3] */
    struct tl_tree_buffers tree;  /* the ground casts no shadow */
    tl_buffer holes;              /* see trace/holes.h */
    bool has_holes;

    tl_buffer side_marks;  /* [triangle_count][front, back]: frame in which it was seen last */
    tl_buffer probe_marks; /* [probe_count]: ... */
    tl_buffer list;        /* [probe_count]: probes that are seen, in order */
    tl_buffer work;        /* see card_points.glsl */
    tl_buffer origins;     /* [listed][2] vec4: origin, 1: covered; normal on the probe's side */
    tl_buffer directions;  /* [rays][regions] vec4: unit, world */
    tl_buffer values;      /* [regions / 4][probe_count]: by place in `list`, a byte a region */
    tl_program programs[TL_CARD_POINTS_PROGRAMS];
};

/* Sends what has changed of the surfaces, and fits the tree. `ground`: the last surface's, or NULL. Errors:
 * TL_DEVICE if a buffer is too large; TL_INPUT if a program does not compile. */
bool tl_card_points_follow(struct tl_card_points *points, tl_gpu *gpu,
                           const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                           uint64_t shapes_revision, tl_error *error);
/* Lists the probes at the corners of triangles whose IDs are in R32UI images of one size; of those that light
 * comes through, on both sides. */
void tl_card_points_list(struct tl_card_points *points, const tl_texture *ids, int count);

struct tl_card_points_light {
    const vec3s *directions; /* [rays][regions], world */
    int region_count, ray_count;
    const struct tl_ground *ground; /* NULL: none */
};
/* Traces the listed probes. What is dispatched after it sees `values`. */
bool tl_card_points_trace(struct tl_card_points *points, const struct tl_card_points_light *light,
                          tl_error *error);

/* Compiles the programs again. */
bool tl_card_points_reload(struct tl_card_points *points, tl_error *error);
void tl_card_points_release(struct tl_card_points *points);
size_t tl_card_points_bytes(const struct tl_card_points *points);

#endif
