#include "render/frame/facts.h"

#include "config/base/simd.h"
#include "render/brdf/fuzz.h"
#include "render/brdf/lobe_fit.h"
#include "render/card/card.h"
#include "render/detail/detail.h"
#include "render/env/exponent.h"
#include "render/env/lobes.h"
#include "render/inspect/legend.h"
#include "render/light/light.h"
#include "render/light/mirrors.h"
#include "render/light/transparency.h"
#include "render/local/lamp_shadows.h"
#include "render/shade/materials.h"

#include <math.h>

/* The smallest and the largest of some numbers. In many lanes, because a budget asks for the facts of a frame
 * at other settings, too. */
TL_CLONES static void range_of(const float *values, size_t count, float *low, float *high)
{
    enum { LANES = 2 * TL_LANES }; /* loops of TL_LANES would be unrolled, and not become vector code */
    float lows[LANES], highs[LANES];
    for (int k = 0; k < LANES; k++) {
        lows[k] = INFINITY;
        highs[k] = -INFINITY;
    }
    size_t whole = count - count % LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (int k = 0; k < LANES; k++) {
            lows[k] = tl_minf(values[i + (size_t)k], lows[k]);
            highs[k] = tl_maxf(values[i + (size_t)k], highs[k]);
        }
    for (size_t i = whole; i < count; i++) {
        lows[0] = tl_minf(values[i], lows[0]);
        highs[0] = tl_maxf(values[i], highs[0]);
    }
    *low = INFINITY;
    *high = -INFINITY;
    for (int k = 0; k < LANES; k++) {
        *low = fminf(*low, lows[k]);
        *high = fmaxf(*high, highs[k]);
    }
}

/* The smallest and the largest glossiness that a material's maps can make of it. */
static void glossiness_range(const tl_material *material, float *low, float *high)
{
    float minimum = material->gloss_map.image ? 0 : material->glossiness, maximum = material->glossiness;
    if (material->weave) {
        const tl_image *gloss = &material->weave->gloss;
        float added_low, added_high;
        range_of(tl_image_floats(gloss), (size_t)gloss->width * (size_t)gloss->height, &added_low,
                 &added_high);
        minimum += added_low;
        maximum += added_high;
    }
    *low = fminf(fmaxf(minimum, 0), 1);
    *high = fminf(fmaxf(maximum, 0), 1);
}

/* The G-buffer rounds 1 - glossiness to a half. */
#define ROUNDING 1e-3f

/* Exponents from `minimum` to `maximum`. */
static uint32_t exponents_between(float minimum, float maximum)
{
    return tl_exponents_needed(1 - 1 / fmaxf(minimum * (1 - ROUNDING), 1),
                               1 - 1 / fmaxf(maximum * (1 + ROUNDING), 1));
}

/* The exponents of the lobes of light from inside threads: from as narrow as they are to as wide as bumps can
 * make any, where `low` states that there are such. */
static uint32_t thread_exponents(const tl_material *material, float low, float high)
{
    const float none[3] = {0, 0, 0}, all[3] = {1, 1, 0}, *widest = low < material->glossiness ? all : none;
    const struct tl_brdf_sum narrow =
        tl_brdf_sum_of(material, material->specular, material->diffuse, high, 1, none);
    const struct tl_brdf_sum wide =
        tl_brdf_sum_of(material, material->specular, material->diffuse, low, 1, widest);
    uint32_t needed = 0;
    for (int i = 1; i < narrow.count; i++) {
        float minimum, maximum, unused;
        tl_lobe_fit_exponents(&wide.items[i], &minimum, &unused);
        tl_lobe_fit_exponents(&narrow.items[i], &unused, &maximum);
        needed |= exponents_between(minimum, maximum);
    }
    return needed;
}

/* The exponents that a material's lobes beyond the first two need. */
static uint32_t layered_exponents(const tl_material *material, float low, float high)
{
    uint32_t needed = 0;
    if (material->coat > 0)
        needed |= tl_exponents_needed(material->coat_glossiness, material->coat_glossiness);
    if (tl_material_has_fuzz(material))
        needed |= TL_FUZZ_EXPONENTS;
    if (!tl_material_is_faceted(material))
        return needed;
    float minimum, maximum, unused;
    struct tl_brdf dull = tl_brdf_of(material, material->specular, low);
    struct tl_brdf shiny = tl_brdf_of(material, material->specular, high);
    tl_lobe_fit_exponents(&dull, &minimum, &unused);
    tl_lobe_fit_exponents(&shiny, &unused, &maximum);
    return needed | exponents_between(minimum, maximum) | thread_exponents(material, low, high);
}

