/* The named colours of CSS Color Module Level 4, section 6.1: 148 names in small letters. Pure; threads: any.
 */
#ifndef TOILE_CONFIG_COLOUR_NAMES_H
#define TOILE_CONFIG_COLOUR_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

extern const char *const tl_colour_names[]; /* in the order of the alphabet, ended by NULL */

/* The colour of a name, sRGB, 0xRRGGBB. False when no colour has it. */
bool tl_colour_find(const char *name, uint32_t *rgb);

#endif
