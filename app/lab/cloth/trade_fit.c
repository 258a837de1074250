#include "app/lab/cloth/trade_fit.h"

#include "app/fit/measures.h"
#include "app/lab/cloth/worn.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MM           1e3
#define QUICK_EDGE_M 0.05f
#define MOVED_S      1 /* of motion after the drape: each solver then shows where it rests */

/* One choice of settings; what is 0 is the default. */
struct fit_setting {
    const char *name;
    int solver;
    bool quick;
    int substeps;
    double dt;     /* s */
    float edge_m;  /* of another mesh; left out in quick runs */
    bool no_cages; /* settles the fine mesh alone */
    bool no_limit; /* without the limit of strain */
    bool passes;   /* without contact of the cloth with itself */
};
static const struct fit_setting settings[] = {
    {
        .name = "reference",
        .solver = TL_CLOTH_REFERENCE,
        .quick = true,
    },
    {.name = "default", .quick = true},
    {.name = "preview 8", .quick = true, .substeps = 8},
    {.name = "preview 15", .substeps = 15},
    {.name = "preview 60", .substeps = 60},
    {.name = "preview 120", .substeps = 120},
    {.name = "no coarse versions", .no_cages = true},
    {.name = "no strain limit", .no_limit = true},
    {.name = "no self-contact", .passes = true},
    {.name = "edges of 40 mm", .edge_m = 0.04f},
    {.name = "edges of 30 mm", .edge_m = 0.03f},
    {.name = "edges of 14 mm", .edge_m = 0.014f},
    {.name = "edges of 10 mm", .edge_m = 0.01f},
};

static const char *const figure_names[TL_FIT_FIGURES] = {
    "hem_height", "neck", "waist", "bust_ease", "waist_ease", "hip_ease",
};

static struct tl_cloth_params params_of(const struct fit_setting *setting, float edge_m)
{
    struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
    params.solver = setting->solver;
    params.edge_m = edge_m;
    params.substeps = setting->substeps > 0 ? setting->substeps : params.substeps;
    params.dt = setting->dt > 0 ? setting->dt : params.dt;
    params.cages = params.cages && !setting->no_cages;
    params.strain_limit = setting->no_limit ? 0 : params.strain_limit;
    params.self_contact = !setting->passes;
    return params;
}

static const struct tl_opening_measures *opening_of(const struct tl_measures *measures, const char *name)
{
    for (size_t i = 0; i < measures->opening_count; i++)
        if (strcmp(measures->openings[i].name, name) == 0)
            return &measures->openings[i];
    return NULL;
}

static double ease_of(const struct tl_measures *measures, int level)
{
    const struct tl_girth_measures *girth = &measures->girths[level];
    return girth->rest_m > 0 ? girth->rest_m - girth->body_m : (double)NAN;
}

static void take_figures(const tl_garment *garment, const struct tl_worn *worn, double out[TL_FIT_FIGURES])
{
    vec3s *positions = TL_NEW_ARRAY(vec3s, garment->model.mesh.vertex_count);
    tl_cloth_positions(worn->cloth, positions);
    const struct tl_measures_source source = {garment, positions, tl_cloth_weld(worn->cloth),
                                              &worn->form.model.mesh};
    struct tl_measures measures = tl_measures_take(&source);
    const struct tl_opening_measures *hem = opening_of(&measures, "hem"),
                                     *neck = opening_of(&measures, "neck"),
                                     *waist = opening_of(&measures, "waist");
    out[TL_FIT_HEM] = hem ? hem->height_m : (double)NAN;
    out[TL_FIT_NECK] = neck ? neck->worn_m : (double)NAN;
    out[TL_FIT_WAIST] = waist ? waist->worn_m : (double)NAN;
    out[TL_FIT_BUST_EASE] = ease_of(&measures, TL_GIRTH_BUST);
    out[TL_FIT_WAIST_EASE] = ease_of(&measures, TL_GIRTH_WAIST);
    out[TL_FIT_HIP_EASE] = ease_of(&measures, TL_GIRTH_HIP);
    tl_measures_release(&measures);
    free(positions);
}

