/* Disjoint sets (union-find) of the numbers 0 to n - 1: the representative of a set is its lowest member.
 * Threads: one per array. */
#ifndef TOILE_ASSETS_TOPOLOGY_SETS_H
#define TOILE_ASSETS_TOPOLOGY_SETS_H

#include <stddef.h>
#include <stdint.h>

/* parents[i] = i: each is its own set. The caller frees the array. */
uint32_t *tl_sets_create(size_t count);
uint32_t tl_sets_find(uint32_t *parents, uint32_t member);
void tl_sets_join(uint32_t *parents, uint32_t a, uint32_t b);

#endif
