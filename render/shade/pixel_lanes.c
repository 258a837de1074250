#include "config/base/memory.h"
#include "render/brdf/material_lobes.h"
#include "render/brdf/ward_lanes.h"
#include "render/env/lobes_fetch.h"
#include "render/shade/pixels_internal.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct tl_pixel_blends {
    struct tl_exponent_blend items[LOBE_BLENDS];
};

struct tl_pixel_blends *tl_pixel_blends_make(void)
{
    struct tl_pixel_blends *blends = TL_NEW(struct tl_pixel_blends);
    for (int i = 0; i < LOBE_BLENDS; i++)
        blends->items[i] = tl_exponent_blend(exp2f((float)i / LOBE_BLEND_STEPS));
    return blends;
}

/* ---- Exact light ---- */

/* Texels of one map about a direction of each lane, and their shares. */
struct fetch_lanes {
    int first[TL_LANES];
    float right[TL_LANES], below[TL_LANES];
};

TL_INLINE void place_fetch(struct fetch_lanes *fetch, int lane, int side, vec2s place)
{
    struct tl_lobe_texels at = tl_lobe_texels_about(side, place);
    fetch->first[lane] = at.first;
    fetch->right[lane] = at.right;
    fetch->below[lane] = at.below;
}

TL_INLINE tl_quad fetch_lane(const struct tl_lobe_map *map, const struct fetch_lanes *fetch, int lane)
{
    return tl_lobe_texels_mean(
        map, (struct tl_lobe_texels){fetch->first[lane], fetch->right[lane], fetch->below[lane]});
}

/* The two maps that each lane blends. */
struct blend_lanes {
    const struct tl_lobe_map *low[TL_LANES], *high[TL_LANES];
    int low_side[TL_LANES], high_side[TL_LANES];
    float weight[TL_LANES]; /* of `high` */
};

TL_INLINE void choose_maps(const struct tl_pixel_scene *scene, const float log_exponents[TL_LANES], int count,
                           struct blend_lanes *blends)
{
    const struct tl_lobe_map *maps = scene->request->lobes->maps;
    for (int i = 0; i < TL_LANES; i++) {
        const struct tl_exponent_blend blend =
            scene->blends->items[lobe_blend_number(log_exponents[i < count ? i : 0])];
        blends->low[i] = &maps[blend.index];
        blends->high[i] = &maps[blend.index + (blend.weight > 0)]; /* need not exist otherwise */
        blends->low_side[i] = blends->low[i]->side;
        blends->high_side[i] = blends->high[i]->side;
        blends->weight[i] = blend.weight;
    }
}

/* Texels about a direction in both maps. */
struct pair_lanes {
    struct fetch_lanes low, high;
};

TL_INLINE void place_pair(const struct blend_lanes *blends, int lane, vec3s direction, struct pair_lanes *to)
{
    vec2s place = octahedral_place(direction);
    place_fetch(&to->low, lane, blends->low_side[lane], place);
    place_fetch(&to->high, lane, blends->high_side[lane], place);
}

TL_INLINE tl_quad fetch_pair(const struct blend_lanes *blends, int lane, const struct pair_lanes *pair)
{
    tl_quad low = fetch_lane(blends->low[lane], &pair->low, lane);
    return low + blends->weight[lane] * (fetch_lane(blends->high[lane], &pair->high, lane) - low);
}

TL_INLINE void add_diffuse(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                           tl_quad light[TL_LANES])
{
    const struct tl_look_lanes *seen = &lanes->look;
    const struct tl_shade_part *part = seen->part;
    const struct tl_lobe_map *map = &scene->request->lobes->maps[0];
    struct fetch_lanes fetch;
    for (int i = 0; i < TL_LANES; i++) {
        vec3s d = tl_pixel_turned(scene, tl_lane_vector(seen->shown, i));
        place_fetch(&fetch, i, map->side, octahedral_place(d));
    }
    for (int i = 0; i < seen->count; i++)
        light[i] = seen->diffuse[i] * fetch_lane(map, &fetch, i) * lanes->diffuse_ratio[i];
    for (int i = 0; !part->is_lambert && i < seen->count; i++)
        light[i] *= matt_albedo(
            part->law, glms_vec3_dot(tl_lane_vector(seen->shown, i), tl_lane_vector(seen->viewer, i)));
}

