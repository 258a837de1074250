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
extern const char *const tl_units_names[];   /* "auto", "m", ...; NULL-terminated */
extern const char *const tl_units_plurals[]; /* "metres", ..., by enum tl_units */

double tl_units_metres(enum tl_units units); /* of one unit; AUTO: 1 */

struct tl_units_reading {
    enum tl_units units; /* what the file was read in; AUTO: built in, metres */
    enum tl_units other; /* a second possible unit; AUTO: none */
    float longest;       /* longest side of the box, units of the file */
    bool guessed;        /* from the size; else set by the file's format or an option */
    bool absurd;         /* guessed, because the format's metres give an impossible size */
    bool fits;           /* the size is that of a garment or a body */
    bool metric;         /* its format is in metres with Y up */
    bool z_up;           /* stands along Z, and its format does not state that Y is up */
    bool deep;           /* deeper than high with Y up, and its format does not state that Y is up */
};

/* The parts of a reading that are in doubt. Units: they were guessed, and a second one is
 * possible, none fits, or the format's metres are absurd. Up: the format does not state it, and the model is
 * deeper (along Z) than high (along Y), as bodies and what they wear seldom are, whichever axis was chosen.
 */
enum tl_doubts { TL_DOUBT_UNITS = 1, TL_DOUBT_UP = 2 };
unsigned tl_units_doubts(const struct tl_units_reading *reading);

/* Decides the units of a file whose positions have this box. `wanted` other than AUTO decides; then
 * `is_metric` means metres, unless absurd; then the size. */
struct tl_units_reading tl_units_read(struct tl_box box, enum tl_units wanted, bool is_metric);

/* Decides again between two possible units by what a pose does not alter, so that a garment has one size in
 * all of its poses. One that hangs above its origin hangs on a standing body: its top is 0.7 to 2 m high.
 * Else, between inches and decimetres, its cloth, `area` in square units, is nearer to a square metre; inches
 * that could be centimetres stay those. */
void tl_units_weigh(struct tl_units_reading *reading, struct tl_box box, double area);

/* Whether a garment lies where its body is only with Z up: half of its box is then within the body's, and
 * nothing of it with Y up. Metres; `body` stands with Y up. */
bool tl_units_lies_z_up(struct tl_box garment, struct tl_box body);
/* Whether it lies where its body is with Y up. */
bool tl_units_lies_y_up(struct tl_box garment, struct tl_box body);

/* One line to report, such as "skirt.obj: 812 units at its longest: taken as millimetres ...; --units
 * overrides this" with `option` for --units: new string, NULL when nothing was guessed. */
char *tl_units_describe(const char *name, const struct tl_units_reading *reading, const char *option);
/* The same for a model that stands along Z and is therefore turned upright, or whose axis is in doubt;
 * `option` for --up. */
char *tl_units_describe_up(const char *name, const struct tl_units_reading *reading, const char *option);

#endif
