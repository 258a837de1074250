/* Converts the lines of a panel, as a file lists them, to its outline. */
#include "assets/pattern/pattern_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Radii that are this much too short for their chord are roundings. */
#define RADIUS_TOLERANCE 1e-3
#define SHORTEST_EDGE_M  1e-6
#define SMALLEST_AREA_M2 1e-8

static struct tl_point scaled(struct tl_point point, double scale)
{
    return (struct tl_point){point.x * scale, point.y * scale};
}

/* ---- One edge ---- */

/* A curve of second degree as one of third. */
static struct tl_curve quadratic(struct tl_point a, struct tl_point control, struct tl_point b)
{
    return (struct tl_curve){.control = {a,
                                         {(a.x + 2 * control.x) / 3, (a.y + 2 * control.y) / 3},
                                         {(b.x + 2 * control.x) / 3, (b.y + 2 * control.y) / 3},
                                         b}};
}

/* An arc from a to b, with SVG's flags in axes with y up: one that bulges to the right turns to the left. */
static bool make_arc(const struct pattern_draft *draft, size_t index, struct tl_point a, struct tl_point b,
                     struct tl_pattern_edge *out, tl_error *error)
{
    const struct pattern_line *line = &draft->lines[index];
    double radius = line->radius * draft->scale, chord = hypot(b.x - a.x, b.y - a.y);
    if (!(radius * (1 + RADIUS_TOLERANCE) >= chord / 2))
        return tl_fail(
            error, TL_INPUT,
            "%s: edge %zu: an arc of radius %g does not reach over %g: make it at least half of it",
            draft->where, index, line->radius, chord / draft->scale);
    radius = fmax(radius, chord / 2);
    double turn = 2 * asin(chord / (2 * radius)), rise = sqrt(radius * radius - chord * chord / 4);
    double left = line->right == line->large ? -rise : rise; /* of the centre, from the chord */
    struct tl_point centre = {(a.x + b.x) / 2 - left * (b.y - a.y) / chord,
                              (a.y + b.y) / 2 + left * (b.x - a.x) / chord};
    turn = line->large ? 2 * M_PI - turn : turn;
    out->is_arc = true;
    out->centre = centre;
    out->radius = radius;
    out->start = atan2(a.y - centre.y, a.x - centre.x);
    out->sweep = line->right ? turn : -turn;
    return true;
}

static bool make_edge(const struct pattern_draft *draft, size_t index, struct tl_pattern_edge *out,
                      tl_error *error)
{
    const struct pattern_line *line = &draft->lines[index];
    struct tl_point a = scaled(draft->vertices[line->from], draft->scale);
    struct tl_point b = scaled(draft->vertices[line->to], draft->scale);
    struct tl_point c = scaled(line->control[0], draft->scale), d = scaled(line->control[1], draft->scale);
    if (!(hypot(b.x - a.x, b.y - a.y) > SHORTEST_EDGE_M))
        return tl_fail(error, TL_INPUT, "%s: edge %zu: begins where it ends: remove it", draft->where, index);
    if (line->kind == PATTERN_ARC)
        return make_arc(draft, index, a, b, out, error);
    out->curve = line->kind == PATTERN_LINE        ? tl_curve_line(a, b)
                 : line->kind == PATTERN_QUADRATIC ? quadratic(a, c, b)
                                                   : (struct tl_curve){.control = {a, c, d, b}};
    return true;
}

static void turn_round(struct tl_pattern_edge *edge)
{
    const struct tl_curve curve = edge->curve;
    for (int i = 0; i < 4; i++)
        edge->curve.control[i] = curve.control[3 - i];
    edge->start += edge->sweep;
    edge->sweep = -edge->sweep;
}

/* The mirror image in x = 0. */
static void mirror(struct tl_pattern_edge *edge)
{
    for (int i = 0; i < 4; i++)
        edge->curve.control[i].x = -edge->curve.control[i].x;
    edge->centre.x = -edge->centre.x;
    edge->start = M_PI - edge->start;
    edge->sweep = -edge->sweep;
}

double tl_pattern_edge_length(const struct tl_pattern_edge *edge)
{
    return edge->is_arc ? edge->radius * fabs(edge->sweep) : tl_curve_length(&edge->curve);
}

