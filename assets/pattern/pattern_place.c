#include "assets/pattern/pattern_place.h"

#include "assets/body/fit.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/yaml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The distance by which panels at the waist are moved towards the body. */
#define INSET_M 0.015
/* GarmentCode hangs a shirt so that its top is so far below the shoulders, which it then falls over. */
#define BELOW_SHOULDER_M 0.05
/* Share of the average body's height (GarmentCode's mean_all: 1.457 of 1.720 m). */
#define SHOULDER_SHARE 0.847
#define ARMSCYE_SHARE  0.075
#define NECK_SHARE     0.11
/* Neck lines may lie so far inside the neck's own width on either side. */
#define NECK_EASE_M 0.01
/* The vertical part of a panel's y axis: less, and it is turned. */
#define UPRIGHT                0.98
#define TL_LIMIT_MEASURE_BYTES ((size_t)1 << 20)

/* ---- Measures ---- */

static void take_measure(struct tl_pattern_measures *measures, const char *key, const char *text)
{
    const struct {
        const char *key;
        double *value;
    } known[] = {{"height", &measures->height},
                 {"head_l", &measures->head},
                 {"waist_line", &measures->waist_line},
                 {"armscye_depth", &measures->armscye},
                 {"neck_w", &measures->neck}};
    char *end;
    double cm = strtod(text, &end);
    for (size_t i = 0; i < TL_COUNT(known); i++)
        if (strcmp(key, known[i].key) == 0 && end != text && *end == '\0' && cm > 0 && cm < 1000)
            *known[i].value = cm / 100;
}

struct measure_reader {
    struct tl_yaml yaml;
    struct tl_pattern_measures *out;
};

/* Reads all scalars of the file that have a scalar key, in whatever mapping they stand: `body:` is the only
 * one of such a file. */
static bool read_measures(void *context)
{
    struct measure_reader *reader = context;
    struct tl_yaml *yaml = &reader->yaml;
    char *key = NULL;
    int depth = 0;
    bool good = true;
    for (;;) {
        yaml_event_type_t type = yaml->event.type;
        bool opens = type == YAML_MAPPING_START_EVENT || type == YAML_SEQUENCE_START_EVENT;
        bool closes = type == YAML_MAPPING_END_EVENT || type == YAML_SEQUENCE_END_EVENT;
        depth += opens - closes;
        bool is_value = key != NULL;
        if (is_value && type == YAML_SCALAR_EVENT)
            take_measure(reader->out, key, tl_yaml_text(yaml));
        free(key);
        key = !is_value && type == YAML_SCALAR_EVENT ? tl_copy_string(tl_yaml_text(yaml)) : NULL;
        if (depth == 0)
            break;
        if (!(good = tl_yaml_next(yaml)))
            break;
    }
    free(key);
    return good;
}

/* The path with .yaml in place of its extension: a new string. */
static char *beside(const char *body_path)
{
    const char *slash = strrchr(body_path, '/'), *dot = strrchr(body_path, '.');
    size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - body_path) : strlen(body_path);
    return tl_format("%.*s.yaml", (int)stem, body_path);
}

bool tl_pattern_measures(const char *body_path, struct tl_pattern_measures *out)
{
    char *path = beside(body_path), *data = NULL;
    size_t size;
    tl_error ignored;
    struct measure_reader reader = {.out = out};
    *out = (struct tl_pattern_measures){0};
    bool found =
        tl_file_exists(path) && tl_file_read_small(path, TL_LIMIT_MEASURE_BYTES, &data, &size, &ignored);
    if (found) {
        found = tl_yaml_begin(&reader.yaml, path, data, size, &ignored) &&
                tl_yaml_read(&reader.yaml, read_measures, &reader);
        tl_yaml_end(&reader.yaml);
    }
    free(data);
    free(path);
    found = found && out->height > 0 && out->head > 0 && out->waist_line > 0 &&
            out->head + out->waist_line < out->height;
    if (!found)
        *out = (struct tl_pattern_measures){0};
    return found;
}

