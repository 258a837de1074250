#include "assets/cut/garment_cut.h"

#include "assets/base/version.h"
#include "assets/body/fit.h"
#include "assets/body/form.h"
#include "assets/cut/garment_cut_internal.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EDGE_MINIMUM_M 0.003f /* 130,000 vertices in the dress */
#define EDGE_MAXIMUM_M 0.08f
#define EDGE_FIRST_M   0.02f /* a finer cut starts from the shape of one with edges twice as long */

/* The reach of relaxation in the first cut, less far in finer ones: from neck to hem and back. Drafted
 * garments, which start farther from their shape, are relaxed for longer. */
#define REACH_M         4.0
#define REACH_DRAFTED_M 8.0

/* Garments for the form are scaled to other bodies, the others are drafted for each body. */
static const struct cut_kind {
    const char *name;
    struct tl_cut_plan (*for_form)(const struct tl_cut_params *);
    struct tl_cut_plan (*for_body)(const struct tl_body *, const struct tl_cut_params *);
    struct tl_cut_range (*form_longer)(void);
    struct tl_cut_range (*body_longer)(const struct tl_body *);
    bool has_sleeves;
} kinds[] = {
    {"dress", .for_form = tl_cut_plan_dress, .form_longer = tl_cut_longer_dress},
    {"skirt", .for_form = tl_cut_plan_skirt, .form_longer = tl_cut_longer_skirt},
    {"layers", .for_form = tl_cut_plan_layers, .form_longer = tl_cut_longer_dress},
    {"trousers", .for_body = tl_cut_plan_trousers, .body_longer = tl_cut_longer_trousers},
    {"shirt", .for_body = tl_cut_plan_shirt, .body_longer = tl_cut_longer_shirt, .has_sleeves = true},
};
const char *const tl_garment_names[] = {"dress", "skirt", "layers", "trousers", "shirt", NULL};

/* The pieces of a plan after cutting, and where their vertices begin in the garment. */
struct cutting {
    const struct tl_cut_plan *plan;
    tl_panel_mesh panels[TL_CUT_MAX_PIECES];
    size_t first_vertex[TL_CUT_MAX_PIECES + 1];
    double reach_m; /* of relaxation */
};

static struct tl_curve *half_curve(struct tl_cut_piece *piece, size_t curve)
{
    return &piece->half[curve < piece->half_count ? curve : tl_cut_mirror(piece, curve)];
}

/* Edges of about edge_m, and as many on both sides of each seam. */
static void choose_segments(struct tl_cut_plan *plan, double edge_m)
{
    for (size_t p = 0; p < plan->piece_count; p++) {
        for (size_t c = 0; c < plan->pieces[p].half_count; c++) {
            struct tl_curve *curve = &plan->pieces[p].half[c];
            curve->segments = (int)fmax(round(tl_curve_length(curve) / edge_m), 1);
        }
    }
    for (size_t s = 0; s < plan->seam_count; s++) {
        const struct tl_cut_seam *seam = &plan->seams[s];
        struct tl_curve *a = half_curve(&plan->pieces[seam->piece_a], seam->curve_a);
        struct tl_curve *b = half_curve(&plan->pieces[seam->piece_b], seam->curve_b);
        a->segments = b->segments = a->segments > b->segments ? a->segments : b->segments;
    }
}

static void cut_pieces(struct cutting *cutting, double edge_m)
{
    for (size_t p = 0; p < cutting->plan->piece_count; p++) {
        const struct tl_cut_piece *piece = &cutting->plan->pieces[p];
        struct tl_curve outline[2 * TL_CUT_MAX_HALF];
        const size_t curves = piece->whole ? piece->half_count : 2 * piece->half_count;
        for (size_t c = 0; c < curves; c++)
            outline[c] = c < piece->half_count ? piece->half[c]
                                               : tl_cut_mirrored_curve(&piece->half[tl_cut_mirror(piece, c)]);
        cutting->panels[p] = tl_panel_cut(outline, curves, edge_m);
        cutting->first_vertex[p + 1] = cutting->first_vertex[p] + cutting->panels[p].point_count;
    }
}

static size_t curve_segments(const struct cutting *cutting, size_t piece_index, size_t curve)
{
    const struct tl_cut_piece *piece = &cutting->plan->pieces[piece_index];
    return (size_t)piece->half[curve < piece->half_count ? curve : tl_cut_mirror(piece, curve)].segments;
}

