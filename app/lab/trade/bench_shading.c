/* toile bench shading: every technique of shading under a lamp, timed in turn on a mesh that fills the image
 * [Schroecker 2002, figure 12]. */
#include "app/cli/json.h"
#include "app/lab/experiments/experiment.h"
#include "app/lab/experiments/experiments.h"
#include "app/lab/trade/bench.h"
#include "app/measure/cost.h"
#include "app/scene/headless.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/local/shading_bench.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct shading_schedule {
    int side;   /* pixels */
    int cells;  /* of the mesh's side, two triangles each */
    int rounds; /* times that every variant is drawn */
};
static const struct shading_schedule full = {512, 100, 4}, quick = {96, 20, 2};

enum { ROWS_MAX = 40, APPEARANCES = 2 };

struct shading_row {
    const char *name;
    enum tl_reflectance model;
    struct tl_shading_params shading;
    double cpu_ms, wall_ms; /* the best of the rounds */
    double rel_rmse;        /* against exact evaluation of the same model */
};

struct shading_bench {
    struct shading_schedule schedule;
    tl_image decal, bumps;
    tl_mesh mesh;
    tl_material material;
    tl_gpu *gpu;
    struct tl_shading_bench *trial;
    uint64_t shown; /* surfaces so far */
    const struct tl_experiment *experiment;
    struct shading_row rows[APPEARANCES][ROWS_MAX];
    int row_count;
};

/* A screen of low waves, facing +Z. */
static tl_mesh make_mesh(int cells)
{
    const float waves = 3 * 2 * (float)M_PI, height = 0.02f, half = 0.6f;
    size_t stride = (size_t)cells + 1, count = stride * stride;
    tl_mesh mesh = {.vertex_count = count,
                    .positions = TL_NEW_ARRAY(vec3s, count),
                    .normals = TL_NEW_ARRAY(vec3s, count),
                    .tangents = TL_NEW_ARRAY(vec4s, count),
                    .uvs = TL_NEW_ARRAY(vec2s, count),
                    .index_count = 6 * (size_t)cells * (size_t)cells,
                    .indices = TL_NEW_ARRAY(uint32_t, 6 * (size_t)cells * (size_t)cells),
                    .part_count = 1,
                    .parts = TL_NEW(struct tl_mesh_part)};
    for (size_t i = 0; i < count; i++) {
        size_t column = i % stride, row = i / stride;
        float u = (float)column / (float)cells, v = (float)row / (float)cells;
        float a = waves * u, b = waves * v, slope = height * waves / (2 * half);
        float dx = slope * cosf(a) * cosf(b), dy = slope * sinf(a) * sinf(b); /* y runs against v */
        mesh.uvs[i] = (vec2s){{u, v}};
        mesh.positions[i] = (vec3s){{half * (2 * u - 1), half * (1 - 2 * v), height * sinf(a) * cosf(b)}};
        mesh.normals[i] = glms_vec3_normalize((vec3s){{-dx, -dy, 1}});
        vec3s t = glms_vec3_normalize((vec3s){{1, 0, dx}});
        mesh.tangents[i] = (vec4s){{t.x, t.y, t.z, 1}};
    }
    uint32_t *index = mesh.indices, next = (uint32_t)stride;
    for (uint32_t y = 0; y < (uint32_t)cells; y++)
        for (uint32_t x = 0; x < (uint32_t)cells; x++) {
            uint32_t a = y * next + x, c = a + next;
            const uint32_t quad[6] = {a, c, a + 1, a + 1, c, c + 1};
            for (int k = 0; k < 6; k++)
                *index++ = quad[k];
        }
    mesh.parts[0] = (struct tl_mesh_part){.index_count = (uint32_t)mesh.index_count};
    return mesh;
}

static tl_image make_map(bool is_normal)
{
    enum { SIDE = 128 };
    tl_image image = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_U8);
    image.linear = is_normal;
    uint8_t *texel = image.texels;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++, texel += 3) {
            float u = 16 * (float)M_PI * ((float)x + 0.5f) / SIDE,
                  v = 16 * (float)M_PI * ((float)y + 0.5f) / SIDE;
            vec3s n = glms_vec3_normalize((vec3s){{0.4f * cosf(u), 0.4f * cosf(v), 1}});
            bool dark = (x / 16 + y / 16) % 2;
            for (int c = 0; c < 3; c++)
                texel[c] = is_normal ? (uint8_t)lroundf(127.5f + 127.5f * n.raw[c]) : (dark ? 90 : 220);
        }
    return image;
}

