#include "config/hash.h"
#include "config/memory.h"
#include "render/brdf/lobe_fit.h"
#include "render/detail/detail.h"
#include "render/env/exponent.h"
#include "render/frame/frame.h"
#include "render/inspect/job.h"
#include "render/plan/affects.h"

#include <math.h>

#define MIX(hash, field) tl_hash(hash, &(field), sizeof(field))

static uint64_t shapes_signature(const tl_frame *frame)
{
    uint64_t hash = MIX(TL_HASH_START, frame->surface_count);
    for (size_t i = 0; i < frame->surface_count; i++) {
        const tl_surface *surface = &frame->surfaces[i];
        hash = MIX(MIX(MIX(hash, surface->topology_revision), surface->vertex_count), surface->index_count);
    }
    return hash;
}

static uint64_t motion_signature(const tl_frame *frame)
{
    uint64_t hash = TL_HASH_START;
    for (size_t i = 0; i < frame->surface_count; i++)
        hash = MIX(hash, frame->surfaces[i].motion_revision);
    return hash;
}

static uint64_t camera_signature(const struct tl_camera *camera)
{
    uint64_t hash = MIX(MIX(MIX(TL_HASH_START, camera->eye), camera->target), camera->up);
    return MIX(MIX(MIX(hash, camera->fov_y), camera->near_m), camera->far_m);
}

/* What options decide, by bits of their rows. Inputs that are not here follow from the frame alone. */
static const uint64_t bits_of[TL_INPUT_COUNT] = {
    [TL_INPUT_SIZE] = TL_AFFECTS_SIZE,         [TL_INPUT_GROUND] = TL_AFFECTS_GROUND,
    [TL_INPUT_PEM_SIZE] = TL_AFFECTS_PEM_SIZE, [TL_INPUT_FILTER] = TL_AFFECTS_FILTER,
    [TL_INPUT_SUN] = TL_AFFECTS_SUN,           [TL_INPUT_REGIONS] = TL_AFFECTS_REGIONS,
    [TL_INPUT_PASSES] = TL_AFFECTS_PASSES,     [TL_INPUT_MAPS] = TL_AFFECTS_SHADOW_MAPS,
    [TL_INPUT_RAYS] = TL_AFFECTS_RAYS,         [TL_INPUT_LIGHT] = TL_AFFECTS_LIGHT,
    [TL_INPUT_LAMPS] = TL_AFFECTS_LAMPS,       [TL_INPUT_REFERENCE] = TL_AFFECTS_REFERENCE,
    [TL_INPUT_DETAIL] = TL_AFFECTS_DETAIL,     [TL_INPUT_DETAIL_MAPS] = TL_AFFECTS_DETAIL_MAPS,
    [TL_INPUT_SHOW] = TL_AFFECTS_SHOW,         [TL_INPUT_ENVMAP] = TL_AFFECTS_ENVMAP,
    [TL_INPUT_LAYOUT] = TL_AFFECTS_LAYOUT,     [TL_INPUT_LOOK_UP] = TL_AFFECTS_LOOK_UP,
    [TL_INPUT_CAPTURE] = TL_AFFECTS_CAPTURE,   [TL_INPUT_VIEW] = TL_AFFECTS_VIEW,
};

/* Each input's signature as far as options decide it. */
static void sign_options(const struct tl_render_settings *settings, uint64_t signatures[TL_INPUT_COUNT])
{
    struct tl_render_settings copy = *settings; /* bindings can be written through */
    struct tl_binding bindings[TL_RENDER_TABLES];
    tl_render_settings_bind(&copy, bindings);
    for (int i = 0; i < TL_INPUT_COUNT; i++)
        signatures[i] = tl_options_hash(bindings, TL_RENDER_TABLES,
                                        (struct tl_option_filter){.any_of = bits_of[i]}, TL_HASH_START);
    const struct tl_option_filter scale = {.any_of = TL_AFFECTS_VIEW_SCALE};
    if (settings->image.view != TL_VIEW_LIGHT)
        signatures[TL_INPUT_VIEW] =
            tl_options_hash(bindings, TL_RENDER_TABLES, scale, signatures[TL_INPUT_VIEW]);
}

