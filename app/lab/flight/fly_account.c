#include "app/lab/flight/fly_account.h"

#include "app/cli/json.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT_SUMMARY_BYTES ((size_t)16 << 20)

/* -- summary.json -- */

static void add_text(cJSON *object, const char *key, const char *text)
{
    if (text)
        cJSON_AddStringToObject(object, key, text);
    else
        cJSON_AddNullToObject(object, key);
}

static void add_settings(cJSON *summary, const struct tl_settings *settings)
{
    cJSON *object = cJSON_AddObjectToObject(summary, "settings");
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind_const(settings, bindings);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; r < bindings[t].table->row_count; r++) {
            char *key = tl_format("%s.%s", bindings[t].table->name, bindings[t].table->rows[r].name);
            char *text = tl_options_get_text(&bindings[t], &bindings[t].table->rows[r]);
            cJSON_AddStringToObject(object, key, text);
            free(text);
            free(key);
        }
}

static void add_jobs(cJSON *summary, const struct tl_flight *flight)
{
    cJSON *jobs = cJSON_AddArrayToObject(summary, "jobs");
    for (int i = 0; i < flight->job_count; i++) {
        const struct tl_flight_job job = tl_flight_measure_job(flight, i);
        if (!job.ran)
            continue;
        cJSON *object = cJSON_CreateObject();
        add_text(object, "name", flight->job_names[i]);
        tl_json_add_number(object, "ran", job.ran);
        tl_json_add_number(object, "median_ms", job.median_ms);
        tl_json_add_number(object, "total_ms", job.total_ms);
        cJSON_AddItemToArray(jobs, object);
    }
}

static void add_worst(cJSON *summary, const struct tl_flight *flight)
{
    cJSON *worst = cJSON_AddArrayToObject(summary, "worst_frames");
    for (int i = 0; i < flight->worst_count; i++)
        cJSON_AddItemToArray(worst, cJSON_CreateNumber(flight->worst[i].frame));
}

static void add_oracle(cJSON *summary, const struct tl_flight_figures *figures)
{
    cJSON *oracle = cJSON_AddObjectToObject(summary, "oracle");
    tl_json_add_number(oracle, "frames", figures->oracle_frames);
    tl_json_add_number(oracle, "garment_frames", figures->garment_frames);
    tl_json_add_number(oracle, "garment_flip_mean", figures->garment_flip);
    tl_json_add_number(oracle, "garment_flip_worst", figures->garment_flip_worst);
    tl_json_add_number(oracle, "garment_flip_max", figures->garment_flip_max);
    tl_json_add_number(oracle, "covered_flip_mean", figures->flip_mean);
    tl_json_add_number(oracle, "covered_flip_max", figures->flip_max);
    tl_json_add_number(oracle, "rel_rmse", figures->rel_rmse);
}

static void add_replay(cJSON *summary, const struct tl_flight_account *account)
{
    cJSON *replay = cJSON_AddObjectToObject(summary, "replay");
    add_text(replay, "of", account->replay);
    tl_json_add_number(replay, "compared", account->compared);
    tl_json_add_number(replay, "different", account->different);
    tl_json_add_number(replay, "first_different",
                       account->first_different < 0 ? (double)NAN : account->first_different);
}

static const char *const verdicts[] = {"alike", "faster", "slower", "unclear"};

static void add_against(cJSON *summary, const struct tl_flight_account *account)
{
    cJSON *against = cJSON_AddObjectToObject(summary, "against");
    add_text(against, "folder", account->against);
    cJSON *rows = cJSON_AddArrayToObject(against, "rows");
    cJSON *regressions = cJSON_AddArrayToObject(against, "regressions");
    for (int i = 0; i < account->ratio_count; i++) {
        const struct tl_flight_ratio *ratio = &account->ratios[i];
        cJSON *row = cJSON_CreateObject();
        add_text(row, "name", ratio->name);
        tl_json_add_number(row, "this_ms", ratio->this_ms);
        tl_json_add_number(row, "that_ms", ratio->that_ms);
        tl_json_add_number(row, "ratio", ratio->ratio);
        tl_json_add_number(row, "low", ratio->low);
        tl_json_add_number(row, "high", ratio->high);
        add_text(row, "verdict", verdicts[ratio->verdict]);
        cJSON_AddItemToArray(rows, row);
        if (ratio->verdict == TL_FLIGHT_SLOWER)
            cJSON_AddItemToArray(regressions, cJSON_CreateString(ratio->name));
    }
}

