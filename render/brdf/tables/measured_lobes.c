#include "render/brdf/tables/measured_lobes.h"

#include "config/base/memory.h"
#include "render/brdf/facets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LOBES_MAX (1 + TL_THREADS_MAX)
#define WIDTHS    (2 * LOBES_MAX)
#define COLUMNS   (1 + 2 * LOBES_MAX) /* even light; each lobe, and it times Schlick's share */
#define COLOURS   (2 + TL_THREADS_MAX)
#define ROWS_MAX  10000 /* about as many samples are read ... */
#define FEW_ROWS  2000  /* ... and, for a first search, these */
#define LOWEST    1e-3f /* cosine; what lies nearer to the horizon is not seen */
#define BLOCKS    32

/* ---- Samples, and what each stands for ---- */

struct lobe_row {
    float slope_x, slope_y, steep, cos_a, cos_b; /* as ward_lobe takes them */
    float share;                                 /* schlick_share */
    float weight;
    vec3s wanted; /* f_r cos a */
};

struct lobe_rows {
    struct lobe_row *items;
    int count;
};

#define HALF_RINGS    12 /* closer to one another near the normal, where gloss is narrow */
#define HALF_TURNS    8
#define OTHER_RINGS   6
#define OTHER_TURNS   8
#define CELLS         (HALF_RINGS * HALF_TURNS * OTHER_RINGS * OTHER_TURNS)
#define STRAIGHT      ((float)M_PI_2)
#define RING(x)       (STRAIGHT * (float)(x) * (float)(x) / (HALF_RINGS * HALF_RINGS))
#define TURN(y, x, n) ((int)((float)(n) * (atan2f(y, x) / (4 * STRAIGHT) + 0.5f)) % (n))

/* The cell of h, and of l about it. *ring: that of h. */
static int cell_of(const struct tl_reflectance_sample *sample, vec3s h, int *ring)
{
    const float flat = hypotf(h.x, h.y), x = flat > 0 ? h.x / flat : 1, y = flat > 0 ? h.y / flat : 0;
    const vec3s towards = {{h.z * x, h.z * y, -flat}}, across = {{-y, x, 0}};
    *ring = (int)fminf(HALF_RINGS * sqrtf(acosf(fminf(h.z, 1)) / STRAIGHT), HALF_RINGS - 1);
    const int other = (int)fminf(OTHER_RINGS * fmaxf(glms_vec3_dot(h, sample->l), 0), OTHER_RINGS - 1);
    const int turn = TURN(glms_vec3_dot(across, sample->l), glms_vec3_dot(towards, sample->l), OTHER_TURNS);
    return ((*ring * HALF_TURNS + TURN(h.y, h.x, HALF_TURNS)) * OTHER_RINGS + other) * OTHER_TURNS + turn;
}

/* Every so many, but in no step that a grid of angles has. */
static bool is_kept(size_t i, size_t count, size_t max)
{
    return fmod(0.6180339887498949 * (double)i, 1) * (double)count < (double)max;
}

static struct lobe_rows rows_of(const struct tl_reflectance_samples *samples)
{
    struct lobe_rows rows = {TL_NEW_ARRAY(struct lobe_row, samples->count), 0};
    int *cells = TL_NEW_ARRAY(int, samples->count), *counts = TL_NEW_ARRAY(int, (size_t)CELLS);
    for (size_t i = 0; i < samples->count; i++) {
        const struct tl_reflectance_sample *sample = &samples->items[i];
        const vec3s h = glms_vec3_normalize(glms_vec3_add(sample->l, sample->v));
        const float cos_t = glms_vec3_dot(h, sample->l), steep = cos_t * h.z * h.z;
        if (!(sample->l.z > LOWEST && sample->v.z > LOWEST) || !is_kept(i, samples->count, ROWS_MAX))
            continue;
        int ring;
        counts[cells[rows.count] = cell_of(sample, h, &ring)]++;
        const float ring_angle = cosf(RING(ring)) - cosf(RING(ring + 1));
        rows.items[rows.count++] = (struct lobe_row){.slope_x = h.x / h.z,
                                                     .slope_y = h.y / h.z,
                                                     .steep = steep * steep,
                                                     .share = schlick_share(cos_t),
                                                     .cos_a = sample->l.z,
                                                     .cos_b = sample->v.z,
                                                     .weight = sample->v.z * cos_t * ring_angle,
                                                     .wanted = glms_vec3_scale(sample->value, sample->l.z)};
    }
    for (int i = 0; i < rows.count; i++)
        rows.items[i].weight /= (float)counts[cells[i]];
    free(counts);
    free(cells);
    return rows;
}

