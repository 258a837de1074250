#include "render/light/compose.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"
#include "render/env/from_environment.h"
#include "render/light/seen_lobes_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct tl_material_sample tl_sample_material(const tl_sample *sample, const tl_material *material,
                                             const struct tl_triangle_ranges *ranges, vec3s eye)
{
    struct tl_material_sample made = {.material = material,
                                      .smooth = sample->smooth,
                                      .normal = sample->normal,
                                      .viewer = glms_vec3_normalize(glms_vec3_sub(eye, sample->point)),
                                      .side = sample->triangle & TL_SAMPLE_BACK ? -1.0f : 1.0f,
                                      .diffuse = sample->diffuse,
                                      .f0 = sample->specular,
                                      .glossiness = sample->glossiness,
                                      .widening = sample->widening};
    if (material->gloss.model != TL_REFLECT_PHONG || material->measured) {
        const vec4s tangent = tl_sample_tangent(sample, ranges);
        made.tangent = (vec3s){{tangent.x, tangent.y, tangent.z}};
        made.handedness = tangent.w;
    }
    return made;
}

/* A sample, in the environment's frame, in which all of this is done. */
struct frame {
    vec3s normal, smooth;
    vec3s gloss;    /* direction of the glossy lobe */
    float exponent; /* ... and its exponent */
    struct tl_exponent_blend blend;
};

/* Sums by channel, of the diffuse and of the glossy lobe. */
enum { DIFFUSE, GLOSSY };
struct sums {
    float seen[2][3];
};

/* The lobes of a sample beyond the two. Environment's frame. */
struct lobes {
    struct tl_material_lobes of;
    int count, facets;
    struct tl_fitted_lobe items[TL_MATERIAL_LOBES_MAX];
    bool has_fuzz;
    float fibres[FUZZ_POWERS]; /* weights of the lobes of fuzz */
};

/* Values that a block of samples shares. */
struct block {
    const struct tl_compose_request *request;
    float turn_cosine, turn_sine; /* of the environment's yaw */
    struct tl_region_exponents exponents;
    float blended;          /* the exponent that `blend` stands for */
    const vec3s *reflected; /* light of all but the nearest samples, by index less primary_count */
    struct tl_exponent_blend blend;
};

/* World direction -> direction in the environment, which is turned by its yaw about +Y. */
TL_INLINE vec3s into_environment(const struct block *block, vec3s d)
{
    return turned_direction(block->turn_cosine, block->turn_sine, d);
}

/* ... and back. */
TL_INLINE vec3s out_of_environment(const struct block *block, vec3s d)
{
    return turned_direction(block->turn_cosine, -block->turn_sine, d);
}

TL_INLINE void add_weights(float sums[TL_LANES], const float power[TL_LANES], const float weights[TL_LANES])
{
    for (int lane = 0; lane < TL_LANES; lane++)
        sums[lane] += power[lane] * weights[lane];
}

/* The parts of a sample's sums that can be skipped: whether bumps turn its normal away from the smooth one,
 * and whether its glossy lobe reflects (that of the ground does not, nor one that a multi-lobe fit or a coat
 * replaces). */
struct kind {
    bool bumped, glossy;
};

struct accumulator {
    float seen[2][3][TL_LANES];
};

/* Light below the plane of the smooth normal does not arrive, even where a map turns the shading normal
 * towards it. A diffuse lobe about the smooth normal ends there by itself. */
TL_INLINE void add_group(struct accumulator *sums, const struct tl_region_group *group,
                         const struct frame *frame, struct kind kind, const float exponents[TL_LANES],
                         const float visibility[TL_LANES])
{
    const vec3s smooth = frame->smooth, normal = frame->normal, gloss = frame->gloss;
    float diffuse[TL_LANES], glossy[TL_LANES];
    for (int lane = 0; lane < TL_LANES; lane++) {
        float x = group->x[lane], y = group->y[lane], z = group->z[lane];
        float sine = group->sine[lane], inverse = group->inverse_sine[lane];
        float above = disc_share((x * smooth.x + y * smooth.y + z * smooth.z) * inverse), both = 1;
        float cosine = x * normal.x + y * normal.y + z * normal.z;
        if (kind.bumped)
            both = tl_minf(above / tl_maxf(disc_share(cosine * inverse), 1e-6f), 1);
        diffuse[lane] = region_lobe_diffuse(cosine, sine, inverse) * both * visibility[lane];
        float gloss_cosine = x * gloss.x + y * gloss.y + z * gloss.z;
        glossy[lane] =
            kind.glossy ? region_lobe(gloss_cosine, sine, inverse, exponents[lane]) * above * visibility[lane]
                        : 0;
    }
    for (int c = 0; c < 3; c++) {
        add_weights(sums->seen[DIFFUSE][c], group->power[c], diffuse);
        if (kind.glossy)
            add_weights(sums->seen[GLOSSY][c], group->power[c], glossy);
    }
}

