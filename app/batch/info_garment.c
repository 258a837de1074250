#include "app/batch/info_garment.h"

#include "assets/charts/rest.h"
#include "cloth/contact/crossings.h"

#include <stdlib.h>

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

void tl_info_describe_garment(cJSON *object, const tl_model *model)
{
    add_count(object, "crossings", tl_crossings_of_mesh(&model->mesh, model->mesh.positions, NULL));
    describe_rest(object, model);
}
