/* test_inject PROGRAM LIBRARY [--all] [COMMAND...]: runs each command of toile below (or those that are
 * named) once for each call that the system may refuse, and refuses that one: the n-th write, sync, rename,
 * opening for writing, folder, thread, memory from the system, GL call and allocation. Prints for each
 * command and kind how many calls there are, how many were refused in turn, and how the runs ended.
 *
 * Oracle, of each run: exit status 0, 1 or 2; one line on standard error, or none after 0; no temporary file;
 * no file takes its name before it is synced; every file either as it was before the run or as the program
 * without refusals writes it, and after the status of a run without refusals all of them, standard output
 * included. What depends on what was refused (a page that lists a cell as not drawn) must be whole by its
 * form.
 *
 * Without --all, kinds of many calls are sampled: the first ones, and others at a fixed distance. */
#include "tests/app/inject/folder.h"
#include "tests/app/inject/supervise.h"

#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CHEAP                                                                                                \
    " --garment sheet --avatar none --fabric none --preset draft --size 32x32 --set cloth.edge_m=0.2 --set " \
    "light.regions=24 --set light.pem_size=16 --set light.rounds=1 --quiet"
#define OLD  " --set cloth.settle_s=0.05"
#define THIS " --set cloth.settle_s=0.1"

/* Run by sh in the folder before: makes the inputs, and outputs of the same names that differ. `toile` is the
 * program. */
static const struct command {
    const char *name, *prepare, *arguments;
    int limit; /* runs of one kind without --all */
} commands[] = {
    {"render", "toile render -o a.png" CHEAP OLD, "render -o a.png" CHEAP THIS, 2},
    {"layers", "toile render --aov -o a.exr" CHEAP OLD, "render --aov -o a.exr" CHEAP THIS, 0},
    {"export", "toile export -o a.glb" CHEAP OLD, "export -o a.glb" CHEAP THIS, 1},
    {"export_obj", "toile export -o a.obj" CHEAP OLD, "export -o a.obj" CHEAP THIS, 0},
    {"export_pc2", "toile export -o a.pc2 --frames 0:2" CHEAP OLD, "export -o a.pc2 --frames 0:2" CHEAP THIS,
     0},
    {"sheet", "toile sheet -o out --views front" CHEAP OLD,
     "sheet -o out --views front,back --method unshadowed" CHEAP THIS, 1},
    {"sheet_image", "toile sheet -o a.png --views front" CHEAP OLD,
     "sheet -o a.png --views front,back" CHEAP THIS, 0},
    {"fly", "toile fly -o out --frames 2 >/dev/null" CHEAP OLD, "fly -o out --frames 3 --hash" CHEAP THIS, 1},
    {"check_keep", "mkdir kept",
     "check --frames 1 --every 1 --keep kept --set light.bounce=off --set fabric.stretch_warp=0.28" CHEAP
         THIS,
     0},
    {"env",
     "printf '#?RADIANCE\\n\\n-Y 1 +X 2\\n\\200\\200\\200\\201\\200\\100\\040\\205' >light.hdr; toile env "
     "light.hdr "
     "-o a.exr --layout cube --size 8 --quiet",
     "env light.hdr -o a.exr --layout cube --size 16 --quiet", 100},
    {"env_capture", "toile env --capture -o a.exr --layout cube --size 8 --garment sheet --quiet",
     "env --capture -o a.exr --layout cube --size 16 --garment none --avatar ball --quiet", 0},
    {"gallery", "mkdir out; echo old >out/gallery.csv", "gallery a1 --quick --quiet -o out", 0},
    {"card", "echo '{}' >card.json", "fabric none --card card.json" CHEAP THIS, 0},
    {"bake",
     "printf "
     "'iVBORw0KGgoAAAANSUhEUgAAAAIAAAACEAAAAAAHTY67AAAAEklEQVR4nGNgYPj/n6GBgZEBAA7/AoBiWyn9AAAAAElFTkSuQmCC' "
     "| base64 -d >height.png; toile fabric height.png -o maps --repeat-mm 3 --quiet",
     "fabric height.png -o maps --repeat-mm 4 --height-mm 1 --quiet", 1},
    {"compare", "toile render -o a.exr" CHEAP OLD "; toile render -o b.exr --set camera.yaw_deg=20" CHEAP OLD,
     "compare a.exr b.exr --json --quiet", 100},
};

