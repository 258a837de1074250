/* The ruler of bench cloth: the plain loop that anyone would write, scalar and in double: a square sheet of
 * point masses with structural, shear and second-neighbour bend springs, moved by Verlet's method below its
 * critical step. Six springs a particle. It is here to be compared with, and is no solver of this program:
 * second-neighbour springs have no linear bending stiffness (CLOTH.md section 3, 5). */
#ifndef TOILE_APP_LAB_TRADE_BASELINE_H
#define TOILE_APP_LAB_TRADE_BASELINE_H

#include <stddef.h>

typedef struct tl_ruler tl_ruler;

tl_ruler *tl_ruler_create(int side); /* side x side particles, 1 m square, hung by an edge */
void tl_ruler_destroy(tl_ruler **ruler);
void tl_ruler_step(tl_ruler *ruler);
double tl_ruler_stretch(const tl_ruler *ruler); /* longest over rest length of the structural springs */

#endif
