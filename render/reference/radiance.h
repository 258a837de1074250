/* Radiance that shading points send to their viewers: light of the environment (gather.h), and light that
 * other surfaces send on, bounce by bounce: path tracing in which every hit gathers the environment and the
 * lamps for itself [Kajiya 1986]. All lobes of a point receive it: matt, glossy, coat, facets, fuzz, and what
 * a sheet transmits; behind open cloth a path continues with the share that the cloth lets through. Light of
 * lamps at the points themselves is not included (lamps.h). Pure; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_RADIANCE_H
#define TOILE_RENDER_REFERENCE_RADIANCE_H

#include "render/reference/gather.h"

struct tl_radiance_request {
    struct tl_gather_request direct;
    int bounces;        /* 0: surfaces send no light on */
    int bounce_samples; /* paths of each lobe; each hit sends on one */
    bool reflect;       /* without bounces too, near mirrors reflect the directly lit scene, by
                           direct.lobe_samples paths */
};

/* light[channel][point]. Returns the number of rays traced. Results are finite. */
size_t tl_radiance(const struct tl_radiance_request *request, const struct tl_shading_points *points,
                   float light[3][TL_SHADING_POINTS]);

#endif
