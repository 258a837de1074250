#include "render/shade/pixel_lights.h"

#include "render/env/cube.h"

void tl_pixel_lights_make(const struct tl_suns *suns, float environment_yaw, const struct tl_lamp *lamps,
                          size_t lamp_count, struct tl_pixel_lights *out)
{
    *out = (struct tl_pixel_lights){0};
    for (int i = 0; i < suns->count; i++) {
        struct tl_sun *sun = &out->items[out->count++].sun;
        *sun = suns->items[i];
        sun->direction = tl_turn_direction(sun->direction, environment_yaw);
        for (int k = 0; k < sun->sample_count; k++)
            sun->samples[k] = tl_turn_direction(sun->samples[k], environment_yaw);
    }
    for (size_t i = 0; i < lamp_count; i++) {
        struct tl_pixel_light *light = &out->items[out->count++];
        light->lamp = lamps[i];
        light->sun.direction = lamps[i].direction;
        light->sun.power = lamps[i].irradiance;
        out->are_near |= lamps[i].kind == TL_LAMP_POINT;
    }
}
