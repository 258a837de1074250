/* Plots below the gallery's sections. Each plots what a pure measurement of render/brdf gives for one
 * technique, into an open page (app/report/report.h). */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_FIGURES_H
#define TOILE_APP_LAB_GALLERY_GALLERY_FIGURES_H

#include <stdio.h>

/* The plots of a section; nothing where it has none. */
void tl_gallery_write_figures(const char *section, FILE *out);

void tl_gallery_table_figures(FILE *out);     /* A1, A3 to A5: error of tables over size and precision */
void tl_gallery_grazing_figures(FILE *out);   /* A2: what the singular factor's range darkens */
void tl_gallery_folded_figures(FILE *out);    /* A3: what folding all terms into one table costs */
void tl_gallery_normalise_figures(FILE *out); /* A9: five normalisations over the angle between vertices */
void tl_gallery_power_figures(FILE *out);     /* A10: a highlight by each power, and their banding */
void tl_gallery_fresnel_figures(FILE *out);   /* B6: the two indices of the paper's figure 7 */
void tl_gallery_lobe_figures(FILE *out);      /* D3, D4: levels by exponent, and lobes' errors */
void tl_gallery_memory_figures(FILE *out);    /* D8: bytes of PEMs and shadow maps by their size */
void tl_gallery_crop_figures(FILE *out);      /* D16: bytes of cropped PEMs by number of regions and size */

#endif