/* The garment's vertex at division `n` of an outline's curve. */
static uint32_t outline_vertex(const struct cutting *cutting, size_t piece_index, size_t curve, size_t n)
{
    size_t point = n;
    for (size_t c = 0; c < curve; c++)
        point += curve_segments(cutting, piece_index, c);
    assert(cutting->panels[piece_index].outline_count > 0);
    point %= cutting->panels[piece_index].outline_count;
    return (uint32_t)(cutting->first_vertex[piece_index] + point);
}

/* The two legs of a dart share their tip, which needs no stitch, so fewer pairs may be used than counted. */
static void sew(const struct cutting *cutting, tl_garment *garment)
{
    const struct tl_cut_plan *plan = cutting->plan;
    size_t maximum = 0;
    for (size_t s = 0; s < plan->seam_count; s++)
        maximum += curve_segments(cutting, plan->seams[s].piece_a, plan->seams[s].curve_a) + 1;
    garment->seams = TL_NEW_ARRAY(struct tl_seam_pair, maximum);
    for (size_t s = 0; s < plan->seam_count; s++) {
        const struct tl_cut_seam *seam = &plan->seams[s];
        size_t segments = curve_segments(cutting, seam->piece_a, seam->curve_a);
        for (size_t n = 0; n <= segments; n++) {
            uint32_t a = outline_vertex(cutting, seam->piece_a, seam->curve_a, n);
            uint32_t b = outline_vertex(cutting, seam->piece_b, seam->curve_b, segments - n);
            if (a != b)
                garment->seams[garment->seam_count++] = (struct tl_seam_pair){a, b};
        }
    }
}

static void pin(const struct cutting *cutting, tl_garment *garment)
{
    const struct tl_cut_plan *plan = cutting->plan;
    bool *pinned = TL_NEW_ARRAY(bool, cutting->first_vertex[plan->piece_count]);
    for (size_t i = 0; i < plan->pin_count; i++) {
        size_t segments = curve_segments(cutting, plan->pins[i].piece, plan->pins[i].curve);
        for (size_t n = 0; n <= segments; n++)
            pinned[outline_vertex(cutting, plan->pins[i].piece, plan->pins[i].curve, n)] = true;
    }
    size_t vertex_count = cutting->first_vertex[plan->piece_count];
    for (size_t v = 0; v < vertex_count; v++)
        garment->pin_count += pinned[v];
    garment->pins = TL_NEW_ARRAY(uint32_t, garment->pin_count);
    size_t next = 0;
    for (size_t v = 0; v < vertex_count; v++) {
        if (pinned[v])
            garment->pins[next++] = (uint32_t)v;
    }
    free(pinned);
}

static tl_material cut_material(const char *name)
{
    tl_material material = tl_material_default(name);
    material.diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
    material.double_sided = true;
    return material;
}

/* One part a material, of the same number. */
static void part_materials(const struct cutting *cutting, tl_model *model)
{
    const struct tl_cut_plan *plan = cutting->plan;
    tl_mesh *mesh = &model->mesh;
    uint32_t next = 0;
    mesh->parts = TL_NEW_ARRAY(struct tl_mesh_part, plan->piece_count);
    model->materials = TL_NEW_ARRAY(tl_material, plan->piece_count);
    for (size_t p = 0; p < plan->piece_count; p++) {
        const char *name = plan->pieces[p].material;
        uint32_t index_count = 3 * (uint32_t)cutting->panels[p].triangle_count;
        if (p == 0 || strcmp(name, plan->pieces[p - 1].material) != 0) {
            model->materials[mesh->part_count] = cut_material(name);
            mesh->parts[mesh->part_count] =
                (struct tl_mesh_part){.first_index = next, .material = (int)mesh->part_count, .uv_metres = 1};
            model->material_count = ++mesh->part_count;
        }
        mesh->parts[mesh->part_count - 1].index_count += index_count;
        next += index_count;
    }
}

