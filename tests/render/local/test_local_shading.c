/* Approximate shading options under lamps: each against exact shading, and against its counterpart on the
 * CPU. Rows A6, A8 to A12 of the technique set. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/brdf/tables/tables.h"
#include "render/scene/view.h"
#include "render/trace/trace.h"

#include "tests/testing.h"

#include <string.h>

static struct test_shape shiny_sphere(int segments, float glossiness)
{
    struct test_shape shape = test_sphere((vec3s){{0, 0, 0}}, 0.7f, segments);
    shape.material.diffuse = (vec3s){{0.4f, 0.3f, 0.2f}};
    shape.material.specular = (vec3s){{0.3f, 0.2f, 0.1f}};
    shape.material.glossiness = glossiness;
    shape.material.gloss.model = TL_REFLECT_BLINN_PHONG;
    return shape;
}

static tl_image draw_exactly(const struct test_scene *scene, tl_renderer *renderer)
{
    struct test_scene exact = *scene;
    exact.settings.shading = *(const struct tl_shading_params *)tl_shading_options.defaults;
    exact.settings.shading.self_shadow = scene->settings.shading.self_shadow;
    return test_scene_draw(&exact, renderer);
}

static double error_of(const struct test_scene *scene, tl_renderer *renderer, const tl_image *expected)
{
    return test_scene_error(scene, renderer, expected).rel_rmse;
}

/* A6. With constant light and view directions, cosines by one matrix, cosines from vertices and vectors at
 * pixels are equal, because all are linear in the normal. The remaining difference is the field of view of
 * 0.2 degrees: through a lobe of exponent 40 it changes the value by up to 40 x 0.0017 x the tangent of its
 * width, about a hundredth. */
static void coordinates_agree_far_away(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(24, 0.9f), 96, 96);
    scene.frame.camera.eye = (vec3s){{0, 100, 500}};
    scene.frame.camera.near_m = 400;
    scene.frame.camera.far_m = 600;
    scene.frame.camera.fov_y = 0.0035f;
    for (int frequency = TL_FREQUENCY_FAST_PHONG; frequency <= TL_FREQUENCY_PHONG; frequency++) {
        scene.settings.shading.frequency = frequency;
        scene.settings.shading.coordinates = TL_COORDINATES_PIXEL;
        tl_image pixel = test_scene_draw(&scene, device->renderer);
        scene.settings.shading.coordinates = TL_COORDINATES_MATRIX;
        double matrix = error_of(&scene, device->renderer, &pixel);
        scene.settings.shading.coordinates = TL_COORDINATES_VERTEX;
        double vertex = error_of(&scene, device->renderer, &pixel);
        print_message("far, frequency %d: matrix %.2e, vertex %.2e\n", frequency, matrix, vertex);
        assert_true(matrix < 1e-2);
        if (frequency ==
            TL_FREQUENCY_FAST_PHONG) /* interpolated cosines cannot be made those of unit vectors */
            assert_true(vertex < 1e-2);
        tl_image_release(&pixel);
    }
    test_scene_close(&scene);
}

/* ... and near by, under a near lamp, the matrix is far off while a local viewer at vertices is not. */
static void coordinates_differ_close_by(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(64, 0.75f), 96, 96);
    scene.frame.camera.eye = (vec3s){{0, 0.2f, 1.1f}};
    scene.frame.camera.fov_y = 1.4f;
    scene.lamps[0] = test_lamp_at((vec3s){{-0.6f, 0.6f, 1}}, 1);
    tl_image exact = draw_exactly(&scene, device->renderer);
    double errors[3];
    for (int coordinates = 0; coordinates < 3; coordinates++) {
        scene.settings.shading.frequency = TL_FREQUENCY_FAST_PHONG;
        scene.settings.shading.coordinates = coordinates;
        errors[coordinates] = error_of(&scene, device->renderer, &exact);
    }
    print_message("close: matrix %.3f, vertex %.4f, pixel %.4f\n", errors[0], errors[1], errors[2]);
    assert_true(errors[TL_COORDINATES_MATRIX] > 5 * errors[TL_COORDINATES_VERTEX]);
    assert_true(errors[TL_COORDINATES_VERTEX] < 0.05);
    assert_true(errors[TL_COORDINATES_PIXEL] < 0.05);
    tl_image_release(&exact);
    test_scene_close(&scene);
}