uint32_t tl_exponents_of(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail)
{
    uint32_t needed = 1;
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s].part_count; p++) {
            const tl_material *material = &surfaces[s].materials[surfaces[s].parts[p].material];
            float low, high;
            glossiness_range(material, &low, &high);
            bool is_sewn = surfaces[s].borders && tl_material_is_sewn(material);
            if (tl_detail_wants_moments(detail) && (is_sewn || tl_detail_wants_maps(detail, material)))
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

bool tl_materials_have(const tl_surface *surfaces, size_t count,
                       bool (*property)(const tl_material *material))
{
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s].part_count; p++)
            if (property(&surfaces[s].materials[surfaces[s].parts[p].material]))
                return true;
    return false;
}

uint32_t tl_map_exponents_of(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail)
{
    return tl_exponents_of(surfaces, count, detail) | 1u << TL_EXPONENT_COUNT;
}

static float max_glossiness(const tl_surface *surfaces, size_t count)
{
    float maximum = 0;
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s].part_count; p++) {
            float low, high;
            glossiness_range(&surfaces[s].materials[surfaces[s].parts[p].material], &low, &high);
            maximum = fmaxf(maximum, high);
        }
    return maximum;
}

static bool wants_detail(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail)
{
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s].part_count; p++)
            if (tl_detail_wants_maps(detail, &surfaces[s].materials[surfaces[s].parts[p].material]))
                return true;
    return false;
}

static tl_bits lamp_facts(const tl_frame *frame, const struct tl_light_params *light)
{
    struct tl_lamp lamps[TL_LAMPS_MAX];
    size_t count = tl_lamps_lit(frame, lamps);
    bool emits = tl_materials_have(frame->surfaces, frame->surface_count, tl_material_emits);
    tl_bits facts = count > 0 || emits ? TL_BIT(TL_SCENE_LAMPS) : 0; /* one pass adds both */
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

static bool has_mirrors(const tl_frame *frame, const struct tl_light_params *light)
{
    return light->reflect_scene &&
           tl_mirror_ray_count(tl_lobe_exponent(max_glossiness(frame->surfaces, frame->surface_count))) > 0;
}

/* Whether no light comes from the environment. Shadow maps are then drawn all the same, of six regions:
 * passes read them. */
static bool is_dark(const tl_frame *frame)
{
    return frame->environment && tl_environment_is_black(frame->environment);
}

static bool is_measured(const tl_material *material)
{
    return material->measured;
}

static bool has_coat(const tl_material *material)
{
    return material->coat > 0;
}

/* Returns why pixels cannot add the lamps' light themselves, by each material's formula; NULL: they can. */
static const char *lamps_refusal(const tl_frame *frame, const struct tl_shading_params *shading)
{
    struct tl_lamp lamps[TL_LAMPS_MAX];
    if (tl_lamps_lit(frame, lamps) == 0)
        return NULL;
    if (!tl_options_equal(&tl_shading_options, shading, tl_shading_options.defaults))
        return "lamps whose shading is not exact (table shading)";
    return tl_materials_have(frame->surfaces, frame->surface_count, is_measured)
               ? "measured reflectance under lamps"
               : NULL;
}

/* Returns why ratios at vertices cannot light the pixels on either engine; NULL: they can. */
static const char *vertices_refusal(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const struct tl_light_params *light = &settings->light;
    if (light->method != TL_METHOD_PEM || light->visibility != TL_VISIBILITY_RAYS ||
        light->lobe != TL_LOBE_DUAL)
        return "this method (light.method, light.visibility, light.lobe)";
    if (frame->aovs)
        return "layers of data";
    if (is_dark(frame))
        return "scenes whose environment is black";
    if (has_mirrors(frame, light))
        return "near mirrors (light.reflect_scene)";
    if (!tl_shade_materials_fit(frame->surfaces, frame->surface_count, &settings->detail))
        return "such detail (detail.mode, detail.shadow, height maps)";
    return lamps_refusal(frame, &settings->shading);
}

/* True when ratios at vertices can light the pixels on the CPU: nothing in the scene needs samples. */
static bool fits_vertices(const tl_frame *frame, const struct tl_render_settings *settings)
{
    return !vertices_refusal(frame, settings) &&
           !tl_materials_have(frame->surfaces, frame->surface_count, tl_material_emits) &&
           !tl_materials_have(frame->surfaces, frame->surface_count, has_coat);
}

static bool is_black(vec3s colour)
{
    return glms_vec3_max(colour) <= 0;
}

/* Whether light that meets the material is sent on: by colours that maps only darken, through holes, or of
 * its own. */
static bool sends_light(const tl_material *material)
{
    const struct tl_back *back = &material->back;
    return !is_black(material->diffuse) || !is_black(material->specular) ||
           tl_material_is_layered(material) || tl_material_emits(material) || material->thread_count > 0 ||
           material->openness > 0 ||
           (back->is_given && !(is_black(back->diffuse) && is_black(back->specular)));
}

static tl_bits bounce_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const struct tl_light_params *light = &settings->light;
    bool bounces =
        light->bounce != TL_BOUNCE_OFF && light->method == TL_METHOD_PEM &&
        light->visibility == TL_VISIBILITY_RAYS &&
        (settings->image.ground || tl_materials_have(frame->surfaces, frame->surface_count, sends_light));
    return bounces ? TL_BIT(TL_SCENE_BOUNCE) : 0;
}

