#include "render/bounce/bounce_internal.h"

/* Whether the camera, or a ray that metal mirrors, looks at a side. At rest all count: the camera may turn.
 */
static bool is_looked_at(const struct tl_bounce *bounce, size_t at, bool in_motion)
{
    return !in_motion || bounce->seen[at] == bounce->update ||
           (bounce->states[at] != TL_BOUNCE_UNKNOWN && bounce->materials[bounce->parts[at / 2]].has_lobes);
}

/* The mean of a side's light and its neighbours', as far as it is known. */
TL_CLONES static void smooth_side(struct tl_bounce *bounce, size_t vertex, size_t side)
{
    const struct tl_vertex_rings *rings = &bounce->rings;
    const size_t at = 2 * vertex + side;
    const uint32_t *ring = rings->neighbours + rings->first[vertex];
    struct tl_bounced sum = {0}, mean = {0};
    float known = 0;
    if (bounce->states[at] != TL_BOUNCE_UNKNOWN) {
        tl_bounced_add(&sum, &bounce->found[at], 1);
        known++;
    }
    for (uint32_t i = 0; i < rings->counts[vertex]; i++) {
        const size_t from = 2 * (size_t)ring[i] + side;
        if (bounce->states[from] != TL_BOUNCE_UNKNOWN) {
            tl_bounced_add(&sum, &bounce->found[from], 1);
            known++;
        }
    }
    if (known > 0)
        tl_bounced_add(&mean, &sum, 1 / known);
    bounce->shown[at] = mean;
}

static void smooth_surface(struct tl_bounce *bounce, const tl_surface *surface, size_t first, bool in_motion)
{
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t v = 0; v < surface->vertex_count; v++)
        for (size_t side = 0; side < 2 && tl_has_own_light(surface, (uint32_t)v); side++)
            if (is_looked_at(bounce, 2 * (first + v) + side, in_motion))
                smooth_side(bounce, first + v, side);
}

/* A vertex without light of its own has the mean of those from which it takes it, as far as theirs is known.
 */
TL_CLONES static void take_mean(struct tl_bounce *bounce, const struct tl_light_mesh *mesh, size_t vertex,
                                size_t first, bool in_motion)
{
    const size_t at = first + 2 * vertex;
    const bool is_shown = is_looked_at(bounce, at, in_motion);
    float known = 0;
    struct tl_bounced mean = {0};
    bounce->states[at] = TL_BOUNCE_UNKNOWN;
    bounce->sent[at] = (vec3s){{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        const size_t from = first + 2 * (size_t)mesh->from[vertex][k];
        known += bounce->states[from] != TL_BOUNCE_UNKNOWN ? mesh->shares[vertex][k] : 0;
    }
    for (int k = 0; k < 3 && known > 0; k++) {
        const size_t from = first + 2 * (size_t)mesh->from[vertex][k];
        const float share = bounce->states[from] != TL_BOUNCE_UNKNOWN ? mesh->shares[vertex][k] / known : 0;
        if (bounce->states[at] < bounce->states[from])
            bounce->states[at] = bounce->states[from];
        bounce->sent[at] = glms_vec3_muladds(bounce->sent[from], share, bounce->sent[at]);
        if (is_shown && share > 0)
            tl_bounced_add(&mean, &bounce->shown[from], share);
    }
    if (is_shown)
        bounce->shown[at] = mean;
}

static void fill_surface(struct tl_bounce *bounce, const tl_surface *surface, size_t first, bool in_motion)
{
    const struct tl_light_mesh *mesh = surface->light_mesh;
    const size_t count = mesh ? surface->vertex_count : 0;
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t v = 0; v < count; v++)
        for (size_t side = 0; side < 2 && mesh->from[v][0] != v; side++)
            take_mean(bounce, mesh, v, 2 * first + side, in_motion);
}

void tl_bounce_smooth(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, bool in_motion)
{
    for (size_t s = 0; s < bounce->surface_count; s++) {
        smooth_surface(bounce, ranges->surfaces[s], bounce->first_vertex[s], in_motion);
        fill_surface(bounce, ranges->surfaces[s], bounce->first_vertex[s], in_motion);
    }
}
