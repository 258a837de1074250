/* Patterns on a body: where the body's waist is, and the panels that belong there. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_PATTERN_PATTERN_PLACE_H
#define TOILE_ASSETS_PATTERN_PATTERN_PLACE_H

#include "assets/base/mesh.h"
#include "assets/pattern/pattern.h"

/* Edges of this label lie at the waist when they are worn: the top of a skirt or of trousers. */
#define TL_PATTERN_AT_WAIST "lower_interface"
/* The top of a bodice without straps: under the arms. Neck lines: beside the neck. */
#define TL_PATTERN_STRAPLESS    "strapless_top"
#define TL_PATTERN_LEFT_COLLAR  "left_collar"
#define TL_PATTERN_RIGHT_COLLAR "right_collar"

/* The body's measures, as GarmentCode writes them: a file beside the body's, of its name with .yaml, that
 * holds `body:` with values in centimetres. Zero for each that is not there. */
struct tl_pattern_measures {
    double height, head, waist_line; /* m: head_l, and from the neck to the waist */
    double armscye, neck; /* m: armscye_depth, from the neck to under the arms; neck_w; 0: unknown */
};
/* False when there is no such file, or no such measures in it; then *out is zeroed. */
bool tl_pattern_measures(const char *body_path, struct tl_pattern_measures *out);

/* Heights above the ground where things hang. */
struct tl_pattern_levels {
    double waist; /* height - head - waist_line where the measures are known, else where the body is narrowest
                     (assets/body/fit.h); 0: not found */
    double shoulder;  /* the neck's foot: height - head, else as on the average body */
    double under_arm; /* shoulder - armscye; the same */
    double neck;      /* half of the neck's width, not a height; the same */
};
struct tl_pattern_levels tl_pattern_levels(const struct tl_pattern_measures *measures, const tl_mesh *body);

/* Raises all panels with edges at the waist by one distance, so that these edges' mean lies there, and moves
 * them inwards, so that what hangs over them is outside. What is sewn to these edges is raised as one until
 * it meets them or reaches the shoulders, unless some of its panels are turned towards limbs. False when no
 * edge is labelled so: the pattern is unchanged. */
bool tl_pattern_raise(tl_pattern *pattern, const struct tl_pattern_levels *levels);

/* Sets what labelled edges are held to while they are sewn: the waist and the tops of strapless bodices to
 * their heights, neck lines to outside of the neck. (GarmentCode's simulator attaches the same labels there
 * in its first frames: pygarment/meshgen/garment.py.) */
void tl_pattern_hold(tl_pattern *pattern, const struct tl_pattern_levels *levels);

#endif