/* The light that comes through from the other side. */
TL_INLINE void add_transmitted(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                               tl_quad light[TL_LANES])
{
    const struct tl_look_lanes *seen = &lanes->look;
    const struct tl_lobe_map *map = &scene->request->lobes->maps[0];
    const tl_quad colour = tl_pixel_quad(seen->part->material->transmission);
    struct fetch_lanes fetch;
    for (int i = 0; i < TL_LANES; i++) {
        vec3s d = tl_pixel_turned(scene, glms_vec3_negate(tl_lane_vector(seen->shown, i)));
        place_fetch(&fetch, i, map->side, octahedral_place(d));
    }
    for (int i = 0; i < seen->count; i++)
        light[i] += colour * fetch_lane(map, &fetch, i) * lanes->other_ratio[i];
}

/* ---- Gloss ---- */

/* The gloss, which depends on the viewer. */
struct gloss_lanes {
    /* Two lobes: */
    float mirror[3][TL_LANES], exponent[TL_LANES];
    tl_quad reflectance[TL_LANES];
    /* Facets: */
    float tangent[3][TL_LANES], bitangent[3][TL_LANES], normal[3][TL_LANES]; /* the frame of the threads */
    float viewer[3][TL_LANES];                                               /* in it */
    float square[3][TL_LANES];                        /* of Ward's widths, and their product */
    float thread_square[TL_THREADS_MAX][3][TL_LANES]; /* ... of each system of threads */
};

/* The frame of tl_brdf_frame_make, with the sine and cosine of the rotation at hand. */
TL_INLINE struct tl_brdf_frame frame_of(const struct tl_shade_part *part, vec3s n, vec3s t, float handedness,
                                        float side)
{
    const vec3s along = thread_direction(n, t, part->turn_cosine, side * part->turn_sine);
    return (struct tl_brdf_frame){
        n, along, glms_vec3_scale(glms_vec3_cross(n, along), handedness * side < 0 ? -1.0f : 1.0f)};
}

TL_INLINE void find_frames(const struct tl_pixel_lanes *lanes, struct gloss_lanes *gloss)
{
    const struct tl_look_lanes *look = &lanes->look;
    for (int i = 0; i < TL_LANES; i++) {
        struct tl_brdf_frame frame =
            frame_of(look->part, tl_lane_vector(look->shown, i), tl_lane_vector(look->tangent, i),
                     look->tangent[3][i], look->side[i]);
        vec3s viewer = tl_lane_vector(look->viewer, i);
        gloss->viewer[0][i] = glms_vec3_dot(viewer, frame.tangent);
        gloss->viewer[1][i] = glms_vec3_dot(viewer, frame.bitangent);
        gloss->viewer[2][i] = glms_vec3_dot(viewer, frame.normal);
        tl_lane_store(gloss->tangent, i, frame.tangent);
        tl_lane_store(gloss->bitangent, i, frame.bitangent);
        tl_lane_store(gloss->normal, i, frame.normal);
        const FacetWidening wider =
            facet_widening(look->part->turn_cosine, look->part->turn_sine, look->tangent[3][i],
                           look->widening[0][i], look->widening[1][i], look->widening[2][i]);
        for (int k = -1; k < look->part->material->thread_count; k++) {
            const float *own = k < 0 ? look->part->ward_squares : look->part->thread_squares[k];
            float(*square)[TL_LANES] = k < 0 ? gloss->square : gloss->thread_square[k];
            square[0][i] = facet_square(own[0], wider.weft);
            square[1][i] = facet_square(own[1], wider.warp);
            square[2][i] = facet_product(square[0][i], square[1][i], wider.product);
        }
    }
}

/* FacetReflected as quads. */
struct reflected {
    tl_quad plain, away;
};

TL_INLINE vec3s vector_of(tl_quad v)
{
    return (vec3s){{v[0], v[1], v[2]}};
}

/* `thread` < 0: of the surface. */
TL_INLINE struct reflected reflected_of(const struct tl_look_lanes *look, int thread, int lane)
{
    const tl_material *material = look->part->material;
    const vec3s f0 = vector_of(look->f0[lane]);
    const FacetReflected f =
        thread < 0 ? facet_reflected(f0)
                   : thread_reflected(f0, vector_of(look->diffuse[lane]), material->threads[thread].ratio);
    const tl_quad none = {0, 0, 0, 0};
    const bool by_index = thread < 0 && material->gloss.fresnel != TL_FRESNEL_SCHLICK;
    return (struct reflected){tl_pixel_quad(f.plain), by_index ? none : tl_pixel_quad(f.away)};
}

