/* Shadows of lamps, by the same method as the regions of the environment: ray tracing, or one depth map per
 * lamp. A map sees the bounding sphere of the casters from a lamp outside of it. A point lamp inside or near
 * that sphere would need six maps, so its shadows are ray traced with either method. Needs the GL context of
 * its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_LAMP_SHADOWS_H
#define TOILE_RENDER_LOCAL_LAMP_SHADOWS_H

#include "render/local/lamp.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"
#include "render/visibility/fit.h"

enum tl_lamp_shadow { TL_LAMP_SHADOW_NONE, TL_LAMP_SHADOW_RAYS, TL_LAMP_SHADOW_MAP };
/* The method for a lamp. */
enum tl_lamp_shadow tl_lamp_shadow_of(const struct tl_lamp *lamp, const struct tl_light_params *light,
                                      const struct tl_casters *casters);

/* The transformation from world to clip space of a lamp's map. Pure. */
mat4s tl_lamp_view(const struct tl_lamp *lamp, const struct tl_casters *casters,
                   const struct tl_caster_cloud *cloud, int map_size);

struct tl_lamp_shadows {
    enum tl_lamp_shadow kinds[TL_LAMPS_MAX];
    mat4s views[TL_LAMPS_MAX]; /* world to clip space, for MAP */
    tl_texture depths;         /* 2D array, one layer per lamp; made when a map is first drawn */
    tl_texture
        visibility; /* R8 2D array, one layer per lamp, texel by sample; made when rays are first traced */
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
    const tl_surfaces *surfaces; /* the casters come first, in the same order */
    int map_size;
};

/* Frees and zeroes. */
void tl_lamp_shadows_release(struct tl_lamp_shadows *shadows);
/* Size of all textures. */
size_t tl_lamp_shadows_bytes(const struct tl_lamp_shadows *shadows);
/* Draws the maps of the lamps whose kind is MAP. False when a shader cannot be compiled. */
bool tl_lamp_maps_draw(struct tl_lamp_shadows *shadows, tl_gpu *gpu,
                       const struct tl_lamp_maps_request *request, tl_error *error);
/* Uploads the visibility of one lamp, the output of tl_lamp_rays. */
void tl_lamp_shadows_set(struct tl_lamp_shadows *shadows, tl_gpu *gpu, int width, int height, size_t lamp,
                         size_t lamp_count, const uint8_t *visible);

#endif
