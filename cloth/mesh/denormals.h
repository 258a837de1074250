/* Denormal numbers, as this thread's processor treats them. */
#ifndef TOILE_CLOTH_MESH_DENORMALS_H
#define TOILE_CLOTH_MESH_DENORMALS_H

/* Makes this thread flush denormals to zero, which here are rounding noise and cost up to 150 times a normal
 * operation. Returns the state that tl_denormals_restore takes. */
unsigned tl_denormals_off(void);
void tl_denormals_restore(unsigned state);

#endif
