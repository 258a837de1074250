/* Directions of rays from one item after the other, update after update. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_SPREAD_H
#define TOILE_RENDER_TRACE_SPREAD_H

#include <cglm/struct.h>
#include <stdint.h>

/* Number i of a sequence that fills the unit square evenly [the R2 sequence of Roberts 2018], begun elsewhere
 * for every item. Fixed point: exact at any i. */
static inline vec2s tl_spread(uint32_t item, uint32_t i)
{
    uint32_t hash = (item + 1) * 0x9e3779b1u;
    hash = (hash ^ hash >> 15) * 0x85ebca77u;
    uint32_t x = hash + i * 3242174889u, y = (hash ^ hash >> 13) * 0xc2b2ae3du + i * 2447445414u;
    return (vec2s){{(float)(x >> 8) / (float)(1 << 24), (float)(y >> 8) / (float)(1 << 24)}};
}

#endif
