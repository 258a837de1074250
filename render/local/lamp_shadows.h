/* Shadows of lamps, by the back-end that the environment's regions have: rays, or a depth map a lamp. A map
 * sees the casters' sphere from a lamp outside of it; a point within or near the sphere would need six, so
 * rays see to it under either back-end. */
#ifndef TOILE_RENDER_LOCAL_LAMP_SHADOWS_H
#define TOILE_RENDER_LOCAL_LAMP_SHADOWS_H

#include "render/local/lamp.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"
#include "render/visibility/fit.h"

enum tl_lamp_shadow { TL_LAMP_SHADOW_NONE, TL_LAMP_SHADOW_RAYS, TL_LAMP_SHADOW_MAP };
enum tl_lamp_shadow tl_lamp_shadow_of(const struct tl_lamp *lamp, const struct tl_light_params *light,
                                      const struct tl_casters *casters);

/* World -> clip space of a lamp's map. Pure. */
mat4s tl_lamp_view(const struct tl_lamp *lamp, const struct tl_casters *casters,
                   const struct tl_caster_cloud *cloud, int map_size);

struct tl_lamp_shadows {
    enum tl_lamp_shadow kinds[TL_LAMPS_MAX];
    mat4s views[TL_LAMPS_MAX]; /* of MAP */
    tl_texture depths;         /* 2D array, a layer a lamp; made when a map is first drawn */
    tl_texture visibility;  /* R8 2D array, a layer a lamp, texel by sample; ... when rays are first shot */
    tl_program programs[2]; /* opaque, masked */
    unsigned framebuffer;   /* GL name */
    struct tl_caster_cloud cloud;
};

struct tl_lamp_maps_request {
    const struct tl_lamp *lamps;
    size_t lamp_count;
    const tl_surface *caster_surfaces; /* without the ground */
    size_t caster_count;
    struct tl_casters casters;
    const tl_surfaces *surfaces; /* what casts comes first in them, in the same order */
    int map_size;
};

void tl_lamp_shadows_release(struct tl_lamp_shadows *shadows);
size_t tl_lamp_shadows_bytes(const struct tl_lamp_shadows *shadows);
/* Draws the maps of those lamps whose kind is MAP. */
bool tl_lamp_maps_draw(struct tl_lamp_shadows *shadows, tl_gpu *gpu,
                       const struct tl_lamp_maps_request *request, tl_error *error);
/* One lamp's layer as tl_lamp_rays made it. */
void tl_lamp_shadows_set(struct tl_lamp_shadows *shadows, tl_gpu *gpu, int width, int height, size_t lamp,
                         size_t lamp_count, const uint8_t *visible);

#endif
