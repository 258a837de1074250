/* toile check: every frame of a scene against the table of invariants. */
#include "app/cli/json.h"
#include "app/lab/check/baseline.h"
#include "app/lab/check/commands.h"
#include "app/scene/headless.h"
#include "app/settings/command.h"
#include "config/base/file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define FRAMES 300
#define EVERY  10

#define FRAMES_MAX 1000000

static bool is_broken(const struct tl_verdict *verdict)
{
    return verdict->finding.is_measured && !verdict->ok;
}

static void print_table(const struct tl_check_outcome *outcome)
{
    printf("%-20s %-4s %12s %10s %6s  %s\n", "invariant", "", "worst", "bound", "frame", "where");
    for (size_t i = 0; i < tl_invariant_count; i++) {
        const struct tl_verdict *verdict = &outcome->verdicts.items[i];
        if (!verdict->finding.is_measured)
            printf("%-20s %-4s %12s\n", tl_invariants[i].name, "-", "not measured");
        else
            printf("%-20s %-4s %12.4g %10.4g %6d  %s\n", tl_invariants[i].name, verdict->ok ? "ok" : "FAIL",
                   verdict->finding.worst, verdict->finding.bound, verdict->frame, verdict->finding.place);
    }
    for (size_t i = 0; i < tl_invariant_count; i++)
        if (is_broken(&outcome->verdicts.items[i]))
            printf("\n%s: %s; its bound: %s\n", tl_invariants[i].name, tl_invariants[i].says,
                   tl_invariants[i].why);
    printf("\n%d frames, %d invariants broken, hash %016" PRIx64 "\n", outcome->verdicts.frames,
           tl_verdicts_failed(&outcome->verdicts), outcome->hash);
}

static void print_json(const struct tl_check_outcome *outcome, uint64_t scene, const char *keep)
{
    cJSON *object = cJSON_CreateObject();
    char hash[17], scene_hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, outcome->hash);
    snprintf(scene_hash, sizeof scene_hash, "%016" PRIx64, scene);
    cJSON_AddNumberToObject(object, "frames", outcome->verdicts.frames);
    cJSON_AddNumberToObject(object, "failed", tl_verdicts_failed(&outcome->verdicts));
    cJSON_AddStringToObject(object, "hash", hash);
    cJSON_AddStringToObject(object, "scene", scene_hash);
    tl_json_add_number(object, "elastic_j", outcome->elastic_j);
    if (outcome->is_kept)
        cJSON_AddStringToObject(object, "kept", keep);
    cJSON *invariants = cJSON_AddArrayToObject(object, "invariants");
    for (size_t i = 0; i < tl_invariant_count; i++) {
        const struct tl_verdict *verdict = &outcome->verdicts.items[i];
        cJSON *row = cJSON_CreateObject();
        bool measured = verdict->finding.is_measured;
        cJSON_AddStringToObject(row, "name", tl_invariants[i].name);
        tl_json_add_number(row, "worst", measured ? verdict->finding.worst : NAN);
        tl_json_add_number(row, "bound", measured ? verdict->finding.bound : tl_invariants[i].bound);
        tl_json_add_number(row, "frame", measured ? (double)verdict->frame : (double)NAN);
        cJSON_AddBoolToObject(row, "ok", !measured || verdict->ok);
        cJSON_AddBoolToObject(row, "measured", measured);
        cJSON_AddStringToObject(row, "place", measured ? verdict->finding.place : "");
        cJSON_AddStringToObject(row, "says", tl_invariants[i].says);
        cJSON_AddStringToObject(row, "why", tl_invariants[i].why);
        cJSON_AddItemToArray(invariants, row);
    }
    tl_json_print(object);
}

static bool judge(const struct tl_check_outcome *outcome, const char *keep, tl_error *error)
{
    if (outcome->broken < 0)
        return true;
    const char *name = tl_invariants[outcome->broken].name;
    const char *place = outcome->found.place;
    if (outcome->is_kept)
        return tl_fail(error, TL_UNSTABLE,
                       "check: %s breaks at frame %d (%s): `toile view %s/scene.yaml` opens it, "
                       "`toile check %s/run.yaml --frames %d` runs it again",
                       name, outcome->broken_frame, place, keep, keep, outcome->broken_frame + 1);
    return tl_fail(error, TL_UNSTABLE, "check: %s breaks at frame %d (%s): --keep FOLDER keeps it", name,
                   outcome->broken_frame, place);
}

bool tl_command_check(const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_check_params params = {.frames = arguments->frame_count > 0 ? arguments->frame_count : FRAMES,
                                     .every = arguments->every > 0 ? arguments->every : EVERY,
                                     .furnace = arguments->furnace,
                                     .still = arguments->still,
                                     .budget_ms = arguments->budget_ms,
                                     .keep = arguments->keep};
    struct tl_headless headless;
    struct tl_settings settings;
    struct tl_check_outcome outcome;
    struct tl_check_baseline baseline;
    if (params.frames > FRAMES_MAX)
        return tl_fail(error, TL_USAGE, "--frames: %d: at most %d", params.frames, FRAMES_MAX);
    if ((params.keep && !tl_folder_make(params.keep, error)) ||
        !tl_settings_of_command(arguments, false, &settings, error) ||
        !tl_headless_may_repeat(&settings, "check", error) || !tl_headless_open(&headless, &settings, error))
        return false;
    const uint64_t scene = tl_baseline_scene(&headless.settings, &params);
    if (arguments->baseline && !tl_baseline_load(arguments->baseline, scene, &baseline, error)) {
        tl_headless_release(&headless);
        return false;
    }
    params.baseline = arguments->baseline ? &baseline : NULL;
    bool done = tl_check_play(&headless, &params, &outcome, error);
    bool has_found = outcome.verdicts.frames > 0; /* even where it could not go on */
    if (has_found && arguments->json)
        print_json(&outcome, scene, params.keep);
    else if (has_found)
        print_table(&outcome);
    tl_headless_release(&headless);
    return done && judge(&outcome, params.keep, error);
}
