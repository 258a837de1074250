/* Each fault, put into a frame on purpose, is named by the invariant that it breaks; a clean frame passes. */
#include "tests/app/lab/verdicts.h"

#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/inside.h"
#include "tests/app/stability/extremes_light.h"

#include <epoxy/gl.h>

#include <string.h>

/* Small, and with a share of all pixels in shadow that a few dozen of them show. */
enum { WIDTH = 96, HEIGHT = 72, PIXEL_40_30 = 4 * (30 * WIDTH + 40) /* its first value */ };

/* A pleated curtain over a floor, drawn by one back-end; and everything that its frame is checked with. */
struct stand {
    tl_gpu *gpu;
    struct tl_extreme_scene scene;
    tl_tangent_frames *frames;
    struct tl_render_settings settings;
    tl_renderer *renderer, *fresh, *white, *white_shadowed;
    tl_environment even;
    tl_image image, fresh_image, white_image, white_shadowed_image;
    tl_frame frame;
    struct tl_checked checked;
};
typedef struct stand *stand_maker(void);

static void draw(struct stand *stand, tl_renderer **renderer, const tl_frame *frame,
                 const struct tl_render_settings *settings, tl_image *image)
{
    tl_error error = {0};
    if (!*renderer)
        *renderer = tl_renderer_create(stand->gpu, &error);
    tl_image_release(image);
    assert_ok(*renderer && tl_renderer_draw(*renderer, frame, settings, &error) &&
                  tl_renderer_read(*renderer, image, &error),
              error);
}

static void draw_white(struct stand *stand)
{
    tl_frame lit = stand->frame;
    struct tl_render_settings settings = stand->settings;
    stand->even = tl_environment_constant(1, 1, 1);
    lit.environment = &stand->even;
    lit.environment_revision = 1;
    draw(stand, &stand->white_shadowed, &lit, &settings, &stand->white_shadowed_image);
    settings.light.method = TL_METHOD_UNSHADOWED;
    draw(stand, &stand->white, &lit, &settings, &stand->white_image);
    stand->checked.white = stand->white;
    stand->checked.white_image = &stand->white_image;
    stand->checked.white_shadowed = &stand->white_shadowed_image;
}

static struct tl_render_settings settings_of(const char *const *assignments, size_t count)
{
    struct tl_settings settings;
    tl_error error = {0};
    const struct tl_settings_source source = {.assignments = assignments, .assignment_count = count};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    settings.image.width = WIDTH;
    settings.image.height = HEIGHT;
    settings.image.supersample = 1;
    settings.image.ground = false;
    settings.light.bounce = TL_BOUNCE_OFF; /* the ordinary extreme reflects more light than it receives */
    return tl_settings_render(&settings);
}

static const struct tl_extreme ordinary = {.name = "ordinary"};

static struct stand *stand_up(const char *const *assignments, size_t count)
{
    struct stand *stand = TL_NEW(struct stand);
    tl_error error = {0};
    stand->gpu = tl_gpu_create_headless(&error);
    assert_ok(stand->gpu != NULL, error);
    assert_ok(tl_extreme_scene_make(&ordinary, &stand->scene, &error), error);
    tl_mesh *mesh = &stand->scene.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    stand->frames = tl_tangent_frames_create(mesh, weld);
    free(weld);
    tl_tangent_frames_update(stand->frames, mesh->positions, mesh->normals, mesh->tangents);
    stand->settings = settings_of(assignments, count);
    stand->frame = tl_extreme_frame(&stand->scene);
    draw(stand, &stand->renderer, &stand->frame, &stand->settings, &stand->image);
    draw(stand, &stand->fresh, &stand->frame, &stand->settings, &stand->fresh_image);
    stand->checked = (struct tl_checked){.number = 7,
                                         .frame = &stand->frame,
                                         .settings = &stand->settings,
                                         .renderer = stand->renderer,
                                         .image = &stand->image,
                                         .is_sampled = true,
                                         .is_reduced = true,
                                         .fresh = &stand->fresh_image,
                                         .hash = tl_check_hash(&stand->frame, &stand->image)};
    stand->checked.first_hash = stand->checked.hash;
    return stand;
}

/* The stand's image is compared with the reference too: most of a check's time, which other rows do not need.
 */
static void trace_reference(struct stand *stand)
{
    stand->checked.is_reduced = false;
}