static struct lobe_rows few_of(const struct lobe_rows *rows)
{
    struct lobe_rows few = {TL_NEW_ARRAY(struct lobe_row, (size_t)rows->count), 0};
    for (int i = 0; i < rows->count; i++)
        if (is_kept((size_t)i, (size_t)rows->count, FEW_ROWS))
            few.items[few.count++] = rows->items[i];
    return few;
}

/* ---- Colours, given the widths ---- */

/* The forms of the surface's lobe; the threads' is the first. */
static const struct tl_gloss surfaces[] = {
    {.model = TL_REFLECT_WARD, .ward = TL_WARD_BOUNDED, .index = 1.5f},
    {.model = TL_REFLECT_WARD, .ward = TL_WARD_PUBLISHED, .index = 1.5f},
    {.model = TL_REFLECT_TORRANCE_SPARROW,
     .facets = TL_FACETS_GGX,
     .masking = TL_MASKING_SMITH,
     .index = 1.5f}};

/* Weighted sums over samples: of products of columns, and of columns with what is wanted. */
struct lobe_sums {
    double products[COLUMNS][COLUMNS], wanted[3][COLUMNS], all[3];
};

static float lobe_of(const struct lobe_row *row, const struct tl_gloss *gloss, float square_weft,
                     float square_warp)
{
    if (gloss->model == TL_REFLECT_WARD)
        return ward_lobe(gloss->ward == TL_WARD_BOUNDED, row->slope_x, row->slope_y, row->steep, row->cos_a,
                         row->cos_b, square_weft, square_warp, 0);
    const float width = sqrtf(square_weft),
                square = row->slope_x * row->slope_x + row->slope_y * row->slope_y;
    return facet_density(gloss->facets, width, square) *
           facet_masking(gloss->facets, gloss->masking, width, row->cos_a, row->cos_b, 1, 1) /
           (GLM_PIf * row->cos_b);
}

static void add_row(const struct lobe_row *row, const struct tl_gloss *surface, const float squares[WIDTHS],
                    int lobes, struct lobe_sums *sums)
{
    double columns[COLUMNS] = {(double)row->cos_a / M_PI};
    for (int k = 0; k < lobes; k++) {
        const float *own = squares + (ptrdiff_t)2 * k;
        columns[1 + 2 * k] = (double)lobe_of(row, k == 0 ? surface : &surfaces[0], own[0], own[1]);
        columns[2 + 2 * k] = columns[1 + 2 * k] * (double)row->share;
    }
    const double weight = (double)row->weight;
    for (int i = 0; i < 1 + 2 * lobes; i++) {
        for (int j = 0; j <= i; j++)
            sums->products[i][j] += weight * columns[i] * columns[j];
        for (int c = 0; c < 3; c++)
            sums->wanted[c][i] += weight * columns[i] * (double)row->wanted.raw[c];
    }
    for (int c = 0; c < 3; c++)
        sums->all[c] += weight * (double)(row->wanted.raw[c] * row->wanted.raw[c]);
}

static void sum_rows(const struct lobe_rows *rows, const struct tl_gloss *surface,
                     const double widths[WIDTHS], int lobes, struct lobe_sums *sums)
{
    struct lobe_sums *blocks = TL_NEW_ARRAY(struct lobe_sums, BLOCKS);
    float squares[WIDTHS];
    for (int i = 0; i < 2 * lobes; i++)
        squares[i] = (float)exp(2 * widths[i]);
#pragma omp parallel for
    for (int b = 0; b < BLOCKS; b++)
        for (int i = b; i < rows->count; i += BLOCKS)
            add_row(&rows->items[i], surface, squares, lobes, &blocks[b]);
    memset(sums, 0, sizeof *sums);
    for (int b = 0; b < BLOCKS; b++)
        for (size_t i = 0; i < sizeof *sums / sizeof(double); i++)
            ((double *)sums)[i] += ((const double *)&blocks[b])[i];
    for (int i = 0; i < COLUMNS; i++)
        for (int j = 0; j < i; j++)
            sums->products[j][i] = sums->products[i][j];
    free(blocks);
}

/* Factors of the columns from even light, f0 and the threads' colours, of one channel. */
static void factors_of(const double colours[COLOURS], double factors[COLUMNS])
{
    const double f0 = colours[1], away = fmin(50 * f0, 1) - f0;
    factors[0] = colours[0];
    factors[1] = f0;
    factors[2] = away;
    for (int k = 0; k < TL_THREADS_MAX; k++) {
        factors[3 + 2 * k] = colours[2 + k] * (1 - f0);
        factors[4 + 2 * k] = -colours[2 + k] * away;
    }
}