static tl_bits ratio_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    return TL_BIT(TL_SCENE_RATIOS) | TL_BIT(TL_SCENE_PIXELS) | TL_BIT(TL_SCENE_RAYS) |
           TL_BIT(TL_SCENE_SHADOWS) | TL_BIT(TL_SCENE_REGION_LIGHTS) | TL_BIT(TL_SCENE_EXACT) |
           bounce_facts(frame, settings);
}

const char *tl_frame_card_refusal(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const char *refusal = vertices_refusal(frame, settings);
    if (settings->image.view != TL_VIEW_LIGHT)
        return "views other than light (image.view)";
    if (refusal)
        return refusal;
    if (settings->light.bounce == TL_BOUNCE_ONE)
        return "light that bounces once (light.bounce)";
    if (settings->light.lobes > TL_CARD_LOBES)
        return "so many lobes of a gloss (light.lobes)";
    return tl_card_refusal(frame->surfaces, frame->surface_count);
}

/* Paths follow what ratios cannot hold: near mirrors, and light that bounces as often as it is to. */
const char *tl_frame_rest_refusal(const tl_frame *frame, const struct tl_render_settings *settings)
{
    struct tl_render_settings followed = *settings;
    if (!frame->still && !frame->smooth) /* noisy */
        return "images of one round";
    if (settings->light.bounce == TL_BOUNCE_OFF && has_mirrors(frame, &settings->light))
        return "near mirrors of a scene whose light does not bounce (light.bounce)";
    followed.light.bounce = TL_BOUNCE_ALL;
    followed.light.lobes = 1;
    followed.light.reflect_scene = false;
    return tl_frame_card_refusal(frame, &followed);
}

static tl_bits card_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const bool bounces = bounce_facts(frame, settings) != 0;
    return TL_BIT(TL_SCENE_CARD) | TL_BIT(TL_SCENE_CARD_RATIOS) | TL_BIT(TL_SCENE_PIXELS) |
           TL_BIT(TL_SCENE_REGION_LIGHTS) | TL_BIT(TL_SCENE_EXACT) |
           (bounces ? TL_BIT(TL_SCENE_CARD_BOUNCE) : 0);
}

