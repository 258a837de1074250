#include "render/shade/pixels.h"

#include "config/memory.h"
#include "render/env/lobes_fetch.h"
#include "render/light/terms.h"
#include "render/shade/look.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROWS 8 /* that a thread takes at a time */

/* Blends of exponents by the base-2 logarithm of the exponent, in steps that a blend is linear over. */
#define BLEND_STEPS   64 /* an octave */
#define BLEND_OCTAVES 10

struct blends {
    struct tl_exponent_blend items[BLEND_STEPS * BLEND_OCTAVES + 1];
};

/* What all pixels share. */
struct scene {
    const struct tl_pixels_request *request;
    const struct blends *blends;
    float turn_cosine, turn_sine; /* of the environment's yaw */
    vec3s first, across, up;      /* the ray through pixel (0, 0), and its changes */
    vec3s suns[TL_SUNS_MAX];      /* directions, world */
};

/* ---- A run of pixels of one triangle ---- */

struct pixel_run {
    const struct tl_pixel_triangle *triangle;
    const struct tl_shade_part *part;
    tl_quad diffuse[3], glossy[3]; /* ratios at the corners; where the run is flat `diffuse` is the light */
    vec3s normals[3];
    vec4s tangents[3];
    vec2s uvs[3];
    tl_quad sunlight[TL_SUNS_MAX]; /* of a flat run, where all of the sun is seen */
    bool is_mixed;                 /* some corners are covered, some are not */
    bool is_flat;                  /* matt, of one colour and one normal */
    bool is_fading;                /* the ground where it fades */
};

TL_INLINE tl_quad exact_light(const struct scene *scene, vec3s direction, struct tl_exponent_blend blend)
{
    float c = scene->turn_cosine, s = scene->turn_sine;
    struct tl_octahedral_place place = tl_octahedral_place(c * direction.x - s * direction.z, direction.y,
                                                           s * direction.x + c * direction.z);
    return tl_lobes_fetch_quad(scene->request->lobes, place, blend);
}

static const struct tl_exponent_blend only_diffuse = {.index = 0};

TL_INLINE tl_quad quad_of(vec3s v)
{
    return (tl_quad){v.x, v.y, v.z, 0};
}

/* K_1 without a power. */
TL_INLINE float diffuse_lobe(float cosine)
{
    return 0.318309886f * tl_greater(cosine, 0);
}

/* Share of a sun's disc above the plane of the smooth normal. */
TL_INLINE float sun_above(const struct tl_sun *sun, float cosine)
{
    return disc_share(cosine / tl_greater(sun->radius, 1e-3f));
}

/* Of one normal and one colour: the light at the corners is all that a pixel interpolates. */
static void flatten(const struct scene *scene, struct pixel_run *run)
{
    const struct tl_pixels_request *request = scene->request;
    vec3s normal = glms_vec3_scale(run->normals[0], run->triangle->back ? -1.0f : 1.0f);
    tl_quad colour = quad_of(run->part->material->diffuse);
    tl_quad light = colour * exact_light(scene, normal, only_diffuse);
    for (int i = 0; i < 3; i++)
        run->diffuse[i] *= light;
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        float cosine = glms_vec3_dot(scene->suns[i], normal);
        run->sunlight[i] = colour * quad_of(sun->power) * (diffuse_lobe(cosine) * sun_above(sun, cosine));
    }
}

static bool has_one_normal(const struct pixel_run *run)
{
    for (int k = 1; k < 3; k++)
        if (run->normals[k].x != run->normals[0].x || run->normals[k].y != run->normals[0].y ||
            run->normals[k].z != run->normals[0].z)
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

static void begin_run(const struct scene *scene, const struct tl_pixel_triangle *triangle,
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
        run->normals[i] = surface->normals[vertex];
        run->tangents[i] = surface->tangents ? surface->tangents[vertex] : (vec4s){{0, 0, 0, 0}};
        run->uvs[i] = surface->uvs ? surface->uvs[vertex] : (vec2s){{0, 0}};
    }
    run->is_mixed = covered > 0 && covered < 3;
    run->is_fading = fades(request, triangle);
    run->is_flat = !run->part->has_maps && !run->part->is_glossy && !run->part->fan && has_one_normal(run);
    if (run->is_flat)
        flatten(scene, run);
}

TL_INLINE vec3s weighted3(const vec3s v[3], const float w[3])
{
    return (vec3s){{w[0] * v[0].x + w[1] * v[1].x + w[2] * v[2].x,
                    w[0] * v[0].y + w[1] * v[1].y + w[2] * v[2].y,
                    w[0] * v[0].z + w[1] * v[1].z + w[2] * v[2].z}};
}

