/* Measures of a garment as it is worn and as it was cut: strains and areas of its panels, lengths of its
 * openings, and its girths beside the body's.
 *
 * Panels are the charts of a garment that has a pattern (assets/sewing/charts.h), else the parts of its mesh.
 * Metres, world axes with y up. Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_APP_FIT_MEASURES_H
#define TOILE_APP_FIT_MEASURES_H

#include "assets/base/garment.h"
#include "assets/sewing/openings.h"

/* Borrowed. */
struct tl_measures_source {
    const tl_garment *garment;
    const vec3s *positions; /* [mesh.vertex_count] as worn */
    const uint32_t *weld;   /* [mesh.vertex_count] welded vertex of each */
    const tl_mesh *body;    /* standing upright on y = 0 as it is worn; NULL: nobody */
};

/* Statistics of strains over rest area, slivers left out. p95: what 95 % of the area do not exceed. */
struct tl_spread {
    double mean, p95, max;
};

struct tl_panel_measures {
    char name[80];
    double rest_m2, worn_m2;
    struct tl_spread warp, weft; /* longer: positive */
    struct tl_spread shear; /* of its magnitude: sine of the angle by which threads leave the right one */
};

struct tl_opening_measures {
    char name[TL_OPENING_NAME];
    double rest_m, worn_m;
    double height_m; /* of its middle as worn: the centre of the loop, as a wire */
};

/* A level of the body. */
enum { TL_GIRTH_BUST, TL_GIRTH_WAIST, TL_GIRTH_HIP, TL_GIRTHS };
extern const char *const tl_girth_names[TL_GIRTHS];
struct tl_girth_measures {
    double height_m;       /* 0: the body has no such level */
    double body_m;         /* as a tape measure reads it */
    double rest_m, worn_m; /* of the cloth around the body there, folds included; 0: there is none */
};

struct tl_measures {
    bool has_pattern; /* its rest shape is a pattern */
    size_t panel_count, opening_count;
    struct tl_panel_measures whole, *panels;
    struct tl_opening_measures *openings;
    struct tl_girth_measures girths[TL_GIRTHS];
};
struct tl_measures tl_measures_take(const struct tl_measures_source *source);
void tl_measures_release(struct tl_measures *measures);

#endif
