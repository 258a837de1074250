/* Seams, hems and stitches at a point of a surface: the counterpart of construction.glsl. Pure;
 * threads: any. */
#ifndef TOILE_RENDER_CONSTRUCTION_LOOK_H
#define TOILE_RENDER_CONSTRUCTION_LOOK_H

#include "assets/topology/borders.h"
#include "render/construction/terms.h"

/* `triangle` of the surface; `across` and `down`: how UV changes from sample to sample. */
static inline ConstructionLook tl_construction_look(const struct tl_construction_tables *tables,
                                                    const tl_borders *borders, uint32_t triangle, vec2s uv,
                                                    vec2s across, vec2s down)
{
    ConstructionPlace seam = construction_far(CONSTRUCTION_REACH), hem = seam, dart = seam;
    ConstructionLook look = construction_none();
    float scale = 0;
    for (uint32_t k = borders->firsts[triangle]; k < borders->firsts[triangle + 1]; k++) {
        const struct tl_border *b = &borders->borders[borders->near[k]];
        scale = b->metres;
        ConstructionPlace *best = b->kind == CONSTRUCTION_HEM    ? &hem
                                  : b->kind == CONSTRUCTION_DART ? &dart
                                                                 : &seam;
        *best =
            construction_nearer(*best, scale * uv.x, -scale * uv.y, scale * b->from[0], -scale * b->from[1],
                                scale * b->to[0], -scale * b->to[1], b->start_m, b->widest_m, b->kind);
    }
    const ConstructionPlace *places[] = {&seam, &hem, &dart};
    for (int i = 0; i < 3; i++)
        if (places[i]->near > 0)
            look = construction_add(tables, look, *places[i], scale * across.x, -scale * across.y,
                                    scale * down.x, -scale * down.y);
    return look;
}

#endif