cJSON *tl_flight_summary(const struct tl_flight_account *account)
{
    const struct tl_flight *flight = account->flight;
    const struct tl_flight_figures *figures = &account->figures;
    cJSON *summary = cJSON_CreateObject();
    tl_json_add_number(summary, "frames", flight->count);
    tl_json_add_number(summary, "frames_planned", flight->planned);
    tl_json_add_number(summary, "warm_up_frames", flight->warm_up);
    tl_json_add_number(summary, "frame_rate", flight->frame_rate);
    add_text(summary, "stopped", account->stopped);
    tl_json_add_number(summary, "budget_ms", flight->budget_ms > 0 ? flight->budget_ms : (double)NAN);
    tl_json_add_number(summary, "p50_ms", figures->p50_ms);
    tl_json_add_number(summary, "p95_ms", figures->p95_ms);
    tl_json_add_number(summary, "p99_ms", figures->p99_ms);
    tl_json_add_number(summary, "mean_ms", figures->mean_ms);
    tl_json_add_number(summary, "worst_ms", figures->worst_ms);
    tl_json_add_number(summary, "cloth_median_ms", figures->cloth_ms);
    tl_json_add_number(summary, "cpu_p50_ms", figures->cpu_p50_ms);
    tl_json_add_number(summary, "load", figures->load);
    tl_json_add_number(summary, "within_1_1x", figures->within);
    tl_json_add_number(summary, "over_budget_frames",
                       flight->budget_ms > 0 ? figures->over_budget : (double)NAN);
    tl_json_add_number(summary, "prediction_error_median", figures->prediction_error);
    tl_json_add_number(summary, "error_estimate_mean", figures->estimated_error);
    tl_json_add_number(summary, "memory_bytes", (double)figures->memory_bytes);
    add_jobs(summary, flight);
    add_worst(summary, flight);
    if (figures->oracle_frames)
        add_oracle(summary, figures);
    if (account->replay)
        add_replay(summary, account);
    if (account->against)
        add_against(summary, account);
    cJSON *machine = cJSON_AddObjectToObject(summary, "machine");
    tl_json_add_number(machine, "cores", account->cores);
    add_text(machine, "gl", account->gl);
    add_text(summary, "scene", account->scene);
    add_text(summary, "path", account->path);
    add_settings(summary, account->settings);
    return summary;
}

void tl_flight_write_summary(const struct tl_flight_account *account, FILE *out)
{
    cJSON *summary = tl_flight_summary(account);
    char *text = cJSON_Print(summary);
    fprintf(out, "%s\n", text);
    free(text);
    cJSON_Delete(summary);
}

/* -- stdout -- */

static void print_ratios(const struct tl_flight_account *account, FILE *out)
{
    static const char *const words[] = {"", "faster", "SLOWER", "unclear"};
    fprintf(out, "\nagainst %s      this ms    that ms    ratio   95 %% interval\n", account->against);
    for (int i = 0; i < account->ratio_count; i++) {
        const struct tl_flight_ratio *ratio = &account->ratios[i];
        fprintf(out, "  %-14s %9.3f  %9.3f  %7.3f   %.3f to %.3f  %s\n", ratio->name, ratio->this_ms,
                ratio->that_ms, ratio->ratio, ratio->low, ratio->high, words[ratio->verdict]);
    }
    if (account->ratio_count > 0 && account->ratios[0].verdict == TL_FLIGHT_UNCLEAR)
        fputs("no verdict: wall time and CPU time of the frame disagree, or one flight has no CPU time: the "
              "machine was busier in one of them, or the work is spread over other threads\n",
              out);
}

