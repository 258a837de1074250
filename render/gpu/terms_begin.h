/* Gives C the names of GLSL for a text that is both, until terms_end.h takes them away:
 *
 *     #include "render/gpu/vectors.h"
 *
 *     #include "render/gpu/terms_begin.h"
 *
 *     #include "render/detail/detail_terms.glsl"
 *
 *     #include "render/gpu/terms_end.h"
 *
 * It has no include guard: each text is read between its own two. Texts are functions of floats, of bools and
 * of vectors, whose components are .x, .y, .z (vectors.h has the arithmetic); constants end in f. `&&` and
 * `?:` over what has no effect leave no branch: loops over lanes become vector code. */
#define TERM        TL_INLINE
#define TERM_TABLE  static const
#define abs         fabsf
#define asin        asinf
#define atan        atanf
#define atan2       atan2f
#define clamp       term_clamp
#define cos         cosf
#define exp         expf
#define exp2        tl_exp2
#define floor       floorf
#define inversesqrt term_inversesqrt
#define log2        tl_log2
#define max         term_max
#define min         term_min
#define pow         powf
#define sin         sinf
#define sqrt        sqrtf
#define cross       glms_vec3_cross
#define dot         glms_vec3_dot
/* Marks of parameters that are arrays. */
#define in const
#define out
/* A type; and, with what follows in brackets, its value. */
#define float(x) ((float)(x))
#define int(x) ((int)(x))
#define uint           term_uint
#define term_uint(x)   ((uint32_t)(x))
#define vec2           term_vec2
#define vec3           term_vec3
#define vec4           term_vec4
#define term_vec2(...) ((term_vec2){{__VA_ARGS__}})
#define term_vec3(...) ((term_vec3){{__VA_ARGS__}})
#define term_vec4(...) ((term_vec4){{__VA_ARGS__}})
