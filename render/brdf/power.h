/* A cosine raised to the exponent of a highlight by three methods [Schroecker 2002, 5.1, 5.2 and figure 10]:
 * pow; repeated squaring in 8 bits and a sign, as register combiners do; a table of 8-bit values that a
 * texture unit interpolates. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_POWER_H
#define TOILE_RENDER_BRDF_POWER_H

#include "render/brdf/normalise.h" /* register_power, of FIXED8 */

enum tl_power { TL_POWER_POW, TL_POWER_FIXED8, TL_POWER_TABLE, TL_POWER_COUNT };
extern const char *const tl_power_names[]; /* pow fixed8 table, NULL */

/* `size` values of x^exponent in 8 bits, at x = i / (size - 1), from 0 up. */
void tl_power_table_make(float exponent, int size, uint8_t *out);
/* The table at a cosine, interpolated linearly; the cosine is clamped to [0, 1]. */
float tl_power_table_at(const uint8_t *table, int size, float cosine);

/* Errors over a highlight, from its centre to where it falls below half of 1/255. The steps of angle are so
 * small that the exact power rounded to 8 bits changes by single levels. FIXED8 needs an exponent that is a
 * power of two. */
struct tl_power_error {
    double rms, max;     /* of the difference from cosine^exponent */
    double max_near_one; /* largest difference where the cosine lies between the table's last two values */
    double band;         /* largest step between neighbouring levels; 1/255 is invisible */
    int levels;          /* number of different values out of 256, rounded to 8 bits */
};
#define TL_POWER_TABLE_SIZE 256
struct tl_power_error tl_power_error(int method, int exponent, int table_size);

#endif