/* The lobes of a set. */
struct lobe_lanes {
    int count;
    float local[TL_LOBE_FIT_MAX][3][TL_LANES]; /* in the frame of the threads, not normalised */
    float log_exponent[TL_LOBE_FIT_MAX][TL_LANES];
    tl_quad weight[TL_LOBE_FIT_MAX][TL_LANES];
};

TL_INLINE void fetch_lobe_set(const struct tl_pixel_lanes *lanes, const struct gloss_lanes *gloss,
                              struct lobe_lanes *lobes)
{
    const struct tl_lobe_set_table *set = lanes->look.part->lobe_set;
    LobeSetPlace places[TL_LANES];
    lobes->count = set->lobe_count;
    for (int i = 0; i < TL_LANES; i++)
        places[i] = tl_lobe_set_place(set, gloss->viewer[0][i], gloss->viewer[1][i], gloss->viewer[2][i],
                                      lanes->look.glossiness[i]);
    for (int i = 0; i < lanes->look.count; i++) {
        const struct tl_lobe_set_shares shares = tl_lobe_set_shares(lanes->look.f0[i]);
        tl_quad nodes[2 * TL_LOBE_FIT_MAX];
        tl_lobe_set_fetch(set, &places[i], nodes);
        for (int k = 0; k < set->lobe_count; k++) {
            const size_t node = 2 * (size_t)k;
            const tl_quad local = nodes[node], weight = nodes[node + 1];
            lobes->local[k][0][i] = places[i].side * local[0];
            lobes->local[k][1][i] = places[i].side * local[1];
            lobes->local[k][2][i] = local[2];
            lobes->weight[k][i] = shares.low * weight[0] + shares.high * weight[1];
            lobes->log_exponent[k][i] = local[3];
        }
    }
}

TL_INLINE tl_quad divide_or_zero(tl_quad a, tl_quad b)
{
    const tl_quad safe = {tl_maxf(b[0], 1e-20f), tl_maxf(b[1], 1e-20f), tl_maxf(b[2], 1e-20f), 1};
    return a / safe;
}

/* `thread` < 0: of the surface. */
TL_INLINE void fit_ward(const struct tl_pixel_lanes *lanes, const struct gloss_lanes *gloss, int thread,
                        struct lobe_lanes *lobes)
{
    static const struct tl_gloss bounded = {.model = TL_REFLECT_WARD, .ward = TL_WARD_BOUNDED};
    const struct tl_look_lanes *look = &lanes->look;
    struct tl_ward_lanes ward;
    const float minimum = 1e-6f; /* of a cosine: the light of pixels below the surface is not used */
    ward.gloss = thread < 0 ? &look->part->material->gloss : &bounded;
    const float(*square)[TL_LANES] = thread < 0 ? gloss->square : gloss->thread_square[thread];
    float cosine[TL_LANES], sine[TL_LANES]; /* into the axes of the widths, and back */
    for (int i = 0; i < TL_LANES; i++) {
        const FacetAxes axes = facet_axes(square[0][i], square[1][i], square[2][i]);
        const float x = gloss->viewer[0][i], y = gloss->viewer[1][i];
        cosine[i] = axes.cosine, sine[i] = axes.sine;
        ward.square[0][i] = axes.square_x, ward.square[1][i] = axes.square_y;
        ward.viewer[0][i] = cosine[i] * x + sine[i] * y;
        ward.viewer[1][i] = cosine[i] * y - sine[i] * x;
        ward.viewer[2][i] = tl_maxf(gloss->viewer[2][i], minimum);
    }
    tl_ward_fit(&ward, look->part->lobe_set_count, look->count);
    lobes->count = ward.count;
    for (int k = 0; k < ward.count; k++)
        for (int i = 0; i < TL_LANES; i++) {
            const float x = ward.local[k][0][i], y = ward.local[k][1][i];
            lobes->local[k][0][i] = cosine[i] * x - sine[i] * y;
            lobes->local[k][1][i] = cosine[i] * y + sine[i] * x;
            lobes->local[k][2][i] = ward.local[k][2][i];
            lobes->log_exponent[k][i] = tl_log2(ward.exponent[k][i]);
        }
    for (int i = 0; i < look->count; i++) {
        const struct reflected f = reflected_of(look, thread, i);
        const tl_quad scale = divide_or_zero(f.plain * ward.albedo[0][i] + f.away * ward.albedo[1][i],
                                             f.plain * ward.sum[0][i] + f.away * ward.sum[1][i]);
        for (int k = 0; k < ward.count; k++)
            lobes->weight[k][i] = scale * (f.plain * ward.plain[k][i] + f.away * ward.away[k][i]);
    }
}

