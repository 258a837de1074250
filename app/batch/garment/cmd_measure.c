/* toile measure: prints strains and areas of a garment's panels, its openings and its girths, and writes them
 * as CSV. Lengths in mm, areas in cm^2, strains in percent. */
#include "app/batch/commands.h"
#include "app/batch/garment/interval.h"
#include "app/cli/json.h"
#include "app/fit/measures.h"
#include "app/scene/headless.h"
#include "app/settings/command.h"
#include "assets/model.h"
#include "cloth/mesh/topology.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MM      1e3
#define CM2     1e4
#define PERCENT 100

/* Before the garment is draped. */
static bool check_interval(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->interval && arguments->output)
        return tl_fail(error, TL_USAGE, "--interval: is printed, as text or with --json: leave -o out");
    return !(arguments->interval && arguments->first_frame > 0) ||
           tl_fail(error, TL_USAGE, "--interval: is that of frame 0: leave --frame out");
}

static bool check_output(const struct tl_arguments *arguments, tl_error *error)
{
    const char *output = arguments->output;
    struct tl_writer writer;
    if (!output)
        return true;
    if (!tl_path_has_extension(output, "csv"))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of file: end the name in .csv", output);
    if (!tl_writer_begin(&writer, output, error))
        return false;
    tl_writer_abandon(&writer); /* before the garment is draped, this only checks that it can be written */
    return true;
}

/* ---- The table ---- */

/* In percent; what would be printed as -0.00 is 0. */
static double percent(double share)
{
    return fabs(PERCENT * share) < 0.005 ? 0 : PERCENT * share;
}

static void print_spread(const struct tl_spread *spread)
{
    printf("  %7.2f %7.2f %7.2f", percent(spread->mean), percent(spread->p95), percent(spread->max));
}

static void print_panel(const struct tl_panel_measures *panel)
{
    printf("%-24s %9.1f %9.1f", panel->name, CM2 * panel->rest_m2, CM2 * panel->worn_m2);
    print_spread(&panel->warp);
    print_spread(&panel->weft);
    print_spread(&panel->shear);
    printf("\n");
}

static void print_tables(const struct tl_measures *measures)
{
    printf("%-24s %19s  %23s  %23s  %23s\n", "", "area, cm^2", "warp strain, %", "weft strain, %",
           "shear, %");
    printf("%-24s %9s %9s", "panel", "at rest", "worn");
    for (int i = 0; i < 3; i++)
        printf("  %7s %7s %7s", "mean", "p95", "max");
    printf("\n");
    for (size_t i = 0; i < measures->panel_count; i++)
        print_panel(&measures->panels[i]);
    if (measures->panel_count != 1)
        print_panel(&measures->whole);
    printf("\n%-24s %9s %9s %9s %9s\n", "opening, mm", "at rest", "worn", "%", "height");
    for (size_t i = 0; i < measures->opening_count; i++) {
        const struct tl_opening_measures *opening = &measures->openings[i];
        printf("%-24s %9.1f %9.1f %9.2f %9.1f\n", opening->name, MM * opening->rest_m, MM * opening->worn_m,
               opening->rest_m > 0 ? percent(opening->worn_m / opening->rest_m - 1) : 0,
               MM * opening->height_m);
    }
    if (measures->girths[TL_GIRTH_WAIST].height_m > 0)
        printf("\n%-24s %9s %9s %9s %9s %9s\n", "girth, mm", "height", "body", "at rest", "worn", "ease");
    for (int i = 0; i < TL_GIRTHS; i++) {
        const struct tl_girth_measures *girth = &measures->girths[i];
        if (!(girth->height_m > 0))
            continue;
        printf("%-24s %9.0f %9.1f", tl_girth_names[i], MM * girth->height_m, MM * girth->body_m);
        if (girth->rest_m > 0)
            printf(" %9.1f %9.1f %9.1f\n", MM * girth->rest_m, MM * girth->worn_m,
                   MM * (girth->rest_m - girth->body_m));
        else
            printf(" %9s %9s %9s\n", "-", "-", "-");
    }
}