struct tl_pattern_levels tl_pattern_levels(const struct tl_pattern_measures *measures, const tl_mesh *body)
{
    struct tl_waist waist;
    struct tl_box box = tl_box_of(body->positions, body->vertex_count);
    double height = measures->height > 0 ? measures->height : (double)(box.upper.y - box.lower.y);
    double shoulder = measures->height > 0 ? measures->height - measures->head
                                           : (double)box.lower.y + SHOULDER_SHARE * height;
    double armscye = measures->armscye > 0 ? measures->armscye : ARMSCYE_SHARE * height;
    double neck = measures->neck > 0 ? measures->neck : NECK_SHARE * height;
    struct tl_pattern_levels levels = {
        .shoulder = shoulder, .under_arm = shoulder - armscye, .neck = neck / 2 - NECK_EASE_M};
    if (measures->height > 0)
        levels.waist = shoulder - measures->waist_line;
    else if (tl_mesh_waist(body, &waist))
        levels.waist = (double)waist.y_m;
    return levels;
}

/* ---- Panels at the waist ---- */

static bool is_at_waist(const struct tl_pattern_edge *edge)
{
    return strcmp(edge->label, TL_PATTERN_AT_WAIST) == 0;
}

static bool has_waist(const struct tl_pattern_panel *panel)
{
    for (size_t e = 0; e < panel->edge_count; e++)
        if (is_at_waist(&panel->edges[e]))
            return true;
    return false;
}

/* The edges whose heights are averaged. */
struct mean_height {
    double length, moment; /* m; m^2: lengths times heights */
};

static void add_edge(struct mean_height *mean, const struct tl_pattern_panel *panel,
                     const struct tl_pattern_edge *edge)
{
    enum { SAMPLES = 16 };
    struct tl_point points[SAMPLES];
    double length = tl_pattern_edge_length(edge), height = 0;
    tl_pattern_edge_divide(edge, SAMPLES, points);
    for (int i = 0; i < SAMPLES; i++)
        height += (panel->origin[1] + points[i].x * panel->across[1] + points[i].y * panel->up[1]) / SAMPLES;
    mean->length += length;
    mean->moment += length * height;
}

/* Moves a panel against its outer side. */
static void move_inwards(struct tl_pattern_panel *panel)
{
    const double *a = panel->across, *u = panel->up;
    const double outwards[3] = {a[1] * u[2] - a[2] * u[1], a[2] * u[0] - a[0] * u[2],
                                a[0] * u[1] - a[1] * u[0]};
    for (int k = 0; k < 3; k++)
        panel->origin[k] -= INSET_M * outwards[k];
}

/* Marks a panel and all that are sewn to it, directly or not, except those at the waist. */
static void mark_sewn(const tl_pattern *pattern, size_t first, bool *marked)
{
    marked[first] = true;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t s = 0; s < pattern->stitch_count; s++) {
            size_t a = pattern->stitches[s].sides[0].panel, b = pattern->stitches[s].sides[1].panel;
            size_t other = marked[a] ? b : a;
            if (marked[a] == marked[b] || has_waist(&pattern->panels[other]))
                continue;
            marked[other] = changed = true;
        }
    }
}

/* The height of the edges of marked panels that are sewn to edges at the waist. */
static struct mean_height height_at_waist(const tl_pattern *pattern, const bool *marked)
{
    struct mean_height mean = {0, 0};
    for (size_t s = 0; s < pattern->stitch_count; s++) {
        for (int k = 0; k < 2; k++) {
            const struct tl_pattern_side *side = &pattern->stitches[s].sides[k];
            const struct tl_pattern_side *other = &pattern->stitches[s].sides[1 - k];
            if (marked[side->panel] && is_at_waist(&pattern->panels[other->panel].edges[other->edge]))
                add_edge(&mean, &pattern->panels[side->panel],
                         &pattern->panels[side->panel].edges[side->edge]);
        }
    }
    return mean;
}

