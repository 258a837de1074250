/* The linear image to a screen's bytes on the CPU: background, exposure, tone mapping, sRGB, as show.frag
 * does it on the GPU (tone.glsl). On all cores; results do not depend on their number. Pure. */
#ifndef TOILE_RENDER_PRESENT_TONE_MAP_H
#define TOILE_RENDER_PRESENT_TONE_MAP_H

#include "assets/base/image.h"
#include "render/present/behind.h"

/* sRGB bytes of linear values, by the bits of the float: TL_ENCODING_STEPS intervals an octave, over the
 * octaves below 1 that are not encoded as 0. Within 0.56 of the exact value before rounding. */
#define TL_ENCODING_OCTAVES 13
#define TL_ENCODING_STEPS   1024
struct tl_encoding {
    uint8_t bytes[TL_ENCODING_OCTAVES * TL_ENCODING_STEPS + 1];
};
void tl_encoding_make(struct tl_encoding *out);

struct tl_tone_map_request {
    const struct tl_encoding *encoding;
    const float *texels; /* [height][width][4]: linear, premultiplied, coverage in alpha */
    int width, height;
    int first_column, end_column; /* [first, end): at least these columns are written */
    bool is_light;                /* false: colours that stand for numbers, neither exposed nor mapped */
    vec3s exposure;               /* factors of red, green and blue */
    struct tl_behind *behind;     /* seen where the image is open; NULL: grey */
};
/* Writes RGBA, alpha 255: [height][width][4]. */
void tl_tone_map(const struct tl_tone_map_request *request, uint8_t *bytes);

/* A whole image of light, on grey. `light`: F32 x4, linear, premultiplied. Returns U8 x4, to be released. */
tl_image tl_tone_map_image(const tl_image *light, vec3s exposure);

#endif