/* Prints the state of the cloth, which shows first that a pattern does not fit. */
static void print_cloth(const tl_session *session)
{
    const struct tl_cloth_report report = tl_session_report(session);
    if (report.vertex_count == 0)
        return;
    printf("cloth, %s: %zu vertices, %zu triangles\n",
           tl_garment_state_names[tl_session_garment_state(session)], report.vertex_count,
           report.triangle_count);
    const struct tl_balance balance = tl_session_balance(session);
    char moved[80] = "";
    if (balance.moved_m > 0)
        snprintf(moved, sizeof moved, "; then its folds swung by %.1f mm rms to rest", MM * balance.moved_m);
    if (balance.residual.rms > 0)
        printf("  out of balance by %.3g of its weight rms, %.3g for 99 %% of the vertices, %.3g at most%s\n",
               balance.residual.rms, balance.residual.high, balance.residual.largest, moved);
    printf(
        "  strain %.2f %% rms, %.0f %% at most; %zu open pairs of seams; %zu vertices inside the body or "
        "the ground, %.1f mm deep; %zu points of the skin beyond the cloth, by up to %.1f mm; %zu pairs of "
        "triangles cross\n\n",
        PERCENT * report.rms_strain, PERCENT * report.max_strain, report.open_seams, report.inside_count,
        MM * report.deepest_m, report.skin_count, MM * report.skin_m, report.crossing_count);
}

/* ---- CSV ---- */

/* Quotes a name, and doubles the quotes in it [RFC 4180]. */
static void write_name(FILE *out, const char *name)
{
    fputc('"', out);
    for (; *name; name++) {
        if (*name == '"')
            fputc('"', out);
        fputc(*name, out);
    }
    fputc('"', out);
}

static void write_strain(FILE *out, const char *panel, const char *quantity, const struct tl_spread *spread)
{
    fputs("panel,", out);
    write_name(out, panel);
    fprintf(out, ",%s,percent,,,%.4f,%.4f,%.4f\n", quantity, PERCENT * spread->mean, PERCENT * spread->p95,
            PERCENT * spread->max);
}

static void write_panel(FILE *out, const struct tl_panel_measures *panel)
{
    fputs("panel,", out);
    write_name(out, panel->name);
    fprintf(out, ",area,cm2,%.3f,%.3f,,,\n", CM2 * panel->rest_m2, CM2 * panel->worn_m2);
    write_strain(out, panel->name, "warp", &panel->warp);
    write_strain(out, panel->name, "weft", &panel->weft);
    write_strain(out, panel->name, "shear", &panel->shear);
}

static void write_lines(FILE *out, const struct tl_measures *measures)
{
    fputs("kind,name,quantity,unit,rest,worn,mean,p95,max\n", out);
    for (size_t i = 0; i < measures->panel_count; i++)
        write_panel(out, &measures->panels[i]);
    if (measures->panel_count != 1)
        write_panel(out, &measures->whole);
    for (size_t i = 0; i < measures->opening_count; i++) {
        const struct tl_opening_measures *opening = &measures->openings[i];
        fputs("opening,", out);
        write_name(out, opening->name);
        fprintf(out, ",length,mm,%.2f,%.2f,,,\n", MM * opening->rest_m, MM * opening->worn_m);
        fputs("opening,", out);
        write_name(out, opening->name);
        fprintf(out, ",height,mm,,%.2f,,,\n", MM * opening->height_m);
    }
    for (int i = 0; i < TL_GIRTHS; i++) {
        const struct tl_girth_measures *girth = &measures->girths[i];
        if (!(girth->height_m > 0))
            continue;
        fprintf(out, "girth,%s,body,mm,%.2f,%.2f,,,\n", tl_girth_names[i], MM * girth->body_m,
                MM * girth->body_m);
        if (girth->rest_m > 0)
            fprintf(out, "girth,%s,garment,mm,%.2f,%.2f,,,\n", tl_girth_names[i], MM * girth->rest_m,
                    MM * girth->worn_m);
    }
}