/* Without lamps it does not depend on `shading`, the signature of how surfaces are shaded under them. */
static uint64_t lamps_signature(const tl_frame *frame, uint64_t shading)
{
    struct tl_lamp lamps[TL_LAMPS_MAX];
    size_t count = tl_lamps_lit(frame, lamps);
    uint64_t hash = TL_HASH_START;
    for (size_t i = 0; i < count; i++) {
        hash = MIX(MIX(hash, lamps[i].kind), lamps[i].irradiance);
        hash = MIX(MIX(hash, lamps[i].direction), lamps[i].position);
    }
    return count > 0 ? MIX(hash, shading) : hash;
}

/* A sphere map depends on where the viewer looks, the other layouts do not. */
static uint64_t layout_signature(const tl_frame *frame, const struct tl_maps_params *maps, uint64_t options)
{
    if (maps->layout != TL_LAYOUT_SPHERE)
        return options;
    struct tl_view view = tl_view_make(&frame->camera, 1, 1);
    return MIX(MIX(options, view.forward), view.up);
}

/* What a capture shows. */
static uint64_t scene_signature(const uint64_t signatures[TL_INPUT_COUNT])
{
    static const enum tl_resource shown[] = {TL_INPUT_ENVIRONMENT, TL_INPUT_YAW, TL_INPUT_SHAPES,
                                             TL_INPUT_MOTION, TL_INPUT_GROUND};
    uint64_t hash = signatures[TL_INPUT_CAPTURE];
    for (size_t i = 0; i < TL_COUNT(shown); i++)
        hash = MIX(hash, signatures[shown[i]]);
    return hash;
}

/* A still image never shows an old scene. */
static void count_capture(const tl_frame *frame, const struct tl_render_settings *settings,
                          const uint64_t signatures[TL_INPUT_COUNT], struct tl_rest *rest)
{
    const struct tl_maps_params *maps = &settings->maps;
    bool is_wanted = settings->light.method == TL_METHOD_MAPS && maps->capture_every > 0;
    uint64_t scene = is_wanted ? scene_signature(signatures) : 0;
    rest->capture_age = rest->capture_age < maps->capture_every ? rest->capture_age + 1 : maps->capture_every;
    bool is_time = frame->still || rest->captured == 0 || rest->capture_age >= maps->capture_every;
    if (scene != rest->captured && (is_time || !is_wanted)) {
        rest->captured = scene;
        rest->capture_age = 0;
    }
    rest->is_captured = scene == rest->captured;
}

static void count_rest(const struct tl_light_params *light, const uint64_t before[TL_INPUT_COUNT],
                       const uint64_t signatures[TL_INPUT_COUNT], struct tl_rest *rest)
{
    bool image_rests = true, scene_rests = true;
    for (int i = 0; i < TL_INPUT_COUNT; i++) {
        bool is_outcome = i == TL_INPUT_ROUND || i == TL_INPUT_SCENE_ROUND;
        if (is_outcome || i == TL_INPUT_SHOW || signatures[i] == before[i])
            continue;
        image_rests = false;
        scene_rests = scene_rests && (i == TL_INPUT_CAMERA || i == TL_INPUT_SIZE || i == TL_INPUT_LAMPS);
    }
    int last = tl_light_averages(light) ? light->rounds - 1 : 0;
    rest->image = !image_rests ? 0 : rest->image < last ? rest->image + 1 : last;
    rest->is_done = rest->is_done && image_rests;
    bool is_done = light->visibility == TL_VISIBILITY_RAYS ? rest->is_done : rest->scene >= last;
    if (!scene_rests)
        rest->scene = 0;
    else if (tl_light_averages(light) && !is_done)
        rest->scene++;
}

void tl_frame_sign(const tl_frame *frame, const struct tl_render_settings *settings,
                   const uint64_t before[TL_INPUT_COUNT], struct tl_rest *rest,
                   uint64_t signatures[TL_INPUT_COUNT])
{
    const struct tl_light_params *light = &settings->light;
    const uint64_t start = TL_HASH_START;
    sign_options(settings, signatures);
    signatures[TL_INPUT_ENVIRONMENT] = MIX(start, frame->environment_revision);
    signatures[TL_INPUT_YAW] = MIX(start, frame->environment_yaw);
    signatures[TL_INPUT_SHAPES] = shapes_signature(frame);
    signatures[TL_INPUT_MOTION] = motion_signature(frame);
    signatures[TL_INPUT_CAMERA] = camera_signature(&frame->camera);
    bool in_passes =
        tl_light_source(light) == TL_LIGHT_CHAIN; /* so many maps to an array as PEMs to a pass */
    signatures[TL_INPUT_MAPS] = MIX(signatures[TL_INPUT_MAPS], in_passes);
    signatures[TL_INPUT_LAMPS] = lamps_signature(frame, signatures[TL_INPUT_LAMPS]);
    bool captures = settings->maps.capture_every > 0;
    signatures[TL_INPUT_ENVMAP] = MIX(signatures[TL_INPUT_ENVMAP], captures);
    signatures[TL_INPUT_LAYOUT] = layout_signature(frame, &settings->maps, signatures[TL_INPUT_LAYOUT]);
    count_capture(frame, settings, signatures, rest);
    signatures[TL_INPUT_CAPTURE] = MIX(start, rest->captured);
    count_rest(light, before, signatures, rest);
    signatures[TL_INPUT_ROUND] = MIX(start, rest->image);
    signatures[TL_INPUT_SCENE_ROUND] = MIX(start, rest->scene);
}