/* Flat pattern, UVs and triangles of all pieces. */
static void lay_out(const struct cutting *cutting, tl_garment *garment)
{
    const struct tl_cut_plan *plan = cutting->plan;
    tl_mesh *mesh = &garment->model.mesh;
    mesh->vertex_count = cutting->first_vertex[plan->piece_count];
    for (size_t p = 0; p < plan->piece_count; p++)
        mesh->index_count += 3 * cutting->panels[p].triangle_count;
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    garment->pattern = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    size_t next = 0;
    for (size_t p = 0; p < plan->piece_count; p++) {
        const tl_panel_mesh *panel = &cutting->panels[p];
        struct tl_point offset = plan->pieces[p].table_offset;
        for (size_t i = 0; i < panel->point_count; i++) {
            vec2s at = {{(float)(panel->points[i].x + offset.x), (float)(panel->points[i].y + offset.y)}};
            garment->pattern[cutting->first_vertex[p] + i] = at;
            mesh->uvs[cutting->first_vertex[p] + i] = (vec2s){{at.x, -at.y}};
        }
        for (size_t t = 0; t < panel->triangle_count; t++) {
            for (int k = 0; k < 3; k++)
                mesh->indices[next++] = (uint32_t)cutting->first_vertex[p] + panel->triangles[t][k];
        }
    }
    part_materials(cutting, &garment->model);
}

/* body[v]: which of the sewn-together points vertex v belongs to; returns how many points there are. */
static size_t join_seams(const tl_garment *garment, uint32_t *body)
{
    size_t count = garment->model.mesh.vertex_count;
    for (size_t v = 0; v < count; v++)
        body[v] = (uint32_t)v;
    /* Chains of seams are short (four pieces meet in a corner), so a few passes of minima converge. */
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t s = 0; s < garment->seam_count; s++) {
            uint32_t *a = &body[garment->seams[s].a], *b = &body[garment->seams[s].b];
            changed |= *a != *b;
            *a = *b = *a < *b ? *a : *b;
        }
    }
    size_t bodies = 0;
    for (size_t v = 0; v < count; v++)
        body[v] = body[v] == v ? (uint32_t)bodies++ : body[body[v]];
    return bodies;
}

static double pattern_distance(const tl_garment *garment, uint32_t a, uint32_t b)
{
    return (double)glms_vec2_distance(garment->pattern[a], garment->pattern[b]);
}

/* Every triangle's sides as springs. An inner side occurs twice and so has twice the weight. */
static struct tl_fit_edge *fit_edges(const tl_garment *garment, const uint32_t *body)
{
    const tl_mesh *mesh = &garment->model.mesh;
    struct tl_fit_edge *edges = TL_NEW_ARRAY(struct tl_fit_edge, mesh->index_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = mesh->indices[i], b = mesh->indices[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = (struct tl_fit_edge){body[a], body[b], pattern_distance(garment, a, b)};
    }
    return edges;
}

/* The start position of every vertex, by the placement of its piece. */
static void hold(const struct cutting *cutting, double (*held)[3])
{
    for (size_t p = 0; p < cutting->plan->piece_count; p++) {
        const struct tl_cut_piece *piece = &cutting->plan->pieces[p];
        for (size_t i = 0; i < cutting->panels[p].point_count; i++)
            piece->place(piece->context, cutting->panels[p].points[i], held[cutting->first_vertex[p] + i]);
    }
}

/* Places the pieces with their seams closed: vertices sewn together start at one position, the mean of those
 * of their pieces, or their position on a coarser cut (coarser edge 0: there is none). */
static void place(const struct cutting *cutting, const tl_garment *coarse, double coarse_edge_m,
                  tl_garment *garment)
{
    const bool carries = coarse_edge_m > 0;
    size_t count = garment->model.mesh.vertex_count;
    double(*held)[3] = tl_alloc(count, sizeof *held);
    hold(cutting, held);
    if (carries)
        tl_cut_carry(coarse, coarse_edge_m, garment, held);
    uint32_t *body = TL_NEW_ARRAY(uint32_t, count);
    size_t bodies = join_seams(garment, body);
    double(*position)[3] = tl_alloc(bodies, sizeof *position);
    int *members = TL_NEW_ARRAY(int, bodies);
    bool *fixed = TL_NEW_ARRAY(bool, bodies);
    for (size_t v = 0; v < count; v++) {
        members[body[v]]++;
        for (int k = 0; k < 3; k++)
            position[body[v]][k] += (held[v][k] - position[body[v]][k]) / members[body[v]];
    }
    for (size_t i = 0; i < garment->pin_count; i++)
        fixed[body[garment->pins[i]]] = true;
    struct tl_fit_edge *edges = fit_edges(garment, body);
    tl_cut_fit(position, bodies, fixed, edges, garment->model.mesh.index_count,
               carries ? 0 : cutting->reach_m, cutting->plan->distance, cutting->plan->keeps_sides);
    for (size_t v = 0; v < count; v++) {
        const double *at = position[body[v]];
        garment->model.mesh.positions[v] = (vec3s){{(float)at[0], (float)at[1], (float)at[2]}};
    }
    free(edges);
    free(fixed);
    free(members);
    free(position);
    free(body);
    free(held);
}

/* Area-weighted, smooth across seams. */
static void fill_normals(tl_garment *garment)
{
    tl_mesh *mesh = &garment->model.mesh;
    uint32_t *body = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    vec3s *sums = TL_NEW_ARRAY(vec3s, join_seams(garment, body));
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
        vec3s other = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
        vec3s area = glms_vec3_cross(side, other);
        for (int k = 0; k < 3; k++)
            sums[body[v[k]]] = glms_vec3_add(sums[body[v[k]]], area);
    }
    for (size_t v = 0; v < mesh->vertex_count; v++)
        mesh->normals[v] = glms_vec3_normalize(sums[body[v]]);
    free(sums);
    free(body);
}