static void take_down(struct stand **handle)
{
    struct stand *stand = *handle;
    tl_image *images[] = {&stand->image, &stand->fresh_image, &stand->white_image,
                          &stand->white_shadowed_image};
    for (size_t i = 0; i < TL_COUNT(images); i++)
        tl_image_release(images[i]);
    tl_renderer_destroy(&stand->renderer);
    tl_renderer_destroy(&stand->fresh);
    tl_renderer_destroy(&stand->white);
    tl_renderer_destroy(&stand->white_shadowed);
    tl_environment_release(&stand->even);
    tl_tangent_frames_destroy(&stand->frames);
    tl_extreme_scene_release(&stand->scene);
    tl_gpu_destroy(&stand->gpu);
    free(stand);
    *handle = NULL;
}

static const char *const paper[] = {"scene.preset=paper", "light.regions=24", "light.map_size=128",
                                    "light.pem_size=32"};
static const char *const slices[] = {
    "light.visibility=depth", "light.prefilter=slices", "light.composition=difference",
    "light.regions=24",       "light.pem_size=32",      "light.map_size=256",
    "light.jitter=false"};

static struct stand *by_rays(void)
{
    static const char *const fewer[] = {"light.regions=96", "light.refresh=24", "light.pem_size=32"};
    return stand_up(fewer, TL_COUNT(fewer));
}

static struct stand *by_chains(void)
{
    return stand_up(paper, TL_COUNT(paper));
}

static struct stand *by_paraboloids(void)
{
    static const char *const settings[] = {"scene.preset=paper", "light.regions=24", "light.map_size=128",
                                           "light.pem_size=32", "light.pem_layout=paraboloid"};
    return stand_up(settings, TL_COUNT(settings));
}

static struct stand *by_slices(void)
{
    return stand_up(slices, TL_COUNT(slices));
}

/* ---- What is found ---- */

static void assert_measured(const struct tl_checked *checked, const char *const *names, size_t count)
{
    struct tl_verdicts verdicts = {0};
    tl_check_frame(checked, &verdicts, NULL);
    for (size_t i = 0; i < count; i++)
        if (!verdicts.items[row_of(names[i])].finding.is_measured)
            fail_msg("%s is not measured", names[i]);
}

static void a_clean_frame_passes(void **state)
{
    (void)state;
    static const char *const always[] = {
        "surface.finite",    "surface.handed", "image.finite",   "image.fresh",      "image.oracle",
        "light.environment", "light.regions",  "furnace.albedo", "furnace.shadowed", "run.repeat"};
    static const char *const rays[] = {"visibility.range", "visibility.regions", "light.exact", "light.sum"};
    static const char *const chains[] = {"maps.moments", "light.pems"};
    static const char *const exact[] = {"maps.moments", "light.slices", "light.sum", "light.exact"};
    stand_maker *const stands[] = {by_rays, by_chains, by_paraboloids, by_slices};
    const char *const *const own[] = {rays, chains, chains, exact};
    const size_t counts[] = {TL_COUNT(rays), TL_COUNT(chains), TL_COUNT(chains), TL_COUNT(exact)};
    for (size_t i = 0; i < TL_COUNT(stands); i++) {
        struct stand *stand = stands[i]();
        trace_reference(stand);
        draw_white(stand);
        assert_clean(&stand->checked);
        assert_measured(&stand->checked, always, TL_COUNT(always));
        assert_measured(&stand->checked, own[i], counts[i]);
        take_down(&stand);
    }
}

/* ---- Geometry: a copied surface is corrupted ---- */

struct copy {
    tl_surface surface;
    vec3s *positions, *normals;
    vec4s *tangents;
    tl_frame frame;
    struct tl_checked checked;
};

static void *copied(const void *from, size_t count, size_t size)
{
    void *to = tl_alloc(count, size);
    memcpy(to, from, count * size);
    return to;
}

static struct copy *copy_of(const struct stand *stand)
{
    struct copy *copy = TL_NEW(struct copy);
    copy->surface = stand->scene.surface;
    size_t count = copy->surface.vertex_count;
    copy->surface.positions = copy->positions = copied(copy->surface.positions, count, sizeof(vec3s));
    copy->surface.normals = copy->normals = copied(copy->surface.normals, count, sizeof(vec3s));
    copy->surface.tangents = copy->tangents = copied(copy->surface.tangents, count, sizeof(vec4s));
    copy->frame = stand->frame;
    copy->frame.surfaces = &copy->surface;
    copy->checked = stand->checked;
    copy->checked.frame = &copy->frame;
    return copy;
}