TL_INLINE struct sums sum_groups(struct block *block, size_t index, const struct frame *frame,
                                 struct kind kind)
{
    const struct tl_compose_request *request = block->request;
    const struct tl_region_lights *lights = request->lights;
    struct accumulator lanes = {0};
    if (kind.glossy)
        tl_region_broaden(&block->exponents, lights, frame->exponent);
    for (int g = 0; g < lights->group_count; g++) {
        const struct tl_region_group *group = &lights->groups[g];
        if (glms_vec3_dot(group->axis, frame->smooth) < -group->reach_sine)
            continue; /* all of it has set */
        float visibility[TL_LANES];
        tl_read_visibility(request->values, request->stride, &request->taps[index], g, visibility);
        add_group(&lanes, group, frame, kind, block->exponents.broadened[g], visibility);
    }
    struct sums sums;
    for (int lobe = 0; lobe < 2; lobe++)
        for (int c = 0; c < 3; c++)
            sums.seen[lobe][c] = tl_sum_lanes(lanes.seen[lobe][c]);
    return sums;
}

/* The loops over the regions are compiled once for each kind of sample. */
TL_INLINE struct sums sum_kind(struct block *block, size_t index, const struct frame *frame, struct kind kind)
{
    if (kind.bumped)
        return kind.glossy ? sum_groups(block, index, frame, (struct kind){true, true})
                           : sum_groups(block, index, frame, (struct kind){true, false});
    return kind.glossy ? sum_groups(block, index, frame, (struct kind){false, true})
                       : sum_groups(block, index, frame, (struct kind){false, false});
}

/* The light that a sample receives through its two lobes, unshadowed and shadowed, before the material's
 * colours. */
struct received {
    vec3s unshadowed[2], shadowed[2];
};

/* `lobes`: of a material of more than two, whose diffuse colour holds its albedo. */
static void add_suns(const struct block *block, size_t index, const struct frame *frame,
                     const struct lobes *lobes, struct received *light)
{
    const struct tl_compose_request *request = block->request;
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        const float *visibility = request->sun_visibility[i];
        float above = light_above(false, sun->radius, glms_vec3_dot(sun->direction, frame->smooth));
        /* The mean square angle of a disc is half its radius squared. */
        float exponent = lobe_broadened_exponent(frame->exponent, sun->radius * GLM_SQRT1_2f);
        float values[2] = {lobe_cosine(1, glms_vec3_dot(sun->direction, frame->normal)),
                           lobe_cosine(exponent, glms_vec3_dot(sun->direction, frame->gloss))};
        if (lobes)
            values[DIFFUSE] *= material_matt(lobes->of.over, sun->direction) / lobes->of.over.matt_albedo;
        for (int kind = 0; kind < 2; kind++) {
            vec3s arriving = glms_vec3_scale(sun->power, values[kind]);
            light->unshadowed[kind] = glms_vec3_add(light->unshadowed[kind], arriving);
            light->shadowed[kind] = glms_vec3_add(
                light->shadowed[kind], glms_vec3_scale(arriving, visibility ? above * visibility[index] : 1));
        }
    }
}

/* The two lobes of the material as one: one look-up [Knuth et al. 2014, 3.2], whose direction and colour lie
 * between diffuse and mirror, which is our choice. */
