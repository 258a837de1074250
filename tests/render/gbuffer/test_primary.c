/* The ID buffer by rays against the one of the raster, for a dressed figure on the ground: where they differ,
 * an edge runs within the raster's grid of the pixel's middle, or two plies lie closer than depths resolve.
 * Faults put into the shader are found. */
#include "render/gbuffer/primary.h"

#include "assets/body/form.h"
#include "assets/cut/garment_cut.h"
#include "config/base/memory.h"
#include "render/gbuffer/depth_terms.glsl"
#include "render/gbuffer/raster.h"
#include "render/gbuffer/samples.h"
#include "render/surfaces/ground.h"
#include "tests/render/tree_rays.h"

#include <epoxy/gl.h>

#include "tests/testing.h"

enum { WIDTH = 220, HEIGHT = 190, PIXELS = WIDTH * HEIGHT };

struct dressed {
    tl_garment garment;
    tl_avatar form;
    struct tl_ground ground;
    tl_surface surfaces[2];
    const tl_surface *drawn[3];
    struct flat_mesh mesh;
    struct tl_raster raster;
};

static struct dressed *shared; /* by all tests */

static struct dressed *open_dressed(void)
{
    tl_error error = {0};
    struct tl_casters casters;
    struct dressed *dressed = TL_NEW(struct dressed);
    assert_ok(tl_garment_cut("dress", 0.02f, &dressed->garment, &error), error);
    dressed->form = tl_avatar_form();
    const tl_model *models[] = {&dressed->garment.model, &dressed->form.model};
    for (int s = 0; s < 2; s++) {
        dressed->surfaces[s] =
            tl_surface_of_mesh(s == 0 ? "garment" : "avatar", &models[s]->mesh, models[s]->materials);
        dressed->drawn[s] = &dressed->surfaces[s];
    }
    assert_ok(tl_casters_measure(dressed->surfaces, 2, &casters, &error), error);
    tl_ground_make(&casters, TL_GROUND_GREY, &dressed->ground);
    dressed->drawn[2] = &dressed->ground.surface;
    dressed->mesh = flat_mesh_join(dressed->drawn, 3);
    dressed->mesh.other_count = TL_GROUND_INDICES / 3;
    return dressed;
}

static void close_dressed(struct dressed *dressed)
{
    tl_garment_release(&dressed->garment);
    tl_avatar_release(&dressed->form);
    flat_mesh_release(&dressed->mesh);
    tl_raster_release(&dressed->raster);
    free(dressed);
}

/* Corners are moved to a grid of 1/256 pixel: by half of it each way. */
#define GRID_PIXELS (1.5 / 512)
/* Depths are rounded, and those of backs moved away. */
#define DEPTH_STEP ((double)DEPTH_OF_BACKS + 2 * (double)DEPTH_ROUNDING)

/* A pixel's middle in a triangle as it is projected, in doubles. */
struct projected {
    bool is_doubtful; /* an edge is too near, or a corner not before the eye */
    bool is_inside;
    double depth; /* of the plane there */
};

