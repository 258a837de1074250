#include "app/batch/info/info_garment.h"

#include "app/fit/measures.h"
#include "app/fit/sewn.h"
#include "assets/base/placing.h"
#include "assets/pattern/pattern_cut.h"
#include "assets/sewing/rest.h"
#include "assets/sewing/stitches.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* A body scan may have thousands of holes. */
#define MAX_OPENINGS 40

static void add_count(cJSON *object, const char *key, size_t count)
{
    cJSON_AddNumberToObject(object, key, (double)count);
}

static void describe_rest(cJSON *object, const tl_model *model)
{
    struct tl_charts charts = tl_charts_find(&model->mesh);
    bool is_pattern = charts.whole.verdict == TL_CHART_IS_PATTERN;
    double mm[2] = {1e3 * charts.metres_per_unit[0], 1e3 * charts.metres_per_unit[1]};
    char *line = tl_rest_describe(model->name, &charts);
    cJSON *rest = cJSON_AddObjectToObject(object, "rest_shape");
    cJSON_AddStringToObject(rest, "of", tl_rest_names[is_pattern ? TL_REST_UV : TL_REST_MESH]);
    add_count(rest, "charts", charts.count);
    add_count(rest, "pattern_charts", charts.pattern_count);
    add_count(rest, "mirrored_charts", charts.mirrored_count);
    cJSON_AddItemToObject(rest, "mm_per_unit", cJSON_CreateDoubleArray(mm, 2));
    cJSON_AddNumberToObject(rest, "residual_percent", 100 * charts.whole.residual);
    cJSON_AddNumberToObject(rest, "stretched_percent", 100 * charts.whole.stretched_share);
    cJSON_AddNumberToObject(rest, "unmapped_percent", 100 * charts.whole.unmapped_share);
    cJSON_AddStringToObject(rest, "note", line);
    free(line);
    tl_charts_release(&charts);
}

/* Lengths of the openings in mm. */
static void describe_openings(cJSON *object, const tl_model *model)
{
    struct tl_openings openings = tl_sewn_openings_of_model(model);
    cJSON *lengths = cJSON_AddObjectToObject(object, "openings_mm");
    for (size_t i = 0; i < openings.count && i < MAX_OPENINGS; i++)
        cJSON_AddNumberToObject(lengths, openings.items[i].name, 1e3 * openings.items[i].length);
    if (openings.count > MAX_OPENINGS)
        add_count(object, "openings_not_listed", openings.count - MAX_OPENINGS);
    tl_openings_release(&openings);
}

/* Lengths of the openings as they are cut, in mm: the panels hang apart. */
static void describe_cut(cJSON *object, const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    struct tl_openings openings = tl_sewn_openings(garment, mesh->positions, weld);
    const struct tl_measures_source source = {.garment = garment, .positions = mesh->positions, .weld = weld};
    struct tl_measures measures = tl_measures_take(&source);
    cJSON *lengths = cJSON_AddObjectToObject(object, "openings_mm");
    for (size_t i = 0; i < measures.opening_count; i++)
        cJSON_AddNumberToObject(lengths, measures.openings[i].name, 1e3 * measures.openings[i].rest_m);
    tl_measures_release(&measures);
    tl_openings_release(&openings);
    free(weld);
}

/* Adds the openings of a sewing pattern: the edges that no stitch joins, as long as they are cut. */
static void describe_sewn(cJSON *object, const tl_pattern *pattern, tl_audit *audit)
{
    const float edge_m = 0.02f;
    tl_garment garment;
    tl_error error = {0};
    if (!tl_pattern_cut(pattern, edge_m, &garment, &error)) {
        cJSON_AddStringToObject(object, "openings_mm", error.message);
        tl_audit_add_file(audit, TL_AUDIT_PATTERN_UNCUT, NULL, error.message);
        return;
    }
    describe_cut(object, &garment);
    tl_garment_release(&garment);
}

