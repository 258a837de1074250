/* Lights whose shadows every pixel looks for: the environment's suns, then the lamps. World space, metres.
 * Pure; threads: any. */
#ifndef TOILE_RENDER_SHADE_PIXEL_LIGHTS_H
#define TOILE_RENDER_SHADE_PIXEL_LIGHTS_H

#include "render/env/sun.h"
#include "render/light/terms.h"
#include "render/scene/lamp.h"

#define TL_PIXEL_LIGHTS_MAX (TL_SUNS_MAX + TL_LAMPS_MAX)

struct tl_pixel_light {
    struct tl_sun sun;   /* directions in the world. Of a lamp: no samples, no radius */
    struct tl_lamp lamp; /* kind TL_LAMP_NONE: a sun */
};

struct tl_pixel_lights {
    int count;
    bool are_near; /* some are point lamps */
    struct tl_pixel_light items[TL_PIXEL_LIGHTS_MAX];
};

/* `environment_yaw` (rad) turns the suns. */
void tl_pixel_lights_make(const struct tl_suns *suns, float environment_yaw, const struct tl_lamp *lamps,
                          size_t lamp_count, struct tl_pixel_lights *out);

/* The unit direction to a light, and its power at a surface there that faces it: of suns and distant lamps
 * the same everywhere. */
struct tl_pixel_lit {
    vec3s direction;
    float share; /* of sun.power */
};
TL_INLINE struct tl_pixel_lit tl_pixel_light_at(const struct tl_pixel_light *light, vec3s point)
{
    if (light->lamp.kind != TL_LAMP_POINT)
        return (struct tl_pixel_lit){light->sun.direction, 1};
    const vec4s place = tl_lamp_place(&light->lamp);
    return (struct tl_pixel_lit){towards_lamp(place, point, light->sun.direction),
                                 lamp_falloff(place, point)};
}

/* The share of a light that lies above the plane of a surface's smooth normal. */
TL_INLINE float tl_pixel_light_above(const struct tl_pixel_light *light, float cosine)
{
    return light_above(light->lamp.kind != TL_LAMP_NONE, light->sun.radius, cosine);
}

#endif
