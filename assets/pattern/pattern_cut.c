#include "assets/pattern/pattern_cut.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Between panels on the cutting table. */
#define TABLE_GAP_M 0.05
/* An edge a little longer than a whole number of segments is not divided once more. */
#define SEGMENT_SLACK 0.3
/* A narrow curved panel whose outline crosses itself when it is divided so coarsely is divided twice as
 * finely so often. */
#define REFINEMENTS 4

struct pattern_cutting {
    const tl_pattern *pattern;
    double edge_m;
    size_t *first_edge; /* [panel_count + 1] of the panel, in `segments` */
    int *segments;      /* of each edge of each panel */
    tl_panel_mesh *panels;
    size_t *first_vertex; /* [panel_count + 1] */
};

/* ---- Segments ---- */

static int *segments_of(const struct pattern_cutting *cutting, const struct tl_pattern_side *side)
{
    return &cutting->segments[cutting->first_edge[side->panel] + side->edge];
}

/* Makes as many segments on both sides of each stitch; an edge may be in several stitches. */
static void agree(const struct pattern_cutting *cutting)
{
    const tl_pattern *pattern = cutting->pattern;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t s = 0; s < pattern->stitch_count; s++) {
            int *a = segments_of(cutting, &pattern->stitches[s].sides[0]);
            int *b = segments_of(cutting, &pattern->stitches[s].sides[1]);
            changed |= *a != *b;
            *a = *b = *a > *b ? *a : *b;
        }
    }
}

static void choose_segments(const struct pattern_cutting *cutting)
{
    for (size_t p = 0; p < cutting->pattern->panel_count; p++) {
        const struct tl_pattern_panel *panel = &cutting->pattern->panels[p];
        int minimum = panel->edge_count == 2 ? 2 : 1; /* two edges of one segment would be one line */
        for (size_t e = 0; e < panel->edge_count; e++) {
            double count = ceil(tl_pattern_edge_length(&panel->edges[e]) / cutting->edge_m - SEGMENT_SLACK);
            cutting->segments[cutting->first_edge[p] + e] =
                (int)fmin(fmax(count, minimum), (double)TL_LIMIT_PATTERN_VERTICES);
        }
    }
    agree(cutting);
}

/* ---- Panels ---- */

/* The outline's points; their number is the sum of the segments. */
static struct tl_point *divide(const struct pattern_cutting *cutting, size_t p, size_t *count)
{
    const struct tl_pattern_panel *panel = &cutting->pattern->panels[p];
    const int *segments = &cutting->segments[cutting->first_edge[p]];
    *count = 0;
    for (size_t e = 0; e < panel->edge_count; e++)
        *count += (size_t)segments[e];
    struct tl_point *points = TL_NEW_ARRAY(struct tl_point, *count);
    size_t next = 0;
    for (size_t e = 0; e < panel->edge_count; e++) {
        tl_pattern_edge_divide(&panel->edges[e], segments[e], points + next);
        next += (size_t)segments[e];
    }
    return points;
}

static void find_bounds(const struct tl_point *points, size_t count, struct tl_point *lower,
                        struct tl_point *upper)
{
    *lower = *upper = points[0];
    for (size_t i = 1; i < count; i++) {
        *lower = (struct tl_point){fmin(lower->x, points[i].x), fmin(lower->y, points[i].y)};
        *upper = (struct tl_point){fmax(upper->x, points[i].x), fmax(upper->y, points[i].y)};
    }
}

/* Checks that outlines, and the grids that fill their boxes, are not too many points. */
static bool check_size(const struct pattern_cutting *cutting, tl_error *error)
{
    const tl_pattern *pattern = cutting->pattern;
    double total = 0;
    for (size_t e = 0; e < cutting->first_edge[pattern->panel_count]; e++)
        total += cutting->segments[e];
    for (size_t p = 0; p < pattern->panel_count && total <= (double)TL_LIMIT_PATTERN_VERTICES; p++) {
        struct tl_point lower, upper;
        size_t count;
        struct tl_point *points = divide(cutting, p, &count);
        find_bounds(points, count, &lower, &upper);
        free(points);
        total += (upper.x - lower.x + cutting->edge_m) * (upper.y - lower.y + cutting->edge_m) /
                 (cutting->edge_m * cutting->edge_m);
    }
    if (total <= (double)TL_LIMIT_PATTERN_VERTICES)
        return true;
    return tl_fail(error, TL_USAGE,
                   "%s: edges of %g m would make more than %zu vertices: choose longer ones: "
                   "cloth.edge_m",
                   pattern->name, cutting->edge_m, TL_LIMIT_PATTERN_VERTICES);
}