static struct projected project(const struct dressed *dressed, const struct tl_view *view, uint32_t triangle,
                                int x, int y)
{
    struct projected result = {.is_inside = true};
    double at[3][3], area[3];
    for (int k = 0; k < 3; k++) {
        const vec3s p = dressed->mesh.positions[dressed->mesh.corners[3 * (size_t)triangle + (size_t)k]];
        double clip[4];
        for (int row = 0; row < 4; row++) {
            clip[row] = (double)view->view_projection.raw[3][row];
            for (int axis = 0; axis < 3; axis++)
                clip[row] += (double)view->view_projection.raw[axis][row] * (double)p.raw[axis];
        }
        if (!(clip[3] > 1e-4))
            return (struct projected){.is_doubtful = true};
        at[k][0] = (clip[0] / clip[3] + 1) * WIDTH / 2 - (x + 0.5);
        at[k][1] = (clip[1] / clip[3] + 1) * HEIGHT / 2 - (y + 0.5);
        at[k][2] = clip[2] / clip[3] / 2 + 0.5;
    }
    for (int k = 0; k < 3; k++) {
        const double *a = at[(k + 1) % 3], *b = at[(k + 2) % 3];
        const double along[2] = {b[0] - a[0], b[1] - a[1]},
                     square = along[0] * along[0] + along[1] * along[1];
        const double t = fmin(fmax(-(a[0] * along[0] + a[1] * along[1]) / square, 0), 1);
        result.is_doubtful |= hypot(a[0] + t * along[0], a[1] + t * along[1]) < GRID_PIXELS;
        area[k] = a[0] * b[1] - a[1] * b[0];
    }
    const double sum = area[0] + area[1] + area[2];
    for (int k = 0; k < 3; k++) {
        result.is_inside &= area[k] / sum >= 0;
        result.depth += area[k] / sum * at[k][2];
    }
    double across = 0, up = 0; /* depth by pixel */
    for (int k = 0; k < 3; k++) {
        across += at[k][2] * (at[(k + 1) % 3][1] - at[(k + 2) % 3][1]) / sum;
        up += at[k][2] * (at[(k + 2) % 3][0] - at[(k + 1) % 3][0]) / sum;
    }
    /* The near plane cuts it here: that is an edge, too. */
    result.is_doubtful |= fabs(result.depth) < DEPTH_STEP + GRID_PIXELS * hypot(across, up);
    return result;
}

/* Whether both IDs may be seen in a pixel. */
static bool may_be_either(const struct dressed *dressed, const struct tl_view *view, uint32_t a, uint32_t b,
                          int x, int y)
{
    const uint32_t ids[2] = {a, b};
    struct projected seen[2] = {{0}};
    if (((a ^ b) & ~TL_SAMPLE_BACK) == 0) /* one triangle has one side there */
        return false;
    for (int i = 0; i < 2; i++)
        if (ids[i])
            seen[i] = project(dressed, view, (ids[i] & ~TL_SAMPLE_BACK) - 1, x, y);
    return seen[0].is_doubtful || seen[1].is_doubtful ||
           (seen[0].is_inside && seen[1].is_inside && fabs(seen[0].depth - seen[1].depth) < DEPTH_STEP);
}

struct differences {
    size_t covered, explained, wrong;
};

static struct differences compare(struct card *card, struct tl_primary *primary, struct dressed *dressed,
                                  const struct tl_view *view)
{
    static uint32_t by_rays[PIXELS], by_raster[PIXELS];
    struct differences result = {0};
    tl_error error = {0};
    tl_texture ids = tl_texture_create(card->gpu, GL_TEXTURE_2D, GL_R32UI, WIDTH, HEIGHT, 1, 1);
    const struct tl_primary_request request = {.tree = &card->tree, .view = view, .ids = &ids};
    const struct tl_raster_request drawn = {.surfaces = dressed->drawn,
                                            .surface_count = 3,
                                            .view_projection = view->view_projection,
                                            .width = WIDTH,
                                            .height = HEIGHT};
    assert_ok(tl_primary_trace(primary, card->gpu, &request, &error), error);
    tl_gpu_barrier();
    glGetTextureImage(ids.id, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof by_rays, by_rays);
    tl_raster_draw(&dressed->raster, &drawn, &(struct tl_raster_layers){.nearest = by_raster});
    for (int i = 0; i < PIXELS; i++) {
        result.covered += by_raster[i] != 0;
        if (by_rays[i] == by_raster[i])
            continue;
        if (may_be_either(dressed, view, by_rays[i], by_raster[i], i % WIDTH, i / WIDTH))
            result.explained++;
        else
            result.wrong++;
    }
    tl_texture_destroy(&ids);
    return result;
}

