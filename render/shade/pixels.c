#include "render/shade/pixels.h"

#include "config/base/memory.h"
#include "render/env/lobes_fetch.h"
#include "render/shade/pixels_internal.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROWS 8 /* that a thread takes at a time */

/* ---- A run of pixels of one triangle ---- */

struct pixel_run {
    const struct tl_pixel_triangle *triangle;
    const struct tl_shade_part *part;
    tl_quad diffuse[3], glossy[3]; /* ratios at the corners; where the run is flat `diffuse` is the light */
    tl_quad other[3];              /* ... of the diffuse light of the other side */
    tl_quad fuzz[3];               /* ... of fibres */
    tl_quad normals[3], tangents[3];
    tl_quad uvs[3];                   /* u, v, u, v */
    tl_quad slopes[3], slope;         /* of the weights, not normalised: across twice, up twice; their sum */
    tl_quad lit[TL_PIXEL_LIGHTS_MAX]; /* of a flat run, where all of the light is seen */
    bool is_mixed;                    /* some corners are covered, some are not */
    bool is_flat;                     /* matt, of one colour and one normal */
    bool is_fading;                   /* the ground where it fades */
};

/* A part of one normal and one colour: the light at the corners is all that a pixel interpolates. */
static void flatten(const struct tl_pixel_scene *scene, struct pixel_run *run)
{
    const struct tl_pixels_request *request = scene->request;
    const float side = run->triangle->back ? -1.0f : 1.0f;
    const vec3s normal = {{side * run->normals[0][0], side * run->normals[0][1], side * run->normals[0][2]}};
    const vec3s d = tl_pixel_turned(scene, normal);
    const tl_material *material = run->part->material;
    tl_quad colour = tl_pixel_quad(run->triangle->back && material->back.is_given ? material->back.diffuse
                                                                                  : material->diffuse);
    tl_quad light = colour * tl_lobe_map_fetch(&request->lobes->maps[0], octahedral_place(d));
    for (int i = 0; i < 3; i++)
        run->diffuse[i] *= light;
    for (int i = 0; i < request->lights->count; i++) {
        const struct tl_pixel_light *source = &request->lights->items[i];
        const float cosine = glms_vec3_dot(source->sun.direction, normal);
        run->lit[i] = colour * tl_pixel_quad(source->sun.power) *
                      (tl_pixel_diffuse_lobe(cosine) * tl_pixel_light_above(source, cosine));
    }
}

static bool has_one_normal(const struct pixel_run *run)
{
    for (int k = 1; k < 3; k++)
        for (int c = 0; c < 3; c++)
            if (run->normals[k][c] != run->normals[0][c])
                return false;
    return true;
}

static bool fades(const struct tl_pixels_request *request, const struct tl_pixel_triangle *triangle)
{
    if (!request->ground || triangle->surface_index + 1 != request->ranges->surface_count)
        return false;
    for (int i = 0; i < 3; i++) {
        vec3s p = triangle->surface->positions[triangle->corners[i]];
        if (tl_ground_cover(request->ground, p.x, p.z) < 1)
            return true;
    }
    return false;
}