#define KIND_GL         CALL_KINDS
#define KIND_ALLOCATION (CALL_KINDS + 1)
#define KINDS           (CALL_KINDS + 2)
static const char *const kind_names[KINDS] = {"",       "write",  "sync",  "rename", "open",
                                              "folder", "thread", "pages", "gl",     "allocation"};
#define COPIES 100 /* of one run, in each of which an allocation fails, without --all */

struct bench {
    const char *program, *preload;
    char *root, *folder, *out, *err, *report;
    int takes_all;
    int failures;
    char unsynced[256]; /* a file of the last run that took its place before it was synced */
};

static void shell(const char *line)
{
    if (system(line) != 0) { // NOLINT(cert-env33-c): the commands are those above
        printf("FAILED %s\n", line);
        exit(1);
    }
}

static void reset(const struct bench *bench)
{
    char *line = tl_format("cd '%s' && rm -rf work report && cp -a before work", bench->root);
    shell(line);
    free(line);
}

static void prepare(const struct bench *bench, const struct command *command)
{
    char *line = tl_format("cd '%s' && rm -rf before && mkdir -p before work && cd before && export "
                           "XDG_CACHE_HOME=$PWD/cache && toile() { '%s' \"$@\"; } && { %s; }",
                           bench->root, bench->program, command->prepare);
    shell(line);
    free(line);
}

/* ---- One run ---- */

struct trial {
    int kind;
    long n; /* which call; of KIND_ALLOCATION: each n-th */
};

static void set_number(const char *variable, int is_set, long number)
{
    char text[32];
    snprintf(text, sizeof text, "%ld", number);
    if (is_set)
        setenv(variable, text, 1);
    else
        unsetenv(variable);
}

struct learning {
    struct known_files *known;
    struct bench *bench;
};

static void learn(void *user, const char *from, const char *to, int is_synced)
{
    const struct learning *learning = user;
    if (learning->known)
        known_add(learning->known, learning->bench->folder, from, to);
    if (!is_synced)
        snprintf(learning->bench->unsynced, sizeof learning->bench->unsynced, "%s", to);
}

static int run(struct bench *bench, const struct command *command, struct trial trial,
               struct known_files *learns, long counts[CALL_KINDS])
{
    char *text = tl_format("%s %s", bench->program, command->arguments), *words[64];
    int count = 0;
    for (char *word = strtok(text, " "); word && count < 63; word = strtok(NULL, " "))
        words[count++] = word;
    words[count] = NULL;
    const char *threads = trial.kind == CALL_THREAD ? "2" : "1";
    setenv("OMP_NUM_THREADS", threads, 1);
    setenv("LP_NUM_THREADS", trial.kind == CALL_THREAD ? "2" : "0", 1);
    set_number("INJECT_GL", trial.kind == KIND_GL, trial.n);
    set_number("INJECT_MEMORY", trial.kind == KIND_ALLOCATION, trial.n);
    setenv("LD_PRELOAD", bench->preload, 1);
    struct learning learning = {learns, bench};
    struct supervised supervised = {.folder = bench->folder,
                                    .out = bench->out,
                                    .err = bench->err,
                                    .arguments = words,
                                    .refused =
                                        trial.kind < CALL_KINDS ? (enum call_kind)trial.kind : CALL_NONE,
                                    .n = trial.n,
                                    .on_rename = learn,
                                    .user = &learning};
    reset(bench);
    bench->unsynced[0] = '\0';
    int status = supervise(&supervised, counts);
    unsetenv("LD_PRELOAD");
    free(text);
    return status;
}

/* ---- Judgement ---- */

struct clean {
    int status;
    uint64_t said; /* hash of standard output */
    struct known_files known;
    long calls[KINDS];
};

static char *text_of(const char *path, size_t *size)
{
    char *text = NULL;
    tl_error error;
    *size = 0;
    return tl_file_size(path) > 0 && tl_file_read(path, &text, size, &error) ? text : tl_copy_string("");
}

static uint64_t hash_of(const char *path)
{
    size_t size;
    char *text = text_of(path, &size);
    uint64_t hash = tl_hash(TL_HASH_START, text, size);
    free(text);
    return hash;
}

