/* GarmentCode's pattern JSON, checked field by field: pattern.panels, pattern.stitches, properties. */
#include "assets/pattern/pattern_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNITS_IN_METER 100 /* of a file without properties: GarmentCode writes centimetres */

/* The new place of each line of a panel, for the stitches, which name lines by their place in the file. */
struct places {
    size_t count, *edges;
};

struct reader {
    const char *path;
    char *where; /* path and panel, for messages */
    double scale;
    bool absolute; /* control points are in the panel's axes, not relative to the chord */
    bool centred;  /* the vertices' mean is to become the panel's origin */
    tl_pattern *out;
    struct places *places; /* [panel_count] */
    tl_error *error;
};

bool tl_pattern_is_file(const char *path)
{
    return tl_path_has_extension(path, "json");
}

/* ---- Values ---- */

/* The text of a string, or "" for any other value: a new string. */
static char *text_of(const cJSON *value)
{
    return tl_copy_string(cJSON_IsString(value) ? value->valuestring : "");
}

/* Whether a value is a list of `count` finite numbers. */
static bool read_numbers(const cJSON *value, size_t count, double *out)
{
    const cJSON *item;
    size_t found = 0;
    if (!cJSON_IsArray(value))
        return false;
    cJSON_ArrayForEach(item, value)
    {
        if (found == count || !cJSON_IsNumber(item) || !isfinite(item->valuedouble))
            return false;
        out[found++] = item->valuedouble;
    }
    return found == count;
}

/* A flag, as a number or as true and false. */
static bool read_flag(const cJSON *value, bool *out)
{
    *out = cJSON_IsTrue(value) || (cJSON_IsNumber(value) && value->valuedouble != 0);
    return cJSON_IsBool(value) || cJSON_IsNumber(value);
}

/* A whole number from 0 to count - 1. */
static bool read_index(const cJSON *value, size_t count, size_t *out)
{
    if (!cJSON_IsNumber(value) || !(value->valuedouble >= 0) || !(value->valuedouble < (double)count) ||
        value->valuedouble != floor(value->valuedouble))
        return false;
    *out = (size_t)value->valuedouble;
    return true;
}

/* ---- Panels ---- */

static bool is_near(const struct reader *reader, double number)
{
    return fabs(number) * reader->scale <= TL_LIMIT_PATTERN_METRES;
}

static bool read_vertices(const struct reader *reader, const cJSON *list, struct tl_point *out)
{
    const cJSON *item;
    size_t index = 0;
    cJSON_ArrayForEach(item, list)
    {
        double xy[2];
        if (!read_numbers(item, 2, xy))
            return tl_fail(reader->error, TL_INPUT, "%s: vertex %zu: expected two numbers, [x, y]",
                           reader->where, index);
        if (!is_near(reader, xy[0]) || !is_near(reader, xy[1]))
            return tl_fail(reader->error, TL_INPUT,
                           "%s: vertex %zu: [%g, %g] is more than %g m away: check units_in_meter",
                           reader->where, index, xy[0], xy[1], TL_LIMIT_PATTERN_METRES);
        out[index++] = (struct tl_point){xy[0], xy[1]};
    }
    return true;
}

/* A control point in the panel's axes; relative ones are given along the chord and to its left, in chords. */
static bool read_control(const struct reader *reader, const cJSON *value, const struct tl_point ends[2],
                         struct tl_point *out)
{
    double xy[2];
    if (!read_numbers(value, 2, xy))
        return false;
    struct tl_point chord = {ends[1].x - ends[0].x, ends[1].y - ends[0].y};
    *out = reader->absolute ? (struct tl_point){xy[0], xy[1]}
                            : (struct tl_point){ends[0].x + xy[0] * chord.x - xy[1] * chord.y,
                                                ends[0].y + xy[0] * chord.y + xy[1] * chord.x};
    return is_near(reader, out->x) && is_near(reader, out->y);
}

