#include "app/batch/info_garment.h"

#include "app/fit/measures.h"
#include "app/fit/sewn.h"
#include "assets/base/placing.h"
#include "assets/charts/rest.h"
#include "assets/pattern/pattern_cut.h"
#include "assets/stitches/stitches.h"
#include "cloth/contact/crossings.h"
#include "config/memory.h"

#include <stdlib.h>

/* A body scan may have thousands of holes. */
#define MOST_OPENINGS 40

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
    for (size_t i = 0; i < openings.count && i < MOST_OPENINGS; i++)
        cJSON_AddNumberToObject(lengths, openings.items[i].name, 1e3 * openings.items[i].length);
    if (openings.count > MOST_OPENINGS)
        add_count(object, "openings_not_listed", openings.count - MOST_OPENINGS);
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

void tl_info_describe_sewn(cJSON *object, const tl_pattern *pattern)
{
    const float edge_m = 0.02f;
    tl_garment garment;
    tl_error error = {0};
    if (!tl_pattern_cut(pattern, edge_m, &garment, &error)) {
        cJSON_AddStringToObject(object, "openings_mm", error.message);
        return;
    }
    describe_cut(object, &garment);
    tl_garment_release(&garment);
}

/* A file of panels and stitches, upright as it will be sewn. */
static void describe_stitches(cJSON *object, tl_model *model)
{
    const struct tl_placing placing = {.z_up = model->units.z_up, .scale = 1};
    tl_garment garment = {.model = *model};
    tl_error error;
    add_count(object, "stitches", model->stitch_count);
    tl_stitches_sew(&garment);
    tl_placing_apply(&placing, &garment.model.mesh);
    struct tl_charts charts = tl_charts_find(&garment.model.mesh);
    (void)tl_rest_take(TL_REST_AUTO, &charts, &garment, &error); /* AUTO takes what there is */
    describe_cut(object, &garment);
    tl_charts_release(&charts);
    *model = garment.model;
    garment.model = (tl_model){0};
    tl_garment_release(&garment);
}

void tl_info_describe_garment(cJSON *object, tl_model *model)
{
    bool complete;
    add_count(object, "crossings",
              tl_crossings_of_mesh(&model->mesh, model->mesh.positions, NULL, &complete));
    if (!complete)
        cJSON_AddStringToObject(object, "crossings_note", "at least: its triangles lie in one heap");
    describe_rest(object, model);
    if (model->stitch_count > 0)
        describe_stitches(object, model);
    else
        describe_openings(object, model);
}
