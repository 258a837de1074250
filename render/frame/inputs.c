#include "render/frame/inputs.h"

#include "config/base/hash.h"
#include "config/base/memory.h"
#include "render/env/layout.h"
#include "render/frame/resources.h"
#include "render/local/lamp.h"
#include "render/plan/affects.h"

#include <math.h>
#include <string.h>

#define MIX(hash, field) tl_hash(hash, &(field), sizeof(field))

static uint64_t shapes_hash(const tl_frame *frame)
{
    uint64_t hash = MIX(TL_HASH_START, frame->surface_count);
    for (size_t i = 0; i < frame->surface_count; i++) {
        const tl_surface *surface = &frame->surfaces[i];
        hash = MIX(MIX(MIX(hash, surface->topology_revision), surface->vertex_count), surface->index_count);
    }
    return hash;
}

static uint64_t motion_hash(const tl_frame *frame)
{
    uint64_t hash = TL_HASH_START;
    for (size_t i = 0; i < frame->surface_count; i++)
        hash = MIX(hash, frame->surfaces[i].motion_revision);
    return hash;
}

static uint64_t camera_hash(const struct tl_camera *camera)
{
    uint64_t hash = MIX(MIX(MIX(TL_HASH_START, camera->eye), camera->target), camera->up);
    return MIX(MIX(MIX(hash, camera->fov_y), camera->near_m), camera->far_m);
}

/* The inputs that options decide: OPTIONS(input, place, table, affects). The place in tl_resources gets the
 * rows of the table (in tl_render_settings) that have one of these bits, and the input's hash covers them.
 * Other inputs follow from the frame alone. */
#define OPTION_INPUTS(OPTIONS)                                                                               \
    OPTIONS(TL_INPUT_SIZE, size.options, image, TL_AFFECTS_SIZE)                                             \
    OPTIONS(TL_INPUT_GROUND, ground_input.options, image, TL_AFFECTS_GROUND)                                 \
    OPTIONS(TL_INPUT_PEM_SIZE, pem_options, light, TL_AFFECTS_PEM_SIZE)                                      \
    OPTIONS(TL_INPUT_FILTER, filter_options, light, TL_AFFECTS_FILTER)                                       \
    OPTIONS(TL_INPUT_SUN, sun_options, light, TL_AFFECTS_SUN)                                                \
    OPTIONS(TL_INPUT_REGIONS, cut_options, light, TL_AFFECTS_REGIONS)                                        \
    OPTIONS(TL_INPUT_PASSES, storage_options, light, TL_AFFECTS_PASSES)                                      \
    OPTIONS(TL_INPUT_MAPS, shadows.options, light, TL_AFFECTS_SHADOW_MAPS)                                   \
    OPTIONS(TL_INPUT_RAYS, rays.options, light, TL_AFFECTS_RAYS)                                             \
    OPTIONS(TL_INPUT_LIGHT, light_options, light, TL_AFFECTS_LIGHT)                                          \
    OPTIONS(TL_INPUT_LAMPS, lamps.shading, shading, TL_AFFECTS_LAMPS)                                        \
    OPTIONS(TL_INPUT_REFERENCE, reference_options, reference, TL_AFFECTS_REFERENCE)                          \
    OPTIONS(TL_INPUT_DETAIL, detail_steps, detail, TL_AFFECTS_DETAIL | TL_AFFECTS_DETAIL_MAPS)               \
    OPTIONS(TL_INPUT_DETAIL_MAPS, detail_options, detail, TL_AFFECTS_DETAIL_MAPS)                            \
    OPTIONS(TL_INPUT_SHOW, show_options, image, TL_AFFECTS_SHOW | TL_AFFECTS_VIEW)                           \
    OPTIONS(TL_INPUT_ENVMAP, envmap_input.options, maps, TL_AFFECTS_ENVMAP)                                  \
    OPTIONS(TL_INPUT_LAYOUT, layout_options, maps, TL_AFFECTS_LAYOUT | TL_AFFECTS_ENVMAP)                    \
    OPTIONS(TL_INPUT_LOOK_UP, look_up_options, maps,                                                         \
            TL_AFFECTS_LOOK_UP | TL_AFFECTS_LAYOUT | TL_AFFECTS_ENVMAP)                                      \
    OPTIONS(TL_INPUT_CAPTURE, capture_options, maps, TL_AFFECTS_CAPTURE)                                     \
    OPTIONS(TL_INPUT_VIEW, view_options, image, TL_AFFECTS_VIEW | TL_AFFECTS_VIEW_SCALE)                     \
    OPTIONS(TL_INPUT_RATIO, ratio_options, light, TL_AFFECTS_RATIO)