void tl_flight_print(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    const struct tl_flight_figures *figures = &account->figures;
    if (!figures->judged) {
        fprintf(out, "%d frames, all of them warm-up: there are no figures\n", flight->count);
        return;
    }
    fprintf(out, "%d frames: median %.2f ms, 95 %% within %.2f ms, 99 %% within %.2f ms, longest %.2f ms\n",
            flight->count, figures->p50_ms, figures->p95_ms, figures->p99_ms, figures->worst_ms);
    if (isfinite(figures->cpu_p50_ms))
        fprintf(out,
                "CPU time of a frame, all threads: median %.2f ms; load of the machine: %.2f on %d cores\n",
                figures->cpu_p50_ms, figures->load, account->cores);
    if (flight->budget_ms > 0)
        fprintf(out, "%.2f %% of %d frames within 1.1 x %g ms after the first second, %d above %g ms\n",
                100 * figures->within, figures->judged, flight->budget_ms, figures->over_budget,
                flight->budget_ms);
    if (isfinite(figures->prediction_error))
        fprintf(out, "frame times were predicted within %.1f %% (median)\n", 100 * figures->prediction_error);
    if (figures->garment_frames)
        fprintf(out, "%d frames against the reference: FLIP of the garment %.4f, of its worst 5 %% %.4f\n",
                figures->garment_frames, figures->garment_flip, figures->garment_flip_worst);
    if (figures->oracle_frames)
        fprintf(
            out,
            "%d frames against the reference, all covered pixels: mean FLIP %.4f, relative RMSE %.2f %%\n",
            figures->oracle_frames, figures->flip_mean, 100 * figures->rel_rmse);
    if (account->replay && account->compared)
        fprintf(out, "replay of %s: %d of %d images are the same to the bit\n", account->replay,
                account->compared - account->different, account->compared);
    else if (account->replay)
        fprintf(out, "replay of %s: it has no hashes to compare images by: record it with --hash\n",
                account->replay);
    if (account->against)
        print_ratios(account, out);
}

/* -- reading an earlier one -- */

static bool load_summary(const char *file, struct tl_flight_record *out, tl_error *error)
{
    char *data = NULL;
    size_t size = 0;
    if (!tl_file_read_small(file, LIMIT_SUMMARY_BYTES, &data, &size, error))
        return false;
    cJSON *summary = cJSON_ParseWithLength(data, size);
    free(data);
    const cJSON *budget = cJSON_GetObjectItemCaseSensitive(summary, "budget_ms");
    const cJSON *rate = cJSON_GetObjectItemCaseSensitive(summary, "frame_rate");
    const cJSON *settings = cJSON_GetObjectItemCaseSensitive(summary, "settings");
    bool good = cJSON_IsObject(settings) && cJSON_IsNumber(rate) && rate->valuedouble > 0;
    if (good) {
        out->flight.budget_ms = cJSON_IsNumber(budget) && budget->valuedouble > 0 ? budget->valuedouble : 0;
        out->flight.frame_rate = rate->valuedouble;
        out->settings = cJSON_DetachItemFromObjectCaseSensitive(summary, "settings");
    } else {
        tl_fail(error, TL_INPUT,
                "%s: is no summary of a flight: name a folder that `toile fly -o` has written", file);
    }
    cJSON_Delete(summary);
    return good;
}

bool tl_flight_record_load(const char *folder, const struct tl_settings *settings,
                           struct tl_flight_record *out, tl_error *error)
{
    struct tl_flight_record record = {0};
    char *frames = tl_format("%s/frames.csv", folder), *summary = tl_format("%s/summary.json", folder);
    char *path = tl_format("%s/path.yaml", folder);
    bool loaded = tl_flight_read_csv(frames, &record.flight, error) &&
                  load_summary(summary, &record, error) &&
                  tl_path_load(path, settings, &record.flight.path, error);
    free(path);
    free(summary);
    free(frames);
    if (loaded)
        *out = record;
    else
        tl_flight_record_release(&record);
    return loaded;
}

void tl_flight_record_release(struct tl_flight_record *record)
{
    tl_flight_release(&record->flight);
    cJSON_Delete(record->settings);
    record->settings = NULL;
}

/* Times can be compared only between flights that do the same work; a replay needs all options equal. */
bool tl_flight_record_suits(const struct tl_flight_record *record, const char *folder,
                            const struct tl_settings *settings, bool whole, tl_error *error)
{
    const struct tl_option_filter filter = {.any_of = whole ? UINT64_MAX : TL_AFFECTS_WORK};
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    bool suits = true;
    tl_settings_bind_const(settings, bindings);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; suits && r < bindings[t].table->row_count; r++) {
            const struct tl_option *row = &bindings[t].table->rows[r];
            if (!tl_option_passes(row, filter))
                continue;
            char *key = tl_format("%s.%s", bindings[t].table->name, row->name);
            char *own = tl_options_get_text(&bindings[t], row);
            const cJSON *other = cJSON_GetObjectItemCaseSensitive(record->settings, key);
            const char *text = cJSON_IsString(other) ? other->valuestring : "not set";
            if (strcmp(text, own) != 0)
                suits = tl_fail(error, TL_USAGE, "%s: was flown with %s %s, here it is %s: %s", folder, key,
                                text, own,
                                whole ? "a replay needs the same scene and options"
                                      : "times of different work cannot be compared");
            free(own);
            free(key);
        }
    return suits;
}