/* Shows the surface to the trial: with appearance 1 it has a decal and a normal map. */
static bool show(struct shading_bench *bench, int appearance, enum tl_reflectance model, tl_error *error)
{
    tl_material *material = &bench->material;
    material->gloss.model = (int)model;
    material->diffuse_map.image = appearance ? &bench->decal : NULL;
    material->normal_map.image = appearance ? &bench->bumps : NULL;
    tl_surface surface = tl_surface_of_mesh("mesh", &bench->mesh, material);
    surface.topology_revision = surface.motion_revision = ++bench->shown;
    const struct tl_camera camera = {
        .eye = {{0, 0, 1}}, .up = {{0, 1, 0}}, .fov_y = 2 * atanf(0.5f), .near_m = 0.1f, .far_m = 10};
    const struct tl_lamp lamp = {
        .kind = TL_LAMP_POINT, .position = {{-0.5f, 0.5f, 0.8f}}, .irradiance = {{1, 1, 1}}};
    return tl_shading_bench_set_scene(bench->trial, &surface, &camera, &lamp, bench->schedule.side,
                                      bench->schedule.side, error);
}

/* A row's params: defaults, then the experiment's assignments, then the technique's. The experiment is
 * limited to the tables "shading" and "material". */
static bool set_row(const struct tl_experiment *experiment, const struct tl_technique *technique,
                    struct shading_row *row, tl_error *error)
{
    struct tl_material_params material;
    struct tl_binding bindings[] = {{&tl_shading_options, &row->shading}, {&tl_material_options, &material}};
    const char *const *lists[] = {experiment->base, technique->setup.assignments};
    const size_t lengths[] = {TL_COUNT(experiment->base), TL_COUNT(technique->setup.assignments)};
    tl_options_reset(bindings, TL_COUNT(bindings));
    for (size_t l = 0; l < TL_COUNT(lists); l++)
        for (size_t i = 0; i < lengths[l] && lists[l][i]; i++)
            if (!tl_options_set_assignment(bindings, TL_COUNT(bindings), lists[l][i], error))
                return false;
    row->name = technique->table;
    row->model = (enum tl_reflectance)material.model;
    return true;
}

/* Every appearance measures the same techniques. */
static bool list_rows(struct shading_bench *bench, tl_error *error)
{
    const struct tl_technique *technique = NULL;
    while ((technique = tl_experiment_next(bench->experiment, TL_OUTPUT_TABLE, technique))) {
        assert(bench->row_count < ROWS_MAX);
        struct shading_row row = {.cpu_ms = INFINITY, .wall_ms = INFINITY};
        if (!set_row(bench->experiment, technique, &row, error))
            return false;
        for (int a = 0; a < APPEARANCES; a++)
            bench->rows[a][bench->row_count] = row;
        bench->row_count++;
    }
    return true;
}

static double relative_rmse(const tl_image *drawn, const tl_image *exact)
{
    double squares = 0, sum = 0;
    size_t count = (size_t)drawn->width * (size_t)drawn->height * 4;
    for (size_t i = 0; i < count; i++) {
        double want = (double)tl_image_floats(exact)[i], off = (double)tl_image_floats(drawn)[i] - want;
        squares += off * off;
        sum += want;
    }
    return sqrt(squares / (double)count) / (sum / (double)count); /* alpha adds nothing to either */
}

static bool draw_once(struct shading_bench *bench, const struct tl_shading_params *shading,
                      struct tl_taken *taken, tl_error *error)
{
    tl_shading_bench_clear(bench->trial);
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool drawn = tl_shading_bench_draw(bench->trial, shading, error);
    *taken = tl_stopwatch_read(&watch);
    return drawn;
}

/* Draws twice and measures the second draw: the first one loads what the technique before it evicted. */
static bool draw_again(struct shading_bench *bench, const struct tl_shading_params *shading,
                       struct tl_taken *taken, tl_error *error)
{
    bool drawn = true;
    for (int i = 0; drawn && i < 2; i++)
        drawn = draw_once(bench, shading, taken, error);
    return drawn;
}

/* Measures the error. It also makes programs and tables, outside of the measured time. */
static bool measure_error(struct shading_bench *bench, struct shading_row *row, tl_error *error)
{
    const struct tl_shading_params *exact = tl_shading_options.defaults;
    struct tl_taken unused;
    if (!draw_once(bench, exact, &unused, error))
        return false;
    tl_image want = tl_shading_bench_read(bench->trial);
    bool drawn = draw_once(bench, &row->shading, &unused, error);
    if (drawn) {
        tl_image image = tl_shading_bench_read(bench->trial);
        row->rel_rmse = relative_rmse(&image, &want);
        tl_image_release(&image);
    }
    tl_image_release(&want);
    return drawn;
}

/* Draws all techniques of one appearance and model in turn, so that other load on the machine affects all
 * alike. */
