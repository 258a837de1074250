/* The plain loop of bench cloth: a scalar loop in double over a square sheet of point masses with
 * structural, shear and second-neighbour bend springs (six a particle), integrated by Verlet's method below
 * its critical step. It is only compared with and is no solver of this program: second-neighbour springs have
 * no linear bending stiffness: their energy is k dx^2 theta^4 / 32. */
#ifndef TOILE_APP_LAB_CLOTH_PLAIN_LOOP_H
#define TOILE_APP_LAB_CLOTH_PLAIN_LOOP_H

#include <stddef.h>

typedef struct tl_plain_loop tl_plain_loop;

tl_plain_loop *tl_plain_loop_create(int side); /* side x side particles, 1 m square, hung by an edge */
void tl_plain_loop_destroy(tl_plain_loop **loop);
void tl_plain_loop_step(tl_plain_loop *loop);
double
tl_plain_loop_stretch(const tl_plain_loop *loop); /* longest over rest length of the structural springs */

#endif