/* Views from afar; from near; from under the ground; with the near plane in the skirt; from within the dress. */
static const struct {
    vec3s eye, target;
    float near_m;
} cameras[] = {{{{2, 1.6f, 4}}, {{0, 0.9f, 0}}, 0.02f},
               {{{0.3f, 1.2f, 1}}, {{0, 1, 0}}, 0.02f},
               {{{1, -0.5f, 2}}, {{0, 0.5f, 0}}, 0.02f},
               {{{0, 0.7f, 1}}, {{0, 0.7f, 0}}, 0.85f},
               {{{0.02f, 1.1f, 0}}, {{0, 0, 0.1f}}, 0.005f}};

static struct tl_view view_of(size_t camera)
{
    return tl_view_make(&(struct tl_camera){.eye = cameras[camera].eye,
                                            .target = cameras[camera].target,
                                            .up = {{0, 1, 0}},
                                            .fov_y = 0.7f,
                                            .near_m = cameras[camera].near_m,
                                            .far_m = 50},
                        WIDTH, HEIGHT);
}

static void test_rays_see_what_the_raster_draws(void **state)
{
    struct dressed *dressed = shared;
    struct card card;
    struct tl_primary primary = {0};
    card_open(&card, *state, NULL, NULL);
    card_update(&card, &dressed->mesh);
    for (size_t i = 0; i < TL_COUNT(cameras); i++) {
        const struct tl_view view = view_of(i);
        const struct differences result = compare(&card, &primary, dressed, &view);
        print_message("view %zu: of %zu pixels %zu differ by an edge or a depth, %zu otherwise\n", i,
                      result.covered, result.explained, result.wrong);
        assert_true(result.covered > PIXELS / 5);
        assert_true(result.explained <= result.covered / 500);
        assert_int_equal(result.wrong, 0);
    }
    tl_primary_release(&primary);
    card_close(&card);
}

static void test_faults_are_found(void **state)
{
    static const struct card_edit faults[] = {
        {"primary.comp", "vec2(pixel) + 0.5", "vec2(pixel)"},
        {"primary.comp", "tree_seen", "tree_nearest"},
        {"primary.comp", "at.y * up, depths.x", "at.y * up, 0.0"},
        {"primary.comp", "hit.back ?", "!hit.back ?"},
        {"primary.comp", "hit.triangle + 1u", "hit.triangle"},
        {"primary.comp", "at.x * right", "1.001 * at.x * right"},
    };
    struct dressed *dressed = shared;
    struct card card;
    card_open(&card, *state, NULL, NULL);
    card_update(&card, &dressed->mesh);
    for (size_t f = 0; f < TL_COUNT(faults); f++) {
        const struct card_edit edits[CARD_EDITS_MAX] = {faults[f]};
        char *texts[CARD_EDITS_MAX] = {NULL};
        tl_error error = {0};
        struct tl_embedded *shaders = card_list_shaders(edits, texts);
        struct tl_primary primary = {0};
        size_t wrong = 0;
        assert_ok(tl_program_create_compute(*state, shaders, "primary.comp", NULL, &primary.program, &error),
                  error);
        for (size_t i = 0; i < TL_COUNT(cameras) && wrong == 0; i++) {
            const struct tl_view view = view_of(i);
            wrong += compare(&card, &primary, dressed, &view).wrong;
        }
        if (wrong == 0)
            print_error("a fault is not found: %s\n", faults[f].text);
        assert_true(wrong > 0);
        tl_primary_release(&primary);
        free(shaders);
        free(texts[0]);
    }
    card_close(&card);
}

static int open_all(void **state)
{
    if (card_gpu_open(state) != 0)
        return -1;
    shared = open_dressed();
    return 0;
}

static int close_all(void **state)
{
    close_dressed(shared);
    return card_gpu_close(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rays_see_what_the_raster_draws),
        cmocka_unit_test(test_faults_are_found),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