static void release_copy(struct copy *copy)
{
    free(copy->positions);
    free(copy->normals);
    free(copy->tangents);
    free(copy);
}

/* In the middle of the curtain. */
enum { VERTEX = 20 * 41 + 17 };
#define PLACE "vertex 837"

static void break_surface(const struct stand *stand, void (*fault)(struct copy *copy), const char *name)
{
    struct copy *copy = copy_of(stand);
    copy->checked.image = NULL; /* geometry is checked before it is drawn */
    assert_clean(&copy->checked);
    fault(copy);
    assert_breaks(&copy->checked, name, PLACE);
    release_copy(copy);
}

static void nan_position(struct copy *copy)
{
    copy->positions[VERTEX].y = NAN;
}

static void infinite_tangent(struct copy *copy)
{
    copy->tangents[VERTEX].z = INFINITY;
}

static void flipped_normal(struct copy *copy)
{
    copy->normals[VERTEX] = glms_vec3_negate(copy->normals[VERTEX]);
}

static void turned_normal(struct copy *copy)
{
    vec4s tangent = copy->tangents[VERTEX];
    vec3s along = {{tangent.x, tangent.y, tangent.z}};
    copy->normals[VERTEX] = glms_vec3_rotate(copy->normals[VERTEX], glm_rad(5), along);
}

/* They are not means of the faces, and need not be. */
static void turned_normals_of_a_file_pass(const struct stand *stand)
{
    struct copy *copy = copy_of(stand);
    copy->checked.image = NULL;
    copy->surface.has_own_normals = true;
    turned_normal(copy);
    assert_clean(&copy->checked);
    release_copy(copy);
}

static void long_normal(struct copy *copy)
{
    copy->normals[VERTEX] = glms_vec3_scale(copy->normals[VERTEX], 1.001f);
}

static void skewed_tangent(struct copy *copy)
{
    copy->tangents[VERTEX].x += 0.01f;
}

static void other_handedness(struct copy *copy)
{
    copy->tangents[VERTEX].w = -copy->tangents[VERTEX].w;
}

static void flipped_tangent(struct copy *copy)
{
    for (int c = 0; c < 3; c++)
        copy->tangents[VERTEX].raw[c] = -copy->tangents[VERTEX].raw[c];
}

/* As a mirrored mesh whose frames were forgotten: the normal, and what is left of the frame with it. */
static void flipped_frame(struct copy *copy)
{
    flipped_normal(copy);
    other_handedness(copy);
}

static void faults_of_geometry_are_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    break_surface(stand, nan_position, "surface.finite");
    break_surface(stand, infinite_tangent, "surface.finite");
    break_surface(stand, flipped_normal, "surface.sides");
    break_surface(stand, turned_normal, "surface.sides");
    turned_normals_of_a_file_pass(stand);
    break_surface(stand, long_normal, "surface.normals");
    break_surface(stand, skewed_tangent, "surface.tangents");
    break_surface(stand, other_handedness, "surface.handed");
    break_surface(stand, flipped_tangent, "surface.handed");
    break_surface(stand, flipped_frame, "surface.sides");
    break_surface(stand, flipped_frame, "surface.handed");
    take_down(&stand);
}

/* ---- Pixels ---- */

static void faults_of_pixels_are_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    float *pixel = tl_image_floats(&stand->image) + PIXEL_40_30, kept = pixel[1];
    pixel[1] = NAN;
    assert_breaks(&stand->checked, "image.finite", "pixel 40, 30");
    pixel[1] = -1e-3f;
    assert_breaks(&stand->checked, "image.negative", "pixel 40, 30");
    pixel[1] = kept;
    kept = pixel[3];
    pixel[3] = 1.01f;
    assert_breaks(&stand->checked, "image.coverage", "pixel 40, 30");
    pixel[3] = NAN;
    assert_breaks(&stand->checked, "image.coverage", "pixel 40, 30");
    pixel[3] = kept;
    assert_clean(&stand->checked);

    /* The same frame again, one bit aside. */
    uint32_t *bits = (uint32_t *)stand->image.texels + PIXEL_40_30;
    *bits ^= 1;
    stand->checked.hash = tl_check_hash(&stand->frame, &stand->image);
    assert_breaks(&stand->checked, "run.repeat", "in pixels only");
    stand->checked.positions_hash++;
    assert_breaks(&stand->checked, "run.repeat", "in positions");
    take_down(&stand);
}

