#include "app/lab/gallery/baked.h"

#include "app/textures/baked_maps.h"
#include "config/base/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MAP_SIDE 512
#define REACH_M  0.02f

/* A grid over u and v in [0, 1] whose surface the point describes, without its wrinkles (0) or with (1). */
struct baked_shape {
    vec3s (*point)(float u, float v, float wrinkles);
    float extent_v; /* texture coordinates end at (1, extent_v), so that a step of both is one length */
    int coarse[2], fine[2]; /* cells along u, v */
};

/* The gallery's torus, with wrinkles of 4 mm around its tube. */
static vec3s torus_point(float u, float v, float wrinkles)
{
    const float ring_m = 0.12f, tube_m = 0.055f, tilt = 1.05f, turn = 2 * (float)M_PI;
    float tube = tube_m + wrinkles * 0.004f * sinf(turn * 10 * v) * cosf(turn * 16 * u);
    float out = ring_m + tube * cosf(turn * v);
    vec3s level = {{out * cosf(turn * u), tube * sinf(turn * v), -out * sinf(turn * u)}};
    return (vec3s){{level.x, 0.2f + level.y * cosf(tilt) - level.z * sinf(tilt),
                    level.y * sinf(tilt) + level.z * cosf(tilt)}};
}

/* A sheet that hangs in two folds, with wrinkles of 4 mm aslant. */
static vec3s sheet_point(float u, float v, float wrinkles)
{
    const float side_m = 0.46f, turn = 2 * (float)M_PI;
    float fold = 0.03f * sinf(turn * 2 * u),
          wrinkle = 0.004f * sinf(turn * (9 * u + 4 * v)) * sinf(turn * 6 * v);
    return (vec3s){{side_m * (u - 0.5f), 0.27f + side_m * (v - 0.5f), fold + wrinkles * wrinkle}};
}

static const struct baked_shape shapes[TL_PICTURE_OBJECTS] = {
    [TL_PICTURE_SOLID] = {torus_point, 0.055f / 0.12f, {48, 16}, {384, 192}},
    [TL_PICTURE_SHEET] = {sheet_point, 1, {16, 8}, {256, 256}},
};

static void print_grid(FILE *out, const struct baked_shape *shape, const int cells[2], float wrinkles)
{
    for (int j = 0; j <= cells[1]; j++)
        for (int i = 0; i <= cells[0]; i++) {
            float u = (float)i / (float)cells[0], v = (float)j / (float)cells[1];
            vec3s p = shape->point(u, v, wrinkles);
            fprintf(out, "v %.7f %.7f %.7f\nvt %.7f %.7f\n", (double)p.x, (double)p.y, (double)p.z, (double)u,
                    (double)(shape->extent_v * v));
        }
    for (int j = 0; j < cells[1]; j++)
        for (int i = 0; i < cells[0]; i++) {
            int a = j * (cells[0] + 1) + i + 1, b = a + 1, d = a + cells[0] + 1, c = d + 1;
            fprintf(out, "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, d, d);
        }
}

static bool write_grid(const char *path, const struct baked_shape *shape, const int cells[2], float wrinkles,
                       tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    print_grid(writer.stream, shape, cells, wrinkles);
    return tl_writer_commit(&writer, error);
}

static bool bake(char *const paths[4], tl_error *error)
{
    const struct tl_transfer_params params = {MAP_SIDE, MAP_SIDE, REACH_M};
    struct tl_transfer maps = {0};
    tl_model coarse, fine;
    if (!tl_model_load(paths[0], &coarse, error))
        return false;
    bool done = tl_model_load(paths[1], &fine, error);
    if (done) {
        done = tl_baked_maps_make(paths[0], &coarse, paths[1], &fine, &params, &maps, error) &&
               tl_baked_maps_save(paths[2], &maps, error) && tl_baked_maps_save(paths[3], &maps, error);
        tl_transfer_release(&maps);
        tl_model_release(&fine);
    }
    tl_model_release(&coarse);
    return done;
}

bool tl_baked_make(const struct tl_experiment_picture *picture, tl_error *error)
{
    static const char *const names[] = {"coarse.obj", "fine.obj", "normals.png", "heights.exr"};
    bool done = true;
    for (int object = 0; done && object < TL_PICTURE_OBJECTS; object++) {
        const struct baked_shape *shape = &shapes[object];
        char *paths[4];
        for (int i = 0; i < 4; i++)
            paths[i] = tl_picture_file(picture, object, names[i]);
        done = write_grid(paths[0], shape, shape->coarse, 0, error) &&
               write_grid(paths[1], shape, shape->fine, 1, error) && bake(paths, error);
        for (int i = 0; i < 4; i++)
            free(paths[i]);
    }
    return done;
}
