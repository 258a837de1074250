/* The extremes of fabric detail: height fields and degenerate views, each seen by parallax and
 * relief. What is seen never lies farther off than twenty times the height [detail_slant], or than the height
 * itself where the shift is limited. The error is the distance along the cloth from what a fine march sees:
 * in mm, and as a share of the longest way of a ray between the mesh and the farthest height. Parallax and
 * relief of one step assume one height for all that way, and may err by all of it; relief of 256 steps by
 * half of it where one step passes dozens of texels. The remedy of all is relief of 1024 steps, which has to
 * keep the stated share. */
#include "config/base/memory.h"
#include "render/detail/cones.h"
#include "render/detail/detail_terms.h"
#include "render/detail/field.h"
#include "tests/app/stability/stability.h"

#include <math.h>

#define SIDE_M      0.01f
#define SHIFT_SLANT 20 /* 1 / 0.05 of detail_slant */
#define EXACT       0.01
#define ROUNDING_M  1e-8
#define ROUNDING    1e-5 /* of the height */
#define MARCH_STEPS 200000

static const struct detail_extreme {
    const char *name;
    int side;       /* texels */
    float height_m; /* of its bumps */
    bool rough;     /* from texel to texel; else flat */
    float mirrored; /* -1: u runs the other way */
} extremes[] = {
    {"ordinary bumps", 64, 1e-3f, true, 1}, {"mirrored UV", 64, 1e-3f, true, -1},
    {"heights times 0", 64, 0, true, 1},    {"heights times 100", 64, 0.1f, true, 1},
    {"one texel", 1, 1e-3f, false, 1},      {"flat, below the mesh", 16, -1e-3f, false, 1},
};
static const float tilts_deg[] = {0, 60, 89.9f, 90, 120, 180};
static const int steps[] = {1, 256, 1024};
#define REMEDY "detail.mode=relief detail.steps=1024"

static tl_image make_heights(const struct detail_extreme *extreme)
{
    tl_image heights = tl_image_create(extreme->side, extreme->side, 1, TL_IMAGE_F32);
    for (int i = 0; i < extreme->side * extreme->side; i++) {
        float noise = (float)((uint32_t)i * 2654435761u >> 8) / (float)(1 << 24);
        tl_image_floats(&heights)[i] = extreme->height_m * (extreme->rough ? noise : 1);
    }
    return heights;
}

struct detail_cell {
    enum tl_outcome outcome;
    struct tl_cell_error error;
    double moved_m, bound_m;
};

/* One view of a field, and what is right for it. */
struct detail_view {
    const struct detail_extreme *extreme;
    float tilt_deg;
    vec2s uv, right;
    double way_m; /* the longest of a ray */
};

static double distance_m(vec2s from, vec2s to)
{
    return (double)(SIDE_M * hypotf(to.x - from.x, to.y - from.y));
}

/* `maximum`: the share up to which the cell may be coarse. Limited parallax may move by the height alone. */
static struct detail_cell judge(const struct detail_view *view, vec2s to, float lit, double bound_m,
                                double maximum)
{
    struct detail_cell cell = {.moved_m = distance_m(view->uv, to), .bound_m = bound_m};
    double off_m = distance_m(view->right, to);
    cell.error = (struct tl_cell_error){
        .share =
            off_m <= ROUNDING_M + ROUNDING * fabs((double)view->extreme->height_m) ? 0 : off_m / view->way_m,
        .own = 1e3 * off_m,
        .unit = "mm"};
    cell.outcome =
        isfinite(lit) && isfinite(off_m) ? tl_outcome_of(cell.error.share, EXACT, maximum) : TL_OUTCOME_NAN;
    if (!(cell.moved_m <= bound_m * 1.001 + ROUNDING_M && lit >= 0 && lit <= 1) &&
        cell.outcome != TL_OUTCOME_NAN)
        cell.outcome = TL_OUTCOME_SILENT;
    return cell;
}

static void add(const struct detail_view *view, const char *way, const struct detail_cell *cell,
                struct tl_stability *out)
{
    const char *name = view->extreme->name;
    cJSON *row = tl_stability_add(out, "detail", cell->outcome, &cell->error);
    cJSON_AddStringToObject(row, "extreme", name);
    cJSON_AddStringToObject(row, "method", way);
    cJSON_AddNumberToObject(row, "tilt_deg", (double)view->tilt_deg);
    cJSON_AddNumberToObject(row, "moved_m", isfinite(cell->moved_m) ? cell->moved_m : -1);
    cJSON_AddNumberToObject(row, "bound_m", cell->bound_m);
    if (cell->outcome == TL_OUTCOME_COARSE)
        cJSON_AddStringToObject(row, "remedy", REMEDY);
}

static void run_view(const struct detail_extreme *extreme, const struct tl_height_field *field,
                     float tilt_deg, struct tl_stability *out)
{
    static const char *const relief_names[] = {"relief, 1 step", "relief, 256 steps", "relief, 1024 steps"};
    static const double relief_max[] = {1, 0.5, TL_STATED_SHARE};
    const vec3s towards = {
        {0.6f * sinf(glm_rad(tilt_deg)), 0.8f * sinf(glm_rad(tilt_deg)), cosf(glm_rad(tilt_deg))}};
    struct detail_view view = {.extreme = extreme, .tilt_deg = tilt_deg, .uv = {{0.37f, 0.61f}}};
    double height = fabs((double)extreme->height_m), slant = (double)detail_slant(towards.z);
    view.right = tl_field_march(field, view.uv, towards, MARCH_STEPS).uv;
    view.way_m = height * slant * (double)hypotf(towards.x, towards.y);
    for (int limited = 0; limited < 2; limited++) {
        vec2s to = tl_field_parallax(field, view.uv, towards, limited);
        struct detail_cell cell = judge(&view, to, 1, limited ? height : SHIFT_SLANT * height, 1);
        add(&view, limited ? "parallax_limited" : "parallax", &cell, out);
    }
    for (size_t s = 0; s < TL_COUNT(steps); s++) {
        struct tl_relief relief = tl_field_relief(field, view.uv, towards, steps[s], 5);
        float lit = tl_field_lit(field, relief.uv, towards, steps[s]);
        struct detail_cell cell = judge(&view, relief.uv, lit, SHIFT_SLANT * height, relief_max[s]);
        add(&view, relief_names[s], &cell, out);
    }
}

bool tl_stability_detail(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    (void)arguments;
    (void)error;
    for (size_t i = 0; i < TL_COUNT(extremes); i++) {
        tl_image heights = make_heights(&extremes[i]);
        struct tl_height_field field =
            tl_height_field_make(&heights, extremes[i].mirrored * SIDE_M, SIDE_M, false, false);
        tl_image cones = tl_bake_cones(&field, 1);
        field.cones = &cones;
        for (size_t t = 0; t < TL_COUNT(tilts_deg); t++)
            run_view(&extremes[i], &field, tilts_deg[t], out);
        tl_image_release(&cones);
        tl_image_release(&heights);
    }
    return true;
}