/* A8. Against a sphere of 65,000 triangles, shaded exactly. A coarse one loses its highlight to Gouraud, and
 * keeps it whole with unit vectors. Vectors left short between vertices do not save it: with a far light the
 * cosine c is linear in between, and c^s is convex, so that (sum w c)^s <= sum w c^s, which is Gouraud's.
 * The paper calls them much better [Heidrich and Seidel 1999, 3.1]; this can only refer to Mach bands as seen
 * by the eye. */
static void gouraud_loses_the_highlight_first(void **state)
{
    enum { STEPS = 4 };
    static const int segments[STEPS] = {12, 24, 48, 96};
    struct test_device *device = *state;
    double errors[STEPS][3], peaks[STEPS][3];
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(128, 0.9f), 128, 128);
    tl_image exact = draw_exactly(&scene, device->renderer);
    test_scene_close(&scene);
    for (int step = 0; step < STEPS; step++) {
        test_scene_open_lamplit(&scene, shiny_sphere(segments[step], 0.9f), 128, 128);
        for (int frequency = 0; frequency < 3; frequency++) {
            scene.settings.shading.frequency = frequency;
            tl_image drawn = test_scene_draw(&scene, device->renderer);
            errors[step][frequency] = test_compare(&drawn, &exact).rel_rmse;
            peaks[step][frequency] = test_brightest(&drawn) / test_brightest(&exact);
            tl_image_release(&drawn);
        }
        print_message("%5d triangles: error %.3f %.3f %.3f, peak %.2f %.2f %.2f (gouraud, fast, phong)\n",
                      4 * segments[step] * segments[step], errors[step][0], errors[step][1], errors[step][2],
                      peaks[step][0], peaks[step][1], peaks[step][2]);
        assert_true(errors[step][TL_FREQUENCY_GOURAUD] > 5 * errors[step][TL_FREQUENCY_PHONG]);
        assert_true(peaks[step][TL_FREQUENCY_FAST_PHONG] < peaks[step][TL_FREQUENCY_GOURAUD] + 0.01);
        for (int frequency = 0; step > 0 && frequency < 2; frequency++)
            assert_true(errors[step][frequency] < 0.5 * errors[step - 1][frequency]);
        test_scene_close(&scene);
    }
    assert_true(peaks[0][TL_FREQUENCY_GOURAUD] < 0.9);
    assert_true(fabs(peaks[0][TL_FREQUENCY_PHONG] - 1) < 0.02);
    tl_image_release(&exact);
}

/* A8. A surface that turns its backs is one that is turned inside out: the same triangles, wound the other
 * way with opposite normals, have the same picture, but for the order in which corners are interpolated. */
static void backs_are_fronts_turned_inside_out(void **state)
{
    struct test_device *device = *state;
    tl_image pictures[2];
    for (int frequency = 0; frequency < 3; frequency++) {
        for (int inside = 0; inside < 2; inside++) {
            struct test_scene scene;
            struct test_shape shape = shiny_sphere(24, 0.75f);
            for (size_t i = 0; inside && i < shape.mesh.vertex_count; i++)
                shape.mesh.normals[i] = glms_vec3_negate(shape.mesh.normals[i]);
            for (size_t i = 0; inside && i < shape.mesh.index_count; i += 3) {
                const uint32_t second = shape.mesh.indices[i + 1];
                shape.mesh.indices[i + 1] = shape.mesh.indices[i + 2];
                shape.mesh.indices[i + 2] = second;
            }
            test_scene_open_lamplit(&scene, shape, 96, 96);
            scene.settings.shading.frequency = frequency;
            pictures[inside] = test_scene_draw(&scene, device->renderer);
            test_scene_close(&scene);
        }
        const struct test_difference off = test_compare(&pictures[1], &pictures[0]);
        print_message("frequency %d: backs are off by %.1e of %zu pixels\n", frequency, off.rel_rmse,
                      off.pixels);
        assert_true(off.pixels > 1000);
        assert_true(off.rel_rmse < 1e-5);
        tl_image_release(&pictures[0]);
        tl_image_release(&pictures[1]);
    }
}

/* The hit of a pixel's ray and the vectors at the corners of its triangle. */
struct hit {
    bool is_hit;
    vec3s n, l, v, h;    /* interpolated from unit vectors at the corners */
    vec3s corners[4][3]; /* the same at the corners ... */
    float shares[3];     /* ... and how much of each the point has */
};

