#include "assets/topology/sets.h"

#include "config/base/memory.h"

uint32_t *tl_sets_create(size_t count)
{
    uint32_t *parents = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        parents[i] = (uint32_t)i;
    return parents;
}

uint32_t tl_sets_find(uint32_t *parents, uint32_t member)
{
    while (parents[member] != member) {
        parents[member] = parents[parents[member]];
        member = parents[member];
    }
    return member;
}

void tl_sets_join(uint32_t *parents, uint32_t a, uint32_t b)
{
    a = tl_sets_find(parents, a);
    b = tl_sets_find(parents, b);
    if (a < b)
        parents[b] = a;
    else
        parents[a] = b;
}