/* Scales a square of pixels. */
static void scale_square(const struct stand *stand, int left, int top, int side, float factor)
{
    for (int y = top; y < top + side; y++)
        for (int x = left; x < left + side; x++)
            for (int c = 0; c < 3; c++)
                tl_image_floats(&stand->image)[4 * (y * WIDTH + x) + c] *= factor;
}

/* Wherever it lies: a patch is found in all of the picture. */
static void patches_are_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    const size_t bytes = (size_t)WIDTH * HEIGHT * 4 * sizeof(float);
    trace_reference(stand);
    float *kept = copied(stand->image.texels, 1, bytes);
    scale_square(stand, 40, 28, 8, 0.1f);
    assert_breaks(&stand->checked, "image.patch", "pixel 44, 32");
    memcpy(stand->image.texels, kept, bytes);
    scale_square(stand, 40, 28, 8, 3);
    assert_breaks(&stand->checked, "image.patch", "pixel 44, 32");
    memcpy(stand->image.texels, kept, bytes);
    scale_square(stand, 40, 28, 5, 10);
    assert_breaks(&stand->checked, "image.tile", "pixel 42, 30");
    memcpy(stand->image.texels, kept, bytes);
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
        tl_image_floats(&stand->image)[i] *= i % 4 == 2 ? 0.9f : 1;
    assert_breaks(&stand->checked, "image.mean", "");
    memcpy(stand->image.texels, kept, bytes);

    /* As a budget draws it. */
    stand->checked.in_motion = &stand->fresh_image;
    assert_clean(&stand->checked);
    tl_image *drawn = &stand->fresh_image;
    for (int y = 28; y < 36; y++)
        memset(tl_image_floats(drawn) + 4 * ((ptrdiff_t)y * WIDTH + 40), 0, sizeof(float[8][4]));
    assert_breaks(&stand->checked, "image.patch", "pixel 44, 32");
    free(kept);
    take_down(&stand);
}

/* Each pixel becomes the mean of itself and another one: the image moves away from that by half of the way.
 */
static void blend_with(const struct stand *stand, int right, int down)
{
    float *pixels = tl_image_floats(&stand->image);
    for (int y = 0; y + down < HEIGHT; y++)
        for (int x = 0; x + right < WIDTH; x++)
            for (int c = 0; c < 4; c++)
                pixels[4 * (y * WIDTH + x) + c] = 0.5f * (pixels[4 * (y * WIDTH + x) + c] +
                                                          pixels[4 * ((y + down) * WIDTH + x + right) + c]);
}

static void outlines_that_are_displaced_are_named(void **state)
{
    (void)state;
    for (int down = 0; down < 2; down++) {
        struct stand *stand = by_rays();
        trace_reference(stand);
        blend_with(stand, !down, down);
        struct tl_verdict verdict = verdict_on(&stand->checked, "image.place");
        float right, below;
        assert_false(verdict.ok);
        assert_int_equal(sscanf(verdict.finding.place, "%f to the right, %f down", &right, &below), 2);
        assert_near(down ? below : right, -0.4, 0.15);
        assert_near(down ? right : below, 0, 0.1);
        take_down(&stand);
    }
}

static void a_plan_over_budget_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    struct tl_checked checked = stand->checked;
    checked.budget_ms = 33;
    checked.predicted_ms = 32;
    assert_clean(&checked);
    checked.predicted_ms = 35;
    assert_breaks(&checked, "plan.budget", "35.0 ms of 33.0");
    checked.min_ms = 36; /* no plan is cheaper */
    assert_clean(&checked);
    take_down(&stand);
}

/* Removes const: tests corrupt data that a renderer only lends. */
static void *writable(const void *lent)
{
    void *pointer;
    memcpy(&pointer, &lent, sizeof pointer);
    return pointer;
}

/* A renderer's resources, writable. */
static struct tl_resources *inside(const tl_renderer *renderer)
{
    return writable(tl_renderer_frame_resources(renderer));
}

/* ---- Shadows ---- */

/* The region of which least is seen on average over the samples, among those that have their share of light.
 */