static bool write_file(const char *path, const struct tl_measures *measures, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    write_lines(writer.stream, measures);
    return tl_writer_commit(&writer, error);
}

/* ---- JSON ---- */

static void add_spread(cJSON *object, const char *key, const struct tl_spread *spread)
{
    cJSON *item = cJSON_AddObjectToObject(object, key);
    cJSON_AddNumberToObject(item, "mean", PERCENT * spread->mean);
    cJSON_AddNumberToObject(item, "p95", PERCENT * spread->p95);
    cJSON_AddNumberToObject(item, "max", PERCENT * spread->max);
}

static void add_panel(cJSON *panels, const struct tl_panel_measures *panel)
{
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "name", panel->name);
    cJSON_AddNumberToObject(item, "rest_cm2", CM2 * panel->rest_m2);
    cJSON_AddNumberToObject(item, "worn_cm2", CM2 * panel->worn_m2);
    add_spread(item, "warp_percent", &panel->warp);
    add_spread(item, "weft_percent", &panel->weft);
    add_spread(item, "shear_percent", &panel->shear);
    cJSON_AddItemToArray(panels, item);
}

static void add_cloth(cJSON *object, const tl_session *session)
{
    const struct tl_cloth_report report = tl_session_report(session);
    if (report.vertex_count == 0)
        return;
    cJSON *item = cJSON_AddObjectToObject(object, "cloth");
    cJSON_AddStringToObject(item, "state", tl_garment_state_names[tl_session_garment_state(session)]);
    cJSON_AddNumberToObject(item, "vertices", (double)report.vertex_count);
    cJSON_AddNumberToObject(item, "triangles", (double)report.triangle_count);
    cJSON_AddNumberToObject(item, "open_seams", (double)report.open_seams);
    cJSON_AddNumberToObject(item, "inside", (double)report.inside_count);
    cJSON_AddNumberToObject(item, "deepest_mm", MM * report.deepest_m);
    cJSON_AddNumberToObject(item, "skin_beyond", (double)report.skin_count);
    cJSON_AddNumberToObject(item, "skin_beyond_mm", MM * report.skin_m);
    cJSON_AddNumberToObject(item, "crossings", (double)report.crossing_count);
    const struct tl_balance balance = tl_session_balance(session);
    if (balance.residual.rms > 0) {
        cJSON_AddNumberToObject(item, "unbalanced_rms", balance.residual.rms);
        cJSON_AddNumberToObject(item, "unbalanced_p99", balance.residual.high);
        cJSON_AddNumberToObject(item, "unbalanced_max", balance.residual.largest);
        cJSON_AddNumberToObject(item, "swung_mm", MM * balance.moved_m);
    }
    cJSON_AddNumberToObject(item, "rms_strain_percent", PERCENT * report.rms_strain);
    cJSON_AddNumberToObject(item, "max_strain_percent", PERCENT * report.max_strain);
}