/* Half the derivative of the squares of the rest along `along`; *curved: half of the second one. */
static double along_of(const struct lobe_sums *sums, int channel, const double factors[COLUMNS],
                       const double along[COLUMNS], double *curved)
{
    double slope = *curved = 0;
    for (int i = 0; i < COLUMNS; i++) {
        slope -= along[i] * sums->wanted[channel][i];
        for (int j = 0; j < COLUMNS; j++) {
            slope += along[i] * sums->products[i][j] * factors[j];
            *curved += along[i] * sums->products[i][j] * along[j];
        }
    }
    return slope;
}

static double rest_of(const struct lobe_sums *sums, int channel, const double colours[COLOURS])
{
    double factors[COLUMNS], curved;
    factors_of(colours, factors);
    const double slope = along_of(sums, channel, factors, factors, &curved); /* f P f - f w */
    return sums->all[channel] + 2 * slope - curved;
}

/* Moves one colour to where the squares of the rest are smallest between low and high, where all factors are
 * straight in it. */
static double move(const struct lobe_sums *sums, int channel, double colours[COLOURS], int which, double low,
                   double high)
{
    double from[COLUMNS], along[COLUMNS], curved;
    colours[which] = high;
    factors_of(colours, along);
    colours[which] = low;
    factors_of(colours, from);
    for (int i = 0; i < COLUMNS; i++)
        along[i] -= from[i];
    const double slope = along_of(sums, channel, from, along, &curved);
    colours[which] = low + (high - low) * (curved > 0 ? fmin(fmax(-slope / curved, 0), 1) : 0);
    return rest_of(sums, channel, colours);
}

#define SWEEPS  100
#define F0_KNEE 0.02 /* from where f90 is 1 */

static double find_colours(const struct lobe_sums *sums, int channel, int lobes, double colours[COLOURS])
{
    double rest = 0, before = INFINITY;
    memset(colours, 0, COLOURS * sizeof *colours);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        move(sums, channel, colours, 0, 0, 1);
        for (int k = 1; k < lobes; k++)
            move(sums, channel, colours, 1 + k, 0, 1);
        rest = move(sums, channel, colours, 1, 0, F0_KNEE);
        const double below = colours[1], other = move(sums, channel, colours, 1, F0_KNEE, 1);
        if (other > rest)
            colours[1] = below;
        rest = fmin(rest, other);
        if (before - rest < 1e-9 * sums->all[channel])
            break;
        before = rest;
    }
    return rest;
}

/* ---- Widths ---- */

#define NARROWEST (-3.9) /* logarithm: 0.02 */

struct lobe_trial {
    const struct tl_gloss *surface;
    double widths[WIDTHS]; /* logarithms: along weft and warp, of the surface, then of threads */
    double colours[3][COLOURS];
    double rest; /* weighted squares of differences over those of the samples */
};

static void evaluate(const struct lobe_rows *rows, int lobes, struct lobe_trial *trial)
{
    struct lobe_sums sums;
    double rest = 0, all = 0;
    sum_rows(rows, trial->surface, trial->widths, lobes, &sums);
    for (int c = 0; c < 3; c++) {
        rest += find_colours(&sums, c, lobes, trial->colours[c]);
        all += sums.all[c];
    }
    trial->rest = fmax(rest, 0) / fmax(all, 1e-30);
}

static bool try_step(const struct lobe_rows *rows, int lobes, int which, double step, struct lobe_trial *best)
{
    struct lobe_trial trial = *best;
    trial.widths[which] = fmin(fmax(best->widths[which] + step, NARROWEST), 0);
    evaluate(rows, lobes, &trial);
    if (!(trial.rest < best->rest))
        return false;
    *best = trial;
    return true;
}

#define STARTS 4
static const double starts[STARTS] = {-2.8, -2, -1.2, -0.4};

static bool is_round(const struct tl_gloss *surface)
{
    return surface->model != TL_REFLECT_WARD;
}

/* First and last steps. */
#define COARSE 0.4
#define FINE   0.05
#define FINEST 0.012

