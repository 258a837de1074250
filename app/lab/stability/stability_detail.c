/* The extremes of fabric detail: height fields and degenerate views, each seen by parallax and
 * relief. What is seen never lies farther off than twenty times the height [detail_slant], or than the height
 * itself where the shift is limited; flat fields are exact. */
#include "app/lab/stability/stability.h"
#include "config/memory.h"
#include "render/detail/cones.h"
#include "render/detail/field.h"

#include <math.h>
#include <stdio.h>

#define SIDE_M      0.01f
#define SHIFT_SLANT 20 /* 1 / 0.05 of detail_slant */

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
static const int steps[] = {1, 256};

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
    double moved_m, bound_m;
};

/* Limited parallax may move by the height alone. */
static struct detail_cell judge(const struct detail_extreme *extreme, vec2s from, vec2s to, float lit,
                                double bound_m)
{
    struct detail_cell cell = {.bound_m = bound_m,
                               .moved_m = (double)(SIDE_M * hypotf(to.x - from.x, to.y - from.y)),
                               .outcome = TL_OUTCOME_SILENT};
    bool exact = extreme->height_m == 0 && cell.moved_m == 0;
    if (!isfinite(cell.moved_m) || !isfinite(lit))
        cell.outcome = TL_OUTCOME_NAN;
    else if (cell.moved_m <= bound_m * 1.001 + 1e-8 && lit >= 0 && lit <= 1)
        cell.outcome = exact ? TL_OUTCOME_EXACT : TL_OUTCOME_BOUNDED;
    return cell;
}

static void add(const struct detail_extreme *extreme, const char *way, float tilt_deg,
                const struct detail_cell *cell, bool prints, struct tl_stability *out)
{
    cJSON *row = tl_stability_add(out, "detail", cell->outcome);
    cJSON_AddStringToObject(row, "extreme", extreme->name);
    cJSON_AddStringToObject(row, "method", way);
    cJSON_AddNumberToObject(row, "tilt_deg", (double)tilt_deg);
    cJSON_AddNumberToObject(row, "moved_m", isfinite(cell->moved_m) ? cell->moved_m : -1);
    cJSON_AddNumberToObject(row, "bound_m", cell->bound_m);
    if (prints)
        printf("%-22s %-16s %6.1f degrees  %-8s %9.3g m of %.3g\n", extreme->name, way, (double)tilt_deg,
               tl_outcome_names[cell->outcome], cell->moved_m, cell->bound_m);
}

static void run_view(const struct detail_extreme *extreme, const struct tl_height_field *field,
                     float tilt_deg, bool prints, struct tl_stability *out)
{
    static const char *const relief_names[] = {"relief, 1 step", "relief, 256 steps"};
    const vec2s uv = {{0.37f, 0.61f}};
    const vec3s view = {
        {0.6f * sinf(glm_rad(tilt_deg)), 0.8f * sinf(glm_rad(tilt_deg)), cosf(glm_rad(tilt_deg))}};
    double height = fabs((double)extreme->height_m);
    for (int limited = 0; limited < 2; limited++) {
        vec2s to = tl_field_parallax(field, uv, view, limited);
        struct detail_cell cell = judge(extreme, uv, to, 1, limited ? height : SHIFT_SLANT * height);
        add(extreme, limited ? "parallax_limited" : "parallax", tilt_deg, &cell, prints, out);
    }
    for (size_t s = 0; s < TL_COUNT(steps); s++) {
        struct tl_relief relief = tl_field_relief(field, uv, view, steps[s], 5);
        float lit = tl_field_lit(field, relief.uv, view, steps[s]);
        struct detail_cell cell = judge(extreme, uv, relief.uv, lit, SHIFT_SLANT * height);
        add(extreme, relief_names[s], tilt_deg, &cell, prints, out);
    }
}

bool tl_stability_detail(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    (void)error;
    for (size_t i = 0; i < TL_COUNT(extremes); i++) {
        tl_image heights = make_heights(&extremes[i]);
        struct tl_height_field field =
            tl_height_field_make(&heights, extremes[i].mirrored * SIDE_M, SIDE_M, false, false);
        tl_image cones = tl_bake_cones(&field, 1);
        field.cones = &cones;
        for (size_t t = 0; t < TL_COUNT(tilts_deg); t++)
            run_view(&extremes[i], &field, tilts_deg[t], !arguments->json, out);
        tl_image_release(&cones);
        tl_image_release(&heights);
    }
    return true;
}