static struct tl_point arc_at(const struct tl_pattern_edge *edge, double t)
{
    double angle = edge->start + t * edge->sweep;
    return (struct tl_point){edge->centre.x + edge->radius * cos(angle),
                             edge->centre.y + edge->radius * sin(angle)};
}

struct tl_point tl_pattern_edge_start(const struct tl_pattern_edge *edge)
{
    return edge->is_arc ? arc_at(edge, 0) : edge->curve.control[0];
}

void tl_pattern_edge_divide(const struct tl_pattern_edge *edge, int segments, struct tl_point *out)
{
    struct tl_curve curve = edge->curve;
    curve.segments = segments;
    if (!edge->is_arc)
        tl_curve_divide(&curve, out);
    for (int n = 0; edge->is_arc && n < segments; n++)
        out[n] = arc_at(edge, (double)n / segments);
}

/* ---- The outline ---- */

/* Signed: negative for an outline that runs clockwise. */
static double signed_area(const struct tl_pattern_panel *panel)
{
    enum { SAMPLES = 32 };
    struct tl_point last = tl_pattern_edge_start(&panel->edges[0]), points[SAMPLES];
    double twice = 0;
    for (size_t e = 0; e < panel->edge_count; e++) {
        tl_pattern_edge_divide(&panel->edges[e], SAMPLES, points);
        for (int i = 0; i < SAMPLES; i++) {
            twice += last.x * points[i].y - points[i].x * last.y;
            last = points[i];
        }
    }
    struct tl_point first = tl_pattern_edge_start(&panel->edges[0]);
    return (twice + last.x * first.y - first.x * last.y) / 2;
}

double tl_pattern_panel_area(const struct tl_pattern_panel *panel)
{
    return fabs(signed_area(panel));
}

/* Walks from line to line, beginning with the first in its own direction: place[i] is line i's number on the
 * way, turned[i] whether it is walked backwards. */
static bool walk(const struct pattern_draft *draft, size_t *place, bool *turned, tl_error *error)
{
    bool *used = TL_NEW_ARRAY(bool, draft->line_count);
    size_t at = draft->lines[0].to, count = 1;
    used[0] = true;
    place[0] = 0;
    turned[0] = false;
    for (bool found = true; found && count < draft->line_count;) {
        found = false;
        for (size_t k = 0; k < draft->line_count && !found; k++) {
            size_t i = (count + k) % draft->line_count; /* mostly the next of the file */
            const struct pattern_line *line = &draft->lines[i];
            if (used[i] || (line->from != at && line->to != at))
                continue;
            found = used[i] = true;
            place[i] = count++;
            turned[i] = line->from != at;
            at = turned[i] ? line->from : line->to;
        }
    }
    free(used);
    if (count == draft->line_count && at == draft->lines[0].from)
        return true;
    return tl_fail(error, TL_INPUT,
                   "%s: its edges do not form one closed loop: edge 0 leads along %zu of %zu edges to vertex "
                   "%zu, not back to %zu",
                   draft->where, count, draft->line_count, at, draft->lines[0].from);
}

bool tl_pattern_outline(const struct pattern_draft *draft, struct tl_pattern_panel *panel, size_t *place,
                        tl_error *error)
{
    bool *turned = TL_NEW_ARRAY(bool, draft->line_count);
    bool good = walk(draft, place, turned, error);
    panel->edge_count = draft->line_count;
    panel->edges = TL_NEW_ARRAY(struct tl_pattern_edge, draft->line_count);
    for (size_t i = 0; good && i < draft->line_count; i++) {
        struct tl_pattern_edge *edge = &panel->edges[place[i]];
        good = make_edge(draft, i, edge, error);
        if (good && turned[i])
            turn_round(edge);
        edge->label = draft->lines[i].label;
        draft->lines[i].label = NULL;
    }
    free(turned);
    if (!good)
        return false;
    double area = signed_area(panel);
    if (!(fabs(area) > SMALLEST_AREA_M2))
        return tl_fail(error, TL_INPUT, "%s: its outline has no area inside", draft->where);
    for (size_t e = 0; area < 0 && e < panel->edge_count; e++)
        mirror(&panel->edges[e]);
    for (int k = 0; area < 0 && k < 3; k++)
        panel->across[k] = -panel->across[k];
    return true;
}
