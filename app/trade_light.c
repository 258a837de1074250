/* The trade of light: every contender draws the same recorded motion and then its last frame at rest, once
 * for each look of the garment; the oracle draws each frame that is compared once. */
#include "app/trade_light.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct tl_look_row tl_looks[TL_LOOK_COUNT] = {
    {"g=0", "glossiness 0", 0.5f, 0.5f, 0, false},
    {"g=0.7", "glossiness 0.7", 0.5f, 0.5f, 0.7f, false},
    {"g=0.95", "glossiness 0.95", 0.5f, 0.5f, 0.95f, false},
    {"irradiance", "irradiance", 1, 0, 0, false},
    {"sky", "visibility of a uniform sky", 1, 0, 0, true},
};

struct contender_row {
    const char *group;
    struct tl_choice choice;
    bool quick;   /* takes part in a quick run */
    bool picture; /* is shown in the comparison of figure 6 */
};

#define PAPER(...)                                                                                           \
    "paper",                                                                                                 \
    {                                                                                                        \
        "light.lobe=dual", __VA_ARGS__                                                                       \
    }
static const struct contender_row contenders[] = {
    {"presets", {"paper", PAPER(NULL)}, true, true},
    {"presets", {"draft", "draft", {NULL}}, true, false},
    {"presets", {"review", "review", {NULL}}, true, true},
    {"presets", {"final", "final", {NULL}}, false, true},

    {"regions, paper", {"paper N=6", PAPER("light.regions=6")}, true, false},
    {"regions, paper", {"paper N=24", PAPER("light.regions=24")}, false, false},
    {"regions, paper", {"paper N=48", PAPER("light.regions=48")}, false, false},
    {"regions, paper", {"paper N=96", PAPER(NULL)}, false, false},
    {"regions, paper", {"paper N=192", PAPER("light.regions=192")}, false, false},
    {"regions, paper", {"paper N=384", PAPER("light.regions=384", "light.map_size=128")}, false, false},

    {"regions, rays", {"rays N=24", "review", {"light.regions=24", "light.refresh=6"}}, false, false},
    {"regions, rays", {"rays N=48", "review", {"light.regions=48", "light.refresh=6"}}, false, false},
    {"regions, rays", {"rays N=96", "review", {"light.regions=96", "light.refresh=12"}}, false, false},
    {"regions, rays", {"rays N=192", "review", {"light.regions=192", "light.refresh=24"}}, false, false},
    {"regions, rays", {"rays N=384", "review", {"light.regions=384", "light.refresh=48"}}, false, false},
    {"regions, rays", {"rays N=384 all", "review", {"light.regions=384", "light.refresh=0"}}, false, false},

    {"map size", {"paper 32", PAPER("light.map_size=32")}, false, false},
    {"map size", {"paper 64", PAPER("light.map_size=64")}, true, false},
    {"map size", {"paper 128", PAPER("light.map_size=128")}, false, false},
    {"map size", {"paper 256", PAPER(NULL)}, false, false},
    {"map size", {"paper 512", PAPER("light.map_size=512")}, false, false},

    {"filter", {"no filter", PAPER("light.filter=none")}, false, false},
    {"filter", {"Gauss", PAPER("light.filter=gauss")}, false, false},
    {"filter", {"cosine", PAPER("light.filter=cosine")}, false, false},
    {"filter", {"box", PAPER("light.filter=box")}, false, false},
    {"filter", {"root of cosine", PAPER(NULL)}, false, false},
    {"filter", {"exact slices", PAPER("light.prefilter=slices")}, false, false},

    {"back-end", {"vsm, unblurred", PAPER("light.prefilter=slices", "light.blur_m=0")}, false, false},
    {"back-end", {"depth", PAPER("light.prefilter=slices", "light.visibility=depth")}, false, false},
    {"back-end",
     {"depth, sphere cut, sun",
      PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere", "light.sun=true")},
     false,
     false},
    {"back-end",
     {"depth, difference", PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere",
                                 "light.sun=true", "light.composition=difference")},
     false,
     false},
    {"back-end",
     {"depth, ratio", PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere",
                            "light.sun=true", "light.composition=ratio")},
     false,
     false},

    {"rounds", {"rays, 64 rounds", "review", {"light.jitter=true", "light.rounds=64"}}, false, false},
    {"rounds",
     {"depth maps, 32 rounds",
      "paper",
      {"light.lobe=dual", "light.prefilter=slices", "light.visibility=depth", "light.jitter=true",
       "light.rounds=32", "light.map_size=128"}},
     false,
     false},

    {"other methods", {"no occlusion", "review", {"light.method=unshadowed"}}, true, true},
    {"other methods", {"ambient occlusion", "review", {"light.method=ao"}}, false, true},
    {"other methods", {"ambient occlusion, coloured", "review", {"light.method=ao_colour"}}, false, true},
    {"other methods", {"lights", PAPER("light.method=lights")}, true, true},
};