static double form_distance(const void *context, const double point[3])
{
    (void)context;
    return tl_form_distance(point);
}

/* The measures that a garment is cut to. */
struct cut_order {
    const struct cut_kind *kind;
    const struct tl_body *body; /* NULL: the form */
    const struct tl_cut_params *sizes;
};

static struct tl_cut_plan make_plan(const struct cut_order *order)
{
    const struct tl_body *body = order->body;
    struct tl_cut_plan plan =
        body ? order->kind->for_body(body, order->sizes) : order->kind->for_form(order->sizes);
    plan.distance = body ? body->distance : (struct tl_body_distance){form_distance, NULL};
    return plan;
}

/* Bounds of the start shape around the form. */
static struct tl_cache_key key_of(const struct cut_order *order, float edge_m)
{
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_BUILTIN_VERSION, sizeof TL_BUILTIN_VERSION);
    tl_cache_key_add(&key, order->kind->name, strlen(order->kind->name));
    tl_cache_key_add(&key, order->sizes, sizeof *order->sizes);
    tl_cache_key_add(&key, &edge_m, sizeof edge_m);
    return key;
}

static void cut(const struct cut_order *order, float edge_m, tl_garment *out);

/* Start shapes around other bodies are not kept: hashing a body takes long. */
static void place_or_restore(const struct cut_order *order, const struct cutting *cutting, float edge_m,
                             tl_garment *out)
{
    const float coarse_edge_m = edge_m < EDGE_FIRST_M ? 2 * edge_m : 0;
    const struct tl_cache_key key = key_of(order, edge_m);
    tl_mesh *mesh = &out->model.mesh;
    const size_t bytes = mesh->vertex_count * sizeof *mesh->positions;
    tl_garment coarse = {0};
    if (!order->body && tl_cache_read(&key, mesh->positions, bytes))
        return;
    if (coarse_edge_m > 0)
        cut(order, coarse_edge_m, &coarse);
    place(cutting, &coarse, (double)coarse_edge_m, out);
    tl_garment_release(&coarse);
    if (!order->body)
        tl_cache_store(&key, mesh->positions, bytes);
}

static void cut(const struct cut_order *order, float edge_m, tl_garment *out)
{
    const struct cut_kind *kind = order->kind;
    struct tl_cut_plan plan = make_plan(order);
    struct cutting cutting = {.plan = &plan, .reach_m = kind->for_body ? REACH_DRAFTED_M : REACH_M};
    choose_segments(&plan, (double)edge_m);
    cut_pieces(&cutting, (double)edge_m);
    *out = (tl_garment){.model = {.name = tl_copy_string(kind->name)}};
    lay_out(&cutting, out);
    sew(&cutting, out);
    pin(&cutting, out);
    place_or_restore(order, &cutting, edge_m, out);
    fill_normals(out);
    for (size_t p = 0; p < plan.piece_count; p++)
        tl_panel_release(&cutting.panels[p]);
    free(plan.placement);
}

/* NULL when the name is unknown or the edge is out of range. */
static const struct cut_kind *choose(const char *name, float edge_m, tl_error *error)
{
    size_t chosen = 0;
    while (chosen < TL_COUNT(kinds) && strcmp(name, kinds[chosen].name) != 0)
        chosen++;
    if (chosen == TL_COUNT(kinds)) {
        char names[256] = "";
        for (size_t i = 0; i < TL_COUNT(kinds); i++) {
            size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", kinds[i].name);
        }
        (void)tl_fail(error, TL_USAGE,
                      "garment \"%s\": no built-in garment has this name: choose one of %s, or name a "
                      ".glb or .gltf file",
                      name, names);
        return NULL;
    }
    if (!(edge_m >= EDGE_MINIMUM_M && edge_m <= EDGE_MAXIMUM_M)) {
        (void)tl_fail(error, TL_USAGE, "garment \"%s\": an edge of %g m: choose one from %g to %g m", name,
                      (double)edge_m, (double)EDGE_MINIMUM_M, (double)EDGE_MAXIMUM_M);
        return NULL;
    }
    return &kinds[chosen];
}

