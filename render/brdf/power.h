/* A cosine to the power of a highlight, three ways [001, sections 5.1, 5.2 and figure 10]: pow; multiplying
 * with itself in 8 bits and a sign, as register combiners do; a table of 8-bit values between which a texture
 * unit interpolates. Pure. */
#ifndef TOILE_RENDER_BRDF_POWER_H
#define TOILE_RENDER_BRDF_POWER_H

#include <stdint.h>

enum tl_power { TL_POWER_POW, TL_POWER_FIXED8, TL_POWER_TABLE, TL_POWER_COUNT };
extern const char *const tl_power_names[]; /* pow fixed8 table, NULL */

/* cosine^(2^squarings), rounded to 1/255 at first and after each squaring. */
float tl_power_fixed8(float cosine, int squarings);

/* `size` values of x^exponent in 8 bits, at x = i / (size - 1), from 0 up. */
void tl_power_table_make(float exponent, int size, uint8_t *out);
float tl_power_table_at(const uint8_t *table, int size, float cosine);

/* Over a highlight, from its middle to where it is below half of 1/255, in steps of angle that even the exact
 * power in 8 bits would show as single levels. Exponent: a power of two for FIXED8. */
struct tl_power_error {
    double rms, most;     /* of the difference from cosine^exponent */
    double most_near_one; /* where the cosine lies between the table's last two values */
    double band;          /* largest step from one level to the next: 1/255 is none that can be seen */
    int levels;           /* different values shown, rounded to 8 bits, of 256 */
};
#define TL_POWER_TABLE_SIZE 256
struct tl_power_error tl_power_error(int method, int exponent, int table_size);

#endif