static void begin_run(const struct tl_pixel_scene *scene, const struct tl_pixel_triangle *triangle,
                      struct pixel_run *run)
{
    const struct tl_pixels_request *request = scene->request;
    const tl_surface *surface = triangle->surface;
    run->triangle = triangle;
    run->part = &request->materials->parts[triangle->part];
    float covered = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = triangle->corners[i];
        const struct tl_vertex_ratio *ratio =
            tl_ratio_at(request->ratios, triangle->surface_index, vertex, triangle->back);
        run->diffuse[i] = *(const tl_quad *)ratio->diffuse;
        run->glossy[i] = *(const tl_quad *)ratio->glossy;
        covered += run->glossy[i][3];
        if (run->part->transmits) {
            ratio = tl_ratio_at(request->ratios, triangle->surface_index, vertex, !triangle->back);
            run->other[i] = *(const tl_quad *)ratio->diffuse;
        }
        if (run->part->has_fuzz)
            run->fuzz[i] = *(const tl_quad *)tl_fuzz_ratio_at(request->ratios, triangle->surface_index,
                                                              vertex, triangle->back);
        run->normals[i] = tl_pixel_quad(surface->normals[vertex]);
        const vec4s tangent = surface->tangents ? surface->tangents[vertex] : (vec4s){{0, 0, 0, 0}};
        run->tangents[i] = (tl_quad){tangent.x, tangent.y, tangent.z, tangent.w};
        const vec2s uv = surface->uvs ? surface->uvs[vertex] : (vec2s){{0, 0}};
        run->uvs[i] = (tl_quad){uv.x, uv.y, uv.x, uv.y};
        const float *e = triangle->edges[i];
        run->slopes[i] = (tl_quad){e[0], e[0], e[1], e[1]};
    }
    run->slope = run->slopes[0] + run->slopes[1] + run->slopes[2];
    run->is_mixed = covered > 0 && covered < 3;
    run->is_fading = fades(request, triangle);
    run->is_flat = !run->part->has_maps && !run->part->is_glossy && !run->part->is_faceted &&
                   run->part->is_lambert && !run->part->transmits && !run->part->has_fuzz &&
                   !request->lights->are_near && has_one_normal(run);
    if (run->is_flat)
        flatten(scene, run);
}

static vec3s point_of(const struct tl_pixel_triangle *triangle, const float weights[3])
{
    vec3s point = {{0, 0, 0}};
    for (int i = 0; i < 3; i++)
        point = glms_vec3_add(
            point, glms_vec3_scale(triangle->surface->positions[triangle->corners[i]], weights[i]));
    return point;
}

/* Whether the layer that a pixel is seen through lies close above it. What the viewer sees first is rarely
 * covered. */
static bool is_covered(const struct tl_pixel_scene *scene, const struct pixel_run *run,
                       const float weights[3], int x, int y)
{
    const struct tl_id_buffer *ids = scene->request->ids;
    if (!scene->nearer)
        return false;
    const uint32_t id = scene->nearer[(size_t)y * (size_t)ids->width + (size_t)x];
    const struct tl_pixel_triangle *above = &scene->request->triangles->items[tl_ids_place(ids, id)];
    const struct tl_pixel_weights at = tl_pixel_weigh(above, (float)x + 0.5f, (float)y + 0.5f);
    const vec3s up = glms_vec3_sub(point_of(above, at.at), point_of(run->triangle, weights));
    vec3s normal = {{0, 0, 0}};
    for (int i = 0; i < 3; i++)
        normal =
            glms_vec3_add(normal, glms_vec3_scale(run->triangle->surface->normals[run->triangle->corners[i]],
                                                  run->triangle->back ? -weights[i] : weights[i]));
    return glms_vec3_dot(up, glms_vec3_normalize(normal)) < scene->request->cover_m;
}

/* Corners that are covered do not count where a pixel is not, nor those that are not where it is. */
TL_INLINE void match_cover(const struct pixel_run *run, bool is_covered, float weights[3])
{
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        weights[i] = (weights[i] + 1e-6f) * (is_covered ? run->glossy[i][3] : 1 - run->glossy[i][3]);
        sum += weights[i];
    }
    for (int i = 0; i < 3; i++)
        weights[i] /= sum;
}

TL_INLINE tl_quad weighted_quad(const tl_quad v[3], const float w[3])
{
    return w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
}

/* ---- A pixel ---- */

static float cover_of(const struct tl_pixel_scene *scene, const struct pixel_run *run, const float weights[3])
{
    const vec3s point = point_of(run->triangle, weights);
    return tl_ground_cover(scene->request->ground, point.x, point.z);
}

