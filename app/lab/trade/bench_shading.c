/* toile bench shading: every way of shading under a lamp on a mesh that fills the picture, timed in turn
 * [001, figure 12]. */
#include "app/cli/json.h"
#include "app/lab/trade/bench.h"
#include "app/measure/cost.h"
#include "app/scene/headless.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/local/shading_bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct schedule {
    int side;   /* pixels */
    int cells;  /* of the mesh's side, two triangles each */
    int rounds; /* times that every variant is drawn */
};
static const struct schedule full = {512, 100, 4}, quick = {96, 20, 2};

/* A way of shading: assignments to table "shading", and the model, in which ways and tables differ. */
struct variant {
    const char *name;
    enum tl_reflectance model;
    const char *assignments[4];
};
static const struct variant variants[] = {
    {"gouraud", TL_REFLECT_BLINN_PHONG, {"frequency=gouraud"}},
    {"fast_phong, cosines by matrix", TL_REFLECT_BLINN_PHONG, {"frequency=fast_phong", "coordinates=matrix"}},
    {"fast_phong, cosines from vertices",
     TL_REFLECT_BLINN_PHONG,
     {"frequency=fast_phong", "coordinates=vertex"}},
    {"fast_phong, vectors at pixels", TL_REFLECT_BLINN_PHONG, {"frequency=fast_phong"}},
    {"phong, cosines by matrix", TL_REFLECT_BLINN_PHONG, {"coordinates=matrix"}},
    {"phong, normalised by newton", TL_REFLECT_BLINN_PHONG, {"normalisation=newton"}},
    {"phong, normalised by cube8", TL_REFLECT_BLINN_PHONG, {"normalisation=cube8"}},
    {"phong, normalised by cube16", TL_REFLECT_BLINN_PHONG, {"normalisation=cube16"}},
    {"phong, exact", TL_REFLECT_BLINN_PHONG, {NULL}},
    {"phong, power fixed8", TL_REFLECT_BLINN_PHONG, {"normalisation=newton", "power=fixed8"}},
    {"phong, power table", TL_REFLECT_BLINN_PHONG, {"normalisation=cube16", "power=table"}},
    {"phong, tangent space", TL_REFLECT_BLINN_PHONG, {"space=tangent"}},
    {"phong, tangent space, newton", TL_REFLECT_BLINN_PHONG, {"space=tangent", "normalisation=newton"}},
    {"phong, self-shadow by step", TL_REFLECT_BLINN_PHONG, {"self_shadow=step"}},
    {"blinn_phong table", TL_REFLECT_BLINN_PHONG, {"reflectance=table"}},
    {"phong model", TL_REFLECT_PHONG, {NULL}},
    {"phong model table", TL_REFLECT_PHONG, {"reflectance=table"}},
    {"cosine_lobe", TL_REFLECT_COSINE_LOBE, {NULL}},
    {"cosine_lobe table", TL_REFLECT_COSINE_LOBE, {"reflectance=table"}},
    {"torrance_sparrow", TL_REFLECT_TORRANCE_SPARROW, {NULL}},
    {"torrance_sparrow tables", TL_REFLECT_TORRANCE_SPARROW, {"reflectance=table"}},
    {"torrance_sparrow, 3 passes",
     TL_REFLECT_TORRANCE_SPARROW,
     {"reflectance=table", "max_textures_per_pass=1"}},
    {"torrance_sparrow, 3 passes in 8 bits",
     TL_REFLECT_TORRANCE_SPARROW,
     {"reflectance=table", "max_textures_per_pass=1", "pass_target=fixed8"}},
    {"ward", TL_REFLECT_WARD, {NULL}},
    {"ward tables", TL_REFLECT_WARD, {"reflectance=table"}},
    {"ward, 4 passes", TL_REFLECT_WARD, {"reflectance=table", "max_textures_per_pass=1"}},
    {"banks", TL_REFLECT_BANKS, {NULL}},
    {"banks tables", TL_REFLECT_BANKS, {"reflectance=table"}},
};
enum { VARIANTS = TL_COUNT(variants), LOOKS = 2 };
static const char *const look_names[LOOKS] = {"plain", "decal and bumps"};

struct row {
    struct tl_shading_params shading;
    double cpu_ms, wall_ms; /* the best of the rounds */
    double rel_rmse;        /* against the exact way with the same model */
};