/* Facts of a frame whose samples are lit. */
static tl_bits sample_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const struct tl_light_params *light = &settings->light;
    if (light->method == TL_METHOD_REFERENCE)
        return TL_BIT(TL_SCENE_REFERENCE);
    if (light->method == TL_METHOD_MAPS)
        return TL_BIT(TL_SCENE_RASTER) | TL_BIT(TL_SCENE_ENVMAP) | lamp_facts(frame, light) |
               (settings->maps.capture_every > 0 ? TL_BIT(TL_SCENE_CAPTURE) : 0) |
               (settings->maps.light_map > 0 ? TL_BIT(TL_SCENE_LIGHT_MAP) : 0);
    bool rays = light->visibility == TL_VISIBILITY_RAYS;
    bool shadowed = light->method != TL_METHOD_UNSHADOWED && !(rays && is_dark(frame));
    tl_bits facts = TL_BIT(TL_SCENE_RASTER) | TL_BIT(rays ? TL_SCENE_RAYS : TL_SCENE_PASSES);
    if (shadowed)
        facts |= TL_BIT(TL_SCENE_SHADOWS) | TL_BIT(rays ? TL_SCENE_REGION_LIGHTS : TL_SCENE_MAPS);
    if (wants_detail(frame->surfaces, frame->surface_count, &settings->detail))
        facts |= TL_BIT(TL_SCENE_DETAIL);
    if (light->visibility == TL_VISIBILITY_VSM)
        facts |= TL_BIT(TL_SCENE_BLUR);
    if (!rays && tl_light_source(light) == TL_LIGHT_CHAIN)
        facts |= TL_BIT(TL_SCENE_CHAINS);
    if (tl_light_sums_lobes(light) &&
        tl_materials_have(frame->surfaces, frame->surface_count, tl_material_is_faceted))
        facts |= TL_BIT(TL_SCENE_SAMPLES) | TL_BIT(TL_SCENE_LOBE_SUMS);
    if (!rays && tl_light_source(light) == TL_LIGHT_SLICES)
        facts |= TL_BIT(TL_SCENE_SLICES);
    if (rays || tl_light_needs_exact(light))
        facts |= TL_BIT(TL_SCENE_EXACT);
    if (rays && tl_materials_have(frame->surfaces, frame->surface_count, tl_material_shows_more))
        facts |= TL_BIT(TL_SCENE_TRANSPARENCY);
    if (rays && light->method == TL_METHOD_PEM && has_mirrors(frame, light))
        facts |= TL_BIT(TL_SCENE_MIRRORS);
    if (rays)
        facts |= TL_BIT(TL_SCENE_SAMPLES) | TL_BIT(TL_SCENE_COMPOSED);
    return facts | lamp_facts(frame, light) | bounce_facts(frame, settings);
}

static tl_bits light_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    const bool at_vertices = settings->light.ratio_at == TL_RATIO_AT_VERTICES;
    const tl_bits fits = TL_BIT(TL_SCENE_FITS_VERTICES);
    if (at_vertices && settings->light.device == TL_DEVICE_CARD && !tl_frame_card_refusal(frame, settings))
        return fits | card_facts(frame, settings);
    if (!at_vertices && settings->light.device == TL_DEVICE_CARD && !tl_frame_rest_refusal(frame, settings))
        return (tl_frame_card_refusal(frame, settings) ? 0 : fits) | TL_BIT(TL_SCENE_CARD) |
               TL_BIT(TL_SCENE_CARD_REST) | TL_BIT(TL_SCENE_PIXELS);
    if (!fits_vertices(frame, settings))
        return sample_facts(frame, settings);
    return fits | (at_vertices ? ratio_facts(frame, settings) : sample_facts(frame, settings));
}

/* Facts of a frame whose view is not light, except those that follow from its materials. */
static tl_bits view_facts(int view)
{
    tl_bits facts = TL_BIT(TL_SCENE_RASTER) | TL_BIT(TL_SCENE_SAMPLES) | TL_BIT(TL_SCENE_INSPECT);
    if (tl_view_is_visibility(view))
        facts |= TL_BIT(TL_SCENE_RAYS) | TL_BIT(TL_SCENE_SHADOWS);
    return facts;
}

tl_bits tl_frame_facts(const tl_frame *frame, const struct tl_render_settings *settings)
{
    tl_bits kept = frame->aovs ? TL_BIT(TL_SCENE_SAMPLES) : 0;
    if (settings->image.view == TL_VIEW_LIGHT)
        return kept | light_facts(frame, settings);
    if (wants_detail(frame->surfaces, frame->surface_count, &settings->detail))
        kept |= TL_BIT(TL_SCENE_DETAIL);
    return kept | view_facts(settings->image.view);
}
