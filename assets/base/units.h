/* Units of length: the size in metres of one unit of a file. glTF is in metres by its specification; OBJ and
 * point caches state no unit, so it is guessed from the size of their content, reported, and can be set by an
 * option.
 *
 * A garment or an avatar is 0.25 to 2.5 m long (the longest side of its box), so by that length in units of
 * the file:
 *
 *     0.25 to 2.5     metres
 *     2.5 to 9.84     decimetres (some simulators prefer numbers near 1)
 *     9.84 to 25      inches, 0.25 to 0.64 m; decimetres are possible
 *     25 to 250       centimetres; up to 98.4, inches are possible
 *     250 to 2500     millimetres
 *     beyond          no unit fits: metres below, millimetres above
 *
 * A glTF file is doubted only where metres are absurd: 25 m or longer is guessed as for the others.
 * Threads: pure. */
#ifndef TOILE_ASSETS_BASE_UNITS_H
#define TOILE_ASSETS_BASE_UNITS_H

#include "assets/base/mesh.h"

#include <stdbool.h>

enum tl_units { TL_UNITS_AUTO, TL_UNITS_M, TL_UNITS_DM, TL_UNITS_CM, TL_UNITS_MM, TL_UNITS_IN };
extern const char *const tl_units_names[]; /* "auto", "m", ...; NULL-terminated */

double tl_units_metres(enum tl_units units); /* of one unit; AUTO: 1 */

struct tl_units_reading {
    enum tl_units units; /* what the file was read in; AUTO: built in, metres */
    enum tl_units other; /* a second possible unit; AUTO: none */
    float longest;       /* longest side of the box, units of the file */
    bool guessed;        /* from the size; else set by the file's format or an option */
    bool absurd;         /* guessed, because the format's metres give an impossible size */
    bool fits;           /* the size is that of a garment or a body */
    bool z_up;           /* stands along Z, and its format does not say that Y is up */
};

/* Decides the units of a file whose positions have this box. `wanted` other than AUTO decides; then
 * `is_metric` means metres, unless absurd; then the size. */
struct tl_units_reading tl_units_read(struct tl_box box, enum tl_units wanted, bool is_metric);

/* One line to report, such as "skirt.obj: 812 units at its longest: taken as millimetres ...; --units
 * overrides this" with `option` for --units: new string, NULL when nothing was guessed. */
char *tl_units_describe(const char *name, const struct tl_units_reading *reading, const char *option);
/* The same for a model that stands along Z and is therefore turned upright; `option` for --up. */
char *tl_units_describe_up(const char *name, const struct tl_units_reading *reading, const char *option);

#endif