static vec3s mixed(const vec3s corners[3], float u, float v)
{
    vec3s sum = glms_vec3_scale(corners[0], 1 - u - v);
    return glms_vec3_add(glms_vec3_add(sum, glms_vec3_scale(corners[1], u)), glms_vec3_scale(corners[2], v));
}

static struct hit intersect(const struct test_scene *scene, const tl_trace *trace, const struct tl_view *view,
                            int x, int y)
{
    const struct tl_image_params *image = &scene->settings.image;
    float right = 2 * ((float)x + 0.5f) / (float)image->width - 1,
          up = 1 - 2 * ((float)y + 0.5f) / (float)image->height;
    vec3s along = glms_vec3_add(view->forward, glms_vec3_scale(view->right, right));
    along = glms_vec3_normalize(glms_vec3_add(along, glms_vec3_scale(view->up, up)));
    struct tl_trace_hit traced = tl_trace_nearest(trace, view->eye, along, 0.01f, 100);
    struct hit hit = {.is_hit = traced.surface != TL_TRACE_NONE};
    if (!hit.is_hit)
        return hit;
    vec3s n[3], l[3], v[3], h[3];
    for (int i = 0; i < 3; i++) {
        uint32_t corner = scene->surfaces[0].indices[3 * traced.triangle + (uint32_t)i];
        n[i] = scene->surfaces[0].normals[corner];
        l[i] = scene->lamps[0].direction;
        v[i] = glms_vec3_normalize(glms_vec3_sub(view->eye, scene->surfaces[0].positions[corner]));
        h[i] = glms_vec3_normalize(glms_vec3_add(l[i], v[i]));
    }
    const vec3s *all[] = {n, l, v, h};
    for (int i = 0; i < 4; i++)
        memcpy(hit.corners[i], all[i], sizeof hit.corners[i]);
    hit.shares[0] = 1 - traced.u - traced.v, hit.shares[1] = traced.u, hit.shares[2] = traced.v;
    hit.n = mixed(n, traced.u, traced.v);
    hit.l = mixed(l, traced.u, traced.v);
    hit.v = mixed(v, traced.u, traced.v);
    hit.h = mixed(h, traced.u, traced.v);
    return hit;
}

/* The nearest of the 511 values of a register of 8 bits and a sign. */
static double nearest_register(double x)
{
    return (double)lround(fmin(fmax(x, -1), 1) * 255) / 255;
}

/* Equation 6 of [Schroecker 2002] in registers: the dot product and the rest in one, half of v times the
 * rest in another, the sum in a third. */
static vec3s combined(vec3s v)
{
    double held[3], square = 0;
    for (int c = 0; c < 3; c++) {
        held[c] = nearest_register((double)v.raw[c]);
        square += held[c] * held[c];
    }
    double rest = 1 - nearest_register(square);
    for (int c = 0; c < 3; c++)
        v.raw[c] = (float)nearest_register(held[c] + nearest_register(held[c] / 2 * rest));
    return v;
}

/* 1 / sqrt(1 + x) by the binomial series, x = v.v - 1: equation 5 of [op. cit.] with so many terms. */
static vec3s by_series(vec3s v, int terms)
{
    double x = (double)glms_vec3_norm2(v) - 1, term = 1, sum = 1;
    for (int k = 1; k <= terms; k++) {
        term *= -(2 * k - 1) * x / (2 * k);
        sum += term;
    }
    return glms_vec3_scale(v, (float)sum);
}

/* The unit vector at a share of the way from one unit vector to another, by turning the first: equation 3. */
static void turn(const double from[3], const double to[3], double share, double out[3])
{
    double across[3], cosine = 0, sine = 0;
    for (int c = 0; c < 3; c++)
        cosine += from[c] * to[c];
    for (int c = 0; c < 3; c++) {
        across[c] = to[c] - cosine * from[c];
        sine += across[c] * across[c];
    }
    sine = sqrt(sine);
    double angle = share * atan2(sine, cosine);
    for (int c = 0; c < 3; c++)
        out[c] = cos(angle) * from[c] + (sine > 0 ? sin(angle) * across[c] / sine : 0);
}

static vec3s turned(const vec3s corners[3], const float shares[3])
{
    double at[3][3], edge[3], out[3], rest = (double)shares[1] + (double)shares[2];
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            at[i][c] = (double)corners[i].raw[c];
    turn(at[1], at[2], (double)shares[2] / fmax(rest, 1e-9), edge);
    turn(at[0], edge, rest, out);
    return (vec3s){{(float)out[0], (float)out[1], (float)out[2]}};
}

