/* Measured reflectance as a list of samples, from a text file: what a gonioreflectometer or another program
 * writes, one pair of directions a line.
 *
 *     theta_l, phi_l, theta_v, phi_v, r, g, b
 *
 * are degrees from the normal, and from the weft towards the warp;
 *
 *     l_x, l_y, l_z, v_x, v_y, v_z, r, g, b
 *
 * are unit vectors along weft, warp and normal. The first line names the columns, in any order; others are
 * skipped. l points to the light, v to the viewer. r, g, b, or `value` alone, are the reflectance f_r, 1/sr,
 * not multiplied by a cosine. Columns are separated by commas, semicolons or blanks; lines that begin with #
 * are comments.
 *
 * Errors: TL_INPUT, one line that names file and line: a missing column, a word that is no finite number, a
 * negative or a huge value, a direction under the surface, a vector that is not of unit length, more than
 * TL_REFLECTANCE_SAMPLES_MAX samples or fewer than TL_REFLECTANCE_SAMPLES_MIN, nothing but zeros; a file of
 * more than TL_REFLECTANCE_FILE_BYTES is refused unread. Threads: any, one a file. */
#ifndef TOILE_ASSETS_FABRIC_SAMPLES_H
#define TOILE_ASSETS_FABRIC_SAMPLES_H

#include "config/base/error.h"

#include <cglm/struct.h>
#include <stddef.h>

#define TL_REFLECTANCE_SAMPLES_MIN 32
#define TL_REFLECTANCE_SAMPLES_MAX 1000000
#define TL_REFLECTANCE_FILE_BYTES  ((size_t)256 << 20)

/* Directions in the frame of the surface: x along weft, y along warp, z along the normal. */
struct tl_reflectance_sample {
    vec3s l, v;
    vec3s value; /* f_r, 1/sr */
};

struct tl_reflectance_samples {
    struct tl_reflectance_sample *items;
    size_t count;
};

bool tl_reflectance_samples_load(const char *path, struct tl_reflectance_samples *out, tl_error *error);
void tl_reflectance_samples_release(struct tl_reflectance_samples *samples); /* frees and zeroes */

#endif
