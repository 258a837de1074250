/* The image against the ray-traced reference, as truth.h compares them. */
#include "app/lab/check/check_measures.h"
#include "app/lab/truth/truth.h"
#include "render/inside.h"

/* Bounds of an image whose visibility is traced, and of one by maps. */
static double bound_of(const struct tl_light_params *light, double by_rays, double by_maps)
{
    return light->visibility == TL_VISIBILITY_RAYS ? by_rays : by_maps;
}

void tl_measure_oracle(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->truth)
        return;
    finding->bound = bound_of(&checked->settings->light, 0.25, 0.28);
    tl_finding_add(finding, checked->truth->error);
    tl_finding_pixel(finding, checked->truth->worst_x, checked->truth->worst_y);
}

void tl_measure_mean(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->truth)
        return;
    finding->bound = bound_of(&checked->settings->light, 0.08, 0.3);
    tl_finding_add(finding, checked->truth->mean_error);
    if (tl_finding_add(finding, checked->truth->garment_error))
        tl_finding_place(finding, "of the garment");
}

void tl_measure_patch(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->truth)
        return;
    finding->bound = bound_of(&checked->settings->light, 0.3, 0.5);
    tl_finding_add(finding, checked->truth->patch_error);
    tl_finding_pixel(finding, checked->truth->patch_x, checked->truth->patch_y);
}

void tl_measure_tile(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->truth)
        return;
    finding->bound = 1.5;
    tl_finding_add(finding, checked->truth->tile_error);
    tl_finding_pixel(finding, checked->truth->tile_x, checked->truth->tile_y);
}

void tl_measure_place(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->truth || !checked->truth->has_outlines)
        return;
    vec2s off = checked->truth->displacement;
    finding->bound = 0.1 / (double)checked->settings->image.scale; /* what is drawn smaller is enlarged */
    if (tl_finding_add(finding, (double)glms_vec2_norm(off)))
        tl_finding_place(finding, "%.2f to the right, %.2f down", (double)off.x, (double)off.y);
}