/* The least and the largest glossiness that a material's maps can make of it. */
static void glossiness_range(const tl_material *material, float *low, float *high)
{
    float least = material->gloss_map.image ? 0 : material->glossiness, most = material->glossiness;
    if (material->weave) {
        const tl_image *gloss = &material->weave->gloss;
        float added_low = INFINITY, added_high = -INFINITY;
        for (size_t i = 0; i < (size_t)gloss->width * (size_t)gloss->height; i++) {
            added_low = fminf(added_low, tl_image_floats(gloss)[i]);
            added_high = fmaxf(added_high, tl_image_floats(gloss)[i]);
        }
        least += added_low;
        most += added_high;
    }
    *low = fminf(fmaxf(least, 0), 1);
    *high = fminf(fmaxf(most, 0), 1);
}

/* The G-buffer rounds 1 - glossiness to a half. */
#define ROUNDING 1e-3f

/* Exponents from `least` to `greatest`. */
static uint32_t exponents_between(float least, float greatest)
{
    return tl_exponents_needed(1 - 1 / fmaxf(least * (1 - ROUNDING), 1),
                               1 - 1 / fmaxf(greatest * (1 + ROUNDING), 1));
}

/* Of what a material is beyond two lobes. */
static uint32_t layered_exponents(const tl_material *material, float low, float high)
{
    uint32_t needed = 0;
    if (material->coat > 0)
        needed |= tl_exponents_needed(material->coat_glossiness, material->coat_glossiness);
    if (!tl_material_is_faceted(material))
        return needed;
    float least, greatest, unused;
    struct tl_brdf dull = tl_brdf_of(material, material->specular, low);
    struct tl_brdf shiny = tl_brdf_of(material, material->specular, high);
    tl_lobe_fit_exponents(&dull, &least, &unused);
    tl_lobe_fit_exponents(&shiny, &unused, &greatest);
    return needed | exponents_between(least, greatest);
}

uint32_t tl_frame_exponents(const tl_frame *frame, const struct tl_detail_params *detail)
{
    uint32_t needed = 1;
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t p = 0; p < frame->surfaces[s].part_count; p++) {
            const tl_material *material = &frame->surfaces[s].materials[frame->surfaces[s].parts[p].material];
            float low, high;
            glossiness_range(material, &low, &high);
            if (tl_detail_wants_moments(detail) && tl_detail_wants_maps(detail, material))
                low = 0; /* averaged bumps dull any gloss */
            low = 1 - (1 - low) * (1 + ROUNDING);
            needed |= tl_exponents_needed(low, 1 - (1 - high) * (1 - ROUNDING));
            if (tl_mirror_ray_count(tl_lobe_exponent(high)) >
                0) /* lobes along a mirror's rays are narrower still */
                needed |= tl_exponents_needed(high, 1);
            needed |= layered_exponents(material, low, 1 - (1 - high) * (1 - ROUNDING));
        }
    return needed;
}

bool tl_material_is_faceted(const tl_material *material)
{
    return material->gloss.model != TL_REFLECT_PHONG;
}

bool tl_frame_has(const tl_frame *frame, bool (*property)(const tl_material *material))
{
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t p = 0; p < frame->surfaces[s].part_count; p++)
            if (property(&frame->surfaces[s].materials[frame->surfaces[s].parts[p].material]))
                return true;
    return false;
}

uint32_t tl_frame_map_exponents(const tl_frame *frame, const struct tl_detail_params *detail)
{
    return tl_frame_exponents(frame, detail) | 1u << TL_EXPONENT_COUNT;
}

