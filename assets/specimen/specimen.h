/* Simple shapes for judging a fabric: those of the papers' figures, and a sheet over a ball.
 * Metres; UVs are metric, u along the weft, v along minus the warp, as a garment's. Threads: pure. */
#ifndef TOILE_ASSETS_SPECIMEN_SPECIMEN_H
#define TOILE_ASSETS_SPECIMEN_SPECIMEN_H

#include "assets/base/avatar.h"
#include "assets/base/garment.h"

/* "sheet": a square of 0.5 m that lies above the ball and falls. "disc": Cusick's drape test (BS 5058, ISO
 * 9073-9), a disc 30 cm across that lies level, 0.4 m up, its middle held by plates of 18 cm, which are not
 * drawn. "sphere", "torus", "plate": solid, they do not move; the weft of the plate, a flat disc, runs in
 * circles about its middle. */
extern const char *const tl_specimen_names[]; /* NULL-terminated */

/* Makes the shape called `name` with edges of about `edge_m`. False when the name is unknown. */
bool tl_specimen_make(const char *name, float edge_m, tl_garment *out);

/* The body under the sheet: a sphere of 0.12 m on the axis. */
tl_avatar tl_specimen_ball(void);

#endif