#define QUICK_ROUNDS 4

/* Frames before the first measured one, and those measured; the last of them is the one that comes to rest.
 */
struct schedule {
    int warm, measured, looks;
};

struct run {
    struct tl_stage *stage;
    struct tl_trade *trade;
    struct schedule schedule;
    bool quick;
    tl_film *film;
    tl_environment sky;
    struct tl_contender oracle;
    struct tl_truth
        truths[2]; /* of the current look: the first and the last measured frame; empty until needed */
    int look;
};

static tl_frame frame_of(const struct run *run, int number)
{
    tl_frame frame = tl_film_frame(run->film, number);
    if (tl_looks[run->look].sky) {
        frame.environment = &run->sky;
        frame.environment_revision = 0; /* sessions count from 1 */
    }
    return frame;
}

static int last_frame(const struct run *run)
{
    return run->schedule.warm + run->schedule.measured - 1;
}

static bool keep_picture(struct run *run, struct tl_contender *contender, const char *name,
                         const struct tl_measured_error *measured, tl_error *error)
{
    struct tl_trade_picture picture = {.name = name, .look = run->look, .error = *measured};
    tl_image image = {0};
    bool kept = tl_renderer_show_image(contender->renderer, &image, error) &&
                tl_image_encode_png(name, &image, &picture.png, &picture.size, error);
    tl_image_release(&image);
    if (!kept)
        return false;
    struct tl_trade *trade = run->trade;
    trade->pictures = tl_resize(trade->pictures, trade->picture_count + 1, sizeof *trade->pictures);
    trade->pictures[trade->picture_count++] = picture;
    return true;
}

static bool need_truth(struct run *run, int number, const struct tl_truth **truth, tl_error *error)
{
    bool last = number == last_frame(run);
    struct tl_truth *kept = &run->truths[last];
    *truth = kept;
    if (kept->image.texels)
        return true;
    tl_frame frame = frame_of(run, number);
    return tl_truth_draw(&run->oracle, &frame, kept, error) &&
           (!last || keep_picture(run, &run->oracle, "the truth", &(struct tl_measured_error){0}, error));
}

static bool compare(struct run *run, struct tl_contender *contender, int number,
                    struct tl_measured_error *out, tl_error *error)
{
    const struct tl_truth *truth;
    return need_truth(run, number, &truth, error) && tl_contender_compare(contender, truth, out, error);
}

static void add_row(struct run *run, const struct contender_row *row, const struct tl_contender *contender,
                    int draws, const double *cpu_ms, const double *wall_ms, int count,
                    struct tl_measured_error measured)
{
    struct tl_trade *trade = run->trade;
    trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
    trade->rows[trade->row_count++] = (struct tl_trade_row){
        .group = row->group,
        .name = row->choice.name,
        .look = run->look,
        .rest = draws > 1,
        .draws = draws,
        .light = contender->settings.light,
        .taken = {tl_median(cpu_ms, (size_t)count), tl_median(wall_ms, (size_t)count)},
        .error = measured,
        .memory = tl_renderer_memory(contender->renderer),
    };
}

