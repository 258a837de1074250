#include "cloth/contact/layers.h"

#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Largest distance between pieces that lie over each other. A point deeper than this on the wrong side of a
 * piece is not under it, but elsewhere, for example on the far side of a leg. */
#define REACH_M 0.03
/* Largest distance from the avatar at which its normals decide which side of a triangle is the inner one. */
#define AVATAR_REACH_M 0.5
/* Edges longer than this get probes between their vertices: a belt under a shirt is only a few centimetres
 * high. */
#define COARSE_M 0.015
/* Smallest |cosine| between a triangle's normal and the avatar's outward normal at which the triangle faces
 * outwards or inwards; steeper ones, in hems for example, face neither way. Also the smallest cosine between
 * a triangle's normal and the direction to a point that counts as lying over the triangle; other points lie
 * past its edge. */
#define FACING_COSINE 0.4
/* m/s, faster than TL_PUSH_OUT_SPEED: both layers move, and their stiffness pushes them back together. At the
 * avatar's speed crossed layers would never separate. */
#define PUSH_OUT_SPEED 1.0
/* A layer whose vertices all moved by less than this since the last search is not searched again. */
#define AT_REST_M 1e-4

/* ---- Pieces ---- */

size_t tl_layers_pieces(const struct tl_topology *topology, uint32_t *pieces)
{
    size_t count = 0;
    for (size_t i = 0; i < topology->vertex_count; i++)
        pieces[i] = (uint32_t)i;
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 1; corner < 3; corner++)
            tl_sets_join(pieces, topology->triangles[t][0], topology->triangles[t][corner]);
    for (size_t i = 0; i < topology->vertex_count; i++)
        pieces[i] = tl_sets_find(pieces, (uint32_t)i);
    for (size_t i = 0; i < topology->vertex_count;
         i++) /* the lowest member stands for its set, and is numbered first */
        pieces[i] = pieces[i] == i ? (uint32_t)count++ : pieces[pieces[i]];
    return count;
}

/* Unit normal as wound; 0 for a triangle without area. */
static vec3d face_normal(const uint32_t v[3], const vec3d *x)
{
    vec3d area = vec3d_cross(vec3d_sub(x[v[1]], x[v[0]]), vec3d_sub(x[v[2]], x[v[0]]));
    return vec3d_unit_or(area, (vec3d){0});
}

/* Decides per triangle whether its wound normal points away from the avatar. The winding alone is unreliable:
 * files wind some pieces inside out, and in rolled hems the edge faces down and the lining inwards. Without
 * an avatar within reach the winding is taken as it is. */
static void find_facings(struct tl_layers *layers, const struct tl_topology *topology,
                         const tl_collider *avatar, const vec3d *x)
{
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *v = topology->triangles[t];
        const struct tl_contact_sample centre = {{v[0], v[1], v[2]}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
        vec3d at = tl_contact_sample_position(&centre, x);
        const double point[3] = {at.x, at.y, at.z};
        struct tl_contact contact;
        layers->facing[t] = 1;
        if (!avatar || !tl_collider_query(avatar, point, AVATAR_REACH_M, &contact))
            continue;
        vec3d outward = {contact.normal[0], contact.normal[1], contact.normal[2]};
        double cosine = vec3d_dot(face_normal(v, x), outward);
        layers->facing[t] = (signed char)((cosine > FACING_COSINE) - (cosine < -FACING_COSINE));
    }
}

/* Marks the vertices of edges that belong to one triangle only. */
static void find_open_edges(struct tl_layers *layers, const struct tl_topology *topology)
{
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++)
            if (topology->neighbour[t][corner] == TL_NONE)
                for (int end = 1; end < 3; end++)
                    layers->on_open_edge[topology->triangles[t][(corner + end) % 3]] = true;
}

/* ---- A surface ---- */

static void release_layer(struct tl_layer *layer)
{
    tl_collider_destroy(&layer->surface);
    free(layer->triangles);
    free(layer->particles);
    free(layer->positions);
    *layer = (struct tl_layer){0};
}

static void copy_positions(struct tl_layer *layer, const vec3d *x)
{
    for (size_t i = 0; i < layer->particle_count; i++)
        layer->positions[i] = vec3d_to_float(x[layer->particles[i]]);
}