/* The vector of a hit by its number: n, l, v, h. */
static vec3s unit_by(int way, const struct tl_normal_cube *cube, const struct hit *hit, int number)
{
    const vec3s mean[] = {hit->n, hit->l, hit->v, hit->h};
    if (way == TL_NORMALISE_SLERP)
        return turned(hit->corners[number], hit->shares);
    if (way >= TL_NORMALISE_NEWTON && way <= TL_NORMALISE_TAYLOR3)
        return by_series(mean[number], 1 + way - TL_NORMALISE_NEWTON);
    return way == TL_NORMALISE_NEWTON8 ? combined(mean[number]) : tl_normalise(way, cube, mean[number]);
}

static float dot_by(int way, vec3s a, vec3s b)
{
    float exact = glms_vec3_dot(a, b);
    return way == TL_NORMALISE_NEWTON8 ? (float)nearest_register((double)exact) : exact;
}

static float raised(float cosine, float exponent, int power, const uint8_t *table)
{
    float bounded = fminf(fmaxf(cosine, 0), 1);
    if (power == TL_POWER_FIXED8)
        return register_power(bounded, (int)(log2f(exponent) + 0.5f));
    return power == TL_POWER_TABLE ? tl_power_table_at(table, TL_POWER_TABLE_SIZE, bounded)
                                   : powf(bounded, exponent);
}

/* A Blinn-Phong surface by render/brdf's own normalising and powers, in red. */
static tl_image evaluate_reduced(const struct test_scene *scene)
{
    const struct tl_shading_params *shading = &scene->settings.shading;
    const struct tl_image_params *image = &scene->settings.image;
    const tl_material *material = &scene->shapes[0].material;
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    float exponent = 4 * brdf.exponent;
    struct tl_view view = tl_view_make(&scene->frame.camera, image->width, image->height);
    const int way = shading->normalisation;
    bool wide = way == TL_NORMALISE_CUBE16;
    struct tl_normal_cube cube = tl_normal_cube_make(TL_NORMALISE_CUBE_SIZE, wide ? 16 : 8);
    uint8_t table[TL_POWER_TABLE_SIZE];
    tl_power_table_make(exponent, TL_POWER_TABLE_SIZE, table);
    tl_error error = {0};
    tl_trace *trace = tl_trace_create(&error);
    assert_ok(tl_trace_update(trace, scene->surfaces, 1, &error), error);
    tl_image out = tl_image_create(image->width, image->height, 4, TL_IMAGE_F32);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            struct hit hit = intersect(scene, trace, &view, x, y);
            float *pixel = tl_image_floats(&out) + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
            pixel[3] = hit.is_hit;
            if (!hit.is_hit)
                continue;
            vec3s n = unit_by(way, &cube, &hit, 0), l = unit_by(way, &cube, &hit, 1);
            vec3s v = unit_by(way, &cube, &hit, 2), h = unit_by(way, &cube, &hit, 3);
            float facing = dot_by(way, way == TL_NORMALISE_SLERP ? n : glms_vec3_normalize(hit.n), l);
            float a = dot_by(way, n, l), b = dot_by(way, n, v), d = dot_by(way, n, h);
            float ramp = fminf(fmaxf(32 * facing, 0), 1);
            vec3s f = tl_brdf_fresnel(&brdf, fminf(fmaxf(dot_by(way, h, l), 0), 1));
            float lobe = a > 0 && b > 0 && d > 0
                             ? tl_brdf_lobe_scale(&brdf) * raised(d, exponent, shading->power, table)
                             : 0;
            for (int c = 0; c < 3; c++)
                pixel[c] = ramp * scene->lamps[0].irradiance.raw[c] *
                           (material->diffuse.raw[c] * fmaxf(a, 0) / (float)M_PI + f.raw[c] * lobe);
        }
    tl_trace_destroy(&trace);
    tl_normal_cube_release(&cube);
    return out;
}

/* One row of a texture matrix applied to (n, 1) at each corner, and interpolated [Heidrich and Seidel 1999,
 * eq. 2 and 3]: an axis' scale and bias on the cosine of the normal with l, v or h, or on h.l, which is
 * constant. */
