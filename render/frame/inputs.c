#include "render/frame/inputs.h"

#include "config/hash.h"
#include "config/memory.h"
#include "render/env/layout.h"
#include "render/frame/facts.h"
#include "render/light/light.h"
#include "render/local/lamp.h"
#include "render/plan/affects.h"

#include <math.h>
#include <string.h>

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

/* The inputs that options decide, by the bits of the options' rows. Other inputs follow from the frame alone.
 */
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
    [TL_INPUT_RATIO] = TL_AFFECTS_RATIO,
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

/* The signature of the scene that a capture shows. */
static uint64_t scene_signature(const uint64_t signatures[TL_INPUT_COUNT])
{
    static const enum tl_resource shown[] = {TL_INPUT_ENVIRONMENT, TL_INPUT_YAW,    TL_INPUT_SHAPES,
                                             TL_INPUT_MOTION,      TL_INPUT_GROUND, TL_INPUT_LAMPS};
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

/* Ratios at vertices light one shifted image as another, so these begin at once. Samples have rounds of their
 * own, so the first image has all of them. In either case a whole set of shifted images follows when the
 * rounds are in. */
static void count_shifts(const tl_frame *frame, const struct tl_render_settings *settings, bool image_rests,
                         struct tl_rest *rest)
{
    const tl_bits none = TL_BIT(TL_SCENE_PASSES) | TL_BIT(TL_SCENE_REFERENCE);
    tl_bits facts = frame->smooth ? tl_frame_facts(frame, settings) : none;
    int set = facts & none ? 0 : TL_FRAME_SHIFTS - 1;
    if (!image_rests || set != rest->shift_set) {
        rest->shifts = 0;
        rest->shifts_left = rest->shift_set = set;
        return;
    }
    bool has_rounds =
        facts & (TL_BIT(TL_SCENE_RATIOS) | TL_BIT(TL_SCENE_COMPOSED)) && tl_light_averages(&settings->light);
    bool are_in = rest->is_done || !has_rounds || rest->shifts_left < set;
    bool begins = are_in ? rest->shifts_left > 0 : set > 0 && facts & TL_BIT(TL_SCENE_RATIOS);
    rest->shifts += begins;
    rest->shifts_left -= are_in && begins;
}

static void count_rest(const tl_frame *frame, const struct tl_render_settings *settings,
                       const uint64_t before[TL_INPUT_COUNT], const uint64_t signatures[TL_INPUT_COUNT],
                       struct tl_rest *rest)
{
    const struct tl_light_params *light = &settings->light;
    bool image_rests = true, scene_rests = true;
    for (int i = 0; i < TL_INPUT_COUNT; i++) {
        bool is_outcome = i == TL_INPUT_ROUND || i == TL_INPUT_SCENE_ROUND || i == TL_INPUT_SHIFT;
        if (is_outcome || i == TL_INPUT_SHOW || signatures[i] == before[i])
            continue;
        image_rests = false;
        scene_rests = scene_rests && (i == TL_INPUT_CAMERA || i == TL_INPUT_SIZE || i == TL_INPUT_LAMPS ||
                                      i == TL_INPUT_RATIO || i == TL_INPUT_RAYS);
    }
    int last = tl_light_averages(light) ? light->rounds - 1 : 0;
    rest->image = !image_rests ? 0 : rest->image < last ? rest->image + 1 : last;
    rest->is_done = rest->is_done && image_rests;
    count_shifts(frame, settings, image_rests, rest);
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
    signatures[TL_INPUT_GROUND] = MIX(signatures[TL_INPUT_GROUND], frame->environment->ground);
    const struct tl_lobes_input lobes = tl_input_lobes(light);
    signatures[TL_INPUT_LOBES] = MIX(MIX(start, lobes.all), lobes.are_blended);
    bool in_passes =
        tl_light_source(light) == TL_LIGHT_CHAIN; /* maps in an array: as many as PEMs in a pass */
    signatures[TL_INPUT_MAPS] = MIX(signatures[TL_INPUT_MAPS], in_passes);
    signatures[TL_INPUT_LAMPS] = lamps_signature(frame, signatures[TL_INPUT_LAMPS]);
    bool captures = settings->maps.capture_every > 0;
    signatures[TL_INPUT_ENVMAP] = MIX(signatures[TL_INPUT_ENVMAP], captures);
    signatures[TL_INPUT_LAYOUT] = layout_signature(frame, &settings->maps, signatures[TL_INPUT_LAYOUT]);
    count_capture(frame, settings, signatures, rest);
    signatures[TL_INPUT_CAPTURE] = MIX(start, rest->captured);
    count_rest(frame, settings, before, signatures, rest);
    signatures[TL_INPUT_SHIFT] = MIX(start, rest->shifts);
    signatures[TL_INPUT_ROUND] = MIX(start, rest->image);
    signatures[TL_INPUT_SCENE_ROUND] = MIX(start, rest->scene);
}

/* Places in a pixel: the lattice of rank 1 of 16 points whose columns, rows and slanted lines are filled most
 * evenly: an edge's coverage is off by 0.16 at worst. In steps of 5, so that few are spread as well; the
 * first is the middle. */
struct tl_shift_input tl_input_shift(const struct tl_rest *rest, const struct tl_view *view, int width,
                                     int height)
{
    enum { STEP = 5, SLANT = 3 };
    int number = STEP * (rest->shifts % TL_FRAME_SHIFTS), before = rest->shifts;
    float right = (float)((number + TL_FRAME_SHIFTS / 2) % TL_FRAME_SHIFTS) / TL_FRAME_SHIFTS - 0.5f;
    float up = (float)((SLANT * number + TL_FRAME_SHIFTS / 2) % TL_FRAME_SHIFTS) / TL_FRAME_SHIFTS - 0.5f;
    if (before == 0)
        return (struct tl_shift_input){.view = *view};
    return (struct tl_shift_input){.view =
                                       tl_view_shift(view, 2 * right / (float)width, 2 * up / (float)height),
                                   .before = before < TL_FRAME_SHIFTS ? before : TL_FRAME_SHIFTS - 1};
}

struct tl_light_params tl_input_light(const struct tl_light_params *light)
{
    return (struct tl_light_params){.method = light->method,
                                    .lobe = light->lobe,
                                    .prefilter = light->prefilter,
                                    .visibility = light->visibility,
                                    .composition = light->composition,
                                    .reflect_scene = light->reflect_scene,
                                    .bounce = light->bounce,
                                    .bounce_shares = light->bounce_shares,
                                    .fan = light->fan,
                                    .depth_bias_m = light->depth_bias_m,
                                    .min_variance = light->min_variance,
                                    .bleed_reduction = light->bleed_reduction};
}

struct tl_lobes_input tl_input_lobes(const struct tl_light_params *light)
{
    return (struct tl_lobes_input){.all = tl_light_is_composed(light),
                                   .are_blended = light->lobe == TL_LOBE_SINGLE};
}

struct tl_shadow_input tl_input_shadows(const struct tl_light_params *light)
{
    return (struct tl_shadow_input){.kind = (enum tl_visibility)light->visibility,
                                    .moments = (enum tl_moments)light->moments,
                                    .map_size = light->map_size,
                                    .in_passes = tl_light_source(light) == TL_LIGHT_CHAIN,
                                    .blur_m = light->blur_m};
}

struct tl_detail_params tl_input_detail_maps(const struct tl_detail_params *detail)
{
    return (struct tl_detail_params){.mode = detail->mode,
                                     .shadow = detail->shadow,
                                     .angles = detail->angles,
                                     .height_scale = detail->height_scale,
                                     .minify = detail->minify};
}

struct tl_maps_params tl_input_layout(const struct tl_maps_params *maps)
{
    return (struct tl_maps_params){.layout = maps->layout, .size = maps->size};
}

struct tl_maps_params tl_input_look_up(const struct tl_maps_params *maps)
{
    struct tl_maps_params own = *maps; /* all but what is of a capture */
    own.capture_every = 0;
    memset(own.capture_at, 0, sizeof own.capture_at);
    return own;
}

struct tl_maps_params tl_input_capture(const struct tl_maps_params *maps)
{
    return (struct tl_maps_params){
        .size = maps->size, .capture_at = {maps->capture_at[0], maps->capture_at[1], maps->capture_at[2]}};
}

struct tl_ground_input tl_input_ground(const tl_frame *frame, const struct tl_image_params *image)
{
    vec3s known = frame->environment->ground;
    bool is_known = known.r > 0 || known.g > 0 || known.b > 0;
    vec3s colour = is_known ? known : TL_GROUND_GREY;
    if (image->ground_grey > 0)
        colour = glms_vec3_fill(image->ground_grey);
    return (struct tl_ground_input){.is_drawn = image->ground, .colour = colour};
}

struct tl_image_params tl_input_show(const struct tl_image_params *image)
{
    return (struct tl_image_params){.exposure_ev = image->exposure_ev,
                                    .adapt = image->adapt,
                                    .background = image->background,
                                    .view = image->view};
}

struct tl_image_params tl_input_view(const struct tl_image_params *image)
{
    return (struct tl_image_params){
        .view = image->view, .view_region = image->view_region, .view_range = image->view_range};
}

struct tl_lamps_input tl_input_lamps(const tl_frame *frame, const struct tl_shading_params *shading)
{
    struct tl_lamps_input lamps = {.shading = *shading};
    lamps.count = tl_lamps_lit(frame, lamps.items);
    return lamps;
}