/* Cuts all panels, from the first; returns how many could be. */
static size_t fill_panels(struct pattern_cutting *cutting)
{
    size_t panel_count = cutting->pattern->panel_count, p = 0;
    for (bool good = true; good && p < panel_count; p += good) {
        size_t count;
        struct tl_point *points = divide(cutting, p, &count);
        tl_panel_release(&cutting->panels[p]);
        good = tl_panel_fill(points, count, cutting->edge_m, &cutting->panels[p]);
        free(points);
        cutting->first_vertex[p + 1] = cutting->first_vertex[p] + cutting->panels[p].point_count;
    }
    return p;
}

static bool cut_panels(struct pattern_cutting *cutting, tl_error *error)
{
    const tl_pattern *pattern = cutting->pattern;
    choose_segments(cutting);
    for (int attempt = 0;; attempt++) {
        if (!check_size(cutting, error))
            return false;
        size_t failed = fill_panels(cutting);
        if (failed == pattern->panel_count)
            return true;
        if (attempt == REFINEMENTS)
            return tl_fail(error, TL_INPUT,
                           "%s: panel \"%s\": its outline crosses or touches itself: change the pattern",
                           pattern->name, pattern->panels[failed].name);
        for (size_t e = cutting->first_edge[failed]; e < cutting->first_edge[failed + 1]; e++)
            cutting->segments[e] *= 2;
        agree(cutting);
    }
}

/* ---- The garment ---- */

/* Panels side by side on the table, as they lie in their own axes. */
static void lay_out(const struct pattern_cutting *cutting, tl_garment *garment)
{
    tl_mesh *mesh = &garment->model.mesh;
    double table = 0;
    size_t next = 0;
    for (size_t p = 0; p < cutting->pattern->panel_count; p++) {
        const struct tl_pattern_panel *panel = &cutting->pattern->panels[p];
        const tl_panel_mesh *cut = &cutting->panels[p];
        struct tl_point lower, upper;
        find_bounds(cut->points, cut->outline_count, &lower, &upper);
        const double normal[3] = {panel->across[1] * panel->up[2] - panel->across[2] * panel->up[1],
                                  panel->across[2] * panel->up[0] - panel->across[0] * panel->up[2],
                                  panel->across[0] * panel->up[1] - panel->across[1] * panel->up[0]};
        for (size_t i = 0; i < cut->point_count; i++) {
            size_t v = cutting->first_vertex[p] + i;
            struct tl_point at = cut->points[i];
            for (int k = 0; k < 3; k++) {
                mesh->positions[v].raw[k] =
                    (float)(panel->origin[k] + at.x * panel->across[k] + at.y * panel->up[k]);
                mesh->normals[v].raw[k] = (float)normal[k];
            }
            vec2s flat = {{(float)(at.x - lower.x + table), (float)(at.y - lower.y)}};
            garment->pattern[v] = flat;
            mesh->uvs[v] = (vec2s){{flat.x, -flat.y}};
        }
        table += upper.x - lower.x + TABLE_GAP_M;
        for (size_t t = 0; t < cut->triangle_count; t++)
            for (int k = 0; k < 3; k++)
                mesh->indices[next++] = (uint32_t)cutting->first_vertex[p] + cut->triangles[t][k];
    }
}

static void add_parts(const struct pattern_cutting *cutting, tl_model *model)
{
    size_t count = cutting->pattern->panel_count;
    uint32_t next = 0;
    model->material_count = model->mesh.part_count = count;
    model->materials = TL_NEW_ARRAY(tl_material, count);
    model->mesh.parts = TL_NEW_ARRAY(struct tl_mesh_part, count);
    for (size_t p = 0; p < count; p++) {
        uint32_t index_count = 3 * (uint32_t)cutting->panels[p].triangle_count;
        model->materials[p] = tl_material_default(cutting->pattern->panels[p].name);
        model->materials[p].diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
        model->materials[p].double_sided = true;
        model->mesh.parts[p] = (struct tl_mesh_part){next, index_count, (int)p, 1};
        next += index_count;
    }
}

/* The garment's vertex at division n of an edge, counted from its start. */
static uint32_t edge_vertex(const struct pattern_cutting *cutting, const struct tl_pattern_side *side,
                            size_t n)
{
    size_t point = n, first = cutting->first_edge[side->panel];
    for (size_t e = 0; e < side->edge; e++)
        point += (size_t)cutting->segments[first + e];
    point %= cutting->panels[side->panel].outline_count;
    return (uint32_t)(cutting->first_vertex[side->panel] + point);
}