/* `curvature`: {"type": "quadratic" | "cubic" | "circle", "params": [...]}, or [x, y] of a quadratic. */
static bool read_curvature(const struct reader *reader, const cJSON *value, const struct tl_point ends[2],
                           struct pattern_line *out)
{
    const cJSON *type = cJSON_GetObjectItemCaseSensitive(value, "type");
    const cJSON *params = cJSON_GetObjectItemCaseSensitive(value, "params");
    const char *name = cJSON_IsString(type) ? type->valuestring : "";
    if (!value || cJSON_IsNull(value))
        return true;
    if (cJSON_IsArray(value)) {
        out->kind = PATTERN_QUADRATIC;
        return read_control(reader, value, ends, &out->control[0]);
    }
    int count = cJSON_GetArraySize(params);
    if (strcmp(name, "quadratic") == 0 && count == 1) {
        out->kind = PATTERN_QUADRATIC;
        return read_control(reader, cJSON_GetArrayItem(params, 0), ends, &out->control[0]);
    }
    if (strcmp(name, "cubic") == 0 && count == 2) {
        out->kind = PATTERN_CUBIC;
        return read_control(reader, cJSON_GetArrayItem(params, 0), ends, &out->control[0]) &&
               read_control(reader, cJSON_GetArrayItem(params, 1), ends, &out->control[1]);
    }
    if (strcmp(name, "circle") == 0 && count == 3) {
        const cJSON *radius = cJSON_GetArrayItem(params, 0);
        out->kind = PATTERN_ARC;
        out->radius = cJSON_IsNumber(radius) ? radius->valuedouble : 0;
        return out->radius > 0 && is_near(reader, out->radius) &&
               read_flag(cJSON_GetArrayItem(params, 1), &out->large) &&
               read_flag(cJSON_GetArrayItem(params, 2), &out->right);
    }
    return false;
}

static bool read_line(const struct reader *reader, const cJSON *value, size_t index,
                      const struct pattern_draft *draft, struct pattern_line *out)
{
    const cJSON *endpoints = cJSON_GetObjectItemCaseSensitive(value, "endpoints");
    if (cJSON_GetArraySize(endpoints) != 2 ||
        !read_index(cJSON_GetArrayItem(endpoints, 0), draft->vertex_count, &out->from) ||
        !read_index(cJSON_GetArrayItem(endpoints, 1), draft->vertex_count, &out->to))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: edge %zu: endpoints: expected two numbers of vertices, 0 to %zu", reader->where,
                       index, draft->vertex_count - 1);
    const struct tl_point ends[2] = {draft->vertices[out->from], draft->vertices[out->to]};
    if (!read_curvature(reader, cJSON_GetObjectItemCaseSensitive(value, "curvature"), ends, out))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: edge %zu: curvature: expected [x, y], or a type with its params: quadratic "
                       "[[x, y]], cubic [[x, y], [x, y]], circle [radius, large, right]",
                       reader->where, index);
    out->label = text_of(cJSON_GetObjectItemCaseSensitive(value, "label"));
    return true;
}

/* The number of elements of a list, or a failure when it is no list or its length is out of range. */
static bool count_list(const struct reader *reader, const cJSON *list, const char *key, size_t minimum,
                       size_t maximum, size_t *out)
{
    *out = (size_t)cJSON_GetArraySize(list);
    if (cJSON_IsArray(list) && *out >= minimum && *out <= maximum)
        return true;
    return tl_fail(reader->error, TL_INPUT, "%s: %s: expected a list of %zu to %zu, found %zu", reader->where,
                   key, minimum, maximum, cJSON_IsArray(list) ? *out : 0);
}

