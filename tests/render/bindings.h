/* A check of every draw and dispatch that drivers do not make alike: samplers that compare depths read
 * textures that do, and no other sampler does; every storage block has a buffer. What GL leaves undefined
 * there, software GL draws in silence.
 *
 * Where TOILE_SHADERS_TO names a folder, the text of every shader that compiles is kept there, for `./dev
 * lint`.
 *
 * It stands before GL's functions that draw and dispatch, for the whole program, from test_bindings_watch on.
 * One thread.
 */
#ifndef TOILE_TESTS_RENDER_BINDINGS_H
#define TOILE_TESTS_RENDER_BINDINGS_H

#include <stddef.h>

void test_bindings_watch(void);
/* Counts the samplers and storage blocks that were bound so since the last call; the first few were printed.
 */
size_t test_bindings_take_faults(void);

#endif