/* A pixel of a flat run. */
TL_INLINE tl_quad flat_pixel(const struct tl_pixel_scene *scene, const struct pixel_run *run,
                             const float ratio_weights[3], size_t pixel)
{
    tl_quad colour = weighted_quad(run->diffuse, ratio_weights);
    for (int i = 0; i < scene->request->lights->count; i++)
        colour += tl_pixel_light_seen(scene, i, pixel) * run->lit[i];
    return colour;
}

/* Interpolates what the other pixels are evaluated from. */
TL_INLINE void fill_lane(const struct pixel_run *run, const struct tl_pixel_weights *weights,
                         struct tl_look_lanes *look, int lane)
{
    const tl_quad normal = weighted_quad(run->normals, weights->at);
    look->side[lane] = run->triangle->back ? -1.0f : 1.0f;
    for (int c = 0; c < 3; c++)
        look->normal[c][lane] = normal[c];
    if (run->part->has_bumps || run->part->is_faceted) {
        const tl_quad tangent = weighted_quad(run->tangents, weights->at);
        for (int c = 0; c < 4; c++)
            look->tangent[c][lane] = tangent[c];
    }
    if (run->part->has_maps) {
        const tl_quad uv = weighted_quad(run->uvs, weights->at);
        look->triangle[lane] = run->triangle->number;
        tl_quad change = {0, 0, 0, 0};
        for (int i = 0; i < 3; i++)
            change += weights->scale * (run->slopes[i] - weights->at[i] * run->slope) * run->uvs[i];
        for (int k = 0; k < 2; k++) {
            look->uv[k][lane] = uv[k];
            look->change[k][0][lane] = change[k];
            look->change[k][1][lane] = change[k + 2];
            look->slopes[k][lane] = run->triangle->slopes[k];
        }
    }
}

TL_INLINE void flush(const struct tl_pixel_scene *scene, struct tl_pixel_lanes *lanes)
{
    if (lanes->look.count > 0)
        tl_pixel_lanes_shade(scene, lanes);
    lanes->look.count = 0;
}

/* Writes a pixel's colour, now or with its lanes. */
TL_INLINE void shade_pixel(const struct tl_pixel_scene *scene, const struct pixel_run *run, int x, int y,
                           struct tl_pixel_lanes *lanes, tl_quad *to)
{
    const size_t pixel = (size_t)y * (size_t)scene->request->ids->width + (size_t)x;
    const struct tl_pixel_weights weights = tl_pixel_weigh(run->triangle, (float)x + 0.5f, (float)y + 0.5f);
    float ratio_weights[3] = {weights.at[0], weights.at[1], weights.at[2]};
    if (run->is_mixed)
        match_cover(run, is_covered(scene, run, weights.at, x, y), ratio_weights);
    float cover = run->is_fading ? cover_of(scene, run, weights.at) : 1;
    if (run->is_flat) {
        tl_quad colour = cover * flat_pixel(scene, run, ratio_weights, pixel);
        colour[3] = cover;
        *to = colour;
        return;
    }
    if (lanes->look.part != run->part)
        flush(scene, lanes);
    const int lane = lanes->look.count++;
    lanes->look.part = run->part;
    lanes->x[lane] = (float)x;
    lanes->y[lane] = (float)y;
    lanes->pixel[lane] = pixel;
    if (scene->request->lights->are_near)
        tl_lane_store(lanes->point, lane, point_of(run->triangle, weights.at));
    lanes->cover[lane] = cover;
    lanes->to[lane] = to;
    lanes->diffuse_ratio[lane] = weighted_quad(run->diffuse, ratio_weights);
    lanes->glossy_ratio[lane] = weighted_quad(run->glossy, ratio_weights);
    if (run->part->has_fuzz)
        lanes->fuzz_ratio[lane] = weighted_quad(run->fuzz, ratio_weights);
    if (run->part->transmits) /* what is not seen itself may well be covered: by the body, for one */
        lanes->other_ratio[lane] = weighted_quad(run->other, weights.at);
    fill_lane(run, &weights, &lanes->look, lane);
    if (lanes->look.count == TL_LANES)
        flush(scene, lanes);
}