static float coordinate(const struct tl_brdf_axis *axis, const struct hit *hit, vec3s l, vec3s v, vec3s h)
{
    const vec3s rows[] = {[TL_AXIS_N_DOT_L] = l, [TL_AXIS_N_DOT_V] = v, [TL_AXIS_N_DOT_H] = h};
    bool is_constant = axis->input == TL_AXIS_H_DOT_L || axis->input == TL_AXIS_NONE;
    vec3s row = is_constant ? (vec3s){{0, 0, 0}} : glms_vec3_scale(rows[axis->input], axis->scale);
    float last = axis->bias + (axis->input == TL_AXIS_H_DOT_L ? axis->scale * glms_vec3_dot(h, l) : 0),
          sum = 0;
    for (int i = 0; i < 3; i++)
        sum += hit->shares[i] * (glms_vec3_dot(row, hit->corners[0][i]) + last);
    return sum;
}

/* A surface whose tables are read at the coordinates of texture matrices. */
static tl_image evaluate_matrices(const struct test_scene *scene)
{
    const struct tl_image_params *image = &scene->settings.image;
    const tl_material *material = &scene->shapes[0].material;
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    const struct tl_brdf_table_params params = {.size = scene->settings.shading.table_size,
                                                .precision = TL_PRECISION_FLOAT,
                                                .range = TL_RANGE_SCALED,
                                                .angles = true};
    struct tl_brdf_tables tables = tl_brdf_tables_make(&brdf, &params);
    struct tl_view view = tl_view_make(&scene->frame.camera, image->width, image->height);
    const vec3s l = scene->lamps[0].direction, v = glms_vec3_negate(glms_vec3_normalize(view.forward));
    const vec3s h = glms_vec3_normalize(glms_vec3_add(l, v));
    tl_error error = {0};
    tl_trace *trace = tl_trace_create(&error);
    assert_ok(tl_trace_update(trace, scene->surfaces, 1, &error), error);
    tl_image out = tl_image_create(image->width, image->height, 4, TL_IMAGE_F32);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const struct hit hit = intersect(scene, trace, &view, x, y);
            float *pixel = tl_image_floats(&out) + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
            pixel[3] = hit.is_hit;
            if (!hit.is_hit)
                continue;
            float a = glms_vec3_dot(hit.n, l), b = glms_vec3_dot(hit.n, v);
            float ramp = fminf(fmaxf(32 * glms_vec3_dot(glms_vec3_normalize(hit.n), l), 0), 1);
            vec3s gloss =
                a > 0 && b > 0 && glms_vec3_dot(hit.n, h) > 0 ? (vec3s){{1, 1, 1}} : (vec3s){{0, 0, 0}};
            for (int i = 0; i < tables.count; i++) {
                const struct tl_brdf_table *table = &tables.tables[i];
                gloss = glms_vec3_mul(gloss, tl_brdf_table_at(table, coordinate(&table->x, &hit, l, v, h),
                                                              coordinate(&table->y, &hit, l, v, h)));
            }
            for (int c = 0; c < 3; c++)
                pixel[c] = ramp * scene->lamps[0].irradiance.raw[c] *
                           (material->diffuse.raw[c] * fmaxf(a, 0) / (float)M_PI + gloss.raw[c]);
        }
    tl_trace_destroy(&trace);
    tl_brdf_tables_release(&tables);
    return out;
}

/* A6. Cosines by a matrix at pixels, with normals as short as interpolation leaves them, are the coordinates
 * of one texture matrix a table at vertices: what is affine may be interpolated before or after. The sphere
 * is coarse, so that unit normals at pixels would be another picture. */
static void a_texture_matrix_gives_the_coordinates(void **state)
{
    static const int models[] = {TL_REFLECT_BLINN_PHONG, TL_REFLECT_TORRANCE_SPARROW};
    struct test_device *device = *state;
    for (size_t i = 0; i < TL_COUNT(models); i++) {
        struct test_scene scene;
        struct test_shape shape = shiny_sphere(12, 0.75f);
        shape.material.gloss.model = models[i];
        shape.material.gloss.width_weft = 0.3f;
        test_scene_open_lamplit(&scene, shape, 96, 96);
        scene.settings.shading.reflectance = TL_REFLECTANCE_TABLE;
        scene.settings.shading.coordinates = TL_COORDINATES_MATRIX;
        tl_image expected = evaluate_matrices(&scene);
        double unit = error_of(&scene, device->renderer, &expected);
        scene.settings.shading.frequency = TL_FREQUENCY_FAST_PHONG;
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        print_message("texture matrix, model %d: off by %.1e (largest %.1e); with unit normals %.4f\n",
                      models[i], off.rel_rmse, off.largest, unit);
        /* floats in another order, through the slope of a table */
        assert_true(off.rel_rmse < 2e-5 + off.moved_rmse);
        assert_true(unit > 0.02);
        tl_image_release(&expected);
        test_scene_close(&scene);
    }
}