TL_INLINE void place_lobe(const struct tl_pixel_scene *scene, const struct gloss_lanes *gloss,
                          float local[3][TL_LANES], const struct blend_lanes *blends, struct pair_lanes *to)
{
    for (int i = 0; i < TL_LANES; i++) {
        vec3s d = glms_vec3_scale(tl_lane_vector(gloss->tangent, i), local[0][i]);
        d = glms_vec3_add(d, glms_vec3_scale(tl_lane_vector(gloss->bitangent, i), local[1][i]));
        d = glms_vec3_add(d, glms_vec3_scale(tl_lane_vector(gloss->normal, i), local[2][i]));
        place_pair(blends, i, tl_pixel_turned(scene, d), to);
    }
}

/* The exact light of the lobes of a set. */
TL_INLINE void add_lobe_set(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                            const struct gloss_lanes *gloss, struct lobe_lanes *lobes,
                            tl_quad light[TL_LANES])
{
    const int count = lanes->look.count;
    for (int k = 0; k < lobes->count; k++) {
        struct blend_lanes blends;
        struct pair_lanes pair;
        choose_maps(scene, lobes->log_exponent[k], count, &blends);
        place_lobe(scene, gloss, lobes->local[k], &blends, &pair);
        for (int i = 0; i < count; i++)
            if (gloss->viewer[2][i] > 0)
                light[i] += fetch_pair(&blends, i, &pair) * lobes->weight[k][i] * lanes->glossy_ratio[i];
    }
}

TL_INLINE void add_facets(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                          struct gloss_lanes *gloss, tl_quad light[TL_LANES])
{
    assert(lanes->look.count > 0); /* what idle lanes hold is the first one's */
    struct lobe_lanes lobes;
    find_frames(lanes, gloss);
    if (lanes->look.part->lobe_set)
        fetch_lobe_set(lanes, gloss, &lobes);
    else
        fit_ward(lanes, gloss, -1, &lobes);
    add_lobe_set(scene, lanes, gloss, &lobes, light);
    for (int k = 0; k < lanes->look.part->material->thread_count; k++) {
        fit_ward(lanes, gloss, k, &lobes);
        add_lobe_set(scene, lanes, gloss, &lobes, light);
    }
}

/* The exact light of the mirror direction's lobe. */
TL_INLINE void add_lobe(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                        struct gloss_lanes *gloss, tl_quad light[TL_LANES])
{
    const struct tl_look_lanes *look = &lanes->look;
    struct blend_lanes blends;
    struct pair_lanes pair;
    float cosines[TL_LANES], log_exponents[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        vec3s normal = tl_lane_vector(look->shown, i), viewer = tl_lane_vector(look->viewer, i);
        cosines[i] = glms_vec3_dot(normal, viewer);
        tl_lane_store(gloss->mirror, i, mirror_direction(normal, viewer));
        gloss->exponent[i] = lobe_exponent(look->glossiness[i]);
        log_exponents[i] = tl_log2(gloss->exponent[i]);
    }
    choose_maps(scene, log_exponents, look->count, &blends);
    for (int i = 0; i < TL_LANES; i++)
        place_pair(&blends, i, tl_pixel_turned(scene, tl_lane_vector(gloss->mirror, i)), &pair);
    for (int i = 0; i < look->count; i++) {
        gloss->reflectance[i] = tl_pixel_quad(schlick_colour(vector_of(look->f0[i]), cosines[i]));
        light[i] += gloss->reflectance[i] * fetch_pair(&blends, i, &pair) * lanes->glossy_ratio[i];
    }
}