TL_INLINE struct frame frame_of(struct block *block, const tl_sample *sample)
{
    vec3s gloss = sample->mirror;
    if (block->request->params->lobe == TL_LOBE_SINGLE)
        gloss = glms_vec3_normalize(glms_vec3_lerp(sample->normal, sample->mirror, sample->glossiness));
    struct frame frame = {.normal = into_environment(block, sample->normal),
                          .smooth = into_environment(block, sample->smooth),
                          .gloss = into_environment(block, gloss),
                          .exponent = tl_lobe_exponent(sample->glossiness)};
    if (frame.exponent != block->blended) {
        block->blended = frame.exponent;
        block->blend = tl_exponent_blend(frame.exponent);
    }
    frame.blend = block->blend;
    return frame;
}

static vec3s colour_of(const tl_sample *sample, int lobe, const vec3s light[2])
{
    if (lobe == TL_LOBE_SINGLE)
        return glms_vec3_mul(glms_vec3_lerp(sample->diffuse, sample->specular, sample->glossiness),
                             light[GLOSSY]);
    return glms_vec3_add(glms_vec3_mul(sample->diffuse, light[DIFFUSE]),
                         glms_vec3_mul(sample->specular, light[GLOSSY]));
}

static const struct tl_exponent_blend only_diffuse = {.index = 0};

static void receive_unshadowed(const struct block *block, const struct frame *frame, vec3s light[2])
{
    const struct tl_lobes *lobes = block->request->lobes;
    light[DIFFUSE] = tl_lobes_fetch(lobes, frame->normal, only_diffuse);
    light[GLOSSY] = tl_lobes_fetch(lobes, frame->gloss, frame->blend);
}

static void receive_shadowed(const struct block *block, const struct frame *frame, const struct sums *sums,
                             struct kind kind, vec3s light[2])
{
    const struct tl_region_lights *lights = block->request->lights;
    vec3s gains[2] = {{{1, 1, 1}}, {{1, 1, 1}}};
    if (lights->gain.made) {
        gains[DIFFUSE] = tl_lobes_fetch(&lights->diffuse_gain, frame->normal, only_diffuse);
        if (kind.glossy)
            gains[GLOSSY] = tl_lobes_fetch(&lights->gain, frame->gloss, frame->blend);
    }
    for (int lobe = 0; lobe < 2; lobe++)
        for (int c = 0; c < 3; c++)
            light[lobe].raw[c] = gains[lobe].raw[c] * sums->seen[lobe][c];
}

/* One ray decides whether the lobe is open. Its light is the mean over the lobe, because bright texels would
 * show their edges. */
static vec3s perfect_mirror_light(const struct block *block, const struct tl_mirror *mirror, float exponent)
{
    const struct tl_compose_request *request = block->request;
    uint32_t hit = mirror->hits[0];
    if (hit == TL_MIRROR_BLACK)
        return (vec3s){{0, 0, 0}};
    vec3s light = {{0, 0, 0}};
    for (int m = 0; m < TL_MIRROR_RAYS_MAX; m++) {
        vec3s d = tl_mirror_direction(mirror->directions[0], exponent, m, TL_MIRROR_RAYS_MAX);
        vec3s texel = tl_environment_texel(request->environment, into_environment(block, d));
        light = glms_vec3_add(light, glms_vec3_scale(texel, 1.0f / TL_MIRROR_RAYS_MAX));
    }
    if (hit == TL_MIRROR_OPEN)
        return light;
    return glms_vec3_add(glms_vec3_scale(light, 1 - request->samples->items[hit].cover),
                         block->reflected[hit - request->samples->primary_count]);
}

/* The glossy light of a near mirror, but for suns: see mirrors.h. */
static vec3s mirror_light(const struct block *block, const struct tl_mirror *mirror,
                          const struct frame *frame)
{
    const struct tl_compose_request *request = block->request;
    struct tl_exponent_blend blend = tl_exponent_blend(frame->exponent * (float)mirror->ray_count);
    vec3s all = {{0, 0, 0}}, open = all, scene = all;
    for (int m = 0; m < mirror->ray_count; m++) {
        vec3s light = tl_lobes_fetch(request->lobes, into_environment(block, mirror->directions[m]), blend);
        uint32_t hit = mirror->hits[m];
        float cover = hit == TL_MIRROR_OPEN    ? 0
                      : hit == TL_MIRROR_BLACK ? 1
                                               : request->samples->items[hit].cover;
        all = glms_vec3_add(all, light);
        open = glms_vec3_add(open, glms_vec3_scale(light, 1 - cover));
        if (hit < TL_MIRROR_BLACK)
            scene = glms_vec3_add(scene, block->reflected[hit - request->samples->primary_count]);
    }
    vec3s exact = tl_lobes_fetch(request->lobes, frame->gloss, frame->blend);
    vec3s light;
    for (int c = 0; c < 3; c++) {
        float share = all.raw[c] > 0 ? open.raw[c] / all.raw[c] : 0;
        light.raw[c] = exact.raw[c] * share + scene.raw[c] / (float)mirror->ray_count;
    }
    return light;
}

