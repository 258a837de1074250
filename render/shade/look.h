/* The material at pixels of one part, from what rasterisation interpolates: what the G-buffer's shader
 * (render/gbuffer/gbuffer.frag) writes for a pixel, from the same terms. TL_LANES pixels are evaluated at a
 * time: lane by lane where texels are read, in vector code elsewhere. World space. Pure; threads: any. */
#ifndef TOILE_RENDER_SHADE_LOOK_H
#define TOILE_RENDER_SHADE_LOOK_H

#include "config/base/simd.h"
#include "render/shade/materials.h"

#include <cglm/struct.h>

#include <math.h>

#define TL_NO_TRIANGLE UINT32_MAX

struct tl_look_lanes {
    const struct tl_shade_part *part;
    int count; /* the other lanes are not read for texels; what they hold does not matter */
    /* Given: */
    float normal[3][TL_LANES];  /* towards the front, not normalised */
    float tangent[4][TL_LANES]; /* along u, and handedness; read where the part has bumps or lobes */
    float viewer[3][TL_LANES];  /* unit, towards the eye */
    float side[TL_LANES];       /* 1: the front is seen; -1: the back, whose whole frame turns over */
    /* Values of the part's maps: */
    float uv[2][TL_LANES];        /* must be finite */
    float change[2][2][TL_LANES]; /* of u and of v to the next sample across and up */
    float slopes[2][TL_LANES];    /* factors on a weave's slopes along u and v (tl_slope_factors) */
    uint32_t triangle[TL_LANES];  /* the surface's own; TL_NO_TRIANGLE: borders are not looked for */
    /* Results: */
    float smooth[3][TL_LANES]; /* the given normal, normalised */
    float shown[3][TL_LANES];  /* shading normal, unit, on the viewer's side */
    float glossiness[TL_LANES];
    float widening[3][TL_LANES]; /* added to squared widths of facets along u and v, and to their product */
    tl_quad diffuse[TL_LANES], f0[TL_LANES]; /* RGB: kd; reflectance at normal incidence */
};

void tl_look_evaluate(const struct tl_detail_params *detail, struct tl_look_lanes *lanes);

TL_INLINE vec3s tl_lane_vector(const float from[3][TL_LANES], int lane)
{
    return (vec3s){{from[0][lane], from[1][lane], from[2][lane]}};
}

TL_INLINE void tl_lane_store(float to[3][TL_LANES], int lane, vec3s v)
{
    to[0][lane] = v.x;
    to[1][lane] = v.y;
    to[2][lane] = v.z;
}

#endif