/* By how much results in registers may differ where samples lie aside: a change by m of values that registers
 * round by J moves a share m / J of them by a step, J; root mean square, twice over. */
static double steps_moved(const struct test_difference *off, double rounded)
{
    return 2 * sqrt(off->moved_rmse * rounded);
}

/* A9. Each method matches its counterpart in render/brdf, and their order is that of the paper: one Newton
 * step is better than eight bits, and sixteen bits are nearly exact. Software GL also interpolates texels of
 * eight bits with eight bits, so two results may differ by a step of 1/255 of a vector: 4 s / 255 of the
 * highlight. */
static void normalises_as_the_cpu_does(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    double errors[TL_NORMALISE_COUNT];
    test_scene_open_lamplit(&scene, shiny_sphere(12, 0.75f), 96, 96);
    tl_image exact = draw_exactly(&scene, device->renderer);
    for (int way = TL_NORMALISE_NONE; way < TL_NORMALISE_EXACT; way++) {
        scene.settings.shading.normalisation = way;
        tl_image expected = evaluate_reduced(&scene);
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        tl_image_release(&expected);
        errors[way] = error_of(&scene, device->renderer, &exact);
        print_message("%-7s: off the CPU by %.1e (largest %.1e), off exact by %.4f\n",
                      tl_normalisation_names[way], off.rel_rmse, off.largest, errors[way]);
        bool is_coarse = way == TL_NORMALISE_CUBE8;
        /* A value between two registers may go to either. */
        bool is_rounded = way == TL_NORMALISE_NEWTON8;
        double moved = is_rounded ? steps_moved(&off, errors[way]) : off.moved_rmse;
        assert_true(off.rel_rmse < (is_coarse ? 2e-2 : is_rounded ? 2e-3 : 2e-4) + moved);
    }
    scene.settings.shading.normalisation = TL_NORMALISE_NEWTON8;
    scene.settings.shading.power = TL_POWER_FIXED8;
    tl_image expected = evaluate_reduced(&scene);
    struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
    double rounded = error_of(&scene, device->renderer, &exact);
    print_message("newton8 with powers in registers: off the CPU by %.1e, off exact by %.4f\n", off.rel_rmse,
                  rounded);
    tl_image_release(&expected);
    assert_true(off.rel_rmse < 2e-3 + steps_moved(&off, rounded));
    assert_true(errors[TL_NORMALISE_NEWTON8] > 5 * errors[TL_NORMALISE_NEWTON]);
    assert_true(errors[TL_NORMALISE_NONE] > 5 * errors[TL_NORMALISE_NEWTON]);
    assert_true(errors[TL_NORMALISE_CUBE8] > errors[TL_NORMALISE_NEWTON]);
    tl_image_release(&exact);
    test_scene_close(&scene);
}

/* A9. On triangles whose corners turn by up to 45 degrees each term of the series can be told from the next,
 * and slerp from unit vectors, in each of two parts. Sines of GL may err by 2^-11 [OpenGL 4.5, GLSL 4.7.1].
 */
static void interpolates_by_series_and_by_turning(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(6, 0.75f), 96, 96);
    struct tl_mesh_part parts[2] = {scene.surfaces[0].parts[0], scene.surfaces[0].parts[0]};
    parts[0].index_count = parts[1].first_index = 3 * (uint32_t)(scene.surfaces[0].index_count / 6);
    parts[1].index_count -= parts[0].index_count;
    scene.surfaces[0].parts = parts;
    scene.surfaces[0].part_count = 2;
    scene.surfaces[0].topology_revision += 1000;
    for (int way = TL_NORMALISE_NEWTON; way <= TL_NORMALISE_SLERP; way++) {
        if (way == TL_NORMALISE_NEWTON8)
            continue;
        scene.settings.shading.normalisation = way;
        tl_image expected = evaluate_reduced(&scene);
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        scene.settings.shading.normalisation = way == TL_NORMALISE_SLERP     ? TL_NORMALISE_CUBE16
                                               : way == TL_NORMALISE_TAYLOR3 ? way - 1
                                                                             : way + 1;
        double other = error_of(&scene, device->renderer, &expected);
        print_message("%-7s: off the CPU by %.1e; %s: by %.1e\n", tl_normalisation_names[way], off.rel_rmse,
                      tl_normalisation_names[scene.settings.shading.normalisation], other);
        assert_true(off.rel_rmse < (way == TL_NORMALISE_SLERP ? 5e-4 : 2e-5) + off.moved_rmse);
        assert_true(other > 10 * off.rel_rmse);
        tl_image_release(&expected);
    }
    test_scene_close(&scene);
}

