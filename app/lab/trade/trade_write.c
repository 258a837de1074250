/* trade.csv, and report.html, which trade.js shows. */
#include "app/lab/trade/trade.h"
#include "app/lab/trade/trade_light.h"
#include "app/report/report.h"
#include "config/embedded.h"

#include <string.h>

extern const struct tl_embedded tl_embedded_trade[]; /* trade.js */

static const char *choice_name(const char *key, int index)
{
    return tl_experiment_choices(&tl_light_options, key)[index];
}

void tl_trade_write_csv(const struct tl_trade *trade, FILE *out)
{
    fputs("group,name,look,state,draws,budget_ms,width,height,scale,method,visibility,prefilter,composition,"
          "cut,regions,"
          "map_size_texels,"
          "filter,cpu_ms_per_frame,wall_ms_per_frame,pem_bytes,map_bytes,total_bytes,relative_rmse,standard_"
          "error,mean_flip,"
          "largest_difference,covered_pixels,garment_flip,garment_flip_worst,garment_pixels\n",
          out);
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_row *row = &trade->rows[i];
        const struct tl_light_params *light = &row->settings.light;
        fprintf(
            out,
            "\"%s\",\"%s\",%s,%s,%d,%g,%d,%d,%g,%s,%s,%s,%s,%s,%d,%d,%s,%.3f,%.3f,%zu,%zu,%zu,%.6g,%.6g,%."
            "6g,%.6g,%zu",
            row->group, row->name, trade->experiment->appearances[row->appearance].name,
            row->rest ? "rest" : "moving", row->draws, row->budget_ms, row->settings.image.width,
            row->settings.image.height, (double)row->settings.image.scale,
            choice_name("method", light->method), choice_name("visibility", light->visibility),
            choice_name("prefilter", light->prefilter), choice_name("composition", light->composition),
            choice_name("cut", light->cut), light->regions, light->map_size,
            choice_name("filter", light->filter), row->taken.cpu_ms, row->taken.wall_ms, row->memory.pems,
            row->memory.maps, row->memory.total, row->error.rel_rmse, row->error.standard_error,
            row->error.flip_mean, row->error.max_abs, row->error.covered);
        if (row->error.garment.pixels)
            fprintf(out, ",%.6g,%.6g,%zu\n", row->error.garment.flip_mean, row->error.garment.flip_worst,
                    row->error.garment.pixels);
        else
            fputs(",,,\n", out);
    }
}

static void write_csv(const void *trade, FILE *out)
{
    tl_trade_write_csv(trade, out);
}

static void add_looks(cJSON *data, const struct tl_experiment *experiment)
{
    cJSON *looks = cJSON_AddArrayToObject(data, "looks");
    for (int i = 0; i < experiment->appearance_count; i++) {
        cJSON *look = cJSON_CreateObject();
        cJSON_AddStringToObject(look, "name", experiment->appearances[i].name);
        cJSON_AddStringToObject(look, "title", experiment->appearances[i].title);
        cJSON_AddItemToArray(looks, look);
    }
}

/* Of the measure that the experiment is judged by. The reference has no error. */
static void add_error(cJSON *object, const struct tl_measured_error *measured, bool by_flip)
{
    if (!measured->covered) {
        cJSON_AddNullToObject(object, "error");
        return;
    }
    cJSON *error = cJSON_AddObjectToObject(object, "error");
    if (by_flip) {
        cJSON_AddNumberToObject(error, "garment_flip", measured->garment.flip_mean);
        cJSON_AddNumberToObject(error, "garment_flip_worst", measured->garment.flip_worst);
    } else {
        cJSON_AddNumberToObject(error, "rel_rmse", measured->rel_rmse);
        cJSON_AddNumberToObject(error, "flip_mean", measured->flip_mean);
    }
}

static void add_pictures(cJSON *data, const struct tl_trade *trade)
{
    cJSON *pictures = cJSON_AddArrayToObject(data, "pictures");
    for (size_t i = 0; i < trade->picture_count; i++) {
        const struct tl_trade_picture *picture = &trade->pictures[i];
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "name", picture->name);
        cJSON_AddStringToObject(object, "look", trade->experiment->appearances[picture->appearance].name);
        cJSON_AddItemToObject(object, "png", tl_report_png(picture->png, picture->size));
        add_error(object, &picture->error, trade->experiment->by_flip);
        cJSON_AddItemToArray(pictures, object);
    }
}

bool tl_trade_write_report(const struct tl_trade *trade, const char *folder, tl_error *error)
{
    const struct tl_experiment *experiment = trade->experiment;
    const struct tl_experiment_appearance *quick = &experiment->appearances[experiment->quick_appearance];
    bool light = strcmp(experiment->name, "light") == 0;
    cJSON *data = cJSON_CreateObject();
    cJSON_AddStringToObject(data, "axis", experiment->name);
    cJSON_AddStringToObject(data, "title", experiment->title);
    cJSON_AddStringToObject(data, "text", experiment->text);
    cJSON_AddBoolToObject(data, "by_wall", experiment->by_wall);
    cJSON_AddBoolToObject(data, "by_flip", experiment->by_flip);
    cJSON_AddBoolToObject(data, "complete", trade->complete);
    cJSON_AddNumberToObject(data, "garment_triangles", (double)trade->recording.garment_triangles);
    cJSON_AddNumberToObject(data, "mean_step_m", trade->recording.mean_step_m);
    cJSON_AddStringToObject(data, "environment", trade->environment->name);
    add_looks(data, experiment);
    cJSON_AddStringToObject(data, "table_look", trade->quick ? quick->name : experiment->appearances[0].name);
    cJSON_AddItemToObject(data, "sweep_look", light ? cJSON_CreateString(quick->name) : cJSON_CreateNull());
    tl_report_add_text(data, "csv", trade, write_csv);
    add_pictures(data, trade);
    cJSON *figures = cJSON_AddArrayToObject(data, "figures");
    if (light && trade->complete) { /* after Ctrl-C these slow figures are left out */
        tl_trade_add_lobes(trade->quick, figures);
        tl_trade_add_memory(trade->environment, figures);
    }
    tl_report_add_texts(data, "refusals", trade->refusals, trade->refusal_count);
    return tl_report_write(folder, "report.html", tl_embedded_trade[0].data, data, error);
}
