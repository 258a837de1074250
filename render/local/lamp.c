#include "render/local/lamp.h"

#include <math.h>

static const char *const kind_names[] = {"none", "directional", "point", NULL};

typedef struct tl_lamp_params lamp_params;
static const struct tl_option rows[] = {
    TL_OPTION_ENUM(lamp_params, kind, TL_AFFECTS_NOTHING, kind_names,
                   "a light in addition to the environment"),
    TL_OPTION_FLOAT(lamp_params, yaw_deg, TL_AFFECTS_NOTHING, -3600, 3600, "degrees",
                    "direction about the camera's target: 0 shines from +Z, positive turns towards +X"),
    TL_OPTION_FLOAT(lamp_params, pitch_deg, TL_AFFECTS_NOTHING, -90, 90, "degrees",
                    "elevation; positive shines from above"),
    TL_OPTION_FLOAT(lamp_params, distance_m, TL_AFFECTS_NOTHING, 0, 10000, "m",
                    "point: distance to the camera's target"),
    TL_OPTION_COLOUR(lamp_params, irradiance, TL_AFFECTS_NOTHING, 0, 1e6,
                     "irradiance of a surface that faces the lamp, for point at 1 m; larger: brighter; 3.14 "
                     "makes white 1"),
};
const struct tl_option_table tl_lamp_options =
    TL_OPTION_TABLE("lamp", "a light in addition to the environment", rows, lamp_params, .yaw_deg = -40,
                    .pitch_deg = 40, .distance_m = 2, .irradiance = {3, 3, 3});
const struct tl_option_table tl_fill_options =
    TL_OPTION_TABLE("fill", "a second light in addition to the environment", rows, lamp_params, .yaw_deg = 60,
                    .pitch_deg = 10, .distance_m = 2, .irradiance = {1, 1, 1});

struct tl_lamp tl_lamp_make(const struct tl_lamp_params *params, vec3s target)
{
    float yaw = glm_rad(params->yaw_deg), pitch = glm_rad(params->pitch_deg);
    vec3s direction = {{sinf(yaw) * cosf(pitch), sinf(pitch), cosf(yaw) * cosf(pitch)}};
    return (struct tl_lamp){
        .kind = (enum tl_lamp_kind)params->kind,
        .direction = direction,
        .position = glms_vec3_add(target, glms_vec3_scale(direction, params->distance_m)),
        .irradiance = {{params->irradiance[0], params->irradiance[1], params->irradiance[2]}},
    };
}

static bool is_finite(vec3s v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

bool tl_lamp_is_lit(const struct tl_lamp *lamp)
{
    const vec3s *e = &lamp->irradiance;
    bool shines = is_finite(*e) && e->x >= 0 && e->y >= 0 && e->z >= 0 && e->x + e->y + e->z > 0;
    if (lamp->kind == TL_LAMP_DIRECTIONAL)
        return shines && is_finite(lamp->direction) && glms_vec3_norm2(lamp->direction) > 0;
    return shines && lamp->kind == TL_LAMP_POINT && is_finite(lamp->position);
}

size_t tl_lamps_lit(const tl_frame *frame, struct tl_lamp out[TL_LAMPS_MAX])
{
    size_t count = 0;
    for (size_t i = 0; i < frame->lamp_count && count < TL_LAMPS_MAX; i++)
        if (tl_lamp_is_lit(&frame->lamps[i]))
            out[count++] = frame->lamps[i];
    return count;
}