/* What is seen is rarely covered: corners that are do not count beside others that are not. */
TL_INLINE void uncover(const struct pixel_run *run, float weights[3])
{
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        weights[i] = (weights[i] + 1e-6f) * (1 - run->glossy[i][3]);
        sum += weights[i];
    }
    for (int i = 0; i < 3; i++)
        weights[i] /= sum;
}

TL_INLINE tl_quad weighted_quad(const tl_quad v[3], const float w[3])
{
    return w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
}

TL_INLINE struct tl_exponent_blend blend_of(const struct scene *scene, float log_exponent)
{
    float at = tl_greater(tl_lesser(log_exponent, BLEND_OCTAVES), 0) * BLEND_STEPS;
    return scene->blends->items[(int)(at + 0.5f)];
}

/* ---- A pixel ---- */

/* The gloss, which depends on the viewer. */
struct gloss {
    /* Two lobes: */
    vec3s mirror, reflectance;
    float exponent;
    /* Facets: */
    struct tl_brdf_frame frame;
    float x, y, cosine; /* the viewer in it */
};

/* As tl_brdf_frame_make, with the sine and cosine of the rotation at hand. */
TL_INLINE struct tl_brdf_frame frame_of(const struct tl_shade_part *part, const struct tl_look *look,
                                        const struct tl_look_at *at)
{
    vec3s n = look->normal, t = {{at->tangent.x, at->tangent.y, at->tangent.z}};
    t = glms_vec3_sub(t, glms_vec3_scale(n, glms_vec3_dot(n, t)));
    float square = glms_vec3_dot(t, t);
    if (!(square > 1e-12f)) {
        vec3s axis = fabsf(n.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}};
        t = glms_vec3_cross(axis, n);
        square = glms_vec3_dot(t, t);
    }
    t = glms_vec3_scale(t, 1 / sqrtf(square));
    vec3s left = glms_vec3_cross(n, t);
    vec3s turned = glms_vec3_add(glms_vec3_scale(t, part->turn_cosine),
                                 glms_vec3_scale(left, at->side * part->turn_sine));
    float handedness = at->tangent.w * at->side < 0 ? -1.0f : 1.0f;
    return (struct tl_brdf_frame){n, turned, glms_vec3_scale(glms_vec3_cross(n, turned), handedness)};
}

/* A direction of the world in the environment, as a quad. */
TL_INLINE tl_quad turned_quad(const struct scene *scene, vec3s d, float scale)
{
    float c = scene->turn_cosine, s = scene->turn_sine;
    return scale * (tl_quad){c * d.x - s * d.z, d.y, s * d.x + c * d.z, 0};
}

/* The exact light of the lobes of a fan. */
TL_INLINE tl_quad light_of_facets(const struct scene *scene, const struct pixel_run *run,
                                  const struct tl_look *look, const struct tl_look_at *at,
                                  struct gloss *gloss)
{
    const struct tl_fan_table *fan = run->part->fan;
    tl_quad nodes[2 * TL_LOBE_FIT_MAX], light = {0, 0, 0, 0};
    gloss->frame = frame_of(run->part, look, at);
    gloss->x = glms_vec3_dot(at->viewer, gloss->frame.tangent);
    gloss->y = glms_vec3_dot(at->viewer, gloss->frame.bitangent);
    gloss->cosine = glms_vec3_dot(at->viewer, gloss->frame.normal);
    if (!(gloss->cosine > 0))
        return light;
    float side = tl_fan_fetch(fan, gloss->x, gloss->y, gloss->cosine, look->glossiness, nodes);
    tl_quad tangent = turned_quad(scene, gloss->frame.tangent, side),
            bitangent = turned_quad(scene, gloss->frame.bitangent, side),
            normal = turned_quad(scene, gloss->frame.normal, 1);
    /* All lobes of a fan have the same exponent. */
    const struct tl_exponent_blend blend = blend_of(scene, nodes[fan->lobe_count & ~1][3]);
    for (int k = 0; k < fan->lobe_count; k++) {
        const size_t node = 2 * (size_t)k;
        const tl_quad local = nodes[node], weight = nodes[node + 1];
        tl_quad d = local[0] * tangent + local[1] * bitangent + local[2] * normal;
        tl_quad exact =
            tl_lobes_fetch_quad(scene->request->lobes, tl_octahedral_place(d[0], d[1], d[2]), blend);
        light += exact * (tl_quad){tl_fan_weight(weight[0], weight[1], look->f0.x),
                                   tl_fan_weight(weight[0], weight[1], look->f0.y),
                                   tl_fan_weight(weight[0], weight[1], look->f0.z), 0};
    }
    return light;
}