static bool measure_model(struct shading_bench *bench, int appearance, enum tl_reflectance model,
                          tl_error *error)
{
    bool done = show(bench, appearance, model, error);
    for (int round = -1; done && round < bench->schedule.rounds; round++)
        for (int i = 0; done && i < bench->row_count; i++) {
            struct shading_row *row = &bench->rows[appearance][i];
            struct tl_taken taken;
            if (row->model != model)
                continue;
            if (round < 0) {
                done = measure_error(bench, row, error);
                continue;
            }
            done = draw_again(bench, &row->shading, &taken, error);
            row->cpu_ms = fmin(row->cpu_ms, taken.cpu_ms);
            row->wall_ms = fmin(row->wall_ms, taken.wall_ms);
        }
    return done && (!tl_interrupted() || tl_fail(error, TL_INTERRUPTED, "bench: stopped while shading"));
}

static bool run(struct shading_bench *bench, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring shading");
    int steps = APPEARANCES * (TL_REFLECT_BANKS + 1), done = 0;
    bool fine = list_rows(bench, error);
    tl_shading_bench_create(bench->trial, bench->gpu);
    for (int model = TL_REFLECT_PHONG; fine && model <= TL_REFLECT_BANKS; model++)
        for (int appearance = 0; fine && appearance < APPEARANCES; appearance++) {
            fine = measure_model(bench, appearance, (enum tl_reflectance)model, error);
            tl_progress_update(&progress, ++done, steps);
        }
    tl_progress_end(&progress);
    tl_shading_bench_release(bench->trial);
    return fine;
}

static double ratio_of(const struct shading_bench *bench, int appearance, int variant)
{
    return bench->rows[appearance][variant].cpu_ms / bench->rows[0][0].cpu_ms;
}

static void print_table(const struct shading_bench *bench)
{
    const struct shading_schedule *schedule = &bench->schedule;
    size_t triangles = bench->mesh.index_count / 3;
    printf("%d x %d pixels, all covered by %zu triangles under one point lamp; the best of %d draws each, "
           "process CPU time; errors against phong, exact, with the same model\n\n",
           schedule->side, schedule->side, triangles, schedule->rounds);
    printf("%-38s %26s %26s\n", "", bench->experiment->appearances[0].name,
           bench->experiment->appearances[1].name);
    printf("%-38s %8s %8s %8s %8s %8s %8s\n", "", "CPU ms", "ratio", "error", "CPU ms", "ratio", "error");
    for (int i = 0; i < bench->row_count; i++) {
        printf("%-38s", bench->rows[0][i].name);
        for (int appearance = 0; appearance < APPEARANCES; appearance++)
            printf(" %8.1f %8.2f %8.4f", bench->rows[appearance][i].cpu_ms, ratio_of(bench, appearance, i),
                   bench->rows[appearance][i].rel_rmse);
        printf("\n");
    }
}

static void print_json(const struct shading_bench *bench)
{
    size_t triangles = bench->mesh.index_count / 3;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "width", bench->schedule.side);
    cJSON_AddNumberToObject(object, "height", bench->schedule.side);
    cJSON_AddNumberToObject(object, "triangles", (double)triangles);
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (int appearance = 0; appearance < APPEARANCES; appearance++)
        for (int i = 0; i < bench->row_count; i++) {
            const struct shading_row *measured = &bench->rows[appearance][i];
            cJSON *row = cJSON_CreateObject();
            cJSON_AddStringToObject(row, "name", bench->rows[0][i].name);
            cJSON_AddStringToObject(row, "look", bench->experiment->appearances[appearance].name);
            cJSON_AddNumberToObject(row, "cpu_ms", measured->cpu_ms);
            cJSON_AddNumberToObject(row, "wall_ms", measured->wall_ms);
            cJSON_AddNumberToObject(row, "ratio", ratio_of(bench, appearance, i));
            cJSON_AddNumberToObject(row, "rel_rmse", measured->rel_rmse);
            cJSON_AddItemToArray(rows, row);
        }
    tl_json_print(object);
}

static void release(struct shading_bench *bench)
{
    tl_mesh_release(&bench->mesh);
    tl_image_release(&bench->decal);
    tl_image_release(&bench->bumps);
    free(bench->trial);
    tl_gpu_destroy(&bench->gpu);
}

bool tl_bench_shading(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count > 0 || arguments->assignment_count > 0)
        return tl_fail(error, TL_USAGE,
                       "bench shading: it has a mesh and settings of its own: leave scene and options out");
    struct shading_bench *bench = TL_NEW(struct shading_bench);
    bench->schedule = arguments->quick ? quick : full;
    bench->experiment = tl_experiment_find(TL_OUTPUT_TABLE, "shading");
    bench->mesh = make_mesh(bench->schedule.cells);
    bench->decal = make_map(false);
    bench->bumps = make_map(true);
    bench->material = tl_material_default("bench");
    bench->material.specular = (vec3s){{0.3f, 0.3f, 0.3f}};
    bench->material.glossiness = 0.75f;
    bench->trial = TL_NEW(struct tl_shading_bench);
    bench->gpu = tl_gpu_create_headless(error);
    bool done = bench->gpu && run(bench, error);
    if (done && arguments->json)
        print_json(bench);
    else if (done)
        print_table(bench);
    release(bench);
    free(bench);
    return done;
}