static int judge_lines(const struct bench *bench, int status, char *problem, size_t room)
{
    size_t size;
    char *text = text_of(bench->err, &size);
    int lines = 0;
    for (size_t i = 0; i < size; i++)
        lines += text[i] == '\n';
    int is_fine = status == 0 ? size == 0 : lines == 1 && strncmp(text, "toile: ", 7) == 0;
    if (!is_fine) {
        for (char *c = text; *c; c++)
            if (*c == '\n')
                *c = '|';
        snprintf(problem, room, "%d lines: %.300s", lines, text);
    }
    free(text);
    return is_fine;
}

static int judge(const struct bench *bench, const struct clean *clean, int status, char *problem, size_t room)
{
    int is_complete = status == clean->status;
    if (status < 0 || status > 2) {
        size_t size;
        char *text = text_of(bench->err, &size);
        text[strcspn(text, "\n")] = '\0';
        snprintf(problem, room, "%s: %.300s", status == STATUS_HANGS ? "hangs" : "ends otherwise", text);
        free(text);
        return 0;
    }
    if (!judge_lines(bench, status, problem, room) ||
        known_find_problem(&clean->known, bench->folder, is_complete, problem, room))
        return 0;
    if (bench->unsynced[0]) {
        snprintf(problem, room, "%s takes its place unsynced", bench->unsynced);
        return 0;
    }
    if (!is_complete || hash_of(bench->out) == clean->said)
        return 1;
    snprintf(problem, room, "standard output differs");
    return 0;
}

/* The line of the preloaded library. */
static long read_report(const struct bench *bench, long *bad, long *first_bad, char problem[64])
{
    long calls = -1;
    FILE *file = fopen(bench->report, "r");
    if (!file || fscanf(file, "%ld %ld %ld %63[^\n]", &calls, bad, first_bad, problem) != 4)
        calls = -1;
    if (file)
        fclose(file);
    return calls;
}

/* Runs without refusals: what they write, that they write it twice, and how many calls they make. */
static int learn_clean(struct bench *bench, const struct command *command, struct clean *clean)
{
    char problem[512];
    long counts[CALL_KINDS], bad, first_bad;
    prepare(bench, command);
    reset(bench);
    known_add_all(&clean->known, bench->folder, KNOWN_BEFORE);
    clean->status = run(bench, command, (struct trial){KIND_GL, 0}, &clean->known, clean->calls);
    if (clean->status == STATUS_CANNOT) {
        printf("skipped: this system has no seccomp_unotify\n");
        exit(77);
    }
    known_add_all(&clean->known, bench->folder, KNOWN_AFTER);
    clean->said = hash_of(bench->out);
    clean->calls[KIND_GL] = read_report(bench, &bad, &first_bad, problem);
    int status = run(bench, command, (struct trial){KIND_ALLOCATION, 1L << 40}, NULL, counts);
    int is_same = judge(bench, clean, status, problem, sizeof problem) && status == clean->status;
    for (int kind = 1; kind < CALL_PAGES; kind++) /* pages depend on where the system puts them */
        is_same &= counts[kind] == clean->calls[kind];
    if (!is_same || clean->status < 0 || clean->status > 1)
        printf("FAILED %s without refusals: exit %d, %d: %s\n", command->name, clean->status, status,
               problem);
    clean->calls[KIND_ALLOCATION] = read_report(bench, &bad, &first_bad, problem);
    if (clean->calls[KIND_ALLOCATION] <= 0) {
        printf("FAILED %s: the preloaded library reports nothing\n", command->name);
        is_same = 0;
    }
    run(bench, command, (struct trial){CALL_THREAD, 0}, NULL, counts);
    clean->calls[CALL_THREAD] = counts[CALL_THREAD];
    bench->failures += !is_same;
    return is_same;
}

/* ---- All of a kind ---- */

struct tally {
    long tried, ended[3], other, bad;
};

static void try_call(struct bench *bench, const struct command *command, const struct clean *clean,
                     struct trial trial, struct tally *tally)
{
    char problem[512];
    long counts[CALL_KINDS];
    int status = run(bench, command, trial, NULL, counts);
    tally->tried++;
    if (status >= 0 && status <= 2)
        tally->ended[status]++;
    else
        tally->other++;
    if (judge(bench, clean, status, problem, sizeof problem))
        return;
    printf("FAILED %s, %s %ld refused: exit %d: %s\n", command->name, kind_names[trial.kind], trial.n, status,
           problem);
    fflush(stdout);
    tally->bad++;
}