/* The binding of a table of `settings`, whose params these are. */
static const struct tl_binding *find_binding(const struct tl_binding bindings[TL_RENDER_TABLES],
                                             const void *params)
{
    const struct tl_binding *found = bindings;
    while (found->params != params)
        found++;
    return found;
}

/* Computes each input's hash as far as options decide it. */
static void hash_options(const struct tl_render_settings *settings, uint64_t hashes[TL_INPUT_COUNT])
{
    struct tl_render_settings copy = *settings; /* bindings can be written through */
    struct tl_binding bindings[TL_RENDER_TABLES];
    tl_render_settings_bind(&copy, bindings);
    /* The scale of a view is of no matter while light is shown. */
    const uint64_t unused = settings->image.view == TL_VIEW_LIGHT ? TL_AFFECTS_VIEW_SCALE : 0;
    for (int i = 0; i < TL_INPUT_COUNT; i++)
        hashes[i] = TL_HASH_START;
#define HASH(input, place, table, affects)                                                                   \
    hashes[input] =                                                                                          \
        tl_options_hash(find_binding(bindings, &copy.table), 1,                                              \
                        (struct tl_option_filter){.any_of = (affects) & ~unused}, hashes[input]);
    OPTION_INPUTS(HASH)
#undef HASH
}

/* Copies the rows that have one of the bits into `to`, and sets all other fields to 0. */
static void take_rows(const struct tl_binding *from, uint64_t affects, void *to)
{
    const struct tl_binding taken = {from->table, to};
    memset(to, 0, from->table->params_size);
    tl_options_take(from, &taken, 1, (struct tl_option_filter){.any_of = affects});
}

static void take_options(const struct tl_render_settings *settings, struct tl_resources *resources)
{
    struct tl_render_settings copy = *settings;
    struct tl_binding bindings[TL_RENDER_TABLES];
    tl_render_settings_bind(&copy, bindings);
#define TAKE(input, place, table, affects)                                                                   \
    _Static_assert(__builtin_types_compatible_p(__typeof__(resources->place), __typeof__(copy.table)),       \
                   "the place has the type of the table's params");                                          \
    take_rows(find_binding(bindings, &copy.table), affects, &resources->place);
    OPTION_INPUTS(TAKE)
#undef TAKE
}

/* Without lamps it does not depend on `shading`, the hash of how surfaces are shaded under them. */
static uint64_t lamps_hash(const tl_frame *frame, uint64_t shading)
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
static uint64_t layout_hash(const tl_frame *frame, const struct tl_maps_params *maps, uint64_t options)
{
    if (maps->layout != TL_LAYOUT_SPHERE)
        return options;
    struct tl_view view = tl_view_make(&frame->camera, 1, 1);
    return MIX(MIX(options, view.forward), view.up);
}

/* The hash of the scene that a capture shows. */
static uint64_t scene_hash(const uint64_t hashes[TL_INPUT_COUNT])
{
    static const enum tl_resource shown[] = {TL_INPUT_ENVIRONMENT, TL_INPUT_YAW,    TL_INPUT_SHAPES,
                                             TL_INPUT_MOTION,      TL_INPUT_GROUND, TL_INPUT_LAMPS};
    uint64_t hash = hashes[TL_INPUT_CAPTURE];
    for (size_t i = 0; i < TL_COUNT(shown); i++)
        hash = MIX(hash, hashes[shown[i]]);
    return hash;
}

/* A still image never shows an old scene. */
static void count_capture(const tl_frame *frame, const struct tl_render_settings *settings,
                          const uint64_t hashes[TL_INPUT_COUNT], struct tl_rest *rest)
{
    const struct tl_maps_params *maps = &settings->maps;
    bool is_wanted = settings->light.method == TL_METHOD_MAPS && maps->capture_every > 0;
    uint64_t scene = is_wanted ? scene_hash(hashes) : 0;
    rest->capture_age = rest->capture_age < maps->capture_every ? rest->capture_age + 1 : maps->capture_every;
    bool is_time = frame->still || rest->captured == 0 || rest->capture_age >= maps->capture_every;
    if (scene != rest->captured && (is_time || !is_wanted)) {
        rest->captured = scene;
        rest->capture_age = 0;
    }
    rest->is_captured = scene == rest->captured;
}

/* Rounds of the graphics card, each of them a shifted image. */
static int card_rounds(const struct tl_light_params *light)
{
    return TL_FRAME_SHIFTS * light->rounds;
}

/* Ratios at vertices light one shifted image as another, so these begin at once. Samples have rounds of their
 * own, so the first image has all of them. In either case a whole set of shifted images follows when the
 * rounds are in. */