/* Steps along one width after the other, of half the length where none is better. */
static void search(const struct lobe_rows *rows, double first, int lobes, struct lobe_trial *best)
{
    evaluate(rows, lobes, best);
    double step = first;
    while (step > FINEST) {
        bool moved = false;
        for (int i = 0; i < 2 * lobes; i++)
            for (int sign = -1; sign <= 1; sign += 2)
                while (try_step(rows, lobes, i, sign * step, best))
                    moved = true;
        step = moved ? step : step / 2;
    }
}

/* The best of the grid for the widths of lobes from `first` on. */
static void start(const struct lobe_rows *rows, int first, int lobes, struct lobe_trial *best)
{
    int tries = 1;
    for (int i = 2 * first; i < 2 * lobes; i++)
        tries *= STARTS;
    best->rest = INFINITY;
    for (int at = 0; at < tries; at++) {
        struct lobe_trial trial = *best;
        if (first == 0 && is_round(best->surface) && at / STARTS % STARTS > 0)
            continue;
        for (int i = 2 * first, left = at; i < 2 * lobes; i++, left /= STARTS)
            trial.widths[i] = starts[left % STARTS];
        evaluate(rows, lobes, &trial);
        if (trial.rest < best->rest)
            *best = trial;
    }
}

#define GOOD      1e-4  /* of squares: no further lobe is worth its time */
#define WORTH     0.8   /* a further lobe lessens the squares to this share */
#define EVEN      1e-3f /* at least, because threads have ratios to it */
#define GLOSSIEST 0.95f /* of a cosine lobe as wide: no near mirror */

static void take_better(const struct lobe_trial *other, int lobes, struct lobe_trial *best, int *best_lobes)
{
    if (*best_lobes > 0 && (best->rest < GOOD || other->rest > WORTH * best->rest))
        return;
    *best = *other;
    *best_lobes = lobes;
}

struct tl_measured_lobes tl_measured_lobes_fit(const struct tl_reflectance_samples *samples)
{
    struct lobe_rows rows = rows_of(samples), few = few_of(&rows);
    struct lobe_trial two = {.rest = INFINITY}, best = {0};
    for (size_t i = 0; i < TL_COUNT(surfaces); i++) {
        struct lobe_trial trial = {.surface = &surfaces[i]};
        start(&few, 0, 2, &trial);
        search(&few, COARSE, 2, &trial);
        if (trial.rest < two.rest)
            two = trial;
    }
    struct lobe_trial one = two, three = two;
    search(&rows, FINE, 2, &two);
    start(&few, 0, 1, &one);
    search(&few, COARSE, 1, &one);
    search(&rows, FINE, 1, &one);
    int lobes = 0;
    take_better(&one, 1, &best, &lobes);
    take_better(&two, 2, &best, &lobes);
    if (two.rest > GOOD) {
        start(&few, 2, 3, &three);
        search(&few, COARSE, 3, &three);
        search(&rows, FINE, 3, &three);
        take_better(&three, 3, &best, &lobes);
    }
    free(rows.items);
    free(few.items);
    struct tl_measured_lobes made = {
        .surface = *best.surface, .thread_count = lobes - 1, .rel_rmse = sqrt(best.rest)};
    made.surface.width_weft = (float)exp(best.widths[0]);
    made.surface.width_warp = (float)exp(best.widths[is_round(best.surface) ? 0 : 1]);
    for (int c = 0; c < 3; c++) {
        made.diffuse.raw[c] = fmaxf((float)best.colours[c][0], EVEN);
        made.specular.raw[c] = (float)best.colours[c][1];
        for (int k = 0; k < made.thread_count; k++)
            made.threads[k].ratio.raw[c] = (float)best.colours[c][2 + k] / made.diffuse.raw[c];
    }
    for (int k = 0; k < made.thread_count; k++) {
        made.threads[k].width_weft = (float)exp(best.widths[2 + 2 * k]);
        made.threads[k].width_warp = (float)exp(best.widths[3 + 2 * k]);
    }
    return made;
}

void tl_measured_lobes_set(const struct tl_measured_lobes *lobes, tl_material *material)
{
    const float rotation = material->gloss.rotation;
    material->diffuse = lobes->diffuse;
    material->diffuse_roughness = 0;
    material->specular = lobes->specular;
    const float thin = fminf(lobes->surface.width_weft, lobes->surface.width_warp);
    material->glossiness = fminf(1 - 1 / fmaxf(0.5f / (thin * thin) - 0.5f, 1), GLOSSIEST);
    material->gloss = lobes->surface;
    material->gloss.rotation = rotation;
    material->back.is_given = false;
    material->thread_count = lobes->thread_count;
    memcpy(material->threads, lobes->threads, sizeof material->threads);
}