/* Builds the collider of the triangles whose vertices are in one group, with particles renumbered from 0. */
static bool build_layer(struct tl_layer *layer, const struct tl_topology *topology, const uint32_t *group_of,
                        uint32_t group, const vec3d *x, tl_error *error)
{
    uint32_t *number = TL_NEW_ARRAY(uint32_t, topology->vertex_count);
    *layer = (struct tl_layer){.triangles = TL_NEW_ARRAY(uint32_t, topology->triangle_count),
                               .particles = TL_NEW_ARRAY(uint32_t, topology->vertex_count),
                               .positions = TL_NEW_ARRAY(vec3s, topology->vertex_count)};
    for (size_t i = 0; i < topology->vertex_count; i++)
        if (group_of[i] == group) {
            number[i] = (uint32_t)layer->particle_count;
            layer->particles[layer->particle_count++] = (uint32_t)i;
        }
    copy_positions(layer, x);
    tl_mesh mesh = {.vertex_count = layer->particle_count,
                    .positions = layer->positions,
                    .indices = TL_NEW_ARRAY(uint32_t, 3 * topology->triangle_count)};
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *corners = topology->triangles[t];
        if (group_of[corners[0]] != group)
            continue;
        layer->triangles[mesh.index_count / 3] = (uint32_t)t;
        for (int corner = 0; corner < 3; corner++)
            mesh.indices[mesh.index_count++] = number[corners[corner]];
    }
    layer->surface = tl_collider_create(&mesh, false, error);
    free(mesh.indices);
    free(number);
    return layer->surface != NULL;
}

/* Whether the nearest point lies on an open edge or at one of its vertices, read from the zeros in the
 * barycentric coordinates: one zero is the edge opposite that corner, two are a vertex. */
static bool is_open(const struct tl_layers *layers, const struct tl_topology *topology, uint32_t triangle,
                    const double b[3])
{
    int zeros = (b[0] <= 0) + (b[1] <= 0) + (b[2] <= 0);
    for (int corner = 0; corner < 3; corner++) {
        if (zeros == 1 && b[corner] <= 0)
            return topology->neighbour[triangle][corner] == TL_NONE;
        if (zeros == 2 && b[corner] > 0)
            return layers->on_open_edge[topology->triangles[triangle][corner]];
    }
    return false;
}

/* Finds the point of a layer nearest to contact_pair->point, its outward normal and the signed distance,
 * positive outside. Returns false beyond REACH_M, past an open edge and at triangles that face neither way:
 * there is no side to be on. */
static bool find_surface(const struct tl_layers *layers, const struct tl_topology *topology,
                         const struct tl_layer *layer, const vec3d *x, struct tl_layer_contact *contact_pair,
                         double *distance)
{
    vec3d at = tl_contact_sample_position(&contact_pair->point, x);
    const double point[3] = {at.x, at.y, at.z};
    struct tl_contact contact;
    if (!tl_collider_query(layer->surface, point, REACH_M, &contact))
        return false;
    uint32_t triangle = layer->triangles[contact.triangle];
    const uint32_t *v = topology->triangles[triangle];
    vec3d normal = {contact.normal[0], contact.normal[1], contact.normal[2]};
    double side = layers->facing[triangle];
    if (side == 0 || is_open(layers, topology, triangle, contact.barycentric) ||
        vec3d_dot(normal, face_normal(v, x)) < FACING_COSINE)
        return false;
    memcpy(contact_pair->surface.vertices, v, sizeof contact_pair->surface.vertices);
    memcpy(contact_pair->surface.weights, contact.barycentric, sizeof contact_pair->surface.weights);
    contact_pair->normal = vec3d_scale(normal, side);
    *distance = side * contact.distance_m;
    return true;
}

/* ---- Order of the pieces ---- */

/* Sum over a piece's vertices of their signed distances to another piece, m: positive if it lies mostly
 * outside. The sum rather than a count, so that a few crossed vertices near the surface do not decide. */
static double measure_outside(const struct tl_layers *layers, const struct tl_topology *topology,
                              const struct tl_layer *piece, const struct tl_layer *other, const vec3d *x)
{
    double sum = 0, distance;
    for (size_t i = 0; i < piece->particle_count; i++) {
        uint32_t v = piece->particles[i];
        struct tl_layer_contact contact_pair = {.point = {{v, v, v}, {1, 0, 0}}};
        if (find_surface(layers, topology, other, x, &contact_pair, &distance))
            sum += distance;
    }
    return sum;
}

/* Assigns each piece to the layer above the highest piece that it lies outside of, by relaxation: `layer_of`
 * starts at 0 and each round raises pieces over those they lie outside of. A chain of n pieces needs n - 1
 * rounds. Pieces that lie outside of each other in a ring have no order; bounding layers by the round ends
 * the relaxation there. Returns the number of layers. */
