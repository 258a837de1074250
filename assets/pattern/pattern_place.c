#include "assets/pattern/pattern_place.h"

#include "assets/cut/fit.h"
#include "config/file.h"
#include "config/memory.h"
#include "config/yaml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How far panels at the waist are moved towards the body. */
#define TUCK_M                 0.015
#define TL_LIMIT_MEASURE_BYTES ((size_t)1 << 20)

/* ---- Measures ---- */

static void take_measure(struct tl_pattern_measures *measures, const char *key, const char *text)
{
    const struct {
        const char *key;
        double *value;
    } known[] = {
        {"height", &measures->height}, {"head_l", &measures->head}, {"waist_line", &measures->waist_line}};
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

double tl_pattern_waist(const struct tl_pattern_measures *measures, const tl_mesh *body)
{
    struct tl_waist waist;
    if (measures->height > 0)
        return measures->height - measures->head - measures->waist_line;
    return tl_mesh_waist(body, &waist) ? (double)waist.y_m : 0;
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

/* Adds the edge's length, and its height times that. */
static void add_height(const struct tl_pattern_panel *panel, const struct tl_pattern_edge *edge,
                       double *length, double *moment)
{
    enum { SAMPLES = 16 };
    struct tl_point points[SAMPLES];
    double edge_length = tl_pattern_edge_length(edge), height = 0;
    tl_pattern_edge_divide(edge, SAMPLES, points);
    for (int i = 0; i < SAMPLES; i++)
        height += (panel->origin[1] + points[i].x * panel->across[1] + points[i].y * panel->up[1]) / SAMPLES;
    *length += edge_length;
    *moment += edge_length * height;
}

bool tl_pattern_raise(tl_pattern *pattern, double waist_m)
{
    double length = 0, moment = 0;
    for (size_t p = 0; p < pattern->panel_count; p++)
        for (size_t e = 0; e < pattern->panels[p].edge_count; e++)
            if (is_at_waist(&pattern->panels[p].edges[e]))
                add_height(&pattern->panels[p], &pattern->panels[p].edges[e], &length, &moment);
    if (!(length > 0))
        return false;
    for (size_t p = 0; p < pattern->panel_count; p++) {
        struct tl_pattern_panel *panel = &pattern->panels[p];
        if (!has_waist(panel))
            continue;
        const double *a = panel->across, *u = panel->up;
        const double outwards[3] = {a[1] * u[2] - a[2] * u[1], a[2] * u[0] - a[0] * u[2],
                                    a[0] * u[1] - a[1] * u[0]};
        for (int k = 0; k < 3; k++)
            panel->origin[k] -= TUCK_M * outwards[k];
        panel->origin[1] += waist_m - moment / length;
    }
    return true;
}
