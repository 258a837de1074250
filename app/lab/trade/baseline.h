/* The baseline of bench cloth: a plain scalar loop in double over a square sheet of point masses with
 * structural, shear and second-neighbour bend springs (six a particle), integrated by Verlet's method below
 * its critical step. It is only compared with and is no solver of this program: second-neighbour springs have
 * no linear bending stiffness: their energy is k dx^2 theta^4 / 32. */
#ifndef TOILE_APP_LAB_TRADE_BASELINE_H
#define TOILE_APP_LAB_TRADE_BASELINE_H

#include <stddef.h>

typedef struct tl_baseline tl_baseline;

tl_baseline *tl_baseline_create(int side); /* side x side particles, 1 m square, hung by an edge */
void tl_baseline_destroy(tl_baseline **baseline);
void tl_baseline_step(tl_baseline *baseline);
double
tl_baseline_stretch(const tl_baseline *baseline); /* longest over rest length of the structural springs */

#endif