/* Rotations are angles about the fixed axes x, y and z, one after another: R = Rz Ry Rx. */
static bool read_placement(const struct reader *reader, const cJSON *value, struct tl_pattern_panel *panel)
{
    const cJSON *rotation = cJSON_GetObjectItemCaseSensitive(value, "rotation");
    const cJSON *translation = cJSON_GetObjectItemCaseSensitive(value, "translation");
    double deg[3] = {0}, at[3] = {0};
    if (rotation && !read_numbers(rotation, 3, deg))
        return tl_fail(reader->error, TL_INPUT, "%s: rotation: expected three angles in degrees",
                       reader->where);
    if (translation && (!read_numbers(translation, 3, at) || !is_near(reader, at[0]) ||
                        !is_near(reader, at[1]) || !is_near(reader, at[2])))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: translation: expected three numbers, of at most %g m: check units_in_meter",
                       reader->where, TL_LIMIT_PATTERN_METRES);
    double x = deg[0] * M_PI / 180, y = deg[1] * M_PI / 180, z = deg[2] * M_PI / 180;
    const double across[3] = {cos(z) * cos(y), sin(z) * cos(y), -sin(y)};
    const double up[3] = {cos(z) * sin(y) * sin(x) - sin(z) * cos(x),
                          sin(z) * sin(y) * sin(x) + cos(z) * cos(x), cos(y) * sin(x)};
    for (int k = 0; k < 3; k++)
        panel->origin[k] = at[k] * reader->scale;
    memcpy(panel->across, across, sizeof across);
    memcpy(panel->up, up, sizeof up);
    return true;
}

/* Moves the vertices' mean to (0, 0) and the panel there, as `normalize_panel_translation` asks. */
static void centre(const struct reader *reader, struct tl_point *vertices, const struct pattern_draft *draft,
                   struct tl_pattern_panel *panel)
{
    struct tl_point mean = {0, 0};
    double count = (double)draft->vertex_count;
    for (size_t i = 0; i < draft->vertex_count; i++)
        mean = (struct tl_point){mean.x + vertices[i].x / count, mean.y + vertices[i].y / count};
    for (size_t i = 0; i < draft->vertex_count; i++)
        vertices[i] = (struct tl_point){vertices[i].x - mean.x, vertices[i].y - mean.y};
    for (size_t i = 0; i < 2 * draft->line_count; i++) {
        struct tl_point *control = &draft->lines[i / 2].control[i % 2];
        *control = (struct tl_point){control->x - mean.x, control->y - mean.y};
    }
    panel->origin[0] += mean.x * reader->scale;
    panel->origin[1] += mean.y * reader->scale;
}

static bool read_lines(const struct reader *reader, const cJSON *list, const struct pattern_draft *draft)
{
    const cJSON *item;
    size_t index = 0;
    cJSON_ArrayForEach(item, list)
    {
        if (!read_line(reader, item, index, draft, &draft->lines[index]))
            return false;
        index++;
    }
    return true;
}

static bool read_panel(struct reader *reader, const cJSON *value, size_t index)
{
    struct tl_pattern_panel *panel = &reader->out->panels[index];
    const cJSON *vertices = cJSON_GetObjectItemCaseSensitive(value, "vertices");
    const cJSON *edges = cJSON_GetObjectItemCaseSensitive(value, "edges");
    size_t vertex_count, line_count;
    panel->name = tl_copy_string(value->string);
    panel->label = text_of(cJSON_GetObjectItemCaseSensitive(value, "label"));
    free(reader->where);
    reader->where = tl_format("%s: panel \"%s\"", reader->path, value->string);
    if (!count_list(reader, vertices, "vertices", 2, TL_LIMIT_PATTERN_EDGES, &vertex_count) ||
        !count_list(reader, edges, "edges", 2, TL_LIMIT_PATTERN_EDGES, &line_count) ||
        !read_placement(reader, value, panel))
        return false;
    struct tl_point *points = TL_NEW_ARRAY(struct tl_point, vertex_count);
    struct pattern_line *lines = TL_NEW_ARRAY(struct pattern_line, line_count);
    const struct pattern_draft draft = {reader->where, reader->scale, vertex_count,
                                        points,        line_count,    lines};
    reader->places[index] = (struct places){line_count, TL_NEW_ARRAY(size_t, line_count)};
    bool good = read_vertices(reader, vertices, points) && read_lines(reader, edges, &draft);
    if (good && reader->centred)
        centre(reader, points, &draft, panel);
    good = good && tl_pattern_outline(&draft, panel, reader->places[index].edges, reader->error);
    for (size_t i = 0; i < line_count; i++)
        free(lines[i].label);
    free(lines);
    free(points);
    return good;
}