/* A10. */
static void raises_as_the_cpu_does(void **state)
{
    /* Exponents 8, 16, 64, 256; and 40 and 50, for which squaring takes 32 and 64. */
    static const float glossinesses[] = {0.5f, 0.75f, 0.9375f, 0.984375f, 0.9f, 0.92f};
    struct test_device *device = *state;
    for (size_t g = 0; g < TL_COUNT(glossinesses); g++) {
        struct test_scene scene;
        double errors[TL_POWER_COUNT];
        test_scene_open_lamplit(&scene, shiny_sphere(48, glossinesses[g]), 96, 96);
        tl_image exact = draw_exactly(&scene, device->renderer);
        for (int power = TL_POWER_POW; power <= TL_POWER_TABLE; power++) {
            /* Any way that begins with interpolated vectors: the CPU's own has no other. */
            scene.settings.shading.normalisation = TL_NORMALISE_NEWTON;
            scene.settings.shading.power = power;
            tl_image expected = evaluate_reduced(&scene);
            struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
            tl_image_release(&expected);
            scene.settings.shading.normalisation = TL_NORMALISE_EXACT;
            errors[power] = error_of(&scene, device->renderer, &exact);
            print_message("exponent %3.0f, %-6s: off the CPU by %.1e (largest %.1e), off exact by %.4f\n",
                          4 / (1 - (double)glossinesses[g]), tl_power_names[power], off.rel_rmse, off.largest,
                          errors[power]);
            /* Texels of eight bits are weighed with eight bits: a level of the table's 255. */
            if (power == TL_POWER_FIXED8)
                assert_true(off.rel_rmse < 2e-4 + steps_moved(&off, errors[power]));
            else
                assert_true(off.largest < (power == TL_POWER_TABLE ? 1.0 / 255 : 2e-4) + off.moved_largest);
        }
        assert_true(errors[TL_POWER_POW] < 1e-6);
        assert_true(errors[TL_POWER_FIXED8] > errors[TL_POWER_TABLE]);
        tl_image_release(&exact);
        test_scene_close(&scene);
    }
}

/* A normal map of waves, as steep as 45 degrees. */
static tl_image waves(void)
{
    enum { SIDE = 64 };
    tl_image image = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_U8);
    image.linear = true;
    uint8_t *texel = image.texels;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++, texel += 3) {
            float u = 2 * (float)M_PI * ((float)x + 0.5f) / SIDE,
                  v = 2 * (float)M_PI * ((float)y + 0.5f) / SIDE;
            vec3s n = glms_vec3_normalize((vec3s){{cosf(u), 0.5f * cosf(v), 1}});
            for (int c = 0; c < 3; c++)
                texel[c] = (uint8_t)lroundf(127.5f + 127.5f * n.raw[c]);
        }
    return image;
}

static void give_waves(struct test_scene *scene, const tl_image *image)
{
    tl_material *material = &scene->shapes[0].material;
    material->normal_map.image = image;
    material->normal_map.transform.scale[0] = material->normal_map.transform.scale[1] = 6;
    test_scene_refresh(scene);
}

/* A11. Light taken into tangent space at vertices is off by what the frame turns within a triangle: half the
 * turn, a quarter of the error, with bumps as without. */
static void tangent_space_differs_with_the_frames_turn(void **state)
{
    struct test_device *device = *state;
    tl_image bumps = waves();
    for (int bumpy = 0; bumpy < 2; bumpy++) {
        double before = 0;
        for (int segments = 12; segments <= 48; segments *= 2) {
            struct test_scene scene;
            test_scene_open_lamplit(&scene, shiny_sphere(segments, 0.7f), 128, 128);
            scene.lamps[0] = test_lamp_at((vec3s){{-1, 1, 1.5f}}, 4);
            if (bumpy)
                give_waves(&scene, &bumps);
            tl_image world = draw_exactly(&scene, device->renderer);
            scene.settings.shading.space = TL_SPACE_TANGENT;
            double error = error_of(&scene, device->renderer, &world);
            print_message("%s, frames turn by %4.1f degrees: tangent space off by %.2e\n",
                          bumpy ? "bumpy" : "plain", 180.0 / segments, error);
            if (before > 0)
                assert_true(error < before / 2.5);
            before = error;
            tl_image_release(&world);
            test_scene_close(&scene);
        }
        assert_true(before < 0.02);
    }
    tl_image_release(&bumps);
}

