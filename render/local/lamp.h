/* Lamps: directional and point lights in addition to the environment, which local lighting adds. Pure;
 * threads: any. */
#ifndef TOILE_RENDER_LOCAL_LAMP_H
#define TOILE_RENDER_LOCAL_LAMP_H

#include "render/light/options.h"
#include "render/scene/frame.h"

struct tl_ground;

struct tl_lamp_params {  /* tables "lamp" and "fill" */
    int kind;            /* enum tl_lamp_kind */
    float yaw_deg;       /* about the camera's target, as the camera's: 0 shines from +Z, positive from +X */
    float pitch_deg;     /* positive shines from above */
    float distance_m;    /* POINT: from the camera's target */
    float irradiance[3]; /* as struct tl_lamp */
};
extern const struct tl_option_table tl_lamp_options, tl_fill_options;

/* The lamp of a table of options, about the target of the camera. */
struct tl_lamp tl_lamp_make(const struct tl_lamp_params *params, vec3s target);

/* True if the lamp emits light. A lamp with an invalid position or direction does not. */
bool tl_lamp_is_lit(const struct tl_lamp *lamp);
/* The lit lamps of a frame in their order. Returns their number. */
size_t tl_lamps_lit(const tl_frame *frame, struct tl_lamp out[TL_LAMPS_MAX]);

/* The light of a lamp at a point. Points nearer than TL_LAMP_NEAREST_M are lit as at that distance. */
#define TL_LAMP_NEAREST_M 1e-3f
struct tl_lamplight {
    vec3s direction;  /* towards the lamp, unit; `otherwise` where the two coincide */
    float distance_m; /* infinite for DIRECTIONAL */
    vec3s irradiance; /* on a surface that faces it */
};
/* Unshadowed light at `point`. */
struct tl_lamplight tl_lamp_at(const struct tl_lamp *lamp, vec3s point, vec3s otherwise);

/* The visibility of the lamp over the ground, in [0, 1]: the ground blocks light from below. NULL: no
 * ground. */
float tl_lamp_ground_visibility(const struct tl_lamp *lamp, const struct tl_ground *ground, vec3s point,
                                vec3s direction);

#endif