/* ---- Suns and lamps ---- */

static bool is_plain_ward(const struct tl_gloss *model)
{
    return model->model == TL_REFLECT_WARD && model->fresnel == TL_FRESNEL_SCHLICK;
}

/* tl_brdf_gloss_under_disc of Ward's facets. `thread` < 0: of the surface. */
TL_INLINE void add_ward(const struct tl_pixel_lanes *lanes, const struct gloss_lanes *gloss, int thread,
                        const struct tl_sun *sun, const float towards[3][TL_LANES], tl_quad lit[TL_LANES])
{
    const float(*square_of)[TL_LANES] = thread < 0 ? gloss->square : gloss->thread_square[thread];
    const bool is_bounded = thread >= 0 || lanes->look.part->material->gloss.ward == TL_WARD_BOUNDED;
    float lobe[TL_LANES], share[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        vec3s normal = tl_lane_vector(gloss->normal, i), direction = tl_lane_vector(towards, i);
        vec3s sum = glms_vec3_add(direction, tl_lane_vector(lanes->look.viewer, i));
        const float square = glms_vec3_dot(sum, sum);
        lobe[i] = ward_under_disc(is_bounded, glms_vec3_dot(tl_lane_vector(gloss->tangent, i), sum),
                                  glms_vec3_dot(tl_lane_vector(gloss->bitangent, i), sum),
                                  glms_vec3_dot(normal, sum), square, glms_vec3_dot(normal, direction),
                                  gloss->viewer[2][i], square_of[0][i], square_of[1][i], square_of[2][i],
                                  sun->radius);
        share[i] = schlick_share(0.5f * sqrtf(square));
    }
    for (int i = 0; i < lanes->look.count; i++) {
        const struct reflected f = reflected_of(&lanes->look, thread, i);
        lit[i] += lobe[i] * (f.plain + f.away * share[i]);
    }
}

/* Adds other facets than Ward's: one by one, where the sun is seen. */
TL_INLINE void add_brdf(const struct tl_pixel_lanes *lanes, const struct gloss_lanes *gloss,
                        const struct tl_sun *sun, const float towards[3][TL_LANES],
                        const float seen[TL_LANES], tl_quad lit[TL_LANES])
{
    const struct tl_look_lanes *look = &lanes->look;
    for (int i = 0; i < look->count; i++) {
        if (!(seen[i] > 0))
            continue;
        vec3s f0 = {{look->f0[i][0], look->f0[i][1], look->f0[i][2]}};
        const float widening[3] = {look->widening[0][i], look->widening[1][i], look->widening[2][i]};
        struct tl_brdf brdf =
            tl_brdf_bumped(look->part->material, f0, look->glossiness[i], look->tangent[3][i], widening);
        const struct tl_brdf_frame frame = {tl_lane_vector(gloss->normal, i),
                                            tl_lane_vector(gloss->tangent, i),
                                            tl_lane_vector(gloss->bitangent, i)};
        lit[i] += tl_pixel_quad(tl_brdf_gloss_under_disc(&brdf, &frame, tl_lane_vector(towards, i),
                                                         tl_lane_vector(look->viewer, i), sun->radius));
    }
}

TL_INLINE void add_mirrored(const struct tl_pixel_lanes *lanes, const struct gloss_lanes *gloss,
                            const struct tl_sun *sun, const float towards[3][TL_LANES], tl_quad lit[TL_LANES])
{
    float lobe[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        float exponent = lobe_broadened_exponent(gloss->exponent[i], sun->radius * GLM_SQRT1_2f);
        float cosine =
            tl_maxf(glms_vec3_dot(tl_lane_vector(towards, i), tl_lane_vector(gloss->mirror, i)), 1e-30f);
        lobe[i] = 0.159154943f * (exponent + 1) * tl_power(cosine, exponent);
    }
    for (int i = 0; i < lanes->look.count; i++)
        lit[i] += lobe[i] * gloss->reflectance[i];
}

/* Directions to a light, and the shares of its power that arrive where nothing is in the way. */
TL_INLINE void find_light(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes, int light,
                          float towards[3][TL_LANES], float shares[TL_LANES])
{
    const struct tl_pixel_light *source = &scene->request->lights->items[light];
    for (int i = 0; i < TL_LANES; i++) {
        const struct tl_pixel_lit lit = tl_pixel_light_at(source, tl_lane_vector(lanes->point, i));
        tl_lane_store(towards, i, lit.direction);
        shares[i] = lit.share;
    }
}

