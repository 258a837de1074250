/* Facts about a frame's scene and how it is to be drawn, and what its materials need. Pure. */
#ifndef TOILE_RENDER_FRAME_FACTS_H
#define TOILE_RENDER_FRAME_FACTS_H

#include "render/frame/resource.h"
#include "render/frame/settings.h"

/* Returns why the graphics card cannot draw the frame with ratios at vertices; NULL: it can. A constant text.
 */
const char *tl_frame_card_refusal(const tl_frame *frame, const struct tl_render_settings *settings);
/* ... at rest, by rounds of paths. */
const char *tl_frame_rest_refusal(const tl_frame *frame, const struct tl_render_settings *settings);
/* Bits of enum tl_scene_fact. `settings` as tl_render_settings_resolve returns them. It visits every material
 * and reads the weaves' gloss maps, so a frame computes its facts once and passes them on. */
tl_bits tl_frame_facts(const tl_frame *frame, const struct tl_render_settings *settings);

/* The exponents of the lobes that the surfaces' materials need, as bits of env/lobes.h; and those of
 * environment maps, with the environment itself for mirrors. */
uint32_t tl_exponents_of(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail);
uint32_t tl_map_exponents_of(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail);

/* Whether any material that is drawn has the property. */
bool tl_materials_have(const tl_surface *surfaces, size_t count,
                       bool (*property)(const tl_material *material));
/* Whether the material's gloss is not a lobe about the mirror direction. */
bool tl_material_is_faceted(const tl_material *material);

#endif
