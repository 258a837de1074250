// The numbers of a tree's nodes (tree.h), for GLSL and C.
#define TL_TREE_WIDTH      8  // children of a node
#define TL_TREE_LEAF_MAX   3  // triangles of a child
#define TL_TREE_LEVELS_MAX 13 // the stack of rays has a place for each
// Nodes where rays begin: at all triangles, or at those alone that cast shadows.
#define TL_TREE_ALL     0u
#define TL_TREE_CASTERS 1u
// A child is TL_TREE_NO_CHILD; a node's number; or TL_TREE_LEAF, its triangles above their first place in `order`. The
// slot of a child is the corner of the node that it lies nearest to: bit k for axis k.
#define TL_TREE_NO_CHILD    0xffffffffu
#define TL_TREE_LEAF        0x80000000u
#define TL_TREE_COUNT_SHIFT 27
#define TL_TREE_PLACE       0x07ffffffu
