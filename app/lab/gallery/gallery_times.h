/* The plot of section D10: times that this gallery measured. */
#ifndef TOILE_APP_LAB_GALLERY_GALLERY_TIMES_H
#define TOILE_APP_LAB_GALLERY_GALLERY_TIMES_H

#include "app/lab/gallery/gallery.h"

/* Plots the time of a frame of the entries [first, end) of one section over their number of regions, of
 * those that have the usual size of shadow maps, and over that size, of those with the usual number of
 * regions (what most entries have). Errors: none, what cannot be plotted is left out. Threads: one stream
 * each. */
void tl_gallery_write_times(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                            FILE *out);

#endif