TL_INLINE vec3s schlick(vec3s f0, float cosine)
{
    float away = 1 - tl_greater(tl_lesser(cosine, 1), 0), fifth = away * away * away * away * away;
    vec3s f;
    for (int c = 0; c < 3; c++)
        f.raw[c] = f0.raw[c] + (tl_lesser(50 * f0.raw[c], 1) - f0.raw[c]) * fifth;
    return f;
}

TL_INLINE tl_quad light_of_lobe(const struct scene *scene, const struct tl_look *look,
                                const struct tl_look_at *at, struct gloss *gloss)
{
    float cosine = glms_vec3_dot(look->normal, at->viewer);
    vec3s mirror = glms_vec3_sub(glms_vec3_scale(look->normal, 2 * tl_greater(cosine, 0)), at->viewer);
    gloss->mirror = tl_unit_or(mirror, look->normal);
    gloss->reflectance = schlick(look->f0, cosine);
    gloss->exponent = 1 / tl_greater(1 - look->glossiness, 1e-6f);
    return quad_of(gloss->reflectance) *
           exact_light(scene, gloss->mirror, blend_of(scene, tl_log2(gloss->exponent)));
}

/* tl_brdf_gloss_under_disc of Ward's facets. */
TL_INLINE vec3s ward_under_sun(const struct tl_gloss *model, const struct gloss *gloss, vec3s f0,
                               vec3s viewer, const struct tl_sun *sun, vec3s direction)
{
    const struct tl_brdf_frame *frame = &gloss->frame;
    float cos_a = glms_vec3_dot(frame->normal, direction);
    if (!(cos_a > 0 && gloss->cosine > 0))
        return (vec3s){{0, 0, 0}};
    float wider = sun->radius * sun->radius / 8;
    float u = model->width_weft * model->width_weft + wider,
          v = model->width_warp * model->width_warp + wider;
    vec3s sum = glms_vec3_add(direction, viewer);
    float x = glms_vec3_dot(frame->tangent, sum), y = glms_vec3_dot(frame->bitangent, sum),
          z = glms_vec3_dot(frame->normal, sum);
    float lobe = tl_exp2(-1.44269504f * (x * x / u + y * y / v) / (z * z)) *
                 sqrtf(cos_a / (gloss->cosine * u * v)) * (1 / (4 * (float)M_PI));
    return glms_vec3_scale(schlick(f0, 0.5f * sqrtf(glms_vec3_dot(sum, sum))), lobe);
}

TL_INLINE bool is_plain_ward(const struct tl_gloss *model)
{
    return model->model == TL_REFLECT_WARD && model->fresnel == TL_FRESNEL_SCHLICK &&
           model->width_weft >= 1e-3f && model->width_warp >= 1e-3f && model->width_weft <= 1 &&
           model->width_warp <= 1;
}

TL_INLINE vec3s gloss_under_sun(const struct pixel_run *run, const struct tl_sun *sun, vec3s direction,
                                const struct tl_look *look, const struct tl_look_at *at,
                                const struct gloss *gloss)
{
    const tl_material *material = run->part->material;
    if (!run->part->fan) {
        float exponent = lobe_broadened_exponent(gloss->exponent, sun->radius * GLM_SQRT1_2f);
        float cosine = tl_greater(glms_vec3_dot(direction, gloss->mirror), 1e-30f);
        return glms_vec3_scale(gloss->reflectance,
                               0.159154943f * (exponent + 1) * tl_power(cosine, exponent));
    }
    if (is_plain_ward(&material->gloss))
        return ward_under_sun(&material->gloss, gloss, look->f0, at->viewer, sun, direction);
    struct tl_brdf brdf = tl_brdf_of(material, look->f0, look->glossiness);
    return tl_brdf_gloss_under_disc(&brdf, &gloss->frame, direction, at->viewer, sun->radius);
}