static bool measure(const char *name, const struct fit_setting *setting, float edge_m, size_t compared_with,
                    struct tl_trade_fit *out, tl_error *error)
{
    const struct tl_cloth_params params = params_of(setting, edge_m);
    tl_garment garment;
    if (!tl_garment_cut(name, edge_m, &garment, error))
        return false;
    struct tl_worn worn;
    bool done = tl_worn_settle(&garment, &params, &worn, error);
    for (int frame = 0; done && frame < MOVED_S * params.frame_rate; frame++)
        done = tl_cloth_step(worn.cloth, worn.collider, error);
    if (done) {
        struct tl_cloth_report report = tl_cloth_measure(worn.cloth, NULL);
        struct tl_trade_fit_row row = {.garment = name,
                                       .name = setting->name,
                                       .edge_m = (double)edge_m,
                                       .rms_strain = report.rms_strain,
                                       .taken = worn.taken,
                                       .settled = report.settled,
                                       .particles = report.vertex_count,
                                       .compared_with = compared_with};
        take_figures(&garment, &worn, row.figures);
        out->rows = tl_resize(out->rows, out->row_count + 1, sizeof *out->rows);
        out->rows[out->row_count++] = row;
    }
    tl_worn_release(&worn);
    tl_garment_release(&garment);
    return done;
}

bool tl_trade_fit(bool quick, struct tl_trade_fit *out, tl_error *error)
{
    static const char *const garments[] = {"dress", "skirt"};
    const struct tl_cloth_params *defaults = tl_cloth_options.defaults;
    const int setting_count = (int)TL_COUNT(settings), garment_count = quick ? 1 : (int)TL_COUNT(garments);
    struct tl_progress progress = tl_progress_begin("measuring what settings do to a fit");
    bool done = true;
    for (int g = 0; g < garment_count; g++) {
        size_t reference = out->row_count;
        for (int i = 0; done && i < setting_count; i++) {
            const struct fit_setting *setting = &settings[i];
            float edge_m = setting->edge_m > 0 ? setting->edge_m : quick ? QUICK_EDGE_M : defaults->edge_m;
            if (!quick || setting->quick)
                done = measure(garments[g], setting, edge_m, reference, out, error);
            tl_progress_update(&progress, g * setting_count + i + 1, garment_count * setting_count);
        }
    }
    tl_progress_end(&progress);
    return done;
}

void tl_trade_fit_release(struct tl_trade_fit *fit)
{
    free(fit->rows);
    *fit = (struct tl_trade_fit){0};
}

/* ---- Results ---- */

/* Empty where the garment has no such figure. */
static void print_mm(FILE *out, double value_m)
{
    if (isfinite(value_m))
        fprintf(out, ",%.3f", MM * value_m);
    else
        fputc(',', out);
}

void tl_trade_fit_write_csv(const struct tl_trade_fit *fit, FILE *out)
{
    fputs("garment,name,edge_mm,particles,settled,cpu_ms,wall_ms,rms_strain", out);
    for (int k = 0; k < TL_FIT_FIGURES; k++)
        fprintf(out, ",%s_mm", figure_names[k]);
    for (int k = 0; k < TL_FIT_FIGURES; k++)
        fprintf(out, ",%s_off_mm", figure_names[k]);
    fputc('\n', out);
    for (size_t i = 0; i < fit->row_count; i++) {
        const struct tl_trade_fit_row *row = &fit->rows[i], *truth = &fit->rows[row->compared_with];
        fprintf(out, "%s,\"%s\",%g,%zu,%d,%.1f,%.1f,%.6g", row->garment, row->name, MM * row->edge_m,
                row->particles, row->settled, row->taken.cpu_ms, row->taken.wall_ms, row->rms_strain);
        for (int k = 0; k < TL_FIT_FIGURES; k++)
            print_mm(out, row->figures[k]);
        for (int k = 0; k < TL_FIT_FIGURES; k++)
            print_mm(out, row->figures[k] - truth->figures[k]);
        fputc('\n', out);
    }
}
