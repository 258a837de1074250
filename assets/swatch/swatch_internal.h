/* Shared by the files of the room: light at a texel, and small sums. */
#ifndef TOILE_ASSETS_SWATCH_SWATCH_INTERNAL_H
#define TOILE_ASSETS_SWATCH_SWATCH_INTERNAL_H

#include "assets/swatch/swatch.h"

#include <math.h>

/* Errors of pictures that grow more than this leave normals open. */
#define TL_SWATCH_SPREAD_MAX 10

static inline double tl_swatch_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Scales to length 1 and returns the length that it had, which must not be 0. */
double tl_swatch_unit(double v[3]);

/* The light of a lamp at a point of the swatch, millimetres: direction and e_k. `mean_mm` is the mean
 * distance of lamps with a position from the middle. */
struct tl_swatch_light {
    double direction[3], strength;
};
struct tl_swatch_light tl_swatch_light_at(const struct tl_swatch_lamp *lamp, double mean_mm, double x,
                                          double y);
double tl_swatch_mean_mm(const struct tl_swatch_rig *rig);

/* Weighted normal equations. */
struct tl_swatch_normal_equations {
    double m[6]; /* xx xy xz yy yz zz */
    double v[3];
};
/* Adds the equation row.x = value. */
void tl_swatch_add(struct tl_swatch_normal_equations *sum, const double row[3], double weight, double value);
/* Solves them; false where they are singular. `spread` is how much larger the error of the solution is than
 * that of one value, in the root mean square over its components, for rows of length 1 and weights that add
 * up to 1. */
bool tl_swatch_invert(const struct tl_swatch_normal_equations *sum, double out[3], double *spread);

/* A texel as the solver and the fit of gloss know it. */
struct tl_swatch_texel {
    size_t count;
    double to_camera[3];
    struct tl_swatch_light lights[TL_SWATCH_LAMPS_MAX];
    double values[TL_SWATCH_LAMPS_MAX];  /* means of the channels; -1: saturated */
    double weights[TL_SWATCH_LAMPS_MAX]; /* 0: saturated, or in shadow */
};
void tl_swatch_texel_read(const struct tl_swatch_rig *rig, double mean_mm, const tl_image *pictures,
                          size_t index, struct tl_swatch_texel *out);

struct tl_swatch_gloss {
    double exponent, specular; /* specular 0: none */
    bool is_shown;             /* lamps stand where they would show a lobe of the exponent 16 */
};

/* S (s + 1) / 2 max(0, r.l)^s, and its gradient over the normal; `gradient` may be NULL. */
double tl_swatch_highlight(const struct tl_swatch_gloss *gloss, const struct tl_swatch_texel *texel,
                           const double normal[3], size_t lamp, double gradient[3]);

/* Finds what the model leaves of the values; `body` is albedo times normal. Returns the weighted sum of the
 * squares. With `rows` also the derivatives of the model over the body. */
double tl_swatch_errors(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                        const double *weights, const double body[3], double *errors, double (*rows)[3]);

/* Moves the body to a minimum of that sum, by damped Gauss-Newton steps. Returns the sum. */
double tl_swatch_descend(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                         const double *weights, int steps, double body[3]);

/* The body without gloss, of weighted least squares; false where lamps are fewer than three or nearly in one
 * plane. */
bool tl_swatch_matt(const struct tl_swatch_texel *texel, const double *weights, double body[3]);

/* Descends from the body as it is, and from level cloth, and keeps the better one. */
double tl_swatch_settle(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                        const double *weights, int steps, double body[3]);

/* The gloss that leaves least of the pictures; specular 0 when that is hardly less than what no gloss leaves.
 */
struct tl_swatch_gloss tl_swatch_fit_gloss(const struct tl_swatch_rig *rig, const tl_image *pictures);

#endif