static bool draw(struct run *run, struct tl_contender *contender, int number, struct tl_taken *taken,
                 tl_error *error)
{
    if (tl_interrupted())
        return tl_fail(error, TL_INTERRUPTED, "trade: stopped: what was measured is written");
    tl_frame frame = frame_of(run, number);
    return tl_contender_draw(contender, &frame, taken, error);
}

#define FRAMES_MAX     16
#define REST_DRAWS_MAX 1024

static bool measure_motion(struct run *run, const struct contender_row *row, struct tl_contender *contender,
                           tl_error *error)
{
    int warm = run->schedule.warm, count = run->schedule.measured;
    double cpu_ms[FRAMES_MAX], wall_ms[FRAMES_MAX];
    struct tl_taken taken = {0};
    struct tl_measured_error first = {0}, last;
    for (int number = tl_contender_remembers(contender) ? 0 : warm - 1; number < warm; number++)
        if (!draw(run, contender, number, &taken, error))
            return false;
    for (int i = 0; i < count; i++) {
        if (!draw(run, contender, warm + i, &taken, error))
            return false;
        cpu_ms[i] = taken.cpu_ms;
        wall_ms[i] = taken.wall_ms;
        if (i == 0 && !compare(run, contender, warm, &first, error))
            return false;
    }
    if (!compare(run, contender, warm + count - 1, &last, error))
        return false;
    add_row(run, row, contender, 1, cpu_ms, wall_ms, count,
            (struct tl_measured_error){.rel_rmse = 0.5 * (first.rel_rmse + last.rel_rmse),
                                       .standard_error = 0.5 * (first.standard_error + last.standard_error),
                                       .flip_mean = 0.5 * (first.flip_mean + last.flip_mean),
                                       .max_abs = fmax(first.max_abs, last.max_abs),
                                       .covered = last.covered});
    return !row->picture || keep_picture(run, contender, row->choice.name, &last, error);
}

/* The last frame again until nothing is left to average; a row whenever its draws have doubled, and at the
 * end. */
static bool measure_rest(struct run *run, const struct contender_row *row, struct tl_contender *contender,
                         tl_error *error)
{
    int draws = run->quick ? QUICK_ROUNDS : REST_DRAWS_MAX, since = 0;
    double cpu_ms[REST_DRAWS_MAX], wall_ms[REST_DRAWS_MAX];
    bool done = true, at_rest = false;
    for (int drawn = 2; done && !at_rest && drawn <= draws; drawn++) {
        struct tl_taken taken = {0};
        struct tl_measured_error measured;
        done = draw(run, contender, last_frame(run), &taken, error);
        cpu_ms[since] = taken.cpu_ms;
        wall_ms[since++] = taken.wall_ms;
        at_rest = tl_renderer_is_at_rest(contender->renderer);
        if (!done || ((drawn & (drawn - 1)) != 0 && drawn != draws && !at_rest))
            continue;
        done = compare(run, contender, last_frame(run), &measured, error);
        if (done)
            add_row(run, row, contender, drawn, cpu_ms, wall_ms, since, measured);
        since = 0;
    }
    return done;
}

/* A contender that is drawn with the settings of an earlier one has measured the same. */
static bool repeat(struct run *run, const struct contender_row *row, const struct tl_contender *contender)
{
    struct tl_trade *trade = run->trade;
    size_t count = trade->row_count;
    const char *earlier = NULL;
    for (size_t i = 0; i < count; i++) {
        struct tl_trade_row same = trade->rows[i];
        if (same.look != run->look ||
            !tl_options_equal(&tl_light_options, &same.light, &contender->settings.light))
            continue;
        if (earlier && strcmp(earlier, same.name) != 0)
            continue; /* itself a repetition */
        earlier = same.name;
        same.group = row->group;
        same.name = row->choice.name;
        trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
        trade->rows[trade->row_count++] = same;
    }
    return earlier != NULL;
}

