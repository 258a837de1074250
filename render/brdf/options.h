/* Table "material": a garment's appearance. */
#ifndef TOILE_RENDER_BRDF_OPTIONS_H
#define TOILE_RENDER_BRDF_OPTIONS_H

#include "config/options.h"

enum tl_on_print { TL_ON_PRINT_REPLACE, TL_ON_PRINT_TINT, TL_ON_PRINT_KEEP };

struct tl_material_params { /* table "material": from the fabric or by hand */
    bool use_file;          /* keep the garment file's own materials where it has them */
    float diffuse[3], diffuse_roughness;
    float specular[3];
    float thread;                      /* share of `diffuse` that is sent back as gloss */
    float thread_along, thread_across; /* slopes of a lobe of its own for that; 0: it joins `specular` */
    float warp_share;                  /* of the surface, in warps; the rest is wefts */
    float weft_colour[3];              /* diffuse colour of the wefts; 0: as the warps, `diffuse` */
    float glossiness;
    int model, facets, masking, ward, fresnel; /* as struct tl_gloss */
    float index, extinction;
    float width_weft, width_warp, rotation_deg;
    float coat, coat_glossiness;
    float transmission[3];
    float openness;
    float back[3];                              /* diffuse colour of the back; 0: as the front */
    float fuzz, fuzz_colour[3], fuzz_roughness; /* struct tl_fuzz's colour is the first two multiplied */
    float fuzz_follow;
    const char *samples; /* file of measured reflectance, or "" */
    int on_print;        /* enum tl_on_print: a garment's printed picture under a fabric */
};
extern const struct tl_option_table tl_material_options;

#endif