/* Ambient occlusion applies one share to all light. Under white light of radiance 1 that share is the light
 * that arrives. */
static void replace_by_occlusion(const struct sums *sums, int method, struct received *light)
{
    vec3s share;
    for (int c = 0; c < 3; c++) {
        share.raw[c] = sums->seen[DIFFUSE][c];
        if (method == TL_METHOD_AO_COLOUR)
            share.raw[c] = light->unshadowed[DIFFUSE].raw[c] > 0
                               ? light->shadowed[DIFFUSE].raw[c] / light->unshadowed[DIFFUSE].raw[c]
                               : 1;
    }
    for (int kind = 0; kind < 2; kind++)
        light->shadowed[kind] = glms_vec3_mul(light->unshadowed[kind], share);
}

/* The lobes of a sample that has more than two, and what is left of the two. */
static void split_material_lobes(const struct block *block, const tl_material *material, tl_sample *sample,
                                 struct lobes *lobes)
{
    const struct tl_compose_request *request = block->request;
    const tl_sample whole = *sample;
    struct tl_material_sample seen = tl_sample_material(&whole, material, request->ranges, request->eye);
    seen.smooth = into_environment(block, seen.smooth);
    seen.normal = into_environment(block, seen.normal);
    seen.viewer = into_environment(block, seen.viewer);
    seen.tangent = into_environment(block, seen.tangent);
    if (material->gloss.model != TL_REFLECT_PHONG) {
        sample->specular = (vec3s){{0, 0, 0}};
        sample->glossiness = 0;
    }
    lobes->of = tl_material_lobes_of(&seen);
    lobes->count = tl_material_lobes_fit(&lobes->of, request->params->lobes, lobes->items, &lobes->facets);
    lobes->has_fuzz = tl_material_has_fuzz(material);
    if (lobes->has_fuzz)
        fuzz_lobes(material->fuzz.roughness, glms_vec3_dot(lobes->of.over.fuzz_axis, lobes->of.over.viewer),
                   lobes->fibres);
    sample->diffuse = glms_vec3_scale(sample->diffuse, lobes->of.over.base * lobes->of.over.matt_albedo);
    sample->specular = glms_vec3_scale(sample->specular, lobes->of.over.base);
}

/* Suns shine on facets themselves, on a coat as on any lobe, and on fibres. */
static vec3s sun_on_lobes(const struct block *block, size_t index, const struct lobes *lobes, vec3s smooth,
                          bool shadowed)
{
    const struct tl_compose_request *request = block->request;
    vec3s light = {{0, 0, 0}};
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        const float *visibility = request->sun_visibility[i];
        const vec3s facets = tl_material_facets(&lobes->of, sun->direction, sun->radius);
        const vec3s sent = material_over(lobes->of.over, facets, sun->direction, sun->radius);
        float above = light_above(false, sun->radius, glms_vec3_dot(sun->direction, smooth));
        float seen = shadowed && visibility ? above * visibility[index] : 1;
        light = glms_vec3_add(light, glms_vec3_scale(glms_vec3_mul(sun->power, sent), seen));
    }
    return light;
}

