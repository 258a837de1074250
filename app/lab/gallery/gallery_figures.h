/* Plots and tables below the gallery's sections: what pure measurements of render/brdf and render/pem give
 * for one technique. Errors: none. Threads: one at a time. */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_FIGURES_H
#define TOILE_APP_LAB_GALLERY_GALLERY_FIGURES_H

#include <cjson/cJSON.h>

/* Appends the figures of a section (app/report/report.h) to an array; nothing where it has none. */
void tl_gallery_add_figures(const char *section, cJSON *figures);

#endif