static bool read_panels(struct reader *reader, const cJSON *panels)
{
    tl_pattern *out = reader->out;
    const cJSON *item;
    size_t count = (size_t)cJSON_GetArraySize(panels), index = 0;
    if (!cJSON_IsObject(panels) || count == 0 || count > TL_LIMIT_PATTERN_PANELS)
        return tl_fail(reader->error, TL_INPUT,
                       "%s: pattern.panels: expected 1 to %d panels by name: is this GarmentCode's "
                       "specification?",
                       reader->path, TL_LIMIT_PATTERN_PANELS);
    out->panels = TL_NEW_ARRAY(struct tl_pattern_panel, count);
    reader->places = TL_NEW_ARRAY(struct places, count);
    cJSON_ArrayForEach(item, panels)
    {
        out->panel_count = index + 1;
        if (!read_panel(reader, item, index))
            return false;
        for (size_t other = 0; other < index; other++)
            if (strcmp(out->panels[other].name, out->panels[index].name) == 0)
                return tl_fail(reader->error, TL_INPUT, "%s: there are two panels of this name",
                               reader->where);
        index++;
    }
    return true;
}

/* ---- Stitches ---- */

static bool read_side(const struct reader *reader, const cJSON *value, size_t stitch,
                      struct tl_pattern_side *out)
{
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(value, "panel");
    const cJSON *edge = cJSON_GetObjectItemCaseSensitive(value, "edge");
    size_t line;
    out->panel = 0;
    while (cJSON_IsString(name) && out->panel < reader->out->panel_count &&
           strcmp(reader->out->panels[out->panel].name, name->valuestring) != 0)
        out->panel++;
    if (!cJSON_IsString(name) || out->panel == reader->out->panel_count)
        return tl_fail(reader->error, TL_INPUT, "%s: stitch %zu: panel: \"%s\" is not one of pattern.panels",
                       reader->path, stitch, cJSON_IsString(name) ? name->valuestring : "");
    const struct places *places = &reader->places[out->panel];
    if (!read_index(edge, places->count, &line))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: stitch %zu: edge: expected one of panel \"%s\", 0 to %zu", reader->path, stitch,
                       name->valuestring, places->count - 1);
    out->edge = places->edges[line];
    return true;
}

static bool read_stitch(const struct reader *reader, const cJSON *value, size_t index,
                        struct tl_pattern_stitch *out)
{
    const int count = cJSON_GetArraySize(value);
    const cJSON *kind = count == 3 ? cJSON_GetArrayItem(value, 2) : NULL;
    if (!cJSON_IsArray(value) || count < 2 || count > 3 ||
        (kind && (!cJSON_IsString(kind) || strcmp(kind->valuestring, "right_wrong") != 0)))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: stitch %zu: expected two sides {\"panel\", \"edge\"}, and \"right_wrong\" or "
                       "nothing",
                       reader->path, index);
    out->right_wrong = kind != NULL;
    for (int k = 0; k < 2; k++)
        if (!read_side(reader, cJSON_GetArrayItem(value, k), index, &out->sides[k]))
            return false;
    if (out->sides[0].panel != out->sides[1].panel || out->sides[0].edge != out->sides[1].edge)
        return true;
    return tl_fail(reader->error, TL_INPUT, "%s: stitch %zu: sews an edge to itself: remove it", reader->path,
                   index);
}

static bool read_stitches(struct reader *reader, const cJSON *list)
{
    const cJSON *item;
    size_t count = (size_t)cJSON_GetArraySize(list), index = 0;
    if (!list)
        return true;
    if (!cJSON_IsArray(list) || count > TL_LIMIT_PATTERN_STITCHES)
        return tl_fail(reader->error, TL_INPUT, "%s: pattern.stitches: expected a list of at most %d",
                       reader->path, TL_LIMIT_PATTERN_STITCHES);
    reader->out->stitches = TL_NEW_ARRAY(struct tl_pattern_stitch, count);
    cJSON_ArrayForEach(item, list)
    {
        if (!read_stitch(reader, item, index, &reader->out->stitches[index]))
            return false;
        reader->out->stitch_count = ++index;
    }
    return true;
}

