/* Measured reflectance, material.samples, as tables. To factor a file takes seconds, so tables are shared and
 * kept, as weaves are: for as long as the file has the same size and time, and of those that nobody uses the
 * last TL_MEASURED_KEPT.
 *
 * Errors: those of tl_reflectance_samples_load. Threads: any; the tables themselves are not written to. */
#ifndef TOILE_APP_TEXTURES_MEASURED_FILES_H
#define TOILE_APP_TEXTURES_MEASURED_FILES_H

#include "render/brdf/tables/measured.h"

#define TL_MEASURED_KEPT 4

/* Sets `measured` of the material, and what it reflects of light that no lamp sends. Logs how well both fit
 * the samples. Give `measured` back with tl_measured_give. */
bool tl_measured_take(const char *path, tl_material *material, tl_error *error);
void tl_measured_give(const struct tl_measured *measured); /* NULL is accepted */

#endif