/* The two legs of a dart share their tip, which needs no stitch. */
static void sew(const struct pattern_cutting *cutting, tl_garment *garment)
{
    const tl_pattern *pattern = cutting->pattern;
    size_t maximum = 0;
    for (size_t s = 0; s < pattern->stitch_count; s++)
        maximum += (size_t)*segments_of(cutting, &pattern->stitches[s].sides[0]) + 1;
    garment->seams = TL_NEW_ARRAY(struct tl_seam_pair, maximum);
    for (size_t s = 0; s < pattern->stitch_count; s++) {
        const struct tl_pattern_stitch *stitch = &pattern->stitches[s];
        size_t segments = (size_t)*segments_of(cutting, &stitch->sides[0]);
        for (size_t n = 0; n <= segments; n++) {
            uint32_t a = edge_vertex(cutting, &stitch->sides[0], n);
            uint32_t b = edge_vertex(cutting, &stitch->sides[1], stitch->right_wrong ? n : segments - n);
            if (a != b)
                garment->seams[garment->seam_count++] = (struct tl_seam_pair){a, b};
        }
    }
}

/* Leaves a neck line free where it meets that of the other half: both would draw it to their sides. */
static bool is_centre(const struct pattern_cutting *cutting, const struct tl_pattern_side *side, bool end)
{
    const struct tl_pattern_panel *panel = &cutting->pattern->panels[side->panel];
    const struct tl_pattern_edge *edge = &panel->edges[(side->edge + (end ? 1 : 0)) % panel->edge_count];
    struct tl_point at = tl_pattern_edge_start(edge);
    double x = panel->origin[0] + at.x * panel->across[0] + at.y * panel->up[0];
    return fabs(x) < cutting->edge_m / 2;
}

static void hold(const struct pattern_cutting *cutting, tl_garment *garment)
{
    const tl_pattern *pattern = cutting->pattern;
    for (size_t p = 0; p < pattern->panel_count; p++)
        for (size_t e = 0; e < pattern->panels[p].edge_count; e++) {
            const struct tl_pattern_hold *rule = &pattern->panels[p].edges[e].hold;
            const struct tl_pattern_side side = {p, e};
            size_t count = rule->is_set ? (size_t)*segments_of(cutting, &side) + 1 : 0;
            garment->holds = tl_resize(garment->holds, garment->hold_count + count, sizeof *garment->holds);
            for (size_t n = 0; n < count; n++) {
                bool ends = n == 0 || n + 1 == count;
                if (rule->side != 0 && ends && is_centre(cutting, &side, n > 0))
                    continue;
                garment->holds[garment->hold_count++] = (struct tl_hold){
                    edge_vertex(cutting, &side, n), rule->axis, rule->side, (float)rule->level};
            }
        }
}

static void make_garment(const struct pattern_cutting *cutting, tl_garment *out)
{
    tl_mesh *mesh = &out->model.mesh;
    *out = (tl_garment){.model = {.name = tl_copy_string(cutting->pattern->name)}, .welds_seams_only = true};
    mesh->vertex_count = cutting->first_vertex[cutting->pattern->panel_count];
    for (size_t p = 0; p < cutting->pattern->panel_count; p++)
        mesh->index_count += 3 * cutting->panels[p].triangle_count;
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    out->pattern = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    lay_out(cutting, out);
    add_parts(cutting, &out->model);
    sew(cutting, out);
    hold(cutting, out);
}

bool tl_pattern_cut(const tl_pattern *pattern, float edge_m, tl_garment *out, tl_error *error)
{
    struct pattern_cutting cutting = {.pattern = pattern, .edge_m = (double)edge_m};
    *out = (tl_garment){0};
    if (!(edge_m > 0))
        return tl_fail(error, TL_USAGE, "%s: edges of %g m: choose a cloth.edge_m above 0", pattern->name,
                       (double)edge_m);
    cutting.first_edge = TL_NEW_ARRAY(size_t, pattern->panel_count + 1);
    cutting.first_vertex = TL_NEW_ARRAY(size_t, pattern->panel_count + 1);
    cutting.panels = TL_NEW_ARRAY(tl_panel_mesh, pattern->panel_count);
    for (size_t p = 0; p < pattern->panel_count; p++)
        cutting.first_edge[p + 1] = cutting.first_edge[p] + pattern->panels[p].edge_count;
    cutting.segments = TL_NEW_ARRAY(int, cutting.first_edge[pattern->panel_count]);
    bool good = cut_panels(&cutting, error);
    if (good)
        make_garment(&cutting, out);
    for (size_t p = 0; p < pattern->panel_count; p++)
        tl_panel_release(&cutting.panels[p]);
    free(cutting.segments);
    free(cutting.panels);
    free(cutting.first_vertex);
    free(cutting.first_edge);
    return good;
}