/* A12. The waves' flanks face a light that the sphere itself hides from them. */
static void no_light_on_what_faces_away(void **state)
{
    struct test_device *device = *state;
    tl_image bumps = waves();
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(32, 0.7f), 96, 96);
    give_waves(&scene, &bumps);
    scene.lamps[0] = test_lamp_towards((vec3s){{1, 0.1f, -0.15f}}, 3);
    struct tl_view view = tl_view_make(&scene.frame.camera, 96, 96);
    tl_error error = {0};
    tl_trace *trace = tl_trace_create(&error);
    assert_ok(tl_trace_update(trace, scene.surfaces, 1, &error), error);
    for (int way = 0; way < 4; way++) {
        scene.settings.shading.self_shadow = way & 1;
        scene.settings.shading.space = way >> 1;
        tl_image image = test_scene_draw(&scene, device->renderer);
        int away = 0, towards = 0;
        for (int y = 0; y < 96; y++)
            for (int x = 0; x < 96; x++) {
                struct hit hit = intersect(&scene, trace, &view, x, y);
                float facing = glms_vec3_dot(hit.n, scene.lamps[0].direction);
                away += hit.is_hit && facing < -0.01f;
                towards += test_pixel(&image, x, y)[0] > 0;
                if (hit.is_hit && facing < -0.01f && test_pixel(&image, x, y)[3] > 0)
                    assert_true(test_pixel(&image, x, y)[0] == 0);
            }
        assert_true(away > 1000 && towards > 500);
        tl_image_release(&image);
    }
    tl_trace_destroy(&trace);
    tl_image_release(&bumps);
    test_scene_close(&scene);
}

/* The largest change of any pixel from frame to frame, averaged over the frames of a lamp that goes round. */
static double flicker(struct test_scene *scene, tl_renderer *renderer)
{
    enum { FRAMES = 12 };
    double sum = 0;
    tl_image before = {0};
    for (int i = 0; i <= FRAMES; i++) {
        float angle = 1.2f + 0.004f * (float)i;
        scene->lamps[0] = test_lamp_towards((vec3s){{sinf(angle), 0.2f, cosf(angle)}}, 3);
        tl_image image = test_scene_draw(scene, renderer);
        double maximum = 0;
        for (size_t k = 0; i > 0 && k < (size_t)image.width * (size_t)image.height * 4; k++)
            maximum =
                fmax(maximum, fabs((double)tl_image_floats(&image)[k] - (double)tl_image_floats(&before)[k]));
        sum += maximum;
        if (i > 0)
            tl_image_release(&before);
        before = image;
    }
    tl_image_release(&before);
    return sum / FRAMES;
}

static void a_ramp_flickers_less_than_a_step(void **state)
{
    struct test_device *device = *state;
    tl_image bumps = waves();
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(32, 0.5f), 96, 96);
    give_waves(&scene, &bumps);
    scene.settings.shading.self_shadow = TL_SELF_SHADOW_STEP;
    double step = flicker(&scene, device->renderer);
    scene.settings.shading.self_shadow = TL_SELF_SHADOW_RAMP;
    double ramp = flicker(&scene, device->renderer);
    print_message("frame to frame: step %.3f, ramp %.3f\n", step, ramp);
    assert_true(ramp < 0.5 * step);
    tl_image_release(&bumps);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_agree_far_away),
        cmocka_unit_test(coordinates_differ_close_by),
        cmocka_unit_test(a_texture_matrix_gives_the_coordinates),
        cmocka_unit_test(gouraud_loses_the_highlight_first),
        cmocka_unit_test(backs_are_fronts_turned_inside_out),
        cmocka_unit_test(normalises_as_the_cpu_does),
        cmocka_unit_test(interpolates_by_series_and_by_turning),
        cmocka_unit_test(raises_as_the_cpu_does),
        cmocka_unit_test(tangent_space_differs_with_the_frames_turn),
        cmocka_unit_test(no_light_on_what_faces_away),
        cmocka_unit_test(a_ramp_flickers_less_than_a_step),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
