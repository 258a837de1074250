#include "render/light/compose.h"

#include "config/memory.h"
#include "render/pem/lobe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sample, in the environment's frame, in which all of this is done. */
struct frame {
    vec3s normal, smooth;
    vec3s gloss;    /* direction of the glossy lobe */
    float exponent; /* ... and its exponent */
    struct tl_exponent_blend blend;
};

/* By channel, of the diffuse and of the glossy lobe. */
enum { DIFFUSE, GLOSSY };
struct sums {
    float seen[2][3];
};

/* What a block of samples shares. */
struct block {
    const struct tl_compose_request *request;
    float turn_cosine, turn_sine; /* of the environment's yaw */
    struct tl_region_exponents exponents;
    float blended;          /* the exponent that `blend` stands for */
    const vec3s *reflected; /* light of the samples that mirrors show, by index less primary_count */
    struct tl_exponent_blend blend;
};

/* World direction -> direction in the environment, which is turned by its yaw about +Y. */
TL_INLINE vec3s into_environment(const struct block *block, vec3s d)
{
    float c = block->turn_cosine, s = block->turn_sine;
    return (vec3s){{c * d.x - s * d.z, d.y, s * d.x + c * d.z}};
}

/* Visibility of group g at a sample. */
TL_INLINE void read_visibility(const uint16_t *values, size_t stride, const struct tl_taps *taps, int g,
                               float visibility[TL_LANES])
{
    const uint16_t *rows[TL_TAPS];
    float weights[TL_TAPS];
    for (int t = 0; t < TL_TAPS; t++) {
        rows[t] = values + taps->point[t] * stride + (size_t)g * TL_LANES;
        weights[t] = taps->weight[t] * (1 / TL_VISIBILITY_ONE);
    }
    for (int lane = 0; lane < TL_LANES; lane++)
        visibility[lane] = weights[0] * (float)rows[0][lane] + weights[1] * (float)rows[1][lane] +
                           weights[2] * (float)rows[2][lane] + weights[3] * (float)rows[3][lane];
}

TL_INLINE void add_weights(float sums[TL_LANES], const float power[TL_LANES], const float weights[TL_LANES])
{
    for (int lane = 0; lane < TL_LANES; lane++)
        sums[lane] += power[lane] * weights[lane];
}

struct accumulator {
    float seen[2][3][TL_LANES];
};

/* Light below the plane of the smooth normal does not arrive, even where a map turns the shading normal
 * towards it. A diffuse lobe about the smooth normal ends there by itself. */
TL_INLINE void add_group(struct accumulator *sums, const struct tl_region_group *group,
                         const struct frame *frame, bool bumped, const float exponents[TL_LANES],
                         const float visibility[TL_LANES])
{
    const vec3s smooth = frame->smooth, normal = frame->normal, gloss = frame->gloss;
    float diffuse[TL_LANES], glossy[TL_LANES];
    for (int lane = 0; lane < TL_LANES; lane++) {
        float x = group->x[lane], y = group->y[lane], z = group->z[lane];
        float sine = group->sine[lane], inverse = group->inverse_sine[lane];
        float above = disc_share((x * smooth.x + y * smooth.y + z * smooth.z) * inverse), both = 1;
        float cosine = x * normal.x + y * normal.y + z * normal.z;
        if (bumped)
            both = tl_lesser(above / tl_greater(disc_share(cosine * inverse), 1e-6f), 1);
        diffuse[lane] = tl_region_lobe_diffuse(cosine, sine, inverse) * both * visibility[lane];
        float gloss_cosine = x * gloss.x + y * gloss.y + z * gloss.z;
        glossy[lane] =
            tl_region_lobe(gloss_cosine, sine, inverse, exponents[lane]) * above * visibility[lane];
    }
    for (int c = 0; c < 3; c++) {
        add_weights(sums->seen[DIFFUSE][c], group->power[c], diffuse);
        add_weights(sums->seen[GLOSSY][c], group->power[c], glossy);
    }
}

TL_INLINE struct sums sum_groups(struct block *block, size_t index, const struct frame *frame, bool bumped)
{
    const struct tl_compose_request *request = block->request;
    const struct tl_region_lights *lights = request->lights;
    struct accumulator lanes = {0};
    tl_region_broaden(&block->exponents, lights, frame->exponent);
    for (int g = 0; g < lights->group_count; g++) {
        const struct tl_region_group *group = &lights->groups[g];
        if (glms_vec3_dot(group->axis, frame->smooth) < -group->reach_sine)
            continue; /* all of it has set */
        float visibility[TL_LANES];
        read_visibility(request->values, request->stride, &request->taps[index], g, visibility);
        add_group(&lanes, group, frame, bumped, block->exponents.broadened[g], visibility);
    }
    struct sums sums;
    for (int kind = 0; kind < 2; kind++)
        for (int c = 0; c < 3; c++)
            sums.seen[kind][c] = tl_sum_lanes(lanes.seen[kind][c]);
    return sums;
}

/* What a sample receives through its two lobes, unshadowed and shadowed, before the material's colours. */
struct received {
    vec3s unshadowed[2], shadowed[2];
};

