#include "render/frame/settings.h"

#include <string.h>

void tl_render_settings_bind(struct tl_render_settings *settings,
                             struct tl_binding bindings[TL_RENDER_TABLES])
{
    const struct tl_binding all[TL_RENDER_TABLES] = {
        {&tl_light_options, &settings->light}, {&tl_detail_options, &settings->detail},
        {&tl_maps_options, &settings->maps},   {&tl_shading_options, &settings->shading},
        {&tl_image_options, &settings->image}, {&tl_reference_options, &settings->reference},
    };
    memcpy(bindings, all, sizeof all);
}

struct tl_render_settings tl_render_settings_resolve(const struct tl_render_settings *settings)
{
    struct tl_render_settings used = *settings;
    if (used.light.cut == TL_CUT_FACES)
        used.light.regions = used.light.regions / 6 * 6;
    while (used.light.pem_size & (used.light.pem_size - 1))
        used.light.pem_size &= used.light.pem_size - 1;
    while (used.maps.size & (used.maps.size - 1))
        used.maps.size &= used.maps.size - 1;
    if (used.image.view != TL_VIEW_LIGHT) {
        used.light.method = TL_METHOD_PEM;
        used.light.visibility = TL_VISIBILITY_RAYS;
    }
    return used;
}

int tl_frame_bounces(const struct tl_light_params *light, const struct tl_reference_params *reference)
{
    return light->bounce == TL_BOUNCE_OFF ? 0 : light->bounce == TL_BOUNCE_ONE ? 1 : reference->bounces;
}

struct tl_reference_request tl_frame_reference_request(const tl_frame *frame,
                                                       const struct tl_render_settings *settings,
                                                       const struct tl_ground *ground)
{
    return (struct tl_reference_request){.frame = frame,
                                         .ground = ground,
                                         .params = &settings->reference,
                                         .detail = &settings->detail,
                                         .lobe = settings->light.lobe,
                                         .reflect_scene = settings->light.reflect_scene,
                                         .bounces = tl_frame_bounces(&settings->light, &settings->reference),
                                         .width = settings->image.width,
                                         .height = settings->image.height,
                                         .supersample = settings->image.supersample};
}
