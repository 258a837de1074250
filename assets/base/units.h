/* Units of length: what one unit of a file is in metres. glTF says it (metres); OBJ and point caches do not,
 * so it is guessed from the size of what they hold, said aloud, and can be told.
 *
 * A garment, or who wears it, is 0.25 to 2.5 m at its longest (the longest side of its box), so by that
 * length in units of the file:
 *
 *     0.25 to 2.5     metres
 *     2.5 to 9.84     decimetres (some simulators like numbers of about 1)
 *     9.84 to 25      inches, 0.25 to 0.64 m; decimetres would do
 *     25 to 250       centimetres; up to 98.4 inches would do
 *     250 to 2500     millimetres
 *     beyond          nothing fits: metres below, millimetres above
 *
 * glTF is doubted only where metres are absurd: 25 m and more is read as if it did not say.
 * Pure. */
#ifndef TOILE_ASSETS_BASE_UNITS_H
#define TOILE_ASSETS_BASE_UNITS_H

#include "assets/base/mesh.h"

#include <stdbool.h>

enum tl_units { TL_UNITS_AUTO, TL_UNITS_M, TL_UNITS_DM, TL_UNITS_CM, TL_UNITS_MM, TL_UNITS_IN };
extern const char *const tl_units_names[]; /* "auto", "m", ...; NULL-terminated */

double tl_units_metres(enum tl_units units); /* of one unit; AUTO: 1 */

struct tl_units_reading {
    enum tl_units units; /* what the file was read in; AUTO: built in, metres */
    enum tl_units other; /* would have done too; AUTO: none */
    float longest;       /* longest side of the box, units of the file */
    bool guessed;        /* from the size; else told by the file's kind or a person */
    bool absurd;         /* guessed, because the metres that the file's kind says cannot be */
    bool fits;           /* the size is one that can be worn */
    bool z_up;           /* stands along Z, though it is read with Y up */
};

/* How a file whose positions have this box is read. `wanted` AUTO: `is_metric` says metres, doubted when
 * absurd; otherwise a guess. */
struct tl_units_reading tl_units_read(struct tl_box box, enum tl_units wanted, bool is_metric);

/* One line about it, "skirt.obj: 812 units at its longest: taken as millimetres ...; --units tells otherwise"
 * with `option` for --units: new string, NULL when there is nothing to say. */
char *tl_units_describe(const char *name, const struct tl_units_reading *reading, const char *option);
/* The same for a box that stands along Z. */
char *tl_units_describe_up(const char *name, const struct tl_units_reading *reading);

#endif