/* Pixels of a flat run from x on, until the triangle ends. Returns where that is. */
TL_INLINE int shade_flat(const struct tl_pixel_scene *scene, const struct pixel_run *run, const uint32_t *row,
                         int x, int y, tl_quad *out)
{
    const struct tl_pixels_request *request = scene->request;
    const struct tl_pixel_triangle *triangle = run->triangle;
    const int width = request->ids->width, lights = request->lights->count;
    const size_t first = (size_t)y * (size_t)width;
    const uint32_t id = row[x];
    float base[3], step[3];
    for (int i = 0; i < 3; i++) {
        const float *e = triangle->edges[i];
        step[i] = e[0];
        base[i] = e[0] * (0.5f - triangle->x0) + e[1] * ((float)y + 0.5f - triangle->y0) + e[2];
    }
    for (; x < width && row[x] == id; x++) {
        float a = tl_maxf(base[0] + step[0] * (float)x, 0), b = tl_maxf(base[1] + step[1] * (float)x, 0),
              c = tl_maxf(base[2] + step[2] * (float)x, 0);
        tl_quad colour = (a * run->diffuse[0] + b * run->diffuse[1] + c * run->diffuse[2]) *
                         (1 / tl_maxf(a + b + c, 1e-30f));
        for (int i = 0; i < lights; i++)
            colour += tl_pixel_light_seen(scene, i, first + (size_t)x) * run->lit[i];
        colour[3] = 1;
        out[x] = colour;
    }
    return x;
}

/* Rows first .. last - 1 of a layer to `to`. */
TL_CLONES static void shade_layer(const struct tl_pixel_scene *scene, int first, int last, float *to)
{
    const struct tl_id_buffer *ids = scene->request->ids;
    const int width = ids->width;
    struct tl_pixel_lanes lanes = {0};
    for (int y = first; y < last; y++) {
        const uint32_t *row = scene->ids + (size_t)y * (size_t)width;
        tl_quad *out = (tl_quad *)to + (size_t)(y - first) * (size_t)width;
        uint32_t before = 0;
        struct pixel_run run = {0};
        for (int x = 0; x < width;) {
            if (row[x] == 0) {
                out[x++] = (tl_quad){0, 0, 0, 0};
                continue;
            }
            if (row[x] != before) {
                begin_run(scene, &scene->request->triangles->items[tl_ids_place(ids, row[x])], &run);
                before = row[x];
            }
            assert(run.triangle && run.part); /* of the first covered pixel */
            if (run.is_flat && !run.is_mixed && !run.is_fading) {
                x = shade_flat(scene, &run, row, x, y, out);
            } else {
                shade_pixel(scene, &run, x, y, &lanes, &out[x]);
                x++;
            }
        }
    }
    flush(scene, &lanes);
}

/* ---- Layers ---- */

/* Gives the light of a layer's row the share of it that the viewer sees, and keeps in `through` what the
 * layer lets through. Adds it to `sum`, or replaces that by it in the nearest layer. */
static void blend_row(const struct tl_pixel_scene *scene, int y, const tl_quad *light, float *through,
                      tl_quad *sum)
{
    const struct tl_pixels_request *request = scene->request;
    const struct tl_id_buffer *ids = request->ids;
    const uint32_t *row = scene->ids + (size_t)y * (size_t)ids->width;
    uint32_t before = 0;
    float openness = 0;
    for (int x = 0; x < ids->width; x++) {
        if (row[x] == 0)
            continue; /* `light` is 0 there */
        if (row[x] != before) {
            before = row[x];
            const size_t part = request->triangles->items[tl_ids_place(ids, before)].part;
            const bool is_last = scene->layer == TL_TRANSPARENCY_LAYERS;
            openness = is_last ? 0 : request->materials->parts[part].material->openness;
        }
        const tl_quad seen = light[x] * (through[x] * (1 - openness));
        sum[x] = scene->layer > 0 ? sum[x] + seen : seen;
        through[x] *= openness;
    }
}

