#include "assets/cut/garment_cut_internal.h"

#include <assert.h>

struct tl_curve tl_cut_mirrored_curve(const struct tl_curve *curve)
{
    struct tl_curve result = {.segments = curve->segments};
    for (int i = 0; i < 4; i++)
        result.control[i] = (struct tl_point){-curve->control[3 - i].x, curve->control[3 - i].y};
    return result;
}

struct tl_cut_piece tl_cut_mirrored(const struct tl_cut_piece *piece)
{
    struct tl_cut_piece result = *piece;
    for (size_t c = 0; c < piece->half_count; c++)
        result.half[piece->half_count - 1 - c] = tl_cut_mirrored_curve(&piece->half[c]);
    return result;
}

void tl_cut_sew(struct tl_cut_plan *plan, size_t piece_a, size_t curve_a, size_t piece_b, size_t curve_b)
{
    assert(plan->seam_count < TL_CUT_MAX_SEAMS);
    plan->seams[plan->seam_count++] = (struct tl_cut_seam){piece_a, curve_a, piece_b, curve_b};
}