/* Seen and whole light of the regions through the fibres. */
TL_INLINE void see_fibres(const struct block *block, size_t index, const struct lobes *lobes, vec3s smooth,
                          vec3s *seen, vec3s *all)
{
    const struct tl_compose_request *request = block->request;
    const struct tl_region_lights *lights = request->lights;
    float seen_lanes[3][TL_LANES] = {0}, all_lanes[3][TL_LANES] = {0};
    const bool is_leaning = lobes->of.over.follow > 0; /* then what lies below the surface is not seen */
    const vec3s n = lobes->of.over.fuzz_axis;
    for (int g = 0; g < lights->group_count; g++) {
        const struct tl_region_group *group = &lights->groups[g];
        if (glms_vec3_dot(group->axis, n) < -group->reach_sine)
            continue;
        float visibility[TL_LANES], open[TL_LANES], visible[TL_LANES];
        tl_read_visibility(request->values, request->stride, &request->taps[index], g, visibility);
        for (int lane = 0; lane < TL_LANES; lane++) {
            float cosine = group->x[lane] * n.x + group->y[lane] * n.y + group->z[lane] * n.z;
            float mean = group->sine[lane] * disc_height(cosine * group->inverse_sine[lane]);
            open[lane] = fuzz_lobes_at(lobes->fibres, mean);
            visible[lane] = open[lane] * visibility[lane];
        }
        for (int lane = 0; is_leaning && lane < TL_LANES; lane++) {
            float cosine = group->x[lane] * smooth.x + group->y[lane] * smooth.y + group->z[lane] * smooth.z;
            visible[lane] *= disc_share(cosine * group->inverse_sine[lane]);
        }
        for (int c = 0; c < 3; c++) {
            add_weights(all_lanes[c], group->power[c], open);
            add_weights(seen_lanes[c], group->power[c], visible);
        }
    }
    for (int c = 0; c < 3; c++) {
        seen->raw[c] = tl_sum_lanes(seen_lanes[c]);
        all->raw[c] = tl_sum_lanes(all_lanes[c]);
    }
}

static vec3s share_of(vec3s part, vec3s all)
{
    vec3s share;
    for (int c = 0; c < 3; c++)
        share.raw[c] = all.raw[c] > 0 ? part.raw[c] / all.raw[c] : 1;
    return share;
}

/* Bounced light through a lobe; normal and direction in the environment's frame. */
TL_INLINE vec3s bounced_through(const struct block *block, const struct tl_bounced *bounced, vec3s normal,
                                vec3s direction, float exponent)
{
    if (!block->request->bounce)
        return (vec3s){{0, 0, 0}};
    const struct tl_bounced_lobe lobe =
        tl_bounced_lobe_of(out_of_environment(block, normal), out_of_environment(block, direction), exponent);
    return tl_bounced_through(bounced, &lobe);
}

/* Adds what other surfaces send through the two lobes. Near mirrors have rays of their own for that. */
TL_INLINE void add_bounced(const struct block *block, const struct tl_bounced *bounced,
                           const struct frame *frame, bool is_mirror, vec3s light[2])
{
    light[DIFFUSE] = glms_vec3_add(light[DIFFUSE], bounced->arrives);
    if (!is_mirror)
        light[GLOSSY] = glms_vec3_add(
            light[GLOSSY], bounced_through(block, bounced, frame->smooth, frame->gloss, frame->exponent));
}

/* Light that other surfaces send to a sample. */
static struct tl_bounced bounced_at(const struct block *block, const tl_sample *sample)
{
    const struct tl_compose_request *request = block->request;
    if (!request->bounce)
        return (struct tl_bounced){0};
    return tl_bounced_at(request->bounce, request->ranges, sample);
}

static vec3s exact_in_lobe(const struct block *block, const struct tl_fitted_lobe *lobe)
{
    return tl_lobes_fetch(block->request->lobes, lobe->direction, tl_exponent_blend(lobe->exponent));
}

/* The light of a sample's lobes; under ambient occlusion with the share that the two lobes get. */
TL_INLINE vec3s light_of_lobes(const struct block *block, size_t index, const struct lobes *lobes,
                               vec3s smooth, const struct received *two, const struct tl_bounced *bounced)
{
    int method = block->request->params->method;
    bool by_occlusion = method == TL_METHOD_AO || method == TL_METHOD_AO_COLOUR;
    bool shadowed = method != TL_METHOD_UNSHADOWED && !by_occlusion;
    vec3s light = sun_on_lobes(block, index, lobes, smooth, shadowed);
    if (shadowed)
        light = glms_vec3_add(light, tl_see_lobes(block->request, index, lobes->items, lobes->count, smooth));
    for (int k = 0; k < lobes->count; k++) {
        const struct tl_fitted_lobe *lobe = &lobes->items[k];
        vec3s arriving = bounced_through(block, bounced, smooth, lobe->direction, lobe->exponent);
        if (!shadowed)
            arriving = glms_vec3_add(arriving, exact_in_lobe(block, lobe));
        light = glms_vec3_muladd(lobe->weight, arriving, light);
    }
    if (by_occlusion)
        light = glms_vec3_mul(light, share_of(two->shadowed[DIFFUSE], two->unshadowed[DIFFUSE]));
    return light;
}