/* Rows first .. last - 1 of the ID buffer to `to`, with what is seen behind open triangles. */
static void shade_rows(const struct tl_pixel_scene *nearest, int first, int last, float *to)
{
    const struct tl_id_buffer *ids = nearest->request->ids;
    const size_t width = (size_t)ids->width;
    shade_layer(nearest, first, last, to);
    if (!(nearest->request->materials->openness > 0))
        return;
    float *through = tl_alloc(width, sizeof *through);
    tl_quad *behind = tl_alloc_lines(width, sizeof *behind);
    for (int y = first; y < last; y++) {
        tl_quad *sum = (tl_quad *)to + (size_t)(y - first) * width;
        for (size_t x = 0; x < width; x++)
            through[x] = 1;
        blend_row(nearest, y, sum, through, sum);
        struct tl_pixel_scene layer = *nearest;
        for (int k = 0; ids->layer_count > 1 && k < ids->depths[y]; k++) {
            layer.layer = k + 1;
            layer.nearer = layer.ids;
            layer.ids = ids->layers[k];
            shade_layer(&layer, y, y + 1, (float *)behind);
            blend_row(&layer, y, behind, through, sum);
        }
    }
    free(through);
    free(behind);
}

/* ---- All pixels ---- */

static void place_rays(const struct tl_pixels_request *request, struct tl_pixel_scene *scene)
{
    const struct tl_view *view = request->view;
    scene->across = glms_vec3_scale(view->right, 2 / (float)request->ids->width);
    scene->up = glms_vec3_scale(view->up, 2 / (float)request->ids->height);
    scene->first = glms_vec3_sub(view->forward, glms_vec3_add(view->right, view->up));
    scene->first =
        glms_vec3_add(scene->first, glms_vec3_scale(glms_vec3_add(scene->across, scene->up), 0.5f));
}

static void shade_all(const struct tl_pixel_scene *scene, float *image)
{
    const int width = scene->request->ids->width, height = scene->request->ids->height;
#pragma omp parallel for schedule(dynamic)
    for (int first = 0; first < height; first += ROWS)
        shade_rows(scene, first, first + ROWS < height ? first + ROWS : height,
                   image + 4 * (size_t)first * (size_t)width);
}

/* A pixel of the image from `side` rows of samples. */
TL_CLONES static void average_rows(const float *rows, int width, int side, float *to)
{
    const tl_quad *samples = (const tl_quad *)rows;
    const float share = 1 / (float)(side * side);
    for (int x = 0; x < width / side; x++) {
        tl_quad sum = {0, 0, 0, 0};
        for (int j = 0; j < side; j++)
            for (int i = 0; i < side; i++)
                sum += samples[j * width + x * side + i];
        ((tl_quad *)to)[x] = share * sum;
    }
}

/* Row by row, so that samples never leave the cache. */
static void shade_and_average(const struct tl_pixel_scene *scene, int side, float *image)
{
    const int width = scene->request->ids->width, height = scene->request->ids->height / side;
#pragma omp parallel
    {
        float *rows = TL_NEW_ARRAY(float, 4 * (size_t)side * (size_t)width);
#pragma omp for schedule(dynamic, 4)
        for (int y = 0; y < height; y++) {
            shade_rows(scene, y * side, (y + 1) * side, rows);
            average_rows(rows, width, side, image + 4 * (size_t)y * (size_t)(width / side));
        }
        free(rows);
    }
}

void tl_pixels_shade(const struct tl_pixels_request *request, int side, float *image)
{
    struct tl_pixel_blends *blends = tl_pixel_blends_make();
    struct tl_pixel_scene scene = {.request = request,
                                   .ids = request->ids->ids,
                                   .blends = blends,
                                   .turn_cosine = cosf(request->environment_yaw),
                                   .turn_sine = sinf(request->environment_yaw)};
    place_rays(request, &scene);
    if (side == 1)
        shade_all(&scene, image);
    else
        shade_and_average(&scene, side, image);
    free(blends);
}