static size_t assign_layers(const struct tl_layers *layers, const struct tl_topology *topology,
                            const struct tl_layer *pieces, size_t piece_count, const vec3d *x,
                            uint32_t *layer_of)
{
    double *outside = TL_NEW_ARRAY(double, piece_count *piece_count);
    for (size_t a = 0; a < piece_count; a++)
        for (size_t b = 0; b < piece_count; b++)
            if (a != b)
                outside[a * piece_count + b] = measure_outside(layers, topology, &pieces[a], &pieces[b], x);
    uint32_t highest = 0;
    for (size_t round = 1; round < piece_count; round++)
        for (size_t a = 0; a < piece_count; a++)
            for (size_t b = 0; b < piece_count; b++)
                if (outside[a * piece_count + b] > outside[b * piece_count + a] && layer_of[a] <= layer_of[b])
                    layer_of[a] = (uint32_t)fmin(layer_of[b] + 1, (double)round);
    for (size_t a = 0; a < piece_count; a++)
        highest = layer_of[a] > highest ? layer_of[a] : highest;
    free(outside);
    return (size_t)highest + 1;
}

/* Fills layer_of and layer_count: builds a collider for each piece, compares every pair and discards the
 * colliders. */
static bool order_pieces(struct tl_layers *layers, const struct tl_topology *topology, const uint32_t *pieces,
                         size_t piece_count, const vec3d *x, tl_error *error)
{
    struct tl_layer *surfaces = TL_NEW_ARRAY(struct tl_layer, piece_count);
    uint32_t *layer_of_piece = TL_NEW_ARRAY(uint32_t, piece_count);
    bool built = true;
    for (size_t p = 0; built && p < piece_count; p++)
        built = build_layer(&surfaces[p], topology, pieces, (uint32_t)p, x, error);
    if (built)
        layers->layer_count = assign_layers(layers, topology, surfaces, piece_count, x, layer_of_piece);
    for (size_t i = 0; i < topology->vertex_count; i++)
        layers->layer_of[i] = layer_of_piece[pieces[i]];
    for (size_t p = 0; p < piece_count; p++)
        release_layer(&surfaces[p]);
    free(surfaces);
    free(layer_of_piece);
    return built;
}

/* ---- Creation ---- */

void tl_layers_release(struct tl_layers *layers)
{
    for (size_t i = 0; layers->layers && i < layers->layer_count; i++)
        release_layer(&layers->layers[i]);
    free(layers->layers);
    free(layers->layer_of);
    free(layers->on_open_edge);
    free(layers->facing);
    free(layers->samples);
    free(layers->contacts);
    *layers = (struct tl_layers){0};
}

/* Every vertex, then the samples of coarse edges and triangles. */
static void make_probes(struct tl_layers *layers, const struct tl_topology *topology, const vec2s (*rest)[3])
{
    size_t between;
    struct tl_contact_sample *samples = tl_contact_samples_create(topology, rest, COARSE_M, &between);
    size_t count = topology->vertex_count;
    layers->samples = TL_NEW_ARRAY(struct tl_contact_sample, count + between);
    for (uint32_t i = 0; i < count; i++)
        layers->samples[i] = (struct tl_contact_sample){{i, i, i}, {1, 0, 0}};
    memcpy(layers->samples + count, samples, between * sizeof *samples);
    layers->sample_count = count + between;
    free(samples);
}

bool tl_layers_decide(struct tl_layers *layers, const struct tl_topology *topology, const vec2s (*rest)[3],
                      const tl_collider *avatar, const vec3d *x, tl_error *error)
{
    size_t count = topology->vertex_count;
    uint32_t *pieces = TL_NEW_ARRAY(uint32_t, count);
    *layers = (struct tl_layers){.ordered = true,
                                 .layer_of = TL_NEW_ARRAY(uint32_t, count),
                                 .on_open_edge = TL_NEW_ARRAY(bool, count),
                                 .facing = TL_NEW_ARRAY(signed char, topology->triangle_count)};
    size_t piece_count = tl_layers_pieces(topology, pieces);
    bool done = true;
    if (piece_count > 1 && piece_count <= TL_PIECES_MAX) {
        find_open_edges(layers, topology);
        find_facings(layers, topology, avatar, x);
        done = order_pieces(layers, topology, pieces, piece_count, x, error);
    }
    if (done && layers->layer_count > 1) {
        layers->layers = TL_NEW_ARRAY(struct tl_layer, layers->layer_count);
        make_probes(layers, topology, rest);
        layers->contacts =
            TL_NEW_ARRAY(struct tl_layer_contact, layers->sample_count * (layers->layer_count - 1));
    }
    for (size_t i = 0; done && layers->layers && i < layers->layer_count; i++)
        done = build_layer(&layers->layers[i], topology, layers->layer_of, (uint32_t)i, x, error);
    free(pieces);
    if (!done)
        tl_layers_release(layers);
    return done;
}

