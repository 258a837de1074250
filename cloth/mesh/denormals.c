#include "cloth/mesh/denormals.h"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

unsigned tl_denormals_off(void)
{
#ifdef __SSE2__
    unsigned state = _mm_getcsr();
    _mm_setcsr(state | 0x8040); /* FTZ | DAZ */
    return state;
#else
    return 0;
#endif
}

void tl_denormals_restore(unsigned state)
{
#ifdef __SSE2__
    _mm_setcsr(state);
#else
    (void)state;
#endif
}
