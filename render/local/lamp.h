/* Lamps: directional and point lights in addition to the environment, which local lighting adds. Pure;
 * threads: any. */
#ifndef TOILE_RENDER_LOCAL_LAMP_H
#define TOILE_RENDER_LOCAL_LAMP_H

#include "render/light/options.h"
#include "render/scene/frame.h"

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

#endif
