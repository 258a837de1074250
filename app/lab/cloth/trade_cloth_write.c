/* trade.csv and report.html of the axis cloth; cloth.js shows the latter. */
#include "app/lab/cloth/trade_cloth.h"
#include "app/report/report.h"
#include "cloth/cloth.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <math.h>

extern const struct tl_embedded tl_embedded_cloth[]; /* cloth.js */

/* Empty where nothing was measured. */
static void print_field(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, ",%.6g", value);
    else
        fputc(',', out);
}

void tl_trade_cloth_write_csv(const struct tl_trade_cloth *trade, FILE *out)
{
    fputs("solver,name,side,particles,substep_s,cpu_ms_per_s,wall_ms_per_s,rms_error_m,rms_total_error_m,"
          "rest_cpu_ms,rest_wall_ms,rest_rms_error_m,rest_excess_energy_j,rest_largest_strain\n",
          out);
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_cloth_row *row = &trade->rows[i];
        const double fields[] = {row->substep_s,     row->fall.cpu_ms, row->fall.wall_ms, row->error_m,
                                 row->total_error_m, row->rest.cpu_ms, row->rest.wall_ms, row->rest_error_m,
                                 row->rest_energy_j, row->rest_strain};
        fprintf(out, "%s,\"%s\",%d,%d", tl_cloth_solver_names[row->solver], row->name, row->side,
                row->side * row->side);
        for (size_t k = 0; k < TL_COUNT(fields); k++)
            print_field(out, fields[k]);
        fputc('\n', out);
    }
}

static void write_csv(const void *trade, FILE *out)
{
    tl_trade_cloth_write_csv(trade, out);
}

static void write_fit(const void *fit, FILE *out)
{
    tl_trade_fit_write_csv(fit, out);
}

bool tl_trade_cloth_write_report(const struct tl_trade_cloth *trade, const char *folder, tl_error *error)
{
    cJSON *data = cJSON_CreateObject();
    cJSON_AddBoolToObject(data, "complete", trade->complete);
    cJSON_AddNumberToObject(data, "truth_side", trade->truth_side);
    cJSON_AddNumberToObject(data, "truth_error_m", trade->truth_error_m);
    tl_report_add_text(data, "csv", trade, write_csv);
    tl_report_add_text(data, "fit", &trade->fit, write_fit);
    tl_report_add_texts(data, "refusals", trade->refusals, trade->refusal_count);
    return tl_report_write(folder, "report.html", tl_embedded_cloth[0].data, data, error);
}