static int max_hidden_region(const struct tl_resources *made)
{
    size_t stride;
    const uint16_t *values = tl_points_values(made->points, &stride);
    const struct tl_taps *taps = tl_points_taps(made->points);
    int hidden = 0;
    double minimum = INFINITY, light = 0;
    for (int i = 0; i < made->regions.count; i++)
        light += (double)made->regions.items[i].importance / made->regions.count;
    for (int i = 0; i < made->regions.count; i++) {
        if ((double)made->regions.items[i].importance < light)
            continue;
        double sum = 0;
        size_t facing = 0;
        for (size_t s = 0; s < made->samples.primary_count; s++) {
            float cosine = glms_vec3_dot(made->samples.items[s].smooth, made->regions.items[i].direction);
            if (cosine < 0.3f)
                continue;
            facing++;
            sum += values[taps[s].point[0] * stride + (size_t)i];
        }
        if (facing < made->samples.primary_count / 3 || !(sum / (double)facing < minimum))
            continue;
        minimum = sum / (double)facing;
        hidden = i;
    }
    return hidden;
}

/* Sets the cached visibility of one region to 1 at all points. */
static void leak(const struct tl_resources *made, int region)
{
    size_t stride;
    uint16_t *values = writable(tl_points_values(made->points, &stride));
    size_t points = tl_points_report(made->points).points;
    for (size_t p = 0; p < points; p++)
        values[p * stride + (size_t)region] = UINT16_MAX;
}

static void a_leaking_shadow_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    int region = max_hidden_region(inside(stand->renderer));
    char place[32];
    snprintf(place, sizeof place, "region %d:", region);
    leak(inside(stand->renderer), region);
    assert_breaks(&stand->checked, "visibility.regions", place);
    take_down(&stand);

    /* All of them leak: the picture itself shows it. */
    stand_maker *const stands[] = {by_rays, by_slices};
    for (size_t i = 0; i < TL_COUNT(stands); i++) {
        stand = stands[i]();
        trace_reference(stand);
        struct tl_render_settings settings = stand->settings;
        settings.light.method = TL_METHOD_UNSHADOWED;
        tl_renderer *leaking = NULL;
        draw(stand, &leaking, &stand->frame, &settings, &stand->image);
        assert_breaks(&stand->checked, "image.oracle", "pixel");
        assert_breaks(&stand->checked, "image.fresh", "pixel");
        tl_renderer_destroy(&leaking);
        take_down(&stand);
    }
}

static void visibility_out_of_range_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    struct tl_taps *taps = writable(tl_points_taps(inside(stand->renderer)->points));
    struct tl_taps kept = taps[5];
    taps[5].weight[0] += 0.1f;
    assert_breaks(&stand->checked, "visibility.range", "sample");
    taps[5] = kept;
    taps[5].weight[2] = NAN;
    assert_breaks(&stand->checked, "visibility.range", "sample");
    taps[5] = kept;
    assert_clean(&stand->checked);
    take_down(&stand);
}

static void moments_that_cannot_be_are_named(void **state)
{
    (void)state;
    struct stand *stand = by_chains();
    unsigned texture = tl_shadow_maps_texture(inside(stand->renderer)->maps, 0);
    const float less[2] = {0.5f, 0.245f}, none[2] = {NAN, 1};
    glTextureSubImage3D(texture, 0, 30, 20, 3, 1, 1, 1, GL_RG, GL_FLOAT, less);
    assert_breaks(&stand->checked, "maps.moments", "map of region 3, texel 30, 20");
    glTextureSubImage3D(texture, 0, 30, 20, 3, 1, 1, 1, GL_RG, GL_FLOAT, none);
    assert_breaks(&stand->checked, "maps.moments", "map of region 3, texel 30, 20");
    take_down(&stand);
}

/* The curtain swings out by 15 cm. */
static void move_curtain(struct stand *stand)
{
    tl_mesh *mesh = &stand->scene.mesh;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->positions[v].y > 0.01f)
            mesh->positions[v].z += 0.15f * (1 - mesh->positions[v].y);
    tl_tangent_frames_update(stand->frames, mesh->positions, mesh->normals, mesh->tangents);
}

/* One region is renewed in a frame where 24 of 96 should be. */
static void visibility_that_is_not_renewed_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    struct tl_render_settings slower = stand->settings;
    slower.light.refresh = 1;
    for (int i = 0; i < 12 + 24; i++) {
        stand->scene.mesh.positions[VERTEX].z += 1e-4f;
        stand->scene.surface.motion_revision += 1000;
        draw(stand, &stand->renderer, &stand->frame, i < 12 ? &stand->settings : &slower, &stand->image);
        if (i == 11)
            assert_true(verdict_on(&stand->checked, "visibility.age").finding.is_measured &&
                        verdict_on(&stand->checked, "visibility.age").ok);
    }
    assert_breaks(&stand->checked, "visibility.age", "older than 16 frames");
    take_down(&stand);
}