/* ---- The file ---- */

static bool read_properties(struct reader *reader, const cJSON *properties)
{
    const cJSON *units = cJSON_GetObjectItemCaseSensitive(properties, "units_in_meter");
    const cJSON *coords = cJSON_GetObjectItemCaseSensitive(properties, "curvature_coords");
    const char *coords_name = cJSON_IsString(coords) ? coords->valuestring : "";
    double in_meter = cJSON_IsNumber(units) ? units->valuedouble : units ? 0 : UNITS_IN_METER;
    if (!(in_meter >= 1e-3 && in_meter <= 1e6))
        return tl_fail(reader->error, TL_INPUT,
                       "%s: properties.units_in_meter: expected a number, such as 100 for centimetres",
                       reader->path);
    reader->scale = 1 / in_meter;
    reader->absolute = strcmp(coords_name, "absolute") == 0;
    reader->centred =
        cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(properties, "normalize_panel_translation"));
    if (!coords || reader->absolute || strcmp(coords_name, "relative") == 0)
        return true;
    return tl_fail(reader->error, TL_INPUT,
                   "%s: properties.curvature_coords: expected \"relative\" or \"absolute\"", reader->path);
}

static cJSON *parse(const char *path, const char *data, size_t size, tl_error *error)
{
    const char *end = data;
    size_t line = 1;
    cJSON *root = cJSON_ParseWithLengthOpts(data, size, &end, false);
    if (root)
        return root;
    for (const char *at = data; at < end; at++)
        line += *at == '\n';
    (void)tl_fail(error, TL_INPUT, "%s:%zu: is no valid JSON: check this line and the one before it", path,
                  line);
    return NULL;
}

bool tl_pattern_load(const char *path, tl_pattern *out, tl_error *error)
{
    struct reader reader = {.path = path, .out = out, .error = error};
    const char *slash = strrchr(path, '/');
    char *data;
    size_t size;
    *out = (tl_pattern){0};
    if (!tl_file_read_small(path, TL_LIMIT_PATTERN_BYTES, &data, &size, error))
        return false;
    cJSON *root = parse(path, data, size, error);
    const cJSON *pattern = cJSON_GetObjectItemCaseSensitive(root, "pattern");
    out->name = tl_copy_string(slash ? slash + 1 : path);
    bool good = root && read_properties(&reader, cJSON_GetObjectItemCaseSensitive(root, "properties")) &&
                read_panels(&reader, cJSON_GetObjectItemCaseSensitive(pattern, "panels")) &&
                read_stitches(&reader, cJSON_GetObjectItemCaseSensitive(pattern, "stitches"));
    for (size_t i = 0; reader.places && i < out->panel_count; i++)
        free(reader.places[i].edges);
    free(reader.places);
    free(reader.where);
    cJSON_Delete(root);
    free(data);
    if (good)
        tl_pattern_untwist(out);
    else
        tl_pattern_release(out);
    return good;
}

void tl_pattern_release(tl_pattern *pattern)
{
    for (size_t p = 0; p < pattern->panel_count; p++) {
        struct tl_pattern_panel *panel = &pattern->panels[p];
        for (size_t e = 0; e < panel->edge_count; e++)
            free(panel->edges[e].label);
        free(panel->edges);
        free(panel->name);
        free(panel->label);
    }
    free(pattern->panels);
    free(pattern->stitches);
    free(pattern->name);
    *pattern = (tl_pattern){0};
}

double tl_pattern_stitch_ease(const tl_pattern *pattern, size_t stitch)
{
    double length[2];
    for (int k = 0; k < 2; k++) {
        const struct tl_pattern_side *side = &pattern->stitches[stitch].sides[k];
        length[k] = tl_pattern_edge_length(&pattern->panels[side->panel].edges[side->edge]);
    }
    return fmax(length[0], length[1]) / fmin(length[0], length[1]) - 1;
}