/* Counts the edges of each label, in the order of their first. */
static void describe_labels(cJSON *object, const tl_pattern *pattern)
{
    cJSON *labels = cJSON_AddObjectToObject(object, "labels");
    for (size_t p = 0; p < pattern->panel_count; p++) {
        for (size_t e = 0; e < pattern->panels[p].edge_count; e++) {
            const char *label = pattern->panels[p].edges[e].label;
            cJSON *count = cJSON_GetObjectItemCaseSensitive(labels, label);
            if (count)
                cJSON_SetNumberValue(count, count->valuedouble + 1);
            else if (label[0] != '\0')
                cJSON_AddNumberToObject(labels, label, 1);
        }
    }
}

static double panel_outline(const struct tl_pattern_panel *panel)
{
    double length = 0;
    for (size_t e = 0; e < panel->edge_count; e++)
        length += tl_pattern_edge_length(&panel->edges[e]);
    return length;
}

cJSON *tl_info_describe_pattern(const tl_pattern *pattern, tl_audit *audit)
{
    const double noticed = 0.01; /* seams that gather or ease by more than rounding */
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "kind", "pattern");
    cJSON_AddStringToObject(object, "name", pattern->name);
    cJSON *panels = cJSON_AddObjectToObject(object, "panels");
    for (size_t p = 0; p < pattern->panel_count; p++) {
        const struct tl_pattern_panel *panel = &pattern->panels[p];
        cJSON *item = cJSON_AddObjectToObject(panels, panel->name);
        if (panel->label[0] != '\0')
            cJSON_AddStringToObject(item, "label", panel->label);
        cJSON_AddNumberToObject(item, "edges", (double)panel->edge_count);
        cJSON_AddNumberToObject(item, "outline_m", panel_outline(panel));
        cJSON_AddNumberToObject(item, "area_m2", tl_pattern_panel_area(panel));
    }
    describe_labels(object, pattern);
    cJSON_AddNumberToObject(object, "stitches", (double)pattern->stitch_count);
    cJSON *eased = cJSON_AddObjectToObject(object, "eased_percent");
    for (size_t s = 0; s < pattern->stitch_count; s++) {
        const struct tl_pattern_side *sides = pattern->stitches[s].sides;
        double ease = tl_pattern_stitch_ease(pattern, s);
        char *key = tl_format("%zu: %s, %s", s, pattern->panels[sides[0].panel].name,
                              pattern->panels[sides[1].panel].name);
        if (ease > noticed)
            cJSON_AddNumberToObject(eased, key, 100 * ease);
        free(key);
    }
    cJSON_AddStringToObject(
        object, "body",
        "the one that it was drafted for: --avatar FILE; its measures are looked for in a "
        ".yaml of the same name");
    describe_sewn(object, pattern, audit);
    return object;
}

/* The openings of a file of panels and stitches, upright as it will be sewn. */
static void describe_stitches(cJSON *object, tl_garment *garment)
{
    const struct tl_placing placing = {.z_up = garment->model.units.z_up, .scale = 1};
    tl_error error;
    tl_placing_apply(&placing, &garment->model.mesh);
    struct tl_charts charts = tl_charts_find(&garment->model.mesh);
    (void)tl_rest_take(TL_REST_AUTO, &charts, garment, &error); /* AUTO takes what there is */
    describe_cut(object, garment);
    tl_charts_release(&charts);
}

void tl_info_describe_garment(cJSON *object, tl_model *model, tl_audit *audit)
{
    tl_garment garment = {.model = *model};
    if (model->stitch_count > 0) {
        add_count(object, "stitches", model->stitch_count);
        tl_stitches_sew(&garment);
        *model = garment.model;
    }
    tl_audit_garment(audit, &garment);
    add_count(object, "crossings", audit->crossing_count);
    if (!audit->crossings_complete)
        cJSON_AddStringToObject(object, "crossings_note", "at least: its triangles lie in one heap");
    describe_rest(object, model);
    if (model->stitch_count > 0)
        describe_stitches(object, &garment);
    else
        describe_openings(object, model);
    *model = garment.model;
    garment.model = (tl_model){0};
    tl_garment_release(&garment);
}