/* A request is refused, not trimmed: a size is a measure that somebody relies on. */
static bool check_length(const char *option, double requested, struct tl_cut_range range,
                         const struct cut_kind *kind, tl_error *error)
{
    const double rounding = 1e-6;
    if (requested >= range.minimum - rounding && requested <= range.maximum + rounding)
        return true;
    bool is_short = requested < range.minimum;
    /* The limit to the millimetre, inwards: what is printed is accepted. */
    double limit = is_short ? ceil(range.minimum * 1e3) / 1e3 : floor(range.maximum * 1e3) / 1e3;
    return tl_fail(error, TL_USAGE, "%s: %g m: the %s for this body can have no %s than %g m", option,
                   requested, kind->name, is_short ? "less" : "more", limit + 0.0);
}

static bool check_sizes(const struct cut_order *order, tl_error *error)
{
    const struct cut_kind *kind = order->kind;
    struct tl_cut_range longer = order->body ? kind->body_longer(order->body) : kind->form_longer();
    if (!check_length("cut.longer_m", (double)order->sizes->longer_m, longer, kind, error))
        return false;
    return !kind->has_sleeves || check_length("cut.sleeve_m", (double)order->sizes->sleeve_m,
                                              tl_cut_longer_sleeves(order->body), kind, error);
}

static bool cut_for(const struct cut_kind *kind, float edge_m, const struct tl_cut_params *sizes,
                    const struct tl_wearer *wearer, tl_garment *out, tl_error *error)
{
    struct tl_body body;
    const struct cut_order order = {kind, &body, sizes};
    if (!tl_body_measure(wearer->name, wearer->mesh, wearer->distance, &body, error))
        return false;
    if (kind->has_sleeves && !(body.underarm_y > 0))
        return tl_fail(error, TL_INPUT,
                       "%s: has no arms that hang beside the trunk, so no shirt is cut for it", wearer->name);
    if (!check_sizes(&order, error))
        return false;
    cut(&order, edge_m, out);
    return true;
}

static double figure_distance(const void *context, const double point[3])
{
    (void)context;
    return tl_figure_distance(point);
}

bool tl_garment_is_for_figure(const char *name)
{
    for (size_t i = 0; i < TL_COUNT(kinds); i++)
        if (strcmp(name, kinds[i].name) == 0)
            return kinds[i].for_body != NULL;
    return false;
}

static bool cut_for_figure(const struct cut_kind *kind, float edge_m, const struct tl_cut_params *sizes,
                           tl_garment *out, tl_error *error)
{
    tl_avatar figure = tl_avatar_figure();
    const struct tl_wearer wearer = {"figure", &figure.model.mesh, {figure_distance, NULL}, false};
    bool good = cut_for(kind, edge_m, sizes, &wearer, out, error);
    tl_avatar_release(&figure);
    return good;
}

bool tl_garment_cut_sized(const char *name, float edge_m, const struct tl_cut_params *sizes,
                          const struct tl_wearer *wearer, tl_garment *out, tl_error *error)
{
    const struct cut_kind *kind = choose(name, edge_m, error);
    if (!kind)
        return false;
    if (kind->for_body)
        return wearer ? cut_for(kind, edge_m, sizes, wearer, out, error)
                      : cut_for_figure(kind, edge_m, sizes, out, error);
    const struct cut_order order = {kind, NULL, sizes};
    if (!check_sizes(&order, error))
        return false;
    cut(&order, edge_m, out);
    if (!wearer || tl_garment_fit(out, wearer->name, wearer->mesh, wearer->refits, error))
        return true;
    tl_garment_release(out);
    return false;
}

static const struct tl_cut_params as_drafted;

bool tl_garment_cut(const char *name, float edge_m, tl_garment *out, tl_error *error)
{
    return tl_garment_cut_sized(name, edge_m, &as_drafted, NULL, out, error);
}

bool tl_garment_cut_for(const char *name, float edge_m, const struct tl_wearer *wearer, tl_garment *out,
                        tl_error *error)
{
    return tl_garment_cut_sized(name, edge_m, &as_drafted, wearer, out, error);
}