struct bench {
    struct schedule schedule;
    tl_image decal, bumps;
    tl_mesh mesh;
    tl_material material;
    tl_gpu *gpu;
    struct tl_shading_bench *trial;
    uint64_t shown; /* surfaces so far */
    struct row rows[LOOKS][VARIANTS];
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

/* The surface in one look and model, ready to be shaded. */
static bool show(struct bench *bench, int look, enum tl_reflectance model, tl_error *error)
{
    tl_material *material = &bench->material;
    material->gloss.model = (int)model;
    material->diffuse_map.image = look ? &bench->decal : NULL;
    material->normal_map.image = look ? &bench->bumps : NULL;
    tl_surface surface = tl_surface_of_mesh("mesh", &bench->mesh, material);
    surface.topology_revision = surface.motion_revision = ++bench->shown;
    const struct tl_camera camera = {
        .eye = {{0, 0, 1}}, .up = {{0, 1, 0}}, .fov_y = 2 * atanf(0.5f), .near_m = 0.1f, .far_m = 10};
    const struct tl_lamp lamp = {
        .kind = TL_LAMP_POINT, .position = {{-0.5f, 0.5f, 0.8f}}, .irradiance = {{1, 1, 1}}};
    return tl_shading_bench_set_scene(bench->trial, &surface, &camera, &lamp, bench->schedule.side,
                                      bench->schedule.side, error);
}

static bool set_shading(const struct variant *variant, struct tl_shading_params *shading, tl_error *error)
{
    struct tl_binding binding = {&tl_shading_options, shading};
    tl_options_reset(&binding, 1);
    for (size_t i = 0; i < TL_COUNT(variant->assignments) && variant->assignments[i]; i++) {
        char *assignment = tl_format("shading.%s", variant->assignments[i]);
        bool set = tl_options_set_assignment(&binding, 1, assignment, error);
        free(assignment);
        if (!set)
            return false;
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

static bool draw_once(struct bench *bench, const struct tl_shading_params *shading, struct tl_taken *taken,
                      tl_error *error)
{
    tl_shading_bench_clear(bench->trial);
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool drawn = tl_shading_bench_draw(bench->trial, shading, error);
    *taken = tl_stopwatch_read(&watch);
    return drawn;
}

/* The first of two brings in what the variant before it let go. */
static bool draw_again(struct bench *bench, const struct tl_shading_params *shading, struct tl_taken *taken,
                       tl_error *error)
{
    bool drawn = true;
    for (int i = 0; drawn && i < 2; i++)
        drawn = draw_once(bench, shading, taken, error);
    return drawn;
}

/* Also makes programs and tables, which are not measured. */
static bool measure_error(struct bench *bench, struct row *row, tl_error *error)
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

/* All variants of one look and model, in turn, so that what else the machine does meets them alike. */
static bool measure_model(struct bench *bench, int look, enum tl_reflectance model, tl_error *error)
{
    bool done = show(bench, look, model, error);
    for (int round = -1; done && round < bench->schedule.rounds; round++)
        for (int i = 0; done && i < VARIANTS; i++) {
            struct row *row = &bench->rows[look][i];
            struct tl_taken taken;
            if (variants[i].model != model)
                continue;
            if (round < 0) {
                *row = (struct row){.cpu_ms = INFINITY, .wall_ms = INFINITY};
                done = set_shading(&variants[i], &row->shading, error) && measure_error(bench, row, error);
                continue;
            }
            done = draw_again(bench, &row->shading, &taken, error);
            row->cpu_ms = fmin(row->cpu_ms, taken.cpu_ms);
            row->wall_ms = fmin(row->wall_ms, taken.wall_ms);
        }
    return done && (!tl_interrupted() || tl_fail(error, TL_INTERRUPTED, "bench: stopped while shading"));
}

static bool run(struct bench *bench, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring shading");
    int steps = LOOKS * (TL_REFLECT_BANKS + 1), done = 0;
    bool fine = tl_shading_bench_create(bench->trial, bench->gpu, error);
    for (int model = TL_REFLECT_PHONG; fine && model <= TL_REFLECT_BANKS; model++)
        for (int look = 0; fine && look < LOOKS; look++) {
            fine = measure_model(bench, look, (enum tl_reflectance)model, error);
            tl_progress_update(&progress, ++done, steps);
        }
    tl_progress_end(&progress);
    tl_shading_bench_release(bench->trial);
    return fine;
}

static double ratio_of(const struct bench *bench, int look, int variant)
{
    return bench->rows[look][variant].cpu_ms / bench->rows[0][0].cpu_ms;
}

static void print_table(const struct bench *bench)
{
    const struct schedule *schedule = &bench->schedule;
    size_t triangles = bench->mesh.index_count / 3;
    printf("%d x %d pixels, all covered by %zu triangles under one point lamp; the best of %d draws each, "
           "process CPU time; errors against phong, exact, with the same model\n\n",
           schedule->side, schedule->side, triangles, schedule->rounds);
    printf("%-38s %26s %26s\n", "", look_names[0], look_names[1]);
    printf("%-38s %8s %8s %8s %8s %8s %8s\n", "", "CPU ms", "ratio", "error", "CPU ms", "ratio", "error");
    for (int i = 0; i < VARIANTS; i++) {
        printf("%-38s", variants[i].name);
        for (int look = 0; look < LOOKS; look++)
            printf(" %8.1f %8.2f %8.4f", bench->rows[look][i].cpu_ms, ratio_of(bench, look, i),
                   bench->rows[look][i].rel_rmse);
        printf("\n");
    }
}

static void print_json(const struct bench *bench)
{
    size_t triangles = bench->mesh.index_count / 3;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "width", bench->schedule.side);
    cJSON_AddNumberToObject(object, "height", bench->schedule.side);
    cJSON_AddNumberToObject(object, "triangles", (double)triangles);
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (int look = 0; look < LOOKS; look++)
        for (int i = 0; i < VARIANTS; i++) {
            const struct row *measured = &bench->rows[look][i];
            cJSON *row = cJSON_CreateObject();
            cJSON_AddStringToObject(row, "name", variants[i].name);
            cJSON_AddStringToObject(row, "look", look_names[look]);
            cJSON_AddNumberToObject(row, "cpu_ms", measured->cpu_ms);
            cJSON_AddNumberToObject(row, "wall_ms", measured->wall_ms);
            cJSON_AddNumberToObject(row, "ratio", ratio_of(bench, look, i));
            cJSON_AddNumberToObject(row, "rel_rmse", measured->rel_rmse);
            cJSON_AddItemToArray(rows, row);
        }
    tl_json_print(object);
}

static void release(struct bench *bench)
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
    struct bench *bench = TL_NEW(struct bench);
    bench->schedule = arguments->quick ? quick : full;
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