static void add_suns(const struct block *block, size_t index, const struct frame *frame,
                     struct received *light)
{
    const struct tl_compose_request *request = block->request;
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        const float *visibility = request->sun_visibility[i];
        float above = disc_share(glms_vec3_dot(sun->direction, frame->smooth) / fmaxf(sun->radius, 1e-3f));
        /* The mean square angle of a disc is half its radius squared. */
        float exponent = lobe_broadened_exponent(frame->exponent, sun->radius * GLM_SQRT1_2f);
        float lobes[2] = {lobe_cosine(1, glms_vec3_dot(sun->direction, frame->normal)),
                          lobe_cosine(exponent, glms_vec3_dot(sun->direction, frame->gloss))};
        for (int kind = 0; kind < 2; kind++) {
            vec3s arriving = glms_vec3_scale(sun->power, lobes[kind]);
            light->unshadowed[kind] = glms_vec3_add(light->unshadowed[kind], arriving);
            light->shadowed[kind] = glms_vec3_add(
                light->shadowed[kind], glms_vec3_scale(arriving, visibility ? above * visibility[index] : 1));
        }
    }
}

/* The two lobes of the material as one [002, section 3.4], its direction and colour between diffuse and
 * mirror. */
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
                             vec3s light[2])
{
    const struct tl_region_lights *lights = block->request->lights;
    vec3s gains[2] = {{{1, 1, 1}}, {{1, 1, 1}}};
    if (lights->gain.made) {
        gains[DIFFUSE] = tl_lobes_fetch(&lights->diffuse_gain, frame->normal, only_diffuse);
        gains[GLOSSY] = tl_lobes_fetch(&lights->gain, frame->gloss, frame->blend);
    }
    for (int kind = 0; kind < 2; kind++)
        for (int c = 0; c < 3; c++)
            light[kind].raw[c] = gains[kind].raw[c] * sums->seen[kind][c];
}

/* One ray tells whether the lobe is open; what it shows is the mean over the lobe, for bright texels have
 * edges. */
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

/* Ambient occlusion knows one share for all light. Under white light of 1 the share is what arrives. */
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

/* Light of a sample, premultiplied by cover. */
TL_INLINE vec3s compose_sample(struct block *block, size_t index)
{
    const struct tl_compose_request *request = block->request;
    const tl_sample *sample = &request->samples->items[index];
    int method = request->params->method;
    struct frame frame = frame_of(block, sample);
    struct received received = {0};
    struct sums sums = {0};
    bool by_occlusion = method == TL_METHOD_AO || method == TL_METHOD_AO_COLOUR;
    if (method == TL_METHOD_UNSHADOWED || by_occlusion)
        receive_unshadowed(block, &frame, received.unshadowed);
    if (method != TL_METHOD_UNSHADOWED) {
        bool bumped = glms_vec3_dot(sample->normal, sample->smooth) < 0.99999f;
        sums = bumped ? sum_groups(block, index, &frame, true) : sum_groups(block, index, &frame, false);
        receive_shadowed(block, &frame, &sums, received.shadowed);
    }
    const struct tl_mirror *mirror = request->mirrors ? &request->mirrors[index] : NULL;
    if (mirror && mirror->ray_count > 0)
        received.shadowed[GLOSSY] = mirror_light(block, mirror, &frame);
    add_suns(block, index, &frame, &received);
    if (mirror && mirror->ray_count > 0 && frame.exponent >= TL_PERFECT_EXPONENT)
        received.shadowed[GLOSSY] = perfect_mirror_light(block, mirror, frame.exponent);
    if (by_occlusion)
        replace_by_occlusion(&sums, method, &received);
    const vec3s *arriving = method == TL_METHOD_UNSHADOWED ? received.unshadowed : received.shadowed;
    return glms_vec3_scale(colour_of(sample, request->params->lobe, arriving), sample->cover);
}

#define BLOCK 256 /* samples that a thread takes at a time */

/* Samples first .. last - 1 of the camera into `light`, or of what mirrors show into `reflected`. */
TL_CLONES static void compose_block(const struct tl_compose_request *request, size_t first, size_t last,
                                    float *light, vec3s *reflected)
{
    struct block block = {.request = request,
                          .turn_cosine = cosf(request->environment_yaw),
                          .turn_sine = sinf(request->environment_yaw),
                          .reflected = reflected};
    size_t primary_count = request->samples->primary_count;
    for (size_t i = first; i < last; i++) {
        vec3s colour = compose_sample(&block, i);
        if (i < primary_count)
            memcpy(light + 4 * (size_t)request->samples->items[i].texel, colour.raw, sizeof colour);
        else
            reflected[i - primary_count] = colour;
    }
}

static void compose_range(const struct tl_compose_request *request, size_t begin, size_t end, float *light,
                          vec3s *reflected)
{
#pragma omp parallel for schedule(dynamic)
    for (size_t first = begin; first < end; first += BLOCK)
        compose_block(request, first, end - first < BLOCK ? end : first + BLOCK, light, reflected);
}

void tl_compose(const struct tl_compose_request *request, float *light)
{
    size_t primary_count = request->samples->primary_count, count = request->samples->count;
    vec3s *reflected = TL_NEW_ARRAY(vec3s, count - primary_count);
    compose_range(request, primary_count, count, light, reflected);
    compose_range(request, 0, primary_count, light, reflected);
    free(reflected);
}