TL_INLINE void add_light(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes, int number,
                         const struct gloss_lanes *gloss, tl_quad light[TL_LANES])
{
    const struct tl_pixel_light *source = &scene->request->lights->items[number];
    const struct tl_sun *sun = &source->sun;
    const struct tl_look_lanes *look = &lanes->look;
    const struct tl_shade_part *part = look->part;
    float seen[TL_LANES], through[TL_LANES], lobe[TL_LANES], other_lobe[TL_LANES], any = 0;
    float towards[3][TL_LANES], shares[TL_LANES];
    find_light(scene, lanes, number, towards, shares);
    for (int i = 0; i < TL_LANES; i++) {
        const vec3s direction = tl_lane_vector(towards, i);
        float cosine = look->side[i] * glms_vec3_dot(direction, tl_lane_vector(look->smooth, i));
        float shown = glms_vec3_dot(direction, tl_lane_vector(look->shown, i));
        seen[i] = shares[i] * tl_pixel_light_above(source, cosine);
        through[i] = part->transmits ? shares[i] * tl_pixel_light_above(source, -cosine) : 0;
        lobe[i] = tl_pixel_diffuse_lobe(shown);
        other_lobe[i] = tl_pixel_diffuse_lobe(-shown);
    }
    for (int i = 0; !part->is_lambert && i < TL_LANES; i++) {
        const vec3s thread = part->is_faceted ? tl_lane_vector(gloss->tangent, i) : glms_vec3_zero();
        lobe[i] *= matt_under(part->law, tl_lane_vector(look->shown, i), thread, tl_lane_vector(towards, i),
                              tl_lane_vector(look->viewer, i));
    }
    for (int i = 0; i < look->count; i++) {
        float visible = tl_pixel_light_seen(scene, number, lanes->pixel[i]);
        seen[i] *= visible;
        through[i] *= visible;
        any = tl_maxf(any, tl_maxf(seen[i], through[i]));
    }
    if (!(any > 0))
        return;
    tl_quad lit[TL_LANES];
    for (int i = 0; i < look->count; i++)
        lit[i] = look->diffuse[i] * lobe[i];
    if (part->is_faceted && is_plain_ward(&part->material->gloss))
        add_ward(lanes, gloss, -1, sun, towards, lit);
    else if (part->is_faceted)
        add_brdf(lanes, gloss, sun, towards, seen, lit);
    else if (part->is_glossy)
        add_mirrored(lanes, gloss, sun, towards, lit);
    for (int k = 0; k < part->material->thread_count; k++)
        add_ward(lanes, gloss, k, sun, towards, lit);
    for (int i = 0; i < look->count; i++)
        if (seen[i] > 0)
            light[i] += seen[i] * tl_pixel_quad(sun->power) * lit[i];
    if (!part->transmits)
        return;
    const tl_quad coming_through = tl_pixel_quad(sun->power) * tl_pixel_quad(part->material->transmission);
    for (int i = 0; i < look->count; i++)
        light[i] += (through[i] * other_lobe[i]) * coming_through;
}

/* ---- Fuzz ---- */

TL_INLINE void add_fibres_of_light(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                                   int number, const float normal[3][TL_LANES], tl_quad fibres[TL_LANES])
{
    const struct tl_pixel_light *source = &scene->request->lights->items[number];
    const struct tl_look_lanes *look = &lanes->look;
    float towards[3][TL_LANES], shares[TL_LANES];
    find_light(scene, lanes, number, towards, shares);
    for (int i = 0; i < look->count; i++) {
        const vec3s n = tl_lane_vector(normal, i), direction = tl_lane_vector(towards, i);
        const float height = look->side[i] * glms_vec3_dot(direction, tl_lane_vector(look->smooth, i));
        float seen = shares[i] * tl_pixel_light_above(source, height) *
                     tl_pixel_light_seen(scene, number, lanes->pixel[i]);
        if (seen > 0)
            fibres[i] += tl_pixel_quad(source->sun.power) *
                         (seen * fuzz_value(look->part->material->fuzz.roughness, n, direction,
                                            tl_lane_vector(look->viewer, i)));
    }
}