static void count_shifts(const tl_frame *frame, const struct tl_render_settings *settings, tl_bits facts,
                         bool image_rests, struct tl_rest *rest)
{
    const tl_bits none = TL_BIT(TL_SCENE_PASSES) | TL_BIT(TL_SCENE_REFERENCE);
    int set = !frame->smooth || facts & none ? 0 : TL_FRAME_SHIFTS - 1;
    if (facts & TL_BIT(TL_SCENE_CARD_REST))
        set = frame->still ? 0 : card_rounds(&settings->light) - 1;
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

static void count_rest(const tl_frame *frame, const struct tl_render_settings *settings, tl_bits facts,
                       const uint64_t before[TL_INPUT_COUNT], const uint64_t hashes[TL_INPUT_COUNT],
                       struct tl_rest *rest)
{
    const struct tl_light_params *light = &settings->light;
    bool image_rests = true, scene_rests = true;
    for (int i = 0; i < TL_INPUT_COUNT; i++) {
        bool is_outcome = i == TL_INPUT_ROUND || i == TL_INPUT_SCENE_ROUND || i == TL_INPUT_SHIFT;
        if (is_outcome || i == TL_INPUT_SHOW || hashes[i] == before[i])
            continue;
        image_rests = false;
        scene_rests = scene_rests && (i == TL_INPUT_CAMERA || i == TL_INPUT_SIZE || i == TL_INPUT_LAMPS ||
                                      i == TL_INPUT_RATIO || i == TL_INPUT_RAYS);
    }
    int last = tl_light_averages(light) ? light->rounds - 1 : 0;
    rest->image = !image_rests ? 0 : rest->image < last ? rest->image + 1 : last;
    rest->is_done = rest->is_done && image_rests;
    count_shifts(frame, settings, facts, image_rests, rest);
    bool is_done = light->visibility == TL_VISIBILITY_RAYS ? rest->is_done : rest->scene >= last;
    if (!scene_rests)
        rest->scene = 0;
    else if (tl_light_averages(light) && !is_done)
        rest->scene++;
}

static struct tl_lobes_input lobes_of(const struct tl_light_params *light)
{
    return (struct tl_lobes_input){.all = tl_light_is_composed(light) || tl_light_sums_lobes(light),
                                   .are_blended = light->lobe == TL_LOBE_SINGLE};
}

void tl_frame_hash_inputs(const tl_frame *frame, const struct tl_render_settings *settings, tl_bits facts,
                          const uint64_t before[TL_INPUT_COUNT], struct tl_rest *rest,
                          uint64_t hashes[TL_INPUT_COUNT])
{
    const struct tl_light_params *light = &settings->light;
    const uint64_t start = TL_HASH_START;
    hash_options(settings, hashes);
    const bool on_card = facts & TL_BIT(TL_SCENE_CARD);
    hashes[TL_INPUT_DEVICE] = MIX(start, on_card);
    hashes[TL_INPUT_ENVIRONMENT] = MIX(start, frame->environment_revision);
    hashes[TL_INPUT_YAW] = MIX(start, frame->environment_yaw);
    hashes[TL_INPUT_SHAPES] = shapes_hash(frame);
    hashes[TL_INPUT_MOTION] = motion_hash(frame);
    hashes[TL_INPUT_CAMERA] = camera_hash(&frame->camera);
    hashes[TL_INPUT_GROUND] = MIX(hashes[TL_INPUT_GROUND], frame->environment->ground);
    const struct tl_lobes_input lobes = lobes_of(light);
    hashes[TL_INPUT_LOBES] = MIX(MIX(start, lobes.all), lobes.are_blended);
    bool in_passes =
        tl_light_source(light) == TL_LIGHT_CHAIN; /* maps in an array: as many as PEMs in a pass */
    hashes[TL_INPUT_MAPS] = MIX(hashes[TL_INPUT_MAPS], in_passes);
    hashes[TL_INPUT_LAMPS] = lamps_hash(frame, hashes[TL_INPUT_LAMPS]);
    bool captures = settings->maps.capture_every > 0;
    hashes[TL_INPUT_ENVMAP] = MIX(hashes[TL_INPUT_ENVMAP], captures);
    hashes[TL_INPUT_LAYOUT] = layout_hash(frame, &settings->maps, hashes[TL_INPUT_LAYOUT]);
    count_capture(frame, settings, hashes, rest);
    hashes[TL_INPUT_CAPTURE] = MIX(start, rest->captured);
    count_rest(frame, settings, facts, before, hashes, rest);
    hashes[TL_INPUT_SHIFT] = MIX(start, rest->shifts);
    if (facts & TL_BIT(TL_SCENE_CARD_REST) && frame->still)
        hashes[TL_INPUT_SHIFT] = MIX(hashes[TL_INPUT_SHIFT], light->rounds);
    hashes[TL_INPUT_ROUND] = MIX(start, rest->image);
    hashes[TL_INPUT_SCENE_ROUND] = MIX(start, rest->scene);
}

/* Places in a pixel: the lattice of rank 1 of 16 points whose columns, rows and slanted lines are filled most
 * evenly: an edge's coverage is off by 0.16 at worst. In steps of 5, so that few are spread as well; the
 * first is the middle. */
struct tl_view tl_frame_shifted_view(const struct tl_view *view, int number, int width, int height)
{
    enum { STEP = 5, SLANT = 3 };
    number = STEP * (number % TL_FRAME_SHIFTS);
    float right = (float)((number + TL_FRAME_SHIFTS / 2) % TL_FRAME_SHIFTS) / TL_FRAME_SHIFTS - 0.5f;
    float up = (float)((SLANT * number + TL_FRAME_SHIFTS / 2) % TL_FRAME_SHIFTS) / TL_FRAME_SHIFTS - 0.5f;
    return number == 0 ? *view : tl_view_shift(view, 2 * right / (float)width, 2 * up / (float)height);
}

static struct tl_shift_input shift_of(const struct tl_rest *rest, const tl_frame *frame,
                                      const struct tl_render_settings *settings, tl_bits facts,
                                      const struct tl_view *view)
{
    const struct tl_image_params *image = &settings->image;
    const bool on_card = facts & TL_BIT(TL_SCENE_CARD_REST);
    const int maximum = on_card ? rest->shifts : TL_FRAME_SHIFTS - 1;
    return (struct tl_shift_input){.view =
                                       tl_frame_shifted_view(view, rest->shifts, image->width, image->height),
                                   .before = rest->shifts < maximum ? rest->shifts : maximum,
                                   .rounds = on_card && frame->still ? card_rounds(&settings->light) : 1};
}

static vec3s ground_colour(const tl_frame *frame, const struct tl_image_params *image)
{
    vec3s known = frame->environment->ground;
    bool is_known = known.r > 0 || known.g > 0 || known.b > 0;
    if (image->ground_grey > 0)
        return glms_vec3_fill(image->ground_grey);
    return is_known ? known : TL_GROUND_GREY;
}

/* Lists the surfaces to draw: those of the frame, then the ground if it is shown. */
static void list_surfaces(const tl_frame *frame, bool has_ground, uint64_t revision,
                          struct tl_resources *resources)
{
    struct tl_shapes_input *shapes = &resources->shapes;
    shapes->surfaces = frame->surfaces;
    shapes->surface_count = frame->surface_count;
    shapes->revision = revision;
    shapes->drawn = tl_resize(shapes->drawn, frame->surface_count + 1,
                              sizeof *shapes->drawn); // NOLINT(bugprone-sizeof-expression): of a pointer
    for (size_t i = 0; i < frame->surface_count; i++)
        shapes->drawn[i] = &frame->surfaces[i];
    shapes->drawn[frame->surface_count] = &resources->ground.surface;
    shapes->drawn_count = frame->surface_count + (has_ground ? 1 : 0);
    tl_triangle_ranges_make(shapes->drawn, shapes->drawn_count, &shapes->ranges);
    resources->motion =
        (struct tl_motion_input){.surfaces = frame->surfaces, .surface_count = frame->surface_count};
}

void tl_inputs_set(struct tl_resources *resources, const tl_frame *frame,
                   const struct tl_render_settings *settings, tl_bits facts, const struct tl_rest *rest,
                   const uint64_t hashes[TL_INPUT_COUNT])
{
    const struct tl_light_params *light = &settings->light;
    const struct tl_image_params *image = &settings->image;
    take_options(settings, resources);
    list_surfaces(frame, image->ground, hashes[TL_INPUT_SHAPES], resources);
    resources->environment = (struct tl_environment_input){frame->environment, frame->environment_revision};
    resources->yaw = frame->environment_yaw;
    resources->camera =
        (struct tl_camera_input){frame->camera, tl_view_make(&frame->camera, image->width, image->height)};
    resources->shift = shift_of(rest, frame, settings, facts, &resources->camera.view);
    tl_image_samples(image, &resources->size.columns, &resources->size.rows);
    resources->ground_input.is_drawn = image->ground;
    resources->ground_input.colour = ground_colour(frame, image);
    resources->lobes_input = lobes_of(light);
    resources->shadows.in_passes = tl_light_source(light) == TL_LIGHT_CHAIN;
    resources->rays.params = tl_light_ray_params(light);
    resources->rays.averages = tl_light_averages(light);
    resources->round = rest->image;
    resources->scene_round = rest->scene;
    resources->points_are_done = rest->is_done;
    resources->lamps.count = tl_lamps_lit(frame, resources->lamps.items);
    resources->envmap_input.is_captured = settings->maps.capture_every > 0;
    resources->facts = facts;
}
