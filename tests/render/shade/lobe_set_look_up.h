/* The lobes of a table towards one viewer, as tl_lobe_fit_make gives them: what pixel lanes fetch, one by
 * one. */
#ifndef TOILE_TESTS_RENDER_SHADE_LOBE_SET_LOOK_UP_H
#define TOILE_TESTS_RENDER_SHADE_LOBE_SET_LOOK_UP_H

#include "render/shade/lobe_set_table.h"

/* Returns their number; 0 where the viewer is below the surface. */
static inline int look_lobe_set_up(const struct tl_lobe_set_table *table, const struct tl_brdf_frame *frame,
                                   vec3s viewer, vec3s f0, float glossiness,
                                   struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX])
{
    tl_quad sums[2 * TL_LOBE_FIT_MAX];
    float cosine = glms_vec3_dot(viewer, frame->normal);
    if (!(cosine > 0))
        return 0;
    const LobeSetPlace place =
        tl_lobe_set_place(table, glms_vec3_dot(viewer, frame->tangent),
                          glms_vec3_dot(viewer, frame->bitangent), cosine, glossiness);
    const struct tl_lobe_set_shares shares = tl_lobe_set_shares((tl_quad){f0.x, f0.y, f0.z, 0});
    const float side = place.side;
    tl_lobe_set_fetch(table, &place, sums);
    for (size_t k = 0; k < (size_t)table->lobe_count; k++) {
        const tl_quad at = sums[2 * k], weight = sums[2 * k + 1];
        vec3s d = glms_vec3_scale(frame->tangent, side * at[0]);
        d = glms_vec3_add(d, glms_vec3_scale(frame->bitangent, side * at[1]));
        d = glms_vec3_add(d, glms_vec3_scale(frame->normal, at[2]));
        lobes[k] = (struct tl_fitted_lobe){.direction = glms_vec3_normalize(d), .exponent = exp2f(at[3])};
        const tl_quad mixed = shares.low * weight[0] + shares.high * weight[1];
        lobes[k].weight = (vec3s){{mixed[0], mixed[1], mixed[2]}};
    }
    return table->lobe_count;
}

#endif