/* One run, in whose copies every allocation, or every k-th, fails. */
static void try_allocations(struct bench *bench, const struct command *command, const struct clean *clean,
                            struct tally *tally)
{
    char problem[512];
    long counts[CALL_KINDS], bad = 0, first_bad = 0, calls = clean->calls[KIND_ALLOCATION];
    long stride = bench->takes_all || calls < COPIES ? 1 : calls / COPIES;
    int status = run(bench, command, (struct trial){KIND_ALLOCATION, stride}, NULL, counts);
    calls = read_report(bench, &bad, &first_bad, problem);
    tally->tried = calls / stride;
    tally->ended[2] = tally->tried - bad;
    tally->other = tally->bad = bad;
    if (bad > 0)
        printf("FAILED %s, allocation %ld refused: %s; %ld such calls\n", command->name, first_bad, problem,
               bad);
    if (calls < 0 || !judge(bench, clean, status, problem, sizeof problem)) {
        printf("FAILED %s, around refused allocations: exit %d: %s\n", command->name, status, problem);
        tally->bad++;
    }
}

static void try_kind(struct bench *bench, const struct command *command, const struct clean *clean, int kind)
{
    struct tally tally = {0};
    long calls = clean->calls[kind], limit = bench->takes_all ? calls : command->limit;
    if (kind == KIND_ALLOCATION) {
        try_allocations(bench, command, clean, &tally);
    } else {
        long first = calls <= limit ? calls : limit / 2, rest = calls <= limit ? 0 : limit - first;
        for (long n = 1; n <= first; n++)
            try_call(bench, command, clean, (struct trial){kind, n}, &tally);
        for (long i = 1; i <= rest; i++) /* the last one among them */
            try_call(bench, command, clean, (struct trial){kind, first + (calls - first) * i / rest}, &tally);
    }
    printf("%-12s %-10s %8ld %8ld %8ld %8ld %8ld %8ld %8ld\n", command->name, kind_names[kind], calls,
           tally.tried, tally.ended[0], tally.ended[1], tally.ended[2], tally.other, tally.bad);
    fflush(stdout);
    bench->failures += tally.bad > 0;
}

static int is_wanted(const struct command *command, int is_all, int count, char **names)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], command->name) == 0)
            return 1;
    return count == 0 && (is_all || command->limit > 0);
}

static void make_bench(struct bench *bench)
{
    char root[] = "/tmp/toile_inject.XXXXXX";
    if (!mkdtemp(root)) {
        perror(root);
        exit(1);
    }
    bench->root = tl_copy_string(root);
    bench->folder = tl_format("%s/work", root);
    bench->out = tl_format("%s/said", root);
    bench->err = tl_format("%s/told", root);
    bench->report = tl_format("%s/report", root);
    char *cache = tl_format("%s/cache", bench->folder);
    setenv("XDG_CACHE_HOME", cache, 1);
    free(cache);
    setenv("INJECT_REPORT", bench->report, 1);
    setenv("OMP_WAIT_POLICY", "passive", 1); /* both as main.c sets them, or it would execute itself again */
    setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

static void release_bench(struct bench *bench)
{
    char *line = tl_format("rm -rf '%s'", bench->root);
    shell(line);
    free(line);
    free(bench->root);
    free(bench->folder);
    free(bench->out);
    free(bench->err);
    free(bench->report);
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: test_inject PROGRAM LIBRARY [--all] [COMMAND...]\n");
        return 2;
    }
    struct bench bench = {.program = argv[1], .preload = argv[2]};
    bench.takes_all = argc > 3 && strcmp(argv[3], "--all") == 0;
    int first = bench.takes_all ? 4 : 3;
    make_bench(&bench);
    printf("%-12s %-10s %8s %8s %8s %8s %8s %8s %8s\n", "command", "refused", "calls", "tried", "exit 0",
           "exit 1", "exit 2", "other", "failed");
    for (size_t i = 0; i < TL_COUNT(commands); i++) {
        if (!is_wanted(&commands[i], bench.takes_all, argc - first, argv + first))
            continue;
        struct clean clean = {0};
        if (learn_clean(&bench, &commands[i], &clean))
            for (int kind = 1; kind < KINDS; kind++)
                if (clean.calls[kind] > 0)
                    try_kind(&bench, &commands[i], &clean, kind);
        known_release(&clean.known);
    }
    int failures = bench.failures;
    release_bench(&bench);
    return failures > 0;
}