TL_INLINE tl_quad light_of_sun(const struct scene *scene, const struct pixel_run *run, int sun, float visible,
                               const struct tl_look *look, const struct tl_look_at *at,
                               const struct gloss *gloss)
{
    const struct tl_sun *item = &scene->request->suns->items[sun];
    vec3s direction = scene->suns[sun];
    float seen = visible * sun_above(item, at->side * glms_vec3_dot(direction, at->smooth));
    if (!(seen > 0))
        return (tl_quad){0, 0, 0, 0};
    vec3s light = glms_vec3_scale(look->diffuse, diffuse_lobe(glms_vec3_dot(direction, look->normal)));
    if (run->part->fan || run->part->is_glossy)
        light = glms_vec3_add(light, gloss_under_sun(run, item, direction, look, at, gloss));
    return seen * quad_of(item->power) * quad_of(light);
}

TL_INLINE struct tl_look_at look_at(const struct pixel_run *run, const struct tl_pixel_weights *weights,
                                    vec3s ray)
{
    struct tl_look_at at = {.normal = weighted3(run->normals, weights->at),
                            .viewer = glms_vec3_negate(tl_unit_or(ray, (vec3s){{0, 1, 0}})),
                            .side = run->triangle->back ? -1.0f : 1.0f};
    at.smooth = tl_unit_or(at.normal, (vec3s){{0, 1, 0}});
    if (run->part->has_bumps || run->part->fan)
        for (int k = 0; k < 4; k++)
            at.tangent.raw[k] = weights->at[0] * run->tangents[0].raw[k] +
                                weights->at[1] * run->tangents[1].raw[k] +
                                weights->at[2] * run->tangents[2].raw[k];
    if (run->part->has_maps)
        for (int k = 0; k < 2; k++) {
            at.uv[k] = at.change[k][0] = at.change[k][1] = 0;
            for (int i = 0; i < 3; i++) {
                at.uv[k] += weights->at[i] * run->uvs[i].raw[k];
                at.change[k][0] += weights->across[i] * run->uvs[i].raw[k];
                at.change[k][1] += weights->up[i] * run->uvs[i].raw[k];
            }
        }
    return at;
}

static float cover_of(const struct scene *scene, const struct pixel_run *run, const float weights[3])
{
    const vec3s *p = run->triangle->surface->positions;
    const uint32_t *corners = run->triangle->corners;
    float x = 0, z = 0;
    for (int i = 0; i < 3; i++) {
        x += weights[i] * p[corners[i]].x;
        z += weights[i] * p[corners[i]].z;
    }
    return tl_ground_cover(scene->request->ground, x, z);
}

TL_INLINE float sun_seen(const struct tl_pixels_request *request, int sun, size_t pixel)
{
    const float *visible = request->sun_visibility[sun];
    return visible ? visible[pixel] : 1;
}

TL_INLINE tl_quad shade_look(const struct scene *scene, const struct pixel_run *run,
                             const struct tl_pixel_weights *weights, const float ratio_weights[3], int x,
                             int y, size_t pixel)
{
    const struct tl_pixels_request *request = scene->request;
    vec3s ray = glms_vec3_add(scene->first, glms_vec3_add(glms_vec3_scale(scene->across, (float)x),
                                                          glms_vec3_scale(scene->up, (float)y)));
    struct tl_look_at at = look_at(run, weights, ray);
    struct tl_look look = tl_look_evaluate(run->part, &request->materials->detail, &at);
    tl_quad colour = quad_of(look.diffuse) * exact_light(scene, look.normal, only_diffuse) *
                     weighted_quad(run->diffuse, ratio_weights);
    struct gloss gloss = {0};
    if (run->part->fan)
        colour += light_of_facets(scene, run, &look, &at, &gloss) * weighted_quad(run->glossy, ratio_weights);
    else if (run->part->is_glossy)
        colour += light_of_lobe(scene, &look, &at, &gloss) * weighted_quad(run->glossy, ratio_weights);
    for (int i = 0; i < request->suns->count; i++)
        colour += light_of_sun(scene, run, i, sun_seen(request, i, pixel), &look, &at, &gloss);
    return colour;
}

TL_INLINE tl_quad shade_pixel(const struct scene *scene, const struct pixel_run *run, int x, int y)
{
    const struct tl_pixels_request *request = scene->request;
    const size_t pixel = (size_t)y * (size_t)request->ids->width + (size_t)x;
    struct tl_pixel_weights weights = tl_pixel_weigh(run->triangle, (float)x + 0.5f, (float)y + 0.5f);
    float ratio_weights[3] = {weights.at[0], weights.at[1], weights.at[2]};
    if (run->is_mixed)
        uncover(run, ratio_weights);
    tl_quad colour;
    if (run->is_flat) {
        colour = weighted_quad(run->diffuse, ratio_weights);
        for (int i = 0; i < request->suns->count; i++)
            colour += sun_seen(request, i, pixel) * run->sunlight[i];
    } else {
        colour = shade_look(scene, run, &weights, ratio_weights, x, y, pixel);
    }
    float cover = run->is_fading ? cover_of(scene, run, weights.at) : 1;
    colour *= cover;
    colour[3] = cover;
    return colour;
}