/* The unshadowed light of the environment that fibres send to the viewer. */
static vec3s exact_fibres(const struct block *block, const struct lobes *lobes)
{
    vec3s light = {{0, 0, 0}};
    for (int k = 0; k < FUZZ_POWERS; k++) {
        const struct tl_exponent_blend power = {.index = TL_FUZZ_INDEX(k)};
        vec3s arriving = tl_lobes_fetch(block->request->lobes, lobes->of.over.fuzz_axis, power);
        light = glms_vec3_add(light, glms_vec3_scale(arriving, lobes->fibres[k]));
    }
    return glms_vec3_maxv(light, glms_vec3_zero());
}

/* Bounced light that fibres send to the viewer, as if it were even: their lobes hold their albedo. */
static vec3s fibres_bounced(const struct lobes *lobes, const struct tl_bounced *bounced)
{
    float albedo = 0;
    for (int k = 0; k < FUZZ_POWERS; k++)
        albedo += lobes->fibres[k];
    return glms_vec3_scale(bounced->arrives, albedo);
}

/* The light of fuzz; under ambient occlusion with the share that the diffuse lobe gets. */
TL_INLINE vec3s light_of_fibres(const struct block *block, size_t index, const struct lobes *lobes,
                                vec3s smooth, const struct received *two, const struct tl_bounced *bounced)
{
    const struct tl_compose_request *request = block->request;
    const int method = request->params->method;
    const bool by_occlusion = method == TL_METHOD_AO || method == TL_METHOD_AO_COLOUR;
    const bool shadowed = method != TL_METHOD_UNSHADOWED && !by_occlusion;
    vec3s light = exact_fibres(block, lobes);
    if (shadowed) {
        vec3s seen, all;
        see_fibres(block, index, lobes, smooth, &seen, &all);
        light = glms_vec3_mul(light, share_of(seen, all));
    }
    light = glms_vec3_add(light, fibres_bounced(lobes, bounced));
    if (by_occlusion)
        light = glms_vec3_mul(light, share_of(two->shadowed[DIFFUSE], two->unshadowed[DIFFUSE]));
    return glms_vec3_mul(light, lobes->of.over.fuzz);
}

/* The material of a sample that has more than two lobes, or NULL. Mirrors show the two, and so do the other
 * sides of the layers. */
static const tl_material *rich_material(const struct tl_compose_request *request, size_t index)
{
    const struct tl_samples *samples = request->samples;
    if (!request->any_layered || index >= samples->primary_count + samples->behind_count)
        return NULL;
    const tl_material *material =
        tl_triangle_material(request->ranges, samples->items[index].triangle & ~TL_SAMPLE_BACK);
    const bool is_rich = material->coat > 0 || !tl_material_is_lambert(material) ||
                         material->gloss.model != TL_REFLECT_PHONG || tl_material_has_fuzz(material);
    return is_rich ? material : NULL;
}

/* A sample of two lobes, whose threads shine as if they were matt. */
static tl_sample with_matt_threads(const struct tl_compose_request *request, const tl_sample *sample)
{
    const tl_material *material = tl_triangle_material(request->ranges, sample->triangle & ~TL_SAMPLE_BACK);
    tl_sample matt = *sample;
    matt.diffuse =
        glms_vec3_minv(glms_vec3_mul(sample->diffuse, tl_material_thread_gain(material)), glms_vec3_one());
    return matt;
}

static float share_of_sample(const struct tl_compose_request *request, size_t index)
{
    if (request->shares && index < tl_samples_seen(request->samples))
        return request->shares[index];
    return request->samples->items[index].cover;
}

/* Whether anything of a sample's glossy lobe arrives in its colour. */
static bool is_glossy(const struct tl_compose_request *request, const tl_sample *sample)
{
    return request->params->lobe == TL_LOBE_SINGLE || sample->specular.x > 0 || sample->specular.y > 0 ||
           sample->specular.z > 0;
}

