/* The drawing of ARCHITECTURE.md: floors as bands, rooms as boxes, arrows within a floor down to what a room
 * uses.
 *
 * An arrow that follows from others (a -> c beside a -> b -> c) is left out, and so are the arrows from floor
 * to floor: every floor may use those below it, but for render and cloth, which never see each other. */
#ifndef TOILE_TESTS_HYGIENE_HOUSE_DRAWING_H
#define TOILE_TESTS_HYGIENE_HOUSE_DRAWING_H

#include "tests/hygiene/house.h"

#include <stdio.h>

/* Writes an SVG document. The same code gives the same bytes. */
void house_draw(const struct house *house, FILE *out);

#endif
