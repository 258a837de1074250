/* The point in which a ray of the reference renderer intersects a surface or the ground, and its reflectance,
 * as the shaders of the G-buffer define it (render/gbuffer/gbuffer.frag) but without the rounding of the
 * G-buffer.
 *
 * World space, metres. Borrows the surfaces. Threads: any. */
#ifndef TOILE_RENDER_REFERENCE_SHADING_POINT_H
#define TOILE_RENDER_REFERENCE_SHADING_POINT_H

#include "render/brdf/material_lobes.h"
#include "render/reference/scene.h"
#include "render/scene/view.h"

/* A ray with differentials, for the footprint of texture look-ups [Igehy 1999]. */
struct tl_ray_differential {
    vec3s origin, direction; /* unit */
    float from_m, to_m;
    vec3s across, down; /* change of `direction` to the neighbouring samples; zero: maps are read at their
                           finest level */
};

/* The camera ray through the centre of sample (x, y) of columns x rows, counted from the upper left
 * corner. */
struct tl_ray_differential tl_camera_ray(const struct tl_view *view, int columns, int rows, int x, int y);

/* The parts of a material beyond two lobes. The colours of those in tl_shading_point are already multiplied
 * by `lobes.over.base`. */
struct tl_shading_layers {
    float openness;    /* fraction that is seen straight through */
    vec3s transmitted; /* kt: diffuse transmission of light from the other side: K_1(-normal, w) */
    vec3s behind;      /* origin of rays to that light */
    struct tl_material_lobes lobes;
};

/* A shading point with one or two lobes, c = integral of L V [diffuse K_1(normal, w) + glossy K_s(axis, w)]
 * dw, and layers. */
struct tl_shading_point {
    float cover;      /* coverage; 0: the ray hits nothing */
    float distance_m; /* along the ray */
    bool layered;     /* `layers` is used */
    struct tl_shading_layers layers;
    vec3s point;   /* origin of rays to the light */
    vec3s horizon; /* normal of the plane above which light counts; unit, as all directions here */
    vec3s normal, axis;
    float exponent; /* s */
    vec3s diffuse, glossy;
    vec3s viewer;      /* towards the eye */
    vec3s tangent;     /* along u, at right angles to `normal`; zero where the surface has none */
    float side;        /* 1 for a front face, -1 for a back face */
    vec3s emission;    /* radiance of its own, below the coat */
    vec3s albedo, f0;  /* diffuse colour and reflectance at normal incidence, independent of `lobe` */
    float handedness;  /* bitangent = handedness * cross(normal, tangent) */
    float glossiness;  /* glossiness from the maps; `exponent` is derived from it */
    float widening[3]; /* added to squared widths of facets along u and v, and to their product */
    const tl_material *material; /* borrowed from the surface */
};

/* The nearest intersection of the ray. */
struct tl_shading_point tl_shading_point_find(const struct tl_reference_scene *scene,
                                              const struct tl_ray_differential *ray);

#endif