/* ---- Contact ---- */

/* Whether any vertex is further than AT_REST_M from its position in the layer's collider. */
static bool has_moved(const struct tl_layer *layer, const vec3d *x)
{
    double furthest = 0;
    for (size_t i = 0; i < layer->particle_count; i++) {
        vec3d moved = vec3d_sub(x[layer->particles[i]], vec3d_from(layer->positions[i]));
        furthest = fmax(furthest, vec3d_dot(moved, moved));
    }
    return furthest > AT_REST_M * AT_REST_M;
}

/* Whether x is within REACH_M of the box along each axis. */
static bool within(const struct tl_box *box, vec3d x)
{
    vec3d lower = vec3d_from(box->lower), upper = vec3d_from(box->upper);
    return x.x > lower.x - REACH_M && x.x < upper.x + REACH_M && x.y > lower.y - REACH_M &&
           x.y < upper.y + REACH_M && x.z > lower.z - REACH_M && x.z < upper.z + REACH_M;
}

/* Adds a contact for each probe of any other layer near layer `target`. A contact's normal points to the side
 * on which the probe's layer belongs: outwards if that layer lies above the target, else inwards. */
static void find_contacts(struct tl_layers *layers, const struct tl_topology *topology, uint32_t target,
                          const vec3d *x)
{
    const struct tl_layer *other = &layers->layers[target];
    struct tl_box box = tl_box_of(other->positions, other->particle_count);
    for (size_t i = 0; i < layers->sample_count; i++) {
        const struct tl_contact_sample *sample = &layers->samples[i];
        uint32_t own = layers->layer_of[sample->vertices[0]];
        struct tl_layer_contact contact_pair = {.point = *sample};
        double distance;
        if (own == target || !within(&box, tl_contact_sample_position(sample, x)) ||
            !find_surface(layers, topology, other, x, &contact_pair, &distance))
            continue;
        if (own < target)
            contact_pair.normal = vec3d_scale(contact_pair.normal, -1);
        layers->contacts[layers->contact_count++] = contact_pair;
    }
}

void tl_layers_forget(struct tl_layers *layers)
{
    layers->searched = false;
}

void tl_layers_update(struct tl_layers *layers, const struct tl_topology *topology, const vec3d *x)
{
    bool any = false;
    for (size_t i = 0; layers->layers && i < layers->layer_count; i++) {
        struct tl_layer *layer = &layers->layers[i];
        if (layers->searched && !has_moved(layer, x))
            continue;
        copy_positions(layer, x);
        tl_collider_move(layer->surface, layer->positions);
        any = true;
    }
    if (!any)
        return;
    layers->searched = true;
    layers->contact_count = 0;
    for (uint32_t i = 0; i < layers->layer_count; i++)
        find_contacts(layers, topology, i, x);
}

void tl_layers_solve(const struct tl_layers *layers, const struct tl_contact_params *params,
                     struct tl_particles *particles)
{
    struct tl_contact_params faster = *params;
    faster.push_out_speed = PUSH_OUT_SPEED;
    for (size_t i = 0; i < layers->contact_count; i++) {
        const struct tl_layer_contact *contact_pair = &layers->contacts[i];
        double inverse = tl_contact_sample_inverse_mass(&contact_pair->point, particles->w) +
                         tl_contact_sample_inverse_mass(&contact_pair->surface, particles->w);
        vec3d x = tl_contact_sample_position(&contact_pair->point, particles->x);
        vec3d before = tl_contact_sample_position(&contact_pair->point, particles->previous);
        vec3d surface = tl_contact_sample_position(&contact_pair->surface, particles->x);
        vec3d surface_before = tl_contact_sample_position(&contact_pair->surface, particles->previous);
        /* The push acts on the point and its opposite on the surface, divided by the sum of both effective
         * inverse masses: the relative displacement is the wanted one, and momentum is conserved. */
        vec3d allowed =
            tl_contact_push_out(x, before, surface, surface_before, contact_pair->normal, &faster);
        vec3d push = vec3d_sub(allowed, x);
        if (!(inverse > 0) || !(vec3d_dot(push, push) > 0))
            continue;
        tl_contact_sample_push(&contact_pair->point, vec3d_scale(push, 1 / inverse), particles->w,
                               particles->x);
        tl_contact_sample_push(&contact_pair->surface, vec3d_scale(push, -1 / inverse), particles->w,
                               particles->x);
    }
}