static float greatest_glossiness(const tl_frame *frame)
{
    float greatest = 0;
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t p = 0; p < frame->surfaces[s].part_count; p++) {
            float low, high;
            glossiness_range(&frame->surfaces[s].materials[frame->surfaces[s].parts[p].material], &low,
                             &high);
            greatest = fmaxf(greatest, high);
        }
    return greatest;
}

static bool wants_detail(const tl_frame *frame, const struct tl_detail_params *detail)
{
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t p = 0; p < frame->surfaces[s].part_count; p++)
            if (tl_detail_wants_maps(detail,
                                     &frame->surfaces[s].materials[frame->surfaces[s].parts[p].material]))
                return true;
    return false;
}

static tl_bits lamp_facts(const tl_frame *frame, const struct tl_light_params *light)
{
    struct tl_lamp lamps[TL_LAMPS_MAX];
    size_t count = tl_lamps_lit(frame, lamps);
    tl_bits facts = count > 0 ? TL_BIT(TL_SCENE_LAMPS) : 0;
    struct tl_casters casters = {0};
    tl_error error = {0};
    if (count > 0 && light->visibility != TL_VISIBILITY_RAYS)
        tl_casters_measure(frame->surfaces, frame->surface_count, &casters, &error);
    for (size_t i = 0; i < count; i++) {
        enum tl_lamp_shadow shadow = tl_lamp_shadow_of(&lamps[i], light, &casters);
        if (shadow == TL_LAMP_SHADOW_RAYS)
            facts |= TL_BIT(TL_SCENE_LAMP_RAYS) | TL_BIT(TL_SCENE_SAMPLES);
        else if (shadow == TL_LAMP_SHADOW_MAP)
            facts |= TL_BIT(TL_SCENE_LAMP_MAPS);
    }
    return facts;
}

static tl_bits light_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const struct tl_light_params *light = &settings->light;
    if (light->method == TL_METHOD_REFERENCE)
        return TL_BIT(TL_SCENE_REFERENCE);
    if (light->method == TL_METHOD_MAPS)
        return TL_BIT(TL_SCENE_RASTER) | TL_BIT(TL_SCENE_ENVMAP) | lamp_facts(frame, light) |
               (settings->maps.capture_every > 0 ? TL_BIT(TL_SCENE_CAPTURE) : 0);
    bool shadowed = light->method != TL_METHOD_UNSHADOWED, rays = light->visibility == TL_VISIBILITY_RAYS;
    tl_bits facts = TL_BIT(TL_SCENE_RASTER) | TL_BIT(rays ? TL_SCENE_RAYS : TL_SCENE_PASSES);
    if (shadowed)
        facts |= TL_BIT(TL_SCENE_SHADOWS) | (rays ? 0 : TL_BIT(TL_SCENE_MAPS));
    if (wants_detail(frame, &settings->detail))
        facts |= TL_BIT(TL_SCENE_DETAIL);
    if (light->visibility == TL_VISIBILITY_VSM)
        facts |= TL_BIT(TL_SCENE_BLUR);
    if (!rays && tl_light_source(light) == TL_LIGHT_CHAIN)
        facts |= TL_BIT(TL_SCENE_CHAINS);
    if (!rays && tl_light_source(light) == TL_LIGHT_SLICES)
        facts |= TL_BIT(TL_SCENE_SLICES);
    if (rays || tl_light_needs_exact(light))
        facts |= TL_BIT(TL_SCENE_EXACT);
    if (rays && tl_frame_has(frame, tl_material_shows_more))
        facts |= TL_BIT(TL_SCENE_TRANSPARENCY);
    if (rays && light->method == TL_METHOD_PEM && light->reflect_scene &&
        tl_mirror_ray_count(tl_lobe_exponent(greatest_glossiness(frame))) > 0)
        facts |= TL_BIT(TL_SCENE_MIRRORS);
    if (rays)
        facts |= TL_BIT(TL_SCENE_SAMPLES) | TL_BIT(TL_SCENE_COMPOSED);
    return facts | lamp_facts(frame, light);
}

tl_bits tl_frame_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    tl_bits kept = frame->aovs ? TL_BIT(TL_SCENE_SAMPLES) : 0;
    if (settings->image.view == TL_VIEW_LIGHT)
        return kept | light_facts(frame, settings);
    if (wants_detail(frame, &settings->detail))
        kept |= TL_BIT(TL_SCENE_DETAIL);
    return kept | tl_inspect_facts(settings->image.view);
}