static void note_refusal(struct tl_trade *trade, const char *name, const tl_error *error)
{
    tl_warn("trade: %s: %s", name, error->message);
    for (size_t i = 0; i < trade->refusal_count; i++)
        if (strncmp(trade->refusals[i], name, strlen(name)) == 0)
            return; /* the same for every look */
    trade->refusals = tl_resize(trade->refusals, trade->refusal_count + 1, sizeof *trade->refusals);
    trade->refusals[trade->refusal_count++] = tl_format("%s: %s", name, error->message);
}

/* A contender that the renderer refuses is noted, and the others go on; only Ctrl-C and a failing oracle end
 * the run. */
static bool measure_contender(struct run *run, const struct contender_row *row, tl_error *error)
{
    struct tl_contender contender;
    tl_error refusal = {0};
    bool done =
        tl_contender_create(&contender, run->stage->gpu, &row->choice, &run->stage->settings, &refusal);
    if (done && !repeat(run, row, &contender))
        done = measure_motion(run, row, &contender, &refusal) && measure_rest(run, row, &contender, &refusal);
    tl_contender_release(&contender);
    if (done)
        return true;
    if (refusal.code != TL_USAGE) {
        *error = refusal;
        return false;
    }
    note_refusal(run->trade, row->choice.name, &refusal);
    return true;
}

static bool begin_look(struct run *run, int look, tl_error *error)
{
    struct tl_material_params *material = &run->stage->settings.material;
    run->look = look;
    tl_truth_release(&run->truths[0]);
    tl_truth_release(&run->truths[1]);
    *material = (struct tl_material_params){.glossiness = tl_looks[look].glossiness};
    for (int c = 0; c < 3; c++) {
        material->diffuse[c] = tl_looks[look].diffuse;
        material->specular[c] = tl_looks[look].specular;
    }
    return tl_session_apply(run->stage->session, &run->stage->settings, error);
}

static bool measure_all(struct run *run, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring the trade of light");
    const double contender_count = (int)TL_COUNT(contenders);
    bool done = true;
    for (int i = 0; done && i < run->schedule.looks; i++) {
        done = begin_look(run, run->quick ? TL_LOOK_SATIN : i, error);
        for (size_t c = 0; done && c < TL_COUNT(contenders); c++) {
            if (!run->quick || contenders[c].quick)
                done = measure_contender(run, &contenders[c], error);
            tl_progress_update(&progress, i * contender_count + (double)c + 1,
                               contender_count * run->schedule.looks);
        }
    }
    tl_progress_end(&progress);
    return done;
}

bool tl_trade_light(struct tl_stage *stage, bool quick, struct tl_trade *out, tl_error *error)
{
    struct run run = {
        .stage = stage,
        .trade = out,
        .schedule = quick ? (struct schedule){2, 2, 1} : (struct schedule){16, 3, TL_LOOK_COUNT},
        .quick = quick,
        .sky = tl_environment_constant(1, 1, 1),
    };
    const struct tl_choice truth = tl_choice_oracle();
    *out = (struct tl_trade){.width = stage->settings.image.width,
                             .height = stage->settings.image.height,
                             .quick = quick,
                             .environment = tl_session_frame(stage->session).environment};
    run.film = tl_film_record(stage->session, run.schedule.warm + run.schedule.measured, error);
    bool done = run.film && tl_contender_create(&run.oracle, stage->gpu, &truth, &stage->settings, error);
    if (done) {
        out->film = tl_film_report(run.film);
        done = out->complete = measure_all(&run, error);
    }
    tl_contender_release(&run.oracle);
    tl_truth_release(&run.truths[0]);
    tl_truth_release(&run.truths[1]);
    tl_environment_release(&run.sky);
    tl_film_destroy(&run.film);
    return done;
}

void tl_trade_release(struct tl_trade *trade)
{
    for (size_t i = 0; i < trade->picture_count; i++)
        free(trade->pictures[i].png);
    for (size_t i = 0; i < trade->refusal_count; i++)
        free(trade->refusals[i]);
    free(trade->pictures);
    free(trade->refusals);
    free(trade->rows);
    *trade = (struct tl_trade){0};
}