/* Light of a sample, premultiplied by cover. */
TL_INLINE vec3s compose_sample(struct block *block, size_t index)
{
    const struct tl_compose_request *request = block->request;
    const tl_sample *sample = &request->samples->items[index];
    const tl_material *rich = rich_material(request, index);
    int method = request->params->method;
    tl_sample rest;
    struct lobes lobes = {0};
    if (rich) {
        rest = *sample;
        split_material_lobes(block, rich, &rest, &lobes);
        sample = &rest;
    } else if (request->any_layered) {
        rest = with_matt_threads(request, sample);
        sample = &rest;
    }
    struct frame frame = frame_of(block, sample);
    struct received received = {0};
    struct sums sums = {0};
    bool by_occlusion = method == TL_METHOD_AO || method == TL_METHOD_AO_COLOUR;
    if (method == TL_METHOD_UNSHADOWED || by_occlusion)
        receive_unshadowed(block, &frame, received.unshadowed);
    if (method != TL_METHOD_UNSHADOWED) {
        struct kind kind = {.bumped = glms_vec3_dot(sample->normal, sample->smooth) < 0.99999f,
                            .glossy = is_glossy(request, sample)};
        sums = sum_kind(block, index, &frame, kind);
        receive_shadowed(block, &frame, &sums, kind, received.shadowed);
    }
    const struct tl_mirror *mirror = request->mirrors ? &request->mirrors[index] : NULL;
    if (mirror && mirror->ray_count > 0)
        received.shadowed[GLOSSY] = mirror_light(block, mirror, &frame);
    add_suns(block, index, &frame, rich ? &lobes : NULL, &received);
    if (mirror && mirror->ray_count > 0 && frame.exponent >= TL_PERFECT_EXPONENT)
        received.shadowed[GLOSSY] = perfect_mirror_light(block, mirror, frame.exponent);
    if (by_occlusion)
        replace_by_occlusion(&sums, method, &received);
    const struct tl_bounced bounced = bounced_at(block, sample);
    add_bounced(block, &bounced, &frame, mirror && mirror->ray_count > 0, received.shadowed);
    const vec3s *arriving = method == TL_METHOD_UNSHADOWED ? received.unshadowed : received.shadowed;
    vec3s colour = colour_of(sample, request->params->lobe, arriving);
    if (rich)
        colour =
            glms_vec3_add(colour, light_of_lobes(block, index, &lobes, frame.smooth, &received, &bounced));
    if (lobes.has_fuzz)
        colour =
            glms_vec3_add(colour, light_of_fibres(block, index, &lobes, frame.smooth, &received, &bounced));
    return glms_vec3_scale(colour, share_of_sample(request, index));
}

#define BLOCK 256 /* samples that a thread takes at a time */

/* Samples first .. last - 1: the nearest ones into `light`, all others into `further`, by index less their
 * number. */
TL_CLONES static void compose_block(const struct tl_compose_request *request, size_t first, size_t last,
                                    float *light, vec3s *further)
{
    struct block block = {.request = request,
                          .turn_cosine = cosf(request->environment_yaw),
                          .turn_sine = sinf(request->environment_yaw),
                          .reflected = further};
    size_t primary_count = request->samples->primary_count;
    for (size_t i = first; i < last; i++) {
        vec3s colour = compose_sample(&block, i);
        if (i < primary_count)
            memcpy(light + 4 * (size_t)request->samples->items[i].texel, colour.raw, sizeof colour);
        else
            further[i - primary_count] = colour;
    }
}

/* Adds up what is seen through cloth, layer by layer, and leaves what none of them keeps to the background.
 */
static void blend_behind(const struct tl_compose_request *request, const vec3s *behind, float *light)
{
    const float rounding = 1e-6f;
    const struct tl_samples *samples = request->samples;
    size_t seen = tl_samples_seen(samples), fronts = samples->primary_count + samples->behind_count;
    for (size_t i = 0; i < seen; i++) {
        float *texel = light + 4 * (size_t)samples->items[i].texel;
        if (i < samples->primary_count)
            texel[3] = samples->items[i].cover - request->shares[i];
        else if (i < fronts)
            texel[3] -= request->shares[i];
        for (int c = 0; i >= samples->primary_count && c < 3; c++)
            texel[c] += behind[i - samples->primary_count].raw[c];
    }
    for (size_t i = 0; i < samples->primary_count; i++) {
        float *through = light + 4 * (size_t)samples->items[i].texel + 3;
        *through = *through > rounding ? *through : 0;
    }
}

