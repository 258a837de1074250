/* Shared by the files of this room: the buffers and programs of a frame on the graphics card. */
#ifndef TOILE_RENDER_CARD_CARD_INTERNAL_H
#define TOILE_RENDER_CARD_CARD_INTERNAL_H

#include "render/bounce/bounce_scene.h"
#include "render/card/card.h"
#include "render/card/card_bindings.glsl"
#include "render/visibility/card_points.h"

#include <epoxy/gl.h>

/* PROGRAM(name, file, defines): the compute programs. */
#define TL_CARD_PROGRAMS(PROGRAM)                                                                            \
    PROGRAM(list_tiles, "card_tiles.comp", NULL)                                                             \
    PROGRAM(behind, "card_behind.comp", NULL)                                                                \
    PROGRAM(bounce, "card_bounce.comp", NULL)                                                                \
    PROGRAM(bounce_fill, "card_bounce_fill.comp", NULL)                                                      \
    PROGRAM(bounce_show, "card_bounce_show.comp", NULL)                                                      \
    PROGRAM(ratios, "card_ratios.comp", NULL)                                                                \
    PROGRAM(sun_coarse, "card_sun_coarse.comp", NULL)                                                        \
    PROGRAM(sun_fine, "card_sun_fine.comp", NULL)                                                            \
    PROGRAM(resolve, "card_resolve.comp", NULL)                                                              \
    PROGRAM(shade_nothing, "card_shade.comp", "#define NOTHING\n")                                           \
    PROGRAM(shade_plain, "card_shade.comp", NULL)                                                            \
    PROGRAM(shade_rich, "card_shade.comp", "#define RICH\n")                                                 \
    PROGRAM(rest_plain, "card_rest.comp", NULL)                                                              \
    PROGRAM(rest_rich, "card_rest.comp", "#define RICH\n")

#define TL_CARD_LOBE_MAPS                                                                                    \
    (TL_EXPONENT_COUNT + 2) /* those of the exponents, and the gain of diffuse light                         \
                             */
#define TL_CARD_SUNS   (TL_SUNS_MAX + TL_LAMPS_MAX)
#define TL_CARD_LAYERS (1 + TL_TRANSPARENCY_LAYERS)
#define TL_CARD_PLACES 16                /* of a sun */
#define TL_CARD_MAPS   (TL_MAP_USES + 5) /* of a class: see list_maps */

/* `FrameValues` of card_frame.glsl. */
struct tl_card_frame {
    float view_projection[16], eye[4], ray_first[4], ray_across[4], ray_up[4], disc[4], turn[4];
    int32_t size[4], counts[4];
    uint32_t numbers[4];
    float suns[TL_CARD_SUNS][4], sun_powers[TL_CARD_SUNS][4], sun_places[TL_SUNS_MAX][TL_CARD_PLACES][4];
    float lobe_maps[TL_CARD_LOBE_MAPS][4];
};

/* Parts of surfaces that are shaded together, as they have the same maps. Classes 0 and 1 have none: where
 * nothing is seen; and parts that are matt or have one lobe, and one colour. */
struct tl_card_class {
    const struct tl_shade_part *part; /* the first one; its maps are borrowed */
    tl_texture maps[TL_CARD_MAPS];    /* id 0: none */
    tl_buffer firsts, near, borders, profiles, yarns;
};

struct tl_graphics_card {
    tl_gpu *gpu;
    bool have_programs;
#define MEMBER(name, file, defines) tl_program name;
    TL_CARD_PROGRAMS(MEMBER)
#undef MEMBER
    tl_program draw_ids[2]; /* without and with holes */
    struct tl_card_frame frame;
    tl_buffer frame_buffer, blends;         /* of uniforms */
    unsigned vertex_array, ids_framebuffer; /* GL names */
    struct tl_card_points points;
    tl_buffer buffers[CARD_BUFFERS]; /* without those of `points` */

    /* State of the surfaces. */
    uint64_t shapes_revision;
    bool have_shapes;
    size_t own_count;        /* probes with bounced light of their own */
    size_t traced_triangles; /* those before the ground's */
    int class_count;
    struct tl_card_class classes[CARD_CLASSES_MAX];
    tl_texture no_map; /* one texel of 0 */

    /* State of the view. */
    int layers;                                   /* 1: nothing is seen through */
    tl_texture ids[TL_CARD_LAYERS], depth, light; /* of the samples */

    /* State of the light. */
    uint64_t light_revision;
    bool have_light;
    tl_texture lobe_atlas, gain_atlas;
    tl_texture coarse, sun_seen[TL_CARD_LAYERS]; /* sun_seen: a layer for each sun and lamp */
    struct tl_bounce_sky sky;
    uint32_t bounce_frames; /* since the shapes were new */

    /* State of the image at rest. */
    tl_texture sky_texels, sky_curve; /* card_sky.glsl */
    uint64_t sky_revision;
    tl_texture round; /* light of the samples in one round */
};

static inline void tl_card_put(float to[4], vec3s v, float w)
{
    to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = w;
}

void tl_card_release_programs(tl_graphics_card *card);
bool tl_card_make_programs(tl_graphics_card *card, tl_error *error);
/* Sends `frame`, and binds all buffers. */
bool tl_card_send_frame(tl_graphics_card *card, tl_error *error);
/* Makes a texture that nothing filters, unless it is there. */
void tl_card_fit_texture(tl_graphics_card *card, tl_texture *texture, unsigned format, int width, int height);
/* Runs a program in groups of `group` threads along x; or in so many as the work at a word of CARD_WORK
 * states. What follows sees what it writes. */
void tl_card_dispatch(const tl_program *program, size_t threads, size_t group);
void tl_card_dispatch_listed(const tl_graphics_card *card, const tl_program *program, size_t word);

/* Places suns, then lamps, in the frame's values. */
void tl_card_place_lights(tl_graphics_card *card, const struct tl_suns *suns, float yaw,
                          const struct tl_lamp *lamps, size_t lamp_count);
bool tl_card_send_materials(tl_graphics_card *card, const struct tl_card_surfaces *request, tl_error *error);
void tl_card_release_materials(tl_graphics_card *card);
/* Sends regions and lobes when they have changed; suns and directions as they are now. */
bool tl_card_send_light(tl_graphics_card *card, const struct tl_card_light *request, tl_error *error);
bool tl_card_send_sky(tl_graphics_card *card, const struct tl_card_bounce *request, tl_error *error);
void tl_card_release_light(tl_graphics_card *card);

/* Binds the maps and tables of a class of materials. */
void tl_card_bind_class(tl_graphics_card *card, const struct tl_card_class *class);
/* Makes the picture of samples as tl_card_shade does. */
void tl_card_resolve(tl_graphics_card *card, const tl_texture *samples, const tl_texture *image, int before);

#endif