/* Pixels of a flat run from x on, until the triangle ends. Returns where that is. */
TL_INLINE int shade_flat(const struct scene *scene, const struct pixel_run *run, const uint32_t *row, int x,
                         int y, tl_quad *out)
{
    const struct tl_pixels_request *request = scene->request;
    const struct tl_pixel_triangle *triangle = run->triangle;
    const int width = request->ids->width, suns = request->suns->count;
    const size_t first = (size_t)y * (size_t)width;
    const uint32_t id = row[x];
    float base[3], step[3];
    for (int i = 0; i < 3; i++) {
        const float *e = triangle->edges[i];
        step[i] = e[0];
        base[i] = e[0] * (0.5f - triangle->x0) + e[1] * ((float)y + 0.5f - triangle->y0) + e[2];
    }
    for (; x < width && row[x] == id; x++) {
        float a = tl_greater(base[0] + step[0] * (float)x, 0),
              b = tl_greater(base[1] + step[1] * (float)x, 0),
              c = tl_greater(base[2] + step[2] * (float)x, 0);
        tl_quad colour = (a * run->diffuse[0] + b * run->diffuse[1] + c * run->diffuse[2]) *
                         (1 / tl_greater(a + b + c, 1e-30f));
        for (int i = 0; i < suns; i++)
            colour += sun_seen(request, i, first + (size_t)x) * run->sunlight[i];
        colour[3] = 1;
        out[x] = colour;
    }
    return x;
}

/* Rows first .. last - 1 of the ID buffer to `to`. */
TL_CLONES static void shade_rows(const struct scene *scene, int first, int last, float *to)
{
    const struct tl_id_buffer *ids = scene->request->ids;
    const int width = ids->width;
    for (int y = first; y < last; y++) {
        const uint32_t *row = ids->ids + (size_t)y * (size_t)width;
        tl_quad *out = (tl_quad *)to + (size_t)(y - first) * (size_t)width;
        uint32_t before = 0;
        struct pixel_run run = {0};
        for (int x = 0; x < width;) {
            if (row[x] == 0) {
                out[x++] = (tl_quad){0, 0, 0, 0};
                continue;
            }
            if (row[x] != before) {
                begin_run(scene, &scene->request->triangles[tl_ids_place(ids, row[x])], &run);
                before = row[x];
            }
            assert(run.triangle); /* of the first covered pixel */
            if (run.is_flat && !run.is_mixed && !run.is_fading) {
                x = shade_flat(scene, &run, row, x, y, out);
            } else {
                out[x] = shade_pixel(scene, &run, x, y);
                x++;
            }
        }
    }
}

/* ---- All pixels ---- */

static void make_blends(struct blends *blends)
{
    for (int i = 0; i <= BLEND_STEPS * BLEND_OCTAVES; i++)
        blends->items[i] = tl_exponent_blend(exp2f((float)i / BLEND_STEPS));
}

static void place_rays(const struct tl_pixels_request *request, struct scene *scene)
{
    const struct tl_view *view = request->view;
    scene->across = glms_vec3_scale(view->right, 2 / (float)request->ids->width);
    scene->up = glms_vec3_scale(view->up, 2 / (float)request->ids->height);
    scene->first = glms_vec3_sub(view->forward, glms_vec3_add(view->right, view->up));
    scene->first =
        glms_vec3_add(scene->first, glms_vec3_scale(glms_vec3_add(scene->across, scene->up), 0.5f));
}

static void shade_all(const struct scene *scene, float *image)
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
static void shade_and_average(const struct scene *scene, int side, float *image)
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
    struct blends *blends = TL_NEW(struct blends);
    struct scene scene = {.request = request,
                          .blends = blends,
                          .turn_cosine = cosf(request->environment_yaw),
                          .turn_sine = sinf(request->environment_yaw)};
    make_blends(blends);
    place_rays(request, &scene);
    for (int i = 0; i < request->suns->count; i++)
        scene.suns[i] = tl_turn_direction(request->suns->items[i].direction, request->environment_yaw);
    if (side == 1)
        shade_all(&scene, image);
    else
        shade_and_average(&scene, side, image);
    free(blends);
}
