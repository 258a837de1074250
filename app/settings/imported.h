/* Fabrics of other programs (assets/fabric/fabric_file.h) as options: what they state becomes values of the
 * tables fabric, weave, material and construction; the rest keeps its values. Their pictures are named by
 * weave.pictures.
 *
 * Roughness becomes glossiness as for glTF files (assets/base/material.h); anisotropy becomes widths of the
 * model ward, as the principled model has them [Burley 2012]: aspect = sqrt(1 - 0.9 a), widths r^2 / aspect
 * and r^2 aspect.
 *
 * Errors: false with one line; values are then partly set. Threads: pure, but for reading the files. */
#ifndef TOILE_APP_SETTINGS_IMPORTED_H
#define TOILE_APP_SETTINGS_IMPORTED_H

#include "assets/fabric/fabric_file.h"
#include "config/options.h"

/* The file that a folder of toile's own has its fabric in. */
#define TL_FABRIC_OWN_FILE "fabric.yaml"

/* The file of options that a name stands for: a folder with TL_FABRIC_OWN_FILE in it names that, NULL
 * otherwise. A new string. */
char *tl_imported_own_file(const char *path);

/* Sets the bound options from a file that tl_fabric_file_is. */
bool tl_imported_apply(const char *path, const struct tl_binding *bindings, size_t count, tl_error *error);
/* The same of a file that is open. */
bool tl_imported_apply_file(const char *path, const tl_fabric_file *file, const struct tl_binding *bindings,
                            size_t count, tl_error *error);

#endif
