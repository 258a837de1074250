#include "render/env/sun.h"
void tl_suns_take(tl_cube *cube, struct tl_suns *out){(void)cube;*out=(struct tl_suns){0};}
