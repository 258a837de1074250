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