/* A panel that hangs aslant, such as a sleeve along its arm. */
static bool is_turned(const struct tl_pattern_panel *panel)
{
    return panel->up[1] < UPRIGHT;
}

static double top_of(const struct tl_pattern_panel *panel)
{
    double top = -INFINITY;
    for (size_t e = 0; e < panel->edge_count; e++) {
        struct tl_point at = tl_pattern_edge_start(&panel->edges[e]);
        top = fmax(top, panel->origin[1] + at.x * panel->across[1] + at.y * panel->up[1]);
    }
    return top;
}

/* Panels that are sewn to the waist move with it, as one: a bodice. Where panels hang aslant they are placed
 * on limbs, away from which they are not moved. */
static void raise_sewn(tl_pattern *pattern, size_t first, const struct tl_pattern_levels *levels, bool *done)
{
    bool *marked = TL_NEW_ARRAY(bool, pattern->panel_count);
    bool turned = false;
    mark_sewn(pattern, first, marked);
    struct mean_height mean = height_at_waist(pattern, marked);
    double top = -INFINITY;
    for (size_t p = 0; p < pattern->panel_count; p++) {
        turned |= marked[p] && is_turned(&pattern->panels[p]);
        done[p] |= marked[p];
        if (marked[p])
            top = fmax(top, top_of(&pattern->panels[p]));
    }
    double rise = fmin(levels->waist - mean.moment / mean.length, levels->shoulder - BELOW_SHOULDER_M - top);
    for (size_t p = 0; p < pattern->panel_count; p++)
        if (marked[p] && !turned && mean.length > 0)
            pattern->panels[p].origin[1] += fmax(rise, 0);
    free(marked);
}

bool tl_pattern_raise(tl_pattern *pattern, const struct tl_pattern_levels *levels)
{
    struct mean_height mean = {0, 0};
    bool *done = TL_NEW_ARRAY(bool, pattern->panel_count);
    for (size_t p = 0; p < pattern->panel_count; p++)
        for (size_t e = 0; e < pattern->panels[p].edge_count; e++)
            if (is_at_waist(&pattern->panels[p].edges[e]))
                add_edge(&mean, &pattern->panels[p], &pattern->panels[p].edges[e]);
    for (size_t p = 0; mean.length > 0 && p < pattern->panel_count; p++) {
        if (has_waist(&pattern->panels[p])) {
            move_inwards(&pattern->panels[p]);
            pattern->panels[p].origin[1] += levels->waist - mean.moment / mean.length;
        } else if (!done[p]) {
            raise_sewn(pattern, p, levels, done);
        }
    }
    free(done);
    return mean.length > 0;
}

/* ---- Holds ---- */

void tl_pattern_hold(tl_pattern *pattern, const struct tl_pattern_levels *levels)
{
    enum { X, Y };
    const struct {
        const char *label;
        struct tl_pattern_hold hold;
    } known[] = {{TL_PATTERN_AT_WAIST, {levels->waist > 0, Y, 0, levels->waist}},
                 {TL_PATTERN_STRAPLESS, {true, Y, 0, levels->under_arm}},
                 {TL_PATTERN_LEFT_COLLAR, {levels->neck > 0, X, 1, levels->neck}},
                 {TL_PATTERN_RIGHT_COLLAR, {levels->neck > 0, X, -1, -levels->neck}}};
    for (size_t p = 0; p < pattern->panel_count; p++)
        for (size_t e = 0; e < pattern->panels[p].edge_count; e++)
            for (size_t k = 0; k < TL_COUNT(known); k++)
                if (strcmp(pattern->panels[p].edges[e].label, known[k].label) == 0)
                    pattern->panels[p].edges[e].hold = known[k].hold;
}