static cJSON *describe(const tl_session *session, const struct tl_measures *measures,
                       const struct tl_interval *interval)
{
    cJSON *object = cJSON_CreateObject();
    add_cloth(object, session);
    cJSON *panels = cJSON_AddArrayToObject(object, "panels");
    for (size_t i = 0; i < measures->panel_count; i++)
        add_panel(panels, &measures->panels[i]);
    add_panel(panels, &measures->whole);
    cJSON *openings = cJSON_AddObjectToObject(object, "openings_mm");
    for (size_t i = 0; i < measures->opening_count; i++) {
        cJSON *item = cJSON_AddObjectToObject(openings, measures->openings[i].name);
        cJSON_AddNumberToObject(item, "rest", MM * measures->openings[i].rest_m);
        cJSON_AddNumberToObject(item, "worn", MM * measures->openings[i].worn_m);
        cJSON_AddNumberToObject(item, "height", MM * measures->openings[i].height_m);
    }
    cJSON *girths = cJSON_AddObjectToObject(object, "girths_mm");
    for (int i = 0; i < TL_GIRTHS; i++) {
        const struct tl_girth_measures *girth = &measures->girths[i];
        if (!(girth->height_m > 0))
            continue;
        cJSON *item = cJSON_AddObjectToObject(girths, tl_girth_names[i]);
        cJSON_AddNumberToObject(item, "height", MM * girth->height_m);
        cJSON_AddNumberToObject(item, "body", MM * girth->body_m);
        if (girth->rest_m > 0) {
            cJSON_AddNumberToObject(item, "rest", MM * girth->rest_m);
            cJSON_AddNumberToObject(item, "worn", MM * girth->worn_m);
        }
    }
    if (interval)
        cJSON_AddItemToObject(object, "interval_mm", tl_interval_json(interval));
    return object;
}

/* ---- The command ---- */

/* The welded vertices of the garment: those of the cloth, or what is at one place. The caller frees them. */
static uint32_t *weld_of(tl_session *session, const tl_surface *garment)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, garment->vertex_count);
    const tl_cloth *cloth = tl_session_cloth(session);
    if (cloth)
        memcpy(weld, tl_cloth_weld(cloth), garment->vertex_count * sizeof *weld);
    else
        tl_weld_positions(garment->positions, garment->vertex_count, weld);
    return weld;
}

static struct tl_measures measure(tl_session *session)
{
    tl_frame frame = tl_session_frame(session);
    const tl_surface *garment = &frame.surfaces[frame.surface_count - 1]; /* the avatar comes before it */
    const tl_model *body = tl_session_models(session).avatar;
    bool stands = body && !tl_session_plays_clip(session);
    uint32_t *weld = weld_of(session, garment);
    const struct tl_measures_source source = {.garment = tl_session_cut(session),
                                              .positions = garment->positions,
                                              .weld = weld,
                                              .body = stands ? &body->mesh : NULL};
    struct tl_measures measures = tl_measures_take(&source);
    free(weld);
    if (!measures.has_pattern)
        tl_info("%s: has no pattern: strains are those since its first shape (`toile info` states why)",
                source.garment->model.name);
    return measures;
}

/* `interval` may be NULL. */
static bool report(const tl_session *session, const struct tl_measures *measures,
                   const struct tl_interval *interval, const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->output && !write_file(arguments->output, measures, error))
        return false;
    if (arguments->json) {
        tl_json_print(describe(session, measures, interval));
    } else {
        print_cloth(session);
        print_tables(measures);
        if (interval)
            tl_interval_print(interval);
    }
    return true;
}

bool tl_command_measure(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_settings settings;
    if (!check_interval(arguments, error) || !check_output(arguments, error) ||
        !tl_settings_of_command(arguments, true, &settings, error))
        return false;
    settings.scene.smooth = false; /* the cloth itself is measured */
    tl_session *session = tl_session_create(&settings, error);
    bool done = session != NULL;
    if (done && !tl_session_cut(session))
        done = tl_fail(error, TL_USAGE, "measure: the scene has no garment: add --garment FILE");
    if (done)
        done = tl_session_go_to(session, arguments->first_frame, error);
    if (done) {
        struct tl_measures measures = measure(session);
        struct tl_interval interval = {0};
        done = !arguments->interval || tl_interval_take(session, &measures, &interval, error);
        done = done && report(session, &measures, arguments->interval ? &interval : NULL, arguments, error);
        tl_interval_release(&interval);
        tl_measures_release(&measures);
    }
    tl_session_destroy(&session);
    return done;
}
