/* What a ray of the oracle finds: a point of a surface or of the ground, and what it does with light, as the
 * G-buffer's shaders define it (render/gbuffer/gbuffer.frag) but without the G-buffer's rounding.
 *
 * World space, metres. Borrows the surfaces. Threads: pure once made. */
#ifndef TOILE_RENDER_REFERENCE_SHADING_POINT_H
#define TOILE_RENDER_REFERENCE_SHADING_POINT_H

#include "render/brdf/brdf.h"
#include "render/gpu/map_texture.h"
#include "render/local/lamp.h"
#include "render/reference/detail.h"
#include "render/reference/reference.h"
#include "render/reference/sky.h"
#include "render/scene/view.h"
#include "render/surfaces/ground.h"
#include "render/trace/trace.h"

struct tl_surface_materials; /* a surface's materials, made ready */

struct tl_reference_scene {
    const tl_surface *surfaces; /* the frame's; the ground is none of them */
    size_t surface_count;
    const struct tl_ground *ground; /* NULL: none */
    tl_trace *trace;
    struct tl_surface_materials *looks; /* by surface; the ground's comes last */
    size_t texture_count;
    struct tl_map_texture **textures;
    struct tl_sky sky;
    struct tl_reference_detail detail;
    struct tl_lamp lamps[TL_LAMPS_MAX]; /* those that shine */
    size_t lamp_count;
    float offset_m; /* how far off a surface its rays start */
    int lobe;       /* enum tl_lobe */
    int terminator; /* enum tl_terminator */
    bool reflect;   /* near mirrors see the lit scene */
};

/* All of the request but the image's size. */
bool tl_reference_scene_make(const struct tl_reference_request *request, struct tl_reference_scene *out,
                             tl_error *error);
void tl_reference_scene_release(struct tl_reference_scene *scene);

struct tl_ray_differential {
    vec3s origin, direction; /* unit */
    float from_m, to_m;
    vec3s across, down; /* how `direction` changes from sample to sample; zero: maps at their finest level */
};

/* The camera's ray through the middle of sample (x, y) of columns x rows, counted from the upper left corner.
 */
struct tl_ray_differential tl_camera_ray(const struct tl_view *view, int columns, int rows, int x, int y);

/* What a material is beyond two lobes. Its lobes' colours below, the spot's own among them, are less what the
 * coat reflects already. */
struct tl_shading_layers {
    float openness;    /* share that is seen straight through */
    vec3s transmitted; /* kt: of the light on the other side, diffusely: K_1(-normal, w) */
    vec3s behind;      /* where rays to that light start */
    float coat;        /* F of the coat, times its share */
    vec3s coat_axis;
    float coat_exponent;
    bool faceted; /* gloss is `brdf` times `base`, instead of the lobe about `axis` */
    float base;   /* 1 - coat */
    struct tl_brdf brdf;
    struct tl_brdf_frame frame;
};

/* One lobe, or two: c = integral of L V [diffuse K_1(normal, w) + glossy K_s(axis, w)] dw; and layers. */
struct tl_shading_point {
    float cover;      /* share of what is seen there; 0: the ray meets nothing */
    float distance_m; /* along the ray */
    bool layered;     /* `layers` hold something */
    struct tl_shading_layers layers;
    vec3s point;   /* where rays to the light start */
    vec3s horizon; /* normal of the plane above which light counts; unit, as all directions here */
    vec3s normal, axis;
    float exponent; /* s */
    vec3s diffuse, glossy;
    vec3s viewer;                /* towards the eye */
    vec3s tangent;               /* along u, at right angles to `normal`; zero where the surface has none */
    float side;                  /* 1; -1 where the back is seen */
    vec3s albedo, f0;            /* diffuse colour; reflectance at normal incidence: whatever `lobe` says */
    float handedness;            /* bitangent = handedness * cross(normal, tangent) */
    float glossiness;            /* of the maps, as `exponent` */
    const tl_material *material; /* borrowed from the surface */
};

/* What the ray meets first. */
struct tl_shading_point tl_shading_point_find(const struct tl_reference_scene *scene,
                                              const struct tl_ray_differential *ray);

#endif
