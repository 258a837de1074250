/* The terms of construction_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_CONSTRUCTION_TERMS_H
#define TOILE_RENDER_CONSTRUCTION_TERMS_H

#include "render/construction/tables.h"
#include "render/gpu/vectors.h"

#include <stdbool.h>

typedef struct ConstructionPlace ConstructionPlace;
typedef struct ConstructionProfile ConstructionProfile;
typedef struct ConstructionLook ConstructionLook;

#define CONSTRUCTION_TABLES    tables,
#define CONSTRUCTION_TABLES_IN const struct tl_construction_tables *tables,
#define construction_sizes     (tables->sizes)
#define construction_rows      (tables->rows)

#include "render/gpu/terms_begin.h"

#include "render/construction/construction_terms.glsl"

#include "render/gpu/terms_end.h"

#undef CONSTRUCTION_TABLES
#undef CONSTRUCTION_TABLES_IN
#undef construction_sizes
#undef construction_rows

/* Interpolates a table; beyond its end the last entry counts. */
static inline ConstructionProfile construction_profile(const struct tl_construction_tables *tables,
                                                       float kind, float d)
{
    float place = term_clamp(d / CONSTRUCTION_STEP, 0, (float)CONSTRUCTION_LAST - 0.001f);
    int entry = (int)place;
    float share = place - (float)entry;
    const vec4s *from = &tables->profiles[(int)kind][entry];
    vec4s v = glms_vec4_lerp(from[0], from[1], share);
    return (ConstructionProfile){v.x, v.y, v.z, v.w};
}

#endif