/* Seen and whole light of the lobes that stand for a gloss of facets: the ratio of the two. */
TL_INLINE vec3s ratio_of_lobes(const struct block *block, size_t index, const struct lobes *lobes,
                               vec3s smooth, const struct tl_bounced *bounced)
{
    vec3s seen = tl_see_lobes(block->request, index, lobes->items, lobes->count, smooth), all = {{0, 0, 0}};
    for (int k = 0; k < lobes->count; k++) {
        const struct tl_fitted_lobe *lobe = &lobes->items[k];
        vec3s sent = bounced_through(block, bounced, smooth, lobe->direction, lobe->exponent);
        seen = glms_vec3_muladd(lobe->weight, sent, seen);
        all = glms_vec3_muladd(lobe->weight, exact_in_lobe(block, lobe), all);
    }
    return share_of(seen, all);
}

TL_INLINE struct tl_light_ratio ratio_of_sample(struct block *block, size_t index)
{
    const struct tl_compose_request *request = block->request;
    tl_sample sample = request->samples->items[index];
    const tl_material *rich = rich_material(request, index);
    struct lobes lobes = {0};
    if (rich)
        split_material_lobes(block, rich, &sample, &lobes);
    struct frame frame = frame_of(block, &sample);
    struct kind kind = {.bumped = false, .glossy = is_glossy(request, &sample)};
    struct sums sums = sum_kind(block, index, &frame, kind);
    vec3s seen[2], all[2];
    receive_shadowed(block, &frame, &sums, kind, seen);
    receive_unshadowed(block, &frame, all);
    const struct tl_bounced bounced = bounced_at(block, &sample);
    add_bounced(block, &bounced, &frame, false, seen);
    struct tl_light_ratio ratio = {.diffuse = share_of(seen[DIFFUSE], all[DIFFUSE])};
    ratio.glossy = rich && lobes.facets > 0 ? ratio_of_lobes(block, index, &lobes, frame.smooth, &bounced)
                   : kind.glossy            ? share_of(seen[GLOSSY], all[GLOSSY])
                                            : ratio.diffuse;
    ratio.fuzz = ratio.diffuse;
    if (lobes.has_fuzz) {
        vec3s open, visible;
        see_fibres(block, index, &lobes, frame.smooth, &visible, &open);
        ratio.fuzz = share_of(glms_vec3_add(visible, fibres_bounced(&lobes, &bounced)), open);
    }
    return ratio;
}

TL_CLONES static void ratio_block(const struct tl_compose_request *request, size_t first, size_t last,
                                  struct tl_light_ratio *ratios)
{
    struct block block = {.request = request,
                          .turn_cosine = cosf(request->environment_yaw),
                          .turn_sine = sinf(request->environment_yaw)};
    for (size_t i = first; i < last; i++)
        ratios[i] = ratio_of_sample(&block, i);
}

void tl_compose_ratios(const struct tl_compose_request *request, struct tl_light_ratio *ratios)
{
    const size_t few = 64, count = request->samples->count;
#pragma omp parallel for schedule(dynamic)
    for (size_t first = 0; first < count; first += few)
        ratio_block(request, first, count - first < few ? count : first + few, ratios);
}

static void compose_range(const struct tl_compose_request *request, size_t begin, size_t end, float *light,
                          vec3s *further)
{
#pragma omp parallel for schedule(dynamic)
    for (size_t first = begin; first < end; first += BLOCK)
        compose_block(request, first, end - first < BLOCK ? end : first + BLOCK, light, further);
}

void tl_compose(const struct tl_compose_request *request, float *light)
{
    size_t primary_count = request->samples->primary_count, count = request->samples->count;
    size_t seen = tl_samples_seen(request->samples);
    vec3s *further = TL_NEW_ARRAY(vec3s, count - primary_count);
    compose_range(request, seen, count, light, further);
    compose_range(request, 0, seen, light, further);
    if (request->shares)
        blend_behind(request, further, light);
    free(further);
}