/* Fibres over all that is below them. */
TL_INLINE void add_fuzz(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                        tl_quad light[TL_LANES])
{
    const struct tl_look_lanes *look = &lanes->look;
    const struct tl_fuzz *fuzz = &look->part->material->fuzz;
    const struct tl_lobe_map *maps = scene->request->lobes->maps;
    float normal[3][TL_LANES], weights[FUZZ_POWERS][TL_LANES], under[TL_LANES];
    struct fetch_lanes fetch[FUZZ_POWERS];
    for (int i = 0; i < TL_LANES; i++) {
        const vec3s smooth = glms_vec3_scale(tl_lane_vector(look->smooth, i), look->side[i]);
        const vec3s n = fuzz_axis(fuzz->follow, smooth, tl_lane_vector(look->shown, i));
        const float facing = glms_vec3_dot(n, tl_lane_vector(look->viewer, i));
        float lobes[FUZZ_POWERS];
        fuzz_lobes(fuzz->roughness, facing, lobes);
        const vec3s d = tl_pixel_turned(scene, n);
        const vec2s place = octahedral_place(d);
        tl_lane_store(normal, i, n);
        under[i] = fuzz_under(fuzz->colour, fuzz->roughness, facing);
        for (int k = 0; k < FUZZ_POWERS; k++) {
            weights[k][i] = lobes[k];
            place_fetch(&fetch[k], i, maps[(size_t)TL_FUZZ_INDEX(k)].side, place);
        }
    }
    tl_quad fibres[TL_LANES];
    for (int i = 0; i < look->count; i++) {
        tl_quad sum = {0, 0, 0, 0};
        for (int k = 0; k < FUZZ_POWERS; k++)
            sum += weights[k][i] * fetch_lane(&maps[(size_t)TL_FUZZ_INDEX(k)], &fetch[k], i);
        for (int c = 0; c < 3; c++)
            sum[c] = tl_maxf(sum[c], 0);
        fibres[i] = sum * lanes->fuzz_ratio[i];
    }
    for (int i = 0; i < scene->request->lights->count; i++)
        add_fibres_of_light(scene, lanes, i, normal, fibres);
    for (int i = 0; i < look->count; i++)
        light[i] = light[i] * under[i] + tl_pixel_quad(fuzz->colour) * fibres[i];
}

/* ---- All of it ---- */

TL_INLINE void find_viewers(const struct tl_pixel_scene *scene, struct tl_pixel_lanes *lanes)
{
    const vec3s up = {{0, 1, 0}};
    for (int i = 0; i < TL_LANES; i++) {
        vec3s ray = glms_vec3_add(scene->first, glms_vec3_add(glms_vec3_scale(scene->across, lanes->x[i]),
                                                              glms_vec3_scale(scene->up, lanes->y[i])));
        tl_lane_store(lanes->look.viewer, i, glms_vec3_negate(direction_or(ray, up)));
    }
}

TL_CLONES static void light_lanes(const struct tl_pixel_scene *scene, const struct tl_pixel_lanes *lanes,
                                  tl_quad light[TL_LANES])
{
    const struct tl_shade_part *part = lanes->look.part;
    struct gloss_lanes gloss;
    add_diffuse(scene, lanes, light);
    if (part->transmits)
        add_transmitted(scene, lanes, light);
    if (part->is_faceted)
        add_facets(scene, lanes, &gloss, light);
    else if (part->is_glossy)
        add_lobe(scene, lanes, &gloss, light);
    for (int i = 0; i < scene->request->lights->count; i++)
        add_light(scene, lanes, i, &gloss, light);
    if (part->has_fuzz)
        add_fuzz(scene, lanes, light);
}

TL_CLONES void tl_pixel_lanes_shade(const struct tl_pixel_scene *scene, struct tl_pixel_lanes *lanes)
{
    tl_quad light[TL_LANES];
    find_viewers(scene, lanes);
    tl_look_evaluate(&scene->request->materials->detail, &lanes->look);
    light_lanes(scene, lanes, light);
    for (int i = 0; i < lanes->look.count; i++) {
        tl_quad colour = light[i] * lanes->cover[i];
        colour[3] = lanes->cover[i];
        *lanes->to[i] = colour;
    }
}
