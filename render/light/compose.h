/* The light of every sample from visibility that is kept at points (render/visibility/points.h), on the CPU.
 *
 * Never the light itself but its visible share is interpolated:
 *
 *     c = kd E(n, 1) sum v_i w_i / sum w_i  +  F ks E(r, s) sum v_i u_i / sum u_i        (by colour channel)
 *
 * E is the exact unshadowed light (env/lobes.h); w_i and u_i stand for P_i: the region's power times the
 * lobe, broadened by the region's spread. v_i is the visibility of region i at the sample, clipped at the
 * sample's own horizon (docs/notes/visibility.md, 1 and 2). Suns stand apart: power times lobe times their
 * own visibility. The other methods of enum tl_method are made of the same sums.
 *
 * A material whose gloss is not a lobe about r has a few lobes (render/brdf/lobe_fit.h), a coat has one more;
 * each is taken as the glossy one is, but that none has mirrors' rays: what they reflect of the scene is
 * black. Under suns facets are evaluated themselves. Fuzz is a lobe about the smooth normal over all of these
 * (render/brdf/fuzz.h): its exact light times the share of the regions that is seen through it. */
#ifndef TOILE_RENDER_LIGHT_COMPOSE_H
#define TOILE_RENDER_LIGHT_COMPOSE_H

#include "render/bounce/bounce.h"
#include "render/brdf/material_lobes.h"
#include "render/env/lobes.h"
#include "render/env/sun.h"
#include "render/gbuffer/samples.h"
#include "render/light/mirrors.h"
#include "render/light/options.h"
#include "render/light/region_lights.h"
#include "render/visibility/points.h"

/* A sample as its lobes are made from it; with its tangent only where they have a frame. Borrows
 * both. */
struct tl_material_sample tl_sample_material(const tl_sample *sample, const tl_material *material,
                                             const struct tl_triangle_ranges *ranges, vec3s eye);

struct tl_compose_request {
    const struct tl_samples *samples;
    const struct tl_region_lights *lights; /* whose weight suits the method */
    const struct tl_suns *suns;            /* none: count 0 */
    const struct tl_lobes *lobes;
    /* Visibility as tl_points gives it; unused when the method is UNSHADOWED. */
    const uint16_t *values;
    size_t stride;
    const struct tl_taps *taps;
    const float *sun_visibility[TL_SUNS_MAX];
    const tl_environment *environment; /* what perfect mirrors show */
    const struct tl_mirror *mirrors;   /* by sample; NULL: none */
    float environment_yaw;             /* rad */
    const struct tl_light_params *params;
    const struct tl_bounce
        *bounce; /* light from other surfaces, updated for the samples; NULL: none. Needs: */
    const struct tl_triangle_ranges *ranges;
    bool any_layered; /* a material is more than two lobes */
    vec3s eye;
    const float *shares; /* by sample that the camera sees, in place of its cover (transparency.h); NULL:
                            nothing is seen through */
};

/* Writes light[4 * texel], premultiplied by cover, of every sample of the camera, and how much of that cover
 * is looked through; other texels are left alone. The exponents that the samples' glossiness needs must be in
 * `lobes`. Results do not depend on the number of threads. */
void tl_compose(const struct tl_compose_request *request, float *light);

/* The ratio of seen to exact light, of the regions alone (suns have visibility of their own), by channel. */
struct tl_light_ratio {
    vec3s diffuse, glossy; /* of all lobes of the gloss together */
    vec3s fuzz;            /* of fibres (render/brdf/fuzz.h); as `diffuse` where there are none */
};

/* Writes the ratio of every sample, from the sums that tl_compose makes: method PEM, two lobes, no coat and
 * no mirrors. A sample without gloss has the diffuse ratio for both. */
void tl_compose_ratios(const struct tl_compose_request *request, struct tl_light_ratio *ratios);

#endif