/* The back-end's bound is what tells stale from fresh. */
static void a_stale_map_is_named(void **state)
{
    (void)state;
    stand_maker *const stands[] = {by_rays, by_chains, by_slices};
    for (size_t i = 0; i < TL_COUNT(stands); i++) {
        struct stand *stand = stands[i]();
        move_curtain(stand);
        stand->scene.surface.motion_revision += 1000;
        assert_ok(tl_renderer_forget_scene(stand->fresh, &(tl_error){0}), (tl_error){0});
        draw(stand, &stand->fresh, &stand->frame, &stand->settings, &stand->fresh_image);
        /* Told that something moved, the renderer follows ... */
        tl_renderer *old_maps = stand->renderer;
        stand->renderer = NULL;
        draw(stand, &stand->renderer, &stand->frame, &stand->settings, &stand->image);
        stand->checked.renderer = stand->renderer;
        assert_clean(&(struct tl_checked){.number = 7,
                                          .frame = &stand->frame,
                                          .settings = &stand->settings,
                                          .renderer = stand->renderer,
                                          .image = &stand->image,
                                          .is_sampled = true,
                                          .fresh = &stand->fresh_image});
        /* ... but the shadows of the frame before are not what it calls for. */
        struct tl_resources *made = inside(stand->renderer);
        tl_shadow_maps *maps = made->maps;
        tl_points *points = made->points;
        made->maps = inside(old_maps)->maps;
        made->points = inside(old_maps)->points;
        made->valid &= ~(TL_BIT(TL_MADE_LIGHT) | TL_BIT(TL_MADE_IMAGE));
        if (i > 0) { /* rays: what is kept survives a frame by design, and is bounded by its age */
            draw(stand, &stand->renderer, &stand->frame, &stand->settings, &stand->image);
            assert_breaks(&stand->checked, "image.fresh", "pixel");
        }
        made->maps = maps;
        made->points = points;
        tl_renderer_destroy(&old_maps);
        take_down(&stand);
    }
}

/* Nobody told that anything moved, so that the whole picture is old. */
static void a_skipped_update_is_named(void **state)
{
    (void)state;
    stand_maker *const stands[] = {by_rays, by_chains, by_slices};
    for (size_t i = 0; i < TL_COUNT(stands); i++) {
        struct stand *stand = stands[i]();
        move_curtain(stand);
        draw(stand, &stand->renderer, &stand->frame, &stand->settings, &stand->image);
        assert_ok(tl_renderer_forget_scene(stand->fresh, &(tl_error){0}), (tl_error){0});
        draw(stand, &stand->fresh, &stand->frame, &stand->settings, &stand->fresh_image);
        assert_breaks(&stand->checked, "image.fresh", "pixel");
        take_down(&stand);
    }
}

/* ---- Light ---- */

static void lost_light_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    struct tl_resources *made = inside(stand->renderer);
    vec3s power = made->regions.items[40].power;
    made->regions.items[40].power = (vec3s){{0, 0, 0}};
    assert_breaks(&stand->checked, "light.regions", "");
    made->regions.items[40].power = glms_vec3_scale(power, 2);
    assert_breaks(&stand->checked, "light.regions", "");
    made->regions.items[40].power = power;

    float *lane = writable(&made->lights->groups[2].power[1][8]), kept = *lane;
    *lane = 0;
    assert_breaks(&stand->checked, "light.regions", "green");
    *lane = kept;
    assert_clean(&stand->checked);

    const struct tl_lobe_map *map = &made->lights->diffuse_gain.maps[0];
    for (int i = 0; i < (map->side + 2) * (map->side + 2) * 4; i++)
        map->texels[i] *= 1.05f;
    assert_breaks(&stand->checked, "light.sum", "s = 1 ");
    map = &made->exact.lobes->maps[0];
    for (int i = 0; i < (map->side + 2) * (map->side + 2) * 4; i++)
        map->texels[i] *= 1.05f;
    assert_breaks(&stand->checked, "light.exact", "s = 1 ");
    for (int i = 0; i < 6 * made->cube.size * made->cube.size * 3; i++)
        made->cube.texels[i] *= 1.02f;
    assert_breaks(&stand->checked, "light.environment", "");
    take_down(&stand);
}

