/* test_faults TABLE PROGRAM [FAULT...]: runs `toile check` without a fault and with each fault of faults.txt
 * (or those that are given), and prints which rows name it. Passes if at least 95 of 100 are named by a row
 * that must name them and no run without a fault breaks a row. */
#include "tests/app/faults/fault_table.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAMED_SHARE 0.95

/* What `run` stands for. Small and short: most faults are in every frame. */
static const struct {
    const char *name, *arguments;
} runs[] = {
    {"rays", ""},
    {"matt",
     "--fabric cotton_plain"}, /* satin's colour is that of its threads: it has next to no diffuse light */
    {"long", "--frames 16 --every 15"}, /* what was not done adds up */
    {"aged", "--frames 30 --every 29 --set light.regions=96 --set light.refresh=24"},
    {"skirt", "--garment skirt --fabric cotton_plain --set camera.pitch_deg=-30"}, /* its inside is seen */
    {"turned", "--set scene.environment_yaw_deg=50"},
    /* By maps satin differs from the reference by more than these faults do. */
    {"paper", "--preset paper --fabric cotton_plain"},
    {"turned_maps", "--preset paper --fabric cotton_plain --set scene.environment_yaw_deg=50"},
    {"paraboloids", "--preset paper --fabric cotton_plain --set light.pem_layout=paraboloid"},
    {"depth",
     "--fabric cotton_plain --set light.visibility=depth --set light.prefilter=slices --set "
     "light.composition=difference "
     "--set light.regions=24 --set light.pem_size=32 --set light.map_size=256 --set light.jitter=false"},
    {"body", "--garment none --avatar figure"}, /* only the camera moves */
    {"filtered", "--no-cache"},                 /* what is kept was made without the fault */
    {"cloth", "--no-cache --set cloth.edge_m=0.05"},
    {"folds", "--no-cache --garment skirt --set cloth.edge_m=0.03"},
    {"glossy", "--fabric none --set material.use_file=false --set material.specular=[0.5,0.5,0.5] --set "
               "material.glossiness=0.95"},
    /* What it shows at grazing angles is most of its light. */
    {"lacquer", "--fabric none --set material.use_file=false --set material.diffuse=[0,0,0] --set "
                "material.specular=[0.005,0.005,0.005] --set material.glossiness=0.95"},
    {"sewn", "--no-cache --fabric denim --set cloth.edge_m=0.05"}, /* its warp is stiffer than its weft */
    {"fuzz", "--fabric velvet"},
    {"sheer", "--fabric voile --frames 2 --size 192x108"}, /* the reference takes its time */
    {"fold", "--fabric cotton_plain --garment skirt --set camera.pitch_deg=-20"},
    /* A cup of metal, seen from below. */
    {"metal",
     "--garment skirt --fabric none --set material.use_file=false --set material.diffuse=[0,0,0] --set "
     "material.specular=[0.9,0.9,0.9] --set material.glossiness=0.8 --set camera.pitch_deg=-30"},
    {"near", "--set camera.distance_m=1 --set camera.target=[0,1.2,0]"},
};

static const char *arguments_of(const char *run)
{
    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++)
        if (strcmp(runs[i].name, run) == 0)
            return runs[i].arguments;
    fprintf(stderr, "faults.txt: no run is called %s\n", run);
    exit(1);
}

/* The standard output of a command, a new string. */
static char *output_of(const char *command)
{
    size_t size = 0, room = 1 << 16;
    char *text = malloc(room + 1);
    FILE *pipe = popen(command, "r");
    if (!pipe || !text)
        exit(1);
    for (size_t read; (read = fread(text + size, 1, room - size, pipe)) > 0;) {
        size += read;
        if (size < room)
            continue;
        room *= 2;
        text = realloc(text, room + 1);
        if (!text)
            exit(1);
    }
    pclose(pipe);
    text[size] = 0;
    return text;
}

static void write_whole(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

/* Runs without a fault are the baseline of those with one. */
static cJSON *check(const char *program, const char *fault, const char *run)
{
    char command[8192], baseline[256];
    snprintf(baseline, sizeof baseline, "faults_%s.json", run);
    snprintf(
        command, sizeof command,
        "TOILE_FAULT='%s' '%s' check --json --quiet --frames 4 --every 3 --size 320x180 %s %s %s 2>/dev/null",
        fault, program, arguments_of(run), fault[0] ? "--baseline" : "", fault[0] ? baseline : "");
    char *text = output_of(command);
    if (!fault[0])
        write_whole(baseline, text);
    cJSON *json = cJSON_Parse(text);
    free(text);
    return json;
}

static int is_among(const char *rows, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = rows; (at = strstr(at, name)); at++)
        if ((at == rows || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return 1;
    return 0;
}

/* Prints the rows that break; returns whether one of `rows` is among them, and counts all. */
static int read_rows(const cJSON *json, const char *rows, int *broken)
{
    int named = 0;
    const cJSON *row;
    *broken = 0;
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(json, "invariants"))
    {
        const char *name = cJSON_GetObjectItem(row, "name")->valuestring;
        if (cJSON_IsTrue(cJSON_GetObjectItem(row, "ok")))
            continue;
        (*broken)++;
        named |= is_among(rows, name);
        const cJSON *worst = cJSON_GetObjectItem(row, "worst");
        if (cJSON_IsNumber(worst))
            printf(" %s %.3g > %.3g;", name, worst->valuedouble,
                   cJSON_GetObjectItem(row, "bound")->valuedouble);
        else
            printf(" %s not a number;", name);
    }
    return named;
}

static int is_wanted(const struct fault *fault, int count, char **names)
{
    if (strcmp(fault->kind, "hook") == 0)
        return 0;
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], fault->name) == 0)
            return 1;
    return count == 0;
}

static int run_clean(const struct fault_table *table, const char *program, int count, char **names)
{
    int alarms = 0;
    for (size_t r = 0; r < sizeof runs / sizeof runs[0]; r++) {
        int used = 0, broken = 0;
        for (size_t i = 0; i < table->count; i++)
            used |=
                strcmp(table->items[i].run, runs[r].name) == 0 && is_wanted(&table->items[i], count, names);
        if (!used)
            continue;
        cJSON *json = check(program, "", runs[r].name);
        printf("%-18s %-6s", runs[r].name, "clean");
        if (!json || (read_rows(json, "", &broken), broken > 0))
            alarms++;
        printf("%s\n", !json ? " no answer" : broken == 0 ? " nothing breaks" : "");
        fflush(stdout);
        cJSON_Delete(json);
    }
    return alarms;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: test_faults TABLE PROGRAM [FAULT...]\n");
        return 2;
    }
    const struct fault_table table = fault_table_read(argv[1]);
    int named = 0, all = 0, alarms = run_clean(&table, argv[2], argc - 3, argv + 3);
    for (size_t i = 0; i < table.count; i++) {
        const struct fault *fault = &table.items[i];
        int broken = 0;
        if (!is_wanted(fault, argc - 3, argv + 3))
            continue;
        cJSON *json = check(argv[2], fault->name, fault->run);
        printf("%-18s", fault->name);
        int is_named = json && read_rows(json, fault->rows, &broken);
        printf(" %s\n", is_named ? "" : !json ? "NO ANSWER" : broken > 0 ? "BY OTHER ROWS" : "MISSED");
        fflush(stdout);
        cJSON_Delete(json);
        named += is_named;
        all++;
    }
    printf("\n%d of %d faults are named; %d of the runs without a fault raise an alarm\n", named, all,
           alarms);
    return named >= NAMED_SHARE * all && alarms == 0 ? 0 : 1;
}
