/* The terms of construction_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_CONSTRUCTION_TERMS_H
#define TOILE_RENDER_CONSTRUCTION_TERMS_H

#include "render/construction/tables.h"
#include "render/gpu/glsl.h"

#include <stdbool.h>

typedef struct ConstructionPlace ConstructionPlace;
typedef struct ConstructionProfile ConstructionProfile;
typedef struct ConstructionLook ConstructionLook;

/* Names of GLSL, while the file is read. */
#define TERM                   static inline
#define CONSTRUCTION_TABLES    tables,
#define CONSTRUCTION_TABLES_IN const struct tl_construction_tables *tables,
#define construction_sizes     (tables->sizes)
#define construction_rows      (tables->rows)
#define max                    term_max
#define clamp                  term_clamp
#define abs                    fabsf
#define floor                  floorf
#define sqrt                   sqrtf
#define exp                    expf
#define sin                    sinf
#define cos                    cosf
#include "render/construction/construction_terms.glsl"
#undef TERM
#undef CONSTRUCTION_TABLES
#undef CONSTRUCTION_TABLES_IN
#undef construction_sizes
#undef construction_rows
#undef max
#undef clamp
#undef abs
#undef floor
#undef sqrt
#undef exp
#undef sin
#undef cos

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