static void a_lost_region_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_chains();
    const tl_texture *array = &inside(stand->renderer)->pems.arrays[0];
    const float black[4] = {0};
    for (int level = 0; level < array->levels; level++)
        glClearTexSubImage(array->id, level, 0, 0, 6 * 5, array->width >> level, array->width >> level, 6,
                           GL_RGBA, GL_FLOAT, black); /* region 5 */
    assert_breaks(&stand->checked, "light.pems", "level");
    take_down(&stand);

    stand = by_paraboloids();
    const struct tl_pems *pems = &inside(stand->renderer)->pems;
    for (int chart = 0; chart < TL_PARABOLOID_CHARTS; chart++) {
        const struct tl_paraboloid_crop *crop = &pems->paraboloids[5].crops[1][chart];
        glClearTexSubImage(pems->arrays[0].id, 0, crop->atlas_x, crop->atlas_y, 0, crop->width, crop->height,
                           1, GL_RGBA, GL_FLOAT, black);
    }
    assert_breaks(&stand->checked, "light.pems", "level 1");
    take_down(&stand);

    stand = by_slices();
    struct tl_slices *made = &inside(stand->renderer)->slices.slices;
    size_t texels = (size_t)made->side[0] * (size_t)made->side[0] * 3;
    memset(made->texels[0] + 5 * texels, 0, texels * sizeof(float));
    assert_breaks(&stand->checked, "light.slices", "region 5 of 24");
    take_down(&stand);
}

static void a_furnace_that_glows_is_named(void **state)
{
    (void)state;
    struct stand *stand = by_rays();
    draw_white(stand);
    float *pixel = tl_image_floats(&stand->white_image) + PIXEL_40_30, kept = *pixel;
    *pixel *= 1.03f;
    assert_breaks(&stand->checked, "furnace.albedo", "pixel 40, 30");
    *pixel = kept;
    pixel = tl_image_floats(&stand->white_shadowed_image) + PIXEL_40_30;
    *pixel = 1.03f * kept;
    assert_breaks(&stand->checked, "furnace.shadowed", "pixel 40, 30");
    take_down(&stand);
}

/* A deviation that the general bound allows breaks the bound of a scene whose clean run had a smaller one. */
static void a_baseline_tightens_bounds(void **state)
{
    (void)state;
    const size_t row = row_of("image.tile");
    struct tl_check_baseline baseline = {0};
    for (size_t i = 0; i < TL_INVARIANTS_MAX; i++)
        baseline.worst[i] = NAN;
    assert_near(tl_check_bound(&baseline, row, 1.5), 1.5, 1e-9);
    baseline.worst[row] = 0.1;
    assert_near(tl_check_bound(&baseline, row, 1.5), 0.3, 1e-9);
    baseline.worst[row] = 1.4;
    assert_near(tl_check_bound(&baseline, row, 1.5), 1.5, 1e-9);

    struct stand *stand = by_rays();
    struct tl_verdicts verdicts = {.baseline = &baseline};
    trace_reference(stand);
    baseline.worst[row] = 0.05;
    scale_square(stand, 40, 28, 5, 1.6f);
    assert_true(verdict_on(&stand->checked, "image.tile").ok);
    tl_check_frame(&stand->checked, &verdicts, NULL);
    assert_false(verdicts.items[row].ok);
    take_down(&stand);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clean_frame_passes),
        cmocka_unit_test(faults_of_geometry_are_named),
        cmocka_unit_test(faults_of_pixels_are_named),
        cmocka_unit_test(patches_are_named),
        cmocka_unit_test(outlines_that_are_displaced_are_named),
        cmocka_unit_test(a_plan_over_budget_is_named),
        cmocka_unit_test(a_baseline_tightens_bounds),
        cmocka_unit_test(a_leaking_shadow_is_named),
        cmocka_unit_test(visibility_out_of_range_is_named),
        cmocka_unit_test(moments_that_cannot_be_are_named),
        cmocka_unit_test(visibility_that_is_not_renewed_is_named),
        cmocka_unit_test(a_stale_map_is_named),
        cmocka_unit_test(a_skipped_update_is_named),
        cmocka_unit_test(lost_light_is_named),
        cmocka_unit_test(a_lost_region_is_named),
        cmocka_unit_test(a_furnace_that_glows_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
