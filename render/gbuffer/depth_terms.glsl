// Steps between depths of 0 to 1, for GLSL and C.
#define DEPTH_ROUNDING 1.2e-7f // a surface behind an open one is deeper by more
// Added to the depth of backs. Plies of cloth folded flat are nearer than rounding resolves; the outside is seen.
#define DEPTH_OF_BACKS 4e-7f
